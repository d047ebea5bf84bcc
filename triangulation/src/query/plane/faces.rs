//! Iterates over all faces in constant memory: no face is marked as visited.
//!
//! Seen from a vertex `p`, each face that does not contain it has an *entry*: the edge that
//! contains the face's point nearest to `p`, which is one of the edges that have `p` on their outer
//! side. If that point is a corner of two such edges, either will do, but it must always be the
//! same. Following the entries backward leads to one of the faces around `p`:
//! - beyond the entry the nearest point is nearer, unless it is the same corner `v`;
//! - in this case the path turns around `v` in one direction, from behind `v` as seen from `p`
//!   toward `p`, where faces are nearer.
//!
//! The path does not leave the hull, which is convex and contains `p`. So the faces are a forest
//! whose roots are the faces around `p`. Its order, and the path back to the root, follow from the
//! geometry (de Berg, van Oostrum and Overmars 1996). This holds for any triangulation, lawful or
//! not; all comparisons are exact.

use crate::embedded::Embedded;
use crate::geometry::Coordinates;
use crate::kernel::{DotProduct, Kernel, Orientation2, Wide};
use crate::num::Sign;
use crate::query::site;
use crate::tds::{CellId, Complex, Star, VertexId, ccw, cw};
use crate::triangulation::Triangulation;

impl<G: Coordinates<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Returns all finite faces, each once. Each face around a vertex, counter-clockwise, is
    /// followed by the faces behind it, as seen from the vertex. No visited set is kept. Empty
    /// below dimension 2, or if the vertex does not exist.
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

/// Returns all finite faces, each once, starting with those around a vertex; no visited set is
/// kept. See [`Triangulation::faces_from`]. Empty below dimension 2, or if the vertex does not
/// exist. Ends at the first error.
///
/// # Errors
/// If links of the structure contradict each other.
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

/// Iterates over the finite faces of a triangulation.
struct Faces<'t, T: Embedded<3>> {
    t: &'t T,
    start: VertexId,
    site: [f64; 2],
    /// The faces around the start that have not been returned; `None` after an error.
    roots: Option<Star<'t, T::Complex>>,
    /// The face that was returned last.
    at: Option<CellId>,
    /// The number of steps. Each face is entered and left once: if there are more steps, links are
    /// wrong.
    steps: usize,
}

impl<'t, T: Embedded<3, Geometry: Coordinates<3>>> Faces<'t, T> {
    /// Starts with the faces around a vertex.
    fn new(t: &'t T, start: VertexId) -> Result<Self, T::Error> {
        let roots = Some(Star::new(t.complex(), start, 2)?);
        Ok(Faces {
            t,
            start,
            site: site(t, start)?,
            roots,
            at: None,
            steps: 0,
        })
    }

    /// Returns the index of the edge through which a face is entered; `None` for the faces around
    /// the start.
    fn entry(&self, cell: CellId) -> Result<Option<usize>, T::Error> {
        let complex = self.t.complex();
        let corners @ [a, b, c] = complex.corners(cell)?;
        if corners.contains(&self.start) {
            return Ok(None);
        }
        let corners = [site(self.t, a)?, site(self.t, b)?, site(self.t, c)?];
        let is_seen = |&i: &usize| {
            Wide::sign(&Orientation2([corners[ccw(i)], corners[cw(i)], self.site]))
                == Sign::Negative
        };
        let mut seen = (0..3).filter(is_seen);
        let (first, second) = (seen.next(), seen.next());
        // Otherwise the face is flat or clockwise, or contains the start.
        complex.ensure(cell, || first.is_some() && seen.next().is_none())?;
        let (Some(i), Some(j)) = (first, second) else {
            return Ok(first);
        };
        // The edge opposite `i` runs from the common corner to corner `j`.
        let common = 3 - i - j;
        let falls_on = |to: usize| {
            Wide::sign(&DotProduct([self.site, corners[common], corners[to]])) == Sign::Positive
        };
        Ok(Some(if falls_on(j) {
            i
        } else if falls_on(i) {
            j
        } else {
            ccw(common)
        }))
    }

    /// Returns the edges through which other faces may be entered from this one, in order.
    fn exits(&self, cell: CellId, entry: Option<usize>) -> Result<[usize; 2], T::Error> {
        Ok(match entry {
            Some(entry) => [ccw(entry), cw(entry)],
            None => [self.t.complex().index_of(cell, self.start)?.unwrap_or(0); 2],
        })
    }

    /// Returns the face that is entered through this edge, if there is one.
    fn child(&self, cell: CellId, i: usize) -> Result<Option<CellId>, T::Error> {
        let complex = self.t.complex();
        let beyond = complex.neighbor(cell, i)?;
        if complex.is_infinite(beyond)? {
            return Ok(None);
        }
        let is_entered = self.entry(beyond)? == Some(complex.index_of_neighbor(beyond, cell)?);
        Ok(is_entered.then_some(beyond))
    }

    /// Returns the next face in the tree: a child of this one, or of one above it.
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
        if next.is_some() {
            Ok(next)
        } else {
            self.root()
        }
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
