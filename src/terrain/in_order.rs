//! The order of positions, and of what consists of them.

use std::cmp::Ordering;

/// Compares values that hold no NaN, such as positions; where one does, they may be equal.
#[inline]
pub(super) fn in_order<T: PartialOrd + ?Sized>(a: &T, b: &T) -> Ordering {
    a.partial_cmp(b).unwrap_or(Ordering::Equal)
}
