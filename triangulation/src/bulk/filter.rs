//! The predicates of a merge, evaluated in floating point where the result is certain.
//!
//! All of them are about points seen from one of them, `a`. With `u = b - a`, `v = c - a`,
//! `w = q - a` and the squares of their lengths `U`, `V`, `W`:
//!
//! ```text
//!                | ux uy U |
//!   in-circle  - | vx vy V |  =  wx (U vy - uy V) + wy (ux V - U vx) - W (ux vy - uy vx), positive inside
//!                | wx wy W |
//! ```
//!
//! The three factors are the plane through the lifted points: two tests against one circle share
//! them, and the last is the orientation of `a b c`.
//!
//! *Error.* A rounding changes a value by a factor between `1 - e` and `1 + e`, `e = 2^-53`. For
//! each term, count the roundings on its path: a difference takes 1, and `U` 4 (two of its
//! differences, the product, the sum). `U vy` has 6 with its own, 7 after the subtraction; times
//! `wx`, 9 with its own, and 11 after the two sums. `W ux vy` has 10. So the error is at most
//! `((1 + e)^11 - 1) M`, where `M` is the sum of the terms' magnitudes (Higham 2002, lemma 3.1). By
//! Cauchy and Schwarz `|wx vy| + |wy vx| <= |w| |v|`. A product of three lengths is at most the
//! cube of their quadratic mean, and their sum at most three times that mean. With `S = U + V + W`:
//!
//! ```text
//!   M <= U |v| |w| + V |u| |w| + W |u| |v| = |u| |v| |w| (|u| + |v| + |w|) <= (S / 3)^(3/2) (3 S)^(1/2) = S^2 / 3
//! ```
//!
//! So the bound is `11/3 e S^2 = 4.08e-16 S^2`, except for terms in `e^2` and the 14 roundings of
//! the computed bound itself, for which a tenth on top is ample. In the
//! [range](crate::kernel::RANGE) of expansions nothing overflows and nothing underflows: all values
//! are multiples of `2^-848`.
//!
//! *Orientation.* `ux vy - uy vx` with Shewchuk's bound (1997, section 4.3).
//!
//! Where the result is not certain, the geometry decides, out of line; points on a grid are an
//! exception, see [`in_circle_slowly`](PlanePredicates::in_circle_slowly).

use std::ops::Range;

use crate::geometry::{Coordinates, in_sphere, in_tied_circle};
use crate::num::{Sign, lattice};
use crate::tds::VertexId;

use super::chunks;
use super::curve::Curve;
use super::grain::Grain;

pub(super) type Site = [f64; 2];

/// The site of the infinite vertex. Whatever is computed from it is neither positive, nor negative,
/// nor uncertain.
pub(super) const NOWHERE: Site = [f64::NAN; 2];

/// A vector and its squared length.
#[derive(Clone, Copy)]
pub(super) struct Arrow {
    x: f64,
    y: f64,
    square: f64,
}

impl Arrow {
    #[inline(always)]
    pub(super) fn between(from: Site, to: Site) -> Self {
        let (x, y) = (to[0] - from[0], to[1] - from[1]);
        Arrow {
            x,
            y,
            square: x * x + y * y,
        }
    }

    /// Returns the orientation of the origin and the ends of two arrows.
    #[inline(always)]
    pub(super) fn turn(self, v: Arrow) -> Estimate {
        const BOUND: f64 = (3.0 + 8.0 * f64::EPSILON) * (f64::EPSILON / 2.0);
        let (left, right) = (self.x * v.y, self.y * v.x);
        Estimate {
            value: left - right,
            bound: BOUND * (left.abs() + right.abs()),
        }
    }

    /// Returns the larger side of the bounding box.
    fn size(self) -> f64 {
        self.x.abs().max(self.y.abs())
    }
}

/// A computed value, and a bound on its error.
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

/// A circle through the origin and two points, as the plane through the three lifted points.
#[derive(Clone, Copy)]
pub(super) struct Circle {
    x: f64,
    y: f64,
    area: f64,
    squares: f64,
}

