//! What is written against what is read.

use super::{Hills, written};
use breakline::crs::Crs;
use breakline::data::{BlockSource, ColorMatch, ColorRamp, ColorStop, Frame, StopAt, Window};
use breakline::error::{Error, Result};
use breakline::io::geotiff::{self, CellFormat, WriteOptions};
use breakline::io::png;

#[test]
fn heights_come_back_as_they_were_written() {
    for (width, height) in [(1, 1), (255, 257), (300, 700), (256, 256), (513, 2)] {
        let hills = Hills::new(width, height);
        let (reader, summary, _) = written(&hills, CellFormat::Heights);
        assert_eq!(reader.frame(), hills.frame);
        assert_eq!(reader.info().nodata, Some(-9999.0));
        let grid = reader.read_grid().unwrap();
        let mut valid = 0;
        for row in 0..height {
            for column in 0..width {
                let (found, wanted) = (grid.value(column, row), hills.height(column, row));
                if wanted.is_finite() {
                    assert_eq!(
                        found,
                        f64::from(wanted),
                        "{width} x {height}: column {column}, row {row}"
                    );
                    valid += 1;
                } else {
                    assert!(
                        found.is_nan(),
                        "{width} x {height}: column {column}, row {row}"
                    );
                }
            }
        }
        assert_eq!(summary.valid, valid);
        assert_eq!(
            reader.extremes().unwrap().range,
            Some([summary.min, summary.max])
        );
    }
}

#[test]
fn a_raster_without_values_is_a_few_bytes() {
    let mut hills = Hills::new(3000, 2000);
    hills.is_empty = true;
    let (reader, summary, bytes) = written(&hills, CellFormat::Heights);
    assert!(summary.valid == 0 && summary.min.is_nan() && summary.max.is_nan());
    // The directories of four images.
    assert!(bytes.len() < 2200, "{} bytes", bytes.len());
    assert!(
        reader
            .read_grid()
            .unwrap()
            .values
            .iter()
            .all(|v| v.is_nan())
    );
    assert_eq!(reader.info().warnings, [] as [&str; 0]);
}

#[test]
fn rotated_and_south_up_frames_come_back() {
    for transform in [
        [1841001.75, 1.5, -5.0, 1144003.25, -5.0, -1.5],
        [10.0, 0.5, 0.0, 20.0, 0.0, 0.5],
    ] {
        let mut hills = Hills::new(20, 30);
        hills.frame.transform = transform;
        assert_eq!(written(&hills, CellFormat::Heights).0.frame(), hills.frame);
    }
}

/// Returns columns, rows and cells of each image in a file, as the `tiff` crate decodes them.
fn images(bytes: &[u8]) -> Vec<(usize, usize, Vec<f32>)> {
    let mut decoder = tiff::decoder::Decoder::new(std::io::Cursor::new(bytes)).unwrap();
    let mut all = Vec::new();
    loop {
        let (width, height) = decoder.dimensions().unwrap();
        let tiff::decoder::DecodingResult::F32(cells) = decoder.read_image().unwrap() else {
            panic!("not f32")
        };
        all.push((width as usize, height as usize, cells));
        if !decoder.more_images() {
            return all;
        }
        decoder.next_image().unwrap();
    }
}

/// A raster whose cells are computed from their columns and rows.
struct Cells(Frame, fn(usize, usize) -> f32);

impl BlockSource for Cells {
    fn frame(&self) -> Frame {
        self.0
    }

    fn crs(&self) -> Option<&Crs> {
        None
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        for (i, cell) in out.iter_mut().enumerate() {
            *cell = self.1(
                window.column + i % window.width,
                window.row + i / window.width,
            );
        }
        Ok(())
    }
}

/// Heights with gaps, but none as large as a tile: the `tiff` crate does not read sparse files.
fn wave(column: usize, row: usize) -> f32 {
    let noise = (column * 31 + row * 17) % 53;
    if noise == 0 {
        f32::NAN
    } else {
        (column as f32 * 0.05).sin() * 40.0 + row as f32 + noise as f32
    }
}

/// Shades from 1 to 200 by columns, none in every third.
fn shade(column: usize, _: usize) -> f32 {
    if column % 3 == 2 {
        f32::NAN
    } else {
        (column % 200 + 1) as f32
    }
}

/// A ramp over and beyond the range of a byte, without a value in every third column.
const RAMP: Cells = Cells(
    Frame {
        width: 400,
        height: 300,
        transform: [100.0, 2.0, 0.0, 200.0, 0.0, -2.0],
    },
    |column, _| {
        if column % 3 == 2 {
            f32::NAN
        } else {
            column as f32 - 20.0
        }
    },
);

