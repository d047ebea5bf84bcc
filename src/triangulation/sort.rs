//! Spatial order: points that are near each other come near each other.

use rayon::prelude::*;

use super::{MAX_VERTICES, Refused};

/// Puts the bits of `x` apart, so that `gap` zero bits follow each.
fn spread(x: u64, bits: u32, axes: u32) -> u64 {
    (0..bits).fold(0, |spread, bit| spread | (x >> bit & 1) << (bit * axes))
}

/// The bits of a 32-bit number at the even places of 64.
#[inline]
fn spread_by_two(x: u32) -> u64 {
    let x = u64::from(x);
    let x = (x | x << 16) & 0x0000_FFFF_0000_FFFF;
    let x = (x | x << 8) & 0x00FF_00FF_00FF_00FF;
    let x = (x | x << 4) & 0x0F0F_0F0F_0F0F_0F0F;
    let x = (x | x << 2) & 0x3333_3333_3333_3333;
    (x | x << 1) & 0x5555_5555_5555_5555
}

/// A Morton curve (Morton 1966) through the box around some points.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    axes: usize,
    /// Times `unit`.
    min: [f64; 3],
    /// A power of two that brings the extent to where it and its inverse are numbers: 1, but at the extremes.
    unit: f64,
    scale: f64,
}

impl Curve {
    /// Bits of the key on each axis.
    const fn bits(axes: usize) -> u32 {
        if axes == 3 { 21 } else { 31 }
    }

    /// The curve for these points, of one to three coordinates.
    pub(super) fn through<A: AsRef<[f64]>>(count: usize, coordinates: impl Fn(usize) -> A) -> Self {
        let mut min = [f64::INFINITY; 3];
        let mut max = [f64::NEG_INFINITY; 3];
        let mut axes = 0;
        for i in 0..count {
            let point = coordinates(i);
            axes = point.as_ref().len().min(3);
            for (axis, &x) in point.as_ref().iter().take(3).enumerate() {
                min[axis] = min[axis].min(x);
                max[axis] = max[axis].max(x);
            }
        }
        // One scale for all axes: cubes, not boxes.
        let extent = |unit: f64| (0..axes).map(|axis| max[axis] * unit - min[axis] * unit).fold(0.0, f64::max);
        let unit = match extent(1.0) {
            f64::INFINITY => 0.5,
            // Where this makes a coordinate infinite, all are equal on that axis.
            tiny if tiny < 2f64.powi(-900) => 2f64.powi(900),
            _ => 1.0,
        };
        let scale = (f64::from(Self::bits(axes)).exp2() - 1.0) / extent(unit);
        let scale = if scale.is_finite() { scale } else { 0.0 };
        Curve { axes, min: min.map(|x| x * unit), unit, scale }
    }

    /// Where a point lies on the curve. A larger coordinate never has the smaller bits.
    #[inline]
    pub(super) fn key(&self, point: &[f64]) -> u64 {
        let step = |axis: usize| ((point[axis] * self.unit - self.min[axis]) * self.scale) as u64;
        match self.axes {
            1 => step(0),
            2 => spread_by_two(step(0) as u32) << 1 | spread_by_two(step(1) as u32),
            axes => (0..axes)
                .fold(0, |key, axis| key | spread(step(axis), Self::bits(axes), axes as u32) << (axes - 1 - axis)),
        }
    }
}

/// The positions `0..count` in the order of a Morton curve through the points' coordinates (one to three of
/// them). Points with the same key keep the order of their coordinates, then of their positions: for
/// distinct points the order is a function of the set.
///
/// # Errors
/// If there are more than 2^31 - 2 points.
///
/// # Complexity
/// O(n log n), on all threads; 20 bytes a point.
pub fn spatial_order<A: AsRef<[f64]>>(
    count: usize,
    coordinates: impl Fn(usize) -> A + Sync,
) -> Result<Vec<u32>, Refused> {
    if count >= MAX_VERTICES {
        return Err(Refused::TooMany);
    }
    let curve = Curve::through(count, &coordinates);
    let with_key = |i: usize| (curve.key(coordinates(i).as_ref()), i as u32);
    let mut order: Vec<(u64, u32)> = (0..count).into_par_iter().map(with_key).collect();
    order.par_sort_unstable_by(|&(key_a, a), &(key_b, b)| {
        key_a.cmp(&key_b).then_with(|| {
            let (p, q) = (coordinates(a as usize), coordinates(b as usize));
            let by_place = p.as_ref().iter().zip(q.as_ref()).map(|(x, y)| (x + 0.0).total_cmp(&(y + 0.0)));
            by_place.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then).then(a.cmp(&b))
        })
    });
    Ok(order.into_iter().map(|(_, i)| i).collect())
}
