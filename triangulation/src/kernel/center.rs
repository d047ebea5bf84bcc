//! The circumcenter and the power center: constructions, in exact arithmetic where floating point
//! would be wrong.

use super::RANGE;
use super::formula::{cross, minus, squared_length, twice_area};
use crate::num::{Bounded, Dyadic, Expansion, Number};

/// Weighted points, the last coordinate of each the weight, that have a center.
trait Simplex<const D: usize> {
    /// Returns all coordinates and weights.
    fn numbers(&self) -> &[f64];

    /// Returns the offset from the first point to the center, scaled, and half of the scale.
    fn scaled_offset<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> ([T; D], T);

    /// Returns the offset from the first point to the center, correct to within `2^-40` of its
    /// length.
    fn offset(&self) -> [f64; D] {
        /// The largest relative error of the numerator and of the denominator.
        const TOLERANCE: f64 = 1.0 / (1u64 << 42) as f64;
        let divided = |(offset, scale): ([f64; D], f64)| offset.map(|x| x / scale / 2.0);
        if !self.numbers().iter().all(|&x| RANGE.admits(x)) {
            let (offset, scale) = self.scaled_offset(Dyadic::difference);
            return offset.map(|x| x.quotient(&scale) / 2.0);
        }
        let (offset, scale) = self.scaled_offset(Bounded::difference);
        let most = |of: fn(Bounded) -> f64| offset.iter().map(|&x| of(x)).fold(0.0, f64::max);
        let is_certain = most(Bounded::error) <= TOLERANCE * most(|x| x.value().abs())
            && scale.error() <= TOLERANCE * scale.value().abs();
        if is_certain {
            divided((offset.map(Bounded::value), scale.value()))
        } else {
            let (offset, scale) = self.scaled_offset(Expansion::difference);
            divided((offset.map(|x| x.estimate()), scale.estimate()))
        }
    }
}

/// Returns the vector from one weighted point to another, and its squared length less the
/// difference of the weights.
pub(super) fn lifted<T: Number, const D: usize>(
    (p, weight): ([f64; D], f64),
    (from, other): ([f64; D], f64),
    difference: impl Fn(f64, f64) -> T + Copy,
) -> ([T; D], T) {
    let vector = minus(p, from, difference);
    let length = squared_length(&vector) - difference(weight, other);
    (vector, length)
}

/// Three points `[x, y, weight]`.
struct InPlane([[f64; 3]; 3]);

impl Simplex<2> for InPlane {
    fn numbers(&self) -> &[f64] {
        self.0.as_flattened()
    }

    /// The scale is twice twice the area of the triangle.
    fn scaled_offset<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> ([T; 2], T) {
        let [a, b, c] = self.0.map(|[x, y, weight]| ([x, y], weight));
        let [(u, u_length), (v, v_length)] = [b, c].map(|p| lifted(p, a, difference));
        let offset = [
            cross(&u_length, &v[1], &v_length, &u[1]),
            cross(&v_length, &u[0], &u_length, &v[0]),
        ];
        (offset, cross(&u[0], &v[1], &u[1], &v[0]))
    }
}

/// Three points `[x, y, z, weight]`, whose center is in their plane.
struct OfFacet([[f64; 4]; 3]);

impl Simplex<3> for OfFacet {
    fn numbers(&self) -> &[f64] {
        self.0.as_flattened()
    }

    /// The offset is `(|u|^2 v - |v|^2 u) x n / (2 n . n)` with `n = u x v`.
    fn scaled_offset<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> ([T; 3], T) {
        let [a, b, c] = self.0.map(site_and_weight);
        let [(u, u_length), (v, v_length)] = [b, c].map(|p| lifted(p, a, difference));
        let normal = normal(&u, &v);
        let between = [0, 1, 2].map(|k| cross(&u_length, &v[k], &v_length, &u[k]));
        (self::normal(&between, &normal), squared_length(&normal))
    }
}