impl Circle {
    /// A circle whose sides are neither positive nor negative.
    pub(super) const NONE: Self = Circle {
        x: f64::NAN,
        y: f64::NAN,
        area: f64::NAN,
        squares: f64::NAN,
    };

    #[inline(always)]
    pub(super) fn through(u: Arrow, v: Arrow) -> Self {
        Circle {
            x: u.square * v.y - u.y * v.square,
            y: u.x * v.square - u.square * v.x,
            area: u.x * v.y - u.y * v.x,
            squares: u.square + v.square,
        }
    }

    /// Returns an estimate that is positive inside, if the points turn counter-clockwise.
    #[inline(always)]
    pub(super) fn side(&self, w: Arrow) -> Estimate {
        const BOUND: f64 = 4.5e-16;
        let squares = self.squares + w.square;
        Estimate {
            value: w.x * self.x + w.y * self.y - w.square * self.area,
            bound: BOUND * (squares * squares),
        }
    }
}

/// Returns the orientation of three points.
#[inline(always)]
pub(super) fn turn(a: Site, b: Site, c: Site) -> Estimate {
    Arrow::between(a, b).turn(Arrow::between(a, c))
}

/// Points as a geometry sees them; with `FILTERED`, all of them have exact coordinates that the
/// filter may use.
pub(super) struct PlanePredicates<'a, G: Coordinates<N>, const N: usize, const FILTERED: bool> {
    geometry: &'a G,
    points: &'a [G::Point],
    /// The largest power of two of which all coordinates are multiples; 0 if that is too small to
    /// be useful.
    unit: f64,
    /// The curve that all points are ordered along.
    pub(super) curve: &'a Curve,
}

