//! All faces in constant memory: no face is marked as visited.
//!
//! Seen from a vertex `p`, each face that does not have it has an *entry*: the edge with the face's point nearest to
//! `p`, which is one of the edges that have `p` on their outer side. Where that point is a corner of two such edges,
//! either one will do, but always the same. Going back over the entries leads to one of the faces around `p`:
//! - beyond the entry the nearest point is nearer, unless it is the same corner `v`;
//! - in this case the path turns around `v` in one direction, from behind `v` as `p` sees it towards `p`, where faces
//!   are nearer.
//!
//! Nor does it leave the hull, which is convex and has `p` within. So the faces are a forest over those around `p`,
//! and its order and the path back up are found from the geometry (de Berg, van Oostrum and Overmars 1996). It takes
//! any triangulation, not those of a law only; all comparisons are exact.

use crate::geometry::Coordinates;
use crate::kernel::{DotProduct, Kernel, Orientation2, Wide};
use crate::num::Sign;
use crate::tds::{CellId, Complex, Star, VertexId, ccw, cw};

use super::super::Triangulation;
use super::super::engine::embedded::Embedded;
use super::site;

impl<G: Coordinates<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// All finite faces, each once: of each face around a vertex, counter-clockwise, first itself and then what lies
    /// behind it as the vertex sees it. No visited set is kept. Empty below dimension
    /// 2, or if there is no such vertex.
    ///
    /// # Complexity
    /// Constant memory; constant time for a face, on average.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Plane, Delaunay};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [5.0, 3.0], [1.0, 4.0], [2.0, 2.0]];
    /// let (t, v) = Delaunay::from_points(Plane::new(), &points)?;
    /// assert_eq!(t.faces_from(v[0]).count(), 4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn faces_from(&self, start: VertexId) -> impl Iterator<Item = CellId> + '_ {
        let Ok(faces) = faces_from(self, start);
        faces.map(|Ok(cell)| cell)
    }
}

/// Returns all finite faces, each once, from those around a vertex on, and keeps no visited set: see
/// [`Triangulation::faces_from`]. Empty below dimension 2, or if there is no such vertex. Ends at the first error.
///
/// # Errors
/// If a link does not hold.
///
/// # Complexity
/// Constant memory; constant time for a face, on average.
pub fn faces_from<'t, T: Embedded<3, Geometry: Coordinates<3>>>(
    t: &'t T,
    start: VertexId,
) -> Result<impl Iterator<Item = Result<CellId, T::Error>> + use<'t, T>, T::Error> {
    let is_vertex = start != VertexId::INFINITE && t.complex().cell_of(start)?.is_some();
    let faces = is_vertex.then(|| Faces::new(t, start)).transpose()?;
    Ok(faces.into_iter().flatten())
}

/// The finite faces of a triangulation.
struct Faces<'t, T: Embedded<3>> {
    t: &'t T,
    start: VertexId,
    site: [f64; 2],
    /// Those around the start that have not been returned; `None` after an error.
    roots: Option<Star<'t, T::Complex>>,
    /// The face that was returned last.
    at: Option<CellId>,
    /// Each face is come to and left again once: if there are more steps, links lead astray.
    steps: usize,
}

impl<'t, T: Embedded<3, Geometry: Coordinates<3>>> Faces<'t, T> {
    /// From those around a vertex on.
    fn new(t: &'t T, start: VertexId) -> Result<Self, T::Error> {
        let roots = Some(Star::new(t.complex(), start, 2)?);
        Ok(Faces { t, start, site: site(t, start)?, roots, at: None, steps: 0 })
    }

    /// The index of the edge by which a face is entered; `None` for those around the start.
    fn entry(&self, cell: CellId) -> Result<Option<usize>, T::Error> {
        let complex = self.t.complex();
        let corners @ [a, b, c] = complex.corners(cell)?;
        if corners.contains(&self.start) {
            return Ok(None);
        }
        let corners = [site(self.t, a)?, site(self.t, b)?, site(self.t, c)?];
        let is_seen =
            |&i: &usize| Wide::sign(&Orientation2([corners[ccw(i)], corners[cw(i)], self.site])) == Sign::Negative;
        let mut seen = (0..3).filter(is_seen);
        let (first, second) = (seen.next(), seen.next());
        // A face that is flat, or turned around, or that lies over the start.
        complex.ensure(cell, || first.is_some() && seen.next().is_none())?;
        let (Some(i), Some(j)) = (first, second) else {
            return Ok(first);
        };
        // The edge opposite `i` runs from the common corner to corner `j`.
        let common = 3 - i - j;
        let falls_on = |to: usize| Wide::sign(&DotProduct([self.site, corners[common], corners[to]])) == Sign::Positive;
        Ok(Some(if falls_on(j) {
            i
        } else if falls_on(i) {
            j
        } else {
            ccw(common)
        }))
    }

    /// The faces that may be entered from this one, by their edges in order.
    fn exits(&self, cell: CellId, entry: Option<usize>) -> Result<[usize; 2], T::Error> {
        Ok(match entry {
            Some(entry) => [ccw(entry), cw(entry)],
            None => [self.t.complex().index_of(cell, self.start)?.unwrap_or(0); 2],
        })
    }

    /// The face that is entered over this edge, if there is one.
    fn child(&self, cell: CellId, i: usize) -> Result<Option<CellId>, T::Error> {
        let complex = self.t.complex();
        let beyond = complex.neighbor(cell, i)?;
        if complex.is_infinite(beyond)? {
            return Ok(None);
        }
        let is_entered = self.entry(beyond)? == Some(complex.index_of_neighbor(beyond, cell)?);
        Ok(is_entered.then_some(beyond))
    }

    /// The next face in the tree with this one: a child of it, or else of those above.
    fn after(&mut self, mut cell: CellId) -> Result<Option<CellId>, T::Error> {
        let complex = self.t.complex();
        let mut returned_over = None;
        loop {
            self.steps += 1;
            complex.ensure(cell, || self.steps <= 2 * complex.cell_slots())?;
            let entry = self.entry(cell)?;
            let [first, second] = self.exits(cell, entry)?;
            if returned_over.is_none()
                && let Some(child) = self.child(cell, first)?
            {
                return Ok(Some(child));
            }
            if returned_over != Some(second)
                && second != first
                && let Some(child) = self.child(cell, second)?
            {
                return Ok(Some(child));
            }
            let Some(entry) = entry else {
                return Ok(None);
            };
            let parent = complex.neighbor(cell, entry)?;
            returned_over = Some(complex.index_of_neighbor(parent, cell)?);
            cell = parent;
        }
    }

    fn root(&mut self) -> Result<Option<CellId>, T::Error> {
        for corner in self.roots.iter_mut().flatten() {
            let (cell, _) = corner?;
            if !self.t.complex().is_infinite(cell)? {
                return Ok(Some(cell));
            }
        }
        Ok(None)
    }

    fn step(&mut self) -> Result<Option<CellId>, T::Error> {
        let next = match self.at {
            Some(cell) => self.after(cell)?,
            None => None,
        };
        if next.is_some() { Ok(next) } else { self.root() }
    }
}

impl<T: Embedded<3, Geometry: Coordinates<3>>> Iterator for Faces<'_, T> {
    type Item = Result<CellId, T::Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let step = self.step();
        match step {
            Ok(next) => self.at = next,
            Err(_) => (self.at, self.roots) = (None, None),
        }
        step.transpose()
    }
}
