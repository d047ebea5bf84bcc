//! The power test: the in-circle test for points with a weight.
//!
//! A weight is an area, of degree 2 in the coordinates. That would break the law that all terms of
//! a predicate have one degree, which integers on a common grid and [`Scaled`](super::Scaled) rely
//! on. So each weight is multiplied by a difference that is 1. Weights, and that difference, are on
//! axes of their own.

use super::Predicate;
use super::formula::{cross, in_circle, minus, square};
use crate::num::Number;

/// Returns the coordinates of weighted points on an axis: x, y, weights, and the two whose
/// difference is 1.
fn axis<const N: usize>(points: &[[f64; 3]; N], axis: usize) -> impl Iterator<Item = f64> + Clone {
    let of_point = move |p: &[f64; 3]| if axis < 3 { p[axis] } else { 1.0 };
    let zero = (axis == 3).then_some(0.0);
    points.iter().map(of_point).chain(zero)
}

/// Returns the lift of `p` relative to `q`: the squared distance in the plane, less the difference
/// of the weights.
#[inline(always)]
fn lift<T: Number>(vector: &[T; 2], p: [f64; 3], q: [f64; 3], difference: impl Fn(f64, f64) -> T) -> T {
    square(&vector[0]) + square(&vector[1]) - difference(p[2], q[2]) * difference(1.0, 0.0)
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
        let lifts = [lift(&u, a, d, difference), lift(&v, b, d, difference), lift(&w, c, d, difference)];
        in_circle(u, v, w, lifts)
    }
}

/// The power test of three weighted points `[x, y, w]` on a line: positive if the third's lift is
/// below the line through the lifts of the first two, zero if on it. The first has the smaller
/// coordinate.
#[derive(Debug, Clone, Copy)]
pub struct PowerOnLine {
    /// The two points, and the query point.
    pub points: [[f64; 3]; 3],
    /// The axis on which the first two differ: 0 or 1.
    pub along: usize,
}

impl Predicate for PowerOnLine {
    const DEGREE: i32 = 3;
    const AXES: usize = 4;

    #[inline(always)]
    fn axis(&self, of: usize) -> impl Iterator<Item = f64> + Clone {
        axis(&self.points, of)
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b, q] = self.points;
        let [u, v] = [a, b].map(|p| minus([p[0], p[1]], [q[0], q[1]], difference));
        let (a_lift, b_lift) = (lift(&u, a, q, difference), lift(&v, b, q, difference));
        cross(&a_lift, &v[self.along], &b_lift, &u[self.along])
    }
}

/// A comparison of powers at a point: positive if the first of two weighted points `[x, y, w]` has
/// the larger power there, which is its squared distance less its weight. The query point comes
/// first; its own weight does not count.
#[derive(Debug, Clone, Copy)]
pub struct ComparePower(pub [[f64; 3]; 3]);

impl Predicate for ComparePower {
    const DEGREE: i32 = 2;
    const AXES: usize = 4;

    #[inline(always)]
    fn axis(&self, of: usize) -> impl Iterator<Item = f64> + Clone {
        axis(&self.0, of)
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [q, a, b] = self.0;
        let [u, v] = [a, b].map(|p| minus([p[0], p[1]], [q[0], q[1]], difference));
        lift(&u, a, q, difference) - lift(&v, b, q, difference)
    }
}
