//! A new arrangement of all lines.
//!
//! The arrangement of the lines is a function of their set, and so is the triangulation of vertices
//! and sub-constraints. All lines are arranged, the result is compared with the current state, and
//! the difference is carried out.

use std::cmp::Reverse;
use std::collections::{HashMap, HashSet};

use rustc_hash::FxHashMap;

use crate::arrangement::Arrangement;
use crate::geometry::{Coordinates, Crossing};
use crate::num::unsigned_zero;
use crate::tds::VertexId;

use super::constrained_delaunay::ConstrainedDelaunay;
use crate::bulk::{Grain, spatial_order};
use crate::locate::Dice;

use super::build::points_added;
use super::chains::{segments_of, undirected};
use super::on_crossing::Rounding;

/// What the lines demand: segments between given vertices.
struct LinesDemand {
    /// The given vertices, in order.
    given: Vec<VertexId>,
    /// The coordinates of each given vertex.
    positions: Vec<[f64; 2]>,
    /// The segments; each end is an index into `given`.
    segments: Vec<[u32; 2]>,
}

/// A constrained edge between two sites: a part of a segment.
type SubConstraint = [VertexId; 2];

impl<G: Crossing + Coordinates<3>, V: Default, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    /// Arranges all lines anew, and carries out the difference to the current state.
    pub(super) fn rearrange(&mut self) {
        self.lines.index.take();
        self.lines.rearrangements += 1;
        let used: HashSet<VertexId> = self.lines.chains.each().flatten().copied().collect();
        let leaving: HashSet<VertexId> = self
            .lines
            .owned
            .iter()
            .filter(|v| !used.contains(v))
            .collect();
        let demand = self.demand(&leaving);
        if self.dimension() < 2 {
            self.lines.waiting = demand
                .segments
                .iter()
                .map(|ends| ends.map(|i| demand.given[i as usize]))
                .collect();
            // The vertices that bend or split them may be removed.
            self.lines.chains.bent.clear();
            self.lines.chains.splits.clear();
            self.lines.rounding = None;
            self.lines.recrossed = false;
            self.lines.missing.clear();
            self.take_out(leaving);
            self.lines.touch();
            return;
        }
        self.lines.waiting.clear();
        let position = |i: u32| demand.positions[i as usize];
        let step = self.inner.geometry.step();
        let arrangement = Arrangement::new(demand.given.len(), position, &demand.segments, step);
        self.lines.missing = self.carry_out(&arrangement, &demand, leaving);
        self.lines.recrossed = !self.lines.missing.is_empty();
        if self.lines.recrossed {
            let arrangement = arrangement.crossing_free(position, &demand.segments, step);
            self.lines.missing = self.carry_out(&arrangement, &demand, HashSet::new());
        }
    }

    /// Removes vertices that no line needs.
    fn take_out(&mut self, leaving: HashSet<VertexId>) {
        let mut leaving: Vec<VertexId> = leaving.into_iter().collect();
        leaving.sort_unstable();
        for vertex in leaving {
            self.lines.owned.remove(vertex);
            self.lines.remove_free(&mut self.inner, vertex);
        }
    }

    /// Returns what the lines demand, without the vertices that leave.
    fn demand(&self, leaving: &HashSet<VertexId>) -> LinesDemand {
        let is_given = |v: &VertexId| !self.is_added(*v) && !leaving.contains(v);
        let given: Vec<VertexId> = self.tds().vertices().filter(is_given).collect();
        let number = |v: VertexId| given.partition_point(|&other| other < v) as u32;
        let segments = segments_of(self.lines.chains.each(), number);
        let positions = given.iter().map(|&v| self.plan_of(v)).collect();
        LinesDemand {
            given,
            positions,
            segments,
        }
    }

    /// Makes the triangulation that of an arrangement of what the lines demand, without the
    /// vertices that leave. Returns the sub-constraints that cross others.
    fn carry_out(
        &mut self,
        arrangement: &Arrangement,
        demand: &LinesDemand,
        mut leaving: HashSet<VertexId>,
    ) -> Vec<SubConstraint> {
        let LinesDemand {
            given, segments, ..
        } = demand;
        // Phase 1: sites that stay keep their vertices, other added vertices leave.
        let mut vertex_at: HashMap<[u64; 2], VertexId> = self
            .lines
            .added
            .iter()
            .map(|v| (key(self.plan_of(v)), v))
            .collect();
        let mut sites: Vec<Option<VertexId>> = given.iter().copied().map(Some).collect();
        sites.extend(
            arrangement
                .added()
                .iter()
                .map(|&position| vertex_at.remove(&key(position))),
        );
        leaving.extend(vertex_at.into_values());

        // Phase 2: which sub-constraints exist already.
        let (kept, splits) = self.kept_parts(arrangement, segments, &sites, &leaving);

        // Phase 3: the others are released, and vertices removed.
        let constrained: Vec<SubConstraint> = self.constrained_edges().collect();
        for [a, b] in constrained.into_iter().filter(|edge| !kept.contains(edge)) {
            self.lines.release(&mut self.inner, a, b);
        }
        self.lines.chains.splits = splits;
        leaving.iter().for_each(|&v| _ = self.lines.added.remove(v));
        self.take_out(leaving);

        // Phase 4: new sites and sub-constraints are inserted.
        self.insert_sites(arrangement, demand, &mut sites);
        let sites: Vec<VertexId> = sites.into_iter().flatten().collect(); // all are known now
        let parts = self
            .lines
            .chains
            .record(arrangement, segments, |site| sites[site as usize]);
        self.lines.rounding = Rounding::of(arrangement);
        let crossing = self.constrain_all(parts, Grain::default());
        self.lines.chains.drop_stray_splits();
        self.lines.touch();
        crossing
    }

    /// Returns the edges of chains that are constrained already and stay, and the splits among
    /// them.
    fn kept_parts(
        &self,
        arrangement: &Arrangement,
        segments: &[[u32; 2]],
        sites: &[Option<VertexId>],
        leaving: &HashSet<VertexId>,
    ) -> (HashSet<SubConstraint>, FxHashMap<SubConstraint, VertexId>) {
        let mut splits = FxHashMap::default();
        let mut kept = HashSet::new();
        let mut chain = Vec::new();
        for (i, &[a, b]) in (0..).zip(segments) {
            let mut from = sites[a as usize];
            for &site in arrangement.chain(i).iter().chain([&b]) {
                let to = sites[site as usize];
                let ends = from.zip(to);
                from = to;
                let Some((from, to)) = ends else { continue };
                chain.clear();
                chain.push(from);
                self.lines.chains.walk_part(from, to, &mut chain);
                let is_there = chain
                    .windows(2)
                    .all(|edge| self.inner.has_constraint(edge[0], edge[1]));
                if is_there && !chain.iter().any(|v| leaving.contains(v)) {
                    kept.extend(chain.windows(2).map(|edge| undirected(edge[0], edge[1])));
                    self.lines.chains.copy_splits(from, to, &mut splits);
                }
            }
        }
        (kept, splits)
    }

    /// Inserts the added sites that have no vertex yet; those that have one get its new point.
    fn insert_sites(
        &mut self,
        arrangement: &Arrangement,
        demand: &LinesDemand,
        sites: &mut [Option<VertexId>],
    ) {
        let LinesDemand {
            given, segments, ..
        } = demand;
        let added = points_added(&self.inner.geometry, arrangement, segments, |i| {
            *self.point(given[i as usize])
        });
        let mut near = None;
        for i in order_of_insertion(&self.inner.geometry, &added) {
            let (site, p) = (&mut sites[given.len() + i as usize], added[i as usize]);
            match *site {
                Some(vertex) => {
                    self.replace_point(vertex, p);
                }
                None => {
                    let count = self.vertex_count();
                    let vertex = self.lines.insert_point(&mut self.inner, p, near);
                    if self.vertex_count() > count {
                        self.lines.added.insert(vertex);
                    }
                    *site = Some(vertex);
                    near = self.tds().cell_of(vertex);
                }
            }
        }
    }

    pub(crate) fn plan_of(&self, vertex: VertexId) -> [f64; 2] {
        self.inner.geometry.plan(self.point(vertex))
    }
}

