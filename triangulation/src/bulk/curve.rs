//! The position of points on a space-filling curve.

use std::ops::Range;

use super::chunks;

/// A Morton curve (Morton 1966) through the box around some points of one to three coordinates.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    /// The least coordinates, times `unit`.
    min: [f64; 3],
    /// Powers of two that scale the extent to where it and its inverse are finite: 1, except at the
    /// extremes; 0 on an axis on which all points are equal by comparison.
    unit: [f64; 3],
    /// Steps in a unit; the same on all axes, so that cells of the curve are squares and cubes.
    scale: f64,
}

/// The least and the largest coordinate on each axis, and the number of axes.
#[derive(Clone, Copy)]
pub(super) struct Span {
    min: [f64; 3],
    max: [f64; 3],
    axes: usize,
}

impl Span {
    pub(super) const EMPTY: Self = Span {
        min: [f64::INFINITY; 3],
        max: [f64::NEG_INFINITY; 3],
        axes: 0,
    };

    /// Returns the span of points.
    #[inline(always)]
    pub(super) fn of<A: AsRef<[f64]>>(points: impl Iterator<Item = A>) -> Self {
        points.fold(Span::EMPTY, |span, point| span.with(point.as_ref()))
    }

    #[inline(always)]
    pub(super) fn with(mut self, point: &[f64]) -> Self {
        self.axes = point.len().min(3);
        for (axis, &x) in point.iter().take(3).enumerate() {
            // `f64::min` handles NaN, which takes time.
            self.min[axis] = if x < self.min[axis] {
                x
            } else {
                self.min[axis]
            };
            self.max[axis] = if x > self.max[axis] {
                x
            } else {
                self.max[axis]
            };
        }
        self
    }

    pub(super) fn and(self, other: Self) -> Self {
        Span {
            min: std::array::from_fn(|axis| self.min[axis].min(other.min[axis])),
            max: std::array::from_fn(|axis| self.max[axis].max(other.max[axis])),
            axes: self.axes.max(other.axes),
        }
    }
}

impl Curve {
    /// Returns the curve through `count` points, given the spans of ranges of them; one thread
    /// reads `chunk` points at a time.
    pub(super) fn through(
        count: usize,
        span: &(dyn Fn(Range<usize>) -> Span + Sync),
        chunk: usize,
    ) -> Self {
        Self::along(chunks::reduced(count, chunk, span, Span::EMPTY, Span::and))
    }

    /// Returns the curve through all of a box.
    pub(super) fn along(Span { min, max, axes }: Span) -> Self {
        let extent = |unit: f64| {
            (0..axes)
                .map(|axis| max[axis] * unit - min[axis] * unit)
                .fold(0.0, f64::max)
        };
        let unit = match extent(1.0) {
            f64::INFINITY => 0.5,
            tiny if tiny < 2f64.powi(-900) => 2f64.powi(900),
            _ => 1.0,
        };
        let bits = if axes == 3 { 21.0 } else { 31.0f64 };
        let scale = (bits.exp2() - 1.0) / extent(unit);
        let scale = if scale.is_finite() { scale } else { 0.0 };
        // Where the unit makes a coordinate infinite, all are equal: the extent is tiny.
        let unit = min.map(|x| if (x * unit).is_finite() { unit } else { 0.0 });
        let min = std::array::from_fn(|axis| {
            if unit[axis] == 0.0 {
                0.0
            } else {
                min[axis] * unit[axis]
            }
        });
        Curve { min, unit, scale }
    }

    /// Returns true if all points are equal.
    pub(super) fn is_point(&self) -> bool {
        self.scale == 0.0
    }

    /// Returns which of the `2^31` (with three axes: `2^21`) steps along an axis a coordinate is
    /// in. A larger coordinate never has a smaller step.
    #[inline(always)]
    fn step(&self, axis: usize, x: f64) -> u64 {
        // The low bits of a double from 2^52 to 2^53 are a whole number. A conversion tests for
        // overflow and NaN, which takes three times as long.
        const WHOLE: f64 = (1u64 << 52) as f64;
        let steps = (x * self.unit[axis] - self.min[axis]) * self.scale;
        u64::from((steps + WHOLE).to_bits() as u32)
    }

    /// Returns the position of a point on the curve, in the high bits. The highest bit is one of
    /// the first axis, the others follow in turn; a larger coordinate never has smaller bits.
    #[inline(always)]
    pub(super) fn key(&self, point: &[f64]) -> u64 {
        match *point {
            [] => 0,
            [x] => self.step(0, x) << 33,
            [x, y] => spread_by_two(self.step(0, x)) << 3 | spread_by_two(self.step(1, y)) << 2,
            [x, y, z, ..] => {
                let [x, y, z] =
                    [self.step(0, x), self.step(1, y), self.step(2, z)].map(spread_by_three);
                x << 3 | y << 2 | z << 1
            }
        }
    }
}

