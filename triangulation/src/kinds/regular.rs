use std::cmp::Ordering;
use std::convert::identity;
use std::ops::Deref;

use crate::bulk;
use crate::engine::Inserted;
use crate::engine::insert::insert_each;
use crate::engine::kind_methods::{
    construction_methods, from_points_with_method, insert_method, insertion_methods,
    payload_methods, remove_all_method, remove_by_method,
};
use crate::engine::removal::Removal;
use crate::error::{InputError, MoveError, RemovalError};
use crate::flaw::{Flaw, Level};
use crate::geometry::{Coordinates, Geometry};
use crate::locate::{Locate, Location};
use crate::num::Sign;
use crate::tds::{CellId, VertexId};
use crate::triangulation::Triangulation;

use super::hidden::Hidden;

/// A regular triangulation of the plane or of space, also known as weighted Delaunay: the lower
/// hull of the points lifted to `x^2 + y^2 (+ z^2) - w`, seen from below (Aurenhammer 1987;
/// Edelsbrunner and Shah 1996). It is the dual of the power diagram.
///
/// Its geometry's [`side_of_sphere`](Geometry::side_of_sphere) must be the power test, as in
/// [`Weighted`](crate::geometry::Weighted) and [`WeightedSpace`](crate::geometry::WeightedSpace).
/// With any other geometry it is the Delaunay triangulation.
///
/// Points above the lower hull are *hidden*: they have a number and a payload, but no cell. They
/// are kept with the cell that hides them, and become visible again when enough other points are
/// removed.
///
/// Ties are broken as in [`Delaunay`](crate::Delaunay), so the cells and the hidden points are a
/// function of the set of points. A point *on* the lower hull is always visible, even inside of one
/// of its faces: the perturbation raises the larger corners around it, so that it lies below. Of
/// points on one site the heaviest counts; of those with equal weights, the first.
///
/// ```
/// use breakline_triangulation::geometry::Weighted;
/// use breakline_triangulation::{Level, Regular};
///
/// let mut t = Regular::new(Weighted::new());
/// for [x, y] in [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]] {
///     t.insert([x, y, 0.0])?;
/// }
/// let light = t.insert([1.0, 1.0, -9.0])?;
/// assert!(t.is_hidden(light));
/// assert_eq!(t.finite_cells().count(), 1);
///
/// let heavy = t.insert([1.0, 1.0, 2.0])?;
/// assert_eq!(t.finite_cells().count(), 3);
/// t.remove(heavy);
/// assert!(t.hidden().eq([light]) && t.check(Level::Law).is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Payloads of cells are kept as in [`Delaunay`](crate::Delaunay).
#[derive(Debug)]
pub struct Regular<G: Geometry<N>, const N: usize, V = (), C = ()> {
    inner: Triangulation<G, N, V, C>,
    hidden: Hidden,
}

/// Makes the heaviest of the points on each site its vertex. The others are returned; they get the
/// numbers after those of the sites, one for all with the same weight.
fn choose_heaviest<G: Coordinates<N>, const N: usize>(
    geometry: &G,
    points: &[G::Point],
    sites: &mut [G::Point],
    vertices: &mut [VertexId],
) -> Vec<G::Point> {
    let mut lighter = Vec::new();
    if points.len() == sites.len() {
        return lighter;
    }
    // Positive if the second point is heavier.
    let compare = |p: &G::Point, q: &G::Point| geometry.side_of_sphere_in_flat(&[p], q);
    let mut is_mixed = vec![false; sites.len()];
    for (p, vertex) in points.iter().zip(&*vertices) {
        is_mixed[vertex.index()] |= compare(&sites[vertex.index()], p) != Sign::Zero;
    }
    let mut mixed: Vec<usize> = (0..points.len())
        .filter(|&i| is_mixed[vertices[i].index()])
        .collect();
    mixed.sort_unstable_by(|&i, &j| {
        let by_weight = || match compare(&points[i], &points[j]) {
            Sign::Positive => Ordering::Greater,
            Sign::Zero => i.cmp(&j),
            Sign::Negative => Ordering::Less,
        };
        vertices[i].cmp(&vertices[j]).then_with(by_weight)
    });
    let mut last = None;
    for i in mixed {
        let site = vertices[i];
        match last {
            Some((of, vertex, at))
                if of == site && compare(&points[at], &points[i]) == Sign::Zero =>
            {
                vertices[i] = vertex;
            }
            Some((of, ..)) if of == site => {
                vertices[i] = VertexId::new(sites.len() + lighter.len());
                lighter.push(points[i]);
            }
            _ => sites[site.index()] = points[i],
        }
        last = Some((site, vertices[i], i));
    }
    lighter
}