#[test]
fn an_overview_has_the_means_of_four_cells_each() {
    for (width, height) in [(512, 512), (513, 2), (1, 1025), (1301, 700)] {
        let waves = Cells(Frame::north_up(0.0, 0.0, 1.0, width, height), wave);
        let (reader, _, bytes) = written(&waves, CellFormat::Heights);
        let images = images(&bytes);
        assert_eq!(images.len(), 1 + reader.info().overviews.len());
        assert_eq!((images[0].0, images[0].1), (width, height));
        for (finer, (width, height, cells)) in images.iter().zip(&images[1..]) {
            assert_eq!(
                (*width, *height),
                (finer.0.div_ceil(2), finer.1.div_ceil(2))
            );
            for (i, cell) in cells.iter().enumerate() {
                let of_four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(right, down)| {
                    let (column, row) = (i % width * 2 + right, i / width * 2 + down);
                    if column < finer.0 && row < finer.1 {
                        finer.2[row * finer.0 + column]
                    } else {
                        -9999.0
                    }
                });
                let values: Vec<f64> = of_four
                    .into_iter()
                    .filter(|&v| v != -9999.0)
                    .map(f64::from)
                    .collect();
                let mean = if values.is_empty() {
                    -9999.0
                } else {
                    values.iter().sum::<f64>() / values.len() as f64
                };
                assert_eq!(*cell, mean as f32, "{width} x {height}: cell {i}");
            }
        }
        let (last_width, last_height, _) = &images[images.len() - 1];
        assert!(*last_width.max(last_height) <= 512);
    }
}

#[test]
fn overviews_of_shades_are_shades_and_holes_stay() {
    let (reader, ..) = written(&Hills::new(700, 1200), CellFormat::Heights);
    assert_eq!(reader.info().overviews, [[350, 600], [175, 300]]);
    assert_eq!(reader.info().warnings, [] as [&str; 0]);
    // No value in every third column: where a pair of columns has one, it counts alone.
    let (reader, _, bytes) = written(
        &Cells(Frame::north_up(0.0, 0.0, 1.0, 700, 100), shade),
        CellFormat::Shades,
    );
    assert_eq!(reader.info().overviews, [[350, 50]]);
    let mut decoder = tiff::decoder::Decoder::new(std::io::Cursor::new(bytes)).unwrap();
    decoder.next_image().unwrap();
    let tiff::decoder::DecodingResult::U8(shades) = decoder.read_image().unwrap() else {
        panic!("not bytes")
    };
    for (x, found) in shades[..350].iter().enumerate() {
        let [a, b] = [2 * x, 2 * x + 1]
            .map(|column| shade(column, 0))
            .map(|shade| if shade.is_nan() { 0.0 } else { shade });
        let mean = if a == 0.0 || b == 0.0 {
            a + b
        } else {
            (a + b) / 2.0
        };
        assert_eq!(f32::from(*found), mean.round(), "column {x}");
    }
}

#[test]
fn colors_are_those_of_heights_and_tiles_without_any_are_stored_if_holes_have_one() {
    let ramp = |missing| ColorRamp {
        stops: vec![
            ColorStop {
                at: StopAt::NoHeight,
                color: missing,
            },
            ColorStop {
                at: StopAt::Height(0.0),
                color: [10, 20, 30, 255],
            },
            ColorStop {
                at: StopAt::Height(254.0),
                color: [200, 0, 255, 0],
            },
        ],
    };
    for missing in [[0; 4], [0, 0, 7, 0]] {
        let colors = ramp(missing).over(None, ColorMatch::Linear);
        // The second of three tiles has no cell with a value.
        let height = |column: usize, row: usize| match column {
            256..512 => f32::NAN,
            _ => shade(column, row),
        };
        let source = Cells(Frame::north_up(0.0, 0.0, 1.0, 600, 3), height);
        let (reader, summary, bytes) = written(&source, CellFormat::Colors(&colors));
        assert_eq!(reader.info().bands, 4);
        assert_eq!(reader.info().overviews, [] as [[u64; 2]; 0]);
        assert_eq!(
            summary.valid,
            (0..600).filter(|&x| !height(x, 0).is_nan()).count() as u64 * 3
        );
        let mut decoder = tiff::decoder::Decoder::new(std::io::Cursor::new(&bytes)).unwrap();
        let lengths = decoder
            .get_tag_u64_vec(tiff::tags::Tag::TileByteCounts)
            .unwrap();
        assert_eq!(lengths[1] == 0, missing == [0; 4]);
        assert_eq!(decoder.colortype().unwrap(), tiff::ColorType::RGBA(8));
        for tile in [0, 2] {
            let decoded = decoder.read_chunk(tile).unwrap();
            let tiff::decoder::DecodingResult::U8(samples) = decoded else {
                panic!("not bytes")
            };
            let [width, first] = [if tile == 0 { 256 } else { 88 }, 256 * tile as usize];
            for (i, found) in samples.as_chunks::<4>().0.iter().enumerate() {
                let expected = colors.of(height(first + i % width, i / width));
                assert_eq!(*found, expected, "tile {tile}, cell {i}");
            }
        }
    }
}

