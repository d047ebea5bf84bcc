//! Measures of triangles, and positions of vertices that destroy them. Rounded: only the quality
//! depends on it.

use std::ops::Range;

use crate::kernel::twice_area;
use crate::num::unsigned_zero;

#[inline]
pub(super) fn minus(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    [p[0] - q[0], p[1] - q[1]]
}

#[inline]
pub(super) fn dot(u: [f64; 2], v: [f64; 2]) -> f64 {
    u[0] * v[0] + u[1] * v[1]
}

/// Squares of lengths of which no product of two overflows or underflows. Handling the others
/// everywhere would take a fifth of the time of a refinement.
const ORDINARY: Range<f64> = 1e-140..1e140;

#[inline]
pub(super) fn length(v: [f64; 2]) -> f64 {
    let square = dot(v, v);
    if ORDINARY.contains(&square) {
        square.sqrt()
    } else {
        v[0].hypot(v[1])
    }
}

/// Returns true if the angle between two vectors is obtuse and its cosine at most the negative of
/// another cosine.
#[inline]
pub(super) fn is_in_lens(u: [f64; 2], v: [f64; 2], cosine: f64) -> bool {
    let along = -dot(u, v);
    if along < -ORDINARY.start {
        return false; // an acute angle, no underflow: the case of nearly all calls
    }
    let (uu, vv) = (dot(u, u), dot(v, v));
    if ORDINARY.contains(&uu) && ORDINARY.contains(&vv) {
        // Without square roots.
        along > 0.0 && (cosine <= 0.0 || along * along >= cosine * cosine * (uu * vv))
    } else {
        // With unit vectors, so that nothing underflows.
        let along = -dot(u.map(|x| x / length(u)), v.map(|x| x / length(v)));
        along > 0.0 && along >= cosine
    }
}

/// Returns the area of a triangle, positive if it is counter-clockwise.
#[inline]
pub(super) fn area([p, q, r]: [[f64; 2]; 3]) -> f64 {
    let [u, v] = [minus(q, p), minus(r, p)];
    (u[0] * v[1] - u[1] * v[0]) / 2.0
}

/// A triangle, counter-clockwise.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    corners: [[f64; 2]; 3],
    /// The squared lengths of the edges from each corner to the next.
    squares: [f64; 3],
}

/// Returns the smaller number. One instruction, no branch; `f64::min` takes five, for NaN.
#[inline]
fn least(x: f64, y: f64) -> f64 {
    if x < y { x } else { y }
}

#[inline]
fn largest(x: f64, y: f64) -> f64 {
    if x > y { x } else { y }
}

impl Shape {
    #[inline(always)]
    pub(super) fn of(corners: [[f64; 2]; 3]) -> Self {
        let square = |k: usize| {
            let edge = minus(corners[(k + 1) % 3], corners[k]);
            dot(edge, edge)
        };
        Shape {
            corners,
            squares: [square(0), square(1), square(2)],
        }
    }

    /// Returns the squared length of the shortest edge.
    #[inline]
    pub(super) fn shortest(&self) -> f64 {
        let [a, b, c] = self.squares;
        least(least(a, b), c)
    }

    /// Returns the corner at which the shortest edge begins.
    #[inline]
    pub(super) fn first(&self) -> usize {
        let shorter = |j: usize, k: usize| {
            if self.squares[k] < self.squares[j] {
                k
            } else {
                j
            }
        };
        shorter(shorter(0, 1), 2)
    }

    /// Returns true if the square of the cosine of the smallest angle, by the law of cosines, is
    /// larger than a bound.
    ///
    /// `PERF:` computed for every new triangle: without a division, and without branches, because
    /// which edge is the shortest is not predictable.
    #[inline(always)]
    pub(super) fn is_thinner(self, cosine: f64) -> bool {
        let [a, b, c] = self.squares;
        // One comparison for both. Two are made at once, in one register, and then branched upon.
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        let (short, long) = (least(low, c), largest(high, c));
        if short > ORDINARY.start && long < ORDINARY.end {
            let middle = largest(low, least(high, c));
            let along = 0.5 * (middle + long - short);
            along * along > cosine * (middle * long)
        } else {
            self.squared_cosine() > cosine
        }
    }

