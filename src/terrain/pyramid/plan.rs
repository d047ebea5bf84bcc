//! Where a surface is on the earth, and which tiles it needs.

use rustc_hash::FxHashSet;

use super::heights::owner;
use crate::data::{TilePosition, Tiling};
use crate::error::{Error, Result, Setting, wording};

/// The largest number of tiles of all levels together.
const MAX_TILES: usize = 1 << 22;

/// Turns positions of a surface into those of a tiling, and checks them.
pub(super) fn to_earth(
    positions: &mut [[f64; 3]],
    used: &[bool],
    tiling: Tiling,
    convert: &(dyn Fn(&mut [[f64; 3]]) -> Result<()> + Sync),
) -> Result<()> {
    let mut own: Vec<[f64; 3]> = positions
        .iter()
        .zip(used)
        .filter_map(|(p, used)| used.then_some(*p))
        .collect();
    let before = own.clone();
    convert(&mut own)?;
    let size = tiling.size(0);
    for (p, from) in own.iter().zip(before) {
        if p.iter().any(|c| !c.is_finite()) {
            return Err(Error::format(format!(
                "{from:?} has no position on the earth"
            )));
        }
        let is_inside = (0..2).all(|axis| {
            let at = tiling.in_sides(axis, 0, p[axis]);
            at >= 0.0 && at <= f64::from(size[axis])
        });
        if !is_inside {
            return Err(Error::format(format!(
                "{from:?} is beyond all tiles of EPSG:{}",
                tiling.epsg()
            )));
        }
    }
    let mut own = own.into_iter();
    for (p, _) in positions.iter_mut().zip(used).filter(|(_, used)| **used) {
        *p = own.next().unwrap_or(*p);
    }
    Ok(())
}

/// Returns, for each level up to the finest one, the tiles that may have a part of the surface; at
/// the coarsest level, all tiles.
pub(super) fn tiles_of(
    faces: impl Iterator<Item = [[f64; 3]; 3]>,
    tiling: Tiling,
    finest: u8,
) -> Result<Vec<Vec<TilePosition>>> {
    let too_many = || {
        Error::limit(format!(
            "level {finest} has more than {MAX_TILES} tiles of the surface"
        ))
        .cure(wording![
            "pass a smaller ",
            Setting::MaxLevel,
            ", or a larger ",
            Setting::MaxError
        ])
    };
    let mut own: FxHashSet<TilePosition> = FxHashSet::default();
    for face in faces {
        let corners = face.map(|p| owner(p, tiling, finest));
        let range = |of: fn(&TilePosition) -> u32| {
            let all = corners.iter().map(of);
            all.clone().min().unwrap_or(0)..=all.max().unwrap_or(0)
        };
        let (columns, rows) = (range(|at| at.column), range(|at| at.row));
        let count =
            |range: &std::ops::RangeInclusive<u32>| (range.end() - range.start()) as usize + 1;
        if count(&columns).saturating_mul(count(&rows)) > MAX_TILES {
            return Err(too_many());
        }
        for column in columns {
            own.extend(rows.clone().map(|row| TilePosition {
                level: finest,
                column,
                row,
            }));
        }
        if own.len() > MAX_TILES {
            return Err(too_many());
        }
    }
    let mut levels = Vec::new();
    for level in (0..=finest).rev() {
        if level == 0 {
            let [columns, rows] = tiling.size(0);
            let row = |row| (0..columns).map(move |column| TilePosition { level, column, row });
            own.extend((0..rows).flat_map(row));
        }
        let mut tiles: Vec<TilePosition> = own.iter().copied().collect();
        tiles.sort_unstable();
        own = tiles
            .iter()
            .map(|at| TilePosition {
                level: level.saturating_sub(1),
                column: at.column / 2,
                row: at.row / 2,
            })
            .collect();
        levels.push(tiles);
    }
    levels.reverse();
    Ok(levels)
}
