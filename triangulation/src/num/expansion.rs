use std::ops::{Add, Mul, Sub};

use super::Sign;

/// An exact number as a sum of doubles that do not overlap, smallest first.
///
/// After Shewchuk, *Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
/// Predicates* (1997). Exact as long as no product of components underflows or overflows, which
/// [`RANGE`](crate::kernel::RANGE) guarantees for the predicates of this crate.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// In increasing magnitude, without zeros; empty for zero.
    components: Vec<f64>,
}

/// Returns the rounded sum `a + b` and its error (Knuth).
#[inline(always)]
pub(super) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    let a_part = sum - b_part;
    (sum, (a - a_part) + (b - b_part))
}

/// Returns the rounded product `a * b` and its error.
///
/// With Dekker's splitting: portable builds have no fused multiply-add, and its emulation is slow.
#[inline(always)]
pub(super) fn two_product(a: f64, b: f64) -> (f64, f64) {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let split = |x: f64| {
        let c = SPLITTER * x;
        let high = c - (c - x);
        (high, x - high)
    };
    let product = a * b;
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    let error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (product, error)
}

impl Expansion {
    /// Returns `a - b`, exactly.
    pub fn difference(a: f64, b: f64) -> Self {
        let (value, error) = two_sum(a, -b);
        let mut components = Vec::with_capacity(2);
        components.extend([error, value].into_iter().filter(|c| *c != 0.0));
        Expansion { components }
    }

    /// Returns the sign: that of the largest component.
    pub fn sign(&self) -> Sign {
        self.components.last().map_or(Sign::Zero, Sign::of)
    }

    /// Returns the number rounded to a double, to within a unit in the last place.
    pub fn estimate(&self) -> f64 {
        self.components.iter().sum()
    }

    /// Returns `self + factor * other`, for a factor of 1 or -1: merges by magnitude and sums with
    /// carry (`FAST-EXPANSION-SUM` with zero elimination).
    fn sum(&self, other: &Self, factor: f64) -> Self {
        let (a, b) = (&self.components, &other.components);
        if a.is_empty() || b.is_empty() {
            let components = a
                .iter()
                .copied()
                .chain(b.iter().map(|c| c * factor))
                .collect();
            return Expansion { components };
        }
        let mut components = Vec::with_capacity(a.len() + b.len());
        let (mut i, mut j) = (0, 0);
        let mut next = || {
            if j == b.len() || (i < a.len() && a[i].abs() < b[j].abs()) {
                i += 1;
                a[i - 1]
            } else {
                j += 1;
                b[j - 1] * factor
            }
        };
        let mut carry = next();
        for _ in 1..a.len() + b.len() {
            let (sum, error) = two_sum(carry, next());
            if error != 0.0 {
                components.push(error);
            }
            carry = sum;
        }
        if carry != 0.0 {
            components.push(carry);
        }
        Expansion { components }
    }

    /// Returns `self * factor` (`SCALE-EXPANSION` with zero elimination).
    fn scaled(&self, factor: f64) -> Self {
        let mut components = Vec::with_capacity(2 * self.components.len());
        let mut carry = 0.0;
        let mut keep = |c: f64| {
            if c != 0.0 {
                components.push(c);
            }
        };
        for &component in &self.components {
            let (product, product_error) = two_product(component, factor);
            let (sum, sum_error) = two_sum(carry, product_error);
            keep(sum_error);
            let (total, total_error) = two_sum(product, sum);
            keep(total_error);
            carry = total;
        }
        keep(carry);
        Expansion { components }
    }
}

impl Add for Expansion {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.sum(&other, 1.0)
    }
}

impl Sub for Expansion {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.sum(&other, -1.0)
    }
}

impl Mul for Expansion {
    type Output = Self;

    /// Multiplies one operand by each component of the other. The products are summed as a balanced
    /// tree, so that no partial sum is merged more than logarithmically often.
    fn mul(self, other: Self) -> Self {
        let (long, short) = if self.components.len() >= other.components.len() {
            (&self, &other)
        } else {
            (&other, &self)
        };
        fn tree(long: &Expansion, factors: &[f64]) -> Expansion {
            match factors {
                [] => Expansion {
                    components: Vec::new(),
                },
                [one] => long.scaled(*one),
                many => {
                    let (left, right) = many.split_at(many.len() / 2);
                    tree(long, left).sum(&tree(long, right), 1.0)
                }
            }
        }
        tree(long, &short.components)
    }
}
