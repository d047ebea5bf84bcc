//! Openings by disks: what stands above its surroundings and is narrower than the disk disappears.

use rayon::prelude::*;

use super::raster::Raster;

/// Sides of the blocks of cells that one task computes: their tables fit into a cache.
const BLOCK: [usize; 2] = [128, 64];

/// Cells that are accumulated in registers.
const LANES: usize = 16;

/// Returns the opening by a disk of a radius in cells; beyond the rim, its values are repeated.
pub(super) fn opened(raster: &Raster, radius: usize) -> Raster {
    let eroded = extreme(raster, radius, radius as isize, least);
    extreme(&eroded, radius, -(radius as isize), greatest)
}

/// Returns the closing by a disk of a radius in cells; beyond the rim, its values are repeated.
pub(super) fn closed(raster: &Raster, radius: usize) -> Raster {
    let dilated = extreme(raster, radius, radius as isize, greatest);
    extreme(&dilated, radius, -(radius as isize), least)
}

// Written so that one instruction does it: no value is NaN.
#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn greatest(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The rows of a disk: for each distance from the middle row, the half width.
fn half_widths(radius: usize) -> Vec<usize> {
    (0..=radius)
        .map(|row| (radius * radius - row * row).isqrt())
        .collect()
}

/// Returns the least or greatest value within the disk around each cell, for a raster with `more`
/// cells added at each side (or removed, if negative).
///
/// Each row of the disk is the union of two runs of a power of two of cells, whose extremes are in
/// tables.
fn extreme(
    raster: &Raster,
    radius: usize,
    more: isize,
    choose: impl Fn(f32, f32) -> f32 + Sync + Copy,
) -> Raster {
    let width = raster.width.saturating_add_signed(2 * more);
    let height = raster.height.saturating_add_signed(2 * more);
    let mut result = Raster::of(width, height, 0.0);
    let half_widths = half_widths(radius);
    result
        .values
        .par_chunks_mut(width * BLOCK[1])
        .enumerate()
        .for_each_init(Vec::new, |tables, (band, rows)| {
            for left in (0..width).step_by(BLOCK[0]) {
                let block = Block {
                    left,
                    top: band * BLOCK[1],
                    width: BLOCK[0].min(width - left),
                    height: rows.len() / width,
                };
                block.compute(raster, more, &half_widths, tables, rows, width, choose);
            }
        });
    result
}

/// A rectangle of cells of the result.
struct Block {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

impl Block {
    #[allow(clippy::too_many_arguments, reason = "the inside of one loop")]
    #[inline(always)]
    fn compute(
        &self,
        raster: &Raster,
        more: isize,
        half_widths: &[usize],
        tables: &mut Vec<f32>,
        rows: &mut [f32],
        stride: usize,
        choose: impl Fn(f32, f32) -> f32 + Copy,
    ) {
        let radius = half_widths.len() - 1;
        let levels = (2 * radius + 1).ilog2() as usize + 1;
        // A few more columns, so that whole lanes can be read.
        let across = self.width.next_multiple_of(LANES) + 2 * radius;
        let down = self.height + 2 * radius;
        let size = across * down;
        // What was there before is overwritten.
        tables.resize(size * levels, 0.0);
        let first = [self.left, self.top].map(|start| start as isize - more - radius as isize);
        for (row, target) in tables[..size].chunks_mut(across).enumerate() {
            let source = (first[1] + row as isize).clamp(0, raster.height as isize - 1) as usize;
            let source = &raster.values[source * raster.width..][..raster.width];
            copy_repeating(source, first[0], target);
        }
        for level in 1..levels {
            let (shorter, longer) = tables.split_at_mut(level * size);
            let shorter = &shorter[(level - 1) * size..];
            let step = 1 << (level - 1);
            // The last ones of a row reach into the next; nobody asks for them.
            let count = size - step;
            for ((target, &a), &b) in longer[..count]
                .iter_mut()
                .zip(shorter)
                .zip(&shorter[step..])
            {
                *target = choose(a, b);
            }
        }
        for row in 0..self.height {
            let target = &mut rows[row * stride + self.left..][..self.width];
            for start in (0..self.width).step_by(LANES) {
                let lanes = lanes_of(tables, half_widths, across, size, row, start, choose);
                let count = LANES.min(self.width - start);
                target[start..start + count].copy_from_slice(&lanes[..count]);
            }
        }
    }
}

#[inline(always)]
fn lanes_of(
    tables: &[f32],
    half_widths: &[usize],
    across: usize,
    size: usize,
    row: usize,
    start: usize,
    choose: impl Fn(f32, f32) -> f32 + Copy,
) -> [f32; LANES] {
    let radius = half_widths.len() - 1;
    let mut lanes = [0.0; LANES];
    lanes.copy_from_slice(&tables[(row + radius) * across + start + radius..][..LANES]);
    for (distance, &half) in half_widths.iter().enumerate() {
        let level = (2 * half + 1).ilog2() as usize;
        let second = 2 * half + 1 - (1 << level);
        for line in [row + radius - distance, row + radius + distance] {
            let at = level * size + line * across + start + radius - half;
            let first: &[f32; LANES] = tables[at..at + LANES].try_into().unwrap_or(&[0.0; LANES]);
            let last: &[f32; LANES] = tables[at + second..at + second + LANES]
                .try_into()
                .unwrap_or(&[0.0; LANES]);
            for lane in 0..LANES {
                lanes[lane] = choose(lanes[lane], choose(first[lane], last[lane]));
            }
        }
    }
    lanes
}

/// Copies a part of a row that starts at a column; beyond its ends, the values there are repeated.
fn copy_repeating(source: &[f32], first: isize, target: &mut [f32]) {
    let before = (-first).clamp(0, target.len() as isize) as usize;
    let start = first.clamp(0, source.len() as isize) as usize;
    let count = (target.len() - before).min(source.len() - start);
    target[..before].fill(source[0]);
    target[before..before + count].copy_from_slice(&source[start..start + count]);
    target[before + count..].fill(source[source.len() - 1]);
}
