//! The circumcenter and the power center: constructions, in exact arithmetic where floating point
//! would be wrong.

use super::RANGE;
use super::formula::{cross, minus, square};
use crate::num::{Bounded, Dyadic, Expansion, Number};

/// Returns the offset from the first of three weighted points to their power center, scaled, and
/// the scale.
///
/// The last number is twice the area of the triangle; the first two are the offset times twice
/// that.
fn scaled_offset<T: Number>([a, b, c]: [[f64; 3]; 3], difference: impl Fn(f64, f64) -> T + Copy) -> [T; 3] {
    let [(u, u_length), (v, v_length)] = [b, c].map(|p| {
        let vector = minus([p[0], p[1]], [a[0], a[1]], difference);
        let length = square(&vector[0]) + square(&vector[1]) - difference(p[2], a[2]);
        (vector, length)
    });
    [
        cross(&u_length, &v[1], &v_length, &u[1]),
        cross(&v_length, &u[0], &u_length, &v[0]),
        cross(&u[0], &v[1], &u[1], &v[0]),
    ]
}

/// Returns the circumcenter of a triangle, relative to its first corner: the [power
/// center](power_center) of points of equal weight. The triangle has an area.
pub fn circumcenter(corners: [[f64; 2]; 3]) -> [f64; 2] {
    power_center(corners.map(|[x, y]| [x, y, 0.0]))
}

/// Returns the point that has the same power to three points `[x, y, weight]`, relative to the
/// first of them. The power is the squared distance less the weight.
///
/// The points are not collinear. The result is correct to within `2^-40` of its distance from the
/// first point, however flat the triangle is. It is not finite if it exceeds the range of doubles.
///
/// # Complexity
/// About twenty operations, unless the triangle is very flat; exact arithmetic then.
pub fn power_center(corners: [[f64; 3]; 3]) -> [f64; 2] {
    /// Of the numerator and of the denominator.
    const TOLERANCE: f64 = 1.0 / (1u64 << 42) as f64;
    let divided = |[x, y, area]: [f64; 3]| [x / area / 2.0, y / area / 2.0];
    if !corners.iter().flatten().all(|&x| RANGE.admits(x)) {
        let [x, y, area] = scaled_offset(corners, Dyadic::difference);
        return [x, y].map(|x| x.quotient(&area) / 2.0);
    }
    let rough = scaled_offset(corners, Bounded::difference);
    let [x, y, area] = rough.map(Bounded::value);
    let [x_error, y_error, area_error] = rough.map(Bounded::error);
    if x_error.max(y_error) <= TOLERANCE * x.abs().max(y.abs()) && area_error <= TOLERANCE * area.abs() {
        divided([x, y, area])
    } else {
        divided(scaled_offset(corners, Expansion::difference).map(|x| x.estimate()))
    }
}
