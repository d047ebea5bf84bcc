use std::collections::{BTreeMap, VecDeque};

use crate::tds::{CellId, VertexId};

/// A triangle that is to be destroyed, with its corners as they were: another one may have got its number since.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bad {
    pub(super) cell: CellId,
    pub(super) corners: [VertexId; 3],
    /// The square of its shortest edge.
    pub(super) shortest: f64,
}

/// Triangles by their shortest edges, the shortest first, up to a factor of the root of two; then in the order in which
/// they came. What is repaired on a small scale is not disturbed again from a larger one (Shewchuk 2002).
#[derive(Debug, Default)]
pub(super) struct Queue(BTreeMap<u16, VecDeque<Bad>>);

impl Queue {
    pub(super) fn push(&mut self, bad: Bad) {
        // The exponent, and the first bit behind the point.
        let scale = (bad.shortest.to_bits() >> 51) as u16;
        self.0.entry(scale).or_default().push_back(bad);
    }

    pub(super) fn pop(&mut self) -> Option<Bad> {
        let mut least = self.0.first_entry()?;
        let bad = least.get_mut().pop_front();
        if least.get().is_empty() {
            least.remove();
        }
        bad
    }
}
