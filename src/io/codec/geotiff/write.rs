use std::io::Write;

use super::cell_format::CellFormat;
use super::directory::{self, Offsets};
use super::image::{Image, Packed, RasterSummary, Tiling};
use super::overview::Halved;
use crate::data::{BlockSource, Frame};
use crate::error::Result;
use crate::io::bytes::appended::appended;
use crate::io::bytes::watch::unwatched;
use crate::io::{Destination, Output, Watch};

/// Smaller images of a raster in its file, from which programs draw it at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
pub enum Overviews {
    /// As many as a cloud-optimized GeoTIFF has: down to 512 columns and rows.
    #[default]
    Auto,
    /// None: written in less time and a third less space.
    None,
}

impl Overviews {
    /// Returns how many times the cells of a raster are on the disk while it is written: with
    /// overviews, which add a third, twice.
    pub fn copies_on_disk(self) -> f64 {
        match self {
            Overviews::Auto => 8.0 / 3.0,
            Overviews::None => 1.0,
        }
    }
}

/// How a raster is written.
#[derive(Clone, Copy)]
pub struct WriteOptions<'a> {
    /// What the cells contain.
    pub cells: CellFormat<'a>,
    /// Whether the raster has overviews.
    pub overviews: Overviews,
    /// Called with the cells that were computed since the last call, [`cells_written`] in all, from
    /// any thread.
    pub watch: Watch<'a>,
}

impl Default for WriteOptions<'_> {
    fn default() -> Self {
        CellFormat::default().into()
    }
}

/// Options for these contents, unwatched.
impl<'a> From<CellFormat<'a>> for WriteOptions<'a> {
    fn from(cells: CellFormat<'a>) -> Self {
        WriteOptions {
            cells,
            overviews: Overviews::Auto,
            watch: &unwatched,
        }
    }
}

impl std::fmt::Debug for WriteOptions<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("WriteOptions")
            .field("cells", &self.cells)
            .field("overviews", &self.overviews)
            .finish_non_exhaustive()
    }
}

/// A raster of at most this many columns and rows has no overviews, as with GDAL's COG driver.
const LARGEST_WITHOUT: usize = 512;

/// Writes a cloud-optimized GeoTIFF: one band, or four of colors, DEFLATE, tiles of 256 x 256,
/// PixelIsArea, with the coordinate system of the source.
///
/// A raster of more than 512 columns or rows has overviews, each with half the columns and rows of
/// the one before, down to 512; a cell has the mean of those of its four that have a value. Colors
/// have no overviews, and other rasters [may have none](Overviews::None).
///
/// All cores compute and compress tiles, a few at a time, which are written in order. Memory stays
/// at some megabytes whatever the size of the raster, and the bytes do not depend on the number of
/// threads. Tiles without any value are left out (a sparse file, as with GDAL's SPARSE_OK). The
/// file is a BigTIFF if it might otherwise exceed 4 GiB. It appears at its target once it is
/// complete; with overviews its tiles are on the same disk twice until then.
///
/// # Errors
/// If the raster has no cells or too many, the source fails, or the file cannot be written; and
/// that of the watch.
///
/// # Complexity
/// Linear in the cells, each of which is asked for once.
pub fn write<'a>(
    target: impl Into<Destination<'a>>,
    source: &dyn BlockSource,
    options: WriteOptions<'_>,
) -> Result<RasterSummary> {
    let target = target.into();
    let write = || {
        write_levels(
            &target,
            source,
            options,
            offsets_for(source.frame(), &options)?,
        )
    };
    let path = target.path().to_path_buf();
    let (summary, output) = write().map_err(|e| e.in_file(&path))?;
    // Overviews and statistics of a previous raster would be attributed to this one.
    let beside = [".ovr", ".aux.xml"].map(|end| appended(&path, end));
    target.put_all([], output, beside)?;
    Ok(summary)
}

