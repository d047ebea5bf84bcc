//! What is left out at the rim, where each task has only some of the triangles.

use rustc_hash::FxHashMap;

use super::{Residual, TileTriangle, TileVertex};
use crate::terrain::RimRule;
use crate::terrain::groups::Groups;
use crate::triangulation::tds::{ccw, cw};

/// The ends of an edge by their tiles and numbers, the same from both sides.
pub type EdgeKey = [u64; 2];

/// The triangles of a task that the rule of the rim may remove.
///
/// A triangle is removed if it can be reached from outside over edges that are
/// [open](RimRule) to the triangles behind them, and not on lines. So one without such an edge
/// stays whatever the others are. The others wait: those that a task has are joined to *groups*
/// over edges that are open from both sides; groups are removed or stay together. At their other
/// edges, the *gates*, groups meet others, also those of other tasks, the outside, or a triangle
/// that stays. When all tasks are done, [`Rim`] decides.
#[derive(Debug, Clone, Default)]
pub struct AtRim {
    rule: RimRule,
    triangles: Vec<TileTriangle>,
    /// What is on one side of each edge whose other side was not seen yet.
    unmatched: FxHashMap<EdgeKey, GateSide>,
    /// Edges that were seen from both sides, but are not open from both.
    gates: Vec<(EdgeKey, GateSide)>,
    /// A union-find structure over the triangles.
    groups: Groups,
}

/// The triangles of a task that wait for a decision.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Waiting {
    /// The triangles.
    pub triangles: Vec<TileTriangle>,
    /// The number of the group of each triangle.
    pub group_of: Vec<u32>,
    /// The edges at which groups meet something else, or the outside begins.
    pub gates: Vec<Gate>,
    /// The number of groups.
    pub groups: u32,
}

/// An edge of a group, or of the outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gate {
    /// The edge.
    pub edge: EdgeKey,
    /// What is on this side of it.
    pub side: GateSide,
}

/// What is on one side of an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum GateSide {
    /// The outside.
    Outside,
    /// A group of the task, by its number, to which the edge is open.
    Open(u32),
    /// A group of the task, by its number, to which the edge is not open.
    Closed(u32),
}

impl GateSide {
    fn of(group: u32, is_open: bool) -> Self {
        if is_open {
            GateSide::Open(group)
        } else {
            GateSide::Closed(group)
        }
    }

    /// Returns the same for another number of the group.
    fn renumbered(self, number: impl Fn(u32) -> u32) -> Self {
        match self {
            GateSide::Outside => self,
            GateSide::Open(group) => GateSide::Open(number(group)),
            GateSide::Closed(group) => GateSide::Closed(number(group)),
        }
    }
}

/// Returns true if a triangle has an edge longer than a limit that is not on a line.
pub fn has_long_edge(triangle: &TileTriangle, limit: f64) -> bool {
    has_open_edge(triangle, RimRule::longest(Some(limit)))
}

fn has_open_edge(triangle: &TileTriangle, rule: RimRule) -> bool {
    let corners = triangle.corners.map(|corner| corner.position);
    (0..3).any(|i| rule.is_open(&corners, i) && !triangle.edges[i].is_constrained())
}

impl AtRim {
    /// Creates a collection for a rule.
    pub fn new(rule: RimRule) -> Self {
        AtRim {
            rule,
            ..AtRim::default()
        }
    }

    /// Returns true if a triangle has to wait; it is then kept here.
    pub fn take(&mut self, triangle: &TileTriangle) -> bool {
        if !has_open_edge(triangle, self.rule) {
            return false;
        }
        let corners = triangle.corners.map(|corner| corner.position);
        let number = self.groups.add();
        self.triangles.push(*triangle);
        for i in (0..3).filter(|&i| !triangle.edges[i].is_constrained()) {
            let side = GateSide::of(number, self.rule.is_open(&corners, i));
            self.add(edge_of(triangle, i), side);
        }
        true
    }

    /// Adds a triangle that is not part of the surface, as one of the outside.
    pub fn add_outside(&mut self, triangle: &TileTriangle) {
        (0..3).for_each(|i| self.add(edge_of(triangle, i), GateSide::Outside));
    }

    fn add(&mut self, edge: EdgeKey, side: GateSide) {
        use GateSide::{Closed, Open, Outside};
        let Some(other) = other_side(&mut self.unmatched, edge, side) else {
            return;
        };
        match (side, other) {
            (Open(group), Open(other)) => self.groups.join(group, other),
            // Nothing passes.
            (Outside | Closed(_), Outside | Closed(_)) => {}
            _ => self.gates.extend([(edge, side), (edge, other)]),
        }
    }

