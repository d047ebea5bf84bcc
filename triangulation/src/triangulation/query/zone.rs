use std::convert::Infallible;

use rustc_hash::FxHashSet;

use crate::geometry::{Crossing, Geometry};
use crate::tds::{CellId, Complex, Neighbors, Tds};

use super::super::embedded::sides::in_conflict;
use super::super::embedded::{Embedded, PointOf};
use super::super::locate::locate;
use super::super::{ConstrainedDelaunay, Delaunay, Facets, Location, Regular};

/// The cells that a new point would destroy, and the facets around them, from which the star of the
/// point would be built.
///
/// In the plane, where facets are edges, there are two more edges than cells; on a line, where they
/// are vertices, there are two. In space there are twice as many facets as vertices on them, less
/// four, with the infinite vertex if it is among them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConflictZone {
    /// The cells, including infinite ones if the point lies outside of the hull or on it. The point
    /// lies in the first cell, or beyond the finite facet of that cell.
    pub cells: Vec<CellId>,
    /// The facets around the zone: the cell inside, and the index of the facet in it. In the plane
    /// they are in counter-clockwise order: each edge ends where the next one starts, which may be
    /// the infinite vertex.
    pub border: Vec<(CellId, usize)>,
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
    let complex = t.complex();
    let (start, on) = match location {
        Location::Vertex(_) | Location::OutsideAffineHull | Location::Nowhere => return Ok(None),
        Location::Cell { cell, facets } => (cell, facets),
        Location::OutsideHull { cell } => (cell, Facets::default()),
    };
    let takes = |from: CellId, i: usize, beyond: CellId| {
        // A point on a facet destroys the cells on both sides, constraint or not.
        let is_split = from == start && on.contains(i);
        Ok(is_split || passes(from, i)? && in_conflict(t, beyond, q)?)
    };
    // Only a point with a weight may be hidden; one outside of the hull is not.
    if !matches!(location, Location::OutsideHull { .. }) && !in_conflict(t, start, q)? {
        return Ok(None);
    }
    let width = complex.width();
    let mut taken = FxHashSet::from_iter([start]);
    let mut zone = ConflictZone { cells: vec![start], border: Vec::new() };
    // Depth first, over the sides of each cell counter-clockwise from where it was entered: the
    // border comes in order, as in `tds::Zone`, which does this with memory of its own.
    let mut sides: Vec<(CellId, usize)> = (0..width).rev().map(|i| (start, i)).collect();
    while let Some((cell, i)) = sides.pop() {
        let beyond = complex.neighbor(cell, i)?;
        if taken.contains(&beyond) {
            continue;
        }
        if takes(cell, i, beyond)? {
            taken.insert(beyond);
            zone.cells.push(beyond);
            let entry = complex.index_of_neighbor(beyond, cell)?;
            sides.extend((1..width).rev().map(|turn| (beyond, (entry + turn) % width)));
        } else {
            zone.border.push((cell, i));
        }
    }
    Ok(Some(zone))
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Delaunay<G, N, V, C>
where
    Tds<N, V, C>: Neighbors<N, Error = Infallible>,
{
    /// Returns what the insertion of a point would destroy: the cells whose circumscribed circle or
    /// sphere contains the point, with ties broken as insertion breaks them. `None` if the point is
    /// on a vertex, if it would raise the dimension, or if the geometry does not
    /// [admit](Geometry::admits) it.
    ///
    /// # Complexity
    /// A [walk](crate::triangulation::Triangulation::locate) from a cell nearby, and time
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
}

impl<G: Geometry<N>, const N: usize, V, C: Copy + Default> Regular<G, N, V, C>
where
    Tds<N, V, C>: Neighbors<N, Error = Infallible>,
{
    /// Returns what the insertion of a weighted point would destroy: the cells whose orthogonal
    /// circle or sphere it has a negative power to. `None` also if the point would be hidden, or
    /// takes the site of a vertex, of which the heavier counts.
    ///
    /// # Complexity
    /// That of [`Delaunay::conflict_zone`](crate::Delaunay::conflict_zone).
    pub fn conflict_zone(&self, q: &G::Point, near: Option<CellId>) -> Option<ConflictZone> {
        let Ok(zone) = conflict_zone(&**self, q, self.start(near), |_, _| Ok(true));
        zone
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
}