/// Returns the number of cells that [`write()`] computes, those of overviews included.
pub fn cells_written(frame: Frame, options: &WriteOptions) -> u64 {
    levels(frame, options)
        .map(|Frame { width, height, .. }| (width as u64).saturating_mul(height as u64))
        .fold(0, u64::saturating_add)
}

/// Returns the frame of a raster, and frames with the sizes of its overviews.
fn levels(frame: Frame, options: &WriteOptions) -> impl Iterator<Item = Frame> + use<> {
    let has_overviews = options.cells.has_overviews() && options.overviews == Overviews::Auto;
    std::iter::successors(
        Some(frame),
        move |&Frame {
                  width,
                  height,
                  transform,
              }| {
            let is_large = has_overviews && width.max(height) > LARGEST_WITHOUT;
            is_large.then(|| Frame {
                width: width.div_ceil(2),
                height: height.div_ceil(2),
                transform,
            })
        },
    )
}

/// Returns 32-bit offsets if they are certain to suffice for a raster and its overviews.
fn offsets_for(frame: Frame, options: &WriteOptions) -> Result<Offsets> {
    let most: u64 = levels(frame, options)
        .map(|frame| Ok(Tiling::new(frame)?.most_bytes(options.cells)))
        .sum::<Result<_>>()?;
    // If the tiles do not exceed 4 GiB, 2 MB is ample for the header.
    Ok(if most + (1 << 21) < 1 << 32 {
        Offsets::Bits32
    } else {
        Offsets::Bits64
    })
}

