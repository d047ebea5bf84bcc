//! The formulas of the predicates, each written once.

use super::{Predicate, RANGE};
use crate::num::{Dyadic, Expansion, Number};

/// Returns `a b - c d`.
#[inline(always)]
pub(super) fn cross<T: Number>(a: &T, b: &T, c: &T, d: &T) -> T {
    a.clone() * b.clone() - c.clone() * d.clone()
}

#[inline(always)]
pub(super) fn square<T: Number>(a: &T) -> T {
    a.clone() * a.clone()
}

/// Returns the squared length of a vector.
#[inline(always)]
pub(super) fn squared_length<T: Number, const D: usize>(vector: &[T; D]) -> T {
    (1..D).fold(square(&vector[0]), |sum, axis| sum + square(&vector[axis]))
}

/// Returns `p - q`, axis by axis.
#[inline(always)]
pub(super) fn minus<T: Number, const D: usize>(
    p: [f64; D],
    q: [f64; D],
    difference: impl Fn(f64, f64) -> T,
) -> [T; D] {
    std::array::from_fn(|axis| difference(p[axis], q[axis]))
}

/// The orientation of three points in the plane: positive if they turn counter-clockwise, zero if
/// they are collinear.
#[derive(Debug, Clone, Copy)]
pub struct Orientation2(pub [[f64; 2]; 3]);

impl Predicate for Orientation2 {
    const DEGREE: i32 = 2;
    const AXES: usize = 2;

    #[inline(always)]
    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        self.0.iter().map(move |p| p[axis])
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b, c] = self.0;
        let [ux, uy] = minus(a, c, difference);
        let [vx, vy] = minus(b, c, difference);
        cross(&ux, &vy, &uy, &vx)
    }
}

/// Returns the in-circle determinant of three vectors in a plane, which start at the query point,
/// and their squared lengths.
#[inline(always)]
pub(super) fn in_circle<T: Number>(a: [T; 2], b: [T; 2], c: [T; 2], lengths: [T; 3]) -> T {
    let [a_length, b_length, c_length] = lengths;
    let bc = cross(&b[0], &c[1], &b[1], &c[0]);
    let ca = cross(&c[0], &a[1], &c[1], &a[0]);
    let ab = cross(&a[0], &b[1], &a[1], &b[0]);
    a_length * bc + b_length * ca + c_length * ab
}

/// The in-circle test of a counter-clockwise triangle and a fourth point: positive if the point
/// lies inside the circumscribed circle, zero if on it.
#[derive(Debug, Clone, Copy)]
pub struct InCircle(pub [[f64; 2]; 4]);

impl Predicate for InCircle {
    const DEGREE: i32 = 4;
    const AXES: usize = 2;

    #[inline(always)]
    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        self.0.iter().map(move |p| p[axis])
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b, c, d] = self.0;
        let [a, b, c] = [a, b, c].map(|p| minus(p, d, difference));
        let lengths = [&a, &b, &c].map(squared_length);
        in_circle(a, b, c, lengths)
    }
}

/// The orientation of four points in space: positive if `b - a`, `c - a`, `d - a` are a
/// right-handed system, zero if the points are coplanar.
#[derive(Debug, Clone, Copy)]
pub struct Orientation3(pub [[f64; 3]; 4]);

impl Predicate for Orientation3 {
    const DEGREE: i32 = 3;
    const AXES: usize = 3;

    #[inline(always)]
    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        self.0.iter().map(move |p| p[axis])
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b, c, d] = self.0;
        // Relative to d, the determinant has the opposite sign: exchanging a and b makes up for it.
        let [ux, uy, uz] = minus(b, d, difference);
        let [vx, vy, vz] = minus(a, d, difference);
        let [wx, wy, wz] = minus(c, d, difference);
        let vw = cross(&vx, &wy, &vy, &wx);
        let wu = cross(&wx, &uy, &wy, &ux);
        let uv = cross(&ux, &vy, &uy, &vx);
        uz * vw + vz * wu + wz * uv
    }
}

/// Returns the in-sphere determinant of four vectors in space, which start at the query point, and
/// their squared lengths.
#[inline(always)]
pub(super) fn in_sphere<T: Number>(
    [b, a, c, d]: [[T; 3]; 4],
    [b_length, a_length, c_length, d_length]: [T; 4],
) -> T {
    // With rows in this order, the 4 x 4 determinant is positive inside.
    let plane = |p: &[T; 3], q: &[T; 3]| cross(&p[0], &q[1], &p[1], &q[0]);
    let (ab, bc, cd, da) = (plane(&a, &b), plane(&b, &c), plane(&c, &d), plane(&d, &a));
    let (ac, bd) = (plane(&a, &c), plane(&b, &d));
    let volume = |p: &T, qr: &T, q: &T, pr: &T, r: &T, pq: &T| {
        p.clone() * qr.clone() - q.clone() * pr.clone() + r.clone() * pq.clone()
    };
    let abc = volume(&a[2], &bc, &b[2], &ac, &c[2], &ab);
    let bcd = volume(&b[2], &cd, &c[2], &bd, &d[2], &bc);
    // Two minors have their rows in another order: ac = -ca, and so on.
    let cda = c[2].clone() * da.clone() + d[2].clone() * ac.clone() + a[2].clone() * cd.clone();
    let dab = d[2].clone() * ab.clone() + a[2].clone() * bd.clone() + b[2].clone() * da.clone();
    (d_length * abc - c_length * dab) + (b_length * cda - a_length * bcd)
}

