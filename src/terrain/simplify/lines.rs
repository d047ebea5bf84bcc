//! The constrained edges of a surface that is simplified: its lines, and its rim.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::data::EdgeKind;
use crate::triangulation::geometry::distance_to_segment;
use crate::triangulation::kernel::{Adaptive, DotProduct, Kernel, Orientation2};
use crate::triangulation::num::Sign;

/// What an edge is part of. Edges are joined to one only if all of this is equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct EdgeRole {
    /// [`EdgeKind::Rim`] where no line runs along it.
    pub(super) kind: EdgeKind,
    /// True at the rim of the surface.
    pub(super) is_rim: bool,
}

/// An edge between two sites.
#[derive(Debug, Clone)]
pub(super) struct Edge {
    pub(super) role: EdgeRole,
    /// At the rim: true if the surface is left of it, seen from the site with the lower number.
    is_left: bool,
    /// The sites of the line that were removed between its ends.
    gone: Vec<u32>,
    /// True if all of these are exactly on it.
    is_exact: bool,
    /// Its number, as it was added.
    number: u32,
}

/// The constrained edges, by their ends.
#[derive(Debug, Clone, Default)]
pub(super) struct Lines {
    edges: FxHashMap<[u32; 2], Edge>,
    /// For each number of an edge, that of the one it was joined to, or itself.
    joined_to: Vec<u32>,
    /// For each site that was removed, the number of an edge that it was removed from.
    removed_from: FxHashMap<u32, u32>,
    /// The largest distance in plan of a removed vertex from the edge that replaces it.
    tolerance: f64,
}

/// How two edges become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Joint {
    /// All sites of the line between the ends are exactly on the new edge.
    Exact,
    /// They are near enough.
    Near,
}

