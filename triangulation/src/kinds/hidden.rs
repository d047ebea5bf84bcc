//! The points of a regular triangulation that are in no cell.

use rustc_hash::FxHashMap;

use crate::tds::{CellId, VertexId};

/// Maps hidden points to the cells that hide them, cells to the points under them, and hashes of
/// points to hidden points.
///
/// An edit that destroys cells [takes](Self::take_under) what is under them. These points keep
/// their entries, and are then put under other cells, or removed as they become visible.
#[derive(Debug, Clone, Default)]
pub(super) struct Hidden {
    entries: FxHashMap<VertexId, Entry>,
    under: FxHashMap<CellId, Vec<VertexId>>,
    /// The hidden point of each hash that was put last.
    of_hash: FxHashMap<u64, VertexId>,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    /// The cell that hides the point.
    cell: CellId,
    /// The position of the point in the list of that cell.
    position: u32,
    /// The next hidden point of the same hash.
    next: Option<VertexId>,
}

impl Hidden {
    pub(super) fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    pub(super) fn contains(&self, vertex: VertexId) -> bool {
        self.entries.contains_key(&vertex)
    }

    /// Returns the cell that hides a point.
    pub(super) fn host(&self, vertex: VertexId) -> Option<CellId> {
        self.entries.get(&vertex).map(|entry| entry.cell)
    }

    /// Returns the points under a cell.
    pub(super) fn under(&self, cell: CellId) -> &[VertexId] {
        self.under.get(&cell).map_or(&[], Vec::as_slice)
    }

    /// Returns all points, in order of their numbers.
    pub(super) fn all(&self) -> Vec<VertexId> {
        let mut all: Vec<VertexId> = self.entries.keys().copied().collect();
        all.sort_unstable();
        all
    }

