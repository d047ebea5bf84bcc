//! The faces, edges and vertices that a segment meets.

use std::borrow::Borrow;
use std::cmp::Ordering;

use crate::embedded::{Embedded, PointOf};
use crate::geometry::Geometry;
use crate::locate::Location;
use crate::locate::locate;
use crate::num::Sign;
use crate::tds::{CellId, Complex, Star, VertexId, ccw, cw, plane};
use crate::triangulation::Triangulation;

/// A face, edge or vertex whose interior a segment meets: faces are open, and so are edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passage {
    /// The segment goes through a face.
    Face(CellId),
    /// The segment goes across an edge, or ends on it: the edge opposite this vertex of the cell
    /// that the segment leaves. That cell is infinite where the segment enters the hull.
    Edge(CellId, usize),
    /// The segment goes along an edge, from the first vertex toward the second. The faces on both
    /// sides are those of [`Tds::edge`] for both directions.
    ///
    /// [`Tds::edge`]: crate::tds::Tds::edge
    Along([VertexId; 2]),
    /// The segment goes through a vertex.
    Vertex(VertexId),
}

impl<G: Geometry<3>, V, C: Copy + Default> Triangulation<G, 3, V, C> {
    /// Returns all that a segment meets, in order from `a` to `b`, which may be equal.
    ///
    /// If the segment meets two faces or edges only at their common border, the border is returned:
    /// a segment through a vertex meets the vertex and perhaps two faces, but none of the edges
    /// there. Nothing is met outside of the hull, below dimension 2, or if the geometry does not
    /// [admit](Geometry::admits) `a` or `b`. Exact.
    ///
    /// # Complexity
    /// A [walk](Self::locate) to `a` from a cell nearby; then constant time for a face or an edge,
    /// and the degree of each vertex. If `a` lies outside of the hull, proportional to the size of
    /// the hull: start from the end that is inside, if one is.
    ///
    /// ```
    /// use breakline_triangulation::{geometry::Plane, Delaunay, Passage};
    ///
    /// // Two faces, with the edge from the lower right to the upper left between them.
    /// let points = [[0.0, 0.0], [4.0, 0.0], [5.0, 5.0], [0.0, 4.0]];
    /// let (t, v) = Delaunay::from_points(Plane::new(), &points)?;
    /// let met: Vec<Passage> = t.along([&[-1.0, -1.0], &[3.0, 3.0]], None).collect();
    /// assert!(matches!(met[..], [Passage::Vertex(w), Passage::Face(_), Passage::Edge(..), Passage::Face(_)] if w == v[0]));
    /// let met: Vec<Passage> = t.along([&[1.0, 0.0], &[4.0, 0.0]], None).collect();
    /// assert_eq!(met, [Passage::Along([v[0], v[1]]), Passage::Vertex(v[1])]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn along<'t>(
        &'t self,
        [a, b]: [&G::Point; 2],
        near: Option<CellId>,
    ) -> impl Iterator<Item = Passage> + use<'t, G, V, C> {
        let Ok(along) = along(self, [a, b], self.start(near));
        along.map(|Ok(passage)| passage)
    }
}

/// Returns all that a segment meets, in order from its first point to the second; see
/// [`Triangulation::along`]. The walk to the first point starts at a cell nearby. Ends at the first
/// error.
///
/// # Errors
/// If links of the structure contradict each other.
///
/// # Complexity
/// That of [`Triangulation::along`].
pub fn along<'t, T: Embedded<3>>(
    t: &'t T,
    [a, b]: [&PointOf<T, 3>; 2],
    near: Option<CellId>,
) -> Result<impl Iterator<Item = Result<Passage, T::Error>> + use<'t, T>, T::Error> {
    let location = if t.complex().dimension() == 2 {
        locate(t, a, near)?
    } else {
        Location::OutsideAffineHull
    };
    Ok(Along::new(t, [a, b], location))
}

/// Iterates over what a segment meets, from its start on.
struct Along<'t, T: Embedded<3>> {
    segment: Segment<'t, T>,
    next: Result<Option<Passage>, T::Error>,
    /// The number of faces met. Each is met once: if there are more, links are wrong.
    faces: usize,
    /// The vertex that was met last: the next one is further along.
    vertex: Option<VertexId>,
}