fn ordered([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

impl Lines {
    /// Adds an edge; at the rim, the surface is left of it. Where a rim meets another one, as in
    /// meshes with vertices of their own for each face, the surface goes on, and neither is left.
    pub(super) fn add(&mut self, ends: [u32; 2], role: EdgeRole) {
        let (key, is_left) = (ordered(ends), ends[0] < ends[1]);
        if let Some(old) = self.edges.get_mut(&key) {
            if old.role.is_rim && role.is_rim && old.is_left != is_left {
                let kinds = [old.role.kind, role.kind];
                let of_lines = kinds.into_iter().filter(|kind| kind.is_constrained());
                match of_lines.min() {
                    Some(kind) => {
                        old.role = EdgeRole {
                            kind,
                            is_rim: false,
                        }
                    }
                    None => _ = self.edges.remove(&key),
                }
            }
            return;
        }
        let number = self.joined_to.len() as u32;
        self.joined_to.push(number);
        let edge = Edge {
            role,
            is_left,
            gone: Vec::new(),
            is_exact: true,
            number,
        };
        self.edges.insert(key, edge);
    }

    /// Returns a copy of the edges, with another tolerance.
    pub(super) fn with_tolerance(&self, tolerance: f64) -> Self {
        Lines {
            tolerance,
            ..self.clone()
        }
    }

    /// Returns true if an edge is at the rim, and the surface is right of it.
    pub(super) fn is_surface_right_of(&self, ends: [u32; 2]) -> bool {
        let edge = self.edges.get(&ordered(ends));
        edge.is_some_and(|edge| edge.role.is_rim && edge.is_left != (ends[0] < ends[1]))
    }

    /// The number of sites on lines.
    pub(super) fn vertices_on_lines(&self) -> usize {
        let of_lines = self
            .edges
            .iter()
            .filter(|(_, edge)| edge.role.kind.is_constrained());
        let sites: FxHashSet<u32> = of_lines.flat_map(|(ends, _)| *ends).collect();
        sites.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.edges.is_empty()
    }

    /// The edges in the order of their ends, so that the result does not depend on hashes.
    pub(super) fn sorted(&self) -> Vec<([u32; 2], &Edge)> {
        let mut edges: Vec<_> = self
            .edges
            .iter()
            .map(|(ends, edge)| (*ends, edge))
            .collect();
        edges.sort_unstable_by_key(|(ends, _)| *ends);
        edges
    }

    /// The sites on edges, in the order of their numbers.
    pub(super) fn sites(&self) -> Vec<u32> {
        let mut sites: Vec<u32> = self.edges.keys().flatten().copied().collect();
        sites.sort_unstable();
        sites.dedup();
        sites
    }

    /// The two edges at a vertex that would become one.
    fn both(&self, vertex: u32, [a, b]: [u32; 2]) -> Option<[&Edge; 2]> {
        let of = |end: u32| self.edges.get(&ordered([vertex, end]));
        Some([of(a)?, of(b)?])
    }

    /// Returns true if a site was removed from one of the two edges at a vertex.
    pub(super) fn is_gone_between(&self, site: u32, vertex: u32, ends: [u32; 2]) -> bool {
        let Some(from) = self.removed_from.get(&site) else {
            return false;
        };
        let from = self.last_joined(*from);
        self.both(vertex, ends).is_some_and(|both| {
            both.iter()
                .any(|edge| self.last_joined(edge.number) == from)
        })
    }

    /// The number of the edge that an edge is part of now. Of two that are joined, the one with
    /// more sites keeps its number, so that few steps lead there.
    fn last_joined(&self, mut number: u32) -> u32 {
        while self.joined_to[number as usize] != number {
            number = self.joined_to[number as usize];
        }
        number
    }

    /// Returns whether and how the two edges at a vertex may become one: of one role, and with all
    /// vertices of the line near enough to it. The rim stays where it is: it loses only vertices
    /// that are exactly on it.
    pub(super) fn joint(
        &self,
        vertex: u32,
        ends: [u32; 2],
        plan: &dyn Fn(u32) -> [f64; 2],
    ) -> Option<Joint> {
        let [first, second] = self.both(vertex, ends)?;
        if first.role != second.role || self.edges.contains_key(&ordered(ends)) {
            return None;
        }
        let [a, b] = ends.map(plan);
        let q = plan(vertex);
        // What was exactly on both is then exactly on one line with both ends.
        let is_exact = first.is_exact
            && second.is_exact
            && Adaptive::sign(&Orientation2([a, b, q])) == Sign::Zero
            && Adaptive::sign(&DotProduct([a, q, b])) == Sign::Negative;
        if is_exact {
            return Some(Joint::Exact);
        }
        if first.role.is_rim || self.tolerance == 0.0 {
            return None;
        }
        let is_near = |site: &u32| distance_to_segment(plan(*site), [a, b]) <= self.tolerance;
        let all = [vertex];
        let mut all = all.iter().chain(&first.gone).chain(&second.gone);
        all.all(is_near).then_some(Joint::Near)
    }

    /// Joins the two edges at a vertex, which may be joined in this way.
    pub(super) fn join(&mut self, vertex: u32, [a, b]: [u32; 2], joint: Joint) {
        let first = self.edges.remove(&ordered([vertex, a]));
        let second = self.edges.remove(&ordered([vertex, b]));
        if let (Some(mut edge), Some(mut second)) = (first, second) {
            // Seen from `a`, the surface stays on its side.
            let is_left_of_ab = edge.is_left == (a < vertex);
            edge.is_left = is_left_of_ab == (a < b);
            edge.is_exact = joint == Joint::Exact;
            if edge.gone.len() < second.gone.len() {
                std::mem::swap(&mut edge.gone, &mut second.gone);
                std::mem::swap(&mut edge.number, &mut second.number);
            }
            self.joined_to[second.number as usize] = edge.number;
            edge.gone.extend(second.gone);
            edge.gone.push(vertex);
            self.removed_from.insert(vertex, edge.number);
            self.edges.insert(ordered([a, b]), edge);
        }
    }
}
