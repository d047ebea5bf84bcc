use super::{Filter, Predicate, RANGE, Range};
use crate::num::{Bounded, Sign, lattice};

/// Floating point with an error bound that is computed along: the semi-static filter.
#[derive(Debug, Clone, Copy, Default)]
pub struct ErrorBound;

impl Filter for ErrorBound {
    const RANGE: Range = RANGE;

    #[inline(always)]
    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        predicate.value(Bounded::difference).sign()
    }
}

/// [`ErrorBound`] for every finite coordinate: it gives up where differences are so small that products might
/// underflow, and on zeros.
#[derive(Debug, Clone, Copy, Default)]
pub struct FlooredErrorBound;

impl Filter for FlooredErrorBound {
    const RANGE: Range = Range::FINITE;

    #[inline(always)]
    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        predicate.value(Bounded::floored_difference).sign()
    }
}

/// Integers, where the coordinates of this one question lie on a coarse enough common grid.
#[derive(Debug, Clone, Copy, Default)]
pub struct OnLattice;

impl Filter for OnLattice {
    const RANGE: Range = Range::FINITE;

    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        // A polynomial of degree d in differences below 2^b is below 2^(b d + 7) for every formula
        // of this crate (in-sphere has 4 * 3 * 6 terms), and a difference must fit a double.
        let bits = (120 / P::DEGREE).min(53);
        let inverse_unit = lattice::inverse_unit((0..P::AXES).map(|axis| predicate.axis(axis)), bits)?;
        let value = predicate.value(|a, b| lattice::difference(a, b, inverse_unit));
        Some(Sign::of(&value))
    }
}
