//! The cells, facets, edges and vertices that a segment in space meets.

use std::borrow::Borrow;

use crate::embedded::sides::leaves_flat;
use crate::embedded::{Embedded, PointOf};
use crate::geometry::Geometry;
use crate::locate::line::{LineWalk, at_point, pierced, span_of};
use crate::locate::locate;
use crate::locate::{Location, SpacePassage};
use crate::num::Sign;
use crate::tds::{CellId, Complex, vertices_of};
use crate::triangulation::Triangulation;

impl<G: Geometry<4>, V, C: Copy + Default> Triangulation<G, 4, V, C> {
    /// Returns all that a segment in space meets, in order from `a` to `b`, which may be equal.
    ///
    /// The passages are through relative interiors: a segment through a vertex meets the vertex and
    /// perhaps two cells, but none of the edges and facets there. Nothing is met outside of the
    /// hull, or if the geometry does not [admit](Geometry::admits) `a` or `b`. Below dimension 3
    /// the segment may lie in the line or plane of all points, or meet it in one point. Exact.
    ///
    /// # Complexity
    /// A [walk](Self::locate) to `a` from a cell nearby; then constant time for each cell and
    /// facet, and time proportional to the number of cells around each edge and vertex. If `a` lies
    /// outside of the hull, also proportional to the number of facets of the hull that are visible
    /// from there: start from the end that is inside, if one is. If `a` and `b` lie on different
    /// sides of the line or plane of all points, proportional to the number of cells.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Space, Delaunay, SpacePassage};
    ///
    /// // Two tetrahedra, with a facet between them.
    /// let points = [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 0.0], [1.0, 1.0, 3.0], [1.0, 1.0, -3.0]];
    /// let (t, v) = Delaunay::from_points(Space::new(), &points)?;
    /// let met: Vec<SpacePassage> = t.along([&[1.0, 1.0, 5.0], &[1.0, 1.0, -1.0]], None).collect();
    /// assert_eq!(met[0], SpacePassage::Vertex(v[3]));
    /// assert!(matches!(met[1..], [SpacePassage::Cell(_), SpacePassage::Facet(..), SpacePassage::Cell(_)]));
    /// let met: Vec<SpacePassage> = t.along([&[1.0, 0.0, 0.0], &[4.0, 0.0, 0.0]], None).collect();
    /// assert_eq!(met, [SpacePassage::Along([v[2], v[0]]), SpacePassage::Vertex(v[0])]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn along<'t>(
        &'t self,
        [a, b]: [&G::Point; 2],
        near: Option<CellId>,
    ) -> impl Iterator<Item = SpacePassage> + use<'t, G, V, C> {
        let Ok(along) = along_in_space(self, [a, b], self.start(near));
        along.map(|Ok(passage)| passage)
    }
}

/// Returns all that a segment in space meets, in order from its first point to the second. The walk
/// to the first point starts at a cell nearby. Ends at the first error.
///
/// # Errors
/// If links of the structure contradict each other.
///
/// # Complexity
/// See [`Triangulation::along`](crate::Triangulation::along): in space, also time proportional to
/// the number of cells around each edge and vertex that is met.
pub fn along_in_space<'t, T: Embedded<4>>(
    t: &'t T,
    [a, b]: [&PointOf<T, 4>; 2],
    near: Option<CellId>,
) -> Result<impl Iterator<Item = Result<SpacePassage, T::Error>> + use<'t, T>, T::Error> {
    let complex = t.complex();
    let mut line = LineWalk::new(t, [a, b]);
    let location = if t.geometry().admits(b) {
        locate(t, a, near)?
    } else {
        Location::Nowhere
    };
    let stays = match location.cell_in(complex)? {
        Some(_) if t.geometry().compare(a, b).is_eq() => false,
        Some(cell) if complex.width() < 4 => !leaves_flat(t, complex.inner(cell)?, b)?,
        Some(_) => true,
        None => false,
    };
    let (mut point, mut next) = (None, None);
    match location {
        Location::Vertex(vertex) if stays => next = Some(SpacePassage::Vertex(vertex)),
        Location::Cell { cell, facets } if stays => {
            let width = complex.width();
            next = line.first_from(
                cell,
                std::array::from_fn(|i| i < width && !facets.contains(i)),
            )?;
        }
        Location::OutsideHull { cell } if stays => next = line.first_from_outside(cell)?,
        Location::OutsideAffineHull => {
            let end = locate(t, b, near)?;
            point = if end == Location::OutsideAffineHull {
                through_flat(t, [a, b])?
            } else {
                point_at(t, end)?
            };
        }
        _ => point = point_at(t, location)?,
    }
    let walk = Along {
        left: line.most(),
        line,
        next: Ok(next),
    };
    Ok(point.map(Ok).into_iter().chain(walk))
}

