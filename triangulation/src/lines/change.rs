//! A segment that gets another chain, and where the old and the new chain differ.

use std::ops::Range;

use crate::tds::VertexId;

use super::chains::{Ends, undirected};

/// A segment that is inserted, is removed, or gets another chain.
///
/// A chain is stored as its sites from end to end. Two neighbors in the list are a *part*, numbered
/// by the first of them. The old and the new chain may begin and end with the same parts, which
/// stay in the triangulation:
///
/// ```text
/// old   a --- p --- q --------- r --- b        a p and r b stay
///
/// new   a --- p --- s --- t --- r --- b
/// ```
pub(super) struct Change {
    pub(super) segment: Ends,
    /// True if the segment is bent afterwards, possibly without a site.
    pub(super) is_bent: bool,
    old: Vec<VertexId>,
    new: Vec<VertexId>,
    /// The numbers of parts that stay at the beginning and at the end.
    head: usize,
    tail: usize,
}

impl Change {
    /// Returns the change from one chain to another. The chain of a segment that does not exist is
    /// empty.
    pub(super) fn new(
        segment: Ends,
        old: Vec<VertexId>,
        new: Vec<VertexId>,
        is_bent: bool,
    ) -> Self {
        let head = count_shared(old.iter(), new.iter()).saturating_sub(1);
        let tail = count_shared(old.iter().rev(), new.iter().rev()).saturating_sub(1);
        Change {
            segment,
            is_bent,
            old,
            new,
            head,
            tail,
        }
    }

    /// Lets the parts at a vertex change, too: the part of the old chain with this number, and the
    /// next one if the vertex is between them.
    pub(super) fn include(&mut self, part: usize, vertex: VertexId) {
        let sites = self.old_sites();
        let last = if sites.get(part) == Some(&vertex) {
            part + 1
        } else {
            part
        };
        let after = sites.len() - last;
        self.head = self.head.min(part);
        self.tail = self.tail.min(after);
    }

    /// The sites between the ends of the old chain.
    pub(super) fn old_sites(&self) -> &[VertexId] {
        between(&self.old)
    }

    /// The sites between the ends of the new chain.
    pub(super) fn new_sites(&self) -> &[VertexId] {
        between(&self.new)
    }

    /// The parts of the old chain that are removed.
    pub(super) fn old_parts(&self) -> impl Iterator<Item = Ends> {
        self.parts(&self.old)
    }

    /// The parts of the new chain that are inserted.
    pub(super) fn new_parts(&self) -> impl Iterator<Item = Ends> {
        self.parts(&self.new)
    }

    /// The sites of both chains that lie between the parts that stay.
    pub(super) fn sites_that_change(&self) -> impl Iterator<Item = VertexId> {
        [&self.old, &self.new]
            .into_iter()
            .flat_map(|chain| self.changed(chain).skip(1).map(|part| chain[part]))
    }

    fn parts<'a>(&self, chain: &'a [VertexId]) -> impl Iterator<Item = Ends> + use<'a> {
        self.changed(chain)
            .map(|part| undirected(chain[part], chain[part + 1]))
    }

    /// Returns which parts of a chain change.
    fn changed(&self, chain: &[VertexId]) -> Range<usize> {
        self.head..chain.len().saturating_sub(1 + self.tail)
    }
}

/// Returns how many elements two lists share before the first one that differs.
fn count_shared<'a>(
    old: impl Iterator<Item = &'a VertexId>,
    new: impl Iterator<Item = &'a VertexId>,
) -> usize {
    old.zip(new).take_while(|(u, v)| u == v).count()
}

/// Returns the sites of a chain without its ends.
fn between(chain: &[VertexId]) -> &[VertexId] {
    if let [_, between @ .., _] = chain {
        between
    } else {
        &[]
    }
}
