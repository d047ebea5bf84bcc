//! The macro-element of Clough and Tocher on one triangle.
//!
//! The triangle is divided at its centroid into three cubic polynomials, given by heights and
//! gradients at the corners.
//!
//! ```text
//!            2                 coefficients of one of the three polynomials, j = 0 and k = 1,
//!           /|\                by their weights for (j, k, m), m the centroid:
//!          / | \
//!         /  m  \              300 --- 210 --- 120 --- 030
//!        / /   \ \                \ 201 --- 111 --- 021
//!       0---------1                  \ 102 --- 012
//!                                        003
//! ```

use std::hint::select_unpredictable;

use super::base::{before, minus, next};

/// A cubic surface over one triangle, which continues over its neighbors without a kink.
///
/// Along an edge the height is a cubic polynomial, and the slope in one direction across it is
/// linear; both are given by the ends of the edge alone. If two triangles choose the same direction
/// at their common edge, they fit together without a kink.
///
/// ```
/// use breakline::terrain::CubicElement;
///
/// // z = x + 2 y
/// let corners = [[0.0, 0.0, 0.0], [4.0, 0.0, 4.0], [0.0, 4.0, 8.0]];
/// let plane = CubicElement::new(corners, [[1.0, 2.0]; 3], [0.5; 3]);
/// assert_eq!(plane.height([0.25, 0.25, 0.5]), 5.0);
/// ```
#[derive(Debug, Clone)]
pub struct CubicElement {
    heights: [f64; 3],
    /// For each corner: the coefficients next to it, towards the next corner, the one before, and
    /// the centroid.
    beside: [[f64; 3]; 3],
    /// For each corner, the coefficient in the middle of the opposite polynomial.
    middle: [f64; 3],
    /// For each corner, the coefficient next to the centroid.
    inner: [f64; 3],
    center: f64,
}

impl CubicElement {
    /// The surface of height 0.
    pub const FLAT: Self = CubicElement {
        heights: [0.0; 3],
        beside: [[0.0; 3]; 3],
        middle: [0.0; 3],
        inner: [0.0; 3],
        center: 0.0,
    };

    /// Returns the surface over a triangle with these corners, in counter-clockwise order, and
    /// these gradients there.
    ///
    /// `feet` says for each corner in which direction the slope across the opposite edge is linear:
    /// from the centroid to the point at this part of the edge, 0 at the next corner and 1 at the
    /// one before.
    #[inline]
    pub fn new(corners: [[f64; 3]; 3], gradients: [[f64; 2]; 3], feet: [f64; 3]) -> Self {
        let heights = corners.map(|corner| corner[2]);
        let vector = |i: usize, j: usize| minus(corners[j], corners[i]);
        let slope = |i: usize, [x, y]: [f64; 2]| gradients[i][0] * x + gradients[i][1] * y;
        let beside = [0, 1, 2].map(|i| {
            [vector(i, next(i)), vector(i, before(i)), inward(corners, i)]
                .map(|vector| heights[i] + slope(i, vector) / 3.0)
        });
        // The slope across an edge is linear along it.
        let middle = [0, 1, 2].map(|i| {
            let (j, k) = (next(i), before(i));
            let ([jk, _, jm], [_, kj, km]) = (beside[j], beside[k]);
            let between = |from: f64, to: f64| (1.0 - feet[i]) * from + feet[i] * to;
            between(jk, kj) + 0.5 * (jm - between(heights[j], jk) + km - between(kj, heights[k]))
        });
        let inner = [0, 1, 2].map(|i| (beside[i][2] + middle[next(i)] + middle[before(i)]) / 3.0);
        CubicElement {
            heights,
            beside,
            middle,
            inner,
            center: inner.iter().sum::<f64>() / 3.0,
        }
    }

    /// Returns the height at a position, given by its barycentric coordinates.
    #[inline]
    pub fn height(&self, parts: [f64; 3]) -> f64 {
        // The polynomial over the part of the triangle between the centroid and the farthest edge.
        let (mut i, mut least) = (0, parts[0]);
        for (other, &part) in parts.iter().enumerate().skip(1) {
            i = select_unpredictable(part < least, other, i);
            least = select_unpredictable(part < least, part, least);
        }
        let (j, k) = (next(i), before(i));
        let [u, v, w] = [parts[j] - parts[i], parts[k] - parts[i], 3.0 * parts[i]];
        let ([jk, _, jm], [_, kj, km]) = (self.beside[j], self.beside[k]);
        let at_edge = self.heights[j] * u * u * u
            + 3.0 * u * v * (jk * u + kj * v)
            + self.heights[k] * v * v * v;
        let next_to_it = 3.0 * w * (jm * u * u + 2.0 * self.middle[i] * u * v + km * v * v);
        let next_to_center = 3.0 * w * w * (self.inner[j] * u + self.inner[k] * v);
        at_edge + next_to_it + next_to_center + self.center * w * w * w
    }
}

/// Returns the vector from a corner of a triangle to its centroid.
pub(super) fn inward(corners: [[f64; 3]; 3], i: usize) -> [f64; 2] {
    let [ax, ay] = minus(corners[next(i)], corners[i]);
    let [bx, by] = minus(corners[before(i)], corners[i]);
    [(ax + bx) / 3.0, (ay + by) / 3.0]
}
