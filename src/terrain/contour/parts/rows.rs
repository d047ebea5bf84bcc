//! Contours of a raster that is larger than memory, from some of its rows at a time.

use super::ContourParts;
use super::keyed::Keyed;
use crate::error::Result;
use crate::terrain::contour::bands::Bands;
use crate::terrain::{GridSurface, Levels};

impl ContourParts {
    /// Returns the parts of some rows of a raster. Rows that follow begin with the last of these:
    /// then [`join_level`](super::join_level) returns the lines of the whole raster.
    ///
    /// # Errors
    /// If there are too many levels (see [`Levels::within`]).
    ///
    /// # Complexity
    /// That of [`contours`](crate::terrain::contours).
    pub(crate) fn of_rows(rows: &GridSurface, levels: &Levels) -> Result<Self> {
        let keyed = Keyed {
            surface: rows,
            key_of: |vertex| rows.cell_of(vertex),
        };
        let mut bands = Bands::new(rows, levels)?;
        let mut parts = Vec::new();
        while let Some(band) = bands.next(|level, traces| keyed.parts(level, traces)) {
            parts.extend(band);
        }
        for (level, side) in keyed.level_sides(rows.faces_of_first_and_last_row(), bands.index()) {
            parts[level].sides.push(side);
        }
        for (level, sites) in bands.narrow_sites() {
            parts[level].narrow = sites;
        }
        parts.retain(|parts| !parts.is_empty());
        Ok(ContourParts {
            heights: bands.heights(),
            levels: parts,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Frame, Grid};
    use crate::terrain::contour::contours;
    use crate::terrain::contour::parts::{BendFinder, LevelParts, join_level};
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
                parts.push(ContourParts::of_rows(&surface, &levels).unwrap());
                row = end;
            }
            let all = levels.within(f64::MIN, f64::MAX).unwrap();
            let of_level = |level: f64| -> Vec<LevelParts> {
                let all = parts.iter().flat_map(|parts| parts.levels());
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
