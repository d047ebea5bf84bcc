//! What a segment in space meets next.
//!
//! The relative interiors of vertices, edges, facets and cells fill the hull without overlap. A
//! segment stays in one of them for a while, leaves it at a point of its border, and so on. What
//! comes next is decided by orientations of given points alone; no point in between is computed.
//!
//! - *Into.* From a point of a face (a vertex, an edge, a facet) the segment continues in that cell
//!   around it whose facets at the face all have the end of the segment on their inner side, or on
//!   them. It leaves the face toward the vertices opposite those that it is strictly inside of.
//! - *Out of.* A line pierces a triangle at a point whose barycentric coordinates are proportional
//!   to the volumes that it spans with the opposite edges. The corners whose coordinates are not
//!   zero span what it meets there. In a plane, the same holds for edges and areas.

use std::borrow::Borrow;
use std::cmp::Ordering;

use rustc_hash::FxHashSet;

use crate::embedded::sides::side_of_facet;
use crate::embedded::{Embedded, PointOf};
use crate::geometry::Geometry;
use crate::num::Sign;
use crate::tds::{CellId, Complex, VertexId, space};

/// A cell, facet, edge or vertex in space whose relative interior a segment meets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpacePassage {
    /// The segment goes through a tetrahedron.
    Cell(CellId),
    /// The segment meets a facet in one point: it crosses the facet, starts or ends on it. The
    /// facet opposite this vertex of the cell that the segment leaves, which is infinite where the
    /// segment enters the hull. In dimension 2 it is the cell itself, and the index is 3.
    Facet(CellId, usize),
    /// The segment goes along within a facet. In dimension 2 it is the cell itself, and the index
    /// is 3.
    WithinFacet(CellId, usize),
    /// The segment meets an edge in one point.
    Edge(space::Edge),
    /// The segment goes along an edge, from the first vertex toward the second.
    Along([VertexId; 2]),
    /// The segment goes through a vertex.
    Vertex(VertexId),
}

impl SpacePassage {
    /// Returns a cell that has the facet, edge or vertex.
    fn cell_in<T: Complex<4>>(self, complex: &T) -> Result<Option<CellId>, T::Error> {
        match self {
            SpacePassage::Cell(cell)
            | SpacePassage::Facet(cell, _)
            | SpacePassage::WithinFacet(cell, _)
            | SpacePassage::Edge((cell, ..)) => Ok(Some(cell)),
            SpacePassage::Along([vertex, _]) | SpacePassage::Vertex(vertex) => {
                complex.cell_of(vertex)
            }
        }
    }
}

/// The corners of a cell that span one of its faces.
pub(crate) type Span = [bool; 4];

/// Returns the last cell on the line from a vertex to a point, or one at what the line meets last.
///
/// The triangulation has full dimension.
pub(super) fn last_cell<T: Embedded<4>>(
    t: &T,
    from: VertexId,
    q: &PointOf<T, 4>,
) -> Result<Option<CellId>, T::Error> {
    let mut line = LineWalk::new(t, [t.point(from)?.borrow(), q]);
    let mut met = SpacePassage::Vertex(from);
    for _ in 0..line.most() {
        let Some(next) = line.after(met)? else { break };
        met = next;
    }
    met.cell_in(t.complex())
}

/// A segment with different ends, in the line, plane or space that the vertices span.
pub(crate) struct LineWalk<'t, T: Embedded<4>> {
    t: &'t T,
    a: PointOf<T, 4>,
    b: PointOf<T, 4>,
    /// The cell beyond the facet that was met last, and the facet in it, if the segment goes that
    /// far. The line enters this cell through the interior of the facet.
    ahead: Option<(CellId, usize)>,
}

impl<'t, T: Embedded<4>> LineWalk<'t, T> {
    pub(crate) fn new(t: &'t T, [a, b]: [&PointOf<T, 4>; 2]) -> Self {
        LineWalk {
            t,
            a: *a,
            b: *b,
            ahead: None,
        }
    }

    /// Returns a bound of the number of passages: each cell, facet, edge and vertex is met once.
    pub(crate) fn most(&self) -> usize {
        let simplices = (1 << self.t.complex().width().min(4)) - 1;
        self.t.complex().cell_slots().saturating_mul(simplices)
    }

    /// Returns the orientation of the segment and an edge: on which side the line passes the edge.
    pub(crate) fn side(&self, from: VertexId, to: VertexId) -> Result<Sign, T::Error> {
        let [from, to] = [self.t.point(from)?, self.t.point(to)?];
        Ok(self
            .t
            .geometry()
            .orientation([&self.a, &self.b, from.borrow(), to.borrow()]))
    }