impl<G: Geometry<N>, const N: usize, V, C> Deref for Regular<G, N, V, C> {
    type Target = Triangulation<G, N, V, C>;

    fn deref(&self) -> &Self::Target {
        &self.inner
    }
}

impl<G: Geometry<N> + Clone, const N: usize, V: Clone, C: Clone> Clone for Regular<G, N, V, C> {
    fn clone(&self) -> Self {
        Regular {
            inner: self.inner.duplicate(),
            hidden: self.hidden.clone(),
        }
    }
}

impl<G: Geometry<N>, const N: usize, V> Regular<G, N, V> {
    construction_methods!();
}

impl<G: Coordinates<N>, const N: usize> Regular<G, N> {
    /// Triangulates many points at once; also returns the vertex of each. Points on one site with
    /// one weight share a vertex.
    ///
    /// In the plane they are inserted one by one, in [spatial order](crate::spatial_order); in
    /// space only if the geometry has no [exact sites](Coordinates::exact_site).
    ///
    /// # Errors
    /// If a point is refused; the error names the position of the first one.
    ///
    /// # Complexity
    /// Linear in the number of points if they are spread evenly.
    pub fn from_points(
        geometry: G,
        points: &[G::Point],
    ) -> Result<(Self, Vec<VertexId>), InputError> {
        let mut regular = Self::new(geometry);
        // The builder of the plane knows no hidden points.
        let vertices = if N == 4 { regular.build(points)? } else { None };
        match vertices {
            Some(vertices) => Ok((regular, vertices)),
            None => {
                regular.inner.tds.reserve(points.len());
                let vertices = regular.insert_all(points)?;
                Ok((regular, vertices))
            }
        }
    }

    /// Builds an empty triangulation in bulk; `None` if that is impossible, and it is still empty.
    fn build(&mut self, points: &[G::Point]) -> Result<Option<Vec<VertexId>>, InputError> {
        let (geometry, grain) = (&self.inner.geometry, bulk::Grain::default());
        let (mut sites, mut vertices) = bulk::Sites::of(geometry, points, grain)?;
        let lighter = choose_heaviest(geometry, points, &mut sites.points, &mut vertices);
        let (sites, Some(tds)) = bulk::build(geometry, sites, grain) else {
            return Ok(None);
        };
        self.inner.points = sites;
        self.inner.tds = tds;
        for p in lighter {
            let vertex = self.inner.add_vertex(p, ());
            self.inner.tds.detach(vertex);
        }
        let numbers = (0..self.tds().vertex_slots()).map(VertexId::new);
        let hidden = numbers
            .filter(|&vertex| !self.tds().is_vertex(vertex))
            .collect();
        self.connect_again(hidden);
        Ok(Some(vertices))
    }

