//! Heights and gradients on a triangle, linear between its corners; segments in plan.

use crate::data::orientation;
use crate::triangulation::geometry::height_along;
use crate::triangulation::num::Sign;

/// The ratio of width to longest side below which a triangle is a sliver.
///
/// Rounding hides where across a sliver a position lies. Slivers arise where lines are bent through
/// rounded crossings.
const THINNEST: f64 = 1e-9;

/// The height at `q` of the plane through three points: exact at the first, rounded elsewhere.
///
/// A surface that promises the heights of its vertices looks for a vertex at `q` first.
pub(super) fn linear([a, b, c]: [[f64; 3]; 3], q: [f64; 2]) -> f64 {
    let cross =
        |p: [f64; 3], r: [f64; 3]| (p[0] - q[0]) * (r[1] - q[1]) - (p[1] - q[1]) * (r[0] - q[0]);
    let (at_a, at_b, at_c) = (cross(b, c), cross(c, a), cross(a, b));
    let area = at_a + at_b + at_c;
    let longest = square(a, b).max(square(b, c)).max(square(c, a));
    if area.abs() <= THINNEST * longest {
        return along_sliver([a, b, c], q);
    }
    a[2] + (at_b * (b[2] - a[2]) + at_c * (c[2] - a[2])) / area
}

/// Returns the rise of a triangle per unit of x and of y; not finite if it has no area.
///
/// Rounding depends on the order of the corners.
#[inline]
pub(super) fn gradient([a, b, c]: [[f64; 3]; 3]) -> [f64; 2] {
    let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| p[k] - a[k]));
    let area = u[0] * v[1] - u[1] * v[0];
    [
        (u[2] * v[1] - v[2] * u[1]) / area,
        (u[0] * v[2] - v[0] * u[2]) / area,
    ]
}

/// The height at `q` on a sliver, interpolated along its two shorter sides.
fn along_sliver([a, b, c]: [[f64; 3]; 3], q: [f64; 2]) -> f64 {
    let sides = [(a, b, c), (b, c, a), (c, a, b)];
    let length = |&(p, r, _): &([f64; 3], [f64; 3], [f64; 3])| square(p, r);
    let [from, to, middle] = sides
        .into_iter()
        .max_by(|s, t| length(s).total_cmp(&length(t)))
        .map_or([a, b, c], Into::into);
    let is_before =
        (q[0] - middle[0]) * (to[0] - from[0]) + (q[1] - middle[1]) * (to[1] - from[1]) <= 0.0;
    if is_before {
        height_along(from, middle, q)
    } else {
        height_along(middle, to, q)
    }
}

/// Returns the position of a point in plan.
#[inline(always)]
pub(super) fn plan<T: Copy>([x, y, _]: [T; 3]) -> [T; 2] {
    [x, y]
}

/// Returns the ends of a segment in the order of their x and y.
pub(super) fn sorted([a, b]: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    if a <= b { [a, b] } else { [b, a] }
}

/// Returns the orientation of three points in plan. Exact.
#[inline]
pub(super) fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Sign {
    orientation([a, b, c].map(|[x, y]| [x, y, 0.0]))
}

/// Returns true if two closed segments whose boxes overlap have a point in common. Exact.
pub(super) fn do_meet([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let are_apart = |p: Sign, q: Sign| p == q && p != Sign::Zero;
    !are_apart(turn(a, b, c), turn(a, b, d)) && !are_apart(turn(c, d, a), turn(c, d, b))
}

/// The distance of two points in plan.
pub(super) fn plan_distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// The square of a distance in plan.
fn square(p: [f64; 3], q: [f64; 3]) -> f64 {
    (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sliver_is_folded_at_its_middle_corner() {
        let [a, b, c] = [[0.0, 0.0, 1.0], [1.0, 3.0, 7.0], [0.5, 1.5 + 1e-13, 6.0]];
        for corners in [[a, b, c], [c, b, a], [b, c, a]] {
            for (y, z) in [(0.0, 1.0), (0.75, 3.5), (1.5, 6.0), (2.25, 6.5), (3.0, 7.0)] {
                assert!(
                    (linear(corners, [y / 3.0, y]) - z).abs() < 1e-9,
                    "{corners:?} at {y}"
                );
            }
        }
        assert_eq!(
            [a, b, c].map(|p| linear([a, b, c], [p[0], p[1]])),
            [1.0, 7.0, 6.0]
        );
    }
}
