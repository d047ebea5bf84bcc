//! The vertices by which lines were given, and the chains of their segments.

use std::ops::{Deref, DerefMut};

use rustc_hash::FxHashMap;

use crate::arrangement::Arrangement;
use crate::line_id::LineId;
use crate::tds::VertexId;

/// The lines as given, and their chains through the triangulation.
///
/// A line is stored as the vertices by which it was given. Two tables describe the vertices between
/// two of these: the sites to which a segment bends, and the vertex that splits an edge. Both have
/// no entry for a segment that is one edge. So a line takes 24 bytes, and 4 for each of its
/// vertices if there are not just two. A segment that crosses others takes about 40 more, and 4 for
/// each site on it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Chains {
    /// The vertices of each line, by its id; `None` if it was removed.
    pub(crate) given: Vec<Option<LineVertices>>,
    /// The sites between the ends of each bent segment, from the smaller vertex to the larger.
    pub(crate) bent: FxHashMap<[VertexId; 2], Box<[VertexId]>>,
    /// The vertex that splits a sub-constraint, or a part of one.
    pub(crate) splits: FxHashMap<[VertexId; 2], VertexId>,
}

/// The vertices by which a line was given.
///
/// `PERF:` the two of a single segment are stored inline, as programs create millions of these.
#[derive(Debug, Clone)]
pub(crate) enum LineVertices {
    Segment([VertexId; 2]),
    Other(Box<[VertexId]>),
}

impl LineVertices {
    #[inline]
    pub(crate) fn of<T: Copy>(given: &[T], vertex: impl Fn(T) -> VertexId) -> Self {
        match *given {
            [a, b] => LineVertices::Segment([vertex(a), vertex(b)]),
            _ => LineVertices::Other(given.iter().map(|&v| vertex(v)).collect()),
        }
    }
}

impl From<&[VertexId]> for LineVertices {
    fn from(vertices: &[VertexId]) -> Self {
        LineVertices::of(vertices, |v| v)
    }
}

impl Deref for LineVertices {
    type Target = [VertexId];

    #[inline]
    fn deref(&self) -> &[VertexId] {
        match self {
            LineVertices::Segment(ends) => ends,
            LineVertices::Other(vertices) => vertices,
        }
    }
}

impl DerefMut for LineVertices {
    #[inline]
    fn deref_mut(&mut self) -> &mut [VertexId] {
        match self {
            LineVertices::Segment(ends) => ends,
            LineVertices::Other(vertices) => vertices,
        }
    }
}

/// Two vertices, the smaller first: a segment, a sub-constraint, or an edge.
pub(super) type Ends = [VertexId; 2];

/// Returns the vertices with the smaller first: one key for both directions.
#[inline]
pub(crate) fn undirected(a: VertexId, b: VertexId) -> [VertexId; 2] {
    if a < b { [a, b] } else { [b, a] }
}

/// Returns each segment of some lines once, from the smaller vertex to the larger, in order.
/// `of_vertex` must preserve the order of vertices.
pub(crate) fn segments_of<'a, T: Ord>(
    lines: impl Iterator<Item = &'a [VertexId]>,
    of_vertex: impl Fn(VertexId) -> T,
) -> Vec<[T; 2]> {
    let pairs = lines
        .flat_map(|line| line.windows(2))
        .filter(|pair| pair[0] != pair[1]);
    let mut segments: Vec<[T; 2]> = pairs
        .map(|pair| undirected(pair[0], pair[1]).map(&of_vertex))
        .collect();
    segments.sort_unstable();
    segments.dedup();
    segments
}

impl Chains {
    /// The vertices of each line that exists.
    pub(crate) fn each(&self) -> impl Iterator<Item = &[VertexId]> {
        self.given.iter().flatten().map(|line| &**line)
    }

    /// Records the chain of each arranged segment, whose sites are vertices now. Returns the
    /// sub-constraints, each once, in order.
    pub(crate) fn record(
        &mut self,
        arrangement: &Arrangement,
        segments: &[[u32; 2]],
        vertex: impl Fn(u32) -> VertexId,
    ) -> Vec<[VertexId; 2]> {
        self.bent.clear();
        let mut parts = Vec::with_capacity(segments.len());
        for (i, ends) in (0..).zip(segments) {
            let [a, b] = ends.map(&vertex);
            if !arrangement.has_chain(i) {
                parts.push(undirected(a, b));
                continue;
            }
            let mut between: Box<[VertexId]> = arrangement
                .chain(i)
                .iter()
                .map(|&site| vertex(site))
                .collect();
            let mut at = a;
            for &next in between.iter().chain([&b]) {
                parts.push(undirected(at, next));
                at = next;
            }
            if a > b {
                between.reverse();
            }
            self.bent.insert(undirected(a, b), between);
        }
        parts.sort_unstable();
        parts.dedup();
        parts
    }

