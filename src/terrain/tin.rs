use std::io::Write;
use std::ops::Range;

use rayon::prelude::*;

use crate::crs::Crs;
use crate::data::{
    AT_ONCE, BaseFace, Bounds, Census, EdgeKind, Face, FaceAcross, LineEdges, Surface, across,
};
use crate::error::Result;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, Complex, VertexId, ccw, cw};
use crate::triangulation::{ConstrainedDelaunay, Flaw, Level, LineId, Location};

use super::admitted::searched;
use super::cut::SurfaceCut;
use super::linear::{linear, plan_distance};
use super::lines::kinds::LineKinds;
use super::peel::{finite_faces, lost_at_rim, peel};
use super::ridges::Contoured;
use super::rim_rule::RimRule;
use super::{LostAtRim, TinReport, compact};

/// A surface of triangles over points and breaklines.
///
/// In plan it is a constrained Delaunay triangulation, not all of whose triangles need to be part
/// of the surface: a longest edge, a boundary or bounds leave some out.
#[derive(Debug)]
pub struct Tin {
    pub(super) triangulation: ConstrainedDelaunay<Terrain>,
    /// For each cell number: true if the whole cell is part of the surface.
    pub(super) inside: Vec<bool>,
    /// The fragments of triangles that are part of the surface, if it was cut.
    pub(super) cut: Option<SurfaceCut>,
    pub(super) kinds: LineKinds,
    pub(super) report: TinReport,
    crs: Option<Crs>,
}

impl Tin {
    /// A surface of all finite faces of a triangulation.
    pub(super) fn new(
        triangulation: ConstrainedDelaunay<Terrain>,
        kinds: LineKinds,
        crs: Option<Crs>,
    ) -> Self {
        let report = TinReport::default();
        let mut tin = Tin {
            triangulation,
            inside: Vec::new(),
            cut: None,
            kinds,
            report,
            crs,
        };
        tin.include_all();
        tin
    }

    /// Makes every finite face part of the surface.
    pub(super) fn include_all(&mut self) {
        self.inside = finite_faces(&self.triangulation);
    }

    /// Returns the counts of what was given and what was built.
    pub fn report(&self) -> &TinReport {
        &self.report
    }

    /// Returns the underlying triangulation.
    ///
    /// It covers the whole convex hull, and is not cut by the boundary or the bounds.
    pub fn triangulation(&self) -> &ConstrainedDelaunay<Terrain> {
        &self.triangulation
    }

    /// Returns the kind of the edges that a line became; `None` if there is no such line. Lines are
    /// numbered in the order in which they were added to the builder.
    pub fn line_kind(&self, line: usize) -> Option<EdgeKind> {
        self.kinds.of_line(line)
    }

    /// Returns the flaws of the triangulation up to a level, found with exact predicates.
    ///
    /// If there are none at [`Level::Law`], it is a constrained Delaunay triangulation. The
    /// fragments of triangles that were cut are not part of it;
    /// [`surface_flaws`](super::surface_flaws) checks these.
    #[must_use]
    pub fn check(&self, level: Level) -> Vec<Flaw> {
        self.triangulation.check(level)
    }

    /// Returns the height at a position in plan, linear on the triangle there.
    ///
    /// `None` outside of the surface, or if a coordinate is not finite.
    ///
    /// # Complexity
    /// A walk through about as many triangles as lie in a row across the surface.
    pub fn elevation(&self, x: f64, y: f64) -> Option<f64> {
        self.elevation_near([x, y], &mut None)
    }

    /// Like [`elevation`](Self::elevation), but the walk begins at the cell `near` and leaves the
    /// one at the position there: with the same variable for positions next to each other, walks
    /// are short. The result does not depend on it.
    pub fn elevation_near(&self, q: [f64; 2], near: &mut Option<CellId>) -> Option<f64> {
        let [x, y] = searched(q);
        let location = self.triangulation.locate(&[x, y, 0.0], *near);
        *near = location.cell(&self.triangulation).or(*near);
        let in_whole = match location {
            Location::Vertex(vertex) => {
                let inside = self
                    .triangulation
                    .tds()
                    .around(vertex)
                    .any(|cell| self.inside[cell.index()]);
                inside.then(|| self.triangulation.point(vertex)[2])
            }
            Location::Cell { cell, .. } => {
                let beside = location
                    .facets()
                    .map(|(cell, i)| self.triangulation.tds().neighbor(cell, i));
                // On an edge, rounded heights of both cells may differ: one of them, however it was
                // reached.
                let either = std::iter::once(cell)
                    .chain(beside)
                    .filter(|cell| self.inside[cell.index()]);
                let cell = either.min_by_key(|cell| cell.index());
                let corners = |cell| {
                    self.triangulation
                        .tds()
                        .corners(cell)
                        .map(|v| *self.triangulation.point(v))
                };
                cell.map(|cell| linear(corners(cell), [x, y]))
            }
            Location::OutsideHull { .. } | Location::OutsideAffineHull | Location::Nowhere => None,
        };
        in_whole.or_else(|| self.cut.as_ref()?.elevation([x, y]))
    }

