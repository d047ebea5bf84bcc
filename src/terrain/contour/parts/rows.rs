//! Contours of a raster that is larger than memory, from some of its rows at a time.

use super::keyed::Keyed;
use super::{LevelParts, LevelSide};
use crate::error::Result;
use crate::terrain::contour::bands::Bands;
use crate::terrain::{GridSurface, Levels};
use std::collections::BTreeMap;

/// Calls `take` with the parts of each level that some rows of a raster have, by ascending levels.
/// Returns the lowest and the highest height. Rows that follow begin with the last of these: then
/// [`join_level`](super::join_level) returns the lines of the whole raster.
///
/// # Errors
/// If there are too many levels (see [`Levels::within`]), and those of `take`.
///
/// # Complexity
/// That of [`contours`](crate::terrain::contours), also in memory: parts are made when they are
/// taken.
pub(crate) fn parts_of_rows(
    rows: &GridSurface,
    levels: &Levels,
    mut take: impl FnMut(&LevelParts) -> Result<()>,
) -> Result<[f64; 2]> {
    let keyed = Keyed {
        surface: rows,
        key_of: |vertex| rows.cell_of(vertex),
    };
    let mut bands = Bands::new(rows, levels)?;
    let mut sides: BTreeMap<usize, Vec<LevelSide>> = BTreeMap::new();
    for (level, side) in keyed.level_sides(rows.faces_of_first_and_last_row(), bands.index()) {
        sides.entry(level).or_default().push(side);
    }
    let mut narrow: BTreeMap<usize, Vec<[f64; 2]>> = bands.narrow_sites().into_iter().collect();
    let mut level = 0;
    while let Some(band) = bands.next(|level, traces| keyed.parts(level, traces)) {
        for mut parts in band {
            parts.sides = sides.remove(&level).unwrap_or_default();
            parts.narrow = narrow.remove(&level).unwrap_or_default();
            if !parts.is_empty() {
                take(&parts)?;
            }
            level += 1;
        }
    }
    Ok(bands.heights())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Frame, Grid};
    use crate::terrain::contour::contours;
    use crate::terrain::contour::parts::{BendFinder, join_level};
    use testkit::random::Random;

    /// Lakes, saddles, holes and staircases that go through the rows at which the raster is cut.
    fn raster(random: &mut Random) -> Grid {
        let [width, height] = [1 + random.index(9), 1 + random.index(12)];
        let [heights, holes] = [2 + random.below(4), random.below(3)];
        let values = (0..width * height)
            .map(|_| match random.below(12) < holes {
                true => f64::NAN,
                false => random.below(heights) as f64 * 0.5,
            })
            .collect();
        let transform = match random.below(3) {
            0 => [512_000.1, 0.3, 0.0, 5_403_000.7, 0.0, -0.3],
            1 => [-3.0, 0.7, 0.1, 11.0, -0.2, 0.7],
            _ => [0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        };
        Grid {
            frame: Frame {
                width,
                height,
                transform,
            },
            crs: None,
            values,
        }
    }

    #[test]
    fn rows_give_the_lines_of_the_raster() {
        let mut random = Random(37);
        let levels = Levels::listed(&[0.0, 0.3, 0.5, 1.0, 1.25, 1.5, 2.0]).unwrap();
        for round in 0..3000 {
            let raster = raster(&mut random);
            let Frame { width, height, .. } = raster.frame;
            let mut parts = Vec::new();
            let mut row = 0;
            while row + 1 < height {
                let end = (row + 1 + random.index(4)).min(height - 1);
                let rows = Grid {
                    frame: Frame {
                        height: end + 1 - row,
                        ..raster.frame
                    },
                    crs: None,
                    values: raster.values[row * width..(end + 1) * width].to_vec(),
                };
                let surface = GridSurface::of_rows(&rows, row).unwrap();
                let take = |of_level: &LevelParts| {
                    parts.push(of_level.clone());
                    Ok(())
                };
                parts_of_rows(&surface, &levels, take).unwrap();
                row = end;
            }
            let all = levels.within(f64::MIN, f64::MAX).unwrap();
            let of_level = |level: f64| -> Vec<LevelParts> {
                let all = parts.iter();
                all.filter(|parts| parts.level() == level)
                    .cloned()
                    .collect()
            };
            let mut finder = BendFinder::default();
            for &level in &all {
                finder.add(level, of_level(level)).unwrap();
            }
            let bends = finder.finish();
            let lines: Vec<_> = all
                .iter()
                .flat_map(|&level| join_level(level, of_level(level), &bends).unwrap())
                .collect();
            let whole = GridSurface::new(&raster).unwrap();
            let expected: Vec<_> = contours(&whole, &levels).unwrap().collect();
            assert_eq!(lines, expected, "round {round}: {raster:?}");
        }
    }
}
