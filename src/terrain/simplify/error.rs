//! How far points are above or below a triangle.

use crate::triangulation::kernel::{Adaptive, Kernel, Predicate};
use crate::triangulation::num::{Number, Sign};

/// The share of the heights at hand within which rounding may decide wrongly: far more than the
/// errors of [`Slopes`] in triangles that are not thin, and far less than what is measured.
const UNCERTAIN: f64 = 1.0 / (1_u64 << 32) as f64;

/// Positive if a point lies further above (`above`) or below a triangle than the bound.
///
/// The vertical distance from the plane is a ratio of two determinants; multiplied by the area, it
/// is a polynomial, whose sign is exact.
#[derive(Debug, Clone, Copy)]
struct Excess {
    /// The corners, counter-clockwise in plan.
    corners: [[f64; 3]; 3],
    point: [f64; 3],
    bound: f64,
    above: bool,
}

impl Predicate for Excess {
    const DEGREE: i32 = 3;
    const AXES: usize = 3;

    fn axis(&self, axis: usize) -> impl Iterator<Item = f64> + Clone {
        let of_bound = [self.bound, 0.0].into_iter().filter(move |_| axis == 2);
        let points = self.corners.iter().chain([&self.point]);
        points.map(move |p| p[axis]).chain(of_bound)
    }

    fn value<T: Number>(&self, difference: impl Fn(f64, f64) -> T + Copy) -> T {
        let [a, b, c] = self.corners;
        let from_a = |p: [f64; 3]| [0, 1, 2].map(|axis| difference(p[axis], a[axis]));
        let [bx, by, bz] = from_a(b);
        let [cx, cy, cz] = from_a(c);
        let [qx, qy, qz] = from_a(self.point);
        let area = bx.clone() * cy.clone() - by.clone() * cx.clone();
        let of_c = bx * qy.clone() - by * qx.clone();
        let of_b = qx * cy - qy * cx;
        let plane = bz * of_b + cz * of_c;
        let bound = difference(self.bound, 0.0) * area.clone();
        if self.above {
            qz * area - plane - bound
        } else {
            plane - qz * area - bound
        }
    }
}

/// Returns true if a point lies further above or below a triangle than the bound; exact.
///
/// The corners are counter-clockwise in plan.
pub(super) fn exceeds(corners: [[f64; 3]; 3], point: [f64; 3], bound: f64) -> bool {
    [true, false].into_iter().any(|above| {
        Adaptive::sign(&Excess {
            corners,
            point,
            bound,
            above,
        }) == Sign::Positive
    })
}

/// Returns a rounded error, corrected to be above the bound if, and only if, the real number is.
///
/// `is_beyond` says which, exactly. It is called only where the rounding errors could decide.
#[inline(always)]
pub(super) fn decided(
    error: f64,
    uncertainty: f64,
    bound: f64,
    is_beyond: impl FnOnce() -> bool,
) -> f64 {
    if (error - bound).abs() > uncertainty {
        error
    } else if is_beyond() {
        error.max(bound.next_up())
    } else {
        error.min(bound)
    }
}

/// The plane of a triangle, rounded: heights relative to one of its corners.
#[derive(Clone, Copy)]
pub(super) struct Slopes {
    pub(super) origin: [f64; 3],
    pub(super) along: [f64; 2],
    /// A bound of the rounding errors of [`residual`](Self::residual) within the triangle.
    pub(super) uncertainty: f64,
}

impl Slopes {
    /// The plane of a triangle, given its positions in any coordinates of the plan. `None` if it
    /// has no area in them.
    ///
    /// The result depends on the order of the corners.
    #[inline]
    pub(super) fn of([a, b, c]: [[f64; 3]; 3]) -> Option<Self> {
        let [bx, by, bz] = [0, 1, 2].map(|axis| b[axis] - a[axis]);
        let [cx, cy, cz] = [0, 1, 2].map(|axis| c[axis] - a[axis]);
        let area = bx * cy - by * cx;
        if area == 0.0 {
            return None;
        }
        let inverse = 1.0 / area;
        let (of_b, of_c) = (bz * inverse, cz * inverse);
        let box_of = larger(bx.abs(), cx.abs()) * larger(by.abs(), cy.abs());
        let thinness = box_of * inverse.abs();
        let heights = a[2].abs() + bz.abs() + cz.abs();
        Some(Slopes {
            origin: a,
            along: [of_b * cy - of_c * by, of_c * bx - of_b * cx],
            uncertainty: UNCERTAIN * heights * (1.0 + thinness),
        })
    }

    /// How far a point is above the plane.
    #[inline(always)]
    pub(super) fn residual(&self, q: [f64; 3]) -> f64 {
        let [a, along] = [self.origin, [self.along[0], self.along[1], 0.0]];
        (q[2] - a[2]) - along[0] * (q[0] - a[0]) - along[1] * (q[1] - a[1])
    }
}

/// Returns the larger of two numbers; the second one if one is NaN.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The worst of some points: the largest distance, and of equal ones the lowest number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Worst {
    pub(super) error: f64,
    pub(super) site: u32,
}

impl Worst {
    pub(super) const NONE: Worst = Worst {
        error: 0.0,
        site: u32::MAX,
    };

    #[inline(always)]
    pub(super) fn add(&mut self, error: f64, site: u32) {
        if error > self.error || (error == self.error && site < self.site) {
            *self = Worst { error, site };
        }
    }
}
