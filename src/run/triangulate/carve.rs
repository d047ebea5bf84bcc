//! Removal of triangles that can be reached from outside or from a hole without crossing a segment.

use super::build::{Built, Face, SeedLocation};
use crate::io::triangle::LineGraph;

/// What to do with triangles between the outer boundary and the convex hull.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outside {
    Keep,
    Remove,
}

/// Returns for each face true if it is kept.
pub(super) fn kept(built: &Built, graph: &LineGraph, outside: Outside) -> Vec<bool> {
    let faces = &built.faces;
    let mut is_kept = vec![true; faces.len()];
    let is_open =
        |face: &Face| (0..3).any(|i| face.neighbors[i].is_none() && !face.is_constrained[i]);
    let rim = (0u32..)
        .zip(faces)
        .filter(|(_, face)| outside == Outside::Remove && is_open(face))
        .map(|(f, _)| f);
    let holes = built.seeds[..graph.holes.len()]
        .iter()
        .filter_map(|seed| match seed {
            SeedLocation::Face(face) => Some(*face),
            SeedLocation::Constraint | SeedLocation::Outside => None,
        });
    flood(faces, rim.chain(holes), |face| {
        std::mem::replace(&mut is_kept[face as usize], false)
    });
    is_kept
}

/// Returns the attribute of the region that each kept face lies in, 0 outside of all regions; empty
/// if there are no regions. If a region has several seeds, the last counts.
pub(super) fn attributes(built: &Built, graph: &LineGraph, is_kept: &[bool]) -> Vec<f64> {
    if graph.regions.is_empty() {
        return Vec::new();
    }
    let mut attributes = vec![0.0; built.faces.len()];
    let mut last_region = vec![usize::MAX; built.faces.len()];
    for (region, seed) in built.seeds[graph.holes.len()..].iter().enumerate() {
        let SeedLocation::Face(start) = *seed else {
            continue;
        };
        flood(&built.faces, std::iter::once(start), |face| {
            let face = face as usize;
            attributes[face] = graph.regions[region].attribute;
            is_kept[face] && std::mem::replace(&mut last_region[face], region) != region
        });
    }
    attributes
}

/// Visits the faces that can be reached from `starts` without crossing a constraint. `takes`
/// returns true if the search continues from a face; it must do so only once for each face.
fn flood(faces: &[Face], starts: impl Iterator<Item = u32>, mut takes: impl FnMut(u32) -> bool) {
    let mut open: Vec<u32> = starts.collect();
    while let Some(face) = open.pop() {
        if takes(face) {
            let Face {
                neighbors,
                is_constrained,
                ..
            } = faces[face as usize];
            open.extend(
                (0..3)
                    .filter(|&i| !is_constrained[i])
                    .filter_map(|i| neighbors[i]),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::triangle::{Hole, Region};
    use crate::run::triangulate::build::build;
    use crate::triangulation::OnCrossing;
    use crate::triangulation::kernel::Adaptive;

    /// A square in a square, both of segments.
    fn squares(holes: &[[f64; 2]], regions: &[[f64; 2]]) -> (Built, LineGraph) {
        let square = |r: f64| [[-r, -r], [r, -r], [r, r], [-r, r]];
        let points = [square(3.0), square(1.0)].concat();
        let segments: Vec<[u32; 2]> = (0..4)
            .map(|i| [i, (i + 1) % 4])
            .chain((0..4).map(|i| [4 + i, 4 + (i + 1) % 4]))
            .collect();
        let region = |(i, &at): (usize, &[f64; 2])| Region {
            at,
            attribute: i as f64 + 1.0,
            max_area: None,
            line: 0,
        };
        let graph = LineGraph {
            holes: holes.iter().map(|&at| Hole { at, line: 0 }).collect(),
            regions: regions.iter().enumerate().map(region).collect(),
            ..LineGraph::default()
        };
        let seeds = [holes, regions].concat();
        (
            build::<Adaptive>(
                &points,
                &segments,
                &[true; 8],
                &seeds,
                OnCrossing::Split,
                None,
            )
            .unwrap(),
            graph,
        )
    }

    #[test]
    fn holes_and_regions_end_at_constraints() {
        let count = |holes: &[[f64; 2]], outside| {
            let (built, graph) = squares(holes, &[]);
            kept(&built, &graph, outside)
                .into_iter()
                .filter(|&kept| kept)
                .count()
        };
        for outside in [Outside::Keep, Outside::Remove] {
            assert_eq!(count(&[], outside), 10);
            assert_eq!(count(&[[0.0, 0.5]], outside), 8);
            assert_eq!(count(&[[2.0, 2.0], [0.1, 0.0]], outside), 0);
            assert_eq!(
                count(&[[1.0, 1.0], [1.0, 0.0], [9.0, 9.0]], outside),
                10,
                "on a constraint, or outside"
            );
        }
        let (built, graph) = squares(&[[2.0, 0.0]], &[[2.0, 0.0], [0.0, 0.0], [0.5, 0.5]]);
        let is_kept = kept(&built, &graph, Outside::Remove);
        let attributes = attributes(&built, &graph, &is_kept);
        let inner: Vec<f64> = is_kept
            .iter()
            .zip(&attributes)
            .filter(|(kept, _)| **kept)
            .map(|(_, &a)| a)
            .collect();
        assert_eq!(inner, [3.0, 3.0]);
    }
}
