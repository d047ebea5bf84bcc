//! How full tiles are, by what the headers of files state.

use super::planned_file::PlannedFile;
use crate::terrain::tiles::{Spread, Tile, TileLayout, Work};

/// Returns about how many points the fullest tile has. `tiles` has, for each file, the tile that it
/// is; `None` if the file is divided among tiles.
pub(super) fn fullest(layout: &TileLayout, files: &[PlannedFile], tiles: &[Option<u32>]) -> u64 {
    let points = points_of_tiles(layout, files, tiles);
    points.into_iter().fold(0.0, f64::max).ceil() as u64
}

/// Returns about how many points each tile has, of files that are tiles or are divided.
fn points_of_tiles(layout: &TileLayout, files: &[PlannedFile], tiles: &[Option<u32>]) -> Vec<f64> {
    let mut points = vec![0.0; layout.tile_count()];
    let mut rectangles = vec![Tile::PLANE; layout.tile_count()];
    for step in layout.steps() {
        if let Work::Leaf(tile) = step.work {
            rectangles[tile as usize] = step.tile;
        }
    }
    for (file, tile) in files.iter().zip(tiles) {
        let Spread { min, max, count } = file.spread();
        if let Some(tile) = *tile {
            points[tile as usize] += count;
            continue;
        }
        layout.tiles_in(min, max, &mut |tile| {
            let within = &rectangles[tile as usize];
            let share = |k: usize| {
                let length = max[k] - min[k];
                let common = max[k].min(within.max[k]) - min[k].max(within.min[k]);
                if length > 0.0 { common / length } else { 1.0 }
            };
            points[tile as usize] += count * share(0) * share(1);
        });
    }
    points
}
