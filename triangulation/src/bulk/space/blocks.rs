//! Divides the points between threads: blocks of space that are triangulated on their own.
//!
//! The cells of a block are those of all points if no point outside can be in conflict with them.
//! That is sure of cells whose spheres lie within the block. The others are *open*; their vertices
//! are triangulated again, see [`merge`](super::merge).

use std::collections::HashMap;

use super::sphere::{self, Frame, Sphere};

/// Fewer points are not divided.
const FEWEST: usize = 1 << 16;

/// Blocks have at least so many points, except where there are only two blocks.
const MANY: usize = 1 << 19;

/// There are at most two blocks to this power.
const MOST_LEVELS: u32 = 4;

/// The largest share of points at open cells for which blocks save time.
const MOST_OPEN: f64 = 0.1;

/// Returns the number of times that so many points are halved.
pub(super) fn levels(count: usize) -> u32 {
    if count < FEWEST {
        0
    } else {
        (count / MANY).max(2).ilog2().min(MOST_LEVELS)
    }
}

/// A box, unbounded where nothing cuts it off, in the frame of all points.
#[derive(Clone, Copy)]
pub(super) struct Block {
    /// No point of another block that is beyond this side is below it.
    low: [f32; 3],
    high: [f32; 3],
}

impl Block {
    const SPACE: Self = Block {
        low: [f32::NEG_INFINITY; 3],
        high: [f32::INFINITY; 3],
    };

    /// Returns true if no point outside of the block can be in conflict with a cell of this sphere.
    pub(super) fn contains(&self, sphere: Sphere) -> bool {
        (0..3).all(|axis| {
            let [low, high] = [self.low[axis], self.high[axis]];
            low < sphere[axis]
                && sphere[axis] < high
                && sphere::is_short_of(sphere, axis, low)
                && sphere::is_short_of(sphere, axis, high)
        })
    }
}

/// A plane that divides a block: coordinates on an axis that are less than `at` are below it.
#[derive(Clone, Copy)]
struct BlockCut {
    axis: usize,
    at: f64,
}

/// The cuts of a tree (Bentley 1975) in the order of a heap, and the blocks that are its leaves.
pub(super) struct Blocks {
    cuts: Vec<BlockCut>,
    blocks: Vec<Block>,
}

impl Blocks {
    /// Returns blocks by the medians of a sample of points. `None` if too many of its points are in
    /// one plane.
    pub(super) fn of(sample: &mut [[f64; 3]], levels: u32, frame: Frame) -> Option<Self> {
        let mut blocks = Blocks {
            cuts: Vec::new(),
            blocks: vec![Block::SPACE],
        };
        let mut parts = vec![sample];
        for _ in 0..levels {
            let halves = parts.into_iter().map(halved).collect::<Option<Vec<_>>>()?;
            let mut divided = Vec::new();
            for (block, (cut, _)) in blocks.blocks.iter().zip(&halves) {
                let at = frame.on_axis(cut.axis, cut.at) as f32;
                let (mut below, mut above) = (*block, *block);
                below.high[cut.axis] = at;
                above.low[cut.axis] = at;
                divided.extend([below, above]);
            }
            blocks.blocks = divided;
            blocks.cuts.extend(halves.iter().map(|(cut, _)| *cut));
            parts = halves.into_iter().flat_map(|(_, halves)| halves).collect();
        }
        Some(blocks)
    }

    /// Returns true if blocks of all points are expected to take less time than the whole, by the
    /// finite cells of a sample.
    ///
    /// A layer of points at the cuts has open cells. In a volume its share of the points decreases
    /// with the root of the density; where it does not, it is large.
    pub(super) fn are_worth_it(
        &self,
        count: usize,
        sample: impl Iterator<Item = ([u32; 4], Sphere)>,
    ) -> bool {
        let mut is_open = HashMap::new();
        for (vertices, sphere) in sample {
            let opens = !self.blocks.iter().any(|block| block.contains(sphere));
            for vertex in vertices {
                *is_open.entry(vertex).or_insert(false) |= opens;
            }
        }
        let open = is_open.values().filter(|&&is_open| is_open).count() as f64;
        let sampled = is_open.len() as f64;
        open / sampled * (sampled / count as f64).cbrt() <= MOST_OPEN
    }

    /// Returns the number of the block that a point is in.
    pub(super) fn index_of(&self, [x, y, z]: [f64; 3]) -> usize {
        let mut node = 0;
        while let Some(cut) = self.cuts.get(node) {
            node = 2 * node + if [x, y, z][cut.axis] < cut.at { 1 } else { 2 };
        }
        node - self.cuts.len()
    }

    pub(super) fn each(&self) -> &[Block] {
        &self.blocks
    }
}

/// Returns the plane through the median on the axis on which sites extend farthest, and the sites
/// on both sides. `None` if too many sites are in one plane.
fn halved(sites: &mut [[f64; 3]]) -> Option<(BlockCut, [&mut [[f64; 3]]; 2])> {
    let length = |axis: usize| {
        let (min, max) = sites
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(min, max), site| {
                (site[axis].min(min), site[axis].max(max))
            });
        max - min
    };
    let lengths = [0, 1, 2].map(length);
    let axis = (0..3).max_by(|&i, &j| lengths[i].total_cmp(&lengths[j]))?;
    let half = sites.len() / 2;
    if half == 0 {
        return None;
    }
    let at = sites
        .select_nth_unstable_by(half, |p, q| p[axis].total_cmp(&q[axis]))
        .1[axis];
    sites.sort_unstable_by_key(|site| site[axis] >= at);
    let (below, above) = sites.split_at_mut(sites.partition_point(|site| site[axis] < at));
    (below.len() > above.len() / 2).then_some((BlockCut { axis, at }, [below, above]))
}
