//! The filter of the in-sphere test: the circumscribed sphere of each cell, rounded to 16 bytes.
//!
//! A sphere is stored as its center `c` and its squared radius `R`, four `f32` in a frame in which
//! all points have coordinates between -1 and 1. For a query point `q` of the frame, without
//! weights,
//!
//! ```text
//!   e = |c - q|^2 - R        is sure to have the right sign if |e| > R / 2^j
//! ```
//!
//! The tolerance `j`, 1 to 16, stands in the five lowest bits of `R`. A sphere that is not known
//! that well has a radius of NaN: then nothing is sure, and the geometry decides.
//!
//! *Why.* Let `u = 2^-53`, `h = 2^-24`; `C`, `r` and `P` the true center, radius and point in the
//! frame, a similarity, which changes no sign; `x = |C - P|`. What is computed is `|c - q|^2 - R`
//! with three kinds of errors.
//!
//! 1. *Positions.* `c - q` differs from `C - P` by a vector of length at most `D`. So the squares
//!    differ by at most `2 x D + D^2`.
//! 2. *Radius.* `R` differs from `r^2` by a relative error of its computation, one rounding, and
//!    the five bits: `63 h` for the latter two.
//! 3. *Evaluation.* Each term of `|c - q|^2` takes five roundings, `5 h |c - q|^2`; the last
//!    subtraction is rounded correctly, so that its sign is right.
//!
//! Near the sphere, `x <= 2 r`, the error relative to `r^2` is at most `4 t + t^2 + 63 h + 20 h`
//! with `t = D / r`, besides that of the radius. If that is less than `1 / 2^j`, then `e` is sure
//! where it exceeds it. (`R` itself may be less than `r^2` by that error; the reserve in the
//! constants below covers it.) Far from the sphere, `x > 2 r`, the true value is more than `3/4
//! x^2`, and the errors are at most `2 x D + D^2 + 5 h x^2`, and that of the radius, less than `x^2
//! / 3` for `t <= 1/8`: the sign is right in any case.
//!
//! *The center.* It is computed in `f64`, relative to one of the corners, from the vectors `a`,
//! `b`, `c` to the others:
//!
//! ```text
//!   center = (|a|^2 b x c + |b|^2 c x a + |c|^2 a x b) / (2 d),    d = a . (b x c)
//! ```
//!
//! Let `L` be the length of the longest, a chord, so that `L <= 2 r`. For each term count the
//! roundings on its path (Higham 2002, lemma 3.1): a difference takes 1, a component of a cross
//! product 4, `d` 8, a squared length 5, a component of the numerator 12. By Cauchy and Schwarz the
//! terms of a component of `b x c` sum to at most `L^2`, those of `d` to `sqrt(3) L^3`, and those
//! of the numerator are a vector no longer than `3 sqrt(3) L^4`. So the errors are below
//! `14 u L^3` of `d` and `63 u L^4` of the numerator; with `L <= 2 r` that of the center is below
//! `(63 + 14 + 3) u L^3 / |d|` times `r`, the 3 for the quotient. It adds `80 u L^3 / |d|` to `t`,
//! hence `4.125 * 80` of it to the tolerance, and `2.1 * 80` by way of the radius: together
//! `500 u L^3 / |d|`. The other part of `t` are the roundings of `c` and `q` to `f32`,
//! `sqrt(3) h (1 + max |c|) / r`, also times 4.125: `7.15 h (1 + max |c|) / r`. The square of a sum
//! of three is at most three times the sum of the squares:
//!
//! ```text
//!   3 (500 u)^2 = 9.3e-27    of (L^3 / d)^2              CENTER = 1.25e-26
//!   3 (7.15 h)^2 = 5.5e-13   of (1 + max |c|)^2 / r^2    POSITION = 6.1e-13
//!   3 (83 h)^2 = 7.4e-11                                 FIXED = 9e-11
//! ```
//!
//! *Weights.* Let `l >= 0` be what a vertex lacks of the greatest weight, in the frame. Points with
//! weights are points of a space with one more dimension, `(P, sqrt(l))`, and spheres there that
//! have their centers in `l = 0`: `r^2 = |C - O|^2 + l_o`, where `O` is the corner from which the
//! center is computed, and `x^2 = |C - P|^2 + l`, of which `|c - q|^2 + l - R` is the test. All
//! vectors of the point's own space are projections, and not longer. What differs:
//!
//! - In the formula of the center, `|a|^2` is less by the difference of two weights, at most `W` if
//!   that is the range of all. Its rounding, and one of the sum, make 13 on the path and
//!   `69 u L^2 (L^2 + W)` of the numerator: with `L <= 2 r`, `W` may be added to one `L^2` in the
//!   bound. `L^2` itself is not greater than the largest term plus `W`.
//! - The evaluation has one rounding more, and `l` one: `24 h` for `20 h`.
//!
//! So the constants are `3 (537 u)^2 = 1.07e-26` and `3 (87 h)^2 = 8.1e-11`, less than those above.
//!
//! What is left over covers the roundings of the bound itself. Within the
//! [range](crate::kernel::RANGE) of floating point nothing underflows that counts; where the bound
//! overflows, the sphere is not known.

