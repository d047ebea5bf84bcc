//! Creases of the lower of two heights: where those of two rivers are equal.

use std::collections::BTreeSet;

use rustc_hash::FxHashMap;

use super::scene::{Body, Scene};
use super::strand::Strand;
use crate::terrain::boxes::Extent;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, VertexId};
use crate::triangulation::{ConstrainedDelaunay, OnCrossing};

/// The lines near overlaps, triangulated: each triangle lies in one triangle of each river.
struct Sketch {
    triangulation: ConstrainedDelaunay<Terrain>,
    /// For each line of the triangulation, the segment of a strand that it is.
    segments: Vec<[usize; 2]>,
    heights: FxHashMap<(usize, VertexId), f64>,
}

/// Where a crease enters or leaves a triangle.
#[derive(Debug, Clone, Copy)]
struct Passage {
    at: [f64; 2],
    /// The corner opposite the edge that it passes, or the corner that it passes.
    corner: usize,
    is_at_corner: bool,
}

/// Adds the lines along which two rivers have the same height within their overlap. The lines that
/// they cross get vertices there; so do banks that two rivers share, where both are equally high.
pub(super) fn add(scene: &Scene, strands: &mut Vec<Strand>) {
    let Some(mut sketch) = Sketch::new(scene, strands) else {
        return;
    };
    let mut creases: Vec<Strand> = Vec::new();
    let cells: Vec<CellId> = sketch.triangulation.tds().cells().collect();
    for cell in cells {
        let Some(corners) = sketch.corners(cell) else {
            continue;
        };
        let middle = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).sum::<f64>() / 3.0);
        // A triangle without width lies along a bank, and in several triangles of a river.
        let here = if is_thin(corners, scene.rounding) {
            Vec::new()
        } else {
            scene.meetings.rivers_at(middle)
        };
        for (k, &river) in here.iter().enumerate() {
            for &other in &here[..k] {
                let passages = sketch.passages(scene, cell, [river, other]);
                let [first, second] = passages.as_slice() else {
                    continue;
                };
                if first.at == second.at || sketch.is_along_line(cell, [first, second]) {
                    continue;
                }
                [first, second]
                    .iter()
                    .for_each(|passage| sketch.want(cell, passage, strands));
                let ends = [first.at, second.at].map(|[x, y]| [x, y, scene.height(river, [x, y])]);
                creases.push(Strand::new(river, ends));
            }
        }
        (0..3).for_each(|edge| sketch.want_on_bank(scene, cell, edge, strands));
    }
    strands.append(&mut creases);
}

/// Returns true if the width of a triangle is at most a distance.
fn is_thin(corners: [[f64; 3]; 3], distance: f64) -> bool {
    let side = |k: usize| [0, 1].map(|axis| corners[(k + 1) % 3][axis] - corners[k][axis]);
    let [first, second, third] = [side(0), side(1), side(2)];
    let longest = [first, second, third]
        .map(|[x, y]| x.hypot(y))
        .into_iter()
        .fold(0.0, f64::max);
    (first[0] * second[1] - first[1] * second[0]).abs() <= distance * longest
}

impl Sketch {
    /// Triangulates the segments near overlaps; `None` if they span no area.
    fn new(scene: &Scene, strands: &[Strand]) -> Option<Self> {
        let zones = scene.meetings.zones(scene.waters, 2.0 * scene.width);
        let (mut points, mut lines, mut segments) = (Vec::new(), Vec::new(), Vec::new());
        let is_of_river =
            |strand: &Strand| matches!(scene.bodies[strand.water], Some(Body::River(_)));
        for (number, strand) in strands
            .iter()
            .enumerate()
            .filter(|(_, strand)| is_of_river(strand))
        {
            for (segment, ends) in strand.segments() {
                if zones.find_in(Extent::of(ends), |_| Some(())).is_some() {
                    lines.push([points.len() as u32, points.len() as u32 + 1]);
                    points.extend(ends);
                    segments.push([number, segment]);
                }
            }
        }
        let built =
            ConstrainedDelaunay::from_lines(Terrain::default(), &points, &lines, OnCrossing::Split);
        let (triangulation, _) = built.ok()?;
        (triangulation.dimension() == 2).then(|| Sketch {
            triangulation,
            segments,
            heights: FxHashMap::default(),
        })
    }

    /// The corners of a cell; `None` for those outside of the hull.
    fn corners(&self, cell: CellId) -> Option<[[f64; 3]; 3]> {
        let vertices = self.triangulation.tds().corners(cell);
        (!vertices.contains(&VertexId::INFINITE))
            .then(|| vertices.map(|vertex| *self.triangulation.point(vertex)))
    }

