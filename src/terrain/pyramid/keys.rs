//! Keys of tiles and of positions: how far along a curve through all tiles of a level they are.

use crate::data::{TilePosition, Tiling};
use crate::terrain::sample::on_curve;

/// The tile of a level that owns a position.
pub(super) fn owner([x, y, _]: [f64; 3], tiling: Tiling, level: u8) -> TilePosition {
    let last = tiling.size(level).map(|size| f64::from(size - 1));
    let [column, row] = [(x, 0), (y, 1)].map(|(c, axis)| {
        tiling
            .in_sides(axis, level, c)
            .floor()
            .clamp(0.0, last[axis]) as u32
    });
    TilePosition { level, column, row }
}

/// The position of a tile on a curve through all of its level: that of a tile of the next coarser
/// level is a quarter of it.
fn key(at: TilePosition) -> u64 {
    on_curve([at.column, at.row])
}

/// The key of the tile of a level that owns a position.
pub(super) fn key_of(p: [f64; 3], tiling: Tiling, level: u8) -> u64 {
    key(owner(p, tiling, level))
}

/// The first and the last key that a position of a tile can have.
pub(super) fn keys_of(at: TilePosition) -> [u64; 2] {
    let within = 2 * u32::from(Tiling::MAX_LEVEL - at.level);
    [key(at) << within, ((key(at) + 1) << within) - 1]
}