impl<'t, T: Embedded<3>> Along<'t, T> {
    /// Starts at the location of the segment's first point.
    fn new(t: &'t T, [a, b]: [&PointOf<T, 3>; 2], location: Location) -> Self {
        let segment = Segment { t, a: *a, b: *b };
        let next = if t.geometry().admits(b) {
            segment.first(location)
        } else {
            Ok(None)
        };
        Along {
            segment,
            next,
            faces: 0,
            vertex: None,
        }
    }

    fn after(&mut self, passage: Passage) -> Result<Option<Passage>, T::Error> {
        let complex = self.segment.t.complex();
        match passage {
            Passage::Face(cell) => {
                self.faces += 1;
                complex.ensure(cell, || self.faces <= complex.cell_slots())?;
            }
            Passage::Vertex(vertex) => {
                if let (Some(last), Some(cell)) =
                    (self.vertex.replace(vertex), complex.cell_of(vertex)?)
                {
                    complex.ensure(cell, || {
                        self.segment
                            .order_of(last, vertex)
                            .is_ok_and(Ordering::is_gt)
                    })?;
                }
            }
            Passage::Edge(..) | Passage::Along(_) => {}
        }
        self.segment.after(passage)
    }
}

impl<T: Embedded<3>> Iterator for Along<'_, T> {
    type Item = Result<Passage, T::Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let passage = std::mem::replace(&mut self.next, Ok(None)).transpose()?;
        if let Ok(passage) = passage {
            self.next = self.after(passage);
        }
        Some(passage)
    }
}

/// A segment, and what it meets next.
struct Segment<'t, T: Embedded<3>> {
    t: &'t T,
    a: PointOf<T, 3>,
    b: PointOf<T, 3>,
}