    from_points_with_method!(Regular<G, N, V>);
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Regular<G, N, V, C> {
    fn over(inner: Triangulation<G, N, V, C>) -> Self {
        Regular {
            inner,
            hidden: Hidden::default(),
        }
    }

    /// Converts the triangulation below; its law stays.
    fn with_inner<W, D>(
        self,
        convert: impl FnOnce(Triangulation<G, N, V, C>) -> Triangulation<G, N, W, D>,
    ) -> Regular<G, N, W, D>
    where
        D: Copy + Default,
    {
        Regular {
            inner: convert(self.inner),
            hidden: self.hidden,
        }
    }

    /// Returns the triangulation with its table of hidden points, which are the vertices in no
    /// cell. Those that no cell hides are inserted.
    #[cfg(feature = "serde")]
    pub(crate) fn with_hidden(inner: Triangulation<G, N, V, C>) -> Self {
        let hidden = inner.tds.detached_vertices();
        let mut regular = Self::over(inner);
        regular.connect_again(hidden);
        regular
    }

    payload_methods! {
        vertices: <W> Regular<G, N, W, C>,
        cells: <D> Regular<G, N, V, D>, with_cell_data, identity,
    }

    insertion_methods! {
        /// Inserts a point with a payload and returns its vertex, which may be
        /// [hidden](Self::is_hidden). If a point with the same weight is on the site, returns its
        /// vertex, which keeps its payload, together with the unused payload.
        ///
        /// # Errors
        /// If a coordinate is not finite or out of range; nothing has changed then.
        ///
        /// # Complexity
        /// A [walk](Triangulation::locate) from the last insertion, then linear in the number of
        /// cells replaced and of points hidden by these. A hidden point takes constant time if the
        /// geometry has a [hash](Geometry::point_hash).
        by Locate<G, N>
    }

    fn has_point(&self, vertex: VertexId) -> bool {
        self.tds().is_vertex(vertex) || self.is_hidden(vertex)
    }

    fn insert_at(&mut self, p: G::Point, data: V, location: Location) -> Inserted<V> {
        if let Some(vertex) = self.same(&p, location) {
            return Inserted {
                vertex,
                unused: Some(data),
            };
        }
        let vertex = self.inner.add_vertex(p, data);
        self.connect(vertex, location);
        Inserted {
            vertex,
            unused: None,
        }
    }

    /// Returns the point with the same site and weight, visible or hidden.
    fn same(&self, p: &G::Point, location: Location) -> Option<VertexId> {
        let is_same = |v: &VertexId| {
            self.inner.geometry.compare(self.point(*v), p).is_eq()
                && self.side_of(*v, p) == Sign::Zero
        };
        // Any of the cells at the location may hide it.
        let Ok(cells) = match location {
            Location::Vertex(vertex) if is_same(&vertex) => return Some(vertex),
            _ if self.hidden.is_empty() => return None,
            _ => match self.inner.geometry.point_hash(p) {
                Some(hash) => return self.hidden.of_hash(hash).find(is_same),
                None => location.cells(self.tds()),
            },
        };
        cells
            .iter()
            .flat_map(|&cell| self.hidden.under(cell))
            .copied()
            .find(is_same)
    }

    fn hash_of(&self, vertex: VertexId) -> Option<u64> {
        self.inner.geometry.point_hash(self.point(vertex))
    }

    /// Compares a point on a vertex's site with the vertex: negative if the vertex would hide it,
    /// positive if it would hide the vertex.
    fn side_of(&self, vertex: VertexId, p: &G::Point) -> Sign {
        self.inner
            .geometry
            .side_of_sphere_in_flat(&[self.point(vertex)], p)
    }

    /// Inserts a vertex into the cells, or hides it, given the location of its point.
    fn connect(&mut self, vertex: VertexId, location: Location) {
        let p = *self.inner.point(vertex);
        let host = match location {
            Location::Cell { cell, .. } => (!self.inner.in_conflict(cell, &p)).then_some(cell),
            Location::Vertex(there) if self.side_of(there, &p) != Sign::Positive => {
                self.tds().cell_of(there)
            }
            _ => None,
        };
        if let Some(cell) = host {
            // The finite one of an infinite cell and its neighbor.
            let infinite = self.tds().index_of(cell, VertexId::INFINITE);
            let cell = infinite.map_or(cell, |i| self.tds().neighbor(cell, i));
            self.inner.tds.detach(vertex);
            self.hidden.put(vertex, cell, self.hash_of(vertex));
            self.inner.last = Some(cell);
            return;
        }
        let Some(mut zone) = self
            .inner
            .collect(location, |t, _, _, beyond| t.in_conflict(beyond, &p))
        else {
            let hidden = self.hidden.take_all();
            self.inner.raise_dimension(vertex);
            return self.connect_again(hidden);
        };
        let mut hidden = self.hidden.take_under(zone.cells().iter().copied());
        for vertex in zone.inner_vertices(&self.inner.tds) {
            self.inner.tds.detach(vertex);
            hidden.push(vertex);
        }
        self.inner.last = self
            .inner
            .tds
            .star(&mut zone, vertex, |data, _| *data)
            .last()
            .map(|&(cell, _)| cell);
        self.inner.zone = Some(zone);
        self.connect_again(hidden);
    }

    /// Inserts or hides vertices again after the cells that hid them are gone.
    fn connect_again(&mut self, hidden: Vec<VertexId>) {
        let mut near = None;
        for vertex in hidden {
            self.inner.tds.attach();
            let location = self.inner.locate(self.inner.point(vertex), near);
            self.connect(vertex, location);
            near = self
                .hidden
                .host(vertex)
                .filter(|_| !self.tds().is_vertex(vertex));
            if near.is_none() {
                self.hidden.forget(vertex);
            }
        }
    }

    /// Returns true if the point with this number is in no cell.
    pub fn is_hidden(&self, vertex: VertexId) -> bool {
        self.hidden.contains(vertex)
    }

    /// The hidden points, in order of their numbers. Linear in their number, and a step for every
    /// 16 vertices; for one point use [`is_hidden`](Self::is_hidden), for one cell
    /// [`hidden_under`](Self::hidden_under).
    pub fn hidden(&self) -> impl ExactSizeIterator<Item = VertexId> + '_ {
        self.hidden.all().into_iter()
    }

    /// The points that a finite cell hides, in no particular order.
    pub fn hidden_under(&self, cell: CellId) -> &[VertexId] {
        self.hidden.under(cell)
    }