    /// Returns the side of the line that a vertex lies on, within a plane that contains both.
    pub(crate) fn side_in_plane(&self, vertex: VertexId) -> Result<Sign, T::Error> {
        Ok(self.t.geometry().orientation_in_flat(&[
            &self.a,
            &self.b,
            self.t.point(vertex)?.borrow(),
        ]))
    }

    /// Returns the side of an edge that a point lies on, within a plane that contains both.
    pub(crate) fn beside(
        &self,
        [from, to]: [VertexId; 2],
        p: &PointOf<T, 4>,
    ) -> Result<Sign, T::Error> {
        let [from, to] = [self.t.point(from)?, self.t.point(to)?];
        Ok(self
            .t
            .geometry()
            .orientation_in_flat(&[from.borrow(), to.borrow(), p]))
    }

    /// Compares points on the line: `Less` if the first comes first.
    fn order(&self, p: &PointOf<T, 4>, q: &PointOf<T, 4>) -> Ordering {
        let geometry = self.t.geometry();
        let order = geometry.compare(p, q);
        if geometry.compare(&self.b, &self.a).is_lt() {
            order.reverse()
        } else {
            order
        }
    }

    /// Returns what is met first by a segment that starts in the interior of a face of a finite
    /// cell.
    pub(crate) fn first_from(
        &mut self,
        cell: CellId,
        span: Span,
    ) -> Result<Option<SpacePassage>, T::Error> {
        let width = self.t.complex().width().min(4);
        let mut off = None;
        for i in (0..width).filter(|&i| !span[i]) {
            let side = side_of_facet(self.t, cell, i, &self.b)?;
            if side != Sign::Zero {
                off = Some((i, side));
            }
        }
        let corners = span.into_iter().filter(|&spans| spans).count();
        match off {
            None if corners > 1 => self.within(cell, span).map(Some),
            Some((i, side)) if corners == 3 && width == 4 => self.facet(cell, i, side).map(Some),
            _ => Ok(at_point(self.t.complex(), cell, span)?),
        }
    }

    /// Returns what is met first by a segment that starts outside of the hull, beyond the finite
    /// facet of an infinite cell. Visits facets of the hull that are visible from there.
    pub(crate) fn first_from_outside(
        &mut self,
        start: CellId,
    ) -> Result<Option<SpacePassage>, T::Error> {
        let complex = self.t.complex();
        let width = complex.width().min(4);
        let mut seen = FxHashSet::from_iter([start]);
        let mut visible = vec![start];
        let mut done = 0;
        while let Some(&cell) = visible.get(done) {
            done += 1;
            let Some(infinite) = complex.index_of(cell, VertexId::INFINITE)? else {
                continue;
            };
            let inner = complex.inner(cell)?;
            let i = complex.index_of_neighbor(inner, cell)?;
            if side_of_facet(self.t, inner, i, &self.a)? != Sign::Negative {
                continue;
            }
            let side = side_of_facet(self.t, inner, i, &self.b)?;
            if side != Sign::Negative
                && let Some(span) = self.entered(inner, i)?
            {
                let is_facet = span.into_iter().filter(|&spans| spans).count() == 3;
                return if is_facet {
                    self.facet(cell, infinite, -side).map(Some)
                } else {
                    at_point(complex, inner, span)
                };
            }
            for k in (0..width).filter(|&k| k != infinite) {
                let beside = complex.neighbor(cell, k)?;
                if seen.insert(beside) {
                    visible.push(beside);
                }
            }
        }
        Ok(None)
    }

    /// Returns the face at which the line enters a finite cell through a facet with its border.
    /// `None` if it does not.
    fn entered(&self, cell: CellId, i: usize) -> Result<Option<Span>, T::Error> {
        let corners = self.t.complex().corners(cell)?;
        match self.t.complex().width() {
            4 => pierced(i, |k, l| self.side(corners[l], corners[k])),
            3 => {
                let ends @ [from, to] = [(i + 1) % 3, (i + 2) % 3];
                let turn = self.beside(
                    [corners[from], corners[to]],
                    self.t.point(corners[i])?.borrow(),
                )?;
                let sides = [
                    self.side_in_plane(corners[from])?,
                    self.side_in_plane(corners[to])?,
                ];
                Ok(crossed(sides.map(|side| -turn * side)).map(|spans| span_of(ends, spans)))
            }
            _ => Ok(Some(span_of([1 - i.min(1)], [true]))),
        }
    }

