//! The questions of a merge, answered by floating point where that is certain.
//!
//! All questions are about points seen from one of them, `a`. With `u = b - a`, `v = c - a`, `w = q - a` and the
//! squares of their lengths `U`, `V`, `W`:
//!
//! ```text
//!                | ux uy U |
//!   in-circle  - | vx vy V |  =  wx (U vy - uy V) + wy (ux V - U vx) - W (ux vy - uy vx), positive inside
//!                | wx wy W |
//! ```
//!
//! The three factors are the plane through the lifted points: two questions about one circle share them, and the last
//! is the orientation of `a b c`.
//!
//! *Error.* A rounding changes a value by a factor between `1 - e` and `1 + e`, `e = 2^-53`. Of each term count those
//! that it passes through: a difference takes 1, and `U` 4 (two of its differences, the product, the sum). `U vy` has 6
//! with its own, 7 after the subtraction; times `wx`, 9 with its own, and 11 after the two sums. `W ux vy` has 10. So
//! the error is at most `((1 + e)^11 - 1) M`, where `M` is the sum of the terms' magnitudes (Higham 2002, lemma 3.1).
//! By Cauchy and Schwarz `|wx vy| + |wy vx| <= |w| |v|`; a product of three lengths is no larger than their quadratic
//! mean cubed, and their sum no larger than that mean three times. With `S = U + V + W`:
//!
//! ```text
//!   M <= U |v| |w| + V |u| |w| + W |u| |v| = |u| |v| |w| (|u| + |v| + |w|) <= (S / 3)^(3/2) (3 S)^(1/2) = S^2 / 3
//! ```
//!
//! So the bound is `11/3 e S^2 = 4.08e-16 S^2`, but for terms in `e^2` and the 14 roundings of the computed bound
//! itself, for which a tenth on top is ample. In the [range](crate::kernel::RANGE) of expansions nothing overflows, and
//! nothing underflows: all is a multiple of `2^-848`.
//!
//! *Orientation.* `ux vy - uy vx` with Shewchuk's bound (1997, section 4.3).
//!
//! What is not certain is asked of the geometry, out of line, but for points on a grid: see
//! [`in_circle_slowly`](Seen::in_circle_slowly).

use crate::geometry::{Coordinates, in_sphere, in_tied_circle};
use crate::num::{Sign, lattice};
use crate::parallel::*;
use crate::tds::VertexId;

use super::Grain;
use super::curve::Curve;

pub(super) type Place = [f64; 2];

/// Of the infinite vertex. Whatever is computed from it is neither positive, nor negative, nor uncertain.
pub(super) const NOWHERE: Place = [f64::NAN; 2];

/// A vector and its squared length.
#[derive(Clone, Copy)]
pub(super) struct Arrow {
    x: f64,
    y: f64,
    square: f64,
}

impl Arrow {
    #[inline(always)]
    pub(super) fn between(from: Place, to: Place) -> Self {
        let (x, y) = (to[0] - from[0], to[1] - from[1]);
        Arrow { x, y, square: x * x + y * y }
    }

    /// The orientation of the origin and the ends of two arrows.
    #[inline(always)]
    pub(super) fn turn(self, v: Arrow) -> Estimate {
        const BOUND: f64 = (3.0 + 8.0 * f64::EPSILON) * (f64::EPSILON / 2.0);
        let (left, right) = (self.x * v.y, self.y * v.x);
        Estimate { value: left - right, bound: BOUND * (left.abs() + right.abs()) }
    }

    /// The larger side of its box.
    fn size(self) -> f64 {
        self.x.abs().max(self.y.abs())
    }
}

/// A value that is off by no more than the bound.
#[derive(Clone, Copy)]
pub(super) struct Estimate {
    value: f64,
    bound: f64,
}

impl Estimate {
    #[inline(always)]
    pub(super) fn is_positive(self) -> bool {
        self.value > self.bound
    }

    #[inline(always)]
    pub(super) fn is_negative(self) -> bool {
        self.value < -self.bound
    }
}

