//! The triangles that lines meet, triangulated again together with the lines.

use std::collections::HashMap;

use rustc_hash::{FxHashMap, FxHashSet};

use crate::error::{Error, Result};
use crate::triangulation::arrangement::Arrangement;
use crate::triangulation::geometry::{Crossing, Geometry, Terrain, height_along};
use crate::triangulation::tds::{CellId, VertexId};
use crate::triangulation::{ConstrainedDelaunay, LineId, OnCrossing};

use super::met::met;
use super::order::{compare, corners};
use super::steps::Arranged;
use crate::terrain::linear::linear;
use crate::terrain::lines::kinds::LineKinds;
use crate::terrain::regions::Segment;

/// The part of a triangulation that lines meet, divided so that the lines cross no face.
///
/// It is a separate constrained triangulation. Its points are the corners of the triangles that are
/// met, the ends of the lines, and the crossings of lines and edges. Its constraints are the lines
/// and the edges of these triangles. So each of its faces is a fragment of one triangle, or lies
/// outside of all of them.
#[derive(Debug)]
pub(super) struct Patch {
    pub(super) triangulation: ConstrainedDelaunay<Terrain>,
    /// The triangles that the patch replaces, in order of their numbers.
    pub(super) replaced: Vec<CellId>,
    /// For each vertex of the patch, the vertex of the surface at the same point, if there is one.
    pub(super) vertices: Vec<Option<VertexId>>,
    /// For each face of the patch, the triangle of which it is a fragment, if any.
    pub(super) cells: Vec<Option<CellId>>,
    /// The heights of the vertices; NaN for vertices outside of all triangles that are met.
    pub(super) heights: Vec<f64>,
    /// The edges of the triangles that are met, from the smaller vertex to the larger. Their lines
    /// in the triangulation start at [`first_edge`](Self::first_edge).
    pub(super) edges: Vec<[VertexId; 2]>,
    first_edge: usize,
    /// For each given segment, its line in the triangulation, if it meets a triangle.
    pub(super) segments: Vec<Option<LineId>>,
}

/// A segment to arrange, as indices of points.
type Ends = [u32; 2];

/// The input of the arrangement: the edges of some triangles, and the segments that meet them.
struct Drawing {
    /// The corners of the triangles, in order, followed by the other ends of segments.
    points: Vec<[f64; 3]>,
    corners: Vec<VertexId>,
    /// The segments that meet triangles, followed by the edges, each once.
    lines: Vec<Ends>,
    first_edge: usize,
    edges: Vec<[VertexId; 2]>,
    segments: Vec<Option<u32>>,
}

impl Drawing {
    fn new(
        base: &ConstrainedDelaunay<Terrain>,
        cells: &FxHashSet<CellId>,
        segments: &[Segment],
        is_met: &[bool],
    ) -> Self {
        let tds = base.tds();
        let mut corners: Vec<VertexId> =
            cells.iter().flat_map(|&cell| *tds.corners(cell)).collect();
        // By position, so that results do not depend on the numbering of the vertices.
        corners.sort_unstable_by(|&u, &v| base.geometry().compare(base.point(u), base.point(v)));
        corners.dedup();
        let mut points: Vec<[f64; 3]> = corners.iter().map(|&vertex| *base.point(vertex)).collect();
        let key = |x: f64, y: f64| [x.to_bits(), y.to_bits()];
        let mut at: HashMap<[u64; 2], u32> = points
            .iter()
            .zip(0..)
            .map(|(p, i)| (key(p[0], p[1]), i))
            .collect();
        let mut number: FxHashMap<Ends, u32> = FxHashMap::default();
        let mut lines: Vec<Ends> = Vec::new();
        let mut drawn = vec![None; segments.len()];
        for (i, segment) in segments.iter().enumerate().filter(|&(i, _)| is_met[i]) {
            let [a, b] = segment.map(|[x, y]| {
                *at.entry(key(x, y)).or_insert_with(|| {
                    points.push([x, y, f64::NAN]);
                    points.len() as u32 - 1
                })
            });
            let next = lines.len() as u32;
            drawn[i] = Some(*number.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                lines.push([a.min(b), a.max(b)]);
                next
            }));
        }
        let first_edge = lines.len();
        let position: FxHashMap<VertexId, u32> = corners.iter().copied().zip(0..).collect();
        let mut edges: Vec<[VertexId; 2]> = Vec::new();
        for &cell in cells {
            let [u, v, w] = *tds.corners(cell);
            edges.extend([[u, v], [v, w], [w, u]].map(|[p, q]| [p.min(q), p.max(q)]));
        }
        edges.sort_unstable();
        edges.dedup();
        lines.extend(
            edges
                .iter()
                .map(|edge| edge.map(|vertex| position[&vertex])),
        );
        Drawing {
            points,
            corners,
            lines,
            first_edge,
            edges,
            segments: drawn,
        }
    }

    /// Arranges the lines. Returns the arrangement and the segment in it of each line.
    ///
    /// Cut lines pass through all points that they come near, so that spikes and gaps narrower than
    /// the rounding vanish. An edge that is also a cut line is arranged once.
    fn arrange(&self, step: f64) -> (Arrangement, Vec<u32>) {
        let site = |i: u32| [self.points[i as usize][0], self.points[i as usize][1]];
        let cut: FxHashMap<Ends, u32> = self.lines[..self.first_edge]
            .iter()
            .copied()
            .zip(0..)
            .collect();
        let mut distinct = self.lines[..self.first_edge].to_vec();
        let mut at: Vec<u32> = (0..self.first_edge as u32).collect();
        for line in &self.lines[self.first_edge..] {
            at.push(cut.get(line).copied().unwrap_or(distinct.len() as u32));
            if at.last() == Some(&(distinct.len() as u32)) {
                distinct.push(*line);
            }
        }
        let arrangement =
            Arrangement::with_snapped(self.points.len(), site, &distinct, self.first_edge, step)
                .crossing_free(site, &distinct, step);
        (arrangement, at)
    }
}

