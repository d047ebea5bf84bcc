//! Merges two halves into one triangulation.
//!
//! The gap between the halves is zipped from the lower common tangent upward. Above each base `a b`
//! there are two candidates, the next hull vertices `c` and `d`. The one whose circle with the base
//! does not contain the other becomes the apex of the next triangle, whose free edge is the next
//! base. A hull edge is flipped away first if the vertex `q` behind it lies in that circle:
//!
//! ```text
//!    left half         right half         d in circle (a b c): d is chosen, a d is the new base
//!          c           d                         c           d
//!         /|           |\                        |     . - ' |
//!      q < |           | > q         ->          | . '       |
//!         \|           |/                        |'          |
//!          a---base----b                         a---base----b
//! ```
//!
//! All code has two mirror images, `LEFT` and `RIGHT`. The number is the slot in a ghost of the
//! upper end of its hull edge. A ghost is `(end, start, infinite)` of an edge that runs
//! counter-clockwise around the hull: `(c, a, infinite)` on the left half, `(b, d, infinite)` on
//! the right.

use crate::geometry::Coordinates;
use crate::num::Sign;
use crate::tds::VertexId;

use super::faces::{Edge, Range};
use super::filter::{Arrow, Circle, NOWHERE, Site, turn};
use super::part::{Axis, BuiltRange, NONE};

const LEFT: usize = 0;
const RIGHT: usize = 1;

/// Returns the slot, in a ghost, of the edge between the upper end of the hull edge and infinity:
/// the ghost further up lies across it.
const fn onward(side: usize) -> usize {
    2 - side
}

/// Returns the slot, in a ghost, of the edge between the lower end of the hull edge and infinity:
/// the ghost further down lies across it.
const fn back(side: usize) -> usize {
    1 + side
}

/// The vertex of a half that the base edge ends at.
#[derive(Clone, Copy)]
struct Foot {
    vertex: VertexId,
    at: Site,
    /// The ghost of the hull edge that goes up from the vertex; [`NONE`] for a single point.
    ghost: u32,
}

/// The next hull edge up on one side, with all that the merge needs to know of it.
#[derive(Clone, Copy)]
struct Climb {
    /// The ghost of the hull edge; [`NONE`] for a single point.
    ghost: u32,
    /// The twin of the hull edge, in the face behind it.
    behind: Edge,
    /// The edge that the next ghost shares with this one.
    onward: Edge,
    /// The upper end of the hull edge: the candidate.
    vertex: VertexId,
    candidate: Site,
    /// The coordinates of the vertex opposite the hull edge, in the face behind it.
    apex: Site,
}