/// The in-sphere test of a positively oriented tetrahedron and a fifth point: positive if the point
/// lies inside the circumscribed sphere, zero if on it.
#[derive(Debug, Clone, Copy)]
pub struct InSphere(pub [[f64; 3]; 5]);

impl Predicate for InSphere {
    const DEGREE: i32 = 5;
    const AXES: usize = 3;

    #[inline(always)]
    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        self.0.iter().map(move |p| p[axis])
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b, c, d, e] = self.0;
        let vectors = [a, b, c, d].map(|p| minus(p, e, difference));
        let lengths = vectors.each_ref().map(squared_length);
        in_sphere(vectors, lengths)
    }
}

/// The in-circle test of four points in a common plane in space: positive if the fourth lies inside
/// the circle of the first three, which turn counter-clockwise seen along the axis that is left
/// out.
///
/// Areas in the plane and in a projection of it have a constant ratio. So the determinant can be
/// computed from projected areas and from lengths in space.
#[derive(Debug, Clone, Copy)]
pub struct InCircleOfPlane {
    /// The triangle, and the query point.
    pub points: [[f64; 3]; 4],
    /// The two axes of a projection in which the triangle has an area.
    pub axes: [usize; 2],
}

impl Predicate for InCircleOfPlane {
    const DEGREE: i32 = 4;
    const AXES: usize = 3;

    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        self.points.iter().map(move |p| p[axis])
    }

    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b, c, d] = self.points;
        let vectors = [a, b, c].map(|p| minus(p, d, difference));
        let lengths = vectors.each_ref().map(squared_length);
        let [a, b, c] = vectors.map(|v| self.axes.map(|axis| v[axis].clone()));
        in_circle(a, b, c, lengths)
    }
}

/// A comparison of distances, in the plane (`D` is 2) or in space (3): positive if the second point
/// is further from the first than the third is.
#[derive(Debug, Clone, Copy)]
pub struct CompareDistance<const D: usize>(pub [[f64; D]; 3]);

impl<const D: usize> Predicate for CompareDistance<D> {
    const DEGREE: i32 = 2;
    const AXES: usize = D;

    #[inline(always)]
    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        self.0.iter().map(move |p| p[axis])
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [from, p, q] = self.0;
        let [p, q] = [p, q].map(|p| minus(p, from, difference));
        squared_length(&p) - squared_length(&q)
    }
}

/// The dot product at the second of three points in the plane: positive if the angle there is
/// acute, zero if it is right or one of the other points coincides with the second.
///
/// If it is negative, the second point lies inside the circle that has the other two as its
/// diameter.
#[derive(Debug, Clone, Copy)]
pub struct DotProduct(pub [[f64; 2]; 3]);

impl Predicate for DotProduct {
    const DEGREE: i32 = 2;
    const AXES: usize = 2;

    #[inline(always)]
    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        self.0.iter().map(move |p| p[axis])
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [p, apex, q] = self.0;
        let [ux, uy] = minus(p, apex, difference);
        let [vx, vy] = minus(q, apex, difference);
        ux * vx + uy * vy
    }
}

/// Returns twice the signed area of a triangle, correct to the last bits: positive if the points
/// turn counter-clockwise, zero only if they are collinear or the area is too small for a double.
pub fn twice_area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let area = Orientation2([a, b, c]);
    if in_range(&area) {
        area.value(Expansion::difference).estimate()
    } else {
        area.value(Dyadic::difference).estimate()
    }
}

/// Returns where segment `a b` crosses the line through `c` and `d`, as a fraction of the segment
/// from `a`.
///
/// The two areas are computed exactly and only their quotient is rounded, so the result is correct
/// to the last bits however small the angle is. The segment must cross the line; this is not
/// checked.
pub fn crossing(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> f64 {
    let (area_a, area_b) = (Orientation2([c, d, a]), Orientation2([c, d, b]));
    if in_range(&area_a) && in_range(&area_b) {
        let (at_a, at_b) = (
            area_a.value(Expansion::difference),
            area_b.value(Expansion::difference),
        );
        let from_a = at_a.estimate();
        from_a / (at_a - at_b).estimate()
    } else {
        let (at_a, at_b) = (
            area_a.value(Dyadic::difference),
            area_b.value(Dyadic::difference),
        );
        at_a.clone().quotient(&(at_a - at_b))
    }
}

/// Returns true if expansions are exact for these coordinates.
pub(super) fn in_range<P: Predicate>(predicate: &P) -> bool {
    (0..P::AXES).all(|axis| predicate.axis(axis).all(|x| RANGE.admits(x)))
}
