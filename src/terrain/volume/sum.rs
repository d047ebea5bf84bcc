//! Sums that do not depend on the order of what is added.

use std::ops::{AddAssign, Sub};

/// The bits of the largest number that is to be added.
const BITS: i32 = 100;

/// A unit that is so small that rounding numbers to it does not matter: 2^-100 of the largest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::terrain) struct Unit(f64);

impl Unit {
    /// Returns the unit for sums of numbers that are at most about as large as this one.
    pub(in crate::terrain) fn for_up_to(largest: f64) -> Self {
        let exponent = if largest > 0.0 {
            largest.log2().ceil()
        } else {
            0.0
        };
        Unit(f64::exp2((exponent as i32 - BITS).clamp(-1000, 900).into()))
    }

    /// Returns a number in this unit.
    ///
    /// `PERF:` in most parts one surface is higher everywhere: half of all values are 0.
    pub(in crate::terrain) fn of(self, value: f64) -> Sum {
        if value == 0.0 {
            return Sum(0);
        }
        Sum((value / self.0).round_ties_even() as i128)
    }

    /// Returns a sum as a number.
    pub(in crate::terrain) fn value(self, sum: Sum) -> f64 {
        sum.0 as f64 * self.0
    }
}

/// A sum of numbers in some [`Unit`]. Sums are exact: their order does not matter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(in crate::terrain) struct Sum(i128);

impl AddAssign for Sum {
    fn add_assign(&mut self, other: Self) {
        self.0 = self.0.saturating_add(other.0);
    }
}

impl Sub for Sum {
    type Output = Sum;

    fn sub(self, other: Self) -> Sum {
        Sum(self.0.saturating_sub(other.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_count_beside_large_ones() {
        let unit = Unit::for_up_to(1e20);
        let mut sum = unit.of(1e20);
        // The unit is 2^-33: what is added is a multiple of it, and lost beside 1e20 in an f64.
        for _ in 0..1024 {
            sum += unit.of(1.0 / 1024.0);
        }
        sum += unit.of(-1e20);
        assert_eq!(unit.value(sum), 1.0);
        for largest in [0.0, f64::NAN, f64::INFINITY, 1e-320] {
            assert_eq!(Unit::for_up_to(largest).value(Sum::default()), 0.0);
        }
    }
}