impl<G: Coordinates<N>, const N: usize, const FILTERED: bool> Range<'_, G, N, FILTERED> {
    /// Joins two halves; the right one starts at point `mid`.
    ///
    /// A candidate that is valid stays valid while the other side climbs. Say `d` was chosen, and
    /// `c` is above `a b` but not above `a d`. Then `c`, which is not in the circle of `a b d`,
    /// lies beyond `b d` as seen from `a`. That is the side of the right half, but `c` belongs to
    /// the left one: a contradiction.
    ///
    /// `PERF:` (callgrind and time of 100 000 points) Only valid candidates are tested, and no
    /// circle is computed for an invalid one: -10 % on a parabola, where one side alone climbs for
    /// long, and no loss elsewhere. What the loop needs of a hull edge is in variables, and a ghost
    /// is written once after all its flips: -8 % of the instructions, -5 % on the parabola. Reading
    /// coordinates one ghost ahead, as the prototype did against mispredictions: +7 % instructions,
    /// no gain. Testing both candidates without branches: 8.6 instead of 11.6 simulated
    /// mispredictions a point, no gain on 1 million uniform points, and +10 % on a parabola.
    pub(super) fn merge(
        &mut self,
        left: BuiltRange,
        right: BuiltRange,
        mid: usize,
        axis: Axis,
    ) -> BuiltRange {
        let [
            Foot {
                vertex: mut a,
                at: mut at_a,
                ghost: gl,
            },
            Foot {
                vertex: mut b,
                at: mut at_b,
                ghost: gr,
            },
        ] = self.lower_tangent(
            self.extreme::<LEFT>(left, axis),
            self.extreme::<RIGHT>(right, axis),
        );

        // The ghosts below and above.
        let (below, above) = (2 * mid as u32 - 2, 2 * mid as u32 - 1);
        self.close_below([below, above], [a, b], [gl, gr]);

        // Zip: `open` is the edge from b to a of the last face.
        let mut open = Edge::new(below, 0);
        let mut l = self.climb::<LEFT>(gl);
        let mut r = self.climb::<RIGHT>(gr);
        let (mut valid_c, mut valid_d) = (false, false);
        loop {
            let base = Arrow::between(at_a, at_b);
            let is_valid = |to_candidate: Arrow, climb: &Climb| {
                let turn = base.turn(to_candidate);
                if self.predicates.is_open(turn) {
                    self.predicates.turn_slowly([a, b, climb.vertex]) == Sign::Positive
                } else {
                    turn.is_positive()
                }
            };
            let to_c = Arrow::between(at_a, l.candidate);
            let mut to_d = Arrow::between(at_a, r.candidate);
            valid_c = valid_c || is_valid(to_c, &l);
            valid_d = valid_d || is_valid(to_d, &r);
            let mut circle_c = Circle::NONE;
            if valid_c {
                (_, circle_c) = self.flip_away::<LEFT>(&mut l, [a, b], at_a, base, to_c);
            }
            if valid_d {
                (to_d, _) = self.flip_away::<RIGHT>(&mut r, [a, b], at_a, base, to_d);
            }
            if !(valid_c | valid_d) {
                break;
            }
            let inside = circle_c.side(to_d);
            let mut chooses_d = valid_d & (!valid_c | inside.is_positive());
            if valid_c & valid_d & self.predicates.is_open(inside) {
                chooses_d = self.predicates.in_circle_slowly(a, [b, l.vertex], r.vertex);
            }
            if chooses_d {
                valid_d = false;
                at_b = r.candidate;
                (open, b) = self.step::<RIGHT>(&mut r, open, a);
            } else {
                valid_c = false;
                at_a = l.candidate;
                (open, a) = self.step::<LEFT>(&mut l, open, b);
            }
        }
        let last = |of_half: u32, climb: &Climb| if of_half == NONE { NONE } else { climb.ghost };
        self.close_above(above, [a, b], open, [last(gl, &l), last(gr, &r)]);
        BuiltRange {
            bottom: below,
            top: above,
            first: left.first,
        }
    }

    /// Starts the gap between the halves with the ghost below it, from `b` to `a`. The ghosts of
    /// the halves at these vertices are given, too; a half of one point has none.
    #[inline(always)]
    fn close_below(&mut self, [below, above]: [u32; 2], [a, b]: [VertexId; 2], [gl, gr]: [u32; 2]) {
        self.face_mut(below).vertices = [b, a, VertexId::INFINITE];
        if gl == NONE {
            self.link((below, 1), (above, 2));
        } else {
            self.link_to((below, 1), self.twin(gl, back(LEFT)));
        }
        if gr == NONE {
            self.link((below, 2), (above, 1));
        } else {
            self.link_to((below, 2), self.twin(gr, back(RIGHT)));
        }
    }

    /// Ends the gap with the ghost above it, from `a` to `b`, at the last open edge. The ghosts of
    /// the halves beside it are given, too.
    #[inline(always)]
    fn close_above(
        &mut self,
        above: u32,
        [a, b]: [VertexId; 2],
        open: Edge,
        [left, right]: [u32; 2],
    ) {
        self.face_mut(above).vertices = [a, b, VertexId::INFINITE];
        self.link_to((above, 0), open);
        if right != NONE {
            self.link((above, 1), (right, 2));
        }
        if left != NONE {
            self.link((above, 2), (left, 1));
        }
    }

    /// Flips hull edges of a side away, for as long as the circle through `a`, `b` and the
    /// candidate contains the vertex behind the edge, which is the next candidate. Returns the
    /// arrow from `a` to the last candidate, and its circle.
    #[inline(always)]
    fn flip_away<const SIDE: usize>(
        &mut self,
        climb: &mut Climb,
        [a, b]: [VertexId; 2],
        at_a: Site,
        base: Arrow,
        to_candidate: Arrow,
    ) -> (Arrow, Circle) {
        let (mut to_candidate, mut circle) = (to_candidate, Circle::through(base, to_candidate));
        let mut has_flipped = false;
        loop {
            let to_q = Arrow::between(at_a, climb.apex);
            let inside = circle.side(to_q);
            let mut flips = inside.is_positive();
            if self.predicates.is_open(inside) {
                let (start, chord) = if SIDE == LEFT {
                    (b, [climb.vertex, a])
                } else {
                    (a, [b, climb.vertex])
                };
                flips = self
                    .predicates
                    .in_circle_slowly(start, chord, self.opposite(climb.behind));
            }
            if !flips {
                break;
            }
            self.flip::<SIDE>(climb);
            has_flipped = true;
            to_candidate = to_q;
            circle = Circle::through(base, to_candidate);
        }
        if has_flipped {
            self.update_ghost::<SIDE>(climb);
        }
        (to_candidate, circle)
    }

    /// Returns the vertex of a half that is nearest to the other half; of several, the lowest.
    /// Climbs the ring of ghosts in either direction, from where the half's own merge has ended:
    /// one or two steps, because the axes alternate.
    #[inline(always)]
    fn extreme<const SIDE: usize>(&self, half: BuiltRange, axis: Axis) -> Foot {
        // Along a rotated lexicographic order, so that both axes are treated alike.
        let along = |v: VertexId| {
            let [x, y] = self.predicates.coordinates(v);
            match axis {
                Axis::X => (x, y),
                Axis::Y => (y, -x),
            }
        };
        let is_further = |p: (f64, f64), q: (f64, f64)| {
            let (p, q) = if SIDE == LEFT { (q, p) } else { (p, q) };
            p.0 < q.0 || p.0 == q.0 && p.1 < q.1
        };
        let mut ghost = match (SIDE, axis) {
            (LEFT, Axis::X) | (RIGHT, Axis::Y) => half.bottom,
            _ => half.top,
        };
        if ghost == NONE {
            let vertex = VertexId::new(half.first as usize);
            return Foot {
                vertex,
                at: self.predicates.site(vertex),
                ghost,
            };
        }
        // The start of the ghost's hull edge.
        let mut furthest = along(self.vertex(ghost, 1));
        let end = along(self.vertex(ghost, 0));
        if is_further(end, furthest) {
            furthest = end;
            loop {
                ghost = self.twin(ghost, 2).face();
                let end = along(self.vertex(ghost, 0));
                if !is_further(end, furthest) {
                    break;
                }
                furthest = end;
            }
        } else {
            loop {
                let before = self.twin(ghost, 1).face();
                let start = along(self.vertex(before, 1));
                if !is_further(start, furthest) {
                    break;
                }
                (ghost, furthest) = (before, start);
            }
        }
        let vertex = self.vertex(ghost, 1);
        let ghost = if SIDE == LEFT {
            ghost
        } else {
            self.twin(ghost, 1).face()
        };
        Foot {
            vertex,
            at: self.predicates.site(vertex),
            ghost,
        }
    }

    /// Returns the feet of the lower common tangent: climbs down both rings until no vertex lies
    /// below the line through the two feet. A collinear vertex does not move a foot: it is further
    /// away.
    #[inline(always)]
    fn lower_tangent(&self, mut left: Foot, mut right: Foot) -> [Foot; 2] {
        // At most once around: wrong answers would lead to an endless loop.
        let (first_left, first_right) = (left.ghost, right.ghost);
        loop {
            let mut moved = false;
            while let Some(lower) = self.lower::<LEFT>(&left, [&left, &right])
                && lower.ghost != first_left
            {
                (left, moved) = (lower, true);
            }
            while let Some(lower) = self.lower::<RIGHT>(&right, [&left, &right])
                && lower.ghost != first_right
            {
                (right, moved) = (lower, true);
            }
            if !moved || left.ghost == NONE {
                return [left, right];
            }
        }
    }

    /// Returns the next vertex down on one side if it lies below the line through the two feet.
    #[inline(always)]
    fn lower<const SIDE: usize>(&self, foot: &Foot, [left, right]: [&Foot; 2]) -> Option<Foot> {
        if foot.ghost == NONE {
            return None;
        }
        let ghost = self.twin(foot.ghost, back(SIDE)).face();
        let vertex = self.vertex(ghost, 1 - SIDE);
        let at = self.predicates.site(vertex);
        let turn = turn(left.at, right.at, at);
        let is_below = if self.predicates.is_open(turn) {
            self.predicates
                .turn_slowly([left.vertex, right.vertex, vertex])
                == Sign::Negative
        } else {
            turn.is_negative()
        };
        is_below.then_some(Foot { vertex, at, ghost })
    }

    /// Reads a hull edge.
    #[inline(always)]
    fn climb<const SIDE: usize>(&self, ghost: u32) -> Climb {
        if ghost == NONE {
            let none = Edge::new(0, 0);
            let vertex = VertexId::INFINITE;
            return Climb {
                ghost,
                behind: none,
                onward: none,
                vertex,
                candidate: NOWHERE,
                apex: NOWHERE,
            };
        }
        let vertex = self.vertex(ghost, SIDE);
        let behind = self.twin(ghost, 0);
        Climb {
            ghost,
            behind,
            onward: self.twin(ghost, onward(SIDE)),
            vertex,
            candidate: self.predicates.site(vertex),
            apex: self.predicates.site(self.opposite(behind)),
        }
    }

    /// Removes a hull edge: the triangle behind it becomes the ghost of its far edge, and the near
    /// edge is the next to test.
    ///
    /// ```text
    ///       c                    c
    ///      /|                   /
    ///     q |  ghost    ->     q   the triangle's     (LEFT; RIGHT is its mirror image)
    ///      \|                   \
    ///       a                    a  the ghost's
    /// ```
    ///
    /// The ghost itself is not changed before [`update_ghost`](Self::update_ghost).
    #[inline(always)]
    fn flip<const SIDE: usize>(&mut self, climb: &mut Climb) {
        let edge = climb.behind;
        let face = edge.face();
        let (far, near) = match SIDE {
            LEFT => (edge.next_slot(), edge.previous_slot()),
            _ => (edge.previous_slot(), edge.next_slot()),
        };
        let q = self.opposite(edge);
        let (beyond_far, beyond_near) = (self.twin(face, far), self.twin(face, near));
        self.face_mut(face).vertices = match SIDE {
            LEFT => [climb.vertex, q, VertexId::INFINITE],
            _ => [q, climb.vertex, VertexId::INFINITE],
        };
        self.link_to((face, 0), beyond_far);
        self.link_to((face, onward(SIDE)), climb.onward);
        climb.onward = Edge::new(face, back(SIDE));
        climb.behind = beyond_near;
        climb.vertex = q;
        climb.candidate = climb.apex;
        climb.apex = self.predicates.site(self.opposite(beyond_near));
    }

    /// Makes the ghost that of the hull edge that remains after flips.
    #[inline(always)]
    fn update_ghost<const SIDE: usize>(&mut self, climb: &Climb) {
        self.face_mut(climb.ghost).vertices[SIDE] = climb.vertex;
        self.link_to((climb.ghost, 0), climb.behind);
        self.link_to((climb.ghost, onward(SIDE)), climb.onward);
    }

    /// Turns the chosen candidate's ghost into the triangle on the base, whose other end is given.
    /// Returns the edge that is open then, and its new end.
    #[inline(always)]
    fn step<const SIDE: usize>(
        &mut self,
        climb: &mut Climb,
        open: Edge,
        other: VertexId,
    ) -> (Edge, VertexId) {
        let Climb {
            ghost,
            vertex,
            onward: next,
            ..
        } = *climb;
        self.face_mut(ghost).vertices[2] = other;
        self.link_to((ghost, back(SIDE)), open);
        *climb = self.climb::<SIDE>(next.face());
        (Edge::new(ghost, onward(SIDE)), vertex)
    }
}
