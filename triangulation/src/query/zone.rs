use rustc_hash::FxHashSet;

use crate::embedded::sides::in_conflict;
use crate::embedded::{Embedded, PointOf};
use crate::engine::Inserted;
use crate::error::PointError;
use crate::geometry::{Crossing, Geometry};
use crate::kinds::{Delaunay, Regular};
use crate::lines::ConstrainedDelaunay;
use crate::locate::locate;
use crate::locate::{Facets, Location};
use crate::num::Sign;
use crate::tds::{CellId, Complex};

/// The cells that a new point would destroy, and the facets around them, from which the star of
/// the point would be built.
///
/// The border is a sphere: in the plane, there are two more edges on it than cells in the zone; in
/// space, it has `2 v - 4` facets if it has `v` vertices, the infinite one included. (If a regular
/// triangulation loses vertices, they are in the zone and not on its border.) On a line, where a
/// facet is a vertex, there are two.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConflictZone {
    /// The cells, including infinite ones if the point lies outside of the hull or on it. The point
    /// lies in the first cell, or beyond the finite facet of that cell.
    pub cells: Vec<CellId>,
    /// The facets around the zone: the cell inside, and the index of the facet in it. The cell
    /// outside is the [neighbor](Complex::neighbor) there. In dimension 2 they are edges,
    /// counter-clockwise: each ends where the next one starts, which may be the infinite vertex.
    pub border: Vec<(CellId, usize)>,
}

impl ConflictZone {
    /// Returns the facets between two cells of the zone, each once: one of the two cells, and the
    /// index of the facet in it.
    ///
    /// # Errors
    /// If a cell of the zone, or a neighbor of one, does not exist in the complex.
    ///
    /// # Complexity
    /// Linear in the number of cells.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Space, Delaunay};
    ///
    /// let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0], [4.0, 4.0, 4.0]];
    /// let (t, _) = Delaunay::from_points(Space::new(), &corners)?;
    /// let zone = t.conflict_zone(&[2.0, 2.0, 2.0], None).expect("it is inside");
    /// assert_eq!((zone.cells.len(), zone.border.len()), (2, 6));
    /// assert_eq!(zone.internal_facets(t.tds()).map(|facets| facets.len()), Ok(1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn internal_facets<T: Complex<N>, const N: usize>(
        &self,
        complex: &T,
    ) -> Result<Vec<(CellId, usize)>, T::Error> {
        let taken: FxHashSet<CellId> = self.cells.iter().copied().collect();
        let mut facets = Vec::new();
        for &cell in &self.cells {
            for i in 0..complex.width() {
                let beyond = complex.neighbor(cell, i)?;
                if cell < beyond && taken.contains(&beyond) {
                    facets.push((cell, i));
                }
            }
        }
        Ok(facets)
    }
}

/// Returns what the insertion of a point into a Delaunay or regular triangulation would destroy.
/// `None` if it would destroy nothing: on a vertex, if it is hidden, and if it raises the
/// dimension.
///
/// `passes` returns true if the zone may grow across a facet, given as a cell and the index of the
/// facet in it: if the facet is not constrained.
///
/// # Errors
/// If links of the structure contradict each other, and what `passes` returns.
///
/// # Complexity
/// That of [`locate`](super::locate), and time proportional to the size of the zone.
pub fn conflict_zone<T: Embedded<N>, const N: usize>(
    t: &T,
    q: &PointOf<T, N>,
    near: Option<CellId>,
    passes: impl Fn(CellId, usize) -> Result<bool, T::Error>,
) -> Result<Option<ConflictZone>, T::Error> {
    zone_at(t, q, locate(t, q, near)?, passes)
}

/// Returns what the insertion of a point would destroy, given its location; see [`conflict_zone`].
pub(super) fn zone_at<T: Embedded<N>, const N: usize>(
    t: &T,
    q: &PointOf<T, N>,
    location: Location,
    passes: impl Fn(CellId, usize) -> Result<bool, T::Error>,
) -> Result<Option<ConflictZone>, T::Error> {
    match location {
        Location::Vertex(_) | Location::OutsideAffineHull | Location::Nowhere => Ok(None),
        // Only a point with a weight may be hidden; one outside of the hull is not.
        Location::Cell { cell, .. } if !in_conflict(t, cell, q)? => Ok(None),
        Location::Cell { cell, facets } => zone_from(t, q, cell, facets, passes).map(Some),
        Location::OutsideHull { cell } => {
            zone_from(t, q, cell, Facets::default(), passes).map(Some)
        }
    }
}

