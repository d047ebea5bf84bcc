//! Insertion, written once: the conflict zone of a point is replaced by the point's star. The kinds
//! decide how far the zone extends.

use std::ops::Deref;

use crate::bulk::spatial_order;
use crate::error::{InputError, MAX_VERTICES, MoveError, PointError, RemovalError};
use crate::geometry::{Coordinates, Geometry};
use crate::locate::{Facets, Locate, Location};
use crate::num::Sign;
use crate::tds::{CellId, VertexId, Zone};
use crate::triangulation::Triangulation;

/// The result of inserting a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Inserted<V = ()> {
    /// The new vertex, or the one that was on the site already, which keeps its payload.
    pub vertex: VertexId,
    /// The given payload if there was a vertex on the site already; `None` if the vertex is new.
    pub unused: Option<V>,
}

impl<V> Inserted<V> {
    /// Returns true if the vertex is new.
    #[inline]
    pub fn is_new(&self) -> bool {
        self.unused.is_none()
    }
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    /// Returns an error if a point must not be inserted.
    pub(crate) fn admit(&self, p: &G::Point) -> Result<(), PointError> {
        if let Some(error) = PointError::of(&self.geometry, p) {
            return Err(error);
        }
        if self.tds.vertex_slots() >= MAX_VERTICES {
            return Err(PointError::TooMany);
        }
        Ok(())
    }

    /// Adds a vertex, which is in no cell yet.
    pub(crate) fn add_vertex(&mut self, p: G::Point, data: V) -> VertexId {
        let vertex = self.tds.add_vertex(data);
        match self.points.get_mut(vertex.index()) {
            Some(slot) => *slot = p, // the slot of a removed vertex, or a bulk construction has stored the point already
            None => self.points.push(p),
        }
        vertex
    }

    /// Restores the vertex that was removed last, with its payload and another point. It is in no
    /// cell yet.
    pub(crate) fn restore_vertex(&mut self, p: G::Point) -> Option<VertexId> {
        let vertex = self.tds.restore_vertex()?;
        self.points[vertex.index()] = p;
        Some(vertex)
    }

    /// Inserts a point at its location, unless its site is taken. See [`connect`](Self::connect).
    pub(crate) fn insert_at(
        &mut self,
        p: G::Point,
        location: Location,
        vertex_data: V,
        takes: impl Fn(&Self, CellId, usize, CellId) -> bool,
        data: impl Fn(&C, usize) -> C,
    ) -> Inserted<V> {
        if let Location::Vertex(vertex) = location {
            return Inserted {
                vertex,
                unused: Some(vertex_data),
            };
        }
        let vertex = self.add_vertex(p, vertex_data);
        self.connect(vertex, location, takes, data);
        Inserted {
            vertex,
            unused: None,
        }
    }

    /// Inserts the vertex that was removed last again, with another point at its location. Returns
    /// it, or the vertex that is there already; `None` if none was removed. See
    /// [`connect`](Self::connect).
    pub(crate) fn insert_again(
        &mut self,
        p: G::Point,
        location: Location,
        takes: impl Fn(&Self, CellId, usize, CellId) -> bool,
        data: impl Fn(&C, usize) -> C,
    ) -> Option<VertexId> {
        if let Location::Vertex(other) = location {
            return Some(other);
        }
        let vertex = self.restore_vertex(p)?;
        self.connect(vertex, location, takes, data);
        Some(vertex)
    }

    /// Replaces the point of a vertex by another one on the same site. Returns false, and changes
    /// nothing, if the site differs.
    pub(crate) fn replace_on_site(&mut self, vertex: VertexId, p: &G::Point) -> bool {
        let is_same = self.geometry.compare(self.point(vertex), p).is_eq();
        if is_same {
            self.points[vertex.index()] = *p;
        }
        is_same
    }

    /// Returns a finite neighbor of a vertex, which still exists after the vertex has been removed.
    pub(crate) fn finite_neighbor(&self, vertex: VertexId) -> Option<VertexId> {
        let corners = self.tds.cell_vertices(self.tds.cell_of(vertex)?);
        corners
            .iter()
            .copied()
            .find(|&v| v != vertex && v != VertexId::INFINITE)
    }

    /// Reserves memory for that many more vertices, and for their cells.
    pub(crate) fn reserve(&mut self, vertices: usize) {
        self.tds.reserve(vertices);
        self.points.reserve_exact(vertices);
    }

    /// Returns true if the point is in a finite cell or on its border, or if it sees the facet of
    /// an infinite cell or lies on that facet.
    pub(crate) fn is_split_by(&self, cell: CellId, p: &G::Point) -> bool {
        let vertices = self.tds.cell_vertices(cell);
        match vertices.iter().position(|&v| v == VertexId::INFINITE) {
            None => (0..vertices.len()).all(|i| self.side_of_facet(cell, i, p) != Sign::Negative),
            Some(_) if vertices.len() == 2 => self.in_conflict(cell, p), // the end of a line
            Some(infinite) => match self.side_of_facet(cell, infinite, p) {
                Sign::Positive => true,
                Sign::Zero => self.is_split_by(self.tds.neighbor(cell, infinite), p), // in the facet or beside it
                Sign::Negative => false,
            },
        }
    }

