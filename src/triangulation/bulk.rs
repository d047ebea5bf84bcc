//! Triangulating many points at once: divide and conquer on faces with ghosts.
//!
//! After Guibas and Stolfi (1985), with the cuts of Dwyer's variant (1987, both directions in turn) taken
//! from a Morton order, and without an edge structure: a part of the plane is kept as a *sphere* of
//! faces, where each edge of its hull has a ghost face that ends in the infinite vertex.
//!
//! 1. The points come in Morton order. A range of them is cut where the highest bit in which its keys differ
//!    changes, so that one coordinate strictly separates the halves; where keys are equal, at the
//!    median of the lexicographic order.
//! 2. Ranges of two and three points are made directly.
//! 3. Two halves are merged: their lower common tangent is found on the rings of ghosts, then the gap is
//!    zipped from there up. On each side the next hull vertex is a candidate; before, hull edges whose triangle
//!    it would destroy are flipped out. The ghost of the chosen candidate *becomes* the new
//!    triangle.
//!
//! A range of `m` points has exactly `2 m - 2` faces, and a merge adds exactly two: range `[lo, hi)` owns the
//! faces `2 lo .. 2 hi - 2`, a merge at `mid` adds `2 mid - 2` and `2 mid - 1`. So nothing is allocated, and
//! halves can be built by different threads. Ties are broken as everywhere, so that the result is the
//! same, cell for cell, as by any other road.
//!
//! Within, an edge is numbered `4 * face + k` and runs from corner `k` to the next one; the slots for neighbors hold
//! the number of the edge's twin until all is done. Collinear points have ghosts only.

use std::cmp::Ordering;

use crate::geometry::{Coordinates, in_sphere};
use crate::num::Sign;
use crate::tds::{CellId, Links, VertexId, cw};

use super::sort::Curve;

/// No edge: a single point has no ghosts.
const NONE: u32 = u32::MAX;

/// The most points whose edges can be numbered: `2 n - 2` faces with four numbers each, all of them ids. More are
/// left to insertion one by one.
const MAX_POINTS: usize = 1 << 29;
const _: () = assert!(4 * (2 * MAX_POINTS as u64 - 2) <= CellId::LIMIT as u64);

/// Ranges of more points than this are halved between threads.
const PARALLEL: usize = 1 << 14;

/// The next edge of the face.
#[inline(always)]
fn next(edge: u32) -> u32 {
    edge ^ (0b10_11_01 >> (2 * (edge & 3)) & 3)
}

/// The previous edge of the face.
#[inline(always)]
fn previous(edge: u32) -> u32 {
    edge ^ (0b11_01_10 >> (2 * (edge & 3)) & 3)
}

/// Two ghosts of a finished part, at opposite ends of it, to start looking from; [`NONE`] for one point.
#[derive(Clone, Copy)]
struct Part {
    bottom: u32,
    top: u32,
    first: u32,
}

/// The direction in which a merge looks: its halves are apart in x or in y.
#[derive(Clone, Copy, PartialEq)]
enum Axis {
    X,
    Y,
}

/// The faces of a range of points, and what is needed to build them.
struct Range<'a, G: Coordinates<3>> {
    geometry: &'a G,
    points: &'a [G::Point],
    keys: &'a [u64],
    /// The faces from number `offset` on.
    faces: &'a mut [Links<3>],
    offset: usize,
}

/// Triangulates different points that are in the order of [`spatial_order`](super::spatial_order); `None` if they
/// are all collinear, or more than [`MAX_POINTS`]. Vertices are numbered as the points.
pub(super) fn build<G: Coordinates<3>>(geometry: &G, points: &[G::Point]) -> Option<Vec<Links<3>>> {
    if !(3..=MAX_POINTS).contains(&points.len()) {
        return None;
    }
    let curve = Curve::through(points.len(), |i| geometry.coordinates(&points[i]));
    let keys: Vec<u64> = points.iter().map(|p| curve.key(geometry.coordinates(p).as_ref())).collect();
    debug_assert!(keys.is_sorted());
    let mut faces = vec![Links::UNUSED; 2 * points.len() - 2];
    Range { geometry, points, keys: &keys, faces: &mut faces, offset: 0 }.build(0, points.len());
    let is_finite = |links: &Links<3>| !links.vertices.contains(&VertexId::INFINITE);
    if !faces.iter().any(is_finite) {
        return None;
    }
    for links in &mut faces {
        links.neighbors = links.neighbors.map(|twin| CellId::new(twin.index() >> 2));
    }
    Some(faces)
}

