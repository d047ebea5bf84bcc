//! Cells whose lowest point is below the ground.

use rayon::prelude::*;

use super::fill::filled;
use super::openings::closed;
use super::raster::Raster;
use super::recipe::Recipe;

/// How far from a cell the lowest ones are compared with it, in cells.
const AROUND: isize = 8;

/// The lowest cells around, of which the highest is compared.
const RANK: usize = 5;

/// Empties the cells that are pits: far below all neighbors, and also below the fifth lowest cell
/// around. So a single hit of the ground below trees stays. Returns the raster filled.
pub(super) fn remove_pits(raster: &mut Raster, side: f64, recipe: &Recipe) -> Raster {
    let surface = filled(raster);
    let closed = closed(&surface, 1);
    let depth = (recipe.pit_cells * side) as f32;
    let pits: Vec<usize> = (0..raster.values.len())
        .into_par_iter()
        .filter(|&at| {
            let value = raster.values[at];
            closed.values[at] - value > depth
                && fifth_lowest(raster, at % raster.width, at / raster.width)
                    .is_some_and(|low| value < low - recipe.pit_depth as f32)
        })
        .collect();
    if pits.is_empty() {
        return surface;
    }
    for at in pits {
        raster.values[at] = f32::NAN;
    }
    filled(raster)
}

/// Returns the fifth lowest value around a cell, apart from its neighbors.
fn fifth_lowest(raster: &Raster, column: usize, row: usize) -> Option<f32> {
    let mut values = Vec::new();
    for down in -AROUND..=AROUND {
        for across in -AROUND..=AROUND {
            if across * across + down * down > AROUND * AROUND + 1
                || across.abs().max(down.abs()) < 2
            {
                continue;
            }
            let column = column.checked_add_signed(across);
            let row = row.checked_add_signed(down);
            if let (Some(column), Some(row)) = (column, row)
                && column < raster.width
                && row < raster.height
                && !raster.at(column, row).is_nan()
            {
                values.push(raster.at(column, row));
            }
        }
    }
    values.sort_unstable_by(f32::total_cmp);
    values.get(RANK - 1).copied()
}
