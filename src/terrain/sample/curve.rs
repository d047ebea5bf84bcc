//! An order of positions in which neighbors are near each other.

use rayon::prelude::*;

use crate::data::Bounds;

/// Returns the numbers of positions in the order of a Z-curve over their extent.
pub(crate) fn along_curve(positions: &[[f64; 2]]) -> Vec<u32> {
    let mut extent = Bounds::default();
    positions
        .iter()
        .filter(|q| q.iter().all(|c| c.is_finite()))
        .for_each(|&[x, y]| extent.add([x, y, 0.0]));
    let scale =
        |k: usize| f64::from(u16::MAX) / (extent.max[k] - extent.min[k]).max(f64::MIN_POSITIVE);
    let (scales, low) = ([scale(0), scale(1)], extent.min);
    // What is not finite comes out as some number, and is found to be outside.
    let step = |q: &[f64; 2], k: usize| u32::from(((q[k] - low[k]) * scales[k]) as u16);
    let mut keys: Vec<(u32, u32)> = (0..)
        .zip(positions)
        .map(|(i, q)| (on_curve([step(q, 0), step(q, 1)]) as u32, i))
        .collect();
    keys.par_sort_unstable();
    keys.into_iter().map(|(_, i)| i).collect()
}

/// Returns how far along a Z-curve a square of a lattice is, by its column and row. Four squares
/// that are one in a lattice with half as many columns and rows follow each other.
pub(crate) fn on_curve([column, row]: [u32; 2]) -> u64 {
    spread(column) | spread(row) << 1
}

/// Moves each bit of a number to twice its position.
fn spread(number: u32) -> u64 {
    let mut bits = u64::from(number);
    for (shift, mask) in [
        (16, 0x0000_FFFF_0000_FFFF),
        (8, 0x00FF_00FF_00FF_00FF),
        (4, 0x0F0F_0F0F_0F0F_0F0F),
        (2, 0x3333_3333_3333_3333),
        (1, 0x5555_5555_5555_5555),
    ] {
        bits = (bits | bits << shift) & mask;
    }
    bits
}
