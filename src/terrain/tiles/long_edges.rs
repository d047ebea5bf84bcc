//! The longest edge at the rim, for triangles that no task has all of.

use rustc_hash::FxHashMap;

use super::{TileTriangle, TileVertex};
use crate::terrain::groups::Groups;
use crate::terrain::linear::plan_distance;
use crate::triangulation::tds::{ccw, cw};

/// The ends of an edge by their tiles and numbers, the same from both sides.
pub type EdgeKey = [u64; 2];

/// The triangles of a task that a longest edge at the rim may remove.
///
/// A triangle is removed if it can be reached from outside over long edges that are not on lines.
/// So one without such an edge stays whatever the others are. The others wait: those that a task
/// has are joined over their long edges to *groups*, which are removed or stay together. Groups of
/// different tasks meet at the edges that only one of their triangles has, the *gates*. When all
/// tasks are done, [`Rim`] decides.
#[derive(Debug, Clone, Default)]
pub struct LongEdges {
    limit: f64,
    triangles: Vec<TileTriangle>,
    /// The triangle on one side of each long edge whose other side was not seen yet.
    open: FxHashMap<EdgeKey, u32>,
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
    /// The edges at which groups continue in other tasks, or end at the hull.
    pub gates: Vec<Gate>,
    /// The number of groups.
    pub groups: u32,
}

/// A long edge of a group whose other side is not in the same task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gate {
    /// The edge.
    pub edge: EdgeKey,
    /// The number of the group in its task.
    pub group: u32,
}

/// Returns true if a triangle has an edge longer than a limit that is not on a line.
pub fn has_long_edge(triangle: &TileTriangle, limit: f64) -> bool {
    let corners = triangle.corners.map(|corner| corner.position);
    (0..3).any(|i| is_long(triangle, &corners, i, limit))
}

fn is_long(triangle: &TileTriangle, corners: &[[f64; 3]; 3], i: usize, limit: f64) -> bool {
    // PERF: `hypot` takes longer than the rest, and nearly all edges are short.
    let [dx, dy] = [0, 1].map(|k| (corners[ccw(i)][k] - corners[cw(i)][k]).abs());
    dx + dy > limit
        && plan_distance(corners[ccw(i)], corners[cw(i)]) > limit
        && !triangle.edges[i].is_constrained()
}

impl LongEdges {
    /// Creates a collection for a longest edge.
    pub fn new(limit: f64) -> Self {
        LongEdges {
            limit,
            ..LongEdges::default()
        }
    }

    /// Returns true if a triangle has to wait; it is then kept here.
    pub fn take(&mut self, triangle: &TileTriangle) -> bool {
        let corners = triangle.corners.map(|corner| corner.position);
        let mut number = None;
        for i in (0..3).filter(|&i| is_long(triangle, &corners, i, self.limit)) {
            let number = *number.get_or_insert_with(|| {
                self.triangles.push(*triangle);
                self.groups.add()
            });
            let key = edge_key(triangle.corners[ccw(i)], triangle.corners[cw(i)]);
            match self.open.remove(&key) {
                Some(other) => self.groups.join(number, other),
                None => _ = self.open.insert(key, number),
            }
        }
        number.is_some()
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
        let gate = |(edge, triangle): (EdgeKey, u32)| Gate {
            edge,
            group: group_of[triangle as usize],
        };
        let mut gates: Vec<Gate> = self.open.into_iter().map(gate).collect();
        gates.sort_unstable_by_key(|gate| gate.edge);
        Waiting {
            triangles: self.triangles,
            group_of,
            gates,
            groups,
        }
    }
}

fn edge_key(a: TileVertex, b: TileVertex) -> EdgeKey {
    let [a, b] = [a, b].map(|vertex| u64::from(vertex.tile) << 32 | u64::from(vertex.number));
    [a.min(b), a.max(b)]
}

/// Decides which groups of long edges are at the rim, once all tasks have added theirs. Memory is
/// needed for the groups and the gates.
#[derive(Debug, Clone, Default)]
pub struct Rim {
    /// The first group of each task.
    first_of: Vec<u32>,
    groups: Groups,
    open: FxHashMap<EdgeKey, u32>,
}

impl Rim {
    /// Adds the groups of the next task. Linear, up to a factor that is nearly constant.
    pub fn add(&mut self, groups: u32, gates: &[Gate]) {
        let first = self.groups.count() as u32;
        self.first_of.push(first);
        (0..groups).for_each(|_| _ = self.groups.add());
        for gate in gates {
            match self.open.remove(&gate.edge) {
                Some(other) => self.groups.join(first + gate.group, other),
                None => _ = self.open.insert(gate.edge, first + gate.group),
            }
        }
    }

    /// Returns, for each task in the order in which they were added, and for each of its groups,
    /// true if the group is removed: an edge of it has nothing on its other side.
    pub fn removed(mut self) -> Vec<Vec<bool>> {
        let mut is_removed = vec![false; self.groups.count()];
        for group in self.open.into_values() {
            is_removed[self.groups.find(group) as usize] = true;
        }
        let ends = self
            .first_of
            .iter()
            .skip(1)
            .copied()
            .chain([self.groups.count() as u32]);
        let ranges: Vec<_> = self.first_of.iter().copied().zip(ends).collect();
        let mut of_task = |(first, end)| {
            (first..end)
                .map(|group| is_removed[self.groups.find(group) as usize])
                .collect()
        };
        ranges.into_iter().map(&mut of_task).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{EdgeKind, Surface};
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
            let limit = [2.0, 3.0, 4.5][round % 3];
            let Ok(whole) = builder.clone().build() else {
                continue;
            };
            builder.max_edge = Some(limit);
            let peeled = builder.build().unwrap();

            let tasks = 1 + round % 5;
            let mut parts: Vec<(LongEdges, Vec<u32>)> =
                vec![(LongEdges::new(limit), Vec::new()); tasks];
            let mut kept: Vec<u32> = Vec::new();
            for (face, triangle) in triangles(&whole) {
                let (long, faces) = &mut parts[random.index(tasks)];
                let has_long = has_long_edge(&triangle, limit);
                assert_eq!(long.take(&triangle), has_long);
                (if has_long { faces } else { &mut kept }).push(face);
            }
            let mut rim = Rim::default();
            let parts: Vec<(Waiting, Vec<u32>)> = parts
                .into_iter()
                .map(|(long, faces)| (long.finish(), faces))
                .collect();
            parts
                .iter()
                .for_each(|(waiting, _)| rim.add(waiting.groups, &waiting.gates));
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