/// Squares of one size (segments, cubes), such that all points in one of them have the same highest
/// bits of their keys.
///
/// `PERF:` the square of a point is found without spreading bits.
pub(super) struct Squares<'a> {
    curve: &'a Curve,
    axes: usize,
    /// For each axis, the number of bits of a step that distinguish squares, and of those below.
    bits: [u32; 3],
    low: [u32; 3],
}

impl<'a> Squares<'a> {
    /// Returns the squares that the highest `bits` bits of keys distinguish, for points with one to
    /// three axes.
    pub(super) fn new(curve: &'a Curve, axes: usize, bits: u32) -> Self {
        let axes = axes.min(3);
        let of_step = if axes == 3 { 21 } else { 31 };
        let bits = std::array::from_fn(|axis| match axis < axes {
            true => (bits as usize + axes - 1 - axis) as u32 / axes as u32,
            false => 0,
        });
        Squares {
            curve,
            axes,
            bits,
            low: bits.map(|bits| of_step - bits),
        }
    }

    /// Returns the square that a point is in, counted row by row.
    #[inline(always)]
    pub(super) fn of(&self, point: &[f64]) -> usize {
        let part = |axis: usize| (self.curve.step(axis, point[axis]) >> self.low[axis]) as usize;
        match self.axes {
            0 => 0,
            1 => part(0),
            2 => part(0) << self.bits[1] | part(1),
            _ => (part(0) << self.bits[1] | part(1)) << self.bits[2] | part(2),
        }
    }

    /// Returns the highest bits of the keys in a square.
    pub(super) fn key_bits(&self, square: usize) -> usize {
        let [x, y, z] = self.bits;
        let steps = [
            square >> (y + z),
            square >> z & ((1 << y) - 1),
            square & ((1 << z) - 1),
        ];
        let mut left = self.bits;
        let mut key = 0;
        for axis in (0..self.axes).cycle().take((x + y + z) as usize) {
            left[axis] -= 1;
            key = key << 1 | steps[axis] >> left[axis] & 1;
        }
        key
    }
}

/// Returns the bits of a 32-bit number at the even positions of 64.
#[inline(always)]
fn spread_by_two(x: u64) -> u64 {
    let x = (x | x << 16) & 0x0000_FFFF_0000_FFFF;
    let x = (x | x << 8) & 0x00FF_00FF_00FF_00FF;
    let x = (x | x << 4) & 0x0F0F_0F0F_0F0F_0F0F;
    let x = (x | x << 2) & 0x3333_3333_3333_3333;
    (x | x << 1) & 0x5555_5555_5555_5555
}

/// Returns the bits of a 21-bit number at every third position of 63.
#[inline(always)]
fn spread_by_three(x: u64) -> u64 {
    let x = (x | x << 32) & 0x001F_0000_0000_FFFF;
    let x = (x | x << 16) & 0x001F_0000_FF00_00FF;
    let x = (x | x << 8) & 0x100F_00F0_0F00_F00F;
    let x = (x | x << 4) & 0x10C3_0C30_C30C_30C3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_spread_in_order() {
        for bit in 0..31 {
            assert_eq!(spread_by_two(1 << bit), 1 << (2 * bit));
        }
        for bit in 0..21 {
            assert_eq!(spread_by_three(1 << bit), 1 << (3 * bit));
        }
    }

    #[test]
    fn squares_have_the_highest_bits_of_keys_in_common() {
        let coordinates = |i: usize| [i * 37 % 101, i * 71 % 97, i * 11 % 89].map(|x| x as f64);
        for axes in 0..=3 {
            let point = |i: usize| coordinates(i)[..axes].to_vec();
            let curve = Curve::through(500, &|range| Span::of(range.map(point)), 64);
            for bits in 0..12 {
                let squares = Squares::new(&curve, axes, bits);
                for point in (0..500).map(point) {
                    let (square, key) = (squares.of(&point), curve.key(&point));
                    assert_eq!(
                        squares.key_bits(square),
                        (key >> 1 >> (63 - bits)) as usize,
                        "{point:?} {bits}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_highest_bit_halves_the_first_axis() {
        let points = [[0.0, 0.0], [1.0, 1.0]];
        let curve = Curve::through(2, &|range| Span::of(points[range].iter()), 8);
        assert_eq!(curve.key(&[0.0, 0.0]), 0);
        assert_eq!(curve.key(&[0.9, 0.0]) >> 62, 0b10);
        assert_eq!(curve.key(&[0.0, 0.9]) >> 62, 0b01);
        assert_eq!(curve.key(&[1.0, 1.0]), u64::MAX << 2);
    }
}