    /// Returns all triangles that were taken, in the order in which they came.
    pub fn finish(mut self) -> Waiting {
        let mut number_of = vec![u32::MAX; self.triangles.len()];
        let mut groups = 0;
        let mut group_of = Vec::with_capacity(self.triangles.len());
        for triangle in 0..self.triangles.len() as u32 {
            let number = &mut number_of[self.groups.find(triangle) as usize];
            if *number == u32::MAX {
                *number = groups;
                groups += 1;
            }
            group_of.push(*number);
        }
        let mut gates: Vec<Gate> = self
            .unmatched
            .into_iter()
            .chain(self.gates)
            .map(|(edge, side)| Gate {
                edge,
                side: side.renumbered(|triangle| group_of[triangle as usize]),
            })
            .collect();
        gates.sort_unstable_by_key(|gate| (gate.edge, gate.side));
        Waiting {
            triangles: self.triangles,
            group_of,
            gates,
            groups,
        }
    }
}

/// Returns what was seen on the other side of an edge, which is then forgotten; `None` if nothing
/// was, and this side is then kept.
fn other_side(
    unmatched: &mut FxHashMap<EdgeKey, GateSide>,
    edge: EdgeKey,
    side: GateSide,
) -> Option<GateSide> {
    let other = unmatched.remove(&edge);
    if other.is_none() {
        unmatched.insert(edge, side);
    }
    other
}

fn edge_of(triangle: &TileTriangle, i: usize) -> EdgeKey {
    edge_key(triangle.corners[ccw(i)], triangle.corners[cw(i)])
}

fn edge_key(a: TileVertex, b: TileVertex) -> EdgeKey {
    let [a, b] = [a.key(), b.key()];
    [a.min(b), a.max(b)]
}

/// Decides which groups are removed at the rim, once all tasks have added theirs. Memory is needed
/// for the groups and the gates.
#[derive(Debug, Clone, Default)]
pub struct Rim {
    /// The first group of each task.
    first_of: Vec<u32>,
    /// The groups that are removed or stay together.
    groups: Groups,
    /// What is on one side of each gate whose other side was not seen yet.
    unmatched: FxHashMap<EdgeKey, GateSide>,
    /// Pairs of groups: the second is removed if the first is.
    passages: Vec<[u32; 2]>,
    /// Groups that the outside reaches.
    reached: Vec<u32>,
}

impl Rim {
    /// Adds the groups of the next task.
    ///
    /// # Complexity
    /// Linear, up to a factor that is nearly constant.
    pub fn add(&mut self, groups: u32, gates: &[Gate]) {
        let first = self.groups.count() as u32;
        self.first_of.push(first);
        (0..groups).for_each(|_| _ = self.groups.add());
        for Gate { edge, side } in gates {
            self.add_side(*edge, side.renumbered(|group| first + group));
        }
    }

    /// Adds the outside of all tasks: the residual of the root.
    pub fn add_outside(&mut self, root: &Residual) {
        for [a, b] in root.hull() {
            self.add_side(edge_key(a, b), GateSide::Outside);
        }
    }

    fn add_side(&mut self, edge: EdgeKey, side: GateSide) {
        use GateSide::{Closed, Open, Outside};
        let Some(other) = other_side(&mut self.unmatched, edge, side) else {
            return;
        };
        match (side, other) {
            (Open(group), Open(other)) => self.groups.join(group, other),
            (Closed(from), Open(to)) | (Open(to), Closed(from)) => self.passages.push([from, to]),
            (Outside, Open(group)) | (Open(group), Outside) => self.reached.push(group),
            (Outside | Closed(_), Outside | Closed(_)) => {}
        }
    }

