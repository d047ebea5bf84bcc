//! Broken files against their verdicts, and damage of each byte.

use std::path::PathBuf;

use super::{Hills, written};
use breakline::data::Window;
use breakline::error::Kind;
use breakline::io::geotiff::{self, CellFormat};
use breakline::io::raster;
use testkit::shared;

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
    (
        "bigtiff_header_extract.tif",
        Refused(&["StripOffsets (273)", "100000 values", "not in the file"]),
    ),
    (
        "byte_truncated.tif",
        Refused(&["block 0", "200 bytes at byte 374", "ends at byte 374"]),
    ),
    (
        "byte_zstd_corrupted.tif",
        Refused(&["block 0", "damaged data (compression ZSTD)"]),
    ),
    (
        "corrupted_deflate_singlestrip.tif",
        Refused(&["block 0", "damaged data (compression DEFLATE)"]),
    ),
    ("huge-implied-number-strips.tif", Full(400, 50.0)),
    (
        "hugeblocksize.tif",
        Refused(&["2147483648 x 16", "limit", "one block"]),
    ),
    (
        "image_width_above_32bit.tif",
        Refused(&["2147483648 x 1", "limit", "one block"]),
    ),
    (
        "lzw_corrupted.tif",
        Refused(&["block 0", "damaged data (compression LZW)"]),
    ),
    (
        "many_blocks_truncated.tif",
        Refused(&["StripOffsets (273)", "16777215 values", "not in the file"]),
    ),
    (
        "minimum_tiff_tags_with_warning.tif",
        Partial(1, "1 of 1 blocks are not in the file: their cells are 0"),
    ),
    (
        "missing_tilebytecounts_and_offsets.tif",
        Refused(&["TileOffsets (324)", "not in the file"]),
    ),
    (
        "mut_cut_half.tif",
        Refused(&["byte 1608", "directory is cut short", "ends at byte 968"]),
    ),
    ("mut_ifd_loop.tif", Full(400, 50706.0)),
    (
        "mut_ifd_past_eof.tif",
        Refused(&["directory is cut short", "ends at byte 1936"]),
    ),
    (
        "mut_width_huge.tif",
        Refused(&["1600 bytes, where", "are needed"]),
    ),
    ("one_strip_nobytecount.tif", Full(2001, 1.0)),
];

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_broken_file_gets_its_verdict() {
    let folder = shared("dem/broken");
    let mut names: Vec<PathBuf> = std::fs::read_dir(&folder)
        .unwrap()
        .flatten()
        .map(|e| e.path())
        .collect();
    names.sort();
    assert_eq!(names.len(), BROKEN.len());
    for (path, (name, verdict)) in names.iter().zip(BROKEN) {
        assert!(path.ends_with(name), "{path:?} has no verdict");
        let start = std::time::Instant::now();
        let outcome = geotiff::open(path)
            .and_then(|reader| Ok((reader.read_grid()?, reader.info().warnings.clone())));
        assert!(start.elapsed().as_secs() < 5, "{name}");
        let valid = |values: &[f64]| values.iter().filter(|v| !v.is_nan()).count();
        match (verdict, outcome) {
            (Full(cells, sum), Ok((grid, _))) => {
                assert_eq!(valid(&grid.values), *cells, "{name}");
                assert_eq!(grid.values.iter().sum::<f64>(), *sum, "{name}");
            }
            (Partial(cells, words), Ok((grid, warnings))) => {
                assert_eq!(valid(&grid.values), *cells, "{name}");
                assert!(
                    warnings.iter().any(|w| w.plain().contains(words)),
                    "{name}: {warnings:?}"
                );
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
    assert!(
        error.to_string().contains("DTED") && error.cure_text().unwrap().plain().contains("`gdal`"),
        "{error}"
    );
}

#[test]
fn a_damaged_byte_anywhere_ends_in_values_or_an_error() {
    let (_, _, whole) = written(&Hills::new(40, 9), CellFormat::Heights);
    damage_each_byte(&[whole]);
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn a_damaged_byte_in_files_of_others_does_too() {
    let names = [
        "byte_LZW_tiled",
        "byte_ZSTD_tiled",
        "byte_bigtiff_strip5lines",
        "sparse_tiled_contig",
        "int16_big_endian",
    ];
    damage_each_byte(
        &names.map(|name| std::fs::read(shared(&format!("dem/gdal/{name}.tif"))).unwrap()),
    );
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
            let part = Window {
                column: 0,
                row: 0,
                width: info.width.min(100),
                height: info.height.min(100),
            };
            read += usize::from(reader.read_window(part).is_ok());
        }
    }
    assert!(
        refused > 200 && opened > 500 && read > 500,
        "{refused} {opened} {read}"
    );
}
