//! The power test: the in-circle and in-sphere tests for points with a weight.
//!
//! A weight is an area, of degree 2 in the coordinates. That would break the law that all terms of
//! a predicate have one degree, which integers on a common grid and [`Scaled`](super::Scaled) rely
//! on. So each weight is multiplied by a difference that is 1. Weights, and that difference, are on
//! axes of their own.

use super::Predicate;
use super::formula::{
    cross, in_circle, in_sphere, largest_minus, minus, minus_in_space, square, squared_length,
};
use crate::num::Number;

/// Returns the coordinates of weighted points on an axis: those in the plane or in space, weights,
/// and the two whose difference is 1. The last coordinate of a point is its weight.
fn axis<const D: usize, const N: usize>(
    points: &[[f64; D]; N],
    axis: usize,
) -> impl Iterator<Item = f64> + Clone {
    let of_point = move |p: &[f64; D]| if axis < D { p[axis] } else { 1.0 };
    let zero = (axis == D).then_some(0.0);
    points.iter().map(of_point).chain(zero)
}

/// Returns the lift of `p` relative to `q`: the squared distance, less the difference of the
/// weights.
#[inline(always)]
fn lift<T: Number, const D: usize>(
    squared_distance: T,
    p: [f64; D],
    q: [f64; D],
    difference: impl Fn(f64, f64) -> T,
) -> T {
    squared_distance - difference(p[D - 1], q[D - 1]) * difference(1.0, 0.0)
}

/// The power test of three weighted points `[x, y, w]` that turn counter-clockwise and a fourth:
/// positive if the fourth's lift is below the plane through theirs, zero if on it. For equal
/// weights, this is [`InCircle`](super::InCircle).
///
/// The *lift* of a point lies above it, at height `x^2 + y^2 - w`. The lower hull of all lifts is
/// the regular triangulation; without weights, it is the Delaunay triangulation (Aurenhammer 1987).
#[derive(Debug, Clone, Copy)]
pub struct PowerTest2(pub [[f64; 3]; 4]);

impl Predicate for PowerTest2 {
    const DEGREE: i32 = 4;
    const AXES: usize = 4;

    #[inline(always)]
    fn axis(&self, of: usize) -> impl Iterator<Item = f64> + Clone {
        axis(&self.0, of)
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b, c, d] = self.0;
        let [u, v, w] = [a, b, c].map(|p| minus([p[0], p[1]], [d[0], d[1]], difference));
        let lifts = [(&u, a), (&v, b), (&w, c)]
            .map(|(vector, p)| lift(squared_length(vector), p, d, difference));
        in_circle(u, v, w, lifts)
    }
}

/// The power test of four weighted points `[x, y, z, w]` that are positively oriented and a fifth:
/// positive if the fifth's lift is below the hyperplane through theirs, zero if on it. For equal
/// weights, this is [`InSphere`](super::InSphere).
#[derive(Debug, Clone, Copy)]
pub struct PowerTest3(pub [[f64; 4]; 5]);

impl Predicate for PowerTest3 {
    const DEGREE: i32 = 5;
    const AXES: usize = 5;

    #[inline(always)]
    fn axis(&self, of: usize) -> impl Iterator<Item = f64> + Clone {
        axis(&self.0, of)
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b, c, d, q] = self.0;
        let from_q = |p| minus_in_space(site(p), site(q), difference);
        let vectors = [from_q(a), from_q(b), from_q(c), from_q(d)];
        let lift_of = |vector: &[T; 3], p: [f64; 4]| lift(squared_length(vector), p, q, difference);
        let lifts = [
            lift_of(&vectors[0], a),
            lift_of(&vectors[1], b),
            lift_of(&vectors[2], c),
            lift_of(&vectors[3], d),
        ];
        in_sphere(vectors, lifts)
    }

    #[inline(always)]
    fn widest(&self) -> Option<Self> {
        let [a, b, c, d, q] = self.0;
        let far = largest_minus([a, b, c, d], q);
        Some(PowerTest3([far, far, far, far, [0.0; 4]]))
    }
}

/// The power test of four weighted points `[x, y, z, w]` with sites in a common plane: positive if
/// the lift of the fourth is below the plane through the lifts of the first three, which turn
/// counter-clockwise seen along the axis that is left out.
#[derive(Debug, Clone, Copy)]
pub struct PowerInPlane {
    /// The triangle, and the query point.
    pub points: [[f64; 4]; 4],
    /// The two axes of a projection in which the triangle has an area.
    pub axes: [usize; 2],
}

impl Predicate for PowerInPlane {
    const DEGREE: i32 = 4;
    const AXES: usize = 5;

    fn axis(&self, of: usize) -> impl Iterator<Item = f64> + Clone {
        axis(&self.points, of)
    }

    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b, c, q] = self.points;
        let vectors = [a, b, c].map(|p| minus(site(p), site(q), difference));
        let lifts = std::array::from_fn(|k| {
            lift(squared_length(&vectors[k]), self.points[k], q, difference)
        });
        let [a, b, c] = vectors.map(|v| self.axes.map(|axis| v[axis].clone()));
        in_circle(a, b, c, lifts)
    }
}

/// Returns the position of a weighted point in space.
#[inline(always)]
fn site([x, y, z, _]: [f64; 4]) -> [f64; 3] {
    [x, y, z]
}

/// The power test of three weighted points on a line, `[x, y, w]` in the plane (`D` is 3) or
/// `[x, y, z, w]` in space (4): positive if the third's lift is below the line through the lifts of
/// the first two, zero if on it. The first has the smaller coordinate.
#[derive(Debug, Clone, Copy)]
pub struct PowerOnLine<const D: usize> {
    /// The two points, and the query point.
    pub points: [[f64; D]; 3],
    /// An axis on which the first two differ.
    pub along: usize,
}

impl<const D: usize> Predicate for PowerOnLine<D> {
    const DEGREE: i32 = 3;
    const AXES: usize = D + 1;

    #[inline(always)]
    fn axis(&self, of: usize) -> impl Iterator<Item = f64> + Clone {
        axis(&self.points, of)
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b, q] = self.points;
        let [a_lift, b_lift] = [a, b].map(|p| power(p, q, difference));
        let [u, v] = [a, b].map(|p| difference(p[self.along], q[self.along]));
        cross(&a_lift, &v, &b_lift, &u)
    }
}

/// A comparison of powers at a point: positive if the first of two weighted points, `[x, y, w]` in
/// the plane (`D` is 3) or `[x, y, z, w]` in space (4), has the larger power there, which is its
/// squared distance less its weight. The query point comes first; its own weight does not count.
#[derive(Debug, Clone, Copy)]
pub struct ComparePower<const D: usize>(pub [[f64; D]; 3]);

impl<const D: usize> Predicate for ComparePower<D> {
    const DEGREE: i32 = 2;
    const AXES: usize = D + 1;

    #[inline(always)]
    fn axis(&self, of: usize) -> impl Iterator<Item = f64> + Clone {
        axis(&self.0, of)
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [q, a, b] = self.0;
        power(a, q, difference) - power(b, q, difference)
    }
}

/// Returns the lift of a weighted point relative to another one, on any number of axes.
#[inline(always)]
fn power<T: Number, const D: usize>(
    p: [f64; D],
    q: [f64; D],
    difference: impl Fn(f64, f64) -> T + Copy,
) -> T {
    let axis = |k: usize| square(&difference(p[k], q[k]));
    lift(
        (1..D - 1).fold(axis(0), |sum, k| sum + axis(k)),
        p,
        q,
        difference,
    )
}