impl Patch {
    /// The patch of the triangles that some segments meet; `None` if they meet none.
    ///
    /// # Errors
    /// If there are more points than can be numbered.
    pub(super) fn new(
        base: &ConstrainedDelaunay<Terrain>,
        kinds: &LineKinds,
        segments: &[Segment],
    ) -> Result<Option<Self>> {
        let mut cells: FxHashSet<CellId> = FxHashSet::default();
        let mut is_met = vec![false; segments.len()];
        for (of_segment, is_met) in met(base, segments.iter().copied()).zip(&mut is_met) {
            *is_met = !of_segment.is_empty();
            cells.extend(of_segment);
        }
        if cells.is_empty() {
            return Ok(None);
        }
        // If an edge is divided, the triangles on both of its sides belong to the patch.
        loop {
            let drawing = Drawing::new(base, &cells, segments, &is_met);
            let patch = Self::triangulated(base, kinds, &cells, drawing)?;
            let divided =
                (0..patch.edges.len()).filter(|&edge| patch.chain_of_edge(edge).len() > 2);
            let beside = divided.map(|edge| patch.edges[edge]);
            let beside = beside.flat_map(|[u, v]| [base.tds().edge(u, v), base.tds().edge(v, u)]);
            let beside = beside
                .flatten()
                .map(|(cell, _)| cell)
                .filter(|&cell| !base.tds().is_infinite(cell));
            let before = cells.len();
            cells.extend(beside);
            if cells.len() == before {
                return Ok(Some(patch));
            }
        }
    }

    fn triangulated(
        base: &ConstrainedDelaunay<Terrain>,
        kinds: &LineKinds,
        cells: &FxHashSet<CellId>,
        drawing: Drawing,
    ) -> Result<Self> {
        let (arrangement, at) = drawing.arrange(base.geometry().step());
        let Drawing {
            mut points,
            corners,
            lines,
            first_edge,
            edges,
            segments,
        } = drawing;
        points.extend(arrangement.added().iter().map(|&[x, y]| [x, y, f64::NAN]));
        let chains = lines.iter().zip(at).map(|(&[a, b], at)| {
            let between = arrangement.chain(at).iter().copied();
            std::iter::once(a).chain(between).chain([b]).collect()
        });
        let chains: Vec<Vec<u32>> = chains.collect();
        let unit = arrangement.unit();
        let mut arranged = Arranged {
            base,
            kinds,
            corners: &corners,
            edges: &edges,
            unit,
            points,
            chains,
        };
        arranged.separate();
        let Arranged { points, chains, .. } = arranged;
        let (triangulation, numbers) = ConstrainedDelaunay::from_lines(
            Terrain::default(),
            &points,
            &chains,
            OnCrossing::Split,
        )
        .map_err(|error| Error::limit(error.to_string()))?;
        let mut vertices = vec![None; triangulation.tds().vertex_slots()];
        for (corner, number) in corners.iter().zip(&numbers) {
            vertices[number.index()] = Some(*corner);
        }
        let mut replaced: Vec<CellId> = cells.iter().copied().collect();
        replaced.sort_unstable();
        let mut patch = Patch {
            replaced,
            cells: Vec::new(),
            heights: Vec::new(),
            segments: segments
                .into_iter()
                .map(|line| Some(LineId::new(line? as usize)))
                .collect(),
            triangulation,
            vertices,
            edges,
            first_edge,
        };
        patch.cells = patch.find_cells(base, cells);
        patch.heights = patch.find_heights(base, kinds);
        Ok(patch)
    }

    /// The number of lines of the triangulation that are cut lines; the edges follow them.
    pub(super) fn first_edge(&self) -> usize {
        self.first_edge
    }

    /// The vertices of an edge of the surface in the patch, in order.
    pub(super) fn chain_of_edge(&self, edge: usize) -> Vec<VertexId> {
        self.triangulation
            .chain(LineId::new(self.first_edge + edge))
    }