use crate::num::lanes::{bits, f32x4, f64x2, i32x4, of_bits, rounded};

/// The center and the squared radius; see the [module](self).
pub(super) type Sphere = [f32; 4];

/// A sphere that decides nothing.
pub(super) const UNKNOWN: Sphere = [0.0, 0.0, 0.0, f32::NAN];

/// The sphere of a cell in the conflict zone.
pub(super) const MARKED: Sphere = [0.0, 0.0, 0.0, -1.0];

const CENTER: f64 = 1.25e-26;
const POSITION: f32 = 6.1e-13;
const FIXED: f32 = 9e-11;

/// The bits of a squared radius that hold the tolerance.
const TOLERANCE: i32 = 31;

/// Larger squared radii, and those smaller than its inverse, are not stored.
const LARGEST: f32 = 1e30;

/// The position of the frame: points in it are `(p - middle) * scale`, between -1 and 1.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    pub(super) middle: [f64; 3],
    pub(super) scale: f64,
}

impl Frame {
    #[inline(always)]
    pub(super) fn of(&self, p: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.on_axis(axis, p[axis]))
    }

    #[inline(always)]
    pub(super) fn on_axis(&self, axis: usize, coordinate: f64) -> f64 {
        (coordinate - self.middle[axis]) * self.scale
    }
}

#[cfg(test)]
pub(super) fn is_marked(sphere: Sphere) -> bool {
    sphere[3] < 0.0
}

/// Returns a sphere, marked if the lowest bit is set.
#[inline(always)]
pub(super) fn marked_if(sphere: Sphere, bit: u32) -> Sphere {
    of_bits(bits(f32x4::new(sphere)) | i32x4::new([0, 0, 0, (bit << 31) as i32])).to_array()
}

/// A point in the frame, and what it lacks of the greatest weight, in the same unit.
pub(super) type Query = [f32; 4];

#[inline(always)]
pub(super) fn query([x, y, z]: [f64; 3], lack: f64) -> Query {
    [x, y, z, lack].map(|x| x as f32)
}

#[inline(always)]
fn power(sphere: Sphere, q: Query) -> f32 {
    let [x, y, z] = [0, 1, 2].map(|axis| sphere[axis] - q[axis]);
    x * x + y * y + z * z + q[3] - sphere[3]
}

#[inline(always)]
fn tolerance(squared_radius: f32) -> f32 {
    squared_radius * f32::from_bits((127 - (squared_radius.to_bits() & TOLERANCE as u32)) << 23)
}

/// Returns true if a point is sure to lie inside.
#[inline(always)]
pub(super) fn is_inside(sphere: Sphere, q: Query) -> bool {
    power(sphere, q) < -tolerance(sphere[3])
}

/// Returns true if no point on the other side of a plane than the center can be inside; the plane
/// is that of all points with a coordinate. Points of the frame are then sure to be outside.
#[inline(always)]
pub(super) fn is_short_of(sphere: Sphere, axis: usize, at: f32) -> bool {
    let [distance, squared_radius] = [at - sphere[axis], sphere[3]].map(f64::from);
    distance * distance > squared_radius + f64::from(tolerance(sphere[3]))
}

/// The results of four tests, one bit each.
pub(super) struct SphereTests {
    pub(super) inside: u32,
    pub(super) marked: u32,
    pub(super) sure: u32,
}

/// Tests a point against four spheres.
#[inline(always)]
pub(super) fn sides(spheres: [Sphere; 4], q: Query) -> SphereTests {
    let [x, y, z, squared_radius] = f32x4::transpose(spheres.map(f32x4::new));
    let (x, y, z) = (
        x - f32x4::splat(q[0]),
        y - f32x4::splat(q[1]),
        z - f32x4::splat(q[2]),
    );
    let power = x * x + y * y + z * z + f32x4::splat(q[3]) - squared_radius;
    let exponent = i32x4::splat(127) - (bits(squared_radius) & i32x4::splat(TOLERANCE));
    let tolerance = squared_radius * of_bits(exponent << 23);
    SphereTests {
        inside: power.to_bitmask(),
        marked: squared_radius.to_bitmask(),
        sure: power.abs().simd_gt(tolerance).to_bitmask(),
    }
}