/// Returns what a point is on or in.
fn point_at<T: Embedded<4>>(t: &T, location: Location) -> Result<Option<SpacePassage>, T::Error> {
    match location {
        Location::Vertex(vertex) => Ok(Some(SpacePassage::Vertex(vertex))),
        Location::Cell { cell, facets } => {
            let width = t.complex().width();
            at_point(
                t.complex(),
                cell,
                std::array::from_fn(|i| i < width && !facets.contains(i)),
            )
        }
        Location::OutsideHull { .. } | Location::OutsideAffineHull | Location::Nowhere => Ok(None),
    }
}

/// Returns what a segment meets whose ends lie outside of the line or plane of all points.
fn through_flat<T: Embedded<4>>(
    t: &T,
    [a, b]: [&PointOf<T, 4>; 2],
) -> Result<Option<SpacePassage>, T::Error> {
    let (complex, geometry) = (t.complex(), t.geometry());
    let width = complex.width();
    if width == 1 {
        let Some(vertex) = vertices_of(complex).next().transpose()? else {
            return Ok(None);
        };
        let point = t.point(vertex)?;
        let is_on_line = geometry.orientation_in_flat(&[a, b, point.borrow()]) == Sign::Zero;
        let is_between = geometry.compare(a, point.borrow()) == geometry.compare(point.borrow(), b);
        return Ok((is_on_line && is_between).then_some(SpacePassage::Vertex(vertex)));
    }
    let cells = (0..complex.cell_slots())
        .map(CellId::new)
        .filter(|&cell| complex.is_used(cell));
    for cell in cells {
        if complex.is_infinite(cell)? {
            continue;
        }
        let span = if width == 2 {
            across_edge(t, [a, b], cell)?
        } else {
            across_triangle(t, [a, b], cell)?
        };
        if let Some(span) = span {
            return at_point(complex, cell, span);
        }
    }
    Ok(None)
}

/// Returns which corners of a cell of dimension 1 span the point where a segment crosses it, if it
/// does.
fn across_edge<T: Embedded<4>>(
    t: &T,
    [a, b]: [&PointOf<T, 4>; 2],
    cell: CellId,
) -> Result<Option<[bool; 4]>, T::Error> {
    let [u, v, ..] = t.complex().corners(cell)?;
    let line = LineWalk::new(t, [a, b]);
    let is_apart = line.side(u, v)? == Sign::Zero
        && line.beside([u, v], a)? * line.beside([u, v], b)? == Sign::Negative;
    let sides = [line.side_in_plane(u)?, line.side_in_plane(v)?];
    let is_crossed = is_apart && sides[0] * sides[1] != Sign::Positive && sides[0] != sides[1];
    Ok(is_crossed.then_some(span_of(
        [0, 1],
        [sides[1] != Sign::Zero, sides[0] != Sign::Zero],
    )))
}

/// Returns which corners of a cell of dimension 2 span the point where a segment crosses it, if it
/// does.
fn across_triangle<T: Embedded<4>>(
    t: &T,
    [a, b]: [&PointOf<T, 4>; 2],
    cell: CellId,
) -> Result<Option<[bool; 4]>, T::Error> {
    let [u, v, w, _] = t.complex().corners(cell)?;
    let [p, q, r] = [t.point(u)?, t.point(v)?, t.point(w)?];
    let above = |x| {
        t.geometry()
            .orientation([p.borrow(), q.borrow(), r.borrow(), x])
    };
    // From the side of a tetrahedron over the triangle, the line leaves that.
    let ends = match [above(a), above(b)] {
        [Sign::Positive, Sign::Negative] => [a, b],
        [Sign::Negative, Sign::Positive] => [b, a],
        _ => return Ok(None),
    };
    let (line, corners) = (LineWalk::new(t, ends), [u, v, w]);
    pierced(3, |k, l| line.side(corners[k], corners[l]))
}

/// Iterates over what a segment meets.
struct Along<'t, T: Embedded<4>> {
    line: LineWalk<'t, T>,
    next: Result<Option<SpacePassage>, T::Error>,
    /// The number of passages that are still possible. Each is met once: there are more only if
    /// links or predicates are wrong.
    left: usize,
}

impl<T: Embedded<4>> Iterator for Along<'_, T> {
    type Item = Result<SpacePassage, T::Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let passage = std::mem::replace(&mut self.next, Ok(None)).transpose()?;
        if let Ok(passage) = passage {
            self.left = self.left.saturating_sub(1);
            self.next = if self.left > 0 {
                self.line.after(passage)
            } else {
                Ok(None)
            };
        }
        Some(passage)
    }
}