/// Returns the zone that contains a cell, given the facets of it that the point lies on.
fn zone_from<T: Embedded<N>, const N: usize>(
    t: &T,
    q: &PointOf<T, N>,
    start: CellId,
    on: Facets,
    passes: impl Fn(CellId, usize) -> Result<bool, T::Error>,
) -> Result<ConflictZone, T::Error> {
    let complex = t.complex();
    let takes = |from: CellId, i: usize, beyond: CellId| {
        // A point on a facet destroys the cells on both sides, constraint or not.
        let is_split = from == start && on.contains(i);
        Ok(is_split || passes(from, i)? && in_conflict(t, beyond, q)?)
    };
    let width = complex.width();
    let mut taken = FxHashSet::from_iter([start]);
    let mut zone = ConflictZone {
        cells: vec![start],
        border: Vec::new(),
    };
    // Depth first, over the facets of each cell counter-clockwise from where it was entered: in the
    // plane the border comes in order, as in `tds::Zone`, which does this with memory of its own.
    let mut facets: Vec<(CellId, usize)> = (0..width).rev().map(|i| (start, i)).collect();
    while let Some((cell, i)) = facets.pop() {
        let beyond = complex.neighbor(cell, i)?;
        if taken.contains(&beyond) {
            continue;
        }
        if takes(cell, i, beyond)? {
            taken.insert(beyond);
            zone.cells.push(beyond);
            let entry = complex.index_of_neighbor(beyond, cell)?;
            facets.extend(
                (1..width)
                    .rev()
                    .map(|turn| (beyond, (entry + turn) % width)),
            );
        } else {
            zone.border.push((cell, i));
        }
    }
    Ok(zone)
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Delaunay<G, N, V, C> {
    /// Returns what the insertion of a point would destroy, in any dimension: the cells whose
    /// circumcircle (circumsphere) contains the point, with ties broken as insertion breaks them.
    /// `None` if the point is on a vertex, if it would raise the dimension, or if the geometry does
    /// not [admit](Geometry::admits) it.
    ///
    /// # Complexity
    /// A [walk](crate::Triangulation::locate) from a cell nearby, and time
    /// proportional to the size of the zone.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Plane, Delaunay};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [5.0, 3.0], [1.0, 4.0]];
    /// let (t, _) = Delaunay::from_points(Plane::new(), &points)?;
    /// let zone = t.conflict_zone(&[2.0, 2.0], None).expect("it is inside");
    /// assert_eq!((zone.cells.len(), zone.border.len()), (2, 4));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn conflict_zone(&self, q: &G::Point, near: Option<CellId>) -> Option<ConflictZone> {
        let Ok(zone) = conflict_zone(&self.inner, q, self.start(near), |_, _| Ok(true));
        zone
    }

    /// Inserts a point whose [conflict zone](Self::conflict_zone) is known, with a payload. The
    /// search for the point starts in the zone, and ends at once.
    ///
    /// The result is that of [`insert_with`](Self::insert_with), also if the zone is that of
    /// another point, or of a triangulation that has changed since.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    ///
    /// # Complexity
    /// Linear in the size of the zone.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Plane, Delaunay};
    ///
    /// let points = [[0.0, 0.0], [4.0, 0.0], [5.0, 3.0], [1.0, 4.0]];
    /// let (mut t, _) = Delaunay::from_points(Plane::new(), &points)?;
    /// let p = [2.0, 2.0];
    /// let zone = t.conflict_zone(&p, None).expect("it is inside");
    /// let new_cells = zone.border.len();
    /// let inserted = t.insert_in_zone(p, (), &zone)?;
    /// assert_eq!(t.tds().vertices_around(inserted.vertex).count(), new_cells);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn insert_in_zone(
        &mut self,
        p: G::Point,
        data: V,
        zone: &ConflictZone,
    ) -> Result<Inserted<V>, PointError> {
        self.insert_near(p, data, zone.cells.first().copied())
    }
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Regular<G, N, V, C> {
    /// Returns what the insertion of a weighted point would destroy, in any dimension: the cells
    /// that its lift lies below, with ties broken as insertion breaks them. `None` if the point
    /// would be hidden, if there is the same point already, if it would raise the dimension, or if
    /// the geometry does not [admit](Geometry::admits) it.
    ///
    /// # Complexity
    /// That of [`Delaunay::conflict_zone`].
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Weighted, Regular};
    ///
    /// let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 0.0]];
    /// let (t, _) = Regular::from_points(Weighted::new(), &corners)?;
    /// let size = |weight| t.conflict_zone(&[2.0, 1.0, weight], None).map(|zone| zone.cells.len());
    /// assert_eq!([-9.0, 0.0, 9.0].map(size), [None, Some(2), Some(3)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn conflict_zone(&self, q: &G::Point, near: Option<CellId>) -> Option<ConflictZone> {
        let location = self.locate(q, near);
        let Ok(zone) = match location {
            Location::Vertex(vertex) => {
                let is_heavier = self
                    .geometry()
                    .side_of_sphere_in_flat(&[self.point(vertex)], q)
                    == Sign::Positive;
                let start = self.tds().cell_of(vertex).filter(|_| is_heavier)?;
                zone_from(&**self, q, start, Facets::default(), |_, _| Ok(true)).map(Some)
            }
            _ => zone_at(&**self, q, location, |_, _| Ok(true)),
        };
        zone
    }

    /// Inserts a point whose [conflict zone](Self::conflict_zone) is known, with a payload. The
    /// search for the point starts in the zone, and ends at once.
    ///
    /// The result is that of [`insert_with`](Self::insert_with), also if the zone is that of
    /// another point, or of a triangulation that has changed since.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    ///
    /// # Complexity
    /// Linear in the size of the zone.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Weighted, Regular};
    ///
    /// let points = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [5.0, 3.0, 0.0], [1.0, 4.0, 0.0]];
    /// let (mut t, _) = Regular::from_points(Weighted::new(), &points)?;
    /// let p = [2.0, 2.0, 1.0];
    /// let zone = t.conflict_zone(&p, None).expect("it is inside");
    /// let new_cells = zone.border.len();
    /// let inserted = t.insert_in_zone(p, (), &zone)?;
    /// assert_eq!(t.tds().vertices_around(inserted.vertex).count(), new_cells);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn insert_in_zone(
        &mut self,
        p: G::Point,
        data: V,
        zone: &ConflictZone,
    ) -> Result<Inserted<V>, PointError> {
        self.insert_near(p, data, zone.cells.first().copied())
    }
}

