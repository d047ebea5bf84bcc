//! The order of sites.

use std::cmp::Ordering;

/// Compares coordinates lexicographically.
#[inline(always)]
pub(super) fn lexicographic<const D: usize>(p: [f64; D], q: [f64; D]) -> Ordering {
    for axis in 0..D {
        if p[axis] != q[axis] {
            return if p[axis] < q[axis] {
                Ordering::Less
            } else {
                Ordering::Greater
            };
        }
    }
    Ordering::Equal
}
