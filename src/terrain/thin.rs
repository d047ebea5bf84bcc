//! Faces that are thinner than rounding.

use crate::data::{higher, lowest_and_highest};

/// How many steps of its coordinates a face is wide at least, unless it is thin: more than the
/// errors of two positions that are computed on its edges, and of [`is_thin`].
pub(super) const STEPS: f64 = 32.0;

/// Returns true if a share of a face may be narrower than some steps of its coordinates.
#[inline]
pub(super) fn is_thin([a, b, c]: [[f64; 3]; 3], share: f64) -> bool {
    let axis = |axis: usize| [a[axis], b[axis], c[axis]];
    let range = |coordinates: [f64; 3]| {
        let [low, high] = lowest_and_highest(coordinates);
        high - low
    };
    let size = |[a, b, c]: [f64; 3]| higher(higher(a.abs(), b.abs()), c.abs());
    let twice_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    let length = range(axis(0)) + range(axis(1));
    let step = f64::EPSILON * higher(size(axis(0)), size(axis(1)));
    twice_area.abs() * share < STEPS * step * length
}