    /// Leaves out the faces that can be reached from outside of the hull over unconstrained edges
    /// that are open to them. Returns their number, and what is lost with the caps among them.
    pub(super) fn peel(&mut self, rule: RimRule) -> (usize, LostAtRim) {
        let peeled = peel(&self.triangulation, &mut self.inside, rule);
        let lost = lost_at_rim(&self.triangulation, &peeled, rule);
        (peeled.len(), lost)
    }

    /// Leaves out the faces with an unconstrained edge longer than `limit`, except those in water.
    /// Returns their number.
    pub(super) fn leave_out_long(&mut self, limit: f64, is_water: &[bool]) -> usize {
        let mut left_out = 0;
        for index in 0..self.inside.len() {
            if !self.inside[index] || is_water.get(index).is_some_and(|is_water| *is_water) {
                continue;
            }
            let cell = CellId::new(index);
            let corners = self
                .triangulation
                .tds()
                .corners(cell)
                .map(|v| *self.triangulation.point(v));
            let length = |i: usize| plan_distance(corners[ccw(i)], corners[cw(i)]);
            if (0..3).any(|i| length(i) > limit && !self.triangulation.is_constrained(cell, i)) {
                self.inside[index] = false;
                left_out += 1;
            }
        }
        left_out
    }

    /// The number of faces that are flat between the vertices of contours, and their share of the
    /// area. A cut does not count.
    pub(super) fn flat_share(&self) -> (usize, f64) {
        let kind_of = |line: LineId| self.kinds.of_line(line.index());
        Contoured::new(&self.triangulation, &self.inside, kind_of).flat_share()
    }

    /// The triangles that the patch of a cut replaces.
    pub(super) fn replaced(&self) -> &[CellId] {
        self.cut
            .as_ref()
            .map(SurfaceCut::replaced)
            .unwrap_or_default()
    }

    /// Counts the vertices and faces of the surface.
    pub(super) fn count(&self) -> Count {
        let Census { used, faces, .. } = self.census_without_lines();
        let old = self.triangulation.tds().vertex_slots();
        let add = |mut count: Count, (vertex, is_used): (usize, &bool)| {
            if *is_used {
                count.vertices += 1;
                count.old_vertices += usize::from(vertex < old);
                count.extent.add(self.position(vertex as u32));
            }
            count
        };
        let vertices = used.par_iter().with_min_len(AT_ONCE).enumerate();
        let of_vertices = vertices
            .fold(Count::default, add)
            .reduce(Count::default, Count::and);
        Count {
            faces,
            ..of_vertices
        }
    }

    /// The census of the surface, without the numbers of edges on lines.
    ///
    /// `PERF:` for most vertices, one cell is looked at; the faces have six corners for each.
    fn census_without_lines(&self) -> Census {
        let (mut fragments, mut of_fragments) = (Vec::new(), Vec::new());
        if self.cut.is_some() {
            self.corners_in(
                self.inside.len() as u32..self.face_count() as u32,
                &mut fragments,
            );
            of_fragments.resize(self.vertex_count(), false);
            let corners = fragments.iter().flat_map(|(_, corners)| corners);
            corners.for_each(|&vertex| of_fragments[vertex as usize] = true);
        }
        let is_used = |vertex: usize| {
            of_fragments.get(vertex).is_some_and(|is_it| *is_it)
                || self.is_in_whole(VertexId::new(vertex))
        };
        let all = (0..self.vertex_count()).into_par_iter();
        let whole = self.inside.par_iter().with_min_len(AT_ONCE);
        Census {
            used: all.with_min_len(AT_ONCE).map(is_used).collect(),
            faces: whole.filter(|inside| **inside).count() + fragments.len(),
            lines: LineEdges::default(),
        }
    }

    /// Returns true if a whole cell at a vertex is part of the surface.
    fn is_in_whole(&self, vertex: VertexId) -> bool {
        let tds = self.triangulation.tds();
        let is_inside = |cell: CellId| self.inside[cell.index()];
        let first = tds.cell_of(vertex);
        first.is_some_and(|first| is_inside(first) || tds.around(vertex).any(is_inside))
    }

