//! The grid of rounding, and its pixels.

use crate::kernel::{CornerSide, CrossingSide, Kernel, Orientation2, Predicate, RANGE};
use crate::num::lattice::lowest_bit;
use crate::num::{Dyadic, Pair, Sign, unsigned_zero};

use super::boxes::Box2;
use super::segment::{Segment, Site, lexicographic};

/// The sites to which crossings are rounded. On each axis these are either the multiples of the
/// *unit*, a power of two; or the doubles, of which those near zero are multiples of the *smallest*
/// step.
///
/// The *pixel* of a site is what is nearer to it than to its neighbors, a half-open rectangle that
/// contains its left and its lower border. Pixels tile the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grid {
    pub(super) unit: [f64; 2],
    pub(super) is_even: bool,
    /// Used off the even grid only.
    smallest: [f64; 2],
    /// True if coordinates are in the range of the fast kernels. Halves of steps then enter their
    /// polynomials as multiples of 2^-213 instead of 2^-212, which is sound because the degree is
    /// only 3.
    pub(super) is_ordinary: bool,
}

/// Returns the unit in the last place of a number.
pub(super) fn ulp(x: f64) -> f64 {
    let x = x.abs();
    // The largest numbers have no neighbor above.
    if x < f64::MAX / 2.0 {
        x.next_up() - x
    } else {
        x - x.next_down()
    }
}

impl Grid {
    /// Returns the grid for sites up to these magnitudes: with equal steps, if all given sites lie
    /// on it, else with the steps of doubles, but none smaller than `smallest`.
    pub(super) fn through(largest: Site, smallest: Site, sites: [&[Site]; 2]) -> Self {
        let is_ordinary = sites
            .into_iter()
            .all(|some| some.as_flattened().iter().all(|&x| RANGE.admits(x)));
        // Crossings of what the fast kernels admit must be admitted.
        let ordinary = RANGE.min * f64::EPSILON;
        let smallest = if is_ordinary {
            smallest.map(|step| step.max(ordinary))
        } else {
            smallest
        };
        let unit = [0, 1].map(|k| ulp(largest[k]).max(smallest[k]));
        let mut grid = Grid {
            unit,
            is_even: true,
            smallest,
            is_ordinary,
        };
        grid.is_even = sites
            .into_iter()
            .all(|some| some.iter().all(|&site| grid.holds(site)));
        grid
    }

    /// Returns the same grid with equal steps, or with the steps of doubles.
    pub(super) fn with_steps(self, is_even: bool) -> Self {
        Grid { is_even, ..self }
    }

    /// Returns the distance from a site to the next one above, on an axis.
    #[inline(always)]
    fn gap_above(&self, axis: usize, x: f64) -> f64 {
        if self.is_even {
            return self.unit[axis];
        }
        (x.next_up() - x).clamp(self.smallest[axis], self.unit[axis])
    }

    /// Returns how far the pixel around a value reaches down on an axis.
    #[inline(always)]
    fn down(&self, axis: usize, x: f64) -> f64 {
        self.gap_above(axis, -x) / 2.0 // nothing, if the gap is one that has no half
    }

    /// Returns how far the pixel around a value reaches up on an axis.
    #[inline(always)]
    fn up(&self, axis: usize, x: f64) -> f64 {
        let gap = self.gap_above(axis, x);
        gap - gap / 2.0
    }

    /// Returns the site nearest to a value, on an axis.
    fn nearest(&self, axis: usize, x: f64) -> f64 {
        let step = self.gap_above(axis, x);
        unsigned_zero((x / step).round() * step)
    }

    /// Returns a box around the pixel of a site.
    pub(super) fn around(&self, site: Site) -> Box2 {
        let halves = [0, 1].map(|k| self.down(k, site[k]).max(self.up(k, site[k])));
        Box2::around([site, site]).grown(halves)
    }

