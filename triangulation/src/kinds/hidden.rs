//! The points of a regular triangulation that are in no cell.

use std::num::NonZeroU32;

use rustc_hash::FxHashMap;

use crate::tds::{CellId, VertexId};

/// Maps hidden points to the cells that hide them, cells to the points under them, and hashes of
/// points to hidden points.
///
/// An edit that destroys cells [takes](Self::take_under) what is under them. These points keep
/// their entries, and are then put under other cells, or removed as they become visible.
#[derive(Debug, Clone, Default)]
pub(super) struct Hidden {
    entries: Entries,
    under: FxHashMap<CellId, Vec<VertexId>>,
    buckets: Buckets,
}

#[derive(Debug, Clone, Copy)]
struct Entry {
    /// The cell that hides the point.
    cell: CellId,
    /// The position of the point in the list of that cell.
    position: u32,
    /// What the point is found by, if it has a hash.
    key: Option<NonZeroU32>,
    /// The next hidden point in the bucket of that key.
    next: Option<VertexId>,
}

/// Hidden points by their keys: a hash table whose lists are in the entries.
///
/// `PERF:` a table of keys and vertices takes 130 instructions to add a point to, this one 30.
#[derive(Debug, Clone, Default)]
struct Buckets {
    /// The point that was put last into each bucket.
    heads: Vec<Option<VertexId>>,
    /// The number of points in all buckets: at most that of buckets.
    len: usize,
}

impl Buckets {
    /// Returns the bucket of a key, by its high bits.
    fn of(&self, key: NonZeroU32) -> usize {
        ((u64::from(key.get()) * self.heads.len() as u64) >> 32) as usize
    }

    /// Makes a point the first of its bucket, and returns the one that was first.
    fn put(&mut self, vertex: VertexId, key: NonZeroU32) -> Option<VertexId> {
        let bucket = self.of(key);
        self.heads[bucket].replace(vertex)
    }

    /// Returns the point that was put last into the bucket of a key.
    fn head(&self, key: NonZeroU32) -> Option<VertexId> {
        *self.heads.get(self.of(key))?
    }
}

/// The entries, by the numbers of their vertices, in pages. A page without entries is a null
/// pointer: half a byte for each vertex.
#[derive(Debug, Clone, Default)]
struct Entries {
    pages: Vec<Option<Box<Page>>>,
    len: usize,
}

/// As many entries as share a pointer. Points that are inserted one after another have consecutive
/// numbers, so that their entries are next to each other.
const PAGE: usize = 16;

#[derive(Debug, Clone, Default)]
struct Page {
    entries: [Option<Entry>; PAGE],
    len: usize,
}

impl Entries {
    fn get(&self, vertex: VertexId) -> Option<&Entry> {
        let page = self.pages.get(vertex.index() / PAGE)?.as_ref()?;
        page.entries[vertex.index() % PAGE].as_ref()
    }

    fn get_mut(&mut self, vertex: VertexId) -> Option<&mut Entry> {
        let page = self.pages.get_mut(vertex.index() / PAGE)?.as_mut()?;
        page.entries[vertex.index() % PAGE].as_mut()
    }

    /// Adds the entry of a vertex that has none.
    fn insert(&mut self, vertex: VertexId, entry: Entry) {
        let number = vertex.index() / PAGE;
        if number >= self.pages.len() {
            self.pages.resize_with(number + 1, || None);
        }
        let page = self.pages[number].get_or_insert_default();
        page.entries[vertex.index() % PAGE] = Some(entry);
        page.len += 1;
        self.len += 1;
    }

    fn remove(&mut self, vertex: VertexId) -> Option<Entry> {
        let slot = self.pages.get_mut(vertex.index() / PAGE)?;
        let page = slot.as_mut()?;
        let removed = page.entries[vertex.index() % PAGE].take()?;
        page.len -= 1;
        self.len -= 1;
        if page.len == 0 {
            *slot = None;
        }
        Some(removed)
    }

