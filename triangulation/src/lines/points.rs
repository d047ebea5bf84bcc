//! Insertion, removal and moves of points among lines.

use crate::engine::Inserted;
use crate::engine::insert::{insert_each, move_vertex};
use crate::engine::kind_methods::{insert_method, insertion_methods, remove_by_method};
use crate::error::{InputError, MoveError, RemovalError};
use crate::geometry::{Coordinates, Crossing};
use crate::locate::{Locate, Location};
use crate::tds::VertexId;

use super::constrained_delaunay::ConstrainedDelaunay;
use super::index::NotLocal;

impl<G: Crossing + Coordinates<3>, V: Default, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    insertion_methods! {
        /// Inserts a point with a payload and returns its vertex. If the site is taken, returns the
        /// vertex that is there already, which keeps its payload, together with the unused payload.
        /// A point on a constraint splits it. A vertex that existed for lines only, at a crossing
        /// or at the end of a segment, becomes a given one, which is not removed with the lines.
        /// Strategies of [`insert_by`](Self::insert_by) are not notified of crossings.
        ///
        /// # Errors
        /// If a coordinate is not finite or out of range; nothing has changed then.
        ///
        /// # Complexity
        /// A [walk](crate::Triangulation::locate) from the last insertion, and time linear in
        /// the number of triangles replaced. If the point lies exactly on a segment that crosses
        /// others, as [`insert_lines`](Self::insert_lines).
        by Locate<G, 3>
    }

    fn insert_at(&mut self, p: G::Point, data: V, location: Location) -> Inserted<V> {
        let mut is_known = Ok(());
        let inserted = self.insert_given(p, data, location, &mut is_known);
        if is_known.is_err() {
            self.rearrange();
        }
        inserted
    }

    /// Inserts a point at its location. Updates the lines, too, as long as that is possible
    /// locally; else the caller has to arrange them anew.
    fn insert_given(
        &mut self,
        p: G::Point,
        data: V,
        location: Location,
        is_known: &mut Result<(), NotLocal>,
    ) -> Inserted<V> {
        let inserted = self.lines.insert_at(&mut self.inner, p, data, location);
        let vertex = inserted.vertex;
        self.lines.owned.remove(vertex);
        if is_known.is_ok() {
            *is_known = self.make_given(vertex, p, inserted.is_new());
        } else if self.lines.added.remove(vertex) {
            self.replace_point(vertex, p);
        }
        self.lines.constrain_waiting(&mut self.inner);
        inserted
    }

    /// Removes a vertex and returns its point. Constraints that only run through it stay, without
    /// it; if lines cross there, the vertex stays as their crossing, with the default payload. The
    /// other vertices keep their numbers; the next point inserted takes the freed one.
    ///
    /// # Errors
    /// If there is no such vertex, if it was added where lines cross, or if a line was given by it.
    ///
    /// # Complexity
    /// As [`Delaunay::remove`](crate::Delaunay::remove), or, on a constraint, as
    /// [`remove_line`](Self::remove_line). The first edit after construction takes linear time.
    pub fn remove(&mut self, vertex: VertexId) -> Result<G::Point, RemovalError> {
        let p = self
            .points()
            .get(vertex.index())
            .copied()
            .ok_or(RemovalError::NoVertex)?;
        self.extract(vertex).map(|_| p)
    }

    remove_by_method!(Locate<G, 3>);

    /// Moves a vertex to another point and returns it; it keeps its payload, and also its number,
    /// unless a constraint runs through it or lines are [arranged anew](Self::rearrangements). If
    /// the site is taken, the vertex is removed, and the one that is there already is returned.
    ///
    /// # Errors
    /// If the vertex cannot be [removed](Self::remove), or a coordinate is not finite or out of
    /// range; nothing has changed then.
    ///
    /// # Complexity
    /// That of a removal and an insertion; the search starts at the old site.
    pub fn move_to(&mut self, vertex: VertexId, p: G::Point) -> Result<VertexId, MoveError> {
        move_vertex(
            self,
            |t| &mut t.inner,
            (vertex, p),
            Self::extract,
            |t, p, location, data| Some(t.insert_at(p, data, location).vertex),
        )
    }

    /// Removes a vertex and returns its payload.
    fn extract(&mut self, vertex: VertexId) -> Result<V, RemovalError> {
        if !self.tds().is_vertex(vertex) {
            return Err(RemovalError::NoVertex);
        }
        if self.is_added(vertex) {
            return Err(RemovalError::Crossing);
        }
        if let Some(&line) = self.lines.given_by(&self.inner, vertex).first() {
            return Err(RemovalError::Line(line));
        }
        let data = std::mem::take(self.vertex_data_mut(vertex));
        let is_removed =
            !self.lines.recrossed && self.lines.remove_free(&mut self.inner, vertex).is_some();
        if !is_removed && self.lines.withdraw(&mut self.inner, vertex).is_err() {
            self.rearrange();
        }
        Ok(data)
    }
}

impl<G: Crossing + Coordinates<3>, C: Copy + Default> ConstrainedDelaunay<G, (), C> {
    insert_method!();

    /// Inserts many points, in [spatial order](crate::spatial_order), and returns the vertex of
    /// each.
    ///
    /// # Errors
    /// If a point is refused; the error names the position of the first one. Nothing has changed
    /// then.
    ///
    /// # Complexity
    /// Linear in the number of points if they are spread evenly. Lines are arranged anew once at
    /// most. For an empty triangulation [`from_points`](ConstrainedDelaunay::from_points) is
    /// faster.
    pub fn insert_all(&mut self, points: &[G::Point]) -> Result<Vec<VertexId>, InputError> {
        let order = self.inner.order_of_all(points)?;
        let mut is_known = Ok(());
        let vertices = insert_each(points, order, |p| {
            self.inner.admit(&p)?;
            let location = self.inner.locate(&p, None);
            Ok(self.insert_given(p, (), location, &mut is_known).vertex)
        });
        if is_known.is_err() {
            self.rearrange();
        }
        vertices
    }
}
