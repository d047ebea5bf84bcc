//! The triangles that contained added vertices before a refinement, for the interpolation of
//! attributes.

use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::Plane;
use crate::triangulation::kernel::{Kernel, Orientation2, Predicate, twice_area};
use crate::triangulation::num::Bounded;
use crate::triangulation::refine::Refined;
use crate::triangulation::tds::{CellId, VertexId, ccw, cw};

/// A vertex that a refinement added, in the triangle that contained it before.
#[derive(Debug, Clone, Copy)]
pub(super) struct Between<Vertex> {
    pub(super) vertex: Vertex,
    pub(super) corners: [Vertex; 3],
    /// The barycentric weights of the corners.
    pub(super) weights: [f64; 3],
}

impl<Vertex> Between<Vertex> {
    /// Returns the same with other names of vertices.
    pub(super) fn map<Other>(self, name: impl Fn(Vertex) -> Other) -> Between<Other> {
        Between {
            vertex: name(self.vertex),
            corners: self.corners.map(&name),
            weights: self.weights,
        }
    }
}

/// The triangles of a triangulation that is about to be refined. Given vertices keep their ids and
/// positions, so that these are not copied.
pub(super) struct Before {
    /// Corners and neighbors by cell number; infinite cells are among them.
    cells: Vec<([VertexId; 3], [CellId; 3])>,
    /// A finite triangle at or near each vertex.
    near: Vec<Option<CellId>>,
}

impl Before {
    /// Copies the triangles; `None` if there are none.
    pub(super) fn of<K: Kernel>(t: &ConstrainedDelaunay<Plane<K>>) -> Option<Self> {
        if t.dimension() < 2 {
            return None;
        }
        let tds = t.tds();
        let cell = |k: usize| {
            let cell = CellId::new(k);
            (*tds.corners(cell), [0, 1, 2].map(|i| tds.neighbor(cell, i)))
        };
        let mut near = vec![None; tds.vertex_slots()];
        for cell in t.finite_cells() {
            for v in tds.corners(cell) {
                near[v.index()] = Some(cell);
            }
        }
        Some(Before {
            cells: (0..tds.cell_slots()).map(cell).collect(),
            near,
        })
    }

    /// Returns the triangle of each added vertex for which `is_asked` returns true, in order of
    /// the vertices.
    ///
    /// Each search starts at a vertex beside the added one, and mostly ends after few steps. If
    /// none of these is known, it starts where the last one ended.
    pub(super) fn between<K: Kernel>(
        mut self,
        refined: &Refined<Plane<K>>,
        is_asked: impl Fn(VertexId) -> bool,
    ) -> Vec<Between<VertexId>> {
        self.near.resize(refined.tds().vertex_slots(), None);
        let mut all = Vec::new();
        let mut last = self.near.iter().copied().flatten().next();
        for &vertex in refined.added().iter().filter(|&&v| is_asked(v)) {
            let known = |v: VertexId| self.near.get(v.index()).copied().flatten();
            let beside = refined.tds().vertices_around(vertex).find_map(known);
            let start = beside.or(last);
            let Some((cell, areas)) = start.and_then(|at| self.triangle_at(refined, at, vertex))
            else {
                continue;
            };
            last = Some(cell);
            self.near[vertex.index()] = Some(cell);
            let corners = self.cells[cell.index()].0;
            let [a, b, c] = corners.map(|v| *refined.point(v));
            let whole = area(a, b, c);
            all.push(Between {
                vertex,
                corners,
                weights: areas.map(|area| area / whole),
            });
        }
        all
    }

    /// Returns the triangle that contains a vertex, and twice the areas that the vertex spans with
    /// the edges opposite each corner. The triangle at the hull if the vertex is outside of it,
    /// which is an effect of rounding.
    fn triangle_at<K: Kernel>(
        &self,
        refined: &Refined<Plane<K>>,
        start: CellId,
        vertex: VertexId,
    ) -> Option<(CellId, [f64; 3])> {
        let p = *refined.point(vertex);
        let areas_in = |cell: CellId| {
            let corners = self.cells[cell.index()].0.map(|v| *refined.point(v));
            [0, 1, 2].map(|i| area(corners[ccw(i)], corners[cw(i)], p))
        };
        let is_finite = |cell: &CellId| !self.cells[cell.index()].0.contains(&VertexId::INFINITE);
        let mut cell = start;
        // Across constraints a walk may come back to where it was: then it is ended.
        for _ in 0..self.cells.len() {
            let areas = areas_in(cell);
            let neighbors = self.cells[cell.index()].1;
            let outward = (0..3).filter(|&i| areas[i] < 0.0);
            match outward.map(|i| neighbors[i]).find(is_finite) {
                Some(next) => cell = next,
                None => return Some((cell, areas)),
            }
        }
        let mut all = (0..self.cells.len()).map(CellId::new).filter(is_finite);
        all.find_map(|cell| {
            let areas = areas_in(cell);
            areas
                .iter()
                .all(|&area| area >= 0.0)
                .then_some((cell, areas))
        })
    }
}

/// Returns twice the area of a triangle: exact in its sign, and correct in at least 40 bits.
///
/// `PERF:` the exact area takes ten times as many instructions.
fn area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    const BITS: f64 = (1u64 << 40) as f64;
    let rough = Orientation2([a, b, c]).value(Bounded::floored_difference);
    if rough.error() * BITS < rough.value().abs() {
        rough.value()
    } else {
        twice_area(a, b, c)
    }
}
