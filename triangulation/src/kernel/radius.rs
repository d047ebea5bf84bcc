//! The squared radius of the sphere that is orthogonal to four weighted points `[x, y, z, weight]`:
//! its center has the same power to all four, and this is that power. With weights of zero it is
//! that of the circumscribed sphere.

use std::cell::OnceCell;
use std::cmp::Ordering;

use super::center::offset_in_space;
use super::formula::{square, squared_length};
use crate::num::{Bounded, Dyadic, Integer, Number, Pair, Sign, lattice, unsigned_zero};

/// A quotient `above / below` with a positive `below`.
#[derive(Debug, Clone, Copy)]
struct Quotient<T> {
    above: T,
    below: T,
}

/// Returns the squared radius, and the volume that it is divided by, which is not zero unless the
/// points are coplanar.
fn quotient<T: Number>(
    corners: [[f64; 4]; 4],
    difference: impl Fn(f64, f64) -> T + Copy,
) -> (Quotient<T>, T) {
    let (offset, volume) = offset_in_space(corners, difference);
    let double = volume.clone() + volume.clone();
    let below = square(&double);
    let above = squared_length(&offset) - difference(corners[0][3], 0.0) * below.clone();
    (Quotient { above, below }, volume)
}

/// A squared radius, rounded.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RoundedRadius {
    /// The number to within `2^-44` of it; infinite for coplanar points.
    pub(crate) value: f64,
    /// Two numbers between which it lies.
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl RoundedRadius {
    /// Returns a number that is correct to within two units in the last place.
    fn near(value: f64) -> Self {
        if value.is_infinite() {
            return RoundedRadius {
                value,
                low: value.min(f64::MAX),
                high: value.max(f64::MIN),
            };
        }
        let margin = 4.0 * f64::EPSILON * value.abs() + f64::MIN_POSITIVE;
        RoundedRadius {
            value,
            low: value - margin,
            high: value + margin,
        }
    }
}

/// A squared radius that is compared without rounding.
pub(crate) struct SquaredRadius {
    quick: Quick,
    exact: OnceCell<Box<ExactRadius>>,
}

/// A squared radius in as few digits as are likely to decide.
enum Quick {
    Whole(Quotient<i128>),
    Pair(Quotient<Bounded<Pair>>),
}

/// The weights and the squared distances of the corners of a cell. Cells that have the same are
/// congruent, and have the same radius.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct Congruence {
    weights: [u64; 4],
    distances: [i128; 6],
}

/// Computes the squared radii of the cells of a triangulation.
pub(crate) struct SquaredRadii {
    /// The inverse of a power of two of which all coordinates, and its square of which all weights,
    /// are multiples.
    inverse_unit: Option<f64>,
    /// That of a power of two of which all coordinates are multiples.
    inverse_step: Option<f64>,
}

impl SquaredRadii {
    /// Returns those of cells with corners among these points.
    pub(crate) fn among(points: impl Iterator<Item = [f64; 4]>) -> Self {
        let smaller = |a: Option<i32>, b: Option<i32>| a.into_iter().chain(b).min();
        let lowest_bit = |numbers: &[f64]| {
            let bits = numbers.iter().filter_map(|&x| lattice::lowest_bit(x));
            bits.min()
        };
        let (of_sites, of_weights) = points.fold((None, None), |(sites, weights), p| {
            let (site, weight) = p.split_at(3);
            (
                smaller(sites, lowest_bit(site)),
                smaller(weights, lowest_bit(weight)),
            )
        });
        // Its square is a normal number, too.
        let inverse = |lowest: Option<i32>| {
            let lowest = lowest.unwrap_or(0);
            (-500..=500)
                .contains(&lowest)
                .then(|| lattice::power_of_two(-lowest))
        };
        SquaredRadii {
            inverse_unit: inverse(smaller(of_sites, of_weights.map(|bit| bit.div_euclid(2)))),
            inverse_step: inverse(of_sites),
        }
    }

