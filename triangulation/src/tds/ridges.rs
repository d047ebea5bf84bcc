use super::{CellId, VertexId};

/// Finds which two facets of a border share a ridge (an edge in space), while its star is built: an
/// open hash table of ridges.
#[derive(Debug, Clone, Default)]
pub(super) struct Ridges {
    /// The ridge in each of `1 << bits` slots, 0 if it is free.
    keys: Vec<u64>,
    /// The facet that was met at the ridge, as its cell and the index of the ridge there; the cell
    /// is `NONE` once another has met it.
    waiting: Vec<(CellId, u8)>,
    bits: u32,
    /// A ridge was met by a third facet.
    is_pinched: bool,
}

impl Ridges {
    /// Empties the table, and makes room for that many facets at ridges. Each ridge has two.
    pub(super) fn clear(&mut self, facets_at_ridges: usize) {
        self.bits = facets_at_ridges.max(2).next_power_of_two().trailing_zeros();
        let slots = 1 << self.bits;
        if self.keys.len() < slots {
            self.keys.resize(slots, 0);
            self.waiting.resize(slots, (CellId::NONE, 0));
        }
        self.keys[..slots].fill(0);
        self.is_pinched = false;
    }

    /// Returns true if more than two facets have met at a ridge, so that only the cells between
    /// them tell which of them belong together.
    pub(super) fn is_pinched(&self) -> bool {
        self.is_pinched
    }

    /// Returns the facet that waits at a ridge, given by up to two vertices in any order. If none
    /// does, the given one waits there, unless it is the third.
    #[inline(always)]
    pub(super) fn meet(
        &mut self,
        [a, b]: [VertexId; 2],
        facet: (CellId, usize),
    ) -> Option<(CellId, usize)> {
        let [a, b] = [a, b].map(|vertex| u64::from(vertex.stored().get()));
        let key = if a < b { a << 32 | b } else { b << 32 | a };
        let last = (1 << self.bits) - 1;
        // The high bits of the product depend on all bits of the key.
        let hash = key.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut at = (hash >> (64 - self.bits)) as usize & last;
        while self.keys[at] != key {
            if self.keys[at] == 0 {
                self.keys[at] = key;
                self.waiting[at] = (facet.0, facet.1 as u8);
                return None;
            }
            at = (at + 1) & last;
        }
        let (cell, i) = self.waiting[at];
        self.waiting[at].0 = CellId::NONE;
        if cell == CellId::NONE {
            self.is_pinched = true;
            return None;
        }
        Some((cell, i as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facets_meet_two_by_two() {
        let mut ridges = Ridges::default();
        let facet = |k: usize| (CellId::new(k), k % 4);
        for count in [3, 40, 7] {
            let ends = |k: usize| [VertexId::new(k), VertexId::INFINITE];
            ridges.clear(2 * count);
            for round in 0..2 {
                for k in 0..count {
                    // In any order of the ends.
                    let [a, b] = ends(k);
                    let given = if round == 0 { [a, b] } else { [b, a] };
                    let met = ridges.meet(given, facet(2 * k + round));
                    assert_eq!(met, (round == 1).then_some(facet(2 * k)));
                }
            }
            assert!(!ridges.is_pinched());
            assert_eq!(ridges.meet(ends(1), facet(9)), None);
            assert!(ridges.is_pinched());
        }
    }
}