    /// Puts all points that have a key into buckets that are still empty.
    fn put_into(&mut self, buckets: &mut Buckets) {
        for (number, page) in self.pages.iter_mut().enumerate() {
            let entries = page.iter_mut().flat_map(|page| page.entries.iter_mut());
            for (i, entry) in entries.enumerate() {
                if let Some(entry) = entry
                    && let Some(key) = entry.key
                {
                    entry.next = buckets.put(VertexId::new(number * PAGE + i), key);
                }
            }
        }
    }

    /// Iterates over the vertices that have entries, and these, in order of their numbers.
    fn iter(&self) -> impl Iterator<Item = (VertexId, &Entry)> {
        let pages = self.pages.iter().enumerate();
        let used = pages.filter_map(|(number, page)| Some((number, page.as_ref()?)));
        used.flat_map(|(number, page)| {
            let entries = page.entries.iter().enumerate();
            entries.filter_map(move |(i, entry)| {
                Some((VertexId::new(number * PAGE + i), entry.as_ref()?))
            })
        })
    }
}

/// Returns half of a hash, by which points are found. Any bits of the hash may be the ones that
/// differ.
fn key(hash: u64) -> NonZeroU32 {
    let high = (hash.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as u32;
    NonZeroU32::MIN | high
}

impl Hidden {
    pub(super) fn is_empty(&self) -> bool {
        self.entries.len == 0
    }

    pub(super) fn contains(&self, vertex: VertexId) -> bool {
        self.entries.get(vertex).is_some()
    }

    /// Returns the cell that hides a point.
    pub(super) fn host(&self, vertex: VertexId) -> Option<CellId> {
        self.entries.get(vertex).map(|entry| entry.cell)
    }

    /// Returns the points under a cell.
    pub(super) fn under(&self, cell: CellId) -> &[VertexId] {
        self.under.get(&cell).map_or(&[], Vec::as_slice)
    }

    /// Returns all points, in order of their numbers.
    pub(super) fn all(&self) -> Vec<VertexId> {
        self.entries.iter().map(|(vertex, _)| vertex).collect()
    }

    /// Iterates over the hidden points of a hash, and perhaps a few others.
    pub(super) fn of_hash(&self, hash: u64) -> impl Iterator<Item = VertexId> + '_ {
        let key = key(hash);
        self.in_bucket(key).filter(move |&vertex| {
            let entry = self.entries.get(vertex);
            entry.is_some_and(|entry| entry.key == Some(key))
        })
    }

    /// Iterates over the hidden points in the bucket of a key.
    fn in_bucket(&self, key: NonZeroU32) -> impl Iterator<Item = VertexId> + '_ {
        std::iter::successors(self.buckets.head(key), |&vertex| {
            self.entries.get(vertex)?.next
        })
    }

    /// Puts a point under a cell. The hash is that of the point if it is to be found by it.
    pub(super) fn put(&mut self, vertex: VertexId, cell: CellId, hash: Option<u64>) {
        let under = self.under.entry(cell).or_default();
        let position = under.len() as u32;
        under.push(vertex);
        if let Some(entry) = self.entries.get_mut(vertex) {
            (entry.cell, entry.position) = (cell, position);
            return;
        }
        let key = hash.map(key);
        let next = key.and_then(|key| self.put_into_bucket(vertex, key));
        let entry = Entry {
            cell,
            position,
            key,
            next,
        };
        self.entries.insert(vertex, entry);
    }

    /// Makes a point the first of its bucket, and returns the one that was first. Makes room before
    /// that.
    fn put_into_bucket(&mut self, vertex: VertexId, key: NonZeroU32) -> Option<VertexId> {
        if self.buckets.len == self.buckets.heads.len() {
            self.buckets.heads = vec![None; (2 * self.buckets.len).max(PAGE)];
            self.entries.put_into(&mut self.buckets);
        }
        self.buckets.len += 1;
        self.buckets.put(vertex, key)
    }

    /// Removes a point from under its cell, and its entry; returns false if it was not there.
    pub(super) fn remove(&mut self, vertex: VertexId) -> bool {
        let Some(Entry { cell, position, .. }) = self.take_entry(vertex) else {
            return false;
        };
        if let Some(under) = self.under.get_mut(&cell) {
            under.swap_remove(position as usize);
            match under.get(position as usize) {
                Some(&moved) => {
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
    pub(super) fn forget(&mut self, vertex: VertexId) {
        self.take_entry(vertex);
    }

    fn take_entry(&mut self, vertex: VertexId) -> Option<Entry> {
        let removed = self.entries.remove(vertex)?;
        let Some(key) = removed.key else {
            return Some(removed);
        };
        self.buckets.len -= 1;
        let before = self
            .in_bucket(key)
            .take_while(|&other| other != vertex)
            .last();
        match before {
            Some(before) => {
                if let Some(entry) = self.entries.get_mut(before) {
                    entry.next = removed.next;
                }
            }
            None => {
                let bucket = self.buckets.of(key);
                self.buckets.heads[bucket] = removed.next;
            }
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
            let agrees = |&(position, &vertex): &(usize, &VertexId)| {
                self.entries
                    .get(vertex)
                    .is_some_and(|entry| (entry.cell, entry.position as usize) == (cell, position))
            };
            flaws.extend(
                under
                    .iter()
                    .enumerate()
                    .filter(|listed| !agrees(listed))
                    .map(|(_, &vertex)| vertex),
            );
        }
        let is_found = |&(vertex, entry): &(VertexId, &Entry)| {
            self.under(entry.cell).get(entry.position as usize) == Some(&vertex)
                && hash(vertex).is_none_or(|hash| self.of_hash(hash).any(|other| other == vertex))
        };
        flaws.extend(
            self.entries
                .iter()
                .filter(|entry| !is_found(entry))
                .map(|(vertex, _)| vertex),
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
        (vertex.index() % 3 != 2).then_some(bucket(vertex))
    }

    fn bucket(vertex: VertexId) -> u64 {
        vertex.index() as u64 / 8
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
                            hidden.forget(vertex);
                            expected.remove(&vertex);
                        } else {
                            hidden.put(vertex, CellId::new(k % 5), hash(vertex));
                            expected.insert(vertex, CellId::new(k % 5));
                        }
                    }
                }
                1..4 => assert_eq!(hidden.remove(vertex), expected.remove(&vertex).is_some()),
                _ if !expected.contains_key(&vertex) => {
                    hidden.put(vertex, cell, hash(vertex));
                    expected.insert(vertex, cell);
                }
                _ => {}
            }
            assert_eq!(hidden.flaws(hash), []);
            assert!(hidden.all().iter().eq(expected.keys()));
            assert_eq!(hidden.host(vertex), expected.get(&vertex).copied());
            let mut of_hash: Vec<VertexId> = hidden.of_hash(bucket(vertex)).collect();
            of_hash.sort_unstable();
            let alike = expected
                .keys()
                .filter(|&&other| hash(other) == Some(bucket(vertex)));
            assert!(of_hash.iter().eq(alike));
        }
        hidden
            .take_all()
            .into_iter()
            .for_each(|vertex| hidden.forget(vertex));
        assert!(hidden.is_empty() && hidden.under.is_empty() && hidden.buckets.len == 0);
        assert!(hidden.entries.pages.iter().all(Option::is_none));
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
        assert_eq!(flaws(|hidden| hidden.buckets.heads.fill(None)), [a, b, c]);
        assert_eq!(
            flaws(|hidden| _ = hidden.entries.remove(VertexId::new(3))),
            [a, b, c]
        );
        assert_eq!(
            flaws(|hidden| hidden.under.values_mut().for_each(|under| under.swap(0, 1))),
            [a, b]
        );
    }
}