/// A vector and its squared length, less what its end has more weight than its start.
pub(super) type Arrow = [f64; 4];

#[inline(always)]
pub(super) fn arrow(from: [f64; 3], to: [f64; 3]) -> Arrow {
    let [x, y, z] = [0, 1, 2].map(|axis| to[axis] - from[axis]);
    [x, y, z, x * x + y * y + z * z]
}

/// The point that arrows start at.
#[derive(Clone, Copy)]
pub(super) struct Origin {
    /// Its position in the frame.
    pub(super) at: [f64; 3],
    /// The greatest weight minus its own, in the frame.
    pub(super) lack: f64,
    /// No two weights differ by more; outside of the frame.
    pub(super) range: f64,
}

/// Returns the spheres through a point and the ends of three arrows from it, four at a time.
#[inline(always)]
pub(super) fn through(arrows: [[&Arrow; 3]; 4], origin: Origin, scale: f64) -> [Sphere; 4] {
    let [a, b, c, d] = arrows;
    let (first, second) = (
        centers([a, b], origin, scale),
        centers([c, d], origin, scale),
    );
    let pair = |i: usize| rounded(first[i], second[i]);
    let (x, y, z, squared_radius, error) = (pair(0), pair(1), pair(2), pair(3), pair(4));

    let size = x.abs().fast_max(y.abs()).fast_max(z.abs()) + f32x4::splat(1.0);
    let bound = size * size * f32x4::splat(POSITION) / squared_radius + error + f32x4::splat(FIXED);
    // With the exponent of the bound, which is less than 2^(exponent - 126): its root is less than
    // 2^-tolerance.
    let tolerance: i32x4 = (i32x4::splat(126) - (bits(bound) >> 23)) >> 1;
    // A bound that is not a number may have any sign.
    let is_known = of_bits(tolerance.simd_gt(i32x4::splat(0)))
        & bound.simd_lt(f32x4::splat(1.0))
        & squared_radius.simd_lt(f32x4::splat(LARGEST))
        & squared_radius.simd_gt(f32x4::splat(1.0 / LARGEST));
    let coded =
        bits(squared_radius) & i32x4::splat(!TOLERANCE) | tolerance & i32x4::splat(TOLERANCE);
    let squared_radius = is_known.bitselect(of_bits(coded), f32x4::splat(f32::NAN));
    f32x4::transpose([x, y, z, squared_radius]).map(f32x4::to_array)
}

/// Returns the centers and squared radii of two spheres, and the squares of the errors of the
/// centers.
///
/// `PERF:` no more than two, so that registers suffice.
#[inline(always)]
fn centers(arrows: [[&Arrow; 3]; 2], origin: Origin, scale: f64) -> [f64x2; 5] {
    let [first, second] = arrows;
    let column = |i: usize, axis: usize| f64x2::new([first[i][axis], second[i][axis]]);
    let columns = |i: usize| [column(i, 0), column(i, 1), column(i, 2), column(i, 3)];
    let (a, b, c) = (columns(0), columns(1), columns(2));
    let (u, v, w) = (cross(b, c), cross(c, a), cross(a, b));
    let volume = a[0] * u[0] + a[1] * u[1] + a[2] * u[2];
    let inverse = f64x2::splat(1.0) / volume;
    let half = inverse * f64x2::splat(0.5 * scale);
    let offset = |axis: usize| (a[3] * u[axis] + b[3] * v[axis] + c[3] * w[axis]) * half;
    let (x, y, z) = (offset(0), offset(1), offset(2));
    let squared_radius = x * x + y * y + z * z + f64x2::splat(origin.lack);
    let at = |axis: usize| f64x2::splat(origin.at[axis]);
    let (x, y, z) = (x + at(0), y + at(1), z + at(2));

    let range = f64x2::splat(origin.range);
    let longest = a[3].fast_max(b[3]).fast_max(c[3]) + range;
    let ratio = (longest + range) * inverse;
    [
        x,
        y,
        z,
        squared_radius,
        ratio * ratio * longest * f64x2::splat(CENTER),
    ]
}

#[inline(always)]
fn cross(p: [f64x2; 4], q: [f64x2; 4]) -> [f64x2; 3] {
    [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ]
}