impl<'a, G: Coordinates<N>, const N: usize, const FILTERED: bool>
    PlanePredicates<'a, G, N, FILTERED>
{
    pub(super) fn new(
        geometry: &'a G,
        points: &'a [G::Point],
        curve: &'a Curve,
        grain: Grain,
    ) -> Self {
        let unit = if FILTERED {
            unit(geometry, points, grain)
        } else {
            0.0
        };
        PlanePredicates {
            geometry,
            points,
            unit,
            curve,
        }
    }

    /// Returns the exact coordinates of a vertex; [`NOWHERE`] if it has none or is infinite.
    #[inline(always)]
    pub(super) fn site(&self, vertex: VertexId) -> Site {
        match self.points.get(vertex.index()) {
            Some(p) if FILTERED => self.geometry.exact_plan(p).unwrap_or(NOWHERE),
            _ => NOWHERE,
        }
    }

    /// Returns the coordinates of a finite vertex.
    #[inline(always)]
    pub(super) fn coordinates(&self, vertex: VertexId) -> Site {
        match *self
            .geometry
            .coordinates(&self.points[vertex.index()])
            .as_ref()
        {
            [x, y, ..] => [x, y],
            _ => NOWHERE,
        }
    }

    /// Returns true if the geometry must decide.
    #[inline(always)]
    pub(super) fn is_open(&self, estimate: Estimate) -> bool {
        !FILTERED || estimate.value.abs() <= estimate.bound
    }

    /// Returns the orientation of three finite vertices.
    #[inline(always)]
    pub(super) fn turn(&self, vertices: [VertexId; 3]) -> Sign {
        self.turn_at(vertices.map(|v| self.site(v)), vertices)
    }

    /// Like [`turn`](Self::turn), given the coordinates of the vertices, or these after a quarter
    /// turn.
    #[inline(always)]
    pub(super) fn turn_at(&self, [a, b, c]: [Site; 3], vertices: [VertexId; 3]) -> Sign {
        let estimate = turn(a, b, c);
        if self.is_open(estimate) {
            self.turn_slowly(vertices)
        } else if estimate.is_positive() {
            Sign::Positive
        } else {
            Sign::Negative
        }
    }

    /// Like [`turn`](Self::turn), without the filter; negative if a vertex is infinite.
    #[cold]
    #[inline(never)]
    pub(super) fn turn_slowly(&self, vertices: [VertexId; 3]) -> Sign {
        if vertices.contains(&VertexId::INFINITE) {
            return Sign::Negative;
        }
        if FILTERED {
            // The products of integers up to 2^26, and their difference, are exact.
            let [a, b, c] = vertices.map(|v| self.site(v));
            let (u, v) = (Arrow::between(a, b), Arrow::between(a, c));
            if u.size().max(v.size()) <= (1u64 << 26) as f64 * self.unit {
                return Sign::of(&(u.x * v.y - u.y * v.x));
            }
        }
        let corners = vertices.map(|v| &self.points[v.index()]);
        self.geometry
            .orientation(std::array::from_fn(|i| corners[i]))
    }

    /// Returns true if `q` lies in the circle of a counter-clockwise triangle, ties broken. Seen
    /// from `opposite`, it lies beyond the edge between the `ends`.
    #[inline(always)]
    pub(super) fn in_circle(&self, opposite: VertexId, ends: [VertexId; 2], q: VertexId) -> bool {
        let at = self.site(opposite);
        let [u, v, w] = [ends[0], ends[1], q].map(|v| Arrow::between(at, self.site(v)));
        let estimate = Circle::through(u, v).side(w);
        if self.is_open(estimate) {
            self.in_circle_slowly(opposite, ends, q)
        } else {
            estimate.is_positive()
        }
    }

    /// Like [`in_circle`](Self::in_circle), without the filter; false if a vertex is infinite.
    ///
    /// `PERF:` on a grid, two to three tests a point reach this function. Where the unit of all
    /// coordinates is known, one comparison shows that the points are few units apart, so that
    /// floating point is exact. The kernel would look for the unit of four points each time: for a
    /// grid of 1 million points the prototype took 300 ns a point with the kernel, 88 with the
    /// common unit.
    #[cold]
    #[inline(never)]
    pub(super) fn in_circle_slowly(
        &self,
        opposite: VertexId,
        ends: [VertexId; 2],
        q: VertexId,
    ) -> bool {
        if [opposite, ends[0], ends[1], q].contains(&VertexId::INFINITE) {
            return false;
        }
        if FILTERED {
            let [a, b, c, d] = [opposite, ends[0], ends[1], q].map(|v| self.site(v));
            let [u, v, w] = [b, c, d].map(|p| Arrow::between(a, p));
            // Integers up to 2^12: squares are up to 2^25, factors of the plane 2^38, and the sum
            // less than 2^52.
            if u.size().max(v.size()).max(w.size()) <= (1u64 << 12) as f64 * self.unit {
                let value = Circle::through(u, v).side(w).value;
                return value > 0.0 || value == 0.0 && in_tied_circle(a, [b, c], d);
            }
        }
        let corners = [opposite, ends[0], ends[1]].map(|v| &self.points[v.index()]);
        in_sphere(
            self.geometry,
            std::array::from_fn::<_, N, _>(|i| corners[i]),
            &self.points[q.index()],
        )
    }
}

/// Returns the largest power of two of which all coordinates are multiples; 0 if it is so small
/// compared to the largest coordinate that most distances exceed 2^12 of it.
///
/// `PERF:` one pass over the points of a grid, on all threads; next to nothing for other points,
/// because the first few decide.
fn unit<G: Coordinates<N>, const N: usize>(geometry: &G, points: &[G::Point], grain: Grain) -> f64 {
    let part = 2f64.powi(-14) / points.len() as f64;
    let is_too_small = |lowest: i32, largest: f64| 2f64.powi(lowest) < part * largest;
    let of_chunk = |range: Range<usize>| {
        let (mut lowest, mut largest) = (i32::MAX, 0.0);
        for x in points[range]
            .iter()
            .filter_map(|p| geometry.exact_plan(p))
            .flatten()
        {
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
    let least = |(i, x): (i32, f64), (j, y): (i32, f64)| (i.min(j), x.max(y));
    let of_all = chunks::try_reduced(
        points.len(),
        grain.points,
        &of_chunk,
        (i32::MAX, 0.0),
        least,
    );
    let unit = of_all.filter(|&(lowest, largest)| !is_too_small(lowest, largest));
    unit.map_or(0.0, |(lowest, _)| 2f64.powi(lowest))
}
