//! Where constrained edges are split: in the middle, or on concentric circles around small angles.
//!
//! Where two constraints meet at a small angle, the middle of one may be too near to the other,
//! which is split in turn, and so on without end. If constraints are split at distances from the
//! apex that are powers of two apart, the sub-constraints of both end on common circles, and no
//! vertex encroaches upon a sub-constraint of the other (Ruppert 1995, section 5; Shewchuk 2002,
//! section 4).

use rustc_hash::FxHashMap;

use crate::geometry::Crossing;
use crate::lines::ConstrainedDelaunay;
use crate::num::Sign;
use crate::tds::VertexId;

use super::shape::{dot, length, minus};

/// Clusters of constraints, and the radii of their circles.
///
/// Around each vertex, constraints that follow each other at less than 60 degrees form a cluster,
/// which shares its circles. One circle has as its radius the shortest edge of the cluster at its
/// apex.
///
/// The clusters of a vertex are searched for before the first of its constraints is split.
#[derive(Debug, Default)]
pub(super) struct Shells {
    /// For each original vertex: true if its clusters have been searched for.
    is_known: Vec<bool>,
    /// The cluster by apex and other end of a constrained edge, as the edges were originally.
    cluster: FxHashMap<[VertexId; 2], u32>,
    /// The radius of each cluster.
    radius: Vec<f64>,
    /// The other ends of the constraints of the vertex at hand; kept for its memory.
    ends: Vec<VertexId>,
}

impl Shells {
    /// Returns the shells of a triangulation in which nothing has been split.
    pub(super) fn new(vertex_slots: usize) -> Self {
        Shells {
            is_known: vec![false; vertex_slots],
            ..Shells::default()
        }
    }

    /// Finds the clusters at both ends of a constraint that is about to be split for the first
    /// time.
    pub(super) fn learn<G: Crossing, V: Default>(
        &mut self,
        t: &ConstrainedDelaunay<G, V>,
        constraint: [VertexId; 2],
    ) {
        for apex in constraint {
            if !std::mem::replace(&mut self.is_known[apex.index()], true) {
                let mut ends = std::mem::take(&mut self.ends);
                ends.extend(t.constrained_around(apex));
                self.add(t, apex, &ends);
                ends.clear();
                self.ends = ends;
            }
        }
    }

    /// Adds the clusters of a vertex, given the other ends of its constraints counter-clockwise.
    fn add<G: Crossing, V: Default>(
        &mut self,
        t: &ConstrainedDelaunay<G, V>,
        apex: VertexId,
        ends: &[VertexId],
    ) {
        let count = ends.len();
        if count < 2 {
            return;
        }
        let is_narrow =
            |k: usize| is_below_60_degrees(t, ends[k % count], apex, ends[(k + 1) % count]);
        // Begin behind a gap, if there is one.
        let first = (0..count).find(|&k| !is_narrow(k)).map_or(0, |k| k + 1);
        let mut k = first;
        while k < first + count {
            let mut last = k;
            while last + 1 < first + count && is_narrow(last) {
                last += 1;
            }
            if last > k {
                let cluster = (k..=last).map(|k| ends[k % count]);
                let vectors = cluster
                    .clone()
                    .map(|end| minus(t.plan_of(end), t.plan_of(apex)));
                let radius = vectors.map(length).fold(f64::INFINITY, f64::min);
                let number = self.radius.len() as u32;
                self.radius.push(radius);
                self.cluster
                    .extend(cluster.map(|end| ([apex, end], number)));
            }
            k = last + 1;
        }
    }

    /// Returns the cluster of an original constraint at one of its ends; `None` at other vertices
    /// on it.
    fn cluster_at(&self, end: VertexId, constraint: [VertexId; 2]) -> Option<usize> {
        let other = match constraint {
            [p, q] if p == end => q,
            [p, q] if q == end => p,
            _ => return None,
        };
        self.cluster
            .get(&[end, other])
            .map(|&cluster| cluster as usize)
    }

    /// Returns true if a constraint meets another one at a small angle at one of its ends.
    pub(super) fn is_in_cluster(&self, constraint: [VertexId; 2]) -> bool {
        constraint
            .into_iter()
            .any(|end| self.cluster_at(end, constraint).is_some())
    }

    /// Returns where to split a sub-constraint from `a` to `b`, as a fraction between 1/3 and 2/3
    /// of its length.
    pub(super) fn fraction(
        &mut self,
        [a, b]: [VertexId; 2],
        constraint: [VertexId; 2],
        length: f64,
    ) -> f64 {
        let clusters = [a, b].map(|end| self.cluster_at(end, constraint));
        let fraction = match clusters {
            [Some(at_a), None] => nearest_to_middle(self.radius[at_a], length),
            [None, Some(at_b)] => 1.0 - nearest_to_middle(self.radius[at_b], length),
            _ => 0.5,
        };
        for (cluster, part) in clusters.into_iter().zip([fraction, 1.0 - fraction]) {
            if let Some(cluster) = cluster {
                self.radius[cluster] = self.radius[cluster].min(part * length);
            }
        }
        fraction
    }
}

/// Returns the fraction of a length at which a power of two times the radius is nearest to the
/// middle.
fn nearest_to_middle(radius: f64, length: f64) -> f64 {
    let mut fraction = radius / length;
    if !fraction.is_normal() {
        return 0.5;
    }
    while fraction <= 1.0 / 3.0 {
        fraction *= 2.0;
    }
    while fraction > 2.0 / 3.0 {
        fraction /= 2.0;
    }
    fraction
}

/// Returns true if the angle from `u` counter-clockwise to `w` around the apex is less than 60
/// degrees.
fn is_below_60_degrees<G: Crossing, V: Default>(
    t: &ConstrainedDelaunay<G, V>,
    u: VertexId,
    apex: VertexId,
    w: VertexId,
) -> bool {
    let [to_u, to_w] = [u, w].map(|end| minus(t.plan_of(end), t.plan_of(apex)));
    let along = dot(to_u, to_w);
    // Most angles are obtuse, and need no lengths.
    u != w
        && along >= 0.0
        && 2.0 * along > length(to_u) * length(to_w)
        && t.geometry().orientation([apex, u, w].map(|v| t.point(v))) == Sign::Positive
}

#[cfg(test)]
mod tests {
    use super::nearest_to_middle;

    #[test]
    fn circles_are_a_power_of_two_apart() {
        for (radius, length, at) in [
            (1.0, 2.0, 1.0),
            (1.0, 5.0, 2.0),
            (1.0, 7.0, 4.0),
            (8.0, 3.0, 2.0),
            (3.0, 3.0, 1.5),
        ] {
            assert_eq!(
                nearest_to_middle(radius, length),
                at / length,
                "{radius} on {length}"
            );
        }
    }
}
