//! Numbers in an array, with the names of the crate `wide`.

#![allow(non_camel_case_types, reason = "the names of wide")]

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Shl, Shr, Sub};

/// So many numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lanes<T, const N: usize>([T; N]);

pub(crate) type f32x4 = Lanes<f32, 4>;
pub(crate) type f64x2 = Lanes<f64, 2>;
pub(crate) type i32x4 = Lanes<i32, 4>;

impl<T: Copy, const N: usize> Lanes<T, N> {
    #[inline(always)]
    pub(crate) fn new(numbers: [T; N]) -> Self {
        Lanes(numbers)
    }

    #[inline(always)]
    pub(crate) fn splat(number: T) -> Self {
        Lanes([number; N])
    }

    #[inline(always)]
    pub(crate) fn to_array(self) -> [T; N] {
        self.0
    }

    #[inline(always)]
    fn with(self, other: Self, f: impl Fn(T, T) -> T) -> Self {
        Lanes(std::array::from_fn(|lane| f(self.0[lane], other.0[lane])))
    }
}

impl<T: Copy + PartialOrd, const N: usize> Lanes<T, N> {
    /// The larger number of each lane; the other one's if one is not a number.
    #[inline(always)]
    pub(crate) fn fast_max(self, other: Self) -> Self {
        self.with(other, |x, y| if x > y { x } else { y })
    }
}

/// Implements an operator lane by lane.
macro_rules! lane_by_lane {
    ($($operator:ident $name:ident),*) => {$(
        impl<T: Copy + $operator<Output = T>, const N: usize> $operator for Lanes<T, N> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                self.with(other, T::$name)
            }
        }
    )*};
}

lane_by_lane!(Add add, Sub sub, Mul mul, Div div, BitOr bitor);

impl Shl<i32> for i32x4 {
    type Output = Self;

    #[inline(always)]
    fn shl(self, count: i32) -> Self {
        Lanes(self.0.map(|x| x << count))
    }
}

impl Shr<i32> for i32x4 {
    type Output = Self;

    #[inline(always)]
    fn shr(self, count: i32) -> Self {
        Lanes(self.0.map(|x| x >> count))
    }
}

impl BitAnd for i32x4 {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        self.with(other, i32::bitand)
    }
}

/// Intersects masks.
impl BitAnd for f32x4 {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        self.with(other, |x, y| f32::from_bits(x.to_bits() & y.to_bits()))
    }
}

#[inline(always)]
fn mask(holds: bool) -> f32 {
    f32::from_bits(if holds { u32::MAX } else { 0 })
}

impl f32x4 {
    #[inline(always)]
    pub(crate) fn transpose(rows: [Self; 4]) -> [Self; 4] {
        [0, 1, 2, 3].map(|column| Lanes(rows.map(|row| row.0[column])))
    }

    /// A mask: all bits of a lane are set where the comparison holds.
    #[inline(always)]
    pub(crate) fn simd_lt(self, other: Self) -> Self {
        self.with(other, |x, y| mask(x < y))
    }

    /// See [`simd_lt`](Self::simd_lt).
    #[inline(always)]
    pub(crate) fn simd_gt(self, other: Self) -> Self {
        self.with(other, |x, y| mask(x > y))
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Self {
        Lanes(self.0.map(f32::abs))
    }

    /// The highest bit of each lane.
    #[inline(always)]
    pub(crate) fn to_bitmask(self) -> u32 {
        (0..4)
            .map(|lane| self.0[lane].to_bits() >> 31 << lane)
            .sum()
    }

    /// The first number where a lane of this mask is set, the second where it is not.
    #[inline(always)]
    pub(crate) fn bitselect(self, if_one: Self, if_zero: Self) -> Self {
        let select = |lane: usize| {
            if self.0[lane].to_bits() == 0 {
                if_zero.0[lane]
            } else {
                if_one.0[lane]
            }
        };
        Lanes([0, 1, 2, 3].map(select))
    }
}

impl i32x4 {
    /// A mask, see [`f32x4::simd_lt`].
    #[inline(always)]
    pub(crate) fn simd_gt(self, other: Self) -> Self {
        self.with(other, |x, y| -i32::from(x > y))
    }

    /// The highest bit of each lane.
    #[cfg(test)]
    pub(crate) fn to_bitmask(self) -> u32 {
        (0..4).map(|lane| (self.0[lane] as u32) >> 31 << lane).sum()
    }
}
