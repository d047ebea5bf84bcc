//! Rasters: every real file against its facts, every broken one against its verdict, and what is
//! written against what is read.

use std::path::{Path, PathBuf};

use breakline::crs::Crs;
use breakline::data::{BlockSource, Frame, Window};
use breakline::error::{Error, Kind, Result};
use breakline::io::geotiff::{self, CellFormat, RasterSummary, WriteOptions};
use breakline::io::{png, raster};
use serde_json::Value;
use testkit::shared;

fn facts() -> Value {
    let text = std::fs::read_to_string(shared("FACTS.json")).expect("FACTS.json can be read");
    // A few numbers elsewhere in the file are NaN or Infinity, which JSON does not have.
    let text = text.replace(" NaN", " null").replace("-Infinity", "null").replace(" Infinity", " null");
    serde_json::from_str(&text).expect("FACTS.json is JSON")
}

fn number(value: &Value) -> f64 {
    match value.as_str() {
        Some(text) => text.parse().expect("a number"),
        None => value.as_f64().expect("a number"),
    }
}

/// TIFF files under `data/dem`, sorted, as paths relative to `data`.
fn tiffs(folder: &Path, prefix: &str) -> Vec<String> {
    let mut names = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder").flatten() {
        let name = format!("{prefix}/{}", entry.file_name().to_str().expect("a plain name"));
        if entry.path().is_dir() {
            names.extend(tiffs(&entry.path(), &name));
        } else if name.ends_with(".tif") || name.ends_with(".tiff") {
            names.push(name);
        }
    }
    names.sort();
    names
}

/// Files that are refused, and the words that say why.
const REFUSED: &[(&str, &str)] = &[
    ("dem/gdal/byte_LZMA.tif", "compression LZMA (34925)"),
    ("dem/gdal/byte_lerc.tif", "compression LERC (34887)"),
    ("dem/gdal/float24.tif", "24-bit samples (float24)"),
];

/// Files whose tiepoints lie on one affine transform: FACTS calls them control points.
const OF_TIEPOINTS: &[&str] = &[
    "dem/pointarea/austrian_capitals_model_tie_points_pixel_is_area.tif",
    "dem/pointarea/austrian_capitals_model_tie_points_pixel_is_point.tif",
];

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn real_files_are_what_the_facts_say() {
    let (facts, folder) = (facts(), shared("dem"));
    let mut read = 0;
    for name in tiffs(&folder, "dem") {
        if name.starts_with("dem/broken") {
            continue;
        }
        let path = shared(&name);
        if let Some((_, words)) = REFUSED.iter().find(|(refused, _)| *refused == name) {
            let error = geotiff::open(&path).expect_err(&name);
            assert_eq!(error.kind(), Kind::Unsupported, "{name}");
            assert!(error.to_string().contains(words), "{name}: {error}");
            assert!(error.cure_text().expect("a cure").plain().contains("gdal"), "{name}");
            continue;
        }
        check_facts(&name, &path, &facts[&name]);
        read += 1;
    }
    assert_eq!(read, 83);
    let name = "lidar/bcts/bcts_dsm_5m.tif";
    check_facts(name, &shared(name), &facts[name]);
}