/// The plane through three lifted points, of which one is the origin.
#[derive(Clone, Copy)]
pub(super) struct Circle {
    x: f64,
    y: f64,
    area: f64,
    squares: f64,
}

impl Circle {
    /// Of which nothing is asked.
    pub(super) const NONE: Self = Circle { x: f64::NAN, y: f64::NAN, area: f64::NAN, squares: f64::NAN };

    #[inline(always)]
    pub(super) fn through(u: Arrow, v: Arrow) -> Self {
        Circle {
            x: u.square * v.y - u.y * v.square,
            y: u.x * v.square - u.square * v.x,
            area: u.x * v.y - u.y * v.x,
            squares: u.square + v.square,
        }
    }

    /// Positive inside, if the points turn counter-clockwise.
    #[inline(always)]
    pub(super) fn side(&self, w: Arrow) -> Estimate {
        const BOUND: f64 = 4.5e-16;
        let squares = self.squares + w.square;
        Estimate { value: w.x * self.x + w.y * self.y - w.square * self.area, bound: BOUND * (squares * squares) }
    }
}

/// The orientation of three points.
#[inline(always)]
pub(super) fn turn(a: Place, b: Place, c: Place) -> Estimate {
    Arrow::between(a, b).turn(Arrow::between(a, c))
}

/// Points as a geometry sees them; with `FILTERED`, all of them have an exact place, from which answers follow.
pub(super) struct Seen<'a, G: Coordinates<N>, const N: usize, const FILTERED: bool> {
    geometry: &'a G,
    points: &'a [G::Point],
    /// The largest power of two of which all coordinates are multiples; 0 if that is too small to be of use.
    unit: f64,
    /// The one along which all points are in order.
    pub(super) curve: &'a Curve,
}

impl<'a, G: Coordinates<N>, const N: usize, const FILTERED: bool> Seen<'a, G, N, FILTERED> {
    pub(super) fn new(geometry: &'a G, points: &'a [G::Point], curve: &'a Curve, grain: Grain) -> Self {
        let unit = if FILTERED { unit(geometry, points, grain) } else { 0.0 };
        Seen { geometry, points, unit, curve }
    }

    /// Where a filter may take the vertex to be.
    #[inline(always)]
    pub(super) fn place(&self, vertex: VertexId) -> Place {
        match self.points.get(vertex.index()) {
            Some(p) if FILTERED => self.geometry.exact_plan(p).unwrap_or(NOWHERE),
            _ => NOWHERE,
        }
    }

    /// The coordinates of a finite vertex.
    #[inline(always)]
    pub(super) fn coordinates(&self, vertex: VertexId) -> Place {
        match *self.geometry.coordinates(&self.points[vertex.index()]).as_ref() {
            [x, y, ..] => [x, y],
            _ => NOWHERE,
        }
    }

    /// Whether the geometry is to be asked.
    #[inline(always)]
    pub(super) fn is_open(&self, estimate: Estimate) -> bool {
        !FILTERED || estimate.value.abs() <= estimate.bound
    }

    /// The orientation of three finite vertices.
    #[inline(always)]
    pub(super) fn turn(&self, vertices: [VertexId; 3]) -> Sign {
        self.turn_at(vertices.map(|v| self.place(v)), vertices)
    }

    /// The same, of vertices whose places are known, or where these are after a quarter turn.
    #[inline(always)]
    pub(super) fn turn_at(&self, [a, b, c]: [Place; 3], vertices: [VertexId; 3]) -> Sign {
        let estimate = turn(a, b, c);
        if self.is_open(estimate) {
            self.turn_slowly(vertices)
        } else if estimate.is_positive() {
            Sign::Positive
        } else {
            Sign::Negative
        }
    }