/// Packs the raster and its overviews, and joins them: headers first, then the tiles of the
/// smallest image, so that a reader gets a picture of the whole from the first bytes.
fn write_levels(
    target: &Destination,
    source: &dyn BlockSource,
    options: WriteOptions<'_>,
    offsets: Offsets,
) -> Result<(RasterSummary, Output)> {
    let WriteOptions { cells, watch, .. } = options;
    if levels(source.frame(), &options).nth(1).is_none() {
        let mut output = target.create_seekable()?;
        let packed = Packed::write(&mut output, source, cells, offsets, watch)?;
        return Ok((packed.summary, output));
    }
    let mut output = target.create()?;
    let mut images = vec![Image::pack(target, source, cells, watch)?];
    for _ in levels(source.frame(), &options).skip(1) {
        let finer = images[images.len() - 1].reader(target)?;
        images.push(Image::pack(target, &Halved::new(finer), cells, watch)?);
    }
    // The raster itself is the last in the file, and the first in the header.
    let header = |first: u64| {
        let packed = || images.iter().map(|image| &image.packed);
        let mut at = first + packed().map(Packed::byte_count).sum::<u64>();
        let tags_of = |(level, image): (usize, &Packed)| {
            at -= image.byte_count();
            if level == 0 {
                image.tags(source, cells, at)
            } else {
                image.overview_tags(source, cells, at)
            }
        };
        directory::header(
            offsets,
            &packed().enumerate().map(tags_of).collect::<Vec<_>>(),
        )
    };
    let head = header(header(0).len() as u64);
    output.write_all(&head)?;
    images
        .iter_mut()
        .rev()
        .try_for_each(|image| image.copy_to(&mut output, watch))?;
    Ok((images[0].packed.summary, output))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Grid, Window};
    use crate::io::codec::geotiff::tile::SIDE;

    struct Slope(Frame);

    impl BlockSource for Slope {
        fn frame(&self) -> Frame {
            self.0
        }

        fn crs(&self) -> Option<&crate::crs::Crs> {
            None
        }

        fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
            for (i, cell) in out.iter_mut().enumerate() {
                let (column, row) = (
                    window.column + i % window.width,
                    window.row + i / window.width,
                );
                // Every seventh cell, and all of the second column of tiles, have no value.
                let is_hole = (column + row) % 7 == 0 || (SIDE..2 * SIDE).contains(&column);
                *cell = if is_hole {
                    f32::NAN
                } else {
                    column as f32 * 0.25 - row as f32
                };
            }
            Ok(())
        }
    }

    /// The cells of the overviews, as the `tiff` crate decodes them.
    fn overviews(path: &std::path::Path, count: usize) -> Vec<Vec<f32>> {
        let mut decoder = tiff::decoder::Decoder::new(std::fs::File::open(path).unwrap()).unwrap();
        let mut next = || {
            decoder.next_image().unwrap();
            match decoder.read_image().unwrap() {
                tiff::decoder::DecodingResult::F32(cells) => cells,
                _ => panic!("not f32"),
            }
        };
        (0..count).map(|_| next()).collect()
    }

    fn written(offsets: Offsets) -> (Grid, bool, Vec<Vec<f32>>) {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("slope.tif");
        let frame = Frame::north_up(1000.0, 2000.0, 0.5, 1200, 700);
        let written = write_levels(
            &(&target).into(),
            &Slope(frame),
            WriteOptions::default(),
            offsets,
        )
        .unwrap();
        written.1.commit().unwrap();
        let reader = crate::io::codec::geotiff::open(&target).unwrap();
        assert_eq!(reader.info().overviews, [[600, 350], [300, 175]]);
        (
            reader.read_grid().unwrap(),
            reader.info().is_big_tiff,
            overviews(&target, 2),
        )
    }

    #[test]
    fn classic_and_big_files_hold_the_same() {
        let (small, is_big, small_overviews) = written(Offsets::Bits32);
        assert!(!is_big);
        let (big, is_big, big_overviews) = written(Offsets::Bits64);
        assert!(is_big);
        assert_eq!(small.frame, big.frame);
        assert!(
            small
                .values
                .iter()
                .map(|v| v.to_bits())
                .eq(big.values.iter().map(|v| v.to_bits()))
        );
        assert_eq!(small_overviews, big_overviews);
        // Columns 2 and 3 of rows 0 and 1, all of which have a value; the hole is a hole.
        assert_eq!(
            (small_overviews[0][1], small_overviews[0][130]),
            (0.125, -9999.0)
        );
        assert_eq!(small.value(1, 0), 0.25);
        assert!(small.value(300, 5).is_nan() && small.value(7, 0).is_nan());
    }

    #[test]
    fn offsets_are_wide_when_the_file_may_pass_four_gibibytes() {
        let offsets = |side, cells: CellFormat| {
            let frame = Frame::north_up(0.0, 0.0, 1.0, side, side);
            offsets_for(frame, &cells.into()).unwrap()
        };
        assert_eq!(offsets(28_000, CellFormat::Heights), Offsets::Bits32);
        assert_eq!(offsets(29_000, CellFormat::Heights), Offsets::Bits64);
        assert_eq!(offsets(55_000, CellFormat::Shades), Offsets::Bits32);
        assert_eq!(offsets(58_000, CellFormat::Shades), Offsets::Bits64);
    }

    #[test]
    fn overviews_halve_down_to_512() {
        let sizes = |width, height| -> Vec<[usize; 2]> {
            let all = levels(
                Frame::north_up(0.0, 0.0, 1.0, width, height),
                &WriteOptions::default(),
            );
            all.map(|Frame { width, height, .. }| [width, height])
                .collect()
        };
        assert_eq!(sizes(512, 1), [[512, 1]]);
        assert_eq!(sizes(513, 2), [[513, 2], [257, 1]]);
        assert_eq!(sizes(1, 2500), [[1, 2500], [1, 1250], [1, 625], [1, 313]]);
        assert_eq!(
            cells_written(
                Frame::north_up(0.0, 0.0, 1.0, 600, 300),
                &CellFormat::Shades.into()
            ),
            600 * 300 + 300 * 150
        );
        let without = WriteOptions {
            overviews: Overviews::None,
            ..WriteOptions::default()
        };
        assert_eq!(
            cells_written(Frame::north_up(0.0, 0.0, 1.0, 600, 300), &without),
            600 * 300
        );
    }
}
