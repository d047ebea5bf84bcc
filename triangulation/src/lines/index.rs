//! Which segments run along an edge, and which lines contain them. Computed on first use, and
//! updated from then on.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use crate::arrangement::{Rounder, is_aligned, is_ordinary, step_at};
use crate::geometry::Crossing;
use crate::line_id::LineId;
use crate::tds::VertexId;

use super::chains::{Chains, Ends, undirected};
use super::mesh::{Mesh, position};
use super::on_crossing::Rounding;

/// The reason why an edit cannot be local: the grid changes, sub-constraints cross off the grid, or
/// there are no triangles. All lines have to be arranged anew.
#[derive(Debug)]
pub(super) struct NotLocal;

/// A set that has one element nearly always.
#[derive(Debug, Clone)]
enum Few<T> {
    One(T),
    Many(Vec<T>),
}

impl<T: Copy + PartialEq> Few<T> {
    fn as_slice(&self) -> &[T] {
        match self {
            Few::One(only) => std::slice::from_ref(only),
            Few::Many(all) => all,
        }
    }
}

/// A table of sets that are not empty.
#[derive(Debug, Clone)]
struct SetsByEnds<T>(FxHashMap<Ends, Few<T>>);

impl<T: Copy + PartialEq> SetsByEnds<T> {
    fn get(&self, key: Ends) -> &[T] {
        self.0.get(&key).map_or(&[], Few::as_slice)
    }

    fn insert(&mut self, key: Ends, value: T) {
        match self.0.get_mut(&key) {
            None => _ = self.0.insert(key, Few::One(value)),
            Some(few) if few.as_slice().contains(&value) => {}
            Some(Few::Many(all)) => all.push(value),
            Some(few) => *few = Few::Many([few.as_slice(), &[value]].concat()),
        }
    }

    fn remove(&mut self, key: Ends, value: T) {
        let is_last = match self.0.get_mut(&key) {
            Some(Few::Many(all)) => {
                all.retain(|other| *other != value);
                all.is_empty()
            }
            Some(Few::One(only)) => *only == value,
            None => false,
        };
        if is_last {
            self.0.remove(&key);
        }
    }
}

/// The inverse of [`Chains`].
///
/// The chain of a segment is a list of sub-constraints, each of which is a binary tree of edges
/// that were split. The *nodes* of a segment are all edges of these trees. Most segments are one
/// edge: such a segment is its only node, and has no entry for it.
///
/// About 40 bytes for each segment, and 40 for each node of segments that are more than one edge.
#[derive(Debug, Clone)]
pub(super) struct Index {
    lines_of: SetsByEnds<LineId>,
    segments_on: SetsByEnds<Ends>,
    /// Lines without a segment.
    pub(super) dots: Vec<LineId>,
    /// For each axis and each distance between adjacent doubles: the number of segments' ends whose
    /// coordinate has that distance.
    steps: [BTreeMap<u64, usize>; 2],
    /// The number of segments' ends that are no multiples of the unit.
    uneven: usize,
    /// The grid of the rounding; `None` if edits cannot be local, or before the first edit.
    pub(super) rounder: Option<Rounder>,
    pub(super) is_measured: bool,
}

impl Index {
    /// Returns the index of all lines.
    pub(super) fn of(chains: &Chains) -> Self {
        let mut index = Index {
            lines_of: SetsByEnds(FxHashMap::default()),
            segments_on: SetsByEnds(FxHashMap::default()),
            dots: Vec::new(),
            steps: [BTreeMap::new(), BTreeMap::new()],
            uneven: 0,
            rounder: None,
            is_measured: false,
        };
        for (line, vertices) in chains.numbered() {
            index.rename(line, &[], vertices);
        }
        for segment in index.segments() {
            chains.parts(segment, |part| index.add_part(chains, segment, part));
        }
        index
    }

    fn segments(&self) -> Vec<Ends> {
        self.lines_of.0.keys().copied().collect()
    }

    /// Determines the grid. It is known only if the tables are the result of an arrangement on it:
    /// each segment meets the pixels of its sites, and edges are split at vertices that lie on
    /// them.
    pub(super) fn measure<G: Crossing, V, C: Copy + Default>(
        &mut self,
        chains: &Chains,
        rounding: Option<Rounding>,
        t: &Mesh<G, V, C>,
    ) {
        self.is_measured = true;
        let at = |v: VertexId| position(t, v);
        let segments = self.segments();
        for &end in segments.as_flattened() {
            self.count(at(end), true);
        }
        let is_even = rounding.is_none_or(|rounding| rounding.on_grid);
        let Some(largest) = self.largest() else {
            return;
        };
        let Some(rounder) = Rounder::new(largest, t.geometry.step(), is_even) else {
            return;
        };
        self.uneven = segments
            .as_flattened()
            .iter()
            .filter(|&&end| !rounder.holds(at(end)))
            .count();
        let is_hit = |ends: &Ends, sites: &[VertexId]| {
            sites
                .iter()
                .all(|&site| rounder.hits(ends.map(at), at(site)))
        };
        let is_on =
            |([a, b], between): (&Ends, &VertexId)| is_aligned([at(*a), at(*b)], at(*between));
        let is_known = t.tds.vertices().all(|v| is_ordinary(at(v)))
            && rounding.is_none_or(|rounding| {
                rounding.unit == rounder.unit() && (self.uneven == 0) == is_even
            })
            && chains.bent.iter().all(|(ends, sites)| is_hit(ends, sites))
            && chains.splits.iter().all(is_on);
        self.rounder = is_known
            .then(|| Rounder::new(largest, t.geometry.step(), self.uneven == 0))
            .flatten();
    }