impl<G: Coordinates<3>> Range<'_, G> {
    #[inline(always)]
    fn origin(&self, edge: u32) -> VertexId {
        self.faces[(edge >> 2) as usize - self.offset].vertices[(edge & 3) as usize]
    }

    #[inline(always)]
    fn set_origin(&mut self, edge: u32, vertex: VertexId) {
        self.faces[(edge >> 2) as usize - self.offset].vertices[(edge & 3) as usize] = vertex;
    }

    #[inline(always)]
    fn twin(&self, edge: u32) -> u32 {
        self.faces[(edge >> 2) as usize - self.offset].neighbors[cw((edge & 3) as usize)].index() as u32
    }

    #[inline(always)]
    fn link(&mut self, a: u32, b: u32) {
        for (edge, twin) in [(a, b), (b, a)] {
            self.faces[(edge >> 2) as usize - self.offset].neighbors[cw((edge & 3) as usize)] =
                CellId::new(twin as usize);
        }
    }

    #[inline(always)]
    fn set_face(&mut self, edge: u32, vertices: [VertexId; 3]) {
        self.faces[(edge >> 2) as usize - self.offset].vertices = vertices;
    }

    #[inline(always)]
    fn point(&self, vertex: VertexId) -> &G::Point {
        &self.points[vertex.index()]
    }

    #[inline(always)]
    fn turn(&self, a: VertexId, b: VertexId, c: VertexId) -> Sign {
        self.geometry.orientation([self.point(a), self.point(b), self.point(c)])
    }

    /// Whether `q` lies in the circle of a counter-clockwise triangle, ties decided. Never at infinity.
    #[inline(always)]
    fn in_circle(&self, a: VertexId, b: VertexId, c: VertexId, q: VertexId) -> bool {
        q != VertexId::INFINITE
            && in_sphere(self.geometry, [self.point(a), self.point(b), self.point(c)], self.point(q))
    }

    fn build(&mut self, lo: usize, hi: usize) -> Part {
        match hi - lo {
            1 => return Part { bottom: NONE, top: NONE, first: lo as u32 },
            2 => return self.pair(lo),
            3 => return self.triple(lo),
            _ => {}
        }
        let (mid, axis) = self.cut(lo, hi);
        let (geometry, points, keys, offset) = (self.geometry, self.points, self.keys, self.offset);
        let (left, right) = self.faces.split_at_mut(2 * mid - offset);
        let mut left = Range { geometry, points, keys, faces: left, offset };
        let mut right = Range { geometry, points, keys, faces: right, offset: 2 * mid };
        let (left, right) = if hi - lo > PARALLEL {
            rayon::join(|| left.build(lo, mid), || right.build(mid, hi))
        } else {
            (left.build(lo, mid), right.build(mid, hi))
        };
        self.merge(left, right, mid, axis)
    }

    /// Where to halve a range, and the axis that separates the halves.
    fn cut(&self, lo: usize, hi: usize) -> (usize, Axis) {
        let differing = self.keys[lo] ^ self.keys[hi - 1];
        if differing == 0 {
            return (lo + (hi - lo) / 2, Axis::X);
        }
        let bit = 63 - differing.leading_zeros();
        let mid = lo + self.keys[lo..hi].partition_point(|key| key >> bit & 1 == 0);
        (mid, if bit % 2 == 1 { Axis::X } else { Axis::Y }) // the bit of x stands above that of y
    }

    /// Two points: a hull of two edges.
    fn pair(&mut self, lo: usize) -> Part {
        let (a, b) = (VertexId::new(lo), VertexId::new(lo + 1));
        let (f, g) = (8 * lo as u32, 8 * lo as u32 + 4);
        self.set_face(f, [b, a, VertexId::INFINITE]);
        self.set_face(g, [a, b, VertexId::INFINITE]);
        self.link(f, g);
        self.link(f + 1, g + 2);
        self.link(f + 2, g + 1);
        Part { bottom: f, top: g, first: lo as u32 }
    }

    /// Three points: a triangle, or a chain seen from both sides.
    fn triple(&mut self, lo: usize) -> Part {
        let [mut a, mut b, mut c] = [0, 1, 2].map(|k| VertexId::new(lo + k));
        let f = 8 * lo as u32;
        let ghosts = [f + 4, f + 8, f + 12];
        let turn = self.turn(a, b, c);
        if turn == Sign::Zero {
            let mut chain = [a, b, c];
            chain.sort_unstable_by(|&p, &q| self.geometry.compare(self.point(p), self.point(q)));
            [a, b, c] = chain;
            // The ring a -> b -> c -> b -> a; each edge has a ghost on both sides.
            let ring = [f, ghosts[0], ghosts[1], ghosts[2]];
            for (ghost, [p, q]) in ring.into_iter().zip([[a, b], [b, c], [c, b], [b, a]]) {
                self.set_face(ghost, [q, p, VertexId::INFINITE]);
            }
            self.link(ring[0], ring[3]);
            self.link(ring[1], ring[2]);
            for k in 0..4 {
                self.link(ring[k] + 2, ring[(k + 1) % 4] + 1);
            }
        } else {
            if turn == Sign::Negative {
                std::mem::swap(&mut b, &mut c);
            }
            self.set_face(f, [a, b, c]);
            for (k, [p, q]) in [[a, b], [b, c], [c, a]].into_iter().enumerate() {
                self.set_face(ghosts[k], [q, p, VertexId::INFINITE]);
                self.link(f + k as u32, ghosts[k]);
                self.link(ghosts[k] + 2, ghosts[(k + 1) % 3] + 1);
            }
        }
        Part { bottom: ghosts[0], top: ghosts[2], first: lo as u32 }
    }

    /// The ghost after this one, counter-clockwise around the hull.
    #[inline(always)]
    fn next_ghost(&self, ghost: u32) -> u32 {
        self.twin(ghost + 2) - 1
    }

    /// The ghost before this one.
    #[inline(always)]
    fn previous_ghost(&self, ghost: u32) -> u32 {
        self.twin(ghost + 1) - 2
    }

    /// The order along the axis; a rotated lexicographic order, so that both axes are treated alike.
    #[inline(always)]
    fn compare(&self, p: VertexId, q: VertexId, axis: Axis) -> Ordering {
        let (p, q) = (self.point(p), self.point(q));
        match axis {
            Axis::X => self.geometry.compare(p, q),
            Axis::Y => {
                let (p, q) = (self.geometry.coordinates(p), self.geometry.coordinates(q));
                let (p, q) = (p.as_ref(), q.as_ref());
                p[1].partial_cmp(&q[1])
                    .unwrap_or(Ordering::Equal)
                    .then(q[0].partial_cmp(&p[0]).unwrap_or(Ordering::Equal))
            }
        }
    }

    /// The ghost whose hull edge starts at the extreme vertex along the axis: climbs the ring either way.
    #[inline(always)]
    fn extreme(&self, mut ghost: u32, axis: Axis, further: Ordering) -> u32 {
        let is_further = |p: VertexId, q: VertexId| self.compare(p, q, axis) == further;
        let mut extreme = self.origin(ghost + 1);
        if is_further(self.origin(ghost), extreme) {
            loop {
                ghost = self.next_ghost(ghost);
                extreme = self.origin(ghost + 1);
                if !is_further(self.origin(ghost), extreme) {
                    return ghost;
                }
            }
        }
        loop {
            let before = self.previous_ghost(ghost);
            if !is_further(self.origin(before + 1), extreme) {
                return ghost;
            }
            ghost = before;
            extreme = self.origin(ghost + 1);
        }
    }

    /// Climbs down both rings, from a ghost and its vertex on each ([`NONE`] for a single point), until no
    /// vertex is below the line through the two. A collinear vertex does not move it: it is further away.
    #[inline(always)]
    fn lower_tangent(&self, left: (u32, VertexId), right: (u32, VertexId)) -> [(u32, VertexId); 2] {
        let ((mut gl, mut a), (mut gr, mut b)) = (left, right);
        loop {
            if gl != NONE {
                let ghost = self.previous_ghost(gl);
                let x = self.origin(ghost + 1);
                if self.turn(a, b, x) == Sign::Negative {
                    (gl, a) = (ghost, x);
                    continue;
                }
            }
            if gr != NONE {
                let ghost = self.next_ghost(gr);
                let x = self.origin(ghost);
                if self.turn(a, b, x) == Sign::Negative {
                    (gr, b) = (ghost, x);
                    continue;
                }
            }
            return [(gl, a), (gr, b)];
        }
    }

    fn merge(&mut self, left: Part, right: Part, mid: usize, axis: Axis) -> Part {
        let (one_left, one_right) = (left.bottom == NONE, right.bottom == NONE);
        // `gl` is the ghost of the hull edge that starts at `a` on the left, `gr` of that which ends at `b` on
        // the right. The children's own merges ended near where we look.
        let (mut gl, mut a) = (NONE, VertexId::new(left.first as usize));
        if !one_left {
            let near = if axis == Axis::X { left.bottom } else { left.top };
            gl = self.extreme(near, axis, Ordering::Greater);
            a = self.origin(gl + 1);
        }
        let (mut gr, mut b) = (NONE, VertexId::new(right.first as usize));
        if !one_right {
            let near = if axis == Axis::X { right.top } else { right.bottom };
            let start = self.extreme(near, axis, Ordering::Less);
            b = self.origin(start + 1);
            gr = self.previous_ghost(start);
        }

        [(gl, a), (gr, b)] = self.lower_tangent((gl, a), (gr, b));

        // The ghosts below and above.
        let (below, above) = (8 * mid as u32 - 8, 8 * mid as u32 - 4);
        self.set_face(below, [b, a, VertexId::INFINITE]);
        let before = if one_left { above + 2 } else { self.twin(gl + 1) };
        self.link(below + 1, before);
        let after = if one_right { above + 1 } else { self.twin(gr + 2) };
        self.link(below + 2, after);

        // Zip: `open` is the edge b -> a of the last face.
        let mut open = below;
        loop {
            let mut candidate_left = None;
            if gl != NONE && self.turn(a, b, self.origin(gl)) == Sign::Positive {
                candidate_left = Some(self.clear_left(gl, a, b));
            }
            let mut candidate_right = None;
            if gr != NONE && self.turn(a, b, self.origin(gr + 1)) == Sign::Positive {
                candidate_right = Some(self.clear_right(gr, a, b));
            }
            let chosen_right = match (candidate_left, candidate_right) {
                (None, None) => break,
                (Some(c), Some(d)) => self.in_circle(a, b, c, d).then_some(d),
                (_, right) => right,
            };
            if let Some(d) = chosen_right {
                // The ghost (b, d, infinite) becomes the triangle (b, d, a).
                let onward = self.previous_ghost(gr);
                self.set_origin(gr + 2, a);
                self.link(gr + 2, open);
                (open, b, gr) = (gr + 1, d, onward);
            } else if let Some(c) = candidate_left {
                // The ghost (c, a, infinite) becomes the triangle (c, a, b).
                let onward = self.next_ghost(gl);
                self.set_origin(gl + 2, b);
                self.link(gl + 1, open);
                (open, a, gl) = (gl + 2, c, onward);
            }
        }
        self.set_face(above, [a, b, VertexId::INFINITE]);
        self.link(above, open);
        if !one_right {
            self.link(above + 1, gr + 2);
        }
        if !one_left {
            self.link(above + 2, gl + 1);
        }
        Part { bottom: below, top: above, first: left.first }
    }

    /// Takes out the hull edges at `a` whose triangle a triangle on `a b` would destroy; returns the
    /// candidate that is left.
    #[inline(always)]
    fn clear_left(&mut self, gl: u32, a: VertexId, b: VertexId) -> VertexId {
        let mut c = self.origin(gl);
        loop {
            // The face behind the hull edge is (a, c, q).
            let inner = self.twin(gl);
            let (to_q, from_q) = (next(inner), previous(inner));
            let q = self.origin(from_q);
            if !self.in_circle(a, b, c, q) {
                return c;
            }
            // It becomes the ghost of c -> q's outer side, and `gl` that of a -> q.
            let after = self.next_ghost(gl);
            let (beyond_cq, beyond_qa) = (self.twin(to_q), self.twin(from_q));
            let ghost = inner & !3;
            self.set_origin(gl, q);
            self.link(gl, beyond_qa);
            self.set_face(ghost, [c, q, VertexId::INFINITE]);
            self.link(ghost, beyond_cq);
            self.link(ghost + 2, after + 1);
            self.link(gl + 2, ghost + 1);
            c = q;
        }
    }

    /// The mirror image, at `b`.
    #[inline(always)]
    fn clear_right(&mut self, gr: u32, a: VertexId, b: VertexId) -> VertexId {
        let mut d = self.origin(gr + 1);
        loop {
            // The face behind the hull edge is (d, b, q).
            let inner = self.twin(gr);
            let (to_q, from_q) = (next(inner), previous(inner));
            let q = self.origin(from_q);
            if !self.in_circle(a, b, d, q) {
                return d;
            }
            let before = self.previous_ghost(gr);
            let (beyond_bq, beyond_qd) = (self.twin(to_q), self.twin(from_q));
            let ghost = inner & !3;
            self.set_origin(gr + 1, q);
            self.link(gr, beyond_bq);
            self.set_face(ghost, [q, d, VertexId::INFINITE]);
            self.link(ghost, beyond_qd);
            self.link(ghost + 1, before + 2);
            self.link(gr + 1, ghost + 2);
            d = q;
        }
    }
}