    /// Returns what is met after a passage.
    #[inline]
    pub(crate) fn after(
        &mut self,
        passage: SpacePassage,
    ) -> Result<Option<SpacePassage>, T::Error> {
        let complex = self.t.complex();
        match passage {
            SpacePassage::Cell(cell) => self.after_cell(cell),
            SpacePassage::Facet(..) => Ok(self.ahead.map(|(cell, _)| SpacePassage::Cell(cell))),
            SpacePassage::WithinFacet(cell, i) => self.after_facet(cell, i),
            SpacePassage::Edge((cell, i, j)) if complex.width() == 4 => {
                for edge in space::cells_around_edge(complex, (cell, i, j))? {
                    let (cell, i, j) = edge?;
                    if let Some(next) = self.onward(cell, span_of([i, j], [true; 2]))? {
                        return Ok(Some(next));
                    }
                }
                Ok(None)
            }
            SpacePassage::Edge((cell, i, j)) => {
                let span = span_of([i, j], [true; 2]);
                if let Some(next) = self.onward(cell, span)? {
                    return Ok(Some(next));
                }
                let beyond = complex.neighbor(cell, 3 - i - j)?;
                let opposite = complex.index_of_neighbor(beyond, cell)?;
                self.onward(
                    beyond,
                    span_of([(opposite + 1) % 3, (opposite + 2) % 3], [true; 2]),
                )
            }
            SpacePassage::Along([_, to]) => {
                let is_met = self.order(self.t.point(to)?.borrow(), &self.b).is_le();
                Ok(is_met.then_some(SpacePassage::Vertex(to)))
            }
            SpacePassage::Vertex(vertex) => {
                if self
                    .t
                    .geometry()
                    .compare(self.t.point(vertex)?.borrow(), &self.b)
                    .is_eq()
                {
                    return Ok(None);
                }
                for (cell, i) in space::cells_around(complex, vertex)? {
                    if let Some(next) = self.onward(cell, span_of([i], [true]))? {
                        return Ok(Some(next));
                    }
                }
                Ok(None)
            }
        }
    }

    /// Returns what the segment goes into from a point of a face, if that is in this cell or on its
    /// border.
    fn onward(&self, cell: CellId, face: Span) -> Result<Option<SpacePassage>, T::Error> {
        let complex = self.t.complex();
        if complex.is_infinite(cell)? {
            return Ok(None);
        }
        let mut span = face;
        for i in (0..complex.width().min(4)).filter(|&i| !face[i]) {
            match side_of_facet(self.t, cell, i, &self.b)? {
                Sign::Negative => return Ok(None),
                Sign::Zero => {}
                Sign::Positive => span[i] = true,
            }
        }
        // Equal where the segment ends.
        if span == face {
            Ok(None)
        } else {
            self.within(cell, span).map(Some)
        }
    }

    /// Returns a passage along the interior of what corners of a cell span, two or more.
    fn within(&self, cell: CellId, span: Span) -> Result<SpacePassage, T::Error> {
        if let Some(missing) = only(span.map(|spans| !spans)) {
            return Ok(SpacePassage::WithinFacet(cell, missing));
        }
        if span == [true; 4] {
            return Ok(SpacePassage::Cell(cell));
        }
        let [from, to] = ends(span).map(|i| self.t.complex().vertex(cell, i));
        let [from, to] = [from?, to?];
        let order = self.order(self.t.point(from)?.borrow(), self.t.point(to)?.borrow());
        Ok(SpacePassage::Along(if order.is_gt() {
            [to, from]
        } else {
            [from, to]
        }))
    }

    /// Returns a facet that is crossed out of a cell, given on which side of it the segment ends.
    fn facet(&mut self, cell: CellId, i: usize, end: Sign) -> Result<SpacePassage, T::Error> {
        let complex = self.t.complex();
        let beyond = complex.neighbor(cell, i)?;
        let opposite = complex.index_of_neighbor(beyond, cell)?;
        if end == Sign::Positive {
            self.ahead = (!complex.is_infinite(cell)?).then_some((cell, i));
            return Ok(SpacePassage::Facet(beyond, opposite));
        }
        let goes_on = end == Sign::Negative && !complex.is_infinite(beyond)?;
        self.ahead = goes_on.then_some((beyond, opposite));
        Ok(SpacePassage::Facet(cell, i))
    }

