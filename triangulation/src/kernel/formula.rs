//! The formulas of the predicates, each written once.

use super::{Predicate, RANGE};
use crate::num::{Dyadic, Expansion, Number, Pair};

/// Returns `a b - c d`.
#[inline(always)]
pub(super) fn cross<T: Number>(a: &T, b: &T, c: &T, d: &T) -> T {
    a.clone() * b.clone() - c.clone() * d.clone()
}

#[inline(always)]
pub(super) fn square<T: Number>(a: &T) -> T {
    a.clone() * a.clone()
}

/// Returns the largest distance, axis by axis, of some points from `q`.
#[inline(always)]
pub(crate) fn largest_minus<const D: usize>(points: [[f64; D]; 4], q: [f64; D]) -> [f64; D] {
    // `PERF:` one instruction each, unlike `f64::max`.
    let larger = |x: f64, y: f64| if x > y { x } else { y };
    let [a, b, c, d] = points;
    let mut largest = [0.0; D];
    for axis in 0..D {
        let far = |p: &[f64; D]| (p[axis] - q[axis]).abs();
        largest[axis] = larger(larger(far(&a), far(&b)), larger(far(&c), far(&d)));
    }
    largest
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

/// Returns `p - q` in space.
#[inline(always)]
pub(super) fn minus_in_space<T: Number>(
    p: [f64; 3],
    q: [f64; 3],
    difference: impl Fn(f64, f64) -> T,
) -> [T; 3] {
    [
        difference(p[0], q[0]),
        difference(p[1], q[1]),
        difference(p[2], q[2]),
    ]
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
        // `PERF:` four by four written out, like the axes in `minus_in_space`. What maps arrays
        // becomes a function of its own, whose results are passed through memory.
        let [a, b, c, d] = [
            minus_in_space(a, e, difference),
            minus_in_space(b, e, difference),
            minus_in_space(c, e, difference),
            minus_in_space(d, e, difference),
        ];
        let lengths = [
            squared_length(&a),
            squared_length(&b),
            squared_length(&c),
            squared_length(&d),
        ];
        in_sphere([a, b, c, d], lengths)
    }

    #[inline(always)]
    fn widest(&self) -> Option<Self> {
        let [a, b, c, d, e] = self.0;
        let far = largest_minus([a, b, c, d], e);
        Some(InSphere([far, far, far, far, [0.0; 3]]))
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

/// Returns the volumes, times six and rounded, that a point spans with the facets of a tetrahedron,
/// in the order of the vertices opposite to them: positive where it is inside, if the tetrahedron
/// is positively oriented.
///
/// The bits are those of [`Orientation3`] of each facet and the point, in two thirds of the
/// operations.
#[inline(always)]
pub(crate) fn facet_volumes(tetrahedron: [[f64; 3]; 4], q: [f64; 3]) -> [f64; 4] {
    let [a, b, c, d] = tetrahedron;
    let from_q = |p| minus_in_space(p, q, |x, y| x - y);
    let [a, b, c, d] = [from_q(a), from_q(b), from_q(c), from_q(d)];
    let plane = |p: &[f64; 3], q: &[f64; 3]| cross(&p[0], &q[1], &p[1], &q[0]);
    let (ab, bc, cd, ca) = (plane(&a, &b), plane(&b, &c), plane(&c, &d), plane(&c, &a));
    let (ad, db) = (plane(&a, &d), plane(&d, &b));
    [
        d[2] * bc + b[2] * cd + c[2] * db,
        d[2] * ca - a[2] * cd + c[2] * ad,
        d[2] * ab - (a[2] * db + b[2] * ad),
        -(b[2] * ca + a[2] * bc + c[2] * ab),
    ]
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
    crossing_by([a, b], [c, d], [a, b].map(|p| PointArea::new(p, [c, d])))
}

/// Twice the area between a point and two others, with twice the digits of a double.
///
/// `PERF:` two edges that a line crosses have a vertex in common, whose area is computed once.
#[derive(Debug, Clone, Copy)]
pub struct PointArea {
    area: Pair,
    /// The sum of its products, to which errors are relative.
    size: f64,
}

impl PointArea {
    /// Returns twice the area between `p` and the line through `c` and `d`; `None` if the
    /// coordinates are so large or so small that digits may be lost.
    #[inline]
    pub fn new(p: [f64; 2], [c, d]: [[f64; 2]; 2]) -> Option<Self> {
        if !in_range(&Orientation2([c, d, p])) {
            return None;
        }
        let [ux, uy] = minus(c, p, Pair::difference);
        let [vx, vy] = minus(d, p, Pair::difference);
        let (left, right) = (ux * vy, uy * vx);
        Some(PointArea {
            area: left - right,
            size: left.estimate().abs() + right.estimate().abs(),
        })
    }
}

/// Returns the [`crossing`] of segment `a b` and the line through `c` and `d`, with the same bits.
/// The areas are those of `a` and of `b`, as [`PointArea::new`] returns them.
#[inline]
pub fn crossing_by(
    [a, b]: [[f64; 2]; 2],
    [c, d]: [[f64; 2]; 2],
    areas: [Option<PointArea>; 2],
) -> f64 {
    let exact = [a, b].map(|p| Orientation2([c, d, p]));
    match areas {
        [Some(at_a), Some(at_b)] => {
            crossing_by_pairs(&at_a, &at_b).unwrap_or_else(|| crossing_exactly(&exact))
        }
        _ => crossing_of_any(&exact),
    }
}

/// Returns the [crossing] for any coordinates, given the exact areas at the ends of the segment.
#[cold]
fn crossing_of_any(areas: &[Orientation2; 2]) -> f64 {
    let [at_a, at_b] = areas.each_ref().map(|area| area.value(Dyadic::difference));
    at_a.clone().quotient(&(at_a - at_b))
}

/// Returns the [crossing], given the exact areas at the ends of the segment.
#[inline(never)]
fn crossing_exactly(areas: &[Orientation2; 2]) -> f64 {
    let [at_a, at_b] = areas
        .each_ref()
        .map(|area| area.value(Expansion::difference));
    let from_a = at_a.estimate();
    from_a / (at_a - at_b).estimate()
}

/// Returns the [crossing] with the bits of [`crossing_exactly`], by numbers of twice the digits;
/// `None` if they leave a doubt about a bit.
///
/// `PERF:` a tenth of the time, and the doubt is about one in 2^30.
#[inline]
fn crossing_by_pairs(at_a: &PointArea, at_b: &PointArea) -> Option<f64> {
    // Above the errors of both computations. Here each product is off by `Pair::ERROR`, and so is
    // each sum. There all components of an expansion but the largest are rounding errors, at most
    // 2^-52 of the products; their sum is rounded by 2^-53 of that.
    const ERROR: f64 = 32.0 * Pair::ERROR;
    let error = ERROR * (at_a.size + at_b.size);
    Some(at_a.area.rounded(error)? / (at_a.area - at_b.area).rounded(error)?)
}

/// Returns true if expansions are exact for these coordinates.
pub(super) fn in_range<P: Predicate>(predicate: &P) -> bool {
    (0..P::AXES).all(|axis| predicate.axis(axis).all(|x| RANGE.admits(x)))
}

#[cfg(test)]
mod tests {
    use testkit::random::Random;

    use super::*;

    #[test]
    fn crossings_by_pairs_have_the_bits_of_expansions() {
        let mut random = Random(5);
        let mut decided = 0;
        for _ in 0..20_000 {
            let step = random.pick(&[1.0, 0.01, 0.1 / 3.0]);
            let shift = random.pick(&[[0.0; 2], [500_000.0, 5_400_000.0]]);
            let mut point =
                |side: i64| [0, 1].map(|k| shift[k] + step * random.around(side) as f64);
            let [a, b] = [(); 2].map(|()| point(100));
            let [c, d] = [(); 2].map(|()| point(100_000));
            let exact = crossing_exactly(&[a, b].map(|p| Orientation2([c, d, p])));
            let [at_a, at_b] = [a, b].map(|p| PointArea::new(p, [c, d]).unwrap());
            if let Some(found) = crossing_by_pairs(&at_a, &at_b) {
                decided += 1;
                assert_eq!(found.to_bits(), exact.to_bits(), "{a:?} {b:?} {c:?} {d:?}");
            }
            assert!(crossing(a, b, c, d).to_bits() == exact.to_bits());
        }
        assert!(decided > 19_000, "{decided}");
        // Undecided: zero.
        let ends = [[0.0, 0.0], [3.0, 1.0]];
        let [at_a, at_b] = [[6.0, 2.0], [7.0, -5.0]].map(|p| PointArea::new(p, ends).unwrap());
        assert_eq!(crossing_by_pairs(&at_a, &at_b), None);
    }

    #[test]
    fn volumes_of_facets_have_the_bits_of_orientations() {
        let mut random = Random(1);
        for _ in 0..1000 {
            let [a, b, c, d, q] = [(); 5].map(|()| [(); 3].map(|()| random.unit()));
            let facets = [[b, d, c], [d, a, c], [b, a, d], [a, b, c]];
            let each = facets.map(|[a, b, c]| Orientation3([a, b, c, q]).value(|x, y| x - y));
            let volumes = facet_volumes([a, b, c, d], q);
            assert_eq!(volumes.map(f64::to_bits), each.map(f64::to_bits));
        }
    }
}
