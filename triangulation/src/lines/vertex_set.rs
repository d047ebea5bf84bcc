//! A set of vertices: one bit for each.

use crate::tds::VertexId;

/// A set of vertices, in the order of their numbers.
#[derive(Debug, Clone, Default)]
pub(super) struct VertexSet(Vec<u64>);

impl VertexSet {
    /// Adds a vertex; returns false if it was there already.
    pub(super) fn insert(&mut self, vertex: VertexId) -> bool {
        let (word, bit) = position(vertex);
        if word >= self.0.len() {
            self.0.resize(word + 1, 0);
        }
        let is_new = self.0[word] & bit == 0;
        self.0[word] |= bit;
        is_new
    }

    /// Removes a vertex; returns false if it was not there.
    pub(super) fn remove(&mut self, vertex: VertexId) -> bool {
        let (word, bit) = position(vertex);
        let was_there = self.contains(vertex);
        if was_there {
            self.0[word] ^= bit;
        }
        was_there
    }

    #[inline]
    pub(super) fn contains(&self, vertex: VertexId) -> bool {
        let (word, bit) = position(vertex);
        self.0.get(word).is_some_and(|bits| bits & bit != 0)
    }

    /// The vertices, in order. Time linear in the largest number.
    pub(super) fn iter(&self) -> impl Iterator<Item = VertexId> + '_ {
        self.0.iter().enumerate().flat_map(|(word, &bits)| {
            (0..64)
                .filter(move |bit| bits >> bit & 1 == 1)
                .map(move |bit| VertexId::new(word * 64 + bit))
        })
    }
}

impl FromIterator<VertexId> for VertexSet {
    fn from_iter<I: IntoIterator<Item = VertexId>>(vertices: I) -> Self {
        let mut set = VertexSet::default();
        vertices
            .into_iter()
            .for_each(|vertex| _ = set.insert(vertex));
        set
    }
}

#[inline]
fn position(vertex: VertexId) -> (usize, u64) {
    (vertex.index() / 64, 1 << (vertex.index() % 64))
}
