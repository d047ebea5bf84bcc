//! Cuts of a finished surface along lines.
//!
//! The surface is cut as it is, not triangulated again. Triangles that no line meets stay; the
//! others are divided into fragments, on which the height is that of the triangle.
//!
//! ```text
//!        +                    +
//!       / \                  / \          the line crosses two triangles:
//!      /   \                / _-\         one has three fragments now,
//!   --/-----\--    ->    --+-----+--      the other two; both have the
//!    /_______\            /_______\       same new vertices
//! ```
//!
//! 0. *Far*: segments that reach far beyond the surface are divided, so that rounding does not
//!    depend on their ends.
//! 1. *Met*: a walk finds the triangles that each segment meets.
//! 2. *Snap*: these segments are snapped to each other. So a corner of one polygon that was meant
//!    to lie on the side of another one does, and a side that runs back over itself encloses
//!    nothing.
//! 3. *Patch*: the segments and the edges of the triangles are
//!    [arranged](crate::triangulation::arrangement) together: where they cross, they get a common
//!    vertex, rounded, and bend with it. This cannot reverse a fragment, and cannot open a crack,
//!    because both sides of an edge bend alike. The result is triangulated, with edges and lines as
//!    constraints.
//! 4. *Heights*: a new vertex has the height of the edge that it lies on, breaklines first, or else
//!    that of the triangle.
//! 5. *Regions*: clip lines are closed curves, which bound domains. One walk over all faces finds
//!    the domains of each. Draped lines bound nothing.
//! 6. Triangles all of whose fragments are kept become whole again, unless a draped line crosses
//!    them, or a neighbor needs a vertex on one of their sides.
//!
//! Fragments need not be Delaunay with their neighbors. The triangulation underneath does not
//! change.

mod far;
mod met;
mod order;
mod patch;
mod patched;
mod snap;
mod steps;

use crate::data::EdgeKind;
use crate::error::Result;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, VertexId};
use crate::triangulation::{ConstrainedDelaunay, Location};

use super::linear::linear;
use super::lines::kinds::LineKinds;
use super::regions::{self, Domain, Segment};
pub(super) use far::{divided, reach_of};
use patch::Patch;
pub(super) use patched::DRAPED;
use patched::{Patched, Remains};
use snap::snapped;

/// The fragments that a cut leaves of the triangles of a triangulation.
///
/// Faces and vertices of the patch are numbered after those of the triangulation.
#[derive(Debug)]
pub(super) struct SurfaceCut {
    patch: Patch,
    remains: Remains,
    first_fragment: usize,
    first_vertex: usize,
}

/// Cuts a triangulation along closed curves, given as segments, each with the domain that it
/// bounds, and along [draped](DRAPED) lines, which need not close.
///
/// A face is kept if `is_kept` returns true for the sorted domains that contain it. On return,
/// `inside` contains the triangles that stay whole; the fragments of the others are returned.
///
/// The triangulation may have only a part of a surface: the triangles that the lines meet, and
/// those around them. `reach` has the largest coordinates of the whole, without their signs.
///
/// # Errors
/// If there are more vertices than can be numbered.
///
/// # Complexity
/// Linear in the number of triangles, plus O(m log m) for m segments and triangles that they meet.
pub(super) fn cut(
    base: &ConstrainedDelaunay<Terrain>,
    kinds: &LineKinds,
    inside: &mut [bool],
    curves: &[(Domain, Segment)],
    reach: [f64; 2],
    is_kept: impl Fn(&[Domain]) -> bool,
) -> Result<Option<SurfaceCut>> {
    let curves = &snapped(base, &divided(curves, reach));
    let segments: Vec<Segment> = curves.iter().map(|(_, segment)| *segment).collect();
    let Some(patch) = Patch::new(base, kinds, &segments)? else {
        let start = base.finite_cells().next();
        let corners = start.map(|cell| base.tds().corners(cell).map(|vertex| *base.point(vertex)));
        let within = corners.map(|corners| closed_around(base, corners, curves));
        if !within.is_some_and(|within| is_kept(&within)) {
            inside.fill(false);
        }
        return Ok(None);
    };
    let patched = Patched::new(base, kinds, &patch, curves);
    let Some(start) = patched.first() else {
        inside.fill(false);
        return Ok(None);
    };
    let within = closed_around(base, patched.corners(start), &patched.drawn(curves));
    let kept = regions::label(&patched, patched.count(), start, within, is_kept);
    let remains = patched.remains(inside, &kept);
    let (first_fragment, first_vertex) = (base.tds().cell_slots(), base.tds().vertex_slots());
    Ok(Some(SurfaceCut {
        patch,
        remains,
        first_fragment,
        first_vertex,
    }))
}

/// The sorted domains that contain a triangle.
fn closed_around(
    base: &ConstrainedDelaunay<Terrain>,
    corners: [[f64; 3]; 3],
    curves: &[(Domain, Segment)],
) -> Vec<Domain> {
    let mut within = regions::domains_at(base.geometry(), corners, curves);
    within.retain(|domain| *domain != DRAPED);
    within
}