impl<T: Embedded<3>> Segment<'_, T> {
    /// Returns the side of the line that a vertex lies on: positive on the left.
    fn side(&self, vertex: VertexId) -> Result<Sign, T::Error> {
        Ok(self
            .t
            .geometry()
            .orientation([&self.a, &self.b, self.t.point(vertex)?.borrow()]))
    }

    /// Returns the side of an edge that a point lies on.
    fn beside(&self, [from, to]: [VertexId; 2], p: &PointOf<T, 3>) -> Result<Sign, T::Error> {
        Ok(self.t.geometry().orientation([
            self.t.point(from)?.borrow(),
            self.t.point(to)?.borrow(),
            p,
        ]))
    }

    /// Returns the side of an edge that the segment ends on.
    fn end_side(&self, edge: [VertexId; 2]) -> Result<Sign, T::Error> {
        self.beside(edge, &self.b)
    }

    /// Compares points on the line: `Greater` if `q` comes after `p` along the segment.
    fn order(&self, p: &PointOf<T, 3>, q: &PointOf<T, 3>) -> Ordering {
        let g = self.t.geometry();
        let order = g.compare(q, p);
        if g.compare(&self.b, &self.a).is_lt() {
            order.reverse()
        } else {
            order
        }
    }

    /// Like [`order`](Self::order), for vertices.
    fn order_of(&self, p: VertexId, q: VertexId) -> Result<Ordering, T::Error> {
        Ok(self.order(self.t.point(p)?.borrow(), self.t.point(q)?.borrow()))
    }

    /// Like [`order`](Self::order), for a vertex and the end of the segment.
    fn order_to_end(&self, vertex: VertexId) -> Result<Ordering, T::Error> {
        Ok(self.order(self.t.point(vertex)?.borrow(), &self.b))
    }

    /// Returns a vertex on the line as what is met next, if the segment goes that far.
    fn up_to(&self, vertex: VertexId) -> Result<Option<Passage>, T::Error> {
        Ok(self
            .order_to_end(vertex)?
            .is_ge()
            .then_some(Passage::Vertex(vertex)))
    }

    fn first(&self, location: Location) -> Result<Option<Passage>, T::Error> {
        let complex = self.t.complex();
        Ok(match location {
            Location::Vertex(vertex) => Some(Passage::Vertex(vertex)),
            Location::Cell { cell, facets } => {
                let Some(i) = facets.iter().next() else {
                    return Ok(Some(Passage::Face(cell)));
                };
                let ends @ [from, to] = plane::edge_ends(complex, cell, i)?;
                let beyond = complex.neighbor(cell, i)?;
                Some(match self.end_side(ends)? {
                    Sign::Negative => Passage::Edge(cell, i),
                    Sign::Positive => {
                        Passage::Edge(beyond, complex.index_of_neighbor(beyond, cell)?)
                    }
                    Sign::Zero if self.order(&self.a, &self.b).is_eq() => Passage::Edge(cell, i),
                    Sign::Zero if self.order_of(from, to)?.is_gt() => Passage::Along([from, to]),
                    Sign::Zero => Passage::Along([to, from]),
                })
            }
            Location::OutsideHull { .. } => self.entry()?,
            Location::OutsideAffineHull | Location::Nowhere => None,
        })
    }

    /// Returns what a segment from outside of the hull meets first: an edge that runs from its left
    /// to its right, or, if there is none, the first vertex that the segment goes through.
    fn entry(&self) -> Result<Option<Passage>, T::Error> {
        let complex = self.t.complex();
        let mut touched: Option<VertexId> = None;
        for cell in Star::new(complex, VertexId::INFINITE, 2)? {
            let (cell, i) = cell?;
            // The infinite face lies outside: the hull runs from `to` to `from`.
            let ends @ [to, from] = plane::edge_ends(complex, cell, i)?;
            let sides = [self.side(from)?, self.side(to)?];
            if sides == [Sign::Positive, Sign::Negative] {
                let starts_outside = self.beside([to, from], &self.a)? == Sign::Positive;
                let arrives = self.end_side(ends)? != Sign::Positive;
                return Ok((starts_outside && arrives).then_some(Passage::Edge(cell, i)));
            }
            let is_first = match touched {
                Some(first) => self.order_of(from, first)?.is_gt(),
                None => true,
            };
            if sides[0] == Sign::Zero && is_first {
                touched = Some(from);
            }
        }
        match touched {
            Some(v) if self.order(&self.a, self.t.point(v)?.borrow()).is_gt() => self.up_to(v),
            _ => Ok(None),
        }
    }

    fn after(&self, passage: Passage) -> Result<Option<Passage>, T::Error> {
        let complex = self.t.complex();
        match passage {
            Passage::Vertex(vertex) => self.after_vertex(vertex),
            Passage::Along([_, to]) => self.up_to(to),
            Passage::Edge(cell, i) => {
                let beyond = complex.neighbor(cell, i)?;
                let goes_on = self.end_side(plane::edge_ends(complex, cell, i)?)? == Sign::Negative;
                Ok((goes_on && !complex.is_infinite(beyond)?).then_some(Passage::Face(beyond)))
            }
            Passage::Face(cell) => self.after_face(cell),
        }
    }

    /// Returns what the segment meets after a face. A line leaves a triangle where the border,
    /// counter-clockwise, crosses it from right to left.
    fn after_face(&self, cell: CellId) -> Result<Option<Passage>, T::Error> {
        let complex = self.t.complex();
        let corners @ [u, v, w] = complex.corners(cell)?;
        let sides = [self.side(u)?, self.side(v)?, self.side(w)?];
        let Some(last) =
            (0..3).find(|&i| sides[i] == Sign::Negative && sides[ccw(i)] != Sign::Negative)
        else {
            return Ok(None);
        };
        if sides[ccw(last)] == Sign::Zero {
            return self.up_to(corners[ccw(last)]);
        }
        let i = cw(last);
        Ok(
            (self.end_side(plane::edge_ends(complex, cell, i)?)? != Sign::Positive)
                .then_some(Passage::Edge(cell, i)),
        )
    }

    fn after_vertex(&self, vertex: VertexId) -> Result<Option<Passage>, T::Error> {
        let complex = self.t.complex();
        if self.order_to_end(vertex)?.is_le() {
            return Ok(None);
        }
        for edge in plane::edges_around(complex, vertex)? {
            let (cell, i) = edge?;
            // The next edge of the cell is opposite the vertex.
            let [right, left] = [complex.vertex(cell, cw(i))?, complex.vertex(cell, i)?];
            if right == VertexId::INFINITE {
                continue;
            }
            match self.side(right)? {
                Sign::Zero if self.order_of(vertex, right)?.is_gt() => {
                    return Ok(Some(Passage::Along([vertex, right])));
                }
                Sign::Negative
                    if left != VertexId::INFINITE && self.side(left)? == Sign::Positive =>
                {
                    return Ok(Some(Passage::Face(cell)));
                }
                _ => {}
            }
        }
        Ok(None)
    }
}