fn check_facts(name: &str, path: &Path, facts: &Value) {
    let reader = raster::open(path).unwrap_or_else(|e| panic!("{name}: {e}"));
    let info = reader.info();
    assert_eq!(info.width as u64, facts["size"][0].as_u64().unwrap(), "{name}");
    assert_eq!(info.height as u64, facts["size"][1].as_u64().unwrap(), "{name}");
    assert_eq!(u64::from(info.bands), facts["bands"].as_u64().unwrap(), "{name}");
    assert_eq!(info.is_big_tiff, facts["bigtiff"].as_bool().unwrap(), "{name}");
    assert_eq!(info.byte_order == geotiff::ByteOrder::Big, facts["byte_order"] == "MM", "{name}");
    assert_eq!(info.is_tiled, facts["tiled"].as_bool().unwrap(), "{name}");
    // GDAL cuts a raster that is one uncompressed strip into rows of its own choice.
    if info.is_tiled || info.block[1] < info.height {
        assert_eq!(info.block[1] as u64, facts["block"][0].as_u64().unwrap(), "{name}");
    }
    assert_eq!(info.block[0] as u64, facts["block"][1].as_u64().unwrap(), "{name}");
    let compression = facts["compress"].as_str().unwrap_or("none");
    assert_eq!(info.compression.to_lowercase(), compression, "{name}");
    // GDAL has no half precision and reads it as float32.
    let sample = if name.ends_with("float16.tif") { "float32".into() } else { info.sample.to_string() };
    let sample = if info.sample.bits < 8 { "uint8".into() } else { sample };
    assert_eq!(sample, facts["dtype"].as_str().unwrap(), "{name}");
    assert_eq!(info.scale, facts["scale"].as_f64().unwrap(), "{name}");
    assert_eq!(info.offset, facts["offset"].as_f64().unwrap(), "{name}");
    assert_eq!(info.is_point, facts["area_or_point"] == "Point", "{name}");
    let factors: Vec<u64> = facts["overviews"].as_array().unwrap().iter().map(|f| f.as_u64().unwrap()).collect();
    let found: Vec<u64> = info.overviews.iter().map(|o| (info.width as f64 / o[0] as f64).round() as u64).collect();
    assert_eq!(found, factors, "{name}");

    // FACTS has a number where one EPSG code says it all, else WKT, and nothing for control points.
    let crs = &facts["crs"];
    if let Some(code) = crs.as_u64() {
        assert_eq!(info.crs.as_ref().and_then(|crs| crs.epsg).map(u64::from), Some(code), "{name}");
    } else if let Some(wkt) = crs.as_str().filter(|wkt| !wkt.starts_with("LOCAL_CS[\"unnamed\"")) {
        assert!(info.crs.is_some(), "{name}: {wkt}");
    } else if facts["gcps"].is_null() {
        assert_eq!(info.crs, None, "{name}");
    }

    let nodata = &facts["nodata"];
    match info.nodata {
        None => assert!(nodata.is_null(), "{name}"),
        Some(found) => {
            let wanted = number(nodata);
            assert!(found == wanted || found as f32 == wanted as f32 || found.is_nan() && wanted.is_nan(), "{name}");
        }
    }

    let transform = reader.frame().transform;
    if !OF_TIEPOINTS.contains(&name) {
        for (found, wanted) in transform.iter().zip(facts["geotransform"].as_array().unwrap()) {
            let wanted = wanted.as_f64().unwrap();
            assert!((found - wanted).abs() <= 1e-12 * wanted.abs(), "{name}: {found} is not {wanted}");
        }
    }

    let all = Window { column: 0, row: 0, width: info.width, height: info.height };
    let stored = reader.read_stored(all).unwrap_or_else(|e| panic!("{name}: {e}"));
    let values: Vec<f64> = stored.into_iter().filter(|v| !v.is_nan()).collect();
    // FACTS counts a NaN that is not the nodata value as valid.
    let valid = facts["valid"].as_u64().unwrap() - facts["nan"].as_u64().unwrap_or(0);
    assert_eq!(values.len() as u64, valid, "{name}");
    let extremes = reader.extremes().unwrap();
    assert_eq!(extremes.valid, valid, "{name}");
    let Some([min, max]) = extremes.stored_range else {
        assert!(facts["min"].is_null(), "{name}");
        return;
    };
    // serde_json reads decimal text to within one unit in the last place.
    for (found, wanted) in [(min, number(&facts["min"])), (max, number(&facts["max"]))] {
        assert!((found - wanted).abs() <= f64::EPSILON * wanted.abs(), "{name}: {found} is not {wanted}");
    }
    let wanted = number(&facts["sum"]);
    let sum: f64 = values.iter().sum();
    assert!((sum - wanted).abs() <= 1e-9 * wanted.abs(), "{name}: sum {sum} is not {wanted}");
    let scaled = extremes.range.unwrap();
    assert_eq!(scaled, [min * info.scale + info.offset, max * info.scale + info.offset], "{name}");
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_raster_is_in_the_same_place_however_its_georeferencing_is_written() {
    let encoding = |kind: &str, cells: &str| {
        let path = shared(&format!("dem/pointarea/austrian_capitals_{kind}_pixel_is_{cells}.tif"));
        let reader = geotiff::open(path).unwrap();
        assert_eq!(reader.info().is_point, cells == "point");
        reader.read_grid().unwrap()
    };
    for cells in ["area", "point"] {
        let first = encoding("model_tie_point_and_pixel_scale", cells);
        for kind in ["model_tie_points", "model_transformation"] {
            let other = encoding(kind, cells);
            for (a, b) in first.frame.transform.iter().zip(other.frame.transform) {
                assert!((a - b).abs() < 1e-6, "{kind} {cells}: {a} is not {b}");
            }
            assert!(first.values.iter().map(|v| v.to_bits()).eq(other.values.iter().map(|v| v.to_bits())), "{kind}");
        }
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_window_is_the_same_part_of_the_whole() {
    let folder = shared("dem");
    for name in
        ["gdal/byte_LZW_tiled.tif", "gdal/utm.tif", "bigtujunga.tif", "gdal/separate_tiled.tif", "dem-hills.tiff"]
    {
        let reader = geotiff::open(folder.join(name)).unwrap();
        let grid = reader.read_grid().unwrap();
        let (width, height) = (grid.frame.width, grid.frame.height);
        let windows =
            [(0, 0, 1, 1), (width / 3, height / 4, width / 2, height / 3), (width - 1, 0, 1, height), (3, 5, 14, 15)];
        for (column, row, w, h) in windows {
            let part = reader.read_window(Window { column, row, width: w, height: h }).unwrap();
            for (i, value) in part.iter().enumerate() {
                let whole = grid.value(column + i % w, row + i / w);
                assert!(*value == whole || value.is_nan() && whole.is_nan(), "{name}");
            }
        }
        let outside = Window { column: 1, row: 0, width, height };
        assert_eq!(reader.read_window(outside).unwrap_err().kind(), Kind::Usage);
    }
}

enum Verdict {
    /// Opens and reads; this many cells have a value, and this is their sum.
    Full(usize, f64),
    /// Opens and reads with a warning that has these words; this many cells have a value.
    Partial(usize, &'static str),
    /// An error that has all these words.
    Refused(&'static [&'static str]),
}

use Verdict::{Full, Partial, Refused};

/// What becomes of every broken file.
const BROKEN: &[(&str, Verdict)] = &[
    ("bigtiff_header_extract.tif", Refused(&["StripOffsets (273)", "100000 values", "not in the file"])),
    ("byte_truncated.tif", Refused(&["block 0", "200 bytes at byte 374", "ends at byte 374"])),
    ("byte_zstd_corrupted.tif", Refused(&["block 0", "damaged data (compression ZSTD)"])),
    ("corrupted_deflate_singlestrip.tif", Refused(&["block 0", "damaged data (compression DEFLATE)"])),
    ("huge-implied-number-strips.tif", Full(400, 50.0)),
    ("hugeblocksize.tif", Refused(&["2147483648 x 16", "limit", "one block"])),
    ("image_width_above_32bit.tif", Refused(&["2147483648 x 1", "limit", "one block"])),
    ("lzw_corrupted.tif", Refused(&["block 0", "damaged data (compression LZW)"])),
    ("many_blocks_truncated.tif", Refused(&["StripOffsets (273)", "16777215 values", "not in the file"])),
    ("minimum_tiff_tags_with_warning.tif", Partial(1, "1 of 1 blocks are not in the file: their cells are 0")),
    ("missing_tilebytecounts_and_offsets.tif", Refused(&["TileOffsets (324)", "not in the file"])),
    ("mut_cut_half.tif", Refused(&["byte 1608", "directory is cut short", "ends at byte 968"])),
    ("mut_ifd_loop.tif", Full(400, 50706.0)),
    ("mut_ifd_past_eof.tif", Refused(&["directory is cut short", "ends at byte 1936"])),
    ("mut_width_huge.tif", Refused(&["1600 bytes, where", "are needed"])),
    ("one_strip_nobytecount.tif", Full(2001, 1.0)),
];

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_broken_file_gets_its_verdict() {
    let folder = shared("dem/broken");
    let mut names: Vec<PathBuf> = std::fs::read_dir(&folder).unwrap().flatten().map(|e| e.path()).collect();
    names.sort();
    assert_eq!(names.len(), BROKEN.len());
    for (path, (name, verdict)) in names.iter().zip(BROKEN) {
        assert!(path.ends_with(name), "{path:?} has no verdict");
        let start = std::time::Instant::now();
        let outcome = geotiff::open(path).and_then(|reader| Ok((reader.read_grid()?, reader.info().warnings.clone())));
        assert!(start.elapsed().as_secs() < 5, "{name}");
        let valid = |values: &[f64]| values.iter().filter(|v| !v.is_nan()).count();
        match (verdict, outcome) {
            (Full(cells, sum), Ok((grid, _))) => {
                assert_eq!(valid(&grid.values), *cells, "{name}");
                assert_eq!(grid.values.iter().sum::<f64>(), *sum, "{name}");
            }
            (Partial(cells, words), Ok((grid, warnings))) => {
                assert_eq!(valid(&grid.values), *cells, "{name}");
                assert!(warnings.iter().any(|w| w.plain().contains(words)), "{name}: {warnings:?}");
            }
            (Refused(words), Err(error)) => {
                let text = error.to_string();
                assert!(text.contains(name), "{text}");
                for word in *words {
                    assert!(text.contains(word), "{name}: {word:?} is not in {text:?}");
                }
            }
            (_, outcome) => panic!("{name}: {:?}", outcome.map(|(grid, _)| valid(&grid.values))),
        }
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn other_formats_are_named() {
    let error = raster::open(shared("dem/gdal/n43.dt0")).unwrap_err();
    assert_eq!(error.kind(), Kind::Unsupported);
    assert!(error.to_string().contains("DTED") && error.cure_text().unwrap().plain().contains("`gdal`"), "{error}");
}

/// Heights with holes: some cells, and one tile of the larger sizes.
struct Hills {
    frame: Frame,
    is_empty: bool,
}

impl BlockSource for Hills {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        None
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        for (i, cell) in out.iter_mut().enumerate() {
            *cell = self.height(window.column + i % window.width, window.row + i / window.width);
        }
        Ok(())
    }
}

impl Hills {
    fn new(width: usize, height: usize) -> Self {
        let transform = [500_000.25, 0.5, 0.0, 4_000_000.125, 0.0, -0.5];
        Hills { frame: Frame { width, height, transform }, is_empty: false }
    }

    fn height(&self, column: usize, row: usize) -> f32 {
        let in_hole = (256..512).contains(&row) && column < 256;
        match (column * 31 + row * 17) % 53 {
            _ if self.is_empty || in_hole => f32::NAN,
            0 if column + row > 0 => f32::NAN,
            1 => f32::INFINITY,
            noise => 300.0 + (column as f32 * 0.05).sin() * 40.0 + row as f32 * 0.1 + noise as f32 * 0.01,
        }
    }
}

fn written(source: &dyn BlockSource, cells: CellFormat) -> (geotiff::GeoTiffReader, RasterSummary, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("out.tif");
    let summary = geotiff::write(&target, source, WriteOptions { cells, ..WriteOptions::default() }).unwrap();
    let bytes = std::fs::read(&target).unwrap();
    let reader = geotiff::open(&target).unwrap();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left beside the file");
    (reader, summary, bytes)
}

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
                    assert_eq!(found, f64::from(wanted), "{width} x {height}: column {column}, row {row}");
                    valid += 1;
                } else {
                    assert!(found.is_nan(), "{width} x {height}: column {column}, row {row}");
                }
            }
        }
        assert_eq!(summary.valid, valid);
        assert_eq!(reader.extremes().unwrap().range, Some([summary.min, summary.max]));
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
    assert!(reader.read_grid().unwrap().values.iter().all(|v| v.is_nan()));
    assert_eq!(reader.info().warnings, [] as [&str; 0]);
}

