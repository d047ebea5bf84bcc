//! A segment of a line: on which side of it a vertex is, and what comes first along it.

use std::cmp::Ordering;

use crate::terrain::in_order::in_order;
use crate::terrain::linear::{sorted, turn};
use crate::triangulation::kernel::{Adaptive, Exact, Kernel, PointArea, Predicate, crossing_by};
use crate::triangulation::num::{Number, Sign};

/// How precise an area has to be, relative to itself, for a position that is computed from it.
const PRECISE: f64 = 1e-12;

/// The size of products below which they may have lost digits.
const TINY: f64 = 1e-280;

/// A segment of a line in plan, of some length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    pub(super) from: [f64; 2],
    pub(super) to: [f64; 2],
    /// The ends in the order of their x and y, so that positions do not depend on the direction.
    ends: [[f64; 2]; 2],
}

/// A vertex as a segment sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen {
    pub(super) at: [f64; 3],
    /// Positive to the left of the segment, zero on its line. Exact.
    pub(super) side: Sign,
    /// Twice the area between it and the sorted ends of the segment.
    area: Area,
}

/// Twice an area, as precisely as it has to be.
#[derive(Debug, Clone, Copy)]
enum Area {
    Precise(f64),
    /// A double is not precise.
    Twice(Option<PointArea>),
}

/// A position on a segment.
#[derive(Debug, Clone, Copy)]
pub(super) enum Event {
    /// A point that lies on it exactly.
    Point([f64; 2]),
    /// Where it crosses an edge, whose ends are to its left and to its right.
    Crossing([[f64; 2]; 2]),
}

impl Segment {
    /// Returns the segment between two points; `None` if they are one.
    pub(super) fn new(from: [f64; 2], to: [f64; 2]) -> Option<Self> {
        let ends = sorted([from, to]);
        (from != to).then_some(Segment { from, to, ends })
    }

    /// Returns a vertex as the segment sees it.
    ///
    /// `PERF:` one cross product decides on the side and, later, on where edges are crossed.
    #[inline]
    pub(super) fn seen(&self, at: [f64; 3]) -> Seen {
        let [[ax, ay], [bx, by]] = self.ends;
        let products = [(bx - ax) * (at[1] - ay), (by - ay) * (at[0] - ax)];
        let area = products[0] - products[1];
        let size = products[0].abs() + products[1].abs();
        let error = 4.0 * f64::EPSILON * size;
        let is_certain = area.abs() > error && size > TINY && size.is_finite();
        let side = match (is_certain, (area > 0.0) == self.is_forward()) {
            (false, _) => turn(self.from, self.to, [at[0], at[1]]),
            (true, true) => Sign::Positive,
            (true, false) => Sign::Negative,
        };
        let is_precise = is_certain && error <= PRECISE * area.abs();
        let area = match is_precise {
            true => Area::Precise(area),
            false => Area::Twice(self.area(at)),
        };
        Seen { at, side, area }
    }

    /// Returns twice the area between a vertex and the sorted ends, with twice the digits.
    fn area(&self, at: [f64; 3]) -> Option<PointArea> {
        PointArea::new([at[0], at[1]], self.ends)
    }

    /// Returns true if the segment begins at the first of its sorted ends.
    fn is_forward(&self) -> bool {
        self.from == self.ends[0]
    }

    /// Compares positions along the segment. Exact.
    pub(super) fn compare(&self, a: &Event, b: &Event) -> Ordering {
        match (*a, *b) {
            (Event::Point(a), Event::Point(b)) => self.compare_points(a, b),
            (Event::Point(a), Event::Crossing([left, right])) => ordering(turn(left, right, a)),
            (Event::Crossing([left, right]), Event::Point(b)) => {
                ordering(turn(left, right, b)).reverse()
            }
            (Event::Crossing(a), Event::Crossing(b)) => ordering(sign(&CompareCrossings {
                segment: [self.from, self.to],
                edges: [a, b],
            })),
        }
    }

    /// Compares points on the line of the segment.
    pub(super) fn compare_points(&self, a: [f64; 2], b: [f64; 2]) -> Ordering {
        let axis = usize::from(self.from[0] == self.to[0]);
        let order = in_order(&a[axis], &b[axis]);
        if self.from[axis] < self.to[axis] {
            order
        } else {
            order.reverse()
        }
    }

    /// Returns where the segment crosses an edge, with the height of the edge there.
    ///
    /// It is computed on the edge, from its ends in one order. So both faces of the edge, and both
    /// directions of the segment, have the same.
    pub(super) fn crossing(&self, p: &Seen, q: &Seen) -> [f64; 3] {
        let is_sorted = [p.at[0], p.at[1]] <= [q.at[0], q.at[1]];
        let [p, q] = if is_sorted { [p, q] } else { [q, p] };
        let part = match (p.area, q.area) {
            (Area::Precise(at_p), Area::Precise(at_q)) => at_p / (at_p - at_q),
            _ => {
                let areas = [p, q].map(|end| match end.area {
                    Area::Precise(_) => self.area(end.at),
                    Area::Twice(area) => area,
                });
                let edge = [p, q].map(|end| [end.at[0], end.at[1]]);
                crossing_by(edge, self.ends, areas)
            }
        };
        let part = if part.is_nan() {
            0.5
        } else {
            part.clamp(0.0, 1.0)
        };
        [0, 1, 2].map(|k| p.at[k] + part * (q.at[k] - p.at[k]))
    }

