//! Triangulates ranges of up to four points.

use crate::geometry::Coordinates;
use crate::num::Sign;
use crate::tds::VertexId;

use super::faces::Range;
use super::part::BuiltRange;

const INFINITE: VertexId = VertexId::INFINITE;

impl<G: Coordinates<N>, const N: usize, const FILTERED: bool> Range<'_, G, N, FILTERED> {
    /// Makes the two ghosts of an edge between two points, one for each direction. Returns them.
    #[inline(always)]
    pub(super) fn pair(&mut self, [a, b]: [VertexId; 2], first_face: u32) -> [u32; 2] {
        let ghosts = [first_face, first_face + 1];
        self.close(ghosts, [[a, b], [b, a]]);
        self.link((ghosts[0], 0), (ghosts[1], 0));
        ghosts
    }

    /// Triangulates three points: a triangle, or a chain with ghosts on both sides.
    pub(super) fn triple(&mut self, lo: usize) -> BuiltRange {
        let [mut a, mut b, mut c] = [0, 1, 2].map(|k| VertexId::new(lo + k));
        let [f, g, h, i] = [0, 1, 2, 3].map(|k| 2 * lo as u32 + k);
        let turn = self.predicates.turn([a, b, c]);
        if turn == Sign::Zero {
            let mut chain = [a, b, c].map(|v| (self.predicates.coordinates(v), v));
            chain.sort_unstable_by(|(p, _), (q, _)| {
                p.partial_cmp(q).unwrap_or(std::cmp::Ordering::Equal)
            });
            [a, b, c] = chain.map(|(_, v)| v);
            self.close([f, g, h, i], [[a, b], [b, c], [c, b], [b, a]]);
            self.link((f, 0), (i, 0));
            self.link((g, 0), (h, 0));
        } else {
            if turn == Sign::Negative {
                std::mem::swap(&mut b, &mut c);
            }
            self.face_mut(f).vertices = [a, b, c];
            self.close([g, h, i], [[a, b], [b, c], [c, a]]);
            for (slot, ghost) in [g, h, i].into_iter().enumerate() {
                self.link((f, slot), (ghost, 0));
            }
        }
        BuiltRange {
            bottom: g,
            top: i,
            first: lo as u32,
        }
    }

    /// Triangulates four points of which no three are collinear: two triangles, or three around the
    /// point within. `None` if three are collinear.
    ///
    /// `PERF:` saves a quarter of the merges (0.46 to 0.35 a point; -3 to -4 % of their time in the
    /// prototype).
    pub(super) fn quadruple(&mut self, lo: usize) -> Option<BuiltRange> {
        let mut v = [0, 1, 2, 3].map(|k| VertexId::new(lo + k));
        match self.predicates.turn([v[0], v[1], v[2]]) {
            Sign::Positive => {}
            Sign::Negative => v.swap(1, 2),
            Sign::Zero => return None,
        }
        // The edges of the triangle that have the fourth point on their right, one bit each.
        let mut right = 0;
        for (k, [p, q]) in [[0, 1], [1, 2], [2, 0]].into_iter().enumerate() {
            match self.predicates.turn([v[p], v[q], v[3]]) {
                Sign::Positive => {}
                Sign::Negative => right |= 1 << k,
                Sign::Zero => return None,
            }
        }
        let [f, g, h, i, j, k] = [0, 1, 2, 3, 4, 5].map(|k| 2 * lo as u32 + k);
        // Beyond one edge: a quadrilateral. Beyond two: the corner that they meet in is inside.
        let [a, b, c, d] = match right {
            0b000 => [0, 1, 2, 3],
            0b001 => [0, 3, 1, 2],
            0b010 => [1, 3, 2, 0],
            0b100 => [2, 3, 0, 1],
            0b011 => [2, 0, 3, 1],
            0b110 => [0, 1, 3, 2],
            _ => [1, 2, 3, 0],
        }
        .map(|k: usize| v[k]);
        if matches!(right, 0b001 | 0b010 | 0b100) {
            // The diagonal from a to c, or that from b to d.
            let [a, b, c, d] = if self.predicates.in_circle(d, [a, c], b) {
                [b, c, d, a]
            } else {
                [a, b, c, d]
            };
            self.face_mut(f).vertices = [a, b, c];
            self.face_mut(g).vertices = [a, c, d];
            self.close([h, i, j, k], [[a, b], [b, c], [c, d], [d, a]]);
            for (inner, outer) in [((f, 0), h), ((f, 1), i), ((g, 1), j), ((g, 2), k)] {
                self.link(inner, (outer, 0));
            }
            self.link((f, 2), (g, 0));
            Some(BuiltRange {
                bottom: h,
                top: j,
                first: lo as u32,
            })
        } else {
            for (face, ghost, [p, q]) in [(f, i, [a, b]), (g, j, [b, c]), (h, k, [c, a])] {
                self.face_mut(face).vertices = [p, q, d];
                self.link((face, 0), (ghost, 0));
            }
            self.close([i, j, k], [[a, b], [b, c], [c, a]]);
            for (face, after) in [(f, g), (g, h), (h, f)] {
                self.link((face, 1), (after, 2));
            }
            Some(BuiltRange {
                bottom: i,
                top: j,
                first: lo as u32,
            })
        }
    }

    /// Makes the ghosts of a hull, counter-clockwise, and links them to each other.
    #[inline(always)]
    fn close<const LENGTH: usize>(
        &mut self,
        ghosts: [u32; LENGTH],
        edges: [[VertexId; 2]; LENGTH],
    ) {
        for (k, [p, q]) in edges.into_iter().enumerate() {
            self.face_mut(ghosts[k]).vertices = [q, p, INFINITE];
            self.link((ghosts[k], 2), (ghosts[(k + 1) % LENGTH], 1));
        }
    }
}