    /// Returns where the segment leaves a tetrahedron.
    ///
    /// `PERF:` if it came through the interior of a facet, three orientations are known.
    fn after_cell(&mut self, cell: CellId) -> Result<Option<SpacePassage>, T::Error> {
        let corners = self.t.complex().corners(cell)?;
        let through = self
            .ahead
            .take()
            .filter(|&(ahead, _)| ahead == cell)
            .map(|(_, i)| i);
        let mut sides = [[Sign::Zero; 4]; 4];
        for [k, l] in [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]] {
            let side = match through.filter(|&i| i != k && i != l) {
                Some(i) if space::beside(i, 6 - i - k - l) == [k, l] => Sign::Negative,
                Some(_) => Sign::Positive,
                None => self.side(corners[k], corners[l])?,
            };
            (sides[k][l], sides[l][k]) = (side, -side);
        }
        for i in (0..4).filter(|&i| Some(i) != through) {
            if let Some(span) = pierced(i, |k, l| Ok(sides[k][l]))? {
                let end = side_of_facet(self.t, cell, i, &self.b)?;
                return match end {
                    Sign::Positive => Ok(None),
                    _ if only(span.map(|spans| !spans)).is_some() => {
                        self.facet(cell, i, end).map(Some)
                    }
                    _ => at_point(self.t.complex(), cell, span),
                };
            }
        }
        Ok(None)
    }

    /// Returns where the segment leaves a facet whose plane it lies in.
    fn after_facet(&self, cell: CellId, i: usize) -> Result<Option<SpacePassage>, T::Error> {
        let complex = self.t.complex();
        let corners = complex.corners(cell)?;
        let indices @ [u, v, w] = [1, 2, 3].map(|k| (i + k) % 4);
        let turn = self.beside([corners[u], corners[v]], self.t.point(corners[w])?.borrow())?;
        let mut sides = [Sign::Zero; 3];
        for k in 0..3 {
            sides[k] = turn * self.side_in_plane(corners[indices[k]])?;
        }
        for k in 0..3 {
            let next = (k + 1) % 3;
            if let Some(spans) = crossed([sides[k], sides[next]]) {
                let edge = [indices[k], indices[next]];
                if turn * self.beside(edge.map(|k| corners[k]), &self.b)? == Sign::Positive {
                    return Ok(None);
                }
                return at_point(complex, cell, span_of(edge, spans));
            }
        }
        Ok(None)
    }
}

/// Returns the face through which a line leaves a tetrahedron, if that is the facet opposite vertex
/// `i` or on its border. `side` returns on which side the line passes an edge.
pub(crate) fn pierced<E>(
    i: usize,
    side: impl Fn(usize, usize) -> Result<Sign, E>,
) -> Result<Option<Span>, E> {
    let mut span = [false; 4];
    for j in (0..4).filter(|&j| j != i) {
        let [k, l] = space::beside(i, j);
        match side(k, l)? {
            Sign::Negative => return Ok(None),
            Sign::Zero => {}
            Sign::Positive => span[j] = true,
        }
    }
    Ok((span != [false; 4]).then_some(span))
}

/// Returns which ends of an edge span the point where a line leaves a triangle across the edge, if
/// it does. The arguments are the sides of the line on which the ends lie; the triangle is to the
/// left of the edge.
fn crossed([from, to]: [Sign; 2]) -> Option<[bool; 2]> {
    let is_crossed = from != Sign::Positive && to != Sign::Negative && from != to;
    is_crossed.then_some([to == Sign::Positive, from == Sign::Negative])
}

/// Returns the corners with these indices that are marked.
pub(crate) fn span_of<const K: usize>(indices: [usize; K], marked: [bool; K]) -> Span {
    let mut span = [false; 4];
    for (i, spans) in indices.into_iter().zip(marked) {
        span[i] = spans;
    }
    span
}

/// Returns the only index that is marked.
fn only(marked: Span) -> Option<usize> {
    let mut indices = (0..4).filter(|&i| marked[i]);
    let first = indices.next()?;
    indices.next().is_none().then_some(first)
}

/// Returns the first and the last marked index.
fn ends(span: Span) -> [usize; 2] {
    let position = |mut indices: std::ops::Range<usize>| indices.find(|&i| span[i]).unwrap_or(0);
    let last = (0..4).rev().find(|&i| span[i]).unwrap_or(0);
    [position(0..4), last]
}

/// Returns a passage through one point in the interior of what corners of a finite cell span.
pub(crate) fn at_point<T: Complex<4>>(
    complex: &T,
    cell: CellId,
    span: Span,
) -> Result<Option<SpacePassage>, T::Error> {
    if let Some(missing) = only(span.map(|spans| !spans)) {
        return Ok(Some(SpacePassage::Facet(cell, missing)));
    }
    if let Some(vertex) = only(span) {
        return Ok(Some(SpacePassage::Vertex(complex.vertex(cell, vertex)?)));
    }
    let [from, to] = ends(span);
    Ok(Some(if span == [true; 4] {
        SpacePassage::Cell(cell)
    } else {
        SpacePassage::Edge((cell, from, to))
    }))
}
