//! A surface without kinks except at hard edges: the macro-element of Clough and Tocher.
//!
//! Each triangle has one [`CubicElement`]. The slope across an edge in the direction of its normal
//! is linear along it, so two triangles fit together without a kink.
//!
//! # At hard edges
//!
//! The gradient at a vertex is that of the plane which fits its neighbors best, by least squares
//! with weights of 1 over the square of the distance. Only neighbors are used that are reached
//! around the vertex without crossing a hard edge: a vertex of a breakline has a gradient on each
//! side, and the kink stays.
//!
//! Along a hard edge both sides would have cubic curves of their own. There the height must be
//! linear, as on the breakline. So `E = l_j l_k (A l_j + B l_k) w` is added, with barycentric
//! coordinates `l`. The cubic factor is the difference on the edge. The weight is `w = e_i / e`,
//! where `e_i = (l_j l_k)^2` and `e` is the sum of all three. It is 1 on the edge and vanishes on
//! the two others, together with its gradient (after Nielson 1979). So no kink arises there.

use super::base::{Base, before, cross, minus, next, square};
use super::element::{CubicElement, inward};

/// One triangle with its polynomials.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    face: u32,
    /// From the smallest by x and y, so that sums do not depend on the numbering.
    corners: [[f64; 3]; 3],
    /// Twice its area.
    area: f64,
    element: CubicElement,
    /// For each hard edge, by the opposite corner, what makes it linear.
    hard: [Option<[f64; 2]>; 3],
}

impl Patch {
    /// Returns the patch over a triangle, given the index of its smallest corner.
    ///
    /// # Complexity
    /// Proportional to the number of triangles around its corners.
    pub(super) fn new(base: &Base, face: u32, first: usize) -> Self {
        let order = [first, next(first), before(first)];
        let all = base.corners(face);
        let corners = order.map(|i| all[i]);
        let gradients = order.map(|i| gradient(base, face, i));
        let vector = |i: usize, j: usize| minus(corners[j], corners[i]);
        let slope = |i: usize, [x, y]: [f64; 2]| gradients[i][0] * x + gradients[i][1] * y;
        let normals = [0, 1, 2].map(|i| {
            let (j, k) = (next(i), before(i));
            let (edge, to_center) = (vector(j, k), inward(corners, j));
            (edge[0] * to_center[0] + edge[1] * to_center[1]) / square(edge)
        });
        let hard = [0, 1, 2].map(|i| {
            let (j, k) = (next(i), before(i));
            let rise = corners[k][2] - corners[j][2];
            base.face(face)
                .is_hard(order[i])
                .then(|| [rise - slope(j, vector(j, k)), slope(k, vector(j, k)) - rise])
        });
        let area = cross(vector(0, 1), vector(0, 2));
        Patch {
            face,
            corners,
            area,
            element: CubicElement::new(corners, gradients, normals),
            hard,
        }
    }

    /// Returns the number of the triangle.
    pub(super) fn face(&self) -> u32 {
        self.face
    }

    /// Returns the height at a position in the triangle; `None` if a number overflows or
    /// underflows.
    pub(super) fn height(&self, q: [f64; 2]) -> Option<f64> {
        let to = self.corners.map(|p| minus(p, [q[0], q[1], 0.0]));
        let parts = [0, 1, 2].map(|i| cross(to[next(i)], to[before(i)]) / self.area);
        let height = self.element.height(parts) + self.correction(parts);
        height.is_finite().then_some(height)
    }

    /// Returns what makes the heights linear along hard edges.
    fn correction(&self, parts: [f64; 3]) -> f64 {
        if self.hard == [None; 3] {
            return 0.0;
        }
        let products = [0, 1, 2].map(|i| parts[next(i)] * parts[before(i)]);
        let sum: f64 = products.iter().map(|product| product * product).sum();
        if sum <= 0.0 {
            return 0.0;
        }
        let of_edge = |i: usize| {
            self.hard[i].map_or(0.0, |[a, b]| {
                products[i]
                    * (a * parts[next(i)] + b * parts[before(i)])
                    * products[i]
                    * products[i]
                    / sum
            })
        };
        of_edge(0) + of_edge(1) + of_edge(2)
    }
}

