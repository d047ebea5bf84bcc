//! The grid of rounding, and its pixels.

use crate::kernel::{CornerSide, CrossingSide, Kernel, Orientation2, Predicate, RANGE};
use crate::num::{Dyadic, Sign};

/// A power of two on each axis: crossings are rounded to multiples of it.
///
/// A *pixel* is the half-open rectangle of this size around a place: it holds its left and its lower border.
/// Those around multiples of the unit tile the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grid {
    pub(super) unit: [f64; 2],
    /// Half of it, the reach of a pixel.
    pub(super) half: [f64; 2],
}

/// The unit in the last place of a number.
fn last_place(x: f64) -> f64 {
    let x = x.abs();
    // Of the largest numbers there is none above.
    if x < f64::MAX / 2.0 { x.next_up() - x } else { x - x.next_down() }
}

impl Grid {
    /// The finest on which every number up to these magnitudes has a neighbor at each multiple.
    pub(super) fn of_magnitudes(largest: [f64; 2]) -> Self {
        let unit = largest.map(last_place);
        Grid { unit, half: unit.map(|u| u / 2.0) }
    }

    /// Whether a place is a multiple of the unit on both axes.
    pub(super) fn holds(&self, place: [f64; 2]) -> bool {
        (0..2).all(|k| {
            let steps = place[k] / self.unit[k]; // at most 2^53, and exact unless it vanishes
            steps == steps.trunc() && steps * self.unit[k] == place[k]
        })
    }

    /// Of a place within the magnitudes: the number of its pixel on each axis.
    pub(super) fn pixel(&self, place: [f64; 2]) -> [i64; 2] {
        std::array::from_fn(|k| {
            // Floor first: adding a half to a large odd number would round.
            let steps = place[k] / self.unit[k];
            let below = steps.floor();
            below as i64 + i64::from(steps - below >= 0.5)
        })
    }

    /// Whether a segment has a point in the pixel around a place.
    ///
    /// Of two convex sets without a common point, a line along a side of one of them keeps them apart: a side of the pixel
    /// or the segment. That the pixel lacks two of its sides makes no difference: it is the union of growing
    /// closed rectangles.
    pub(super) fn hits<K: Kernel>(&self, [a, b]: [[f64; 2]; 2], center: [f64; 2]) -> bool {
        let within = |k: usize| {
            let (low, high) = if a[k] < b[k] { (a[k], b[k]) } else { (b[k], a[k]) };
            reaches(high, center[k], -self.half[k]) && !reaches(low, center[k], self.half[k])
        };
        if !within(0) || !within(1) {
            return false;
        }
        let [rightward, upward] = [0, 1].map(|k| b[k] - a[k]);
        if rightward == 0.0 || upward == 0.0 {
            return true; // along an axis, the intervals have said all
        }
        let [hx, hy] = self.half;
        let side = |offset| K::sign(&CornerSide { segment: [a, b], center, offset });
        // The two corners furthest to the left and to the right of the line; of all four only the lower left one is
        // part of the pixel.
        if (rightward > 0.0) == (upward > 0.0) {
            side([-hx, hy]) * side([hx, -hy]) == Sign::Negative
        } else {
            match side([-hx, -hy]) {
                Sign::Zero => true,
                lower_left => lower_left * side([hx, hy]) == Sign::Negative,
            }
        }
    }

    /// Where two segments cross in their interiors, rounded to the grid: the center of the pixel that the crossing lies
    /// in, exactly.
    pub(super) fn crossing<K: Kernel>(&self, ab: [[f64; 2]; 2], cd: [[f64; 2]; 2]) -> [f64; 2] {
        let turn = K::sign(&Orientation2([cd[0], cd[1], ab[0]]));
        std::array::from_fn(|along| self.round::<K>(ab, cd, turn, along))
    }

    fn round<K: Kernel>(&self, ab: [[f64; 2]; 2], cd: [[f64; 2]; 2], turn: Sign, along: usize) -> f64 {
        let (unit, half) = (self.unit[along], self.half[along]);
        let side = |center: f64, offset: f64| turn * K::sign(&CrossingSide { ab, cd, along, center, offset });
        let nearest = |x: f64| (x / unit).round() * unit;
        let mut center = nearest(estimate(ab, cd, along));
        for tries in 0.. {
            if side(center, -half) == Sign::Negative {
                center -= unit;
            } else if side(center, half) != Sign::Negative {
                center += unit;
            } else {
                break;
            }
            if tries == 3 {
                // The estimate was far off: a small angle. The exact way there, rounded, leaves a step or two.
                let beside = CrossingSide { ab, cd, along, center, offset: 0.0 }.value(Dyadic::difference);
                center = nearest(center + beside.quotient(&divisor(ab, cd)));
            }
        }
        center + 0.0 // zero has one sign only
    }

    /// Whether the crossing of two segments lies in the pixel around a place.
    pub(super) fn crossing_in<K: Kernel>(&self, ab: [[f64; 2]; 2], cd: [[f64; 2]; 2], center: [f64; 2]) -> bool {
        let turn = K::sign(&Orientation2([cd[0], cd[1], ab[0]]));
        (0..2).all(|along| {
            let side = |offset| turn * K::sign(&CrossingSide { ab, cd, along, center: center[along], offset });
            side(-self.half[along]) != Sign::Negative && side(self.half[along]) == Sign::Negative
        })
    }
}

/// About where segments cross, on one axis.
fn estimate([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2], along: usize) -> f64 {
    let area = |p: [f64; 2]| (d[0] - c[0]) * (p[1] - c[1]) - (d[1] - c[1]) * (p[0] - c[0]);
    let (at_a, at_b) = (area(a), area(b));
    let fraction = at_a / (at_a - at_b);
    let fraction = if (0.0..=1.0).contains(&fraction) { fraction } else { 0.5 };
    let x = a[along] * (1.0 - fraction) + b[along] * fraction;
    x.clamp(a[along].min(b[along]), a[along].max(b[along]))
}

/// What [`CrossingSide`] divides by.
fn divisor([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> Dyadic {
    let [turn_a, turn_b] = [a, b].map(|p| Orientation2([c, d, p]).value(Dyadic::difference));
    turn_a - turn_b
}

/// Whether `x >= center + offset`, exactly, for an offset that is a power of two.
fn reaches(x: f64, center: f64, offset: f64) -> bool {
    let way = x - center;
    if way != offset {
        return way > offset; // rounding is monotone
    }
    // Knuth's error of the difference.
    let back = way - x;
    let error = (x - (way - back)) - (center + back);
    error >= 0.0
}

/// Whether the fast kernels are right for these magnitudes, the halves of units included.
pub(super) fn is_ordinary(grid: &Grid, places: impl Iterator<Item = [f64; 2]>) -> bool {
    grid.half.iter().all(|&half| RANGE.admits(half)) && places.flatten().all(|x| RANGE.admits(x))
}
