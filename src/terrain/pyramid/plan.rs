//! Where a surface is on the earth, and which tiles it needs.

use rustc_hash::FxHashSet;

use super::keys::owner;
use crate::data::{TilePosition, Tiling};
use crate::error::{Error, Result, Setting, wording};

/// The largest number of tiles of all levels together.
const MAX_TILES: usize = 1 << 22;

/// Turns positions of a surface, some at a time, into longitudes and latitudes with heights in
/// meters.
pub type ToEarth<'a> = dyn Fn(&mut [[f64; 3]]) -> Result<()> + Sync + 'a;

/// Turns positions of a surface into those of a tiling, and checks them.
pub(super) fn to_earth(
    positions: &mut [[f64; 3]],
    tiling: Tiling,
    convert: &ToEarth,
) -> Result<()> {
    let before = positions.to_vec();
    convert(positions)?;
    let size = tiling.size(0);
    for (p, from) in positions.iter().zip(before) {
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
    Ok(())
}

/// The tiles of the finest level that may have a part of the surface.
pub(super) struct FinestTiles {
    tiling: Tiling,
    finest: u8,
    own: FxHashSet<TilePosition>,
}

impl FinestTiles {
    pub(super) fn new(tiling: Tiling, finest: u8) -> Self {
        FinestTiles {
            tiling,
            finest,
            own: FxHashSet::default(),
        }
    }

    /// Returns an error if a surface of this area, in tiles of the coarsest level, has too many: it
    /// would be crossed by as many lines.
    ///
    /// # Errors
    /// If there are too many.
    pub(super) fn require_room(&self, area: f64) -> Result<()> {
        let side = f64::from(1_u32 << self.finest);
        match area * side * side > MAX_TILES as f64 {
            true => Err(self.too_many()),
            false => Ok(()),
        }
    }

    fn too_many(&self) -> Error {
        let finest = self.finest;
        Error::limit(format!(
            "level {finest} has more than {MAX_TILES} tiles of the surface"
        ))
        .cure(wording![
            "pass a smaller ",
            Setting::MaxLevel,
            ", or a larger ",
            Setting::MaxError
        ])
    }

    /// Adds the tiles that a triangle may meet.
    ///
    /// # Errors
    /// If there are too many.
    pub(super) fn add(&mut self, face: [[f64; 3]; 3]) -> Result<()> {
        let corners = face.map(|p| owner(p, self.tiling, self.finest));
        let range = |of: fn(&TilePosition) -> u32| {
            let all = corners.iter().map(of);
            all.clone().min().unwrap_or(0)..=all.max().unwrap_or(0)
        };
        let (columns, rows) = (range(|at| at.column), range(|at| at.row));
        let count =
            |range: &std::ops::RangeInclusive<u32>| (range.end() - range.start()) as usize + 1;
        if count(&columns).saturating_mul(count(&rows)) > MAX_TILES {
            return Err(self.too_many());
        }
        for column in columns {
            self.own.extend(rows.clone().map(|row| TilePosition {
                level: self.finest,
                column,
                row,
            }));
        }
        self.require_few()
    }

    /// Adds those of another part of the surface.
    ///
    /// # Errors
    /// If there are too many.
    pub(super) fn merge(&mut self, other: Self) -> Result<()> {
        self.own.extend(other.own);
        self.require_few()
    }

    fn require_few(&self) -> Result<()> {
        match self.own.len() > MAX_TILES {
            true => Err(self.too_many()),
            false => Ok(()),
        }
    }

    /// Returns, for each level up to the finest one, the tiles that may have a part of the surface;
    /// at the coarsest level, all tiles.
    pub(super) fn of_levels(self) -> Vec<Vec<TilePosition>> {
        let mut own = self.own;
        let mut levels = Vec::new();
        for level in (0..=self.finest).rev() {
            if level == 0 {
                let [columns, rows] = self.tiling.size(0);
                let row = |row| (0..columns).map(move |column| TilePosition { level, column, row });
                own.extend((0..rows).flat_map(row));
            }
            let mut tiles: Vec<TilePosition> = own.iter().copied().collect();
            tiles.sort_unstable();
            own = tiles.iter().map(|&at| above(at)).collect();
            levels.push(tiles);
        }
        levels.reverse();
        levels
    }
}

/// The tile of the next coarser level that has a tile.
fn above(at: TilePosition) -> TilePosition {
    TilePosition {
        level: at.level.saturating_sub(1),
        column: at.column / 2,
        row: at.row / 2,
    }
}
