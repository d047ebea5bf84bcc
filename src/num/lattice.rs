//! Coordinates on a common power-of-two grid as integers.
//!
//! Ties (cocircular points, above all) happen where coordinates are coarse: integer grids, rounded
//! samples. There all differences are small multiples of one unit, and 128-bit integers hold the
//! whole polynomial.

/// The exponent of the lowest set bit of a finite number; `None` for zero.
#[inline]
fn lowest_bit(x: f64) -> Option<i32> {
    if x == 0.0 {
        return None;
    }
    let bits = x.to_bits();
    let biased = ((bits >> 52) & 0x7ff) as i32;
    let fraction = bits & ((1 << 52) - 1);
    let (mantissa, exponent) = if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    Some(exponent + mantissa.trailing_zeros() as i32)
}

/// A power of two of which every coordinate is a multiple, if differences within an axis counted in
/// it stay within `bits` bits; returned as its inverse, to multiply with.
///
/// `None` if the range is wider, or the inverse is not a normal number.
pub fn inverse_unit<A>(axes: impl Iterator<Item = A> + Clone, bits: i32) -> Option<f64>
where
    A: Iterator<Item = f64> + Clone,
{
    let lowest = axes.clone().flatten().filter_map(lowest_bit).min().unwrap_or(0);
    if !(-1000..=1000).contains(&lowest) {
        return None;
    }
    let inverse = 2f64.powi(-lowest);
    // The rounding of max - min is harmless: 2^bits is representable, and rounding is monotone.
    let limit = 2f64.powi(bits);
    let fits = |axis: A| {
        let (min, max) = axis.fold((f64::INFINITY, f64::NEG_INFINITY), |(min, max), x| (min.min(x), max.max(x)));
        (max - min) * inverse <= limit
    };
    axes.into_iter().all(fits).then_some(inverse)
}

/// `a - b` counted in units.
///
/// Exact: both are multiples of the unit and their difference has at most 53 bits, as
/// [`inverse_unit`] was asked for no more.
#[inline]
pub fn difference(a: f64, b: f64, inverse_unit: f64) -> i128 {
    i128::from(((a - b) * inverse_unit) as i64)
}