    /// Returns, for each task in the order in which they were added, and for each of its groups,
    /// true if the group is removed.
    ///
    /// # Complexity
    /// O(n log n) in the number of gates, and nearly linear in that of groups.
    pub fn removed(mut self) -> Vec<Vec<bool>> {
        let groups = &mut self.groups;
        let mut passages: Vec<[u32; 2]> = self
            .passages
            .iter()
            .map(|passage| passage.map(|group| groups.find(group)))
            .collect();
        passages.sort_unstable();
        let mut ahead: Vec<u32> = self
            .reached
            .iter()
            .map(|&group| groups.find(group))
            .collect();
        let mut is_removed = vec![false; groups.count()];
        while let Some(group) = ahead.pop() {
            if std::mem::replace(&mut is_removed[group as usize], true) {
                continue;
            }
            let first = passages.partition_point(|[from, _]| *from < group);
            let onward = passages[first..]
                .iter()
                .take_while(|[from, _]| *from == group);
            ahead.extend(onward.map(|[_, to]| *to));
        }
        let ends = self
            .first_of
            .iter()
            .skip(1)
            .copied()
            .chain([groups.count() as u32]);
        let ranges: Vec<_> = self.first_of.iter().copied().zip(ends).collect();
        let mut of_task = |(first, end)| {
            (first..end)
                .map(|group| is_removed[groups.find(group) as usize])
                .collect()
        };
        ranges.into_iter().map(&mut of_task).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{EdgeKind, Surface};
    use crate::terrain::tiles::ResidualEdge;
    use crate::terrain::{Tin, TinBuilder};
    use testkit::random::Random;

    /// The triangles of a TIN, with vertices of different tiles.
    fn triangles(tin: &Tin) -> Vec<(u32, TileTriangle)> {
        let vertex = |v: u32| TileVertex {
            tile: v % 3,
            number: v,
            position: tin.position(v),
            is_tight: false,
        };
        let of = |face: u32| {
            let corners = tin.face(face)?.map(vertex);
            let edges = [0, 1, 2].map(|i| match tin.edge_kind(face, i) {
                EdgeKind::Rim => EdgeKind::Plain,
                kind => kind,
            });
            Some((face, TileTriangle { corners, edges }))
        };
        (0..tin.face_count() as u32).filter_map(of).collect()
    }

    /// The residual of a root that has found these triangles: the edges with one triangle.
    fn hull(tin: &Tin) -> Residual {
        let mut rest = Residual::default();
        let mut sides: FxHashMap<EdgeKey, Vec<[TileVertex; 2]>> = FxHashMap::default();
        for (_, triangle) in triangles(tin) {
            for i in 0..3 {
                let ends = [ccw(i), cw(i)].map(|k| triangle.corners[k]);
                sides.entry(edge_of(&triangle, i)).or_default().push(ends);
            }
        }
        for ends in sides
            .into_values()
            .filter(|sides| sides.len() == 1)
            .flatten()
        {
            let first = rest.vertices.len() as u32;
            rest.vertices.extend(ends);
            rest.edges.push(ResidualEdge {
                ends: [first, first + 1],
                is_seam: true,
                kind: EdgeKind::Plain,
            });
        }
        rest
    }

    /// Random points and lines on a grid, triangles in tasks at random: what is removed is what a
    /// TIN in one piece leaves out.
    #[test]
    fn tasks_remove_what_the_whole_leaves_out() {
        let mut random = Random(23);
        let mut removed_in_all = 0;
        for round in 0..200 {
            let mut builder = TinBuilder::default();
            let side = 12;
            let mut coordinate = || random.below(side) as f64;
            let points: Vec<[f64; 3]> = (0..8 + round % 40)
                .map(|_| [coordinate(), coordinate(), 0.0])
                .collect();
            builder.add_owned_points(points);
            for _ in 0..round % 4 {
                builder.add_breakline(&[
                    [coordinate(), coordinate(), 0.0],
                    [coordinate(), coordinate(), 0.0],
                ]);
            }
            let rule = RimRule {
                max_edge: [None, Some(2.0), Some(3.0), Some(4.5)][round % 4],
                opens_caps: round % 3 != 0,
            };
            let Ok(whole) = builder.clone().build() else {
                continue;
            };
            (builder.max_edge, builder.leave_out_caps) = (rule.max_edge, rule.opens_caps);
            let peeled = builder.build().unwrap();

            let tasks = 1 + round % 5;
            let mut parts: Vec<(AtRim, Vec<u32>)> = vec![(AtRim::new(rule), Vec::new()); tasks];
            let mut kept: Vec<u32> = Vec::new();
            for (face, triangle) in triangles(&whole) {
                let (at_rim, faces) = &mut parts[random.index(tasks)];
                let waits = at_rim.take(&triangle);
                (if waits { faces } else { &mut kept }).push(face);
            }
            let mut rim = Rim::default();
            let parts: Vec<(Waiting, Vec<u32>)> = parts
                .into_iter()
                .map(|(at_rim, faces)| (at_rim.finish(), faces))
                .collect();
            parts
                .iter()
                .for_each(|(waiting, _)| rim.add(waiting.groups, &waiting.gates));
            rim.add_outside(&hull(&whole));
            for (is_removed, (waiting, faces)) in rim.removed().iter().zip(&parts) {
                assert_eq!(waiting.triangles.len(), faces.len());
                let stay = faces
                    .iter()
                    .zip(&waiting.group_of)
                    .filter(|(_, group)| !is_removed[**group as usize]);
                kept.extend(stay.map(|(face, _)| *face));
            }
            kept.sort_unstable();
            let expected: Vec<u32> = triangles(&peeled)
                .into_iter()
                .map(|(face, _)| face)
                .collect();
            assert_eq!(kept, expected, "round {round}");
            removed_in_all += peeled.report().faces_beyond_max_edge;
        }
        assert!(removed_in_all > 500, "{removed_in_all}");
    }
}