    /// Returns the square of the cosine of the smallest angle, by unit vectors, so that nothing
    /// overflows or underflows.
    #[cold]
    fn squared_cosine(self) -> f64 {
        let [p, q, r] = self.shortest_first();
        let [u, v] = [minus(r, q), minus(p, r)].map(|edge| edge.map(|x| x / length(edge)));
        dot(u, v).powi(2)
    }

    /// Returns the corners, the two ends of the shortest edge first.
    fn shortest_first(&self) -> [[f64; 2]; 3] {
        let first = self.first();
        [0, 1, 2].map(|k| self.corners[(first + k) % 3])
    }

    #[inline]
    pub(super) fn area(&self) -> f64 {
        area(self.corners)
    }

    pub(super) fn center(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.corners.iter().map(|p| p[axis] / 3.0).sum())
    }

    /// Returns the circumcenter, or the off-center if that is nearer to the shortest edge: the
    /// point above the middle of that edge, `reach` times its length away, from which it is seen
    /// under the requested smallest angle (Üngör 2004). Takes fewer vertices than circumcenters
    /// only.
    pub(super) fn off_center(&self, reach: f64) -> [f64; 2] {
        let [p, q, r] = self.shortest_first();
        let [u, v] = [minus(q, p), minus(r, p)];
        let (uv, vu) = (u[0] * v[1], u[1] * v[0]);
        // In slivers nothing is left of the difference.
        let is_sliver = (uv - vu).abs() < 1e-6 * (uv.abs() + vu.abs());
        let doubled = 2.0
            * if is_sliver {
                twice_area(p, q, r)
            } else {
                uv - vu
            };
        let (uu, vv) = (dot(u, u), dot(v, v));
        let center = [
            (v[1] * uu - u[1] * vv) / doubled,
            (u[0] * vv - v[0] * uu) / doubled,
        ];
        let off = [0.5 * u[0] - reach * u[1], 0.5 * u[1] + reach * u[0]];
        let offset = if dot(off, off) < dot(center, center) {
            off
        } else {
            center
        };
        [0, 1].map(|axis| unsigned_zero(p[axis] + offset[axis]))
    }
}

#[cfg(test)]
mod tests {
    use super::{Shape, is_in_lens};

    #[test]
    fn lenses_are_of_any_size() {
        for scale in [1e-300, 1e-170, 1e-3, 1.0, 1e170, 1e300] {
            let [u, v] =
                [[-1.0, -0.1], [1.0, -0.1]].map(|arrow: [f64; 2]| arrow.map(|x| x * scale));
            // Seen under nearly 169 degrees.
            assert!(is_in_lens(u, v, 0.98) && !is_in_lens(u, v, 0.99), "{scale}");
            let [u, v] =
                [[-1.0, -1.1], [1.0, -1.1]].map(|arrow: [f64; 2]| arrow.map(|x| x * scale));
            assert!(
                !is_in_lens(u, v, 0.0) && !is_in_lens(u, v, -0.5),
                "{scale}: the angle is acute"
            );
        }
        assert!(!is_in_lens([0.0; 2], [1.0, 0.0], 0.5));
    }

    #[test]
    fn a_triangle_begins_at_its_shortest_edge() {
        let shape = Shape::of([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]]);
        assert_eq!(
            (shape.first(), shape.shortest(), shape.area()),
            (1, 9.0, 6.0)
        );
        let tiny = Shape::of([[0.0, 0.0], [4e-100, 0.0], [4e-100, 3e-100]]);
        for shape in [shape, tiny] {
            assert!((shape.squared_cosine() - 16.0 / 25.0).abs() < 1e-15);
            assert!(shape.is_thinner(16.0 / 25.0 - 1e-15));
            assert!(!shape.is_thinner(16.0 / 25.0 + 1e-15));
        }
        assert_eq!(
            shape.off_center(1e9),
            [2.0, 1.5],
            "a right angle's circle has its center in the longest edge"
        );
        assert_eq!(
            shape.off_center(0.5),
            [2.5, 1.5],
            "half an edge away from the middle of the shortest"
        );
    }
}
