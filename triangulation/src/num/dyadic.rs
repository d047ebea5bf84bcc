use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

use super::Sign;

/// An exact number `± mantissa * 2^exponent` with a mantissa of any length.
///
/// Closed under `+`, `-` and `*`: evaluating a polynomial cannot overflow, underflow or round. It
/// is the reference in tests, and the fallback where magnitudes leave the range of the faster
/// numbers.
#[derive(Debug, Clone)]
pub struct Dyadic {
    negative: bool,
    /// The least significant limb first, without leading zero limbs; empty for zero.
    limbs: Vec<u64>,
    exponent: i64,
}

impl Dyadic {
    /// Returns `a - b`, exactly.
    pub fn difference(a: f64, b: f64) -> Self {
        Self::from(a) - Self::from(b)
    }

    /// Returns the sign.
    pub fn sign(&self) -> Sign {
        match (self.limbs.is_empty(), self.negative) {
            (true, _) => Sign::Zero,
            (false, true) => Sign::Negative,
            (false, false) => Sign::Positive,
        }
    }

    /// Returns the number rounded to a double, to within a unit in the last place; infinite or zero
    /// beyond the range of doubles.
    pub fn estimate(&self) -> f64 {
        let (leading, exponent) = self.leading();
        scaled(leading, exponent)
    }

    /// Returns the quotient of two numbers, rounded to within two units in the last place.
    pub fn quotient(&self, divisor: &Self) -> f64 {
        let ((leading, exponent), (by, by_exponent)) = (self.leading(), divisor.leading());
        scaled(leading / by, exponent - by_exponent)
    }

    /// Returns the leading digits as a double of magnitude at most `2^128`, and the exponent of the
    /// power of two to multiply it with.
    fn leading(&self) -> (f64, i64) {
        let Some((&high, lower)) = self.limbs.split_last() else {
            return (0.0, 0);
        };
        let (magnitude, below) = match lower.split_last() {
            Some((&low, below)) => (
                (u128::from(high) << 64 | u128::from(low)) as f64,
                below.len(),
            ),
            None => (high as f64, 0),
        };
        (
            if self.negative { -magnitude } else { magnitude },
            self.exponent + 64 * below as i64,
        )
    }

    /// Returns the mantissa counted in units of `2^exponent`, for an exponent that is at most its
    /// own.
    fn limbs_at(&self, exponent: i64) -> Vec<u64> {
        let shift = (self.exponent - exponent) as u64;
        let (words, bits) = ((shift / 64) as usize, shift % 64);
        let mut limbs = vec![0; words];
        if bits == 0 {
            limbs.extend_from_slice(&self.limbs);
        } else {
            let mut carry = 0;
            for &limb in &self.limbs {
                limbs.push(limb << bits | carry);
                carry = limb >> (64 - bits);
            }
            limbs.push(carry);
        }
        limbs
    }

    fn trimmed(negative: bool, mut limbs: Vec<u64>, exponent: i64) -> Self {
        while limbs.last() == Some(&0) {
            limbs.pop();
        }
        Dyadic {
            negative,
            limbs,
            exponent,
        }
    }

    fn plus(self, other: &Self, other_negative: bool) -> Self {
        if other.limbs.is_empty() {
            return self;
        }
        if self.limbs.is_empty() {
            return Dyadic {
                negative: other_negative,
                ..other.clone()
            };
        }
        let exponent = self.exponent.min(other.exponent);
        let (a, b) = (self.limbs_at(exponent), other.limbs_at(exponent));
        if self.negative == other_negative {
            return Self::trimmed(self.negative, add(&a, &b), exponent);
        }
        match compare(&a, &b) {
            Ordering::Less => Self::trimmed(other_negative, subtract(&b, &a), exponent),
            _ => Self::trimmed(self.negative, subtract(&a, &b), exponent),
        }
    }
}

/// Returns `x * 2^exponent`, multiplied in steps that neither overflow nor underflow before the
/// product does.
fn scaled(mut x: f64, exponent: i64) -> f64 {
    let mut left = exponent.clamp(-4000, 4000) as i32;
    while left != 0 {
        let step = left.clamp(-900, 900);
        x *= 2f64.powi(step);
        left -= step;
    }
    x
}

fn limb(limbs: &[u64], i: usize) -> u64 {
    limbs.get(i).copied().unwrap_or(0)
}

fn compare(a: &[u64], b: &[u64]) -> Ordering {
    let length = a.len().max(b.len());
    (0..length)
        .rev()
        .map(|i| limb(a, i).cmp(&limb(b, i)))
        .find(|o| o.is_ne())
        .unwrap_or(Ordering::Equal)
}

fn add(a: &[u64], b: &[u64]) -> Vec<u64> {
    let mut carry = 0u128;
    (0..=a.len().max(b.len()))
        .map(|i| {
            carry += u128::from(limb(a, i)) + u128::from(limb(b, i));
            let low = carry as u64;
            carry >>= 64;
            low
        })
        .collect()
}

/// Returns `a - b`, for `a >= b`.
fn subtract(a: &[u64], b: &[u64]) -> Vec<u64> {
    let mut borrow = false;
    (0..a.len().max(b.len()))
        .map(|i| {
            let (d, under) = limb(a, i).overflowing_sub(limb(b, i));
            let (d, under_again) = d.overflowing_sub(u64::from(borrow));
            borrow = under || under_again;
            d
        })
        .collect()
}

impl From<f64> for Dyadic {
    /// # Panics
    /// If `x` is NaN or infinite; no geometry admits such coordinates.
    fn from(x: f64) -> Self {
        assert!(x.is_finite(), "{x} is not a real number");
        let bits = x.to_bits();
        let biased = ((bits >> 52) & 0x7ff) as i64;
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, exponent) = if biased == 0 {
            (fraction, -1074)
        } else {
            (fraction | 1 << 52, biased - 1075)
        };
        Self::trimmed(x < 0.0, vec![mantissa], exponent)
    }
}

impl Add for Dyadic {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.plus(&other, other.negative)
    }
}

impl Sub for Dyadic {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.plus(&other, !other.negative)
    }
}

impl Mul for Dyadic {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let mut limbs = vec![0u64; self.limbs.len() + other.limbs.len()];
        for (i, &a) in self.limbs.iter().enumerate() {
            let mut carry = 0u128;
            for (j, &b) in other.limbs.iter().enumerate() {
                carry += u128::from(a) * u128::from(b) + u128::from(limbs[i + j]);
                limbs[i + j] = carry as u64;
                carry >>= 64;
            }
            limbs[i + other.limbs.len()] = carry as u64;
        }
        Self::trimmed(
            self.negative != other.negative,
            limbs,
            self.exponent + other.exponent,
        )
    }
}