    /// Returns true if a site is the center of a pixel, in the arithmetic that is used.
    pub(super) fn has(&self, site: Site) -> bool {
        let is_center = !self.is_even || self.holds(site);
        is_center && (!self.is_ordinary || site.iter().all(|&x| RANGE.admits(x)))
    }

    /// Returns true if a site is a multiple of the unit on both axes.
    pub(super) fn holds(&self, site: Site) -> bool {
        (0..2).all(|k| site[k] == 0.0 || lowest_bit(site[k]) >= lowest_bit(self.unit[k]))
    }

    /// Returns true if a segment has a point in the pixel around a site.
    ///
    /// Two convex sets without a common point are separated by a line along a side of one of them:
    /// a side of the pixel, or the segment. That the pixel lacks two of its sides makes no
    /// difference: it is the union of growing closed rectangles.
    pub(super) fn hits<K: Kernel>(&self, [a, b]: Segment, center: Site) -> bool {
        let within = |k: usize| {
            let (low, high) = if a[k] < b[k] {
                (a[k], b[k])
            } else {
                (b[k], a[k])
            };
            reaches(high, center[k], -self.down(k, center[k]))
                && !reaches(low, center[k], self.up(k, center[k]))
        };
        if !within(0) || !within(1) {
            return false;
        }
        let [rightward, upward] = [0, 1].map(|k| b[k] - a[k]);
        if rightward == 0.0 || upward == 0.0 {
            return true; // along an axis, the intervals decide
        }
        let [left, down] = [0, 1].map(|k| -self.down(k, center[k]));
        let [right, up] = [0, 1].map(|k| self.up(k, center[k]));
        let side = |offset| {
            K::sign(&CornerSide {
                segment: [a, b],
                center,
                offset,
            })
        };
        // The two corners furthest to the left and to the right of the line. Of all four corners,
        // only the lower left one belongs to the pixel.
        if (rightward > 0.0) == (upward > 0.0) {
            side([left, up]) * side([right, down]) == Sign::Negative
        } else {
            match side([left, down]) {
                Sign::Zero => true,
                lower_left => lower_left * side([right, up]) == Sign::Negative,
            }
        }
    }

    /// Returns keys that sort the sites whose pixels a segment meets, from its lexicographically
    /// smaller end.
    ///
    /// Pixels are ordered by their centers on the axis along which the segment is longer, in units,
    /// and within a column from one side to the other.
    #[inline]
    pub(super) fn along(&self, [a, b]: Segment) -> impl Fn(Site) -> Site + use<> {
        let (a, b) = if lexicographic(a, b).is_le() {
            (a, b)
        } else {
            (b, a)
        };
        let [dx, dy] = [0, 1].map(|k| b[k] / self.unit[k] - a[k] / self.unit[k]);
        let axes = if dx.abs() >= dy.abs() { [0, 1] } else { [1, 0] };
        let is_upward = axes.map(|k| a[k] <= b[k]);
        move |site| {
            [0, 1].map(|n| {
                if is_upward[n] {
                    site[axes[n]]
                } else {
                    -site[axes[n]]
                }
            })
        }
    }

    /// Returns where two segments cross in their interiors, rounded to the grid: the center of the
    /// pixel that contains the exact crossing.
    pub(super) fn crossing<K: Kernel>(&self, ab: Segment, cd: Segment) -> Site {
        if let Some(center) = self.crossing_by_pairs(ab, cd) {
            return center;
        }
        let turn = K::sign(&Orientation2([cd[0], cd[1], ab[0]]));
        std::array::from_fn(|along| self.round::<K>(ab, cd, turn, along))
    }

