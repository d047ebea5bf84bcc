//! The pages that list the nodes of an octree.

use std::collections::{BTreeMap, BTreeSet};

use crate::io::codec::las::node::{ENTRY, Key};

/// The levels that a page lists: of nodes that each have four below them, 341.
const LEVELS: u32 = 5;

/// Where the chunk of a node is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Chunk {
    pub(super) key: Key,
    pub(super) start: u64,
    pub(super) bytes: u32,
    pub(super) points: i32,
}

/// The pages of a file, one after the other.
pub(super) struct Hierarchy {
    pub(super) pages: Vec<u8>,
    /// Bytes of the first page, that of the root.
    pub(super) first: u64,
}

impl Hierarchy {
    /// Returns the pages of nodes, to be written at a position of the file.
    pub(super) fn of(chunks: &[Chunk], start: u64) -> Self {
        let mut lists: BTreeMap<Key, Vec<&Chunk>> = BTreeMap::new();
        for chunk in chunks {
            lists.entry(page_of(chunk.key)).or_default().push(chunk);
        }
        // The pages that each page lists.
        let mut below: BTreeMap<Key, BTreeSet<Key>> = BTreeMap::new();
        for &key in lists.keys().filter(|key| key.level > 0) {
            let above = page_of(key.on(key.level - 1));
            below.entry(above).or_default().insert(key);
        }
        let (mut sites, mut end) = (BTreeMap::new(), start);
        for (key, list) in &lists {
            let entries = list.len() + below.get(key).map_or(0, BTreeSet::len);
            let bytes = (entries * ENTRY) as u32;
            sites.insert(*key, (end, bytes));
            end += u64::from(bytes);
        }
        let mut pages = Vec::with_capacity((end - start) as usize);
        for (key, list) in &lists {
            for chunk in list {
                pages.extend(chunk.key.entry(chunk.start, chunk.bytes, chunk.points));
            }
            for page in below.get(key).into_iter().flatten() {
                let (start, bytes) = sites[page];
                pages.extend(page.entry(start, bytes, -1));
            }
        }
        let first = sites.get(&Key::ROOT).map_or(0, |&(_, bytes)| bytes.into());
        Hierarchy { pages, first }
    }
}

/// Returns the node whose page lists a node.
fn page_of(key: Key) -> Key {
    key.on(key.level - key.level % LEVELS)
}
