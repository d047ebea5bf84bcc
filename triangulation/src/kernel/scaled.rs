use std::marker::PhantomData;

use super::{Filter, Kernel, Predicate, Range};
use crate::num::{Number, Sign};

/// A kernel applied to all coordinates times a power of two, if that brings them into its range
/// without rounding. The sign does not change, since all terms of a predicate have the same degree.
#[derive(Debug, Clone, Copy, Default)]
pub struct Scaled<K>(PhantomData<K>);

impl<K: Kernel> Filter for Scaled<K> {
    const RANGE: Range = Range::FINITE;

    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        let mut coordinates = (0..P::AXES).flat_map(|axis| predicate.axis(axis));
        let largest = coordinates
            .clone()
            .fold(0.0, |largest: f64, x| largest.max(x.abs()));
        // The largest goes to the upper end of the range, so that as many as possible of the others
        // fit below.
        let factor = power_of_two(exponent(K::RANGE.max) - 1 - exponent(largest));
        // A normal number was not rounded.
        let fits = |x: f64| x == 0.0 || (x * factor).is_normal() && K::RANGE.admits(x * factor);
        coordinates
            .all(fits)
            .then(|| K::sign(&Times { predicate, factor }))
    }
}

/// Returns the exponent of a normal number.
fn exponent(x: f64) -> i64 {
    (x.to_bits() >> 52 & 0x7ff) as i64 - 1023
}

/// Returns `2^exponent`; exponents beyond ±1000 are clamped.
fn power_of_two(exponent: i64) -> f64 {
    f64::from_bits(((1023 + exponent.clamp(-1000, 1000)) as u64) << 52)
}

/// A predicate whose coordinates are multiplied by a factor.
#[derive(Clone)]
struct Times<'a, P> {
    predicate: &'a P,
    factor: f64,
}

impl<P: Predicate> Predicate for Times<'_, P> {
    const DEGREE: i32 = P::DEGREE;
    const AXES: usize = P::AXES;

    #[inline]
    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        let factor = self.factor;
        self.predicate.axis(axis).map(move |x| x * factor)
    }

    #[inline(always)]
    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let factor = self.factor;
        self.predicate
            .value(move |a, b| difference(a * factor, b * factor))
    }
}
