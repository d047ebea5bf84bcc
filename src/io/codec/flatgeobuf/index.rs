//! The index: a packed R-tree over records that are sorted along a Hilbert curve. The root comes
//! first, the nodes of the records last; a node has the number of its first child, or the position
//! of its record.

use std::io::{self, Write};

/// Children of a node in files that are written.
pub(super) const NODE_SIZE: u16 = 16;

/// Bytes of a node: its extent and a number.
const NODE: u64 = 40;

/// A rectangle: the smallest x and y, then the largest.
pub(super) type Extent = [f64; 4];

/// The extent of nothing.
pub(super) const NOTHING: Extent = [
    f64::INFINITY,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NEG_INFINITY,
];

pub(super) fn merged(a: Extent, b: Extent) -> Extent {
    [
        a[0].min(b[0]),
        a[1].min(b[1]),
        a[2].max(b[2]),
        a[3].max(b[3]),
    ]
}

/// Returns the numbers of nodes in each level, that of the records first.
fn levels(records: u64, node_size: u64) -> Vec<u64> {
    let mut levels = vec![records];
    let mut count = records;
    loop {
        count = count.div_ceil(node_size);
        levels.push(count);
        if count <= 1 {
            return levels;
        }
    }
}

/// Returns the bytes of the index of a file; `None` if they are too many to be true.
pub(super) fn size(records: u64, node_size: u16) -> Option<u64> {
    if records == 0 || node_size == 0 {
        return Some(0);
    }
    // Readers take fewer than two children as two.
    let levels = levels(records, u64::from(node_size.max(2)));
    let nodes = levels.into_iter().try_fold(0_u64, u64::checked_add);
    nodes?.checked_mul(NODE)
}

/// Returns the position of a cell along the Hilbert curve of order 16.
fn hilbert(mut x: u32, mut y: u32) -> u32 {
    const SIDE: u32 = 1 << 16;
    let mut along = 0;
    let mut side = SIDE / 2;
    while side > 0 {
        let right = u32::from(x & side > 0);
        let upper = u32::from(y & side > 0);
        along += side * side * ((3 * right) ^ upper);
        if upper == 0 {
            if right == 1 {
                (x, y) = (SIDE - 1 - x, SIDE - 1 - y);
            }
            (x, y) = (y, x);
        }
        side /= 2;
    }
    along
}

/// Returns the positions of records with these extents, sorted along the curve through the extent
/// of all. Those at the same position keep their order, and those without an extent come last.
pub(super) fn order(extents: &[Extent]) -> Vec<usize> {
    let all = extents.iter().fold(NOTHING, |all, &one| merged(all, one));
    let cell = |low: f64, high: f64, first: f64, last: f64| {
        let across = last - first;
        let middle = low / 2.0 + high / 2.0 - first;
        match across > 0.0 {
            true => (f64::from(u16::MAX) * (middle / across)) as u32 & u32::from(u16::MAX),
            false => 0,
        }
    };
    let key = |extent: &Extent| match extent[0].is_finite() {
        true => hilbert(
            cell(extent[0], extent[2], all[0], all[2]),
            cell(extent[1], extent[3], all[1], all[3]),
        ),
        false => u32::MAX,
    };
    let mut order: Vec<usize> = (0..extents.len()).collect();
    order.sort_by_cached_key(|&record| key(&extents[record]));
    order
}

/// Writes the index of records that are sorted, each with its extent and its position among the
/// bytes of all.
pub(super) fn write(out: &mut impl Write, records: &[(Extent, u64)]) -> io::Result<()> {
    let size = usize::from(NODE_SIZE);
    let mut levels = vec![records.to_vec()];
    loop {
        let below = levels.last().map_or(&[][..], Vec::as_slice);
        let groups = below.chunks(size).enumerate();
        let node = |(i, children): (usize, &[(Extent, u64)])| {
            let extents = children.iter().map(|&(extent, _)| extent);
            (extents.fold(NOTHING, merged), (i * size) as u64)
        };
        let level: Vec<(Extent, u64)> = groups.map(node).collect();
        let is_root = level.len() <= 1;
        levels.push(level);
        if is_root {
            break;
        }
    }
    // The children of a level come behind all levels above it, and behind itself.
    let mut first = 0;
    for (depth, level) in levels.iter().rev().enumerate() {
        let behind = first + level.len() as u64;
        let is_of_records = depth + 1 == levels.len();
        for (extent, number) in level {
            for side in extent {
                out.write_all(&side.to_le_bytes())?;
            }
            let number = if is_of_records {
                *number
            } else {
                behind + number
            };
            out.write_all(&number.to_le_bytes())?;
        }
        first = behind;
    }
    Ok(())
}