    /// Returns the flaws found by a check up to the given level, with exact predicates. If there
    /// are none, the triangulation is what it claims to be.
    #[must_use]
    pub fn check(&self, level: Level) -> Vec<Flaw> {
        let mut flaws = self.flaws(level, |_, _| true);
        if flaws.is_empty() && level == Level::Law {
            flaws.extend(
                self.hidden
                    .flaws(|vertex| self.hash_of(vertex))
                    .into_iter()
                    .map(Flaw::Hidden),
            );
        }
        if flaws.is_empty() && level == Level::Law {
            flaws.extend(
                self.hidden()
                    .filter(|&vertex| !self.is_rightly_hidden(vertex))
                    .map(Flaw::Hidden),
            );
        }
        flaws
    }

    fn is_rightly_hidden(&self, vertex: VertexId) -> bool {
        let p = self.point(vertex);
        let Some(host) = self.hidden.host(vertex) else {
            return false;
        };
        if !self.tds().is_used(host) || self.tds().is_infinite(host) || self.tds().is_vertex(vertex)
        {
            return false;
        }
        match self.tds().dimension() {
            0 => self.side_of(self.tds().vertex(host, 0), p) != Sign::Positive,
            _ => {
                let width = self.tds().cell_vertices(host).len();
                let holds =
                    (0..width).all(|i| self.inner.side_of_facet(host, i, p) != Sign::Negative);
                holds && !self.inner.in_conflict(host, p)
            }
        }
    }
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Regular<G, N, V, C>
where
    Triangulation<G, N, V, C>: Removal,
{
    /// Removes a point, visible or hidden, and returns it. The result is the triangulation of the
    /// others, which keep their numbers; the next point inserted takes the freed one.
    ///
    /// # Errors
    /// If no point has this number.
    ///
    /// # Complexity
    /// Of a hidden point, O(1) if the geometry has a [hash](Geometry::point_hash). Of a vertex,
    /// that of [`Delaunay::remove`](crate::Delaunay::remove), and one insertion for each point that
    /// the cells around it hide. Below full dimension, or if the dimension decreases, one insertion
    /// for each hidden point.
    pub fn remove(&mut self, vertex: VertexId) -> Result<G::Point, RemovalError> {
        if self.is_hidden(vertex) {
            self.hidden.remove(vertex);
            self.inner.tds.attach();
            self.inner.tds.remove_vertex(vertex);
        } else if self.tds().is_vertex(vertex) {
            let mut hidden = if self.inner.is_full() {
                self.hidden.take_under(self.inner.star(vertex))
            } else {
                self.hidden.take_all()
            };
            if self.inner.remove_and_restore(vertex) {
                hidden.extend(self.hidden.take_all());
            }
            self.connect_again(hidden);
        } else {
            return Err(RemovalError::NoVertex);
        }
        Ok(*self.point(vertex))
    }

    remove_by_method!(Locate<G, N>);

    remove_all_method!();

    /// Moves a point, visible or hidden, and returns its vertex, which keeps its number and
    /// payload. If a point with the same weight is on the site, the moved one is removed, and the
    /// vertex that is there already is returned.
    ///
    /// # Errors
    /// If no point has this number, or a coordinate or the weight is not finite or out of
    /// range; nothing has changed then.
    ///
    /// # Complexity
    /// That of a removal and of an insertion.
    pub fn move_to(&mut self, vertex: VertexId, p: G::Point) -> Result<VertexId, MoveError> {
        self.inner.admit(&p)?;
        self.remove(vertex)?;
        let location = self.inner.locate(&p, None);
        if let Some(same) = self.same(&p, location) {
            return Ok(same);
        }
        if let Some(vertex) = self.inner.restore_vertex(p) {
            self.connect(vertex, location);
        }
        Ok(vertex)
    }
}

impl<G: Geometry<N>, const N: usize, C: Copy + Default> Regular<G, N, (), C> {
    insert_method!();
}

impl<G: Coordinates<N>, const N: usize, C: Copy + Default> Regular<G, N, (), C> {
    /// Inserts many points, in [spatial order](crate::spatial_order), and returns the vertex of
    /// each.
    ///
    /// # Errors
    /// If a point is refused; the error names the position of the first one. Nothing has changed
    /// then.
    ///
    /// # Complexity
    /// Linear in the number of points if they are spread evenly.
    pub fn insert_all(&mut self, points: &[G::Point]) -> Result<Vec<VertexId>, InputError> {
        let order = self.inner.order_of_all(points)?;
        insert_each(points, order, |p| self.insert(p))
    }
}
