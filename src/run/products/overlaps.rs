//! Search for faces that overlap without sharing an edge.
//!
//! If all faces are counter-clockwise and linked edge by edge, the number of faces that cover a
//! point is the winding number of the border around it. The border is triangulated with its edges
//! as constraints. If none of them is split, they do not cross, and the winding number of every
//! triangle follows by walking in from the outside, where it is 0, and counting the border edges
//! that are crossed.

use std::collections::HashMap;

use crate::data::{self, Surface};
use crate::triangulation::geometry::Plane;
use crate::triangulation::kernel::Wide;
use crate::triangulation::num::unsigned_zero;
use crate::triangulation::tds::{CellId, VertexId, ccw, cw};
use crate::triangulation::{ConstrainedDelaunay, OnCrossing};

/// A position where faces of a surface overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Overlap {
    /// The edge opposite this corner of the face has no neighbor, and another such edge or its end
    /// lies on it.
    Border {
        /// The face that has the edge.
        face: u32,
        /// The corner opposite the edge.
        corner: usize,
    },
    /// Several faces cover the same area.
    Covered {
        /// The number of faces.
        times: i64,
        /// A point in that area, in plan.
        near: [f64; 2],
    },
}

impl Overlap {
    /// Returns the vertices of the edge; none for covered areas.
    pub(crate) fn vertices(&self, surface: &dyn Surface) -> Vec<u32> {
        let Overlap::Border { face, corner } = *self else {
            return Vec::new();
        };
        surface
            .face(face)
            .into_iter()
            .flat_map(|corners| [corners[ccw(corner)], corners[cw(corner)]])
            .collect()
    }
}

impl std::fmt::Display for Overlap {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Overlap::Border { face, corner } => {
                write!(
                    f,
                    "face {face}, edge {corner}: meets the border of other faces between its ends"
                )
            }
            Overlap::Covered {
                times,
                near: [x, y],
            } => write!(f, "{times} faces overlap near {x} {y}"),
        }
    }
}

/// Returns the overlaps of a surface whose faces are counter-clockwise and linked: those of its
/// border; if there are none, one for each area that is covered more than once.
///
/// # Complexity
/// O(n log n) in the edges without a neighbor.
pub(crate) fn overlaps(surface: &dyn Surface) -> Vec<Overlap> {
    let sides =
        data::corners(surface).flat_map(|(face, corners)| (0..3).map(move |i| (face, corners, i)));
    let border: Vec<(u32, [u32; 3], usize)> = sides
        .filter(|&(face, _, i)| surface.neighbor(face, i).is_none())
        .collect();
    let position = |vertex: u32| {
        let [x, y, _] = surface.position(vertex);
        [unsigned_zero(x), unsigned_zero(y)]
    };
    let ends: Vec<[f64; 2]> = border
        .iter()
        .flat_map(|&(_, c, i)| [position(c[ccw(i)]), position(c[cw(i)])])
        .collect();
    let sides: Vec<[u32; 2]> = (0..border.len() as u32)
        .map(|i| [2 * i, 2 * i + 1])
        .collect();
    let Ok((t, vertices)) =
        ConstrainedDelaunay::from_lines(Plane::<Wide>::default(), &ends, &sides, OnCrossing::Split)
    else {
        return Vec::new(); // coordinates that are not finite are flaws of their own
    };
    let is_whole = |edge: &[VertexId]| {
        t.tds()
            .edge(edge[0], edge[1])
            .is_some_and(|(cell, i)| t.is_constrained(cell, i))
    };
    let broken = border
        .iter()
        .zip(vertices.chunks_exact(2))
        .filter(|(_, edge)| !is_whole(edge));
    let broken: Vec<Overlap> = broken
        .map(|(&(face, _, corner), _)| Overlap::Border { face, corner })
        .collect();
    if !broken.is_empty() {
        return broken;
    }
    covered_twice(&t, &vertices)
}