/// The sums of a least squares fit of a plane through a vertex.
#[derive(Debug, Default)]
struct Fit {
    xx: f64,
    xy: f64,
    yy: f64,
    xz: f64,
    yz: f64,
}

impl Fit {
    /// Adds a neighbor.
    fn add(&mut self, [x, y]: [f64; 2], z: f64) {
        let weight = 1.0 / (x * x + y * y);
        self.xx += weight * x * x;
        self.xy += weight * x * y;
        self.yy += weight * y * y;
        self.xz += weight * x * z;
        self.yz += weight * y * z;
    }

    /// Returns the gradient. If the neighbors are nearly in a line, the plane is level across it.
    fn gradient(&self) -> [f64; 2] {
        /// Of the smaller to the larger spread of the directions.
        const NARROWEST: f64 = 1e-5;
        let spread = self.xx + self.yy;
        let determinant = self.xx * self.yy - self.xy * self.xy;
        if determinant > NARROWEST * spread * spread {
            [
                (self.xz * self.yy - self.yz * self.xy) / determinant,
                (self.yz * self.xx - self.xz * self.xy) / determinant,
            ]
        } else {
            [self.xz / spread, self.yz / spread]
        }
    }
}

/// Returns the gradient at corner `i` of a triangle, from the neighbors on the same side of hard
/// edges.
///
/// It is reduced where it would miss a neighbor by more than twice the largest difference of
/// heights around the vertex: at the foot of a slope, next to triangles that are much longer than
/// those on the slope.
fn gradient(base: &Base, face: u32, i: usize) -> [f64; 2] {
    let (mut fit, mut relief) = (Fit::default(), 0.0_f64);
    each_neighbor(base, face, i, |to, rise| {
        fit.add(to, rise);
        relief = relief.max(rise.abs());
    });
    let [x, y] = fit.gradient();
    let mut part = 1.0_f64;
    each_neighbor(base, face, i, |to, rise| {
        let reached = x * to[0] + y * to[1];
        let allowed = 2.0 * relief + if reached < 0.0 { -rise } else { rise };
        if part * reached.abs() > allowed {
            part = allowed / reached.abs();
        }
    });
    [part * x, part * y]
}

/// Calls `each` with the vector to each neighbor of corner `i` of a triangle, and the difference of
/// heights: those that are reached without crossing a hard edge.
fn each_neighbor(base: &Base, face: u32, i: usize, mut each: impl FnMut([f64; 2], f64)) {
    let vertex = base.face(face).corners[i];
    let at = base.point(vertex);
    let mut add = |neighbor: u32| {
        let p = base.point(neighbor);
        each(minus(p, at), p[2] - at[2]);
    };
    // Clockwise to a closed edge, or once around.
    let (mut at_face, mut at_corner, mut steps) = (face, i, 0);
    while let Some((beyond, j)) = base
        .across(at_face, before(at_corner))
        .filter(|_| steps < base.count())
    {
        // The edge passed ends at the vertex, and its other end is next to it.
        (at_face, at_corner) = (beyond, before(j));
        steps += 1;
        if at_face == face {
            break;
        }
    }
    // Back, over all neighbors. The other end of a line that ends here counts once.
    let first = base.face(at_face).corners[next(at_corner)];
    add(first);
    for _ in 0..=base.count() {
        let neighbor = base.face(at_face).corners[before(at_corner)];
        if neighbor == first {
            break;
        }
        add(neighbor);
        match base.across(at_face, next(at_corner)) {
            Some((beyond, j)) => (at_face, at_corner) = (beyond, next(j)),
            None => break,
        }
    }
}