    /// Inserts an added vertex into the complex, given the location of its point. The zone replaced
    /// by its star grows from there across the facets that `takes` accepts; its arguments are the
    /// cell within, the index of the facet, and the cell beyond. `data` returns the payload of a
    /// cell of the star, given that of the old cell with the same facet, and the facet's index.
    ///
    /// Expected time linear in the number of cells replaced.
    pub(crate) fn connect(
        &mut self,
        vertex: VertexId,
        location: Location,
        takes: impl Fn(&Self, CellId, usize, CellId) -> bool,
        data: impl Fn(&C, usize) -> C,
    ) {
        let Some(mut zone) = self.collect(location, takes) else {
            return self.raise_dimension(vertex);
        };
        let star = self.tds.star(&mut zone, vertex, data);
        self.last = star.last().map(|&(cell, _)| cell);
        self.zone = Some(zone);
    }

    /// Returns the zone of a point, given its location; `None` if the point is outside of the
    /// affine hull of the others. The caller should store the zone in `self.zone` afterwards, so
    /// that its memory is used again.
    pub(crate) fn collect(
        &mut self,
        location: Location,
        takes: impl Fn(&Self, CellId, usize, CellId) -> bool,
    ) -> Option<Box<Zone>> {
        let (cell, on) = match location {
            Location::OutsideAffineHull | Location::Nowhere => return None,
            Location::Vertex(vertex) => (self.tds.cell_of(vertex)?, Facets::default()),
            Location::Cell { cell, facets } => (cell, facets),
            Location::OutsideHull { cell } => (cell, Facets::default()),
        };
        let mut zone = self.take_zone();
        zone.grow(&self.tds, cell, |from, i, beyond| {
            // A point on a facet destroys the cells on both sides, even if the facet is
            // constrained.
            from == cell && on.contains(i) || takes(self, from, i, beyond)
        });
        Some(zone)
    }

    /// Inserts an added vertex outside of the affine hull of the others.
    pub(crate) fn raise_dimension(&mut self, vertex: VertexId) {
        self.tds.raise_dimension(vertex);
        let finite = self.finite_cells().next();
        if let Some(cell) = finite.filter(|_| self.dimension() > 0) {
            let positive = if self.is_full() {
                self.geometry.orientation(self.simplex(cell)) == Sign::Positive
            } else {
                let simplex: Vec<_> = self
                    .tds
                    .cell_vertices(cell)
                    .iter()
                    .map(|&v| self.point(v))
                    .collect();
                self.geometry.orientation_in_flat(&simplex) == Sign::Positive
            };
            if !positive {
                self.tds.mirror_all();
            }
        }
        self.last = finite;
    }
}

impl<G: Coordinates<N>, const N: usize, V, C: Copy + Default> Triangulation<G, N, V, C> {
    /// Returns the order in which to insert points, or an error that names the position of the
    /// first one that is refused.
    pub(crate) fn order_of_all(&self, points: &[G::Point]) -> Result<Vec<u32>, InputError> {
        if let Some(error) = InputError::of_points(&self.geometry, points) {
            return Err(error);
        }
        if self.tds.vertex_slots() + points.len() > MAX_VERTICES {
            return Err(InputError::TooMany);
        }
        let geometry = &self.geometry;
        spatial_order(points.len(), |i| geometry.coordinates(&points[i]))
    }
}

/// Inserts a point into a kind: locates it by a strategy, inserts it by the step of the kind, and
/// notifies the strategy if the vertex is new and in cells.
pub(crate) fn insert_located<K, G: Geometry<N>, const N: usize, V, C: Copy + Default>(
    kind: &mut K,
    strategy: &mut impl Locate<G, N>,
    p: G::Point,
    data: V,
    insert_at: impl FnOnce(&mut K, G::Point, V, Location) -> Inserted<V>,
) -> Result<Inserted<V>, PointError>
where
    K: Deref<Target = Triangulation<G, N, V, C>>,
{
    kind.admit(&p)?;
    let location = strategy.locate(kind, &p);
    let inserted = insert_at(kind, p, data, location);
    if inserted.is_new() && kind.tds.is_vertex(inserted.vertex) {
        strategy.inserted(&kind.geometry, inserted.vertex, &p);
    }
    Ok(inserted)
}

/// Moves a vertex of a kind: removes it and inserts it elsewhere, by two steps of the kind. The
/// second receives what the first returned; it returns `None` only if the vertex was not removed.
/// If the site stays, only the point is replaced.
pub(crate) fn move_vertex<K, G: Geometry<N>, const N: usize, V, C: Copy + Default, R>(
    kind: &mut K,
    inner: impl FnOnce(&mut K) -> &mut Triangulation<G, N, V, C>,
    (vertex, p): (VertexId, G::Point),
    remove: impl FnOnce(&mut K, VertexId) -> Result<R, RemovalError>,
    insert_again: impl FnOnce(&mut K, G::Point, Location, R) -> Option<VertexId>,
) -> Result<VertexId, MoveError>
where
    K: Deref<Target = Triangulation<G, N, V, C>>,
{
    kind.admit(&p)?;
    if kind.tds.is_vertex(vertex) && inner(kind).replace_on_site(vertex, &p) {
        return Ok(vertex);
    }
    let neighbor = kind.finite_neighbor(vertex);
    let removed = remove(kind, vertex)?;
    let location = kind.locate(&p, neighbor.and_then(|v| kind.tds.cell_of(v)));
    Ok(insert_again(kind, p, location, removed).unwrap_or(vertex))
}

/// Inserts points in an order of their positions, by `insert`, and returns the vertex of each.
pub(crate) fn insert_each<P: Copy>(
    points: &[P],
    order: Vec<u32>,
    mut insert: impl FnMut(P) -> Result<VertexId, PointError>,
) -> Result<Vec<VertexId>, InputError> {
    let mut vertices = vec![VertexId::INFINITE; points.len()];
    for position in order {
        let i = position as usize;
        vertices[i] = insert(points[i]).map_err(|error| error.at(i))?;
    }
    Ok(vertices)
}
