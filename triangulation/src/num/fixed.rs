use std::ops::{Add, Mul, Sub};

use super::Sign;

/// A floating-point result computed from whole numbers of magnitude up to `2^BITS`, with an error
/// bound that is known in advance. `BITS` is at most 52.
///
/// Besides the value it carries two numbers that depend on the formula only: the largest magnitude
/// `M` that the value can have, and the largest error `E`. The optimizer sees constants, and what
/// is left at run time is plain floating point and one comparison (the *static filter* of Fortune
/// and Van Wyk 1996, without their compiler). Let `u` be `2^-53`:
///
/// | | `M` | `E` |
/// |---|---|---|
/// | `a - b` of coordinates | `2^(BITS + 1)` | 0: a whole number of at most 53 bits |
/// | `x ± y` | `Mx + My` | `Ex + Ey`, and the rounding |
/// | `x y` | `Mx My` | `Mx Ey + My Ex + Ex Ey`, and the rounding |
///
/// `M` is computed in floating point, too: rounding is monotone, so no computed value exceeds it. A
/// result is rounded by at most `u M`. Where `M <= 2^53` it is not rounded at all, because all
/// values are whole numbers, rounded ones included.
///
/// With 24 bits, an orientation in the plane is always certain. An in-circle test is certain if the
/// determinant, a sum of products of up to `2^102`, is above `2^53`.
#[derive(Debug, Clone, Copy)]
pub struct Fixed<const BITS: i32> {
    value: f64,
    magnitude: f64,
    error: f64,
}

/// The magnitude up to which all whole numbers are doubles.
const WHOLE: f64 = (1u64 << f64::MANTISSA_DIGITS) as f64;

/// Returns the largest error of a rounding to a whole number of at most this magnitude.
#[inline(always)]
fn rounding(magnitude: f64) -> f64 {
    if magnitude <= WHOLE {
        0.0
    } else {
        magnitude / WHOLE
    }
}

impl<const BITS: i32> Fixed<BITS> {
    /// Returns `a - b`, exactly.
    #[inline(always)]
    pub fn difference(a: f64, b: f64) -> Self {
        const {
            assert!(
                0 <= BITS && BITS <= 52,
                "differences have one bit more, and 53 is all there are"
            )
        };
        Fixed {
            value: a - b,
            magnitude: f64::from_bits((1023 + 1 + BITS as u64) << 52),
            error: 0.0,
        }
    }

    /// Returns the sign, or `None` if the error may have changed it.
    ///
    /// The bound was computed in fewer than 2^10 operations, each of which rounded it by `2^-53`: a
    /// margin of 2 % is ample.
    #[inline(always)]
    pub fn sign(self) -> Option<Sign> {
        let bound = 1.02 * self.error;
        if self.value > bound {
            Some(Sign::Positive)
        } else if self.value < -bound {
            Some(Sign::Negative)
        } else if bound == 0.0 {
            Some(Sign::Zero)
        } else {
            None
        }
    }
}

impl<const BITS: i32> Add for Fixed<BITS> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let magnitude = self.magnitude + other.magnitude;
        let error = self.error + other.error + rounding(magnitude);
        Fixed {
            value: self.value + other.value,
            magnitude,
            error,
        }
    }
}

impl<const BITS: i32> Sub for Fixed<BITS> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + Fixed {
            value: -other.value,
            ..other
        }
    }
}

impl<const BITS: i32> Mul for Fixed<BITS> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let magnitude = self.magnitude * other.magnitude;
        let inherited =
            self.magnitude * other.error + other.magnitude * self.error + self.error * other.error;
        Fixed {
            value: self.value * other.value,
            magnitude,
            error: inherited + rounding(magnitude),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Dyadic;

    /// Sums of products of two, three and four differences of numbers of the largest magnitude.
    #[test]
    fn errors_are_within_the_bound() {
        let mut state = 1u64;
        let mut coordinate = |bits: i32| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let below = (state >> (63 - bits)) as f64;
            2f64.powi(bits)
                - if state.count_ones().is_multiple_of(2) {
                    below
                } else {
                    (below / 2f64.powi(bits - 3)).floor()
                }
        };
        fn polynomial<T: crate::num::Number>(of: impl Fn(f64, f64) -> T, c: [f64; 8]) -> [T; 3] {
            let [p, q, r, s] = [
                of(c[0], c[1]),
                of(c[2], c[3]),
                of(c[4], c[5]),
                of(c[6], c[7]),
            ];
            let two = p.clone() * q.clone() - r.clone() * s.clone();
            let three = two.clone() * r + p.clone() * q.clone() * s;
            [
                two.clone(),
                three.clone(),
                three * p - two.clone() * (two + q.clone() * q),
            ]
        }
        fn check<const BITS: i32>(c: [f64; 8]) -> usize {
            let (fixed, exact) = (
                polynomial(Fixed::<BITS>::difference, c),
                polynomial(Dyadic::difference, c),
            );
            fixed
                .into_iter()
                .zip(exact)
                .filter(|(fixed, exact)| {
                    let error = (Dyadic::from(fixed.value) - exact.clone()).estimate().abs();
                    assert!(
                        error <= fixed.error && fixed.value.abs() <= fixed.magnitude,
                        "{fixed:?} {c:?}: {error:e}"
                    );
                    assert!(fixed.sign().is_none_or(|sign| sign == exact.sign()));
                    error > 0.0
                })
                .count()
        }
        let mut wrong = 0;
        for _ in 0..10_000 {
            wrong += check::<24>([(); 8].map(|()| coordinate(24)));
            wrong += check::<31>([(); 8].map(|()| coordinate(31)));
            wrong += check::<52>([(); 8].map(|()| coordinate(52)));
        }
        assert!(wrong > 10_000, "{wrong}");
    }
}
