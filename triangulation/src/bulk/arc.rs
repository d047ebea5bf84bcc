//! Triangulates points on an arc, from one end of it to the other.
//!
//! Halves of an arc along which the curvature falls are fans. A merge of two of them destroys one,
//! so that each level of divide and conquer destroys half of all triangles. If the points are
//! inserted one by one from the sharp end, each is joined to the ends of the last edge, and nothing
//! is destroyed:
//!
//! ```text
//!            . e
//!         d'   |          the ghost of a d becomes the triangle a d e,
//!       c'    /           with ghosts of d e and e a
//!     b'   . '
//!     a. '
//! ```
//!
//! An arc here is convex and rises or falls all along, so that an end point beyond it sees one edge
//! only. Where triangles are destroyed all the same, edges are flipped (Lawson 1977), as long as
//! that is less work than merges would be. The work lost on failed attempts is a few steps a point
//! at most: after one, the next is made with at most three quarters as many points.
//!
//! `PERF:` 100 000 points on a parabola: 211 instead of 484 million instructions, with reading the
//! file. Insertion in random order (Chew 1990), which suits any arc: 567.

use std::cmp::Ordering;

use crate::geometry::Coordinates;
use crate::num::Sign;
use crate::tds::VertexId;

use super::faces::Range;
use super::filter::NOWHERE;
use super::part::{Axis, BuiltRange};

/// Smaller ranges are merged: the test for an arc takes as long.
pub(super) const LEAST: usize = 200;

/// Larger ranges are cut in two, so that threads can share them.
pub(super) const MOST: usize = 1 << 17;

/// Ranges of at most this many points are sorted by comparison.
const FEW: usize = 8;

/// Flips allowed for each point inserted so far: merges take about one for each level.
const FLIPS: usize = 3;

/// Flips allowed on top: at the start of an arc, its curvature is lost in roundings.
const FIRST_FLIPS: usize = 64;

