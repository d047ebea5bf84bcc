//! Creases of the lower of two heights: where those of two rivers are equal.

use rustc_hash::FxHashMap;

use super::Scene;
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
/// they cross get vertices there.
pub(super) fn add(scene: &Scene, strands: &mut Vec<Strand>) {
    let Some(mut sketch) = Sketch::new(scene, strands) else { return };
    let mut creases: Vec<Strand> = Vec::new();
    let cells: Vec<CellId> = sketch.triangulation.tds().cells().collect();
    for cell in cells {
        let Some(corners) = sketch.corners(cell) else { continue };
        let middle = [0, 1].map(|axis| corners.iter().map(|p| p[axis]).sum::<f64>() / 3.0);
        let here = scene.meetings.rivers_at(middle);
        for (k, &river) in here.iter().enumerate() {
            for &other in &here[..k] {
                let passages = sketch.passages(scene, cell, [river, other]);
                let [first, second] = passages.as_slice() else { continue };
                if first.at == second.at || sketch.is_along_line(cell, [first, second]) {
                    continue;
                }
                [first, second].iter().for_each(|passage| sketch.want(cell, passage, strands));
                let ends = [first.at, second.at].map(|[x, y]| [x, y, scene.height(river, [x, y])]);
                creases.push(Strand::new(river, ends));
            }
        }
    }
    strands.append(&mut creases);
}

impl Sketch {
    /// Triangulates the segments near overlaps; `None` if they span no area.
    fn new(scene: &Scene, strands: &[Strand]) -> Option<Self> {
        let zones = scene.meetings.zones(scene.waters, 2.0 * scene.width);
        let (mut points, mut lines, mut segments) = (Vec::new(), Vec::new(), Vec::new());
        for (number, strand) in strands.iter().enumerate() {
            for (segment, ends) in strand.segments() {
                if zones.find_in(Extent::of(ends), |_| Some(())).is_some() {
                    lines.push([points.len() as u32, points.len() as u32 + 1]);
                    points.extend(ends);
                    segments.push([number, segment]);
                }
            }
        }
        let built = ConstrainedDelaunay::from_lines(Terrain::default(), &points, &lines, OnCrossing::Split);
        let (triangulation, _) = built.ok()?;
        (triangulation.dimension() == 2).then(|| Sketch { triangulation, segments, heights: FxHashMap::default() })
    }

    /// The corners of a cell; `None` for those outside of the hull.
    fn corners(&self, cell: CellId) -> Option<[[f64; 3]; 3]> {
        let vertices = self.triangulation.tds().corners(cell);
        (!vertices.contains(&VertexId::INFINITE)).then(|| vertices.map(|vertex| *self.triangulation.point(vertex)))
    }

    fn height(&mut self, scene: &Scene, water: usize, vertex: VertexId) -> f64 {
        let [x, y, _] = *self.triangulation.point(vertex);
        *self.heights.entry((water, vertex)).or_insert_with(|| scene.height(water, [x, y]))
    }

    /// Where the crease between two rivers meets the border of a triangle: at two points, unless
    /// one river is lower everywhere or they are equal.
    fn passages(&mut self, scene: &Scene, cell: CellId, [river, other]: [usize; 2]) -> Vec<Passage> {
        let vertices = *self.triangulation.tds().corners(cell);
        let differences = vertices.map(|vertex| {
            let difference = self.height(scene, river, vertex) - self.height(scene, other, vertex);
            if difference.abs() <= scene.tolerance { 0.0 } else { difference }
        });
        let sites = vertices.map(|vertex| self.triangulation.point(vertex)).map(|&[x, y, _]| [x, y]);
        let mut passages = Vec::new();
        for corner in 0..3 {
            let [j, k] = [(corner + 1) % 3, (corner + 2) % 3];
            if differences[corner] == 0.0 {
                passages.push(Passage { at: sites[corner], corner, is_at_corner: true });
            }
            if differences[j] * differences[k] < 0.0 {
                // Both triangles at the edge find the same point.
                let [from, to] = if sites[j] < sites[k] { [j, k] } else { [k, j] };
                let part = differences[from] / (differences[from] - differences[to]);
                let at = [0, 1].map(|axis| sites[from][axis] + part * (sites[to][axis] - sites[from][axis]));
                passages.push(Passage { at, corner, is_at_corner: false });
            }
        }
        passages
    }

    /// Returns true if a crease runs along an edge on which a line runs already.
    fn is_along_line(&self, cell: CellId, passages: [&Passage; 2]) -> bool {
        passages.iter().all(|passage| passage.is_at_corner)
            && self.triangulation.is_constrained(cell, 3 - passages[0].corner - passages[1].corner)
    }

    /// Asks for a vertex on the lines that a crease meets.
    fn want(&self, cell: CellId, passage: &Passage, strands: &mut [Strand]) {
        let corner = passage.corner;
        let edges = if passage.is_at_corner { vec![(corner + 1) % 3, (corner + 2) % 3] } else { vec![corner] };
        for edge in edges.into_iter().filter(|&edge| self.triangulation.is_constrained(cell, edge)) {
            let [from, to] = self.triangulation.tds().edge_ends(cell, edge);
            for line in self.triangulation.lines_through(from, to) {
                let [strand, segment] = self.segments[line.index()];
                strands[strand].want(segment, passage.at);
            }
        }
    }
}
