use std::ops::{Add, Div, Mul, Sub};

use super::expansion::{two_product, two_sum};

/// A number as the unevaluated sum of two doubles, the second below the last place of the first:
/// twice the digits of a double.
///
/// Sums, products and quotients are correct to within `2^-101` of their magnitude, as long as
/// nothing overflows or underflows (Joldes, Muller and Popescu 2017: the algorithms
/// AccurateDWPlusDW, DWTimesDW and DWDivDW with 3, 5 and 15 squares of `2^-53`).
#[derive(Debug, Clone, Copy)]
pub struct Pair {
    high: f64,
    low: f64,
}

impl Pair {
    /// A bound on the relative error of one operation.
    pub const ERROR: f64 = f64::from_bits((1023 - 101) << 52);

    /// Returns `a - b`, exactly.
    #[inline(always)]
    pub fn difference(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, -b);
        Pair { high, low }
    }

    /// Returns the nearest double.
    #[inline(always)]
    pub fn estimate(self) -> f64 {
        self.high
    }

    /// Returns the double nearest to every number that is at most `error` away; `None` if there is
    /// none.
    #[inline(always)]
    pub fn rounded(self, error: f64) -> Option<f64> {
        let Pair { high, low } = self;
        (high + (low - error) == high && high + (low + error) == high).then_some(high)
    }

    /// Returns what the [estimate](Self::estimate) leaves.
    #[inline(always)]
    pub(super) fn rest(self) -> f64 {
        self.low
    }
}

/// Returns `a + b` as a pair, if `a` is not smaller in magnitude than `b`.
#[inline(always)]
fn quick_two_sum(a: f64, b: f64) -> Pair {
    let high = a + b;
    Pair {
        high,
        low: b - (high - a),
    }
}

impl Add for Pair {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (s_high, s_low) = two_sum(self.high, other.high);
        let (t_high, t_low) = two_sum(self.low, other.low);
        let v = quick_two_sum(s_high, s_low + t_high);
        quick_two_sum(v.high, t_low + v.low)
    }
}

impl Sub for Pair {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + Pair {
            high: -other.high,
            low: -other.low,
        }
    }
}

impl Mul for Pair {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (high, low) = two_product(self.high, other.high);
        quick_two_sum(high, low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Pair {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        // The quotient of the leading parts, and the remainder that it leaves.
        let high = self.high / other.high;
        let rest = self - other * Pair { high, low: 0.0 };
        quick_two_sum(high, rest.high / other.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Dyadic;

    fn exact(p: Pair) -> Dyadic {
        Dyadic::from(p.high) + Dyadic::from(p.low)
    }

    #[test]
    fn errors_are_within_the_bound() {
        let mut state = 1u64;
        let mut unit = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.4
        };
        for _ in 0..20_000 {
            let scale = [1.0, 1e-9, 1e9][(unit().abs() * 4.0) as usize % 3];
            let p = Pair::difference(unit(), unit() * 1e-3);
            let q = Pair::difference(unit() * scale, unit() * 1e-12);
            let near = |found: Pair, truth: Dyadic| {
                let error = (exact(found) - truth).estimate().abs();
                assert!(
                    error <= Pair::ERROR * found.high.abs(),
                    "{p:?} {q:?}: {error:e}"
                );
            };
            near(p + q, exact(p) + exact(q));
            near(p - q, exact(p) - exact(q));
            near(p * q, exact(p) * exact(q));
            // q (p / q) is p, up to the error of the quotient.
            let error = (exact(p / q) * exact(q) - exact(p)).estimate().abs();
            assert!(
                error <= Pair::ERROR * p.high.abs(),
                "{p:?} {q:?}: {error:e}"
            );
        }
    }
}
