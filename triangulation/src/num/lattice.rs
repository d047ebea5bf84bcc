//! Coordinates as integers, counted in a common unit that is a power of two.
//!
//! Ties (cocircular points, above all) happen where coordinates are coarse: integer grids, rounded
//! samples. There all differences are small multiples of one unit, and 128-bit integers hold the
//! whole polynomial. In the plane, 256-bit integers suffice for any coordinates of about one size.

use super::Integer;

/// Returns the exponent of the lowest set bit of a finite number; `None` for zero.
#[inline]
pub fn lowest_bit(x: f64) -> Option<i32> {
    if x == 0.0 {
        return None;
    }
    let bits = x.to_bits();
    let biased = ((bits >> 52) & 0x7ff) as i32;
    let fraction = bits & ((1 << 52) - 1);
    let (mantissa, exponent) = if biased == 0 {
        (fraction, -1074)
    } else {
        (fraction | 1 << 52, biased - 1075)
    };
    Some(exponent + mantissa.trailing_zeros() as i32)
}

/// Returns the inverse of a common unit of all coordinates, a power of two to multiply with.
/// Differences within an axis, counted in that unit, stay below `2^bits`.
///
/// `None` if they do not, or if the inverse is not a normal number.
pub fn inverse_unit<A>(axes: impl Iterator<Item = A> + Clone, bits: i32) -> Option<f64>
where
    A: Iterator<Item = f64> + Clone,
{
    let lowest = axes
        .clone()
        .flatten()
        .filter_map(lowest_bit)
        .min()
        .unwrap_or(0);
    if !(-1000..=1000).contains(&lowest) {
        return None;
    }
    let inverse = power_of_two(-lowest);
    fit(axes, inverse, bits).then_some(inverse)
}

/// Returns true if differences within each axis stay below `2^bits`, for coordinates that are
/// multiples of a unit and are counted in it.
#[inline]
pub fn fit<A>(mut axes: impl Iterator<Item = A>, inverse_unit: f64, bits: i32) -> bool
where
    A: Iterator<Item = f64>,
{
    // The rounding of max - min is harmless: it is monotone and 2^bits is a double, so a difference
    // of at least 2^bits is never rounded to less. (2^53 + 1 is rounded *to* 2^53.)
    let limit = power_of_two(bits);
    axes.all(|axis| {
        let (min, max) = axis.fold((f64::INFINITY, f64::NEG_INFINITY), |(min, max), x| {
            (min.min(x), max.max(x))
        });
        (max - min) * inverse_unit < limit
    })
}

/// Returns a power of two with an exponent from -1022 to 1023. (`powi` takes ten times as long.)
#[inline]
pub(crate) fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// Returns `a - b`, counted in units.
///
/// Exact if both are multiples of the unit and their difference has at most 53 bits, as
/// [`inverse_unit`] guarantees if `bits` is at most 53.
#[inline]
pub fn difference(a: f64, b: f64, inverse_unit: f64) -> i128 {
    i128::from(((a - b) * inverse_unit) as i64)
}

/// Returns `a - b`, counted in units, for numbers of at most 62 bits each.
#[inline]
pub fn long_difference(a: f64, b: f64, inverse_unit: f64) -> Integer {
    let [a, b] = [a, b].map(|x| (x * inverse_unit) as i64);
    Integer::from(a - b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit_of(points: &[f64], bits: i32) -> Option<f64> {
        inverse_unit(std::iter::once(points.iter().copied()), bits)
    }

    #[test]
    fn differences_stay_below_the_limit() {
        let limit = 2f64.powi(53);
        assert_eq!(unit_of(&[0.0, 1.0, limit - 1.0], 53), Some(1.0));
        // The two are 2^53 + 1 apart, which is no double: max - min is 2^53.
        assert_eq!(unit_of(&[-1.0, limit], 53), None);
        assert_eq!(unit_of(&[1.0, 2f64.powi(24)], 24), Some(1.0));
        assert_eq!(unit_of(&[0.0, 1.0, 2f64.powi(24)], 24), None);
    }

    #[test]
    fn the_unit_divides_every_coordinate() {
        assert_eq!(unit_of(&[0.75, 5.0, -3.5], 30), Some(4.0));
        assert_eq!(unit_of(&[96.0, 0.0, -32.0], 30), Some(1.0 / 32.0));
        assert_eq!(unit_of(&[0.0, -0.0], 30), Some(1.0));
        assert_eq!(difference(0.75, -3.5, 4.0), 17);
        assert_eq!(unit_of(&[5e-324, 1e-323], 53), None);
        assert_eq!(unit_of(&[f64::MAX, -f64::MAX], 53), None);
    }
}