    /// Returns the segments of all lines, each once, from the smaller vertex to the larger, in
    /// order.
    pub(crate) fn segments(&self) -> Vec<[VertexId; 2]> {
        segments_of(self.each(), |v| v)
    }

    /// Returns the sites that a segment passes through, ends included.
    pub(crate) fn sites(&self, [a, b]: [VertexId; 2]) -> Vec<VertexId> {
        let between = self.bent.get(&[a, b]).map_or(&[][..], |sites| sites);
        [&[a], between, &[b]].concat()
    }

    /// Records that an edge was split.
    pub(crate) fn split(&mut self, a: VertexId, b: VertexId, at: VertexId) {
        self.splits.insert(undirected(a, b), at);
    }

    /// Appends the vertices of a segment to `chain`, without its start.
    pub(crate) fn walk(&self, a: VertexId, b: VertexId, chain: &mut Vec<VertexId>) {
        let mut at = a;
        let mut steps = |site: VertexId| {
            self.walk_part(at, site, chain);
            at = site;
        };
        if let Some(sites) = self.bent.get(&undirected(a, b)) {
            if a < b {
                sites.iter().for_each(|&site| steps(site));
            } else {
                sites.iter().rev().for_each(|&site| steps(site));
            }
        }
        steps(b);
    }

    /// Like [`walk`](Self::walk), but for a sub-constraint, which does not bend but may have been
    /// split.
    pub(crate) fn walk_part(&self, a: VertexId, b: VertexId, chain: &mut Vec<VertexId>) {
        let mut at = a;
        let mut ahead = vec![b];
        while let Some(&next) = ahead.last() {
            match self.splits.get(&undirected(at, next)) {
                Some(&between) => ahead.push(between),
                None => {
                    if next != at {
                        chain.push(next);
                    }
                    at = next;
                    ahead.pop();
                }
            }
        }
    }

    /// Calls `visit` with each part of a segment's chain: its sub-constraints.
    pub(super) fn parts(&self, segment: Ends, mut visit: impl FnMut(Ends)) {
        let mut at = segment[0];
        for &site in self
            .bent
            .get(&segment)
            .into_iter()
            .flatten()
            .chain([&segment[1]])
        {
            visit(undirected(at, site));
            at = site;
        }
    }

    /// Calls `visit` with each node of a part of a chain: the part, and those into which it was
    /// split.
    pub(super) fn nodes_of_part(&self, part: Ends, mut visit: impl FnMut(Ends)) {
        let (mut first, mut parts) = (Some(part), Vec::new());
        while let Some(part) = first.take().or_else(|| parts.pop()) {
            visit(part);
            if let Some(&between) = self.splits.get(&part) {
                parts.extend(part.map(|end| undirected(end, between)));
            }
        }
    }

    /// Returns the vertices by which a line was given; none if it does not exist.
    pub(super) fn vertices(&self, line: LineId) -> &[VertexId] {
        self.given
            .get(line.index())
            .and_then(Option::as_deref)
            .unwrap_or_default()
    }

    /// The lines that exist, each with the vertices by which it was given.
    pub(super) fn numbered(&self) -> impl Iterator<Item = (LineId, &[VertexId])> {
        let given = self.given.iter().enumerate();
        given.filter_map(|(number, line)| Some((LineId::new(number), line.as_deref()?)))
    }

    /// Removes the splits of edges that are on no segment's chain.
    pub(super) fn drop_stray_splits(&mut self) {
        let mut splits = FxHashMap::default();
        for ends in self.segments() {
            let sites = self.sites(ends);
            sites
                .windows(2)
                .for_each(|part| self.copy_splits(part[0], part[1], &mut splits));
        }
        self.splits = splits;
    }

    /// Copies the splits of a sub-constraint into another table.
    pub(crate) fn copy_splits(
        &self,
        a: VertexId,
        b: VertexId,
        to: &mut FxHashMap<[VertexId; 2], VertexId>,
    ) {
        let mut parts = vec![undirected(a, b)];
        while let Some([a, b]) = parts.pop() {
            if let Some(&between) = self.splits.get(&[a, b]) {
                to.insert([a, b], between);
                parts.extend([undirected(a, between), undirected(between, b)]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the sizes that the documentation of [`Chains`] states.
    #[test]
    fn lines_are_small() {
        assert_eq!(size_of::<Option<LineVertices>>(), 24, "a line");
        assert_eq!(
            size_of::<VertexId>(),
            4,
            "a vertex of a line, a site on a segment"
        );
        assert_eq!(
            size_of::<([VertexId; 2], Box<[VertexId]>)>(),
            24,
            "a segment that crosses others, in the table"
        );
        assert_eq!(
            size_of::<([VertexId; 2], VertexId)>(),
            12,
            "an edge that was split, in the table"
        );
        assert_eq!(
            size_of::<crate::engine::ConstrainedEdges>(),
            1,
            "the flags of three edges, at each triangle"
        );
    }
}
