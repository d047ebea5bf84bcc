use std::ops::{Add, Mul, Sub};

use super::Sign;

/// A whole number of 256 bits, wrapping around beyond `-2^255 .. 2^255`.
///
/// For polynomials that are known in advance to fit, see [`lattice`](super::lattice): no branches,
/// no allocation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Integer {
    /// Two's complement, the lowest limb first.
    limbs: [u64; 4],
}

impl Integer {
    /// Returns the sign.
    #[inline]
    pub fn sign(self) -> Sign {
        if self.limbs[3] >> 63 == 1 {
            Sign::Negative
        } else if self.limbs == [0; 4] {
            Sign::Zero
        } else {
            Sign::Positive
        }
    }

    /// Returns the same number.
    #[inline]
    pub(crate) fn of(x: i128) -> Self {
        let sign = (x >> 127) as u64;
        Integer {
            limbs: [x as u64, (x >> 64) as u64, sign, sign],
        }
    }

    /// Returns the sum with another number, given limb by limb, and a carry.
    #[inline]
    fn plus(self, limb: impl Fn(usize) -> u64, mut carry: bool) -> Self {
        let limbs = std::array::from_fn(|i| {
            let (sum, over) = self.limbs[i].overflowing_add(limb(i));
            let (sum, over_again) = sum.overflowing_add(u64::from(carry));
            carry = over | over_again;
            sum
        });
        Integer { limbs }
    }
}

impl From<i64> for Integer {
    #[inline]
    fn from(x: i64) -> Self {
        let sign = (x >> 63) as u64;
        Integer {
            limbs: [x as u64, sign, sign, sign],
        }
    }
}

impl Add for Integer {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        self.plus(|i| other.limbs[i], false)
    }
}

impl Sub for Integer {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        // The negative is one more than all bits inverted.
        self.plus(|i| !other.limbs[i], true)
    }
}

impl Mul for Integer {
    type Output = Self;

    /// Modulo `2^256`, the product is the same for signed and unsigned numbers.
    #[inline]
    fn mul(self, other: Self) -> Self {
        let mut limbs = [0; 4];
        for i in 0..4 {
            let mut carry = 0;
            for j in 0..4 - i {
                let product = u128::from(self.limbs[i]) * u128::from(other.limbs[j]);
                // Below 2^128: (2^64 - 1)^2 + 2 (2^64 - 1).
                let sum = product + u128::from(limbs[i + j]) + u128::from(carry);
                limbs[i + j] = sum as u64;
                carry = (sum >> 64) as u64;
            }
        }
        Integer { limbs }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As long as 128 bits suffice, they are the reference; beyond, the laws of arithmetic are.
    #[test]
    fn arithmetic_is_that_of_whole_numbers() {
        let numbers = [
            0,
            1,
            -1,
            3,
            -7,
            1 << 31,
            -(1 << 40),
            i64::MAX,
            i64::MIN,
            0x1234_5678_9ABC_DEF0,
        ];
        for a in numbers {
            for b in numbers {
                let [x, y] = [a, b].map(Integer::from);
                let [wide_a, wide_b] = [a, b].map(i128::from);
                assert_eq!(Integer::of(wide_a * wide_b), x * y, "{a} {b}");
                assert_eq!((x + y).sign(), Sign::of(&(wide_a + wide_b)), "{a} + {b}");
                assert_eq!((x - y).sign(), Sign::of(&(wide_a - wide_b)), "{a} - {b}");
                assert_eq!((x * y).sign(), Sign::of(&(wide_a * wide_b)), "{a} {b}");
                assert_eq!((x + y) * (x - y), x * x - y * y, "{a} {b}");
                assert_eq!(
                    ((x * y) * y - (x * y) * y + Integer::from(1)).sign(),
                    Sign::Positive,
                    "{a} {b}"
                );
                for c in numbers {
                    let z = Integer::from(c);
                    // Products of three have up to 189 bits.
                    let expected = (a.signum() * b.signum() * c.signum()).cmp(&0);
                    assert_eq!((x * y * z).sign() as i8, expected as i8, "{a} {b} {c}");
                    assert_eq!((x + y) * z, z * x + y * z, "{a} {b} {c}");
                }
            }
        }
        let big = Integer::from(1 << 62);
        let bigger = big * big * big * big;
        assert_eq!(bigger.limbs, [0, 0, 0, 1 << 56]);
        assert_eq!(
            (bigger - bigger * big).sign(),
            Sign::Positive,
            "it wraps around"
        );
    }
}