#[test]
fn tiles_are_arranged_for_readers_in_the_cloud() {
    let (.., bytes) = written(&Hills::new(1301, 700), CellFormat::Heights);
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let half = |at: usize| u16::from_le_bytes(bytes[at..at + 2].try_into().unwrap()) as usize;
    assert!(bytes[8..].starts_with(b"GDAL_STRUCTURAL_METADATA_SIZE=000140 bytes\n"));
    // The directory comes right behind the 140 bytes of that text, at an even byte.
    assert_eq!(word(4), (8 + 43 + 140_usize).next_multiple_of(8));
    let mut directory = word(4);
    let mut tiles = Vec::new();
    let mut end_of_headers = 0;
    while directory != 0 {
        let count = half(directory);
        let entry = |tag| {
            (0..count)
                .map(|i| directory + 2 + 12 * i)
                .find(|&at| half(at) == tag)
                .unwrap()
        };
        let [starts, lengths] = [324, 325].map(entry);
        for i in 0..word(starts + 4) {
            tiles.push((
                word(word(starts + 8) + 4 * i),
                word(word(lengths + 8) + 4 * i),
            ));
        }
        end_of_headers = end_of_headers.max(word(lengths + 8) + 4 * word(lengths + 4));
        directory = word(directory + 2 + 12 * count);
    }
    // In the order of the file: the tiles of the smallest image first, each image's row by row.
    let of_images = [6 * 3, 3 * 2, 2];
    let (whole, overviews) = tiles.split_at(of_images[0]);
    let (half_size, quarter) = overviews.split_at(of_images[1]);
    let stored: Vec<_> = [quarter, half_size, whole]
        .concat()
        .into_iter()
        .filter(|&(_, length)| length > 0)
        .collect();
    assert_eq!(
        (tiles.len(), stored.len()),
        (of_images.iter().sum(), of_images.iter().sum::<usize>() - 1)
    );
    let mut at = stored[0].0 - 4;
    assert!(
        at >= end_of_headers,
        "all headers come before the first tile"
    );
    for (start, length) in stored {
        assert_eq!(
            (start, word(at)),
            (at + 4, length),
            "the length stands before each tile"
        );
        assert_eq!(
            bytes[start + length - 4..start + length],
            bytes[start + length..start + length + 4]
        );
        at = start + length + 4;
    }
    assert_eq!(at, bytes.len());
}

#[test]
fn bytes_do_not_depend_on_the_number_of_threads() {
    let threads = |count| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(count)
            .build()
            .unwrap();
        pool.install(|| written(&Hills::new(5000, 1100), CellFormat::Heights).2)
    };
    assert!(threads(1) == threads(2));
}

#[test]
fn shades_are_bytes_from_one() {
    let (reader, summary, _) = written(&RAMP, CellFormat::Shades);
    assert_eq!(reader.info().sample.to_string(), "uint8");
    assert_eq!((summary.min, summary.max), (1.0, 255.0));
    let grid = reader.read_grid().unwrap();
    assert_eq!(
        [0, 31, 300].map(|column| grid.value(column, 77)),
        [1.0, 11.0, 255.0]
    );
    assert!(grid.value(2, 0).is_nan());
}

#[test]
fn a_picture_is_gray_and_knows_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("relief.png");
    png::write_gray(&target, &RAMP).unwrap();
    let file = std::io::BufReader::new(std::fs::File::open(&target).unwrap());
    let mut reader = ::png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(
        (info.width, info.height, info.color_type),
        (400, 300, ::png::ColorType::GrayscaleAlpha)
    );
    for row in [0, 255, 256, 299] {
        for (column, gray) in [
            (0, [0, 255]),
            (21, [1, 255]),
            (2, [0, 0]),
            (399, [255, 255]),
        ] {
            assert_eq!(
                pixels[2 * (row * 400 + column)..][..2],
                gray,
                "column {column}, row {row}"
            );
        }
    }
    let world_file = std::fs::read_to_string(folder.path().join("relief.pgw")).unwrap();
    assert_eq!(world_file, "2\n0\n0\n-2\n101\n199\n");
}

#[test]
fn a_source_that_fails_leaves_no_file() {
    struct Failing;
    impl BlockSource for Failing {
        fn frame(&self) -> Frame {
            Frame::north_up(0.0, 0.0, 1.0, 1000, 1000)
        }
        fn crs(&self) -> Option<&Crs> {
            None
        }
        fn fill(&self, window: Window, _: &mut [f32]) -> Result<()> {
            if window.row > 500 {
                Err(Error::format("the source broke"))
            } else {
                Ok(())
            }
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("out.tif");
    let error = geotiff::write(&target, &Failing, WriteOptions::default()).unwrap_err();
    assert!(error.to_string().contains("the source broke"));
    let error = png::write_gray(&folder.path().join("out.png"), &Failing).unwrap_err();
    assert!(error.to_string().contains("the source broke"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