/// Returns the order in which to insert points one by one. A few keep their order. Many are
/// inserted in random rounds, each about twice as large as the one before and in spatial order:
/// then O(n log n) triangles are expected to be created and destroyed, wherever the points lie
/// (Amenta, Choi and Rote 2003).
pub(super) fn order_of_insertion<G: Coordinates<3>>(geometry: &G, points: &[G::Point]) -> Vec<u32> {
    const FEW: usize = 256;
    if points.len() <= FEW {
        return (0..points.len() as u32).collect();
    }
    let Ok(mut order) = spatial_order(points.len(), |i| geometry.coordinates(&points[i])) else {
        return (0..points.len() as u32).collect(); // more than can be numbered
    };
    let mut dice = Dice::default();
    let mut rounds = vec![0; points.len()];
    // Points on one site are consecutive; the first of them stays the first.
    for here in order.chunk_by(|&i, &j| {
        geometry
            .compare(&points[i as usize], &points[j as usize])
            .is_eq()
    }) {
        let round = (1 << 16 | dice.below(1 << 16)).trailing_zeros();
        here.iter().for_each(|&i| rounds[i as usize] = round);
    }
    order.sort_by_key(|&i| Reverse(rounds[i as usize]));
    order
}

/// Returns a key that is equal for equal sites: negative zeros become positive.
fn key(position: [f64; 2]) -> [u64; 2] {
    position.map(|x| unsigned_zero(x).to_bits())
}
