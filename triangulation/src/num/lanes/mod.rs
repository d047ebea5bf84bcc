//! Four numbers at a time, or two of 64 bits: what the algorithms use of the crate `wide`, and a
//! plain twin of it.
//!
//! With the feature `simd` these are `wide`'s own types, which are vector registers. Without it,
//! `plain` has the same names over arrays. Both round alike, so both give the same bits, except
//! for the larger of two of which one is not a number.

#[cfg(feature = "simd")]
pub(crate) use wide::{f32x4, f64x2, i32x4};

#[cfg(any(test, not(feature = "simd")))]
mod plain;
#[cfg(not(feature = "simd"))]
pub(crate) use plain::*;

/// Asks for memory that will be needed soon. It changes no result.
///
/// Where there is no instruction for it, reads the memory, and does not use what it has read.
#[inline(always)]
pub(crate) fn prefetch<T: Copy>(wanted: &T) {
    #[cfg(all(feature = "simd", target_feature = "sse"))]
    safe_arch::prefetch_t0(wanted);
    #[cfg(not(all(feature = "simd", target_feature = "sse")))]
    std::hint::black_box(*wanted);
}

/// Returns the facets of a positive cell of vertices `v`, each as the cell sees it, and its
/// neighbors `n` beyond them.
///
/// `PERF:` the compiler would move sixteen numbers one by one.
#[inline(always)]
pub(crate) fn facets(v: [u32; 4], n: [u32; 4]) -> [[u32; 4]; 4] {
    #[cfg(all(feature = "simd", target_feature = "sse"))]
    {
        use safe_arch::{
            m128, shuffle_abi_f32_all_m128 as shuffle, unpack_high_m128, unpack_low_m128,
        };
        let [v, n] = [v, n].map(|row| m128::from_array(row.map(f32::from_bits)));
        // v2 n2 v3 n3; v3 v3 n0 n1.
        let high = unpack_high_m128(v, n);
        let both = shuffle::<0b11_01_10_10>(high, unpack_low_m128(v, n));
        let rows = [
            shuffle::<0b10_00_01_10>(v, both),
            shuffle::<0b11_01_10_00>(v, both),
            shuffle::<0b01_10_00_01>(v, high),
            shuffle::<0b11_00_01_00>(v, high),
        ];
        rows.map(|row| row.to_array().map(f32::to_bits))
    }
    #[cfg(not(all(feature = "simd", target_feature = "sse")))]
    [
        [v[2], v[1], v[3], n[0]],
        [v[0], v[2], v[3], n[1]],
        [v[1], v[0], v[3], n[2]],
        [v[0], v[1], v[2], n[3]],
    ]
}

/// Returns a row with another last number.
///
/// `PERF:` one write, and not four, where the row is stored.
#[inline(always)]
pub(crate) fn with_last(row: [u32; 4], last: u32) -> [u32; 4] {
    #[cfg(all(feature = "simd", target_feature = "sse"))]
    {
        use safe_arch::{m128, shuffle_abi_f32_all_m128 as shuffle};
        let [row, last] = [row, [last; 4]].map(|row| m128::from_array(row.map(f32::from_bits)));
        // The third, and the last.
        let end = shuffle::<0b00_00_10_10>(row, last);
        shuffle::<0b10_00_01_00>(row, end)
            .to_array()
            .map(f32::to_bits)
    }
    #[cfg(not(all(feature = "simd", target_feature = "sse")))]
    [row[0], row[1], row[2], last]
}

/// Rounds each number of two pairs.
#[inline(always)]
pub(crate) fn rounded(first: f64x2, second: f64x2) -> f32x4 {
    let ([a, b], [c, d]) = (first.to_array(), second.to_array());
    f32x4::new([a as f32, b as f32, c as f32, d as f32])
}

/// Returns the bits of each number.
#[inline(always)]
pub(crate) fn bits(x: f32x4) -> i32x4 {
    i32x4::new(x.to_array().map(|x| x.to_bits() as i32))
}

/// Returns the numbers with these bits.
#[inline(always)]
pub(crate) fn of_bits(bits: i32x4) -> f32x4 {
    f32x4::new(bits.to_array().map(|bits| f32::from_bits(bits as u32)))
}

#[cfg(test)]
mod tests {
    use super::plain;

    /// Runs the same lines on both.
    macro_rules! results {
        ($module:path, $rows:expr) => {{
            use $module as lanes;
            let [a, b, c, d] = lanes::f32x4::transpose($rows.map(lanes::f32x4::new));
            let less = a.simd_lt(b);
            let [e, f, g, _] = $rows
                .map(|row: [f32; 4]| lanes::f64x2::new([f64::from(row[0]), f64::from(row[1])]));
            let i = lanes::i32x4::new($rows[0].map(|x| x.to_bits() as i32));
            let floats: [lanes::f32x4; 5] = [
                a + b * c - d,
                a / b,
                c.abs().fast_max(d),
                less.bitselect(c, d),
                (a.simd_gt(d) & less).bitselect(a, b),
            ];
            let doubles: [lanes::f64x2; 3] = [
                e + f * g - e / f,
                e.fast_max(f),
                lanes::f64x2::splat(0.1) * g,
            ];
            let low: lanes::i32x4 = i & lanes::i32x4::splat(31);
            let up: lanes::i32x4 = lanes::i32x4::splat(7) << 23;
            let down: lanes::i32x4 = (i - lanes::i32x4::splat(126)) >> 3;
            let whole: [lanes::i32x4; 2] = [low | up, down];
            (
                floats.map(|x| x.to_array().map(f32::to_bits)),
                doubles.map(|x| x.to_array().map(f64::to_bits)),
                whole.map(|x| x.to_array()),
                [a, b, less].map(|x| x.to_bitmask()),
                lanes::i32x4::splat(3).simd_gt(i).to_bitmask(),
            )
        }};
    }

    #[test]
    fn facets_have_their_vertices_and_neighbors() {
        let facets = [
            [2, 1, 3, 4],
            [0, 2, 3, 5],
            [1, 0, 3, u32::MAX],
            [0, 1, 2, 7],
        ];
        assert_eq!(super::facets([0, 1, 2, 3], [4, 5, u32::MAX, 7]), facets);
    }

    #[test]
    fn only_the_last_number_changes() {
        assert_eq!(
            super::with_last([1, u32::MAX, 3, 4], 5),
            [1, u32::MAX, 3, 5]
        );
    }

    #[test]
    fn the_plain_twin_computes_the_same() {
        let mut random = testkit::random::Random(1);
        for _ in 0..10_000 {
            let mut number =
                || (random.around(1000) as f32) * 2f32.powi(random.around(20) as i32) + 0.5;
            let rows = [0; 4].map(|_| [0; 4].map(|_| number()));
            assert_eq!(
                results!(plain, rows),
                results!(crate::num::lanes, rows),
                "{rows:?}"
            );
        }
    }
}
