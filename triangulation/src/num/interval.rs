use std::ops::{Add, Mul, Sub};

use super::Sign;
use super::expansion::{two_product, two_sum};

/// The range of values that a rounded number may stand for: from `low` to `high`.
///
/// Bounds are rounded outward without changing the processor's rounding mode. The error of a sum or
/// product is known exactly; its sign says on which side of the result the true value lies, and
/// only that bound moves to the next double. Exact results stay single numbers, so ties of small
/// whole numbers are certain. Tighter than [`Bounded`](super::Bounded), which assumes the largest
/// possible error for every rounding, and slower.
///
/// Sound as long as no product underflows or overflows, which [`RANGE`](crate::kernel::RANGE)
/// guarantees for the predicates of this crate.
#[derive(Debug, Clone, Copy)]
pub struct Interval {
    low: f64,
    high: f64,
}

impl Interval {
    /// Returns an interval around `a - b`: one number if that is exact, else two consecutive
    /// doubles.
    #[inline(always)]
    pub fn difference(a: f64, b: f64) -> Self {
        Self::around(two_sum(a, -b))
    }

    /// Returns the sign, or `None` unless all numbers in the interval have the same.
    #[inline(always)]
    pub fn sign(self) -> Option<Sign> {
        if self.low > 0.0 {
            Some(Sign::Positive)
        } else if self.high < 0.0 {
            Some(Sign::Negative)
        } else if self.low == 0.0 && self.high == 0.0 {
            Some(Sign::Zero)
        } else {
            None
        }
    }

    /// Returns the interval of a rounded value and its error.
    #[inline(always)]
    fn around(rounded: (f64, f64)) -> Self {
        Interval {
            low: down(rounded),
            high: up(rounded),
        }
    }

    #[inline(always)]
    fn is_exact(self) -> bool {
        self.low == self.high
    }
}

/// Returns a value rounded down, given the rounded value and its error.
#[inline(always)]
fn down((value, error): (f64, f64)) -> f64 {
    if error < 0.0 {
        value.next_down()
    } else {
        value
    }
}

/// Returns a value rounded up, given the rounded value and its error.
#[inline(always)]
fn up((value, error): (f64, f64)) -> f64 {
    if error > 0.0 { value.next_up() } else { value }
}

impl Add for Interval {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Interval {
            low: down(two_sum(self.low, other.low)),
            high: up(two_sum(self.high, other.high)),
        }
    }
}

impl Sub for Interval {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Interval {
            low: down(two_sum(self.low, -other.high)),
            high: up(two_sum(self.high, -other.low)),
        }
    }
}

impl Mul for Interval {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        if self.is_exact() && other.is_exact() {
            return Self::around(two_product(self.low, other.low));
        }
        // Rounding is monotone: the smallest of the rounded products is the smallest product,
        // rounded. The bounds move outward even if they are exact; a zero may come from an
        // underflow.
        let products = [
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ];
        Interval {
            low: products
                .into_iter()
                .fold(f64::INFINITY, f64::min)
                .next_down(),
            high: products
                .into_iter()
                .fold(f64::NEG_INFINITY, f64::max)
                .next_up(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Dyadic;

    fn contains(interval: Interval, truth: &Dyadic) -> bool {
        let below = (truth.clone() - Dyadic::from(interval.low)).sign();
        let above = (Dyadic::from(interval.high) - truth.clone()).sign();
        below != Sign::Negative && above != Sign::Negative
    }

    /// Random polynomials of random numbers; some of few bits, some equal.
    #[test]
    fn the_truth_is_within_and_the_bounds_are_near() {
        let mut state = 1u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let mut exact = 0;
        for round in 0..20_000 {
            let coarse = |x: f64| if round % 2 == 0 { (x * 8.0).round() } else { x };
            let numbers = [(); 6].map(|()| coarse(random()));
            fn polynomial<T: crate::num::Number>([a, b, c, d, e, f]: [T; 6]) -> T {
                (a.clone() * b.clone() - c.clone() * d.clone()) * (e.clone() - a * d)
                    + (b * f.clone() - e) * (c * f)
            }
            let interval = polynomial(numbers.map(|x| Interval::difference(x, 0.1 * numbers[0])));
            let truth = polynomial(numbers.map(|x| Dyadic::difference(x, 0.1 * numbers[0])));
            assert!(contains(interval, &truth), "{interval:?}");
            assert!(
                interval.high - interval.low
                    < 100.0 * f64::EPSILON * (1.0 + interval.high.abs()) * 512.0
            );
            exact += usize::from(interval.is_exact());
            assert!(interval.sign().is_none_or(|sign| sign == truth.sign()));
        }
        assert!(exact > 1000, "{exact}");
    }

    #[test]
    fn what_is_exact_stays_one_number() {
        let number = |x: f64| Interval::difference(x, 0.0);
        let zero = number(3.0) * number(5.0) - number(15.0);
        assert_eq!(zero.sign(), Some(Sign::Zero));
        let third = number(1.0 / 3.0);
        assert_eq!(
            (third * third - third * third).sign(),
            None,
            "a rounding is not forgotten"
        );
        let wide = number(1.0) + number(1e-30);
        assert_eq!((wide.low, wide.high), (1.0, 1.0f64.next_up()));
        assert_eq!((wide - number(1.0)).sign(), None);
    }
}