impl<G: Coordinates<N>, const N: usize, const FILTERED: bool> Range<'_, G, N, FILTERED> {
    /// Triangulates a range of points on an arc; `None` if they are not on one or it takes too
    /// long, with faces in an undefined state, to be overwritten.
    #[inline(never)]
    pub(super) fn arc(&mut self, lo: usize, hi: usize) -> Option<BuiltRange> {
        let samples = [0, 1, 2, 3].map(|k| VertexId::new(lo + (hi - 1 - lo) * k / 3));
        let sites = samples.map(|v| self.predicates.site(v));
        let rises = |i: usize, j: usize| (sites[j][0] - sites[i][0]) * (sites[j][1] - sites[i][1]);
        let slopes = [
            rises(0, 1),
            rises(0, 2),
            rises(0, 3),
            rises(1, 2),
            rises(1, 3),
            rises(2, 3),
        ];
        if slopes.iter().all(|&s| s >= 0.0) || slopes.iter().all(|&s| s <= 0.0) {
            return self.sampled_arc(lo, hi, slopes.iter().any(|&s| s > 0.0));
        }
        None
    }

    #[cold]
    fn sampled_arc(&mut self, lo: usize, hi: usize, rises: bool) -> Option<BuiltRange> {
        let (mut chain, mut turn) = self.along(lo, hi, rises)?;
        // Start where the curvature is larger: the circle through three points of the arc does not
        // contain the fourth.
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| chain[(chain.len() - 1) * k / 3]);
        let ends = if turn == Sign::Positive {
            [a, b]
        } else {
            [b, a]
        };
        if self.predicates.in_circle(c, ends, d) {
            chain.reverse();
            turn = -turn;
        }
        self.insert_along(&chain, turn, 2 * lo as u32)
    }

    /// Returns the points of a range by rising `x`, or by rising `y` and falling `x`, and the side
    /// that they turn to.
    fn along(&self, lo: usize, hi: usize, rises: bool) -> Option<(Vec<VertexId>, Sign)> {
        // Rotated to the right if the arc falls: neither coordinate falls along it then.
        let site = |v: VertexId| {
            let [x, y] = self.predicates.site(v);
            if rises { [x, y] } else { [y, -x] }
        };
        let mut chain: Vec<VertexId> = Vec::with_capacity(hi - lo);
        let mut last = [NOWHERE; 2];
        let mut side = None;
        let mut ranges = vec![(lo, hi)];
        let mut few = Vec::with_capacity(FEW);
        while let Some((lo, hi)) = ranges.pop() {
            if hi - lo > FEW {
                let (mid, axis) = self.halve(lo, hi)?;
                let halves = [(lo, mid), (mid, hi)];
                let [first, second] = if rises || axis == Axis::Y {
                    halves
                } else {
                    [halves[1], halves[0]]
                };
                ranges.extend([second, first]);
                continue;
            }
            few.clear();
            few.extend((lo..hi).map(VertexId::new).map(|v| (site(v), v)));
            few.sort_unstable_by(|(p, _), (q, _)| p.partial_cmp(q).unwrap_or(Ordering::Equal));
            for &(r, vertex) in &few {
                let [p, q] = last;
                last = [q, r];
                chain.push(vertex);
                if let &[.., a, b, c] = chain.as_slice() {
                    let turn = self.predicates.turn_at([p, q, r], [a, b, c]);
                    let goes_on = p[0] <= q[0] && p[1] <= q[1] && q[0] <= r[0] && q[1] <= r[1];
                    if turn == Sign::Zero || *side.get_or_insert(turn) != turn || !goes_on {
                        return None;
                    }
                }
            }
        }
        Some((chain, side?))
    }

    /// Triangulates the vertices of a convex polygon, given in order.
    fn insert_along(
        &mut self,
        chain: &[VertexId],
        turn: Sign,
        first_face: u32,
    ) -> Option<BuiltRange> {
        let &[a, b, ref rest @ ..] = chain else {
            return None;
        };
        let turns_left = turn == Sign::Positive;
        let mut open = self.pair([a, b], first_face)[usize::from(turns_left)];
        let mut unchecked = Vec::new();
        let mut flips = 0;
        for (count, (&next, fresh)) in rest.iter().zip((first_face + 2..).step_by(2)).enumerate() {
            let before_and_after = self.add(next, open, fresh);
            unchecked.push(std::mem::replace(
                &mut open,
                before_and_after[usize::from(turns_left)],
            ));
            while let Some(face) = unchecked.pop() {
                if let Some(beside) = self.flip_outward(face) {
                    unchecked.extend([face, beside]);
                    flips += 1;
                }
            }
            if flips > FLIPS * count + FIRST_FLIPS {
                return None;
            }
        }
        Some(BuiltRange {
            bottom: open,
            top: open,
            first: first_face / 2,
        })
    }

    /// Turns a ghost into the triangle to a vertex that sees no other edge of the hull. Returns the
    /// ghosts of the edges to the vertex and from it.
    #[inline(always)]
    fn add(&mut self, vertex: VertexId, ghost: u32, fresh: u32) -> [u32; 2] {
        let (to, from) = (fresh, fresh + 1);
        let [end, start, infinite] = self.face(ghost).vertices;
        let (before, after) = (self.twin(ghost, 1), self.twin(ghost, 2));
        self.face_mut(ghost).vertices[2] = vertex;
        self.face_mut(to).vertices = [vertex, start, infinite];
        self.face_mut(from).vertices = [end, vertex, infinite];
        self.link((ghost, 1), (to, 0));
        self.link((ghost, 2), (from, 0));
        self.link_to((to, 1), before);
        self.link((to, 2), (from, 1));
        self.link_to((from, 2), after);
        [to, from]
    }

    /// Flips the first edge of a face if the vertex in the last slot lies in the circle of the face
    /// beyond; then both faces have that vertex in their last slot. Returns the other face.
    #[inline(always)]
    fn flip_outward(&mut self, face: u32) -> Option<u32> {
        let [p, q, vertex] = self.face(face).vertices;
        let edge = self.twin(face, 0);
        let apex = self.opposite(edge);
        if !self.predicates.in_circle(apex, [q, p], vertex) {
            return None;
        }
        let beside = edge.face();
        let (beyond_p, beyond_q) = (
            self.twin(beside, edge.next_slot()),
            self.twin(beside, edge.previous_slot()),
        );
        let beyond_vertex = self.twin(face, 2);
        self.face_mut(face).vertices[0] = apex;
        self.face_mut(beside).vertices = [p, apex, vertex];
        self.link_to((beside, 0), beyond_p);
        self.link_to((face, 0), beyond_q);
        self.link_to((beside, 2), beyond_vertex);
        self.link((face, 2), (beside, 1));
        Some(beside)
    }
}
