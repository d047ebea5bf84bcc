//! Boxes around parts of waters, and how far rounding may move heights.

use crate::terrain::boxes::{Boxed, Extent};

/// The box around something that overlaps something else.
#[derive(Debug, Clone, Copy)]
pub(super) struct Zone(pub(super) Extent);

impl Boxed for Zone {
    fn extent(&self) -> Extent {
        self.0
    }
}

/// How many units in the last place of the largest coordinate and height rounding may change the
/// difference of two heights.
const ROUNDING: f64 = 64.0;

pub(super) fn tolerance_of(vertices: impl Iterator<Item = [f64; 3]>) -> f64 {
    let largest = vertices
        .flatten()
        .fold(0.0_f64, |most, c| most.max(c.abs()));
    ROUNDING * (largest.next_up() - largest)
}
