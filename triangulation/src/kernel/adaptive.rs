use super::{Filter, Predicate, RANGE, Range};
use crate::num::{self, Bounded, Sign, lattice};

/// Floating point with an error bound that is computed along with the value: the semi-static
/// filter. If there is a [widest](Predicate::widest) predicate, the bound of that one is tried
/// first.
#[derive(Debug, Clone, Copy, Default)]
pub struct ErrorBound;

impl Filter for ErrorBound {
    const RANGE: Range = RANGE;

    /// The magnitudes of the widest predicate are sums and products of larger numbers, in the same
    /// order: rounded alike, none is smaller. So a sign that is certain by them is certain.
    #[inline(always)]
    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        let Some(widest) = predicate.widest() else {
            return predicate.value(Bounded::difference).sign();
        };
        let value = predicate.value(|a, b| a - b);
        let error = widest.value(Bounded::difference).error();
        if value > error {
            Some(Sign::Positive)
        } else if value < -error {
            Some(Sign::Negative)
        } else {
            bounded_by_terms(predicate.clone())
        }
    }
}

/// Kept out of line, and given a copy, like what comes after a filter.
#[cold]
#[inline(never)]
fn bounded_by_terms<P: Predicate>(predicate: P) -> Option<Sign> {
    predicate.value(Bounded::difference).sign()
}

/// Like [`ErrorBound`], but for every finite coordinate: it gives up on zeros, and where
/// differences are so small that products might underflow.
#[derive(Debug, Clone, Copy, Default)]
pub struct FlooredErrorBound;

impl Filter for FlooredErrorBound {
    const RANGE: Range = Range::FINITE;

    #[inline(always)]
    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        predicate.value(Bounded::floored_difference).sign()
    }
}

/// Like [`ErrorBound`], but with twice the digits ([`num::Pair`], double-word arithmetic after
/// Joldes, Muller and Popescu 2017): certain where three points are nearly collinear or four nearly
/// cocircular, but not where they are exactly so.
#[derive(Debug, Clone, Copy, Default)]
pub struct PairBound;

impl Filter for PairBound {
    const RANGE: Range = RANGE;

    #[inline(never)] // long, and no faster where it is called
    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        predicate.value(Bounded::exact_difference).sign()
    }
}

/// Intervals that are rounded outward: the dynamic filter of CGAL's kernels (Brönnimann, Burnikel
/// and Pion 2001).
#[derive(Debug, Clone, Copy, Default)]
pub struct IntervalBound;

impl Filter for IntervalBound {
    const RANGE: Range = RANGE;

    // Too long to be inlined at every call in a triangulation.
    #[inline(never)]
    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        predicate.value(num::Interval::difference).sign()
    }
}

/// Floating point with an error bound that is a constant of each formula: the static filter. For
/// whole numbers of magnitude up to `2^BITS`. [`num::Fixed`] derives the constants.
#[derive(Debug, Clone, Copy, Default)]
pub struct FixedBound<const BITS: i32>;

impl<const BITS: i32> Filter for FixedBound<BITS> {
    const RANGE: Range = Range {
        max: f64::from_bits((1023 + BITS as u64) << 52),
        ..WholeNumbers::RANGE
    };

    #[inline(always)]
    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        predicate.value(num::Fixed::<BITS>::difference).sign()
    }
}

/// Returns the number of bits that differences may have so that integers of `of_integers` bits hold
/// the polynomial.
///
/// A polynomial of degree `d` in differences below `2^b` is below `2^(b d + 7)` for every formula
/// of this crate: none has more than 96 terms, those of [`PowerTest3`](super::PowerTest3) (four
/// volumes of six terms, each times a lift of four). `most` is the limit of the conversion from
/// coordinates to differences.
const fn bits(of_integers: i32, degree: i32, most: i32) -> i32 {
    let bits = (of_integers - 8) / degree;
    if bits < most { bits } else { most }
}

/// Like [`bits`], for integers of 128 bits, where a difference must fit a double.
const fn coarse_bits(degree: i32) -> i32 {
    bits(128, degree, 53)
}

/// Integers of 128 bits, where the coordinates of the predicate at hand lie on a coarse enough
/// common grid.
#[derive(Debug, Clone, Copy, Default)]
pub struct OnLattice;

impl Filter for OnLattice {
    const RANGE: Range = Range::FINITE;

    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        let axes = (0..P::AXES).map(|axis| predicate.axis(axis));
        let inverse_unit = lattice::inverse_unit(axes, coarse_bits(P::DEGREE))?;
        Some(Sign::of(
            &predicate.value(|a, b| lattice::difference(a, b, inverse_unit)),
        ))
    }
}

/// Integers of 256 bits, where the coordinates of the predicate at hand, counted in a common unit,
/// and their differences have up to 62 bits: in the plane, any coordinates of about one size. In an
/// in-sphere test, with weights or without, the limit is 49 bits.
#[derive(Debug, Clone, Copy, Default)]
pub struct OnFineLattice;

impl Filter for OnFineLattice {
    const RANGE: Range = Range::FINITE;

    #[inline(never)] // long, and no faster where it is called
    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        // With zero among them, the limit holds for the coordinates, too, not only for their
        // differences.
        let axes = (0..P::AXES).map(|axis| predicate.axis(axis).chain([0.0]));
        let inverse_unit = lattice::inverse_unit(axes, bits(256, P::DEGREE, 62))?;
        Some(
            predicate
                .value(|a, b| lattice::long_difference(a, b, inverse_unit))
                .sign(),
        )
    }
}

/// Integers of 128 bits, for coordinates that are whole numbers: [`OnLattice`] with a unit of 1.
/// The differences in an in-circle or in-sphere test may be up to `2^30` and `2^24`.
#[derive(Debug, Clone, Copy, Default)]
pub struct WholeNumbers;

impl Filter for WholeNumbers {
    /// Of the numbers below `2^52`, only multiples of 1 are admitted.
    const RANGE: Range = Range {
        min: 1.0 / f64::EPSILON,
        max: 2.0 / f64::EPSILON,
    };

    #[inline]
    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        let axes = (0..P::AXES).map(|axis| predicate.axis(axis));
        let fit = lattice::fit(axes, 1.0, coarse_bits(P::DEGREE));
        fit.then(|| Sign::of(&predicate.value(|a, b| lattice::difference(a, b, 1.0))))
    }
}