    /// The kinds of the edges opposite the corners of a face.
    ///
    /// `PERF:` for most faces of a surface that is not cut, only the neighbors are looked at.
    #[inline(always)]
    fn kinds(&self, face: u32) -> [EdgeKind; 3] {
        let cell = CellId::new(face as usize);
        let is_plain = |i: usize| {
            !self.triangulation.is_constrained(cell, i)
                && self.inside[self.triangulation.tds().neighbor(cell, i).index()]
        };
        if self.cut.is_none() && is_plain(0) && is_plain(1) && is_plain(2) {
            return [EdgeKind::Plain; 3];
        }
        self.kinds_at_lines(face)
    }

    /// The kinds of the edges opposite the corners of any face.
    #[inline(never)]
    fn kinds_at_lines(&self, face: u32) -> [EdgeKind; 3] {
        if self.cut.is_some() {
            return [0, 1, 2].map(|i| self.edge_kind(face, i));
        }
        let cell = CellId::new(face as usize);
        [0, 1, 2].map(|i| {
            if let Some(kind) = self.kinds.of_edge(&self.triangulation, cell, i) {
                kind
            } else if self.inside[self.triangulation.tds().neighbor(cell, i).index()] {
                EdgeKind::Plain
            } else {
                EdgeKind::Rim
            }
        })
    }

    /// The numbers of edges of the surface that lie on lines.
    pub(super) fn count_lines(&self) -> LineEdges {
        let has_lines = |&face: &u32| {
            let cell = CellId::new(face as usize);
            self.cut.is_some() || (0..3).any(|i| self.triangulation.is_constrained(cell, i))
        };
        let add = |mut count: LineEdges, face: u32| {
            count.add(self, face, self.kinds(face));
            count
        };
        let join = |mut count: LineEdges, other: LineEdges| {
            count += other;
            count
        };
        let faces = (0..self.face_count() as u32).into_par_iter();
        faces
            .with_min_len(AT_ONCE)
            .filter(has_lines)
            .filter(|&face| self.face(face).is_some())
            .fold(LineEdges::default, add)
            .reduce(LineEdges::default, join)
    }
}

/// The vertices and faces of a surface, counted.
#[derive(Default)]
pub(super) struct Count {
    /// Vertices that belong to the triangulation.
    pub(super) old_vertices: usize,
    /// All vertices: those of the triangulation and those of the cut.
    pub(super) vertices: usize,
    pub(super) faces: usize,
    pub(super) extent: Bounds,
}

impl Count {
    /// Returns the sum of both.
    fn and(mut self, other: Self) -> Self {
        self.extent.merge(&other.extent);
        Count {
            old_vertices: self.old_vertices + other.old_vertices,
            vertices: self.vertices + other.vertices,
            faces: self.faces + other.faces,
            extent: self.extent,
        }
    }
}

impl Surface for Tin {
    fn vertex_count(&self) -> usize {
        self.cut.as_ref().map_or(
            self.triangulation.tds().vertex_slots(),
            SurfaceCut::vertex_count,
        )
    }

    #[inline(always)] // into the loops over many faces
    fn position(&self, vertex: u32) -> [f64; 3] {
        match (self.triangulation.points().get(vertex as usize), &self.cut) {
            (Some(point), _) => *point,
            (None, Some(cut)) => cut.position(vertex),
            (None, None) => panic!("vertex {vertex} of {}", self.triangulation.points().len()),
        }
    }

    fn face_count(&self) -> usize {
        self.cut
            .as_ref()
            .map_or(self.inside.len(), SurfaceCut::face_count)
    }

    #[inline(always)] // into the loops over many faces
    fn face(&self, face: u32) -> Option<[u32; 3]> {
        match self.inside.get(face as usize) {
            Some(inside) => inside.then(|| {
                self.triangulation
                    .tds()
                    .corners(CellId::new(face as usize))
                    .map(|v| v.index() as u32)
            }),
            None => self.cut.as_ref()?.face(face),
        }
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        if (face as usize) < self.inside.len() {
            let beside = self
                .triangulation
                .tds()
                .neighbor(CellId::new(face as usize), i);
            if self.inside[beside.index()] {
                return Some(beside.index() as u32);
            }
        }
        self.cut.as_ref()?.neighbor(face, i)
    }