    /// Returns the squared radius of a cell, rounded.
    pub(crate) fn rounded(&self, corners: [[f64; 4]; 4]) -> RoundedRadius {
        const TOLERANCE: f64 = 1.0 / (1u64 << 44) as f64;
        let (low, high) = squared_radius_bounds(corners);
        if high.is_finite() && high - low <= TOLERANCE * low.abs() {
            return RoundedRadius {
                value: 0.5 * low + 0.5 * high,
                low,
                high,
            };
        }
        let value = self.quick(corners).value(self.inverse_unit);
        RoundedRadius::near(value.unwrap_or_else(|| ExactRadius::of(corners).value()))
    }

    /// Returns the squared radius of a cell, to be compared.
    pub(crate) fn to_compare(&self, corners: [[f64; 4]; 4]) -> SquaredRadius {
        SquaredRadius {
            quick: self.quick(corners),
            exact: OnceCell::new(),
        }
    }

    /// Returns what a cell has in common with congruent ones; `None` if its size needs more digits
    /// than `f64` has.
    ///
    /// The corners are sorted by their weights and distances. Where these do not distinguish them,
    /// congruent cells may give different results.
    pub(crate) fn congruence(&self, corners: [[f64; 4]; 4]) -> Option<Congruence> {
        const BITS: i32 = 53;
        let inverse = self.inverse_step?;
        let axes = [0, 1, 2]
            .into_iter()
            .map(|axis| corners.iter().map(move |p| p[axis]));
        if !lattice::fit(axes, inverse, BITS) {
            return None;
        }
        let distance = |i: usize, j: usize| -> i128 {
            let along = |axis: usize| {
                let [a, b] = [i, j].map(|corner| corners[corner][axis]);
                lattice::difference(a, b, inverse)
            };
            (0..3).map(|axis| along(axis) * along(axis)).sum()
        };
        let mut sorted = [0, 1, 2, 3].map(|i| {
            let mut to_others = [0, 1, 2, 3].map(|j| distance(i, j));
            to_others.sort_unstable();
            (unsigned_zero(corners[i][3]).to_bits(), to_others, i)
        });
        sorted.sort_unstable();
        let at = sorted.map(|(.., corner)| corner);
        let pairs = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
        Some(Congruence {
            weights: sorted.map(|(weight, ..)| weight),
            distances: pairs.map(|[i, j]| distance(at[i], at[j])),
        })
    }

    fn quick(&self, corners: [[f64; 4]; 4]) -> Quick {
        match self.whole(corners) {
            Some(quotient) => Quick::Whole(quotient),
            None => Quick::Pair(quotient(corners, Bounded::exact_difference).0),
        }
    }

    /// Returns the squared radius in units, if 128 bits suffice and the points are not coplanar.
    ///
    /// Let differences be below `2^b`, and weights below `2^2b`. The lifts are then below
    /// `2^(2b+3)`, the offset to the center below `2^(4b+6)`, its squared length, plus a weight
    /// times the denominator of less than `2^(6b+8)`, below `2^(8b+15)`. For 14 bits
    /// that is `2^127`.
    fn whole(&self, corners: [[f64; 4]; 4]) -> Option<Quotient<i128>> {
        const BITS: i32 = 14;
        let inverse = self.inverse_unit?;
        let in_units = corners
            .map(|[x, y, z, w]| [x * inverse, y * inverse, z * inverse, w * inverse * inverse]);
        let is_light = in_units
            .iter()
            .all(|p| p[3].abs() < lattice::power_of_two(2 * BITS));
        let axes = [0, 1, 2]
            .into_iter()
            .map(|axis| in_units.iter().map(move |p| p[axis]));
        if !is_light || !lattice::fit(axes, 1.0, BITS) {
            return None;
        }
        let (quotient, volume) = quotient(in_units, |a, b| lattice::difference(a, b, 1.0));
        (volume != 0).then_some(quotient)
    }
}

