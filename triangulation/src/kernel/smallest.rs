//! On which side of the smallest sphere of an edge or a triangle a point lies.

use super::formula::{cross, minus, squared_length};
use crate::num::{Bounded, Dyadic, Number, Sign};

/// Returns a positive multiple of the power of `q` to the smallest sphere that is orthogonal to the
/// spheres of the points of a simplex.
///
/// The center is `a + s u + t v` for the vectors `u` and `v` from the first point to the others.
/// That it has the same power to all points is a linear system in `s` and `t`, solved by Cramer's
/// rule; the multiple is its determinant.
fn power<T: Number>(
    simplex: &[[f64; 4]],
    q: [f64; 4],
    difference: impl Fn(f64, f64) -> T + Copy,
) -> Option<T> {
    let (&a, others) = simplex.split_first()?;
    let relative = |p: [f64; 4]| {
        let vector = minus([p[0], p[1], p[2]], [a[0], a[1], a[2]], difference);
        let lift = squared_length(&vector) - difference(p[3], a[3]);
        (vector, lift)
    };
    let dot = |p: &[T; 3], q: &[T; 3]| {
        let [x, y, z] = [0, 1, 2].map(|axis| p[axis].clone() * q[axis].clone());
        x + y + z
    };
    let (w, power) = relative(q);
    match *others {
        [] => Some(power),
        [b] => {
            let (u, lift) = relative(b);
            Some(cross(&squared_length(&u), &power, &lift, &dot(&u, &w)))
        }
        [b, c] => {
            let ((u, u_lift), (v, v_lift)) = (relative(b), relative(c));
            let (uu, uv, vv) = (squared_length(&u), dot(&u, &v), squared_length(&v));
            let along_u = cross(&u_lift, &vv, &v_lift, &uv) * dot(&u, &w);
            let along_v = cross(&v_lift, &uu, &u_lift, &uv) * dot(&v, &w);
            Some(cross(&uu, &vv, &uv, &uv) * power - along_u - along_v)
        }
        _ => None,
    }
}

/// Returns on which side of the smallest sphere of a point, an edge or a triangle `q` lies, for
/// points `[x, y, z, weight]`: positive inside, zero on it. With weights it is the smallest sphere
/// that is orthogonal to those of the points, and inside is what has a negative power to it. Zero
/// for points that do not span a simplex, and for any other number of them.
///
/// Exact for all finite numbers. The degree is 6, one more than a [`Predicate`](super::Predicate)
/// may have.
pub(crate) fn side_of_smallest_sphere(simplex: &[[f64; 4]], q: [f64; 4]) -> Sign {
    /// Larger errors cover all that is lost by underflow.
    const LEAST: f64 = 1e-280;
    let Some(rough) = power(simplex, q, Bounded::difference) else {
        return Sign::Zero;
    };
    let (value, error) = (rough.value(), rough.error());
    let outside = if error > LEAST && value.abs() > error && value.is_finite() {
        Sign::of(&value)
    } else {
        power(simplex, q, Dyadic::difference).map_or(Sign::Zero, |power| power.sign())
    };
    -outside
}