    /// Returns true if the segment certainly goes on beyond the edge that it crosses at a position.
    ///
    /// `PERF:` nearly always true, and the exact test takes longer.
    #[inline]
    pub(super) fn surely_goes_on(&self, at: [f64; 3], p: &Seen, q: &Seen) -> bool {
        let [dx, dy] = [0, 1].map(|k| self.to[k] - self.from[k]);
        let [x, y] = [0, 1].map(|k| self.to[k] - at[k]);
        let edge = (p.at[0] - q.at[0]).abs() + (p.at[1] - q.at[1]).abs();
        let largest = at[0].abs() + at[1].abs() + self.to[0].abs() + self.to[1].abs();
        // Far more than the rounding errors of the position and of this.
        let error = 1e-10 * edge + 1e-14 * largest;
        x * dx + y * dy > error * (dx.abs() + dy.abs())
    }
}

/// Returns an order from the sign of a difference.
fn ordering(sign: Sign) -> Ordering {
    match sign {
        Sign::Negative => Ordering::Less,
        Sign::Zero => Ordering::Equal,
        Sign::Positive => Ordering::Greater,
    }
}

/// Returns the sign of a predicate, exact for all finite coordinates.
fn sign<P: Predicate>(predicate: &P) -> Sign {
    let admits = |axis| predicate.axis(axis).all(|c| Adaptive::RANGE.admits(c));
    if (0..P::AXES).all(admits) {
        Adaptive::sign(predicate)
    } else {
        Exact::sign(predicate)
    }
}

/// Which of two edges a segment crosses first: negative if the first one, zero if both at once.
/// The first end of each edge is to the left of the segment, the second one to its right.
#[derive(Debug, Clone, Copy)]
struct CompareCrossings {
    segment: [[f64; 2]; 2],
    edges: [[[f64; 2]; 2]; 2],
}

impl Predicate for CompareCrossings {
    const DEGREE: i32 = 4;
    const AXES: usize = 2;

    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        let points = self.segment.iter().chain(self.edges.iter().flatten());
        points.map(move |p| p[axis])
    }

    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [from, to] = self.segment;
        let minus = |p: [f64; 2], q: [f64; 2]| [0, 1].map(|k| difference(p[k], q[k]));
        let cross = |u: [T; 2], v: [T; 2]| {
            let ([ux, uy], [vx, vy]) = (u, v);
            ux * vy - uy * vx
        };
        // Each is crossed at the quotient of both, whose divisors are negative.
        let [a, b] = self.edges.map(|[left, right]| {
            let at_start = cross(minus(left, from), minus(right, from));
            (at_start, cross(minus(to, from), minus(right, left)))
        });
        a.0 * b.1 - b.0 * a.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_along_a_segment_are_compared_exactly() {
        let segment = Segment::new([0.0, 0.0], [3.0, 1.0]).unwrap();
        let edge = |x: f64| Event::Crossing([[x, 9.0], [x, -9.0]]);
        // Through (1.5, 0.5) at another angle.
        let slanted = Event::Crossing([[0.5, 1.5], [2.5, -0.5]]);
        assert_eq!(segment.compare(&edge(1.5), &slanted), Ordering::Equal);
        assert_eq!(
            segment.compare(&edge(1.5f64.next_up()), &slanted),
            Ordering::Greater
        );
        assert_eq!(
            segment.compare(&edge(1.5f64.next_down()), &slanted),
            Ordering::Less
        );
        let point = Event::Point([1.5, 0.5]);
        assert_eq!(segment.compare(&point, &slanted), Ordering::Equal);
        assert_eq!(segment.compare(&slanted, &point), Ordering::Equal);
        assert_eq!(
            segment.compare(&Event::Point([0.0, 0.0]), &slanted),
            Ordering::Less
        );
        assert_eq!(
            segment.compare(&slanted, &Event::Point([0.0, 0.0])),
            Ordering::Greater
        );
        let back = Segment::new([3.0, 1.0], [0.0, 0.0]).unwrap();
        let turned = |event| match event {
            Event::Crossing([left, right]) => Event::Crossing([right, left]),
            point => point,
        };
        assert_eq!(
            back.compare(&turned(edge(1.0)), &turned(slanted)),
            Ordering::Greater
        );
        assert_eq!(
            back.compare(&Event::Point([3.0, 1.0]), &point),
            Ordering::Less
        );
    }

    #[test]
    fn a_crossing_does_not_depend_on_directions() {
        let [a, b] = [[437_512.3, 5_812_004.7], [438_100.1, 5_811_800.2]];
        let [p, q] = [
            [437_700.0, 5_812_100.0, 3.0],
            [437_712.5, 5_811_700.0, 17.0],
        ];
        let one = Segment::new(a, b).unwrap();
        let back = Segment::new(b, a).unwrap();
        let seen = |by: &Segment| [p, q].map(|end| by.seen(end));
        let ([p, q], [r, s]) = (seen(&one), seen(&back));
        assert_eq!((p.side, r.side), (Sign::Positive, Sign::Negative));
        let at = one.crossing(&p, &q);
        assert_eq!(at, one.crossing(&q, &p));
        assert_eq!(at, back.crossing(&r, &s));
        assert!(one.surely_goes_on(at, &p, &q) && back.surely_goes_on(at, &r, &s));
    }
}
