use std::ops::{Add, Mul, Sub};

use super::{Number, Pair, Sign};

/// A floating-point result with a bound on its error: a double, or a [`Pair`] of doubles.
///
/// Besides the value it carries its *magnitude*: the same formula with every term made positive. If
/// every term of a polynomial passed through at most `k` roundings, the value and the true result
/// differ by at most `((1 + u)^k - 1) * magnitude`, where `u = 2^-53` (Shewchuk 1997, section 4.1;
/// Higham 2002, lemma 3.1). `k` depends on the formula only, so the optimizer sees a constant. For
/// pairs, `u = 2^-101`.
///
/// *Overflow* reaches the magnitude, which is never below the value: it becomes infinite or not a
/// number, and the sign unknown. *Underflow* is not accounted for, unless differences are
/// [floored](Self::floored_difference): coordinates must stay in [`RANGE`](crate::kernel::RANGE),
/// where nothing underflows.
#[derive(Debug, Clone, Copy)]
pub struct Bounded<T = f64> {
    value: T,
    magnitude: f64,
    roundings: u32,
}

/// A number type whose operations are rounded.
trait Rounded: Copy {
    /// The largest relative error of one operation.
    const UNIT: f64;

    /// Returns the nearest double, which has the same sign.
    fn estimate(self) -> f64;
}

impl Rounded for f64 {
    const UNIT: f64 = f64::EPSILON / 2.0;

    #[inline(always)]
    fn estimate(self) -> f64 {
        self
    }
}

impl Rounded for Pair {
    const UNIT: f64 = Pair::ERROR;

    #[inline(always)]
    fn estimate(self) -> f64 {
        Pair::estimate(self)
    }
}

/// The smallest magnitude of a floored difference.
const FLOOR: f64 = f64::from_bits((1023 - 160) << 52);

/// Returns `size`, or `FLOOR` if that is larger. One instruction; `f64::max` takes five, because of
/// NaN.
#[inline(always)]
fn floored(size: f64) -> f64 {
    if size > FLOOR { size } else { FLOOR }
}

impl Bounded {
    /// Returns `a - b`, rounded once.
    #[inline(always)]
    pub fn difference(a: f64, b: f64) -> Self {
        let value = a - b;
        Bounded {
            value,
            magnitude: value.abs(),
            roundings: 1,
        }
    }

    /// Returns `a - b`, rounded once, with a magnitude of at least `2^-160`: sound for all finite
    /// coordinates, in products of up to five differences.
    ///
    /// The magnitude of a product is then at least `2^-800`. Where the product underflows, it is
    /// rounded to a multiple of `2^-1074`, which adds less than any other rounding may add. Sums do
    /// not underflow. The price: a zero is never certain, nor is any sign where differences are
    /// that small.
    #[inline(always)]
    pub fn floored_difference(a: f64, b: f64) -> Self {
        let value = a - b;
        Bounded {
            value,
            magnitude: floored(value.abs()),
            roundings: 1,
        }
    }

    /// The computed value.
    #[inline(always)]
    pub fn value(self) -> f64 {
        self.value
    }
}

impl Bounded<Pair> {
    /// Returns `a - b`, exactly, with a floored magnitude: sound in the
    /// [range](crate::kernel::RANGE) of expansions.
    ///
    /// In that range both parts of the difference are exact, and nothing overflows. What is rounded
    /// has more digits below the last place of the coordinates. Where a product of them underflows,
    /// its error is a multiple of `2^-1074` and less than what a rounding of the floored magnitude,
    /// `2^-101` of `2^-800`, allows.
    #[inline(always)]
    pub fn exact_difference(a: f64, b: f64) -> Self {
        let value = Pair::difference(a, b);
        Bounded {
            value,
            magnitude: floored(value.estimate().abs()),
            roundings: 0,
        }
    }

    /// Returns the double nearest to the true result; `None` if that is not certain, or if it would
    /// not be after a truncation to 64 bits.
    pub(crate) fn nearest(self) -> Option<f64> {
        const TRUNCATION: f64 = 1.0 / (1u64 << 62) as f64;
        let size = self.value.estimate().abs();
        let half_a_digit = 0.5 * (size - size.next_down());
        let from_it = self.value.rest().abs() + self.error() + TRUNCATION * size;
        (size.is_normal() && from_it < half_a_digit).then_some(self.value.estimate())
    }
}

#[expect(private_bounds, reason = "implemented for two types, which are public")]
impl<T: Rounded> Bounded<T> {
    /// Returns a bound on the absolute error of the value.
    ///
    /// The computed magnitude passes through the same `k` roundings, so the true magnitude is at
    /// most the computed one divided by `(1 - u)^k`, and the error is at most
    /// `((1 + u)^k - 1) / (1 - u)^k < k u (1 + 2 k u)` times the computed one, for `k < 2^40`.
    /// Computing the bound adds three roundings. A margin of 2 % covers all of that while `k` is
    /// not in the millions.
    #[inline(always)]
    pub fn error(self) -> f64 {
        f64::from(self.roundings) * (1.02 * T::UNIT) * self.magnitude
    }

    /// Returns the sign, or `None` if the error may have changed it.
    ///
    /// If no term is left (each vanishes because two coordinates are equal), zero is certain, too.
    #[inline(always)]
    pub fn sign(self) -> Option<Sign> {
        let (value, bound) = (self.value.estimate(), self.error());
        if value > bound {
            Some(Sign::Positive)
        } else if value < -bound {
            Some(Sign::Negative)
        } else if self.magnitude == 0.0 {
            Some(Sign::Zero)
        } else {
            None
        }
    }
}

impl<T: Number> Add for Bounded<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Bounded {
            value: self.value + other.value,
            magnitude: self.magnitude + other.magnitude,
            roundings: self.roundings.max(other.roundings) + 1,
        }
    }
}

impl<T: Number> Sub for Bounded<T> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Bounded {
            value: self.value - other.value,
            magnitude: self.magnitude + other.magnitude,
            roundings: self.roundings.max(other.roundings) + 1,
        }
    }
}

impl<T: Number> Mul for Bounded<T> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Bounded {
            value: self.value * other.value,
            magnitude: self.magnitude * other.magnitude,
            roundings: self.roundings + other.roundings + 1,
        }
    }
}