/// Returns one overlap for each area that the directed edges wind around more than once.
fn covered_twice(t: &ConstrainedDelaunay<Plane<Wide>>, edges: &[VertexId]) -> Vec<Overlap> {
    // By how much the winding number grows from the right of an edge to its left.
    let mut steps: HashMap<[VertexId; 2], i64> = HashMap::new();
    for edge in edges.chunks_exact(2) {
        *steps.entry([edge[0], edge[1]]).or_default() += 1;
        *steps.entry([edge[1], edge[0]]).or_default() -= 1;
    }
    let tds = t.tds();
    let mut winding: Vec<Option<i64>> = vec![None; tds.cell_slots()];
    let mut found = Vec::new();
    let mut open: Vec<CellId> = tds.cell_of(VertexId::INFINITE).into_iter().collect();
    open.iter()
        .for_each(|outside| winding[outside.index()] = Some(0));
    while let Some(cell) = open.pop() {
        let Some(times) = winding[cell.index()] else {
            continue;
        };
        for (i, &beyond) in tds.cell_neighbors(cell).iter().enumerate() {
            if winding[beyond.index()].is_some() {
                continue;
            }
            // From the other side, the edge has the opposite direction.
            let edge = [tds.vertex(cell, cw(i)), tds.vertex(cell, ccw(i))];
            let step = steps.get(&edge).copied().unwrap_or(0);
            winding[beyond.index()] = Some(times + step);
            open.push(beyond);
            if times + step > 1 && step > 0 {
                let corners = tds.corners(beyond).map(|v| *t.point(v));
                let near = [0, 1].map(|axis| corners.iter().map(|p| p[axis] / 3.0).sum());
                found.push(Overlap::Covered {
                    times: times + step,
                    near,
                });
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Mesh, Triangles};

    fn overlaps_of(vertices: &[[f64; 2]], faces: &[[u32; 3]]) -> Vec<String> {
        let vertices = vertices.iter().map(|&[x, y]| [x, y, 0.0]).collect();
        let triangles = Triangles {
            vertices,
            faces: faces.to_vec(),
            ..Triangles::default()
        };
        let (mesh, flaws) = Mesh::link(triangles).unwrap();
        assert_eq!(flaws, []);
        overlaps(&mesh).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn neighbors_and_islands_do_not_overlap() {
        let square = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [9.0, 0.0],
            [9.0, 9.0],
        ];
        assert!(overlaps_of(&square, &[[0, 1, 2], [0, 2, 3]]).is_empty());
        assert!(overlaps_of(&square, &[[0, 1, 2], [0, 2, 3], [4, 5, 2]]).is_empty());
        // The same edge twice, as two pairs of vertices.
        let twice = [
            square[0], square[1], square[2], square[0], square[2], square[3],
        ];
        assert!(overlaps_of(&twice, &[[0, 1, 2], [3, 4, 5]]).is_empty());
        // Around a hole.
        let ring = [
            [0.0, 0.0],
            [9.0, 0.0],
            [9.0, 9.0],
            [3.0, 1.0],
            [8.0, 1.0],
            [8.0, 6.0],
        ];
        assert!(
            overlaps_of(
                &ring,
                &[
                    [0, 1, 4],
                    [0, 4, 3],
                    [1, 2, 5],
                    [1, 5, 4],
                    [2, 0, 3],
                    [2, 3, 5]
                ]
            )
            .is_empty()
        );
        assert!(overlaps_of(&[], &[]).is_empty());
    }

    #[test]
    fn what_lies_over_something_else_is_found() {
        let crossing = [
            [0.0, 0.0],
            [4.0, 0.0],
            [0.0, 4.0],
            [1.0, -1.0],
            [5.0, 3.0],
            [1.0, 3.5],
        ];
        assert!(
            overlaps_of(&crossing, &[[0, 1, 2], [3, 4, 5]])
                .iter()
                .all(|text| text.contains("meets the border"))
        );
        assert!(!overlaps_of(&crossing, &[[0, 1, 2], [3, 4, 5]]).is_empty());
        let within = [
            [0.0, 0.0],
            [9.0, 0.0],
            [0.0, 9.0],
            [1.0, 1.0],
            [2.0, 1.0],
            [1.0, 2.0],
        ];
        let found = overlaps_of(&within, &[[0, 1, 2], [3, 4, 5]]);
        assert_eq!(found.len(), 1);
        assert!(
            found[0].starts_with("2 faces overlap near 1.3333"),
            "{found:?}"
        );
        // The same face twice, as two triples of vertices.
        let twice = [
            within[0], within[1], within[2], within[0], within[1], within[2],
        ];
        assert_eq!(overlaps_of(&twice, &[[0, 1, 2], [3, 4, 5]]).len(), 1);
        // A vertex in the middle of an edge that is not split there.
        let hanging = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0], [2.0, 0.0], [1.0, -3.0]];
        assert_eq!(overlaps_of(&hanging, &[[0, 1, 2], [0, 4, 3]]).len(), 1);
        // A fan that winds twice around its middle, all edges linked within.
        let star = [0.0f64, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0].map(|k| {
            let (sine, cosine) = (k * 1.6).sin_cos();
            [cosine * (9.0 + k), sine * (9.0 + k)]
        });
        let vertices = [vec![[0.0, 0.0]], star.to_vec()].concat();
        let fan: Vec<[u32; 3]> = (1..8).map(|k| [0, k, k + 1]).collect();
        assert!(!overlaps_of(&vertices, &fan).is_empty());
    }
}
