//! Heights next to each other, with a plane that they are near to: most blocks are known to be
//! within a bound of a large triangle without a look at each height.

use crate::data::{Bounds, Tiling};
use crate::error::Result;
use crate::terrain::records::{Record, RecordFile};

/// The largest number of heights of a block.
const BLOCK: usize = 1 << 10;

/// Heights of one tile of the finest level that follow each other in the order of their keys.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Block {
    /// The first key and the last.
    pub(super) keys: [u64; 2],
    /// The position of the first height.
    pub(super) start: u64,
    /// The number of heights.
    pub(super) count: usize,
    /// The box around the heights.
    pub(super) bounds: Bounds,
    /// How a plane rises along x and y, and its height in the middle of the box.
    plane: [f64; 3],
    /// The lowest and the highest height above the plane.
    pub(super) residuals: [f64; 2],
}

impl Block {
    /// Returns the block of some heights. The first one is at the position `start`.
    fn of(start: u64, records: &[Record<3>]) -> Self {
        let mut bounds = Bounds::default();
        records.iter().for_each(|(_, p)| bounds.add(*p));
        let mut block = Block {
            keys: [records.first(), records.last()].map(|record| record.map_or(0, |(key, _)| *key)),
            start,
            count: records.len(),
            bounds,
            plane: [0.0; 3],
            residuals: [0.0; 2],
        };
        block.plane = block.fitted(records);
        let above = || {
            records
                .iter()
                .map(|&(_, [x, y, z])| z - block.height([x, y]))
        };
        block.residuals = [
            above().fold(f64::INFINITY, f64::min),
            above().fold(f64::NEG_INFINITY, f64::max),
        ];
        block
    }

    fn middle(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| (self.bounds.min[k] + self.bounds.max[k]) / 2.0)
    }

    /// Returns the plane of least squares, or a level one if the positions are on a line.
    fn fitted(&self, records: &[Record<3>]) -> [f64; 3] {
        let middle = self.middle();
        let count = records.len() as f64;
        let local = || {
            records
                .iter()
                .map(|(_, p)| [0, 1, 2].map(|k| p[k] - middle[k]))
        };
        let mean = |k: usize| local().map(|p| p[k]).sum::<f64>() / count;
        let [x, y, z] = [0, 1, 2].map(mean);
        let moment = |i: usize, j: usize| {
            let means = [x, y, z];
            local()
                .map(|p| (p[i] - means[i]) * (p[j] - means[j]))
                .sum::<f64>()
        };
        let [xx, xy, yy] = [moment(0, 0), moment(0, 1), moment(1, 1)];
        let [xz, yz] = [moment(0, 2), moment(1, 2)];
        let area = xx * yy - xy * xy;
        let rise = [(xz * yy - yz * xy) / area, (yz * xx - xz * xy) / area];
        let [a, b] = if rise.iter().all(|rise| rise.is_finite()) {
            rise
        } else {
            [0.0; 2]
        };
        [a, b, middle[2] + z - a * x - b * y]
    }

    /// Returns the height of the plane at a position.
    pub(super) fn height(&self, [x, y]: [f64; 2]) -> f64 {
        let [a, b, height] = self.plane;
        let [middle_x, middle_y, _] = self.middle();
        height + a * (x - middle_x) + b * (y - middle_y)
    }

    /// The corners of the box in plan.
    pub(super) fn corners(&self) -> [[f64; 2]; 4] {
        let Bounds { min, max } = self.bounds;
        [min, max, [min[0], max[1], 0.0], [max[0], min[1], 0.0]].map(|[x, y, _]| [x, y])
    }
}

/// Divides sorted heights into blocks: squares of the curve by which their keys go, as far as these
/// have no more heights than a block.
#[derive(Default)]
struct Blocks {
    /// How many bits of a key are within a tile of the finest level.
    within: u32,
    done: Vec<Block>,
    open: Vec<Record<3>>,
    start: u64,
}

impl Blocks {
    fn new(within: u32) -> Self {
        Blocks {
            within,
            ..Blocks::default()
        }
    }

    /// Adds heights that follow those that were added before.
    fn extend(&mut self, records: &[Record<3>]) {
        self.open.extend(records);
        while self.open.len() > BLOCK {
            self.cut();
        }
    }

    /// Returns all blocks.
    fn finish(mut self) -> Vec<Block> {
        while !self.open.is_empty() {
            self.cut();
        }
        self.done
    }

    fn cut(&mut self) {
        let first = self.open[0].0;
        let in_square = |shift: u32| {
            self.open
                .partition_point(|(key, _)| key >> shift == first >> shift)
        };
        let mut sizes = (0..=self.within / 2).rev().map(|half| in_square(2 * half));
        let size = sizes.find(|&size| size <= BLOCK).unwrap_or(BLOCK);
        let block = Block::of(self.start, &self.open[..size]);
        self.open.drain(..size);
        self.start += size as u64;
        self.done.push(block);
    }
}

/// Divides vertices into blocks, each in one tile of a level.
///
/// # Errors
/// If they cannot be read.
pub(super) fn blocks_of(vertices: &RecordFile<3>, finest: u8) -> Result<Vec<Block>> {
    let mut blocks = Blocks::new(2 * u32::from(Tiling::MAX_LEVEL - finest));
    let mut records = Vec::new();
    for start in (0..vertices.count()).step_by(BLOCK) {
        let end = vertices.count().min(start + BLOCK as u64);
        vertices.read(start..end, &mut records)?;
        blocks.extend(&records);
    }
    Ok(blocks.finish())
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::random::Random;

    #[test]
    fn blocks_are_of_one_tile_and_near_to_their_planes() {
        let mut random = Random(8);
        for (count, keys) in [(1, 5), (3000, 2), (20_000, 1 << 12), (30_000, 3)] {
            let mut records: Vec<Record<3>> = (0..count)
                .map(|_| {
                    let [x, y] = [0; 2].map(|_| random.below(40) as f64);
                    let z = 3.0 * x - y + random.below(5) as f64;
                    (random.below(keys), [x, y, z])
                })
                .collect();
            records.sort_unstable_by_key(|record| record.0);
            let mut blocks = Blocks::new(6);
            records.chunks(999).for_each(|some| blocks.extend(some));
            let blocks = blocks.finish();
            let mut next = 0;
            for block in &blocks {
                assert_eq!(block.start, next);
                assert!((1..=BLOCK).contains(&block.count));
                next += block.count as u64;
                let own = &records[block.start as usize..next as usize];
                assert_eq!(block.keys, [own[0].0, own[own.len() - 1].0]);
                assert_eq!(block.keys[0] >> 6, block.keys[1] >> 6);
                let [low, high] = block.residuals;
                for &(_, [x, y, z]) in own {
                    let above = z - block.height([x, y]);
                    assert!(above >= low && above <= high);
                }
                assert!(own.len() < 100 || high - low < 5.5, "{low} {high}");
            }
            assert_eq!(next, count as u64);
        }
    }
}