    fn height(&mut self, scene: &Scene, water: usize, vertex: VertexId) -> f64 {
        let [x, y, _] = *self.triangulation.point(vertex);
        *self
            .heights
            .entry((water, vertex))
            .or_insert_with(|| scene.height(water, [x, y]))
    }

    /// How much higher one river is than another at a vertex; 0 if it is rounding.
    fn difference(&mut self, scene: &Scene, vertex: VertexId, [river, other]: [usize; 2]) -> f64 {
        let difference = self.height(scene, river, vertex) - self.height(scene, other, vertex);
        if difference.abs() <= scene.tolerance {
            0.0
        } else {
            difference
        }
    }

    fn site(&self, vertex: VertexId) -> [f64; 2] {
        let [x, y, _] = *self.triangulation.point(vertex);
        [x, y]
    }

    /// Returns the position between the ends of an edge at which two rivers are equally high;
    /// `None` if one of them is not lower at either end. Both sides of the edge get the same bits.
    fn crossing(
        &mut self,
        scene: &Scene,
        edge: [VertexId; 2],
        pair: [usize; 2],
    ) -> Option<[f64; 2]> {
        let mut ends = edge.map(|vertex| (self.site(vertex), self.difference(scene, vertex, pair)));
        ends.sort_by(|(p, _), (q, _)| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
        let [(from, before), (to, after)] = ends;
        let part = before / (before - after);
        (before * after < 0.0)
            .then(|| [0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis])))
    }

    /// Where the crease between two rivers meets the border of a triangle: at two points, unless
    /// one river is lower everywhere or they are equal.
    fn passages(&mut self, scene: &Scene, cell: CellId, pair: [usize; 2]) -> Vec<Passage> {
        let vertices = *self.triangulation.tds().corners(cell);
        let mut passages = Vec::new();
        for (corner, &vertex) in vertices.iter().enumerate() {
            if self.difference(scene, vertex, pair) == 0.0 {
                passages.push(Passage {
                    at: self.site(vertex),
                    corner,
                    is_at_corner: true,
                });
            }
            let edge = [vertices[(corner + 1) % 3], vertices[(corner + 2) % 3]];
            if let Some(at) = self.crossing(scene, edge, pair) {
                passages.push(Passage {
                    at,
                    corner,
                    is_at_corner: false,
                });
            }
        }
        passages
    }

    /// Asks for a vertex where two rivers that share a bank are equally high: there the lower one
    /// becomes the higher one.
    fn want_on_bank(&mut self, scene: &Scene, cell: CellId, edge: usize, strands: &mut [Strand]) {
        if !self.triangulation.is_constrained(cell, edge) {
            return;
        }
        let [from, to] = self.triangulation.tds().edge_ends(cell, edge);
        let lines = self.triangulation.lines_through(from, to);
        let segments: Vec<[usize; 2]> = lines
            .into_iter()
            .map(|line| self.segments[line.index()])
            .collect();
        let here: BTreeSet<usize> = segments
            .iter()
            .map(|[strand, _]| strands[*strand].water)
            .collect();
        for &river in &here {
            for &other in here
                .range(..river)
                .filter(|other| scene.meetings.pairs.contains(&[river, **other]))
            {
                let Some(at) = self.crossing(scene, [from, to], [river, other]) else {
                    continue;
                };
                segments
                    .iter()
                    .for_each(|&[strand, segment]| strands[strand].want(segment, at));
            }
        }
    }

    /// Returns true if a crease runs along an edge on which a line runs already.
    fn is_along_line(&self, cell: CellId, passages: [&Passage; 2]) -> bool {
        passages.iter().all(|passage| passage.is_at_corner)
            && self
                .triangulation
                .is_constrained(cell, 3 - passages[0].corner - passages[1].corner)
    }

    /// Asks for a vertex on the lines that a crease meets.
    fn want(&self, cell: CellId, passage: &Passage, strands: &mut [Strand]) {
        let corner = passage.corner;
        let edges = if passage.is_at_corner {
            vec![(corner + 1) % 3, (corner + 2) % 3]
        } else {
            vec![corner]
        };
        for edge in edges
            .into_iter()
            .filter(|&edge| self.triangulation.is_constrained(cell, edge))
        {
            let [from, to] = self.triangulation.tds().edge_ends(cell, edge);
            for line in self.triangulation.lines_through(from, to) {
                let [strand, segment] = self.segments[line.index()];
                strands[strand].want(segment, passage.at);
            }
        }
    }
}