impl<G: Crossing, V: Default, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    /// Like [`Delaunay::conflict_zone`], but constraints limit what the point sees. If it lies on a
    /// constraint, the zone contains both sides. For a point on a segment that is bent at
    /// crossings, insertion replaces more, because it makes the segment go through the point.
    pub fn conflict_zone(&self, q: &G::Point, near: Option<CellId>) -> Option<ConflictZone> {
        let passes = |cell: CellId, i| Ok(!self.tds().cell_data(cell).has(i));
        let Ok(zone) = conflict_zone(&self.inner, q, self.start(near), passes);
        zone
    }

    /// Like [`Delaunay::insert_in_zone`], but constraints limit the zone.
    ///
    /// # Errors
    /// See [`insert_with`](Self::insert_with).
    ///
    /// ```
    /// use breakline_triangulation::{ConstrainedDelaunay, OnCrossing, geometry::Plane};
    ///
    /// let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    /// let diagonal = [[0, 2]];
    /// let (mut t, _) =
    ///     ConstrainedDelaunay::from_lines(Plane::new(), &square, &diagonal, OnCrossing::Split)?;
    /// let p = [3.0, 1.0];
    /// let zone = t.conflict_zone(&p, None).expect("there is no vertex yet");
    /// assert_eq!(zone.cells.len(), 1, "the diagonal is the border of the zone");
    /// t.insert_in_zone(p, (), &zone)?;
    /// assert_eq!(t.finite_cells().count(), 4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn insert_in_zone(
        &mut self,
        p: G::Point,
        data: V,
        zone: &ConflictZone,
    ) -> Result<Inserted<V>, PointError> {
        self.insert_near(p, data, zone.cells.first().copied())
    }
}