    fn across(&self, face: u32, i: usize) -> Option<FaceAcross> {
        let tds = self.triangulation.tds();
        if (face as usize) < self.inside.len() {
            let cell = CellId::new(face as usize);
            let beyond = tds.neighbor(cell, i);
            if self.inside[beyond.index()] {
                tds.fetch_neighbors(beyond);
                let corner = tds.index_of_neighbor(beyond, cell);
                return Some(FaceAcross {
                    number: beyond.index() as u32,
                    corner,
                    apex: *self.triangulation.point(tds.vertex(beyond, corner)),
                });
            }
        }
        self.cut.as_ref()?;
        across(self, face, i)
    }

    #[inline]
    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        if let Some(kind) = self.cut.as_ref().and_then(|cut| cut.edge_kind(face, i)) {
            return kind;
        }
        // The fragment beyond knows of all lines along the edge.
        let on_line = self.cut.as_ref().and_then(|cut| cut.kind_beside(face, i));
        if let Some(kind) = on_line.or_else(|| {
            self.kinds
                .of_edge(&self.triangulation, CellId::new(face as usize), i)
        }) {
            return kind;
        }
        if self.cut.as_ref().is_some_and(|cut| cut.is_draped(face, i)) {
            return EdgeKind::Draped;
        }
        match self.neighbor(face, i) {
            Some(_) => EdgeKind::Plain,
            None if self.cut.as_ref().is_some_and(|cut| cut.is_clipped(face, i)) => EdgeKind::Clip,
            None => EdgeKind::Rim,
        }
    }

    fn has_lines(&self) -> bool {
        self.report.breaklines > 0 || self.cut.is_some()
    }

    fn is_fragment(&self, face: u32) -> bool {
        face as usize >= self.inside.len()
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }

    fn census(&self) -> Census {
        let mut census = self.census_without_lines();
        if self.has_lines() {
            census.lines = self.count_lines();
        }
        census
    }

    fn write_tin(&self, out: &mut dyn Write) -> Result<()> {
        compact::write(self, &self.triangulation, &self.kinds, out)
    }

    fn faces_in(&self, numbers: Range<u32>, faces: &mut Vec<Face>) {
        faces.extend(numbers.filter_map(|number| {
            let corners = self.face(number)?;
            Some(Face {
                number,
                corners,
                edges: self.kinds(number),
            })
        }));
    }

    fn faces_at(&self, q: [f64; 2], near: &mut Option<u32>, faces: &mut Vec<u32>) -> bool {
        let start = near.map(|cell| CellId::new(cell as usize));
        let location = self.triangulation.locate(&[q[0], q[1], 0.0], start);
        let tds = self.triangulation.tds();
        if let Some(cell) = location.cell(&self.triangulation) {
            *near = Some(cell.index() as u32);
        }
        // True if there may be fragments at the position.
        let mut is_open = false;
        let mut add = |cell: CellId| match self.inside[cell.index()] {
            true => faces.push(cell.index() as u32),
            false => is_open = true,
        };
        match location {
            Location::Vertex(vertex) => tds.around(vertex).for_each(add),
            Location::Cell { cell, .. } => {
                add(cell);
                location
                    .facets()
                    .for_each(|(cell, i)| add(tds.neighbor(cell, i)));
            }
            Location::OutsideHull { .. } | Location::OutsideAffineHull | Location::Nowhere => {
                is_open = true;
            }
        }
        if let Some(cut) = self.cut.as_ref().filter(|_| is_open) {
            cut.faces_at(q, faces);
        }
        true
    }

    fn base_count(&self) -> usize {
        self.inside.len()
    }

    /// The faces of the triangulation, which covers the whole convex hull.
    fn base_faces_in(&self, numbers: Range<u32>, faces: &mut Vec<BaseFace>) {
        let tds = self.triangulation.tds();
        let is_face = |cell: CellId| tds.is_used(cell) && !tds.is_infinite(cell);
        faces.extend(
            numbers
                .map(|number| CellId::new(number as usize))
                .filter(|&cell| is_face(cell))
                .map(|cell| {
                    let beside = |i| Some(tds.neighbor(cell, i)).filter(|&beside| is_face(beside));
                    let kind = |i| match self.kinds.of_edge(&self.triangulation, cell, i) {
                        Some(kind) => kind,
                        None if beside(i).is_none() => EdgeKind::Rim,
                        None => EdgeKind::Plain,
                    };
                    BaseFace {
                        number: cell.index() as u32,
                        corners: tds.corners(cell).map(|v| v.index() as u32),
                        neighbors: [0, 1, 2].map(|i| beside(i).map(|beside| beside.index() as u32)),
                        edges: [0, 1, 2].map(kind),
                    }
                }),
        );
    }
}
