//! Positions in plan.

use std::cmp::Ordering;

use crate::triangulation::num::unsigned_zero;

pub(super) fn flat([x, y, _]: [f64; 3]) -> [f64; 2] {
    [x, y]
}

/// The middle of a segment.
pub(super) fn middle([a, b]: &[[f64; 3]; 2]) -> [f64; 2] {
    [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0]
}

pub(super) fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

pub(super) fn by_site(p: [f64; 2], q: [f64; 2]) -> Ordering {
    p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1]))
}

/// A position, compared bit by bit.
pub(super) type Key = [u64; 2];

pub(super) fn key(at: [f64; 2]) -> Key {
    at.map(|c| unsigned_zero(c).to_bits())
}