    /// Returns, for each axis, the largest coordinate of an end, up to a factor of two.
    fn largest(&self) -> Option<[f64; 2]> {
        let largest = |steps: &BTreeMap<u64, usize>| {
            Some(f64::from_bits(*steps.last_key_value()?.0) / f64::EPSILON)
        };
        Some([largest(&self.steps[0])?, largest(&self.steps[1])?])
    }

    /// Adds an end of a segment to the counts, or removes it from them.
    fn count(&mut self, at: [f64; 2], is_added: bool) {
        for (steps, x) in self.steps.iter_mut().zip(at) {
            let step = step_at(x).to_bits();
            let count = steps.entry(step).or_default();
            *count = if is_added {
                *count + 1
            } else {
                count.saturating_sub(1)
            };
            if *count == 0 {
                steps.remove(&step);
            }
        }
        if self.rounder.is_some_and(|rounder| !rounder.holds(at)) {
            self.uneven = if is_added {
                self.uneven + 1
            } else {
                self.uneven.saturating_sub(1)
            };
        }
    }

    /// Adds the ends of a segment to the counts, or removes them.
    ///
    /// # Errors
    /// If the grid changes.
    pub(super) fn count_ends(
        &mut self,
        ends: [[f64; 2]; 2],
        is_added: bool,
    ) -> Result<(), NotLocal> {
        let before = self.largest();
        ends.into_iter().for_each(|at| self.count(at, is_added));
        let is_same =
            |rounder: &Rounder| rounder.is_even() == (self.uneven == 0) && before == self.largest();
        self.rounder.filter(is_same).map(|_| ()).ok_or(NotLocal)
    }

    /// Records that a line contains a segment, whose chain is known.
    pub(super) fn attach(&mut self, segment: Ends, line: LineId) {
        self.lines_of.insert(segment, line);
    }

    /// Records that a line no longer contains a segment. Returns true if no line contains it now.
    pub(super) fn detach(&mut self, segment: Ends, line: LineId) -> bool {
        self.lines_of.remove(segment, line);
        !self.has_segment(segment)
    }

    /// Records new vertices of a line. The chains of its segments are known, or will be.
    pub(super) fn rename(&mut self, line: LineId, before: &[VertexId], after: &[VertexId]) {
        let mut is_dot = !after.is_empty();
        for segment in segments_of_line(before) {
            self.lines_of.remove(segment, line);
        }
        for segment in segments_of_line(after) {
            self.lines_of.insert(segment, line);
            is_dot = false;
        }
        self.dots.retain(|other| *other != line);
        self.dots.extend(is_dot.then_some(line));
    }

    /// Returns true if a line contains this segment.
    pub(super) fn has_segment(&self, segment: Ends) -> bool {
        !self.lines_of.get(segment).is_empty()
    }

    /// The lines that contain a segment, in no particular order.
    pub(super) fn lines_of(&self, segment: Ends) -> &[LineId] {
        self.lines_of.get(segment)
    }

    /// The segments that have an edge as a node.
    pub(super) fn segments_on(&self, chains: &Chains, edge: Ends) -> impl Iterator<Item = Ends> {
        let is_one =
            self.has_segment(edge) && chains.bent.get(&edge).is_none_or(|sites| sites.is_empty());
        self.segments_on
            .get(edge)
            .iter()
            .copied()
            .chain(is_one.then_some(edge))
    }

    /// Returns true if the index has all nodes of a segment.
    pub(super) fn knows(&self, chains: &Chains, segment: Ends) -> bool {
        let mut is_known = self.has_segment(segment);
        let is_on = |node| self.segments_on(chains, node).any(|other| other == segment);
        chains.parts(segment, |part| {
            chains.nodes_of_part(part, |node| is_known &= is_on(node))
        });
        is_known
    }

    /// Records that a segment has the nodes of a part of its chain, which is in the tables.
    pub(super) fn add_part(&mut self, chains: &Chains, segment: Ends, part: Ends) {
        chains.nodes_of_part(part, |node| {
            if node != segment {
                self.segments_on.insert(node, segment);
            }
        });
    }

    /// Records that a segment has a node, which is not in the tables yet.
    pub(super) fn add_node(&mut self, segment: Ends, node: Ends) {
        self.segments_on.insert(node, segment);
    }

    /// Removes a segment from the nodes of a part of its chain, and appends these to `nodes`. The
    /// node that is the segment itself stays.
    pub(super) fn remove_part(
        &mut self,
        chains: &Chains,
        segment: Ends,
        part: Ends,
        nodes: &mut Vec<Ends>,
    ) {
        chains.nodes_of_part(part, |node| {
            self.segments_on.remove(node, segment);
            nodes.push(node);
        });
    }

    /// Records that an edge was split.
    pub(super) fn split(&mut self, chains: &Chains, edge: Ends, at: VertexId) {
        let segments: Vec<Ends> = self.segments_on(chains, edge).collect();
        for segment in segments {
            for end in edge {
                self.segments_on.insert(undirected(end, at), segment);
            }
        }
    }
}

/// The segments of a line, from the smaller vertex to the larger; with repetitions.
fn segments_of_line(vertices: &[VertexId]) -> impl Iterator<Item = Ends> + '_ {
    vertices
        .windows(2)
        .filter(|pair| pair[0] != pair[1])
        .map(|pair| undirected(pair[0], pair[1]))
}
