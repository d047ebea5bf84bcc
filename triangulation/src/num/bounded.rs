use std::ops::{Add, Mul, Sub};

use super::{Number, Pair, Sign};

/// A floating-point result that knows how wrong it may be: a double, or a [`Pair`] of doubles.
///
/// Beside the value it carries its *magnitude*: the same formula with every term made positive. If
/// every term of a polynomial passed through at most `k` roundings, value and truth differ by at
/// most `((1 + u)^k - 1) * magnitude`, where `u = 2^-53` (Shewchuk 1997, section 4.1; Higham 2002,
/// lemma 3.1). `k` depends on the formula only, so that the optimizer sees a constant. For pairs, `u = 2^-101`.
///
/// *Overflow* reaches the magnitude, which is never below the value: it becomes infinite or not a number, and the
/// sign unknown. *Underflow* is not accounted for, unless differences are [floored](Self::floored_difference):
/// coordinates must keep to [`RANGE`](crate::kernel::RANGE), where there is none.
#[derive(Debug, Clone, Copy)]
pub struct Bounded<T = f64> {
    value: T,
    magnitude: f64,
    roundings: u32,
}

/// A number whose operations are rounded.
trait Rounded: Copy {
    /// The most that one operation changes the result by, relative to it.
    const UNIT: f64;

    /// The double nearest to it, which has its sign.
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

/// The least magnitude of a floored difference.
const FLOOR: f64 = f64::from_bits((1023 - 160) << 52);

/// One instruction; `f64::max` takes five, for NaN.
#[inline(always)]
fn floored(size: f64) -> f64 {
    if size > FLOOR { size } else { FLOOR }
}

impl Bounded {
    /// `a - b`, rounded once.
    #[inline(always)]
    pub fn difference(a: f64, b: f64) -> Self {
        let value = a - b;
        Bounded { value, magnitude: value.abs(), roundings: 1 }
    }

    /// `a - b`, rounded once, whose magnitude is `2^-160` at least: sound for all finite coordinates, in products of
    /// up to five differences.
    ///
    /// The magnitude of a product is then `2^-800` at least, and what its rounding to a multiple of `2^-1074` adds
    /// where it underflows is less than any other rounding may add. Sums do not underflow. The price: no zero is
    /// certain, and no sign where differences are that small.
    #[inline(always)]
    pub fn floored_difference(a: f64, b: f64) -> Self {
        let value = a - b;
        Bounded { value, magnitude: floored(value.abs()), roundings: 1 }
    }

    /// The result.
    #[inline(always)]
    pub fn value(self) -> f64 {
        self.value
    }
}

impl Bounded<Pair> {
    /// `a - b`, exactly, with a floored magnitude: sound in the [range](crate::kernel::RANGE) of expansions.
    ///
    /// There the parts of the difference are exact, and nothing overflows. What is rounded has more digits below the
    /// last place of the coordinates; where a product of them underflows, it is off by a multiple of `2^-1074` less than
    /// a rounding of the floored magnitude, `2^-101` of `2^-800`, allows.
    #[inline(always)]
    pub fn exact_difference(a: f64, b: f64) -> Self {
        let value = Pair::difference(a, b);
        Bounded { value, magnitude: floored(value.estimate().abs()), roundings: 0 }
    }
}

#[expect(private_bounds, reason = "implemented for two types, which are public")]
impl<T: Rounded> Bounded<T> {
    /// How wrong the result may be at most.
    ///
    /// The computed magnitude passes through the same `k` roundings, so that the true one is no larger than it
    /// divided by `(1 - u)^k`, and the error is at most `((1 + u)^k - 1) / (1 - u)^k < k u (1 + 2 k u)` times
    /// the computed one, for `k < 2^40`. The bound is rounded three times more on its way. A fiftieth on
    /// top is ample for all that while `k` is not in the millions.
    #[inline(always)]
    pub fn error(self) -> f64 {
        f64::from(self.roundings) * (1.02 * T::UNIT) * self.magnitude
    }

    /// The sign, if the error cannot have changed it.
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