    /// The edges of the surface that run along an edge of the patch, as indices.
    pub(super) fn edges_along(&self, [p, q]: [VertexId; 2]) -> impl Iterator<Item = usize> + '_ {
        self.triangulation
            .lines_through(p, q)
            .filter_map(|line| line.index().checked_sub(self.first_edge))
    }

    /// Returns true if a cut line runs along an edge of the patch.
    pub(super) fn is_cut_along(&self, [p, q]: [VertexId; 2]) -> bool {
        self.triangulation
            .lines_through(p, q)
            .next()
            .is_some_and(|line| line.index() < self.first_edge)
    }

    /// For each face, the triangle of which it is a fragment.
    ///
    /// Next to the chain of an edge, this is the triangle at the edge. From there it is propagated
    /// to neighbors, but not across such chains.
    fn find_cells(
        &self,
        base: &ConstrainedDelaunay<Terrain>,
        cells: &FxHashSet<CellId>,
    ) -> Vec<Option<CellId>> {
        let tds = self.triangulation.tds();
        // The triangle on the left of each edge of the patch. Triangles that have collapsed onto an
        // edge are listed as well, on both of its sides.
        let mut left: Vec<([VertexId; 2], CellId)> = Vec::new();
        for (edge, &[u, v]) in self.edges.iter().enumerate() {
            let sides = [base.tds().edge(u, v), base.tds().edge(v, u)];
            for pair in self.chain_of_edge(edge).windows(2) {
                let both = [[pair[0], pair[1]], [pair[1], pair[0]]];
                left.extend(
                    both.into_iter()
                        .zip(sides)
                        .filter_map(|(edge, side)| Some((edge, side?.0))),
                );
            }
        }
        // By position, so that results do not depend on the numbering of the triangles.
        left.sort_unstable_by(|a, b| a.0.cmp(&b.0).then_with(|| compare(base, a.1, b.1)));
        let all_left = |[p, q]: [VertexId; 2]| {
            let from = left.partition_point(|(edge, _)| *edge < [p, q]);
            let count = left[from..].partition_point(|(edge, _)| *edge == [p, q]);
            &left[from..from + count]
        };
        let mut found = vec![None; tds.cell_slots()];
        let mut is_known = vec![false; tds.cell_slots()];
        let mut ahead = Vec::new();
        for [p, q] in left.chunk_by(|a, b| a.0 == b.0).map(|same| same[0].0) {
            let others = all_left([q, p]);
            let standing = all_left([p, q])
                .iter()
                .find(|(_, cell)| others.iter().all(|(_, other)| other != cell));
            let (Some((_, cell)), Some((face, _))) = (standing, tds.edge(p, q)) else {
                continue;
            };
            if !std::mem::replace(&mut is_known[face.index()], true) {
                found[face.index()] = Some(*cell).filter(|cell| cells.contains(cell));
                ahead.push(face);
            }
        }
        while let Some(face) = ahead.pop() {
            for i in 0..3 {
                let beside = tds.neighbor(face, i);
                let is_border = || self.edges_along(tds.edge_ends(face, i)).next().is_some();
                if is_known[beside.index()]
                    || self.triangulation.is_constrained(face, i) && is_border()
                {
                    continue;
                }
                is_known[beside.index()] = true;
                found[beside.index()] = found[face.index()];
                ahead.push(beside);
            }
        }
        let is_face = |face: usize| !tds.is_infinite(CellId::new(face));
        (0..found.len())
            .map(|face| found[face].filter(|_| is_face(face)))
            .collect()
    }

    /// The heights of the vertices.
    ///
    /// A vertex of the surface keeps its height. One on an edge has the height of the edge, one in
    /// a triangle that of its plane. If several edges are so close that they share a vertex,
    /// breaklines precede other edges, level ones precede those with a slope (a shore stays level
    /// where a line crosses it), and then the lowest is used.
    fn find_heights(&self, base: &ConstrainedDelaunay<Terrain>, kinds: &LineKinds) -> Vec<f64> {
        let slots = self.triangulation.tds().vertex_slots();
        let mut on_edges: Vec<Option<(bool, bool, f64)>> = vec![None; slots];
        for (edge, &[u, v]) in self.edges.iter().enumerate() {
            let is_plain = kinds.between(base, [u, v]).is_none();
            let has_slope = base.point(u)[2] != base.point(v)[2];
            let chain = self.chain_of_edge(edge);
            for &vertex in chain.iter().skip(1).rev().skip(1) {
                let [x, y, _] = *self.triangulation.point(vertex);
                let here = (
                    is_plain,
                    has_slope,
                    height_along(*base.point(u), *base.point(v), [x, y]),
                );
                let known = on_edges[vertex.index()].get_or_insert(here);
                if here < *known {
                    *known = here;
                }
            }
        }
        let height = |slot: usize| {
            let vertex = VertexId::new(slot);
            if let Some(corner) = self.vertices[slot] {
                return base.point(corner)[2];
            }
            if let Some((.., height)) = on_edges[slot] {
                return height;
            }
            if !self.triangulation.tds().is_vertex(vertex) {
                return f64::NAN;
            }
            let within = self
                .triangulation
                .tds()
                .around(vertex)
                .find_map(|face| self.cells[face.index()]);
            let [x, y, _] = *self.triangulation.point(vertex);
            within.map_or(f64::NAN, |cell| linear(corners(base, cell), [x, y]))
        };
        (0..slots).map(height).collect()
    }
}
