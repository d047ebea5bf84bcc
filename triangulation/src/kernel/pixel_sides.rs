//! Predicates of rounding: on which side of a pixel's border something lies.
//!
//! A border is half a unit from the center of its pixel, which takes one bit more than a coordinate
//! has. So center and offset are passed separately, and their sum is computed in the arithmetic.

use super::Predicate;
use super::formula::{cross, minus};
use crate::num::Number;

/// The side of a segment on which a corner lies, given as a center and an offset: positive if to
/// the left.
#[derive(Debug, Clone, Copy)]
pub struct CornerSide {
    /// The ends of the segment.
    pub segment: [[f64; 2]; 2],
    /// The center of a pixel.
    pub center: [f64; 2],
    /// The vector from the center to the corner.
    pub offset: [f64; 2],
}

impl Predicate for CornerSide {
    const DEGREE: i32 = 2;
    const AXES: usize = 2;

    #[inline]
    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        let [a, b] = self.segment;
        [a[axis], b[axis], self.center[axis], self.offset[axis], 0.0].into_iter()
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b] = self.segment;
        let [ux, uy] = minus(b, a, difference);
        let [cx, cy] = minus(self.center, a, difference);
        let [ox, oy] = minus(self.offset, [0.0; 2], difference);
        cross(&ux, &(cy + oy), &uy, &(cx + ox))
    }
}

/// The side of a value on one axis on which two segments cross: positive if the crossing lies
/// beyond the value, times the turn of `c d a`. The value is given as a center and an offset.
#[derive(Debug, Clone, Copy)]
pub struct CrossingSide {
    /// One segment, `a b`.
    pub ab: [[f64; 2]; 2],
    /// The other segment, `c d`.
    pub cd: [[f64; 2]; 2],
    /// The axis: 0 or 1.
    pub along: usize,
    /// The center of a pixel, on that axis.
    pub center: f64,
    /// The offset from the center to the value.
    pub offset: f64,
}

impl Predicate for CrossingSide {
    const DEGREE: i32 = 3;
    const AXES: usize = 2;

    #[inline]
    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        let [a, b] = self.ab;
        let [c, d] = self.cd;
        // On the other axis only the segments enter; one of their coordinates stands in for the
        // center.
        let [center, offset] = if axis == self.along {
            [self.center, self.offset]
        } else {
            [a[axis], 0.0]
        };
        [a[axis], b[axis], c[axis], d[axis], center, offset, 0.0].into_iter()
    }

    /// The crossing is `a + (b - a) A / D` with the areas `A = [c d a]` and
    /// `D = A - [c d b] = (d - c) x (a - b)`.
    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b] = self.ab;
        let [c, d] = self.cd;
        let [ux, uy] = minus(d, c, difference);
        let [vx, vy] = minus(a, c, difference);
        let vector = minus(a, b, difference);
        let area = cross(&ux, &vy, &uy, &vx);
        let divisor = cross(&ux, &vector[1], &uy, &vector[0]);
        let beside = difference(a[self.along], self.center) - difference(self.offset, 0.0);
        beside * divisor - vector[self.along].clone() * area
    }
}
