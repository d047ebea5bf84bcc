//! The squared radius of the sphere that is orthogonal to four weighted points `[x, y, z, weight]`:
//! its center has the same power to all four, and this is that power. With weights of zero it is
//! that of the circumscribed sphere.

use std::cmp::Ordering;

use super::center::offset_in_space;
use super::formula::{square, squared_length};
use crate::num::{Bounded, Dyadic, Number, Sign};

/// A quotient `above / below` with a positive `below`.
#[derive(Debug, Clone)]
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

/// Returns two numbers between which the squared radius lies; infinite ones if floating point
/// cannot tell.
pub(crate) fn squared_radius_bounds(corners: [[f64; 4]; 4]) -> (f64, f64) {
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

/// A squared radius without rounding.
#[derive(Debug, Clone)]
pub(crate) struct SquaredRadius(Option<Quotient<Dyadic>>);

impl SquaredRadius {
    /// Returns that of four points; that of coplanar ones is infinite.
    pub(crate) fn of(corners: [[f64; 4]; 4]) -> Self {
        let (quotient, volume) = quotient(corners, Dyadic::difference);
        SquaredRadius((volume.sign() != Sign::Zero).then_some(quotient))
    }

    /// Returns the number, rounded.
    pub(crate) fn value(&self) -> f64 {
        self.0
            .as_ref()
            .map_or(f64::INFINITY, |Quotient { above, below }| {
                above.quotient(below)
            })
    }

    pub(crate) fn compare(&self, other: &Self) -> Ordering {
        match (&self.0, &other.0) {
            (Some(p), Some(q)) => {
                let difference =
                    p.above.clone() * q.below.clone() - q.above.clone() * p.below.clone();
                match difference.sign() {
                    Sign::Negative => Ordering::Less,
                    Sign::Zero => Ordering::Equal,
                    Sign::Positive => Ordering::Greater,
                }
            }
            (p, q) => p.is_none().cmp(&q.is_none()),
        }
    }
}
