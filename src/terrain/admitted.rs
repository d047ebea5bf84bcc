//! Coordinates outside of the range of the arithmetic.

use crate::error::Error;
use crate::triangulation::kernel::{RANGE, Range};

/// The error for a point with a coordinate that is not finite, or too large or small.
#[cold]
pub(super) fn refused(p: [f64; 3]) -> Error {
    if p.iter().all(|x| x.is_finite()) {
        let Range { min, max } = RANGE;
        return Error::limit(format!(
            "{p:?} has a coordinate that is neither 0 nor between {min:.0e} and {max:.0e}"
        ));
    }
    Error::format(format!("{p:?} is not a finite point"))
}

/// Returns a position for a search: coordinates below the range of the arithmetic count as zero.
/// Those above it are beyond all vertices.
#[inline]
pub(super) fn searched(q: [f64; 2]) -> [f64; 2] {
    q.map(|c| {
        if c.abs() < RANGE.min && !RANGE.admits(c) {
            0.0
        } else {
            c
        }
    })
}