    /// Like `crossing`, computed with twice the digits of a double; `None` if the error leaves a
    /// doubt.
    fn crossing_by_pairs(&self, [a, b]: Segment, [c, d]: Segment) -> Option<Site> {
        if !self.is_ordinary {
            return None;
        }
        let minus = |p: Site, q: Site| [0, 1].map(|k| Pair::difference(p[k], q[k]));
        let ([ux, uy], [vx, vy], vector) = (minus(d, c), minus(a, c), minus(a, b));
        let products = [ux * vy, uy * vx, ux * vector[1], uy * vector[0]];
        let [area, divisor] = [products[0] - products[1], products[2] - products[3]];
        let fraction = area / divisor;
        // Each area is computed from two products and a difference; ten roundings cover all that
        // they and the quotient have.
        let error =
            |p: Pair, q: Pair| 10.0 * Pair::ERROR * (p.estimate().abs() + q.estimate().abs());
        let divided = divisor.estimate().abs();
        let doubt = error(products[2], products[3]);
        if doubt.is_nan() || doubt >= divided / 4.0 {
            return None;
        }
        let of_fraction =
            2.0 * (error(products[0], products[1]) + doubt) / divided + 10.0 * Pair::ERROR;
        let mut center = [0.0; 2];
        for (along, center) in center.iter_mut().enumerate() {
            let x = Pair::difference(a[along], 0.0) - vector[along] * fraction;
            let doubt =
                of_fraction * vector[along].estimate().abs() + 10.0 * Pair::ERROR * a[along].abs();
            *center = self.nearest(along, x.estimate());
            let beside = (x - Pair::difference(*center, 0.0)).estimate();
            let inside = -self.down(along, *center) + 2.0 * doubt < beside
                && beside < self.up(along, *center) - 2.0 * doubt;
            if !inside {
                return None;
            }
        }
        Some(center)
    }

    fn round<K: Kernel>(&self, ab: Segment, cd: Segment, turn: Sign, along: usize) -> f64 {
        let side = |center: f64, offset: f64| {
            turn * K::sign(&CrossingSide {
                ab,
                cd,
                along,
                center,
                offset,
            })
        };
        let mut center = self.nearest(along, estimate(ab, cd, along));
        for tries in 0.. {
            let step = if side(center, -self.down(along, center)) == Sign::Negative {
                -self.gap_above(along, -center)
            } else if side(center, self.up(along, center)) != Sign::Negative {
                self.gap_above(along, center)
            } else {
                break;
            };
            // An estimate is a step or two off, unless the angle is small. Then move by the exact
            // distance, rounded, as long as it is more than a step or two.
            let exact = || {
                CrossingSide {
                    ab,
                    cd,
                    along,
                    center,
                    offset: 0.0,
                }
                .value(Dyadic::difference)
            };
            let move_by = if tries < 2 {
                step
            } else {
                exact().quotient(&divisor(ab, cd))
            };
            center = if move_by.abs() <= 1.5 * step.abs() {
                center + step
            } else {
                self.nearest(along, center + move_by)
            };
        }
        unsigned_zero(center)
    }
}

/// Returns about where two segments cross, on one axis.
fn estimate([a, b]: Segment, [c, d]: Segment, along: usize) -> f64 {
    let area = |p: Site| (d[0] - c[0]) * (p[1] - c[1]) - (d[1] - c[1]) * (p[0] - c[0]);
    let (at_a, at_b) = (area(a), area(b));
    let fraction = at_a / (at_a - at_b);
    let fraction = if (0.0..=1.0).contains(&fraction) {
        fraction
    } else {
        0.5
    };
    let x = a[along] * (1.0 - fraction) + b[along] * fraction;
    x.clamp(a[along].min(b[along]), a[along].max(b[along]))
}

/// Returns the divisor of [`CrossingSide`].
fn divisor([a, b]: Segment, [c, d]: Segment) -> Dyadic {
    let [turn_a, turn_b] = [a, b].map(|p| Orientation2([c, d, p]).value(Dyadic::difference));
    turn_a - turn_b
}

/// Returns true if `x >= center + offset`, exactly, for an offset that is a power of two.
fn reaches(x: f64, center: f64, offset: f64) -> bool {
    let distance = x - center;
    if distance != offset {
        return distance > offset; // rounding is monotone
    }
    // Knuth's error of the difference.
    let back = distance - x;
    let error = (x - (distance - back)) - (center + back);
    error >= 0.0
}