#[test]
fn rotated_and_south_up_frames_come_back() {
    for transform in [[1841001.75, 1.5, -5.0, 1144003.25, -5.0, -1.5], [10.0, 0.5, 0.0, 20.0, 0.0, 0.5]] {
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
        let tiff::decoder::DecodingResult::F32(cells) = decoder.read_image().unwrap() else { panic!("not f32") };
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
            *cell = self.1(window.column + i % window.width, window.row + i / window.width);
        }
        Ok(())
    }
}

/// Heights with gaps, but none as large as a tile: the `tiff` crate does not read sparse files.
fn wave(column: usize, row: usize) -> f32 {
    let noise = (column * 31 + row * 17) % 53;
    if noise == 0 { f32::NAN } else { (column as f32 * 0.05).sin() * 40.0 + row as f32 + noise as f32 }
}

/// Shades from 1 to 200 by columns, none in every third.
fn shade(column: usize, _: usize) -> f32 {
    if column % 3 == 2 { f32::NAN } else { (column % 200 + 1) as f32 }
}

/// A ramp over and beyond the range of a byte, without a value in every third column.
const RAMP: Cells =
    Cells(Frame { width: 400, height: 300, transform: [100.0, 2.0, 0.0, 200.0, 0.0, -2.0] }, |column, _| {
        if column % 3 == 2 { f32::NAN } else { column as f32 - 20.0 }
    });