impl SurfaceCut {
    /// The number of triangles of which there are fragments.
    pub(super) fn cut_count(&self) -> usize {
        self.remains.cut
    }

    /// The triangles that the patch replaces, in order of their numbers: those that lines meet and
    /// some neighbors. Not all of them are cut.
    pub(super) fn replaced(&self) -> &[CellId] {
        &self.patch.replaced
    }

    /// Returns the ends of each edge of a triangle that is divided.
    pub(super) fn divided_edges(&self) -> impl Iterator<Item = [VertexId; 2]> + '_ {
        let is_divided = |&edge: &usize| self.patch.chain_of_edge(edge).len() > 2;
        (0..self.patch.edges.len())
            .filter(is_divided)
            .map(|edge| self.patch.edges[edge])
    }

    /// One more than the largest number of a face.
    pub(super) fn face_count(&self) -> usize {
        self.first_fragment + self.remains.is_fragment.len()
    }

    /// One more than the largest vertex number.
    pub(super) fn vertex_count(&self) -> usize {
        self.first_vertex + self.patch.vertices.len()
    }

    /// The coordinates of a vertex of the patch.
    pub(super) fn position(&self, vertex: u32) -> [f64; 3] {
        self.point(VertexId::new(vertex as usize - self.first_vertex))
    }

    fn point(&self, vertex: VertexId) -> [f64; 3] {
        let [x, y, _] = *self.patch.triangulation.point(vertex);
        [x, y, self.patch.heights[vertex.index()]]
    }

    /// The face of the patch with a number, if it is a fragment.
    fn fragment(&self, face: u32) -> Option<CellId> {
        let at = (face as usize).checked_sub(self.first_fragment)?;
        let is_fragment = *self.remains.is_fragment.get(at)?;
        is_fragment.then(|| CellId::new(at))
    }

    /// The corners of a fragment, counter-clockwise.
    pub(super) fn face(&self, face: u32) -> Option<[u32; 3]> {
        let number = |vertex: VertexId| match self.patch.vertices[vertex.index()] {
            Some(vertex) => vertex.index() as u32,
            None => (self.first_vertex + vertex.index()) as u32,
        };
        Some(
            self.patch
                .triangulation
                .tds()
                .corners(self.fragment(face)?)
                .map(number),
        )
    }

    /// The face across a side, if either of the two is a fragment.
    pub(super) fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        if let Some(fragment) = self.fragment(face) {
            let beyond = self.patch.triangulation.tds().neighbor(fragment, i);
            if self.remains.is_fragment[beyond.index()] {
                return Some((self.first_fragment + beyond.index()) as u32);
            }
        }
        self.remains.beside.get(&(face, i)).copied()
    }

    /// The kind of a side of a fragment.
    pub(super) fn edge_kind(&self, face: u32, i: usize) -> Option<EdgeKind> {
        self.fragment(face)
            .map(|fragment| self.remains.kinds[fragment.index()][i])
    }

    /// The kind of the side that a fragment across a side of a whole triangle has, if it lies on a
    /// line.
    pub(super) fn kind_beside(&self, face: u32, i: usize) -> Option<EdgeKind> {
        self.remains.lines.get(&(face, i)).copied()
    }

    /// Returns true if a draped line runs along the side of a whole triangle.
    pub(super) fn is_draped(&self, face: u32, i: usize) -> bool {
        self.remains.draped.contains(&(face, i))
    }

    /// Returns true if a clip line runs along the side of a whole triangle.
    pub(super) fn is_clipped(&self, face: u32, i: usize) -> bool {
        self.remains.clipped.contains(&(face, i))
    }

    /// Appends the fragments at a position.
    pub(super) fn faces_at(&self, [x, y]: [f64; 2], faces: &mut Vec<u32>) {
        let triangulation = &self.patch.triangulation;
        let location = triangulation.locate(&[x, y, 0.0], None);
        let Ok(cells) = location.cells(triangulation.tds());
        let fragments = cells
            .into_iter()
            .map(CellId::index)
            .filter(|&cell| self.remains.is_fragment[cell]);
        faces.extend(fragments.map(|cell| (self.first_fragment + cell) as u32));
    }

    /// The height at a position in plan, if it lies in a fragment. The position must be admitted.
    pub(super) fn elevation(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let triangulation = &self.patch.triangulation;
        let is_fragment = |cell: &CellId| self.remains.is_fragment[cell.index()];
        let location = triangulation.locate(&[x, y, 0.0], None);
        match location {
            Location::Vertex(vertex) => triangulation
                .tds()
                .around(vertex)
                .any(|cell| is_fragment(&cell))
                .then(|| self.point(vertex)[2]),
            Location::Cell { cell, .. } => {
                let beside = location
                    .facets()
                    .map(|(cell, i)| triangulation.tds().neighbor(cell, i));
                let cell = std::iter::once(cell).chain(beside).find(is_fragment)?;
                Some(linear(
                    triangulation
                        .tds()
                        .corners(cell)
                        .map(|vertex| self.point(vertex)),
                    [x, y],
                ))
            }
            Location::OutsideHull { .. } | Location::OutsideAffineHull | Location::Nowhere => None,
        }
    }
}