    /// The same; negative where one is at infinity.
    #[cold]
    #[inline(never)]
    pub(super) fn turn_slowly(&self, vertices: [VertexId; 3]) -> Sign {
        if vertices.contains(&VertexId::INFINITE) {
            return Sign::Negative;
        }
        if FILTERED {
            // Of integers up to 2^26 the products and their difference are exact.
            let [a, b, c] = vertices.map(|v| self.place(v));
            let (u, v) = (Arrow::between(a, b), Arrow::between(a, c));
            if u.size().max(v.size()) <= (1u64 << 26) as f64 * self.unit {
                return Sign::of(&(u.x * v.y - u.y * v.x));
            }
        }
        let corners = vertices.map(|v| &self.points[v.index()]);
        self.geometry.orientation(std::array::from_fn(|i| corners[i]))
    }

    /// Whether `q` lies in the circle of a counter-clockwise triangle, ties decided. Seen from `opposite`, it lies
    /// beyond the edge between the `ends`.
    #[inline(always)]
    pub(super) fn in_circle(&self, opposite: VertexId, ends: [VertexId; 2], q: VertexId) -> bool {
        let at = self.place(opposite);
        let [u, v, w] = [ends[0], ends[1], q].map(|v| Arrow::between(at, self.place(v)));
        let estimate = Circle::through(u, v).side(w);
        if self.is_open(estimate) { self.in_circle_slowly(opposite, ends, q) } else { estimate.is_positive() }
    }

    /// The same; never at infinity.
    ///
    /// `PERF:` on a grid two to three questions a point come here. Where the unit of all coordinates is known, it is
    /// seen at once that they are few units apart, so that floating point is exact. The kernel looks for the unit of
    /// four points each time: the prototype's time on a grid of 1 million points was 300 ns a point by that road, 88 by
    /// this one.
    #[cold]
    #[inline(never)]
    pub(super) fn in_circle_slowly(&self, opposite: VertexId, ends: [VertexId; 2], q: VertexId) -> bool {
        if [opposite, ends[0], ends[1], q].contains(&VertexId::INFINITE) {
            return false;
        }
        if FILTERED {
            let [a, b, c, d] = [opposite, ends[0], ends[1], q].map(|v| self.place(v));
            let [u, v, w] = [b, c, d].map(|p| Arrow::between(a, p));
            // Integers up to 2^12: squares are up to 2^25, factors of the plane 2^38, and the sum less than 2^52.
            if u.size().max(v.size()).max(w.size()) <= (1u64 << 12) as f64 * self.unit {
                let value = Circle::through(u, v).side(w).value;
                return value > 0.0 || value == 0.0 && in_tied_circle(a, [b, c], d);
            }
        }
        let corners = [opposite, ends[0], ends[1]].map(|v| &self.points[v.index()]);
        in_sphere(self.geometry, std::array::from_fn::<_, N, _>(|i| corners[i]), &self.points[q.index()])
    }
}

/// The largest power of two of which all coordinates are multiples; 0 if it is so small a part of the largest one that most
/// distances are more than 2^12 of it.
///
/// `PERF:` of a grid one pass, on all threads; of other points next to nothing, as the first few tell.
fn unit<G: Coordinates<N>, const N: usize>(geometry: &G, points: &[G::Point], grain: Grain) -> f64 {
    let part = 2f64.powi(-14) / points.len() as f64;
    let is_too_small = |lowest: i32, largest: f64| 2f64.powi(lowest) < part * largest;
    let of_chunk = |chunk: &[G::Point]| {
        let (mut lowest, mut largest) = (i32::MAX, 0.0);
        for x in chunk.iter().filter_map(|p| geometry.exact_plan(p)).flatten() {
            largest = if x.abs() > largest { x.abs() } else { largest };
            let bit = lattice::lowest_bit(x).unwrap_or(lowest);
            if bit < lowest {
                lowest = bit;
                if is_too_small(lowest, largest) {
                    return None;
                }
            }
        }
        Some((lowest, largest))
    };
    let least = |(i, x): (i32, f64), (j, y): (i32, f64)| Some((i.min(j), x.max(y)));
    let of_all = points.par_chunks(grain.points).map(of_chunk).try_reduce(|| (i32::MAX, 0.0), least);
    let unit = of_all.filter(|&(lowest, largest)| !is_too_small(lowest, largest));
    unit.map_or(0.0, |(lowest, _)| 2f64.powi(lowest))
}
