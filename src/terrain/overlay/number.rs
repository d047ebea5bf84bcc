//! Numbers that polygons are computed with: doubles, or pairs of them where doubles do not suffice.

use std::ops::{Add, Div, Mul, Sub};

use crate::terrain::linear::linear;
use crate::triangulation::num::Pair;

/// A number. Its [`value`](Self::value) has its sign.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Returns `a - b`, rounded.
    fn difference(a: f64, b: f64) -> Self;

    /// Returns the nearest double.
    fn value(self) -> f64;

    /// Returns the height of a triangle at a position in it.
    fn linear(triangle: [[Self; 3]; 3], at: [Self; 2]) -> Self;

    fn of(value: f64) -> Self {
        Self::difference(value, 0.0)
    }
}

impl Number for f64 {
    #[inline(always)]
    fn difference(a: f64, b: f64) -> Self {
        a - b
    }

    #[inline(always)]
    fn value(self) -> f64 {
        self
    }

    #[inline(always)]
    fn linear(triangle: [[Self; 3]; 3], at: [Self; 2]) -> Self {
        linear(triangle, at)
    }
}

/// Differences of doubles are exact, and all that follows has twice the digits.
impl Number for Pair {
    fn difference(a: f64, b: f64) -> Self {
        Pair::difference(a, b)
    }

    fn value(self) -> f64 {
        self.estimate()
    }

    fn linear([a, b, c]: [[Self; 3]; 3], q: [Self; 2]) -> Self {
        let cross = |p: [Self; 3], r: [Self; 3]| {
            (p[0] - q[0]) * (r[1] - q[1]) - (p[1] - q[1]) * (r[0] - q[0])
        };
        let (at_a, at_b, at_c) = (cross(b, c), cross(c, a), cross(a, b));
        let area = at_a + at_b + at_c;
        match area.value() {
            0.0 => a[2],
            _ => a[2] + (at_b * (b[2] - a[2]) + at_c * (c[2] - a[2])) / area,
        }
    }
}
