//! The orders of positions, and of what consists of them.

use std::cmp::Ordering;

/// Compares values that hold no NaN, such as positions; where one does, they may be equal.
#[inline]
pub(super) fn in_order<T: PartialOrd + ?Sized>(a: &T, b: &T) -> Ordering {
    a.partial_cmp(b).unwrap_or(Ordering::Equal)
}

/// Compares positions by the first coordinates that differ, in their total order: -0.0 is before 0.
#[inline]
pub(super) fn by_coordinates<const N: usize>(a: &[f64; N], b: &[f64; N]) -> Ordering {
    let mut orders = a.iter().zip(b).map(|(a, b)| a.total_cmp(b));
    orders
        .find(|order| order.is_ne())
        .unwrap_or(Ordering::Equal)
}