impl Quick {
    /// Returns the number, rounded as [`ExactRadius::value`] does; `None` if that is not certain.
    fn value(&self, inverse_unit: Option<f64>) -> Option<f64> {
        match self {
            Quick::Whole(Quotient { above, below }) => {
                let unit = 1.0 / inverse_unit?;
                Some(*above as f64 / *below as f64 * unit * unit)
            }
            Quick::Pair(pair) if pair.is_in_range() => {
                Some(pair.above.nearest()? / pair.below.nearest()?)
            }
            Quick::Pair(_) => None,
        }
    }

    /// Compares two numbers; `None` if that is not certain.
    fn try_compare(&self, other: &Self) -> Option<Ordering> {
        let sign = match (self, other) {
            (Quick::Whole(p), Quick::Whole(q)) => {
                let [a, b, c, d] = [p.above, q.below, q.above, p.below].map(Integer::of);
                (a * b - c * d).sign()
            }
            (Quick::Pair(p), Quick::Pair(q)) if p.is_in_range() && q.is_in_range() => {
                (p.above * q.below - q.above * p.below).sign()?
            }
            _ => return None,
        };
        Some(Ordering::from(sign))
    }
}

impl Quotient<Bounded<Pair>> {
    /// Returns true if the error bounds cover all that is lost by underflow, and nothing
    /// overflowed.
    fn is_in_range(&self) -> bool {
        const RANGE: std::ops::Range<f64> = 1e-240..1e140;
        [self.above, self.below]
            .iter()
            .all(|part| RANGE.contains(&part.error()))
    }
}

impl SquaredRadius {
    /// Compares two squared radii; `corners` and `of_other` return those of their cells.
    pub(crate) fn compare(
        &self,
        other: &Self,
        corners: impl FnOnce() -> [[f64; 4]; 4],
        of_other: impl FnOnce() -> [[f64; 4]; 4],
    ) -> Ordering {
        self.quick.try_compare(&other.quick).unwrap_or_else(|| {
            let exact = self
                .exact
                .get_or_init(|| Box::new(ExactRadius::of(corners())));
            exact.compare(
                other
                    .exact
                    .get_or_init(|| Box::new(ExactRadius::of(of_other()))),
            )
        })
    }
}

/// Returns two numbers between which the squared radius lies; infinite ones if floating point
/// cannot tell.
fn squared_radius_bounds(corners: [[f64; 4]; 4]) -> (f64, f64) {
    /// Error bounds above this one cover all that is lost by underflow.
    const LEAST: f64 = 1e-280;
    let (Quotient { above, below }, _) = quotient(corners, Bounded::difference);
    let ([above, below], [above_error, below_error]) = (
        [above.value(), below.value()],
        [above.error(), below.error()],
    );
    let (least, most) = (below - below_error, below + below_error);
    if !(above_error > LEAST
        && below_error > LEAST
        && least > 0.0
        && above.abs() + most < f64::INFINITY)
    {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    let (low, high) = (above - above_error, above + above_error);
    let low = low / if low < 0.0 { least } else { most };
    let high = high / if high < 0.0 { most } else { least };
    // The roundings of these lines.
    let margin = |x: f64| 4.0 * f64::EPSILON * x.abs();
    (low - margin(low), high + margin(high))
}

/// A squared radius without rounding, in any number of digits.
struct ExactRadius(Option<Quotient<Dyadic>>);

impl ExactRadius {
    /// Returns that of four points; that of coplanar ones is infinite.
    fn of(corners: [[f64; 4]; 4]) -> Self {
        let (quotient, volume) = quotient(corners, Dyadic::difference);
        ExactRadius((volume.sign() != Sign::Zero).then_some(quotient))
    }

    /// Returns the number, rounded.
    fn value(&self) -> f64 {
        self.0
            .as_ref()
            .map_or(f64::INFINITY, |Quotient { above, below }| {
                above.quotient(below)
            })
    }

    fn compare(&self, other: &Self) -> Ordering {
        match (&self.0, &other.0) {
            (Some(p), Some(q)) => {
                let difference =
                    p.above.clone() * q.below.clone() - q.above.clone() * p.below.clone();
                difference.sign().into()
            }
            (p, q) => p.is_none().cmp(&q.is_none()),
        }
    }
}