#[test]
fn an_overview_has_the_means_of_four_cells_each() {
    for (width, height) in [(512, 512), (513, 2), (1, 1025), (1301, 700)] {
        let waves = Cells(Frame::north_up(0.0, 0.0, 1.0, width, height), wave);
        let (reader, _, bytes) = written(&waves, CellFormat::Heights);
        let images = images(&bytes);
        assert_eq!(images.len(), 1 + reader.info().overviews.len());
        assert_eq!((images[0].0, images[0].1), (width, height));
        for (finer, (width, height, cells)) in images.iter().zip(&images[1..]) {
            assert_eq!((*width, *height), (finer.0.div_ceil(2), finer.1.div_ceil(2)));
            for (i, cell) in cells.iter().enumerate() {
                let of_four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(right, down)| {
                    let (column, row) = (i % width * 2 + right, i / width * 2 + down);
                    if column < finer.0 && row < finer.1 { finer.2[row * finer.0 + column] } else { -9999.0 }
                });
                let values: Vec<f64> = of_four.into_iter().filter(|&v| v != -9999.0).map(f64::from).collect();
                let mean = if values.is_empty() { -9999.0 } else { values.iter().sum::<f64>() / values.len() as f64 };
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
    let (reader, _, bytes) = written(&Cells(Frame::north_up(0.0, 0.0, 1.0, 700, 100), shade), CellFormat::Shades);
    assert_eq!(reader.info().overviews, [[350, 50]]);
    let mut decoder = tiff::decoder::Decoder::new(std::io::Cursor::new(bytes)).unwrap();
    decoder.next_image().unwrap();
    let tiff::decoder::DecodingResult::U8(shades) = decoder.read_image().unwrap() else { panic!("not bytes") };
    for (x, found) in shades[..350].iter().enumerate() {
        let [a, b] =
            [2 * x, 2 * x + 1].map(|column| shade(column, 0)).map(|shade| if shade.is_nan() { 0.0 } else { shade });
        let mean = if a == 0.0 || b == 0.0 { a + b } else { (a + b) / 2.0 };
        assert_eq!(f32::from(*found), mean.round(), "column {x}");
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
        let entry = |tag| (0..count).map(|i| directory + 2 + 12 * i).find(|&at| half(at) == tag).unwrap();
        let [starts, lengths] = [324, 325].map(entry);
        for i in 0..word(starts + 4) {
            tiles.push((word(word(starts + 8) + 4 * i), word(word(lengths + 8) + 4 * i)));
        }
        end_of_headers = end_of_headers.max(word(lengths + 8) + 4 * word(lengths + 4));
        directory = word(directory + 2 + 12 * count);
    }
    // In the order of the file: the tiles of the smallest image first, each image's row by row.
    let of_images = [6 * 3, 3 * 2, 2];
    let (whole, overviews) = tiles.split_at(of_images[0]);
    let (half_size, quarter) = overviews.split_at(of_images[1]);
    let stored: Vec<_> = [quarter, half_size, whole].concat().into_iter().filter(|&(_, length)| length > 0).collect();
    assert_eq!((tiles.len(), stored.len()), (of_images.iter().sum(), of_images.iter().sum::<usize>() - 1));
    let mut at = stored[0].0 - 4;
    assert!(at >= end_of_headers, "all headers come before the first tile");
    for (start, length) in stored {
        assert_eq!((start, word(at)), (at + 4, length), "the length stands before each tile");
        assert_eq!(bytes[start + length - 4..start + length], bytes[start + length..start + length + 4]);
        at = start + length + 4;
    }
    assert_eq!(at, bytes.len());
}

#[test]
fn bytes_do_not_depend_on_the_number_of_threads() {
    let threads = |count| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
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
    assert_eq!([0, 31, 300].map(|column| grid.value(column, 77)), [1.0, 11.0, 255.0]);
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
    assert_eq!((info.width, info.height, info.color_type), (400, 300, ::png::ColorType::GrayscaleAlpha));
    for row in [0, 255, 256, 299] {
        for (column, gray) in [(0, [0, 255]), (21, [1, 255]), (2, [0, 0]), (399, [255, 255])] {
            assert_eq!(pixels[2 * (row * 400 + column)..][..2], gray, "column {column}, row {row}");
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
            if window.row > 500 { Err(Error::format("the source broke")) } else { Ok(()) }
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

#[test]
fn a_damaged_byte_anywhere_ends_in_values_or_an_error() {
    let (_, _, whole) = written(&Hills::new(40, 9), CellFormat::Heights);
    damage_each_byte(&[whole]);
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_damaged_byte_in_files_of_others_does_too() {
    let names =
        ["byte_LZW_tiled", "byte_ZSTD_tiled", "byte_bigtiff_strip5lines", "sparse_tiled_contig", "int16_big_endian"];
    damage_each_byte(&names.map(|name| std::fs::read(shared(&format!("dem/gdal/{name}.tif"))).unwrap()));
}

fn damage_each_byte(files: &[Vec<u8>]) {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("damaged.tif");
    let (mut opened, mut read, mut refused) = (0, 0, 0);
    for file in files {
        // Beyond the header, one of 29 bytes is enough.
        let damaged = (0..file.len()).filter(|&at| at < 600 || at % 29 == 0);
        for (at, damage) in damaged.flat_map(|at| [0x01, 0x80, 0xff].map(|damage| (at, damage))) {
            let mut file = file.clone();
            file[at] ^= damage;
            std::fs::write(&target, &file).unwrap();
            let Ok(reader) = geotiff::open(&target) else {
                refused += 1;
                continue;
            };
            opened += 1;
            let info = reader.info();
            let part = Window { column: 0, row: 0, width: info.width.min(100), height: info.height.min(100) };
            read += usize::from(reader.read_window(part).is_ok());
        }
    }
    assert!(refused > 200 && opened > 500 && read > 500, "{refused} {opened} {read}");
}