/// Four points `[x, y, z, weight]`.
struct InSpace([[f64; 4]; 4]);

impl Simplex<3> for InSpace {
    fn numbers(&self) -> &[f64] {
        self.0.as_flattened()
    }

    fn scaled_offset<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> ([T; 3], T) {
        offset_in_space(self.0, difference)
    }
}

pub(super) fn site_and_weight([x, y, z, weight]: [f64; 4]) -> ([f64; 3], f64) {
    ([x, y, z], weight)
}

/// Returns the cross product.
fn normal<T: Number>(p: &[T; 3], q: &[T; 3]) -> [T; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| cross(&p[i], &q[j], &p[j], &q[i]))
}

/// Returns the offset from the first of four weighted points to their center, scaled, and half of
/// the scale: the volume that the vectors to the others span.
///
/// Relative to the first point, with `|p|^2` for the squared length less the difference of weights,
/// the center is `(|a|^2 b x c + |b|^2 c x a + |c|^2 a x b) / (2 a . (b x c))`.
pub(super) fn offset_in_space<T: Number>(
    corners: [[f64; 4]; 4],
    difference: impl Fn(f64, f64) -> T + Copy,
) -> ([T; 3], T) {
    let [first, others @ ..] = corners.map(site_and_weight);
    let [a, b, c] = others.map(|p| lifted(p, first, difference));
    let (u, v, w) = (normal(&b.0, &c.0), normal(&c.0, &a.0), normal(&a.0, &b.0));
    let term = |length: &T, normal: &[T; 3], axis: usize| length.clone() * normal[axis].clone();
    let offset =
        [0, 1, 2].map(|axis| term(&a.1, &u, axis) + term(&b.1, &v, axis) + term(&c.1, &w, axis));
    let along = |axis: usize| a.0[axis].clone() * u[axis].clone();
    (offset, along(0) + along(1) + along(2))
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
    InPlane(corners).offset()
}

/// Returns the center of the sphere around a tetrahedron, relative to its first corner: the [power
/// center](power_center_in_space) of points of equal weight. The tetrahedron has a volume.
pub fn circumcenter_in_space(corners: [[f64; 3]; 4]) -> [f64; 3] {
    power_center_in_space(corners.map(|[x, y, z]| [x, y, z, 0.0]))
}

/// Returns the point that has the same power to four points `[x, y, z, weight]`, relative to the
/// first of them.
///
/// The points are not coplanar. The result is correct to within `2^-40` of its distance from the
/// first point, however flat the tetrahedron is. It is not finite if it exceeds the range of
/// doubles.
///
/// # Complexity
/// About fifty operations, unless the tetrahedron is very flat; exact arithmetic then.
///
/// ```
/// use breakline_triangulation::kernel::power_center_in_space;
///
/// let corners = [[1.0, 1.0, 1.0, 0.0], [5.0, 1.0, 1.0, 0.0], [1.0, 5.0, 1.0, 0.0], [1.0, 1.0, 5.0, 8.0]];
/// assert_eq!(power_center_in_space(corners), [2.0, 2.0, 1.0]);
/// ```
pub fn power_center_in_space(corners: [[f64; 4]; 4]) -> [f64; 3] {
    InSpace(corners).offset()
}

/// Returns the cross product of the vectors from the first corner of a triangle to the others, each
/// coordinate correct to the last bits.
pub(crate) fn normal_of_facet(corners: [[f64; 3]; 3]) -> [f64; 3] {
    [[1, 2], [2, 0], [0, 1]].map(|axes| {
        let [a, b, c] = corners.map(|p| axes.map(|axis| p[axis]));
        twice_area(a, b, c)
    })
}

/// Returns the point in the plane of three points `[x, y, z, weight]` that has the same power to
/// all of them, relative to the first. As accurate as [`power_center_in_space`]. The points are not
/// collinear.
pub(crate) fn power_center_of_facet(corners: [[f64; 4]; 3]) -> [f64; 3] {
    OfFacet(corners).offset()
}
