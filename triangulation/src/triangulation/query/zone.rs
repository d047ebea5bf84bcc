use rustc_hash::FxHashSet;

use crate::geometry::{Crossing, Geometry};
use crate::tds::{CellId, Complex};

use super::super::embedded::sides::in_conflict;
use super::super::embedded::{Embedded, PointOf};
use super::super::locate::locate;
use super::super::{ConstrainedDelaunay, Delaunay, Facets, Location};

/// The cells that a new point would destroy, and the edges around them, from which the star of the
/// point would be built.
///
/// In the plane there are two more edges than cells; on a line, where an edge of the border is a
/// vertex, there are two.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConflictZone {
    /// The cells, including infinite ones if the point lies outside of the hull or on it. The point
    /// lies in the first cell, or beyond the finite edge of that cell.
    pub cells: Vec<CellId>,
    /// The edges around the zone, counter-clockwise: the cell inside, and the index of the edge in
    /// it. Each edge ends where the next one starts, which may be the infinite vertex.
    pub border: Vec<(CellId, usize)>,
}

/// Returns what the insertion of a point into a Delaunay triangulation would destroy, in the plane
/// or on a line. `None` if it would destroy nothing: on a vertex, and if it raises the dimension.
///
/// `passes` returns true if the zone may grow across an edge, given as a cell and the index of the
/// edge in it: if the edge is not constrained.
///
/// # Errors
/// If links of the structure contradict each other, and what `passes` returns.
///
/// # Complexity
/// That of [`locate`](super::locate), and time proportional to the size of the zone.
pub fn conflict_zone<T: Embedded<3>>(
    t: &T,
    q: &PointOf<T, 3>,
    near: Option<CellId>,
    passes: impl Fn(CellId, usize) -> Result<bool, T::Error>,
) -> Result<Option<ConflictZone>, T::Error> {
    zone_at(t, q, locate(t, q, near)?, passes)
}

/// Returns what the insertion of a point would destroy, given its location; see [`conflict_zone`].
pub(super) fn zone_at<T: Embedded<3>>(
    t: &T,
    q: &PointOf<T, 3>,
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
        // A point on an edge destroys the cells on both sides, constraint or not.
        let is_split = from == start && on.contains(i);
        Ok(is_split || passes(from, i)? && in_conflict(t, beyond, q)?)
    };
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

impl<G: Geometry<3>, V, C: Copy + Default> Delaunay<G, 3, V, C> {
    /// Returns what the insertion of a point would destroy, in the plane or on a line: the cells
    /// whose circumcircle contains the point, with ties broken as insertion breaks them. `None` if
    /// the point is on a vertex, if it would raise the dimension, or if the geometry does not
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