    /// Iterates over the hidden points of a hash.
    pub(super) fn of_hash(&self, hash: u64) -> impl Iterator<Item = VertexId> + '_ {
        std::iter::successors(self.of_hash.get(&hash).copied(), |vertex| {
            self.entries.get(vertex)?.next
        })
    }

    /// Puts a point under a cell. The hash is that of the point if it is to be found by it, and the
    /// same each time.
    pub(super) fn put(&mut self, vertex: VertexId, cell: CellId, hash: Option<u64>) {
        let under = self.under.entry(cell).or_default();
        let position = under.len() as u32;
        under.push(vertex);
        let of_hash = &mut self.of_hash;
        let entry = self.entries.entry(vertex).or_insert_with(|| {
            let next = hash.and_then(|hash| of_hash.insert(hash, vertex));
            Entry {
                cell,
                position,
                next,
            }
        });
        (entry.cell, entry.position) = (cell, position);
    }

    /// Removes a point from under its cell, and its entry; returns false if it was not there.
    pub(super) fn remove(&mut self, vertex: VertexId, hash: Option<u64>) -> bool {
        let Some(Entry { cell, position, .. }) = self.take_entry(vertex, hash) else {
            return false;
        };
        if let Some(under) = self.under.get_mut(&cell) {
            under.swap_remove(position as usize);
            match under.get(position as usize) {
                Some(moved) => {
                    if let Some(entry) = self.entries.get_mut(moved) {
                        entry.position = position;
                    }
                }
                None if under.is_empty() => _ = self.under.remove(&cell),
                None => {}
            }
        }
        true
    }

    /// Removes the entry of a point that was taken and is visible now.
    pub(super) fn forget(&mut self, vertex: VertexId, hash: Option<u64>) {
        self.take_entry(vertex, hash);
    }

    fn take_entry(&mut self, vertex: VertexId, hash: Option<u64>) -> Option<Entry> {
        let removed = self.entries.remove(&vertex)?;
        let Some(hash) = hash else {
            return Some(removed);
        };
        let before = self
            .of_hash(hash)
            .take_while(|&other| other != vertex)
            .last();
        match (before, removed.next) {
            (Some(before), next) => {
                if let Some(entry) = self.entries.get_mut(&before) {
                    entry.next = next;
                }
            }
            (None, Some(next)) => _ = self.of_hash.insert(hash, next),
            (None, None) => _ = self.of_hash.remove(&hash),
        }
        Some(removed)
    }

    /// Takes all points from under some cells, and returns them.
    pub(super) fn take_under(&mut self, cells: impl IntoIterator<Item = CellId>) -> Vec<VertexId> {
        if self.under.is_empty() {
            return Vec::new();
        }
        cells
            .into_iter()
            .filter_map(|cell| self.under.remove(&cell))
            .flatten()
            .collect()
    }

    /// Takes all points from under their cells, and returns them, in order of their numbers.
    pub(super) fn take_all(&mut self) -> Vec<VertexId> {
        let mut taken: Vec<VertexId> = self.under.drain().flat_map(|(_, under)| under).collect();
        taken.sort_unstable();
        taken
    }

    /// Returns the points whose entries disagree with the list of their cell, or that are not found
    /// by their hash.
    pub(super) fn flaws(&self, hash: impl Fn(VertexId) -> Option<u64>) -> Vec<VertexId> {
        let mut flaws: Vec<VertexId> = Vec::new();
        for (&cell, under) in &self.under {
            let agrees = |(position, vertex): &(usize, &VertexId)| {
                self.entries
                    .get(vertex)
                    .is_some_and(|entry| (entry.cell, entry.position as usize) == (cell, *position))
            };
            flaws.extend(
                under
                    .iter()
                    .enumerate()
                    .filter(|listed| !agrees(listed))
                    .map(|(_, &vertex)| vertex),
            );
        }
        let is_found = |&(&vertex, entry): &(&VertexId, &Entry)| {
            self.under(entry.cell).get(entry.position as usize) == Some(&vertex)
                && hash(vertex).is_none_or(|hash| self.of_hash(hash).any(|other| other == vertex))
        };
        flaws.extend(
            self.entries
                .iter()
                .filter(|entry| !is_found(entry))
                .map(|(&vertex, _)| vertex),
        );
        flaws.sort_unstable();
        flaws.dedup();
        flaws
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    fn hash(vertex: VertexId) -> Option<u64> {
        (vertex.index() % 3 != 2).then_some(vertex.index() as u64 / 8)
    }

    /// Beside a table that is searched.
    #[test]
    fn points_are_put_taken_and_removed() {
        let (mut hidden, mut expected) = (Hidden::default(), BTreeMap::new());
        let mut state = 1u64;
        let mut below = |limit: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % limit) as usize
        };
        for _ in 0..4000 {
            let (vertex, cell) = (VertexId::new(below(40)), CellId::new(below(5)));
            match below(8) {
                0 => {
                    let mut taken = hidden.take_under([cell, CellId::new(7)]);
                    taken.sort_unstable();
                    assert!(
                        taken.iter().eq(expected
                            .iter()
                            .filter(|&(_, &at)| at == cell)
                            .map(|(vertex, _)| vertex))
                    );
                    // One of them becomes visible, the others are put again.
                    for (k, &vertex) in taken.iter().enumerate() {
                        if k == 0 {
                            hidden.forget(vertex, hash(vertex));
                            expected.remove(&vertex);
                        } else {
                            hidden.put(vertex, CellId::new(k % 5), hash(vertex));
                            expected.insert(vertex, CellId::new(k % 5));
                        }
                    }
                }
                1..4 => assert_eq!(
                    hidden.remove(vertex, hash(vertex)),
                    expected.remove(&vertex).is_some()
                ),
                _ if !expected.contains_key(&vertex) => {
                    hidden.put(vertex, cell, hash(vertex));
                    expected.insert(vertex, cell);
                }
                _ => {}
            }
            assert_eq!(hidden.flaws(hash), []);
            assert!(hidden.all().iter().eq(expected.keys()));
            assert_eq!(hidden.host(vertex), expected.get(&vertex).copied());
            let mut of_hash: Vec<VertexId> = hidden.of_hash(vertex.index() as u64 / 8).collect();
            of_hash.sort_unstable();
            let alike = expected
                .keys()
                .filter(|&&other| hash(other) == Some(vertex.index() as u64 / 8));
            assert!(of_hash.iter().eq(alike));
        }
        hidden
            .take_all()
            .into_iter()
            .for_each(|vertex| hidden.forget(vertex, hash(vertex)));
        assert!(hidden.is_empty() && hidden.under.is_empty() && hidden.of_hash.is_empty());
    }

    #[test]
    fn tables_that_disagree_are_found() {
        let [a, b, c] = [0, 1, 3].map(VertexId::new);
        let cell = CellId::new(0);
        let mut intact = Hidden::default();
        [a, b, c]
            .into_iter()
            .for_each(|vertex| intact.put(vertex, cell, hash(vertex)));
        assert_eq!(intact.flaws(hash), []);
        let flaws = |damage: fn(&mut Hidden)| {
            let mut hidden = intact.clone();
            damage(&mut hidden);
            hidden.flaws(hash)
        };
        assert_eq!(flaws(|hidden| hidden.under.clear()), [a, b, c]);
        assert_eq!(flaws(|hidden| hidden.of_hash.clear()), [a, b, c]);
        assert_eq!(
            flaws(|hidden| _ = hidden.entries.remove(&VertexId::new(3))),
            [a, b, c]
        );
        assert_eq!(
            flaws(|hidden| hidden.under.values_mut().for_each(|under| under.swap(0, 1))),
            [a, b]
        );
    }
}
