//! Damaged files, and those whose parts contradict each other.

use std::path::Path;
use std::time::{Duration, Instant};

use super::read;
use breakline::data::{Layer, Shape};
use breakline::error::Result;
use breakline::io::{OnDamage, layer, shapefile};

/// What is whole of a damaged file.
fn read_what_is_there(path: &Path) -> Result<Layer> {
    layer::read_with(
        path,
        &layer::Options {
            cut: OnDamage::Accept,
            ..layer::Options::default()
        },
        &|_| Ok(()),
    )
}

/// What a damaged file gives.
#[derive(Debug)]
enum Outcome {
    /// Everything; it is only odd. Shapes, vertices, and what the warnings say, if anything.
    Full(usize, usize, &'static [&'static str]),
    /// An error, unless what is whole is asked for. Shapes, vertices, and what the warnings say.
    Partial(usize, usize, &'static [&'static str]),
    /// Nothing; what the message says.
    Refused(&'static [&'static str]),
}

use Outcome::{Full, Partial, Refused};

/// Every file of the folders `broken` and `broken_mut`.
const DAMAGED: &[(&str, Outcome)] = &[
    // Its extent is large, nothing more.
    ("broken/bigoffset.shp", Full(1, 10, &[])),
    // Three parts and five points are announced, two and four are there; there is no other record.
    (
        "broken/buggymultiline.shp",
        Refused(&[
            "no record can be read",
            "record 1 (byte 100)",
            "5 points take 80 bytes",
            "60 left",
        ]),
    ),
    (
        "broken/buggymultipoint.shp",
        Refused(&[
            "no record can be read",
            "record 1 (byte 100)",
            "3 points take 48 bytes",
            "32 left",
        ]),
    ),
    // Some bytes behind the last record, and behind the last row.
    (
        "broken/corrupt_too_long.shp",
        Full(
            10,
            30,
            &["record 11 (byte 1140): 5 bytes, too few for a record"],
        ),
    ),
    ("broken/empty.shp", Full(0, 0, &[])),
    (
        "broken/emptymultiline.shp",
        Full(1, 0, &["4 points belong to no part"]),
    ),
    ("broken/extentnan.shp", Full(0, 0, &[])),
    (
        "broken/mixed_shape_type_non_conformant.shp",
        Full(
            6,
            21,
            &[
                "the header states PolyLine, the records are 1 Point, 2 PolyLine, 2 Polygon, 1 MultiPoint",
            ],
        ),
    ),
    // Two outer rings that are one another's neighbors; nobody asks here which is inside which.
    (
        "broken/multipolygon_as_invalid_polygon.shp",
        Full(2, 16, &[]),
    ),
    (
        "broken_mut/brklinz__filelen_wrong.shp",
        Full(
            122,
            1736,
            &["its header states 101096 bytes, the file has 50548"],
        ),
    ),
    (
        "broken_mut/brklinz__inf_x.shp",
        Refused(&["record 1 (byte 100): x of vertex 2 is inf"]),
    ),
    (
        "broken_mut/brklinz__nan_z.shp",
        Full(122, 1736, &["1 points have no height"]),
    ),
    ("broken_mut/brklinz__no_dbf.shp", Full(122, 1736, &[])),
    ("broken_mut/brklinz__no_shx.shp", Full(122, 1736, &[])),
    (
        "broken_mut/brklinz__nodata_z.shp",
        Full(122, 1736, &["1 points have no height"]),
    ),
    (
        "broken_mut/brklinz__null_record_with_body.shp",
        Full(122, 1644, &["1 records are of the type null, but"]),
    ),
    (
        "broken_mut/brklinz__numpoints_huge.shp",
        Partial(121, 1644, &["record 1 (byte 100): 1000092 points"]),
    ),
    (
        "broken_mut/brklinz__part_index_out_of_range.shp",
        Partial(
            121,
            1644,
            &["record 1 (byte 100): part 1 holds points 97 to 92"],
        ),
    ),
    (
        "broken_mut/brklinz__shp_truncated.shp",
        Partial(
            69,
            1179,
            &[
                "its header states 50548 bytes, the file has 33698",
                "record 70 (byte 33364): content of 784 bytes extends beyond the end of the file",
                ".dbf: 122 rows for 69 records",
            ],
        ),
    ),
    (
        "broken_mut/brklinz__shx_truncated.shp",
        Full(
            122,
            1736,
            &[".shx not used: its header states 1076 bytes, the file has 588"],
        ),
    ),
];

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_damaged_shapefile_is_in_the_table() {
    let folder = testkit::shared("shp");
    let mut there = Vec::new();
    for sub in ["broken", "broken_mut"] {
        for entry in std::fs::read_dir(folder.join(sub)).unwrap() {
            let name = format!(
                "{sub}/{}",
                entry.unwrap().file_name().into_string().unwrap()
            );
            there.extend(name.ends_with(".shp").then_some(name));
        }
    }
    there.sort();
    assert_eq!(there, DAMAGED.iter().map(|row| row.0).collect::<Vec<_>>());

    for (name, outcome) in DAMAGED {
        let start = Instant::now();
        let result = read(&folder.join(name));
        assert!(
            start.elapsed() < Duration::from_secs(5),
            "{name} took {:?}",
            start.elapsed()
        );
        let result = match outcome {
            Partial(_, _, words) => {
                let error = result.expect_err(name);
                assert!(
                    words.iter().any(|word| error.to_string().contains(word)),
                    "{name}: {error}"
                );
                assert!(
                    error
                        .cure_text()
                        .is_some_and(|cure| cure.plain().contains("partial")),
                    "{name}"
                );
                read_what_is_there(&folder.join(name))
            }
            Full(..) | Refused(_) => result,
        };
        match (outcome, result) {
            (Full(shapes, vertices, words) | Partial(shapes, vertices, words), Ok(layer)) => {
                assert_eq!(layer.shapes.len(), *shapes, "{name}");
                assert_eq!(
                    layer.shapes.iter().flat_map(Shape::vertices).count(),
                    *vertices,
                    "{name}"
                );
                assert_eq!(
                    layer.warnings.len(),
                    words.len(),
                    "{name}: {:?}",
                    layer.warnings
                );
                for (warning, word) in layer.warnings.iter().zip(*words) {
                    assert!(
                        warning.plain().contains(word),
                        "{name}: {warning:?} without {word:?}"
                    );
                }
            }
            (Refused(words), Err(error)) => {
                let text = error.to_string();
                assert!(
                    error.path().is_some() && error.cure_text().is_some(),
                    "{name}: {error:?}"
                );
                words.iter().for_each(|word| {
                    assert!(text.contains(word), "{name}: {text:?} without {word:?}")
                });
            }
            (expected, found) => panic!("{name}: {expected:?} expected, found {found:?}"),
        }
    }
}

/// Three lines, at heights 10, 20 and 30 by their field, as a set of files.
fn three_lines(folder: &Path) -> std::path::PathBuf {
    let line = |x: f64, vertices: usize| {
        Shape::Lines(vec![(0..vertices).map(|i| [x, i as f64, 0.0]).collect()])
    };
    let layer = Layer {
        shapes: vec![line(1.0, 2), line(2.0, 3), line(3.0, 2)],
        ..Layer::default()
    };
    let path = folder.join("three.shp");
    let values = [10.0, 20.0, 30.0];
    shapefile::write_layer(
        &path,
        &layer,
        &[shapefile::Column {
            name: "H",
            values: &values,
        }],
    )
    .unwrap();
    path
}

/// Where the second of them begins, and its length with its header.
const SECOND: (usize, usize) = (100 + 8 + 64 + 2 * 24, 8 + 64 + 3 * 24);

/// x and height of each shape's first vertex.
fn x_and_height(layer: &Layer) -> Vec<(f64, f64)> {
    layer
        .shapes
        .iter()
        .filter_map(|s| s.vertices().next().map(|v| (v[0], v[2])))
        .collect()
}

/// Anew, as some file systems wait for the disk when a file is written over.
fn replace(path: &Path, bytes: &[u8]) {
    std::fs::remove_file(path).unwrap();
    std::fs::write(path, bytes).unwrap();
}

fn change(path: &Path, change: impl FnOnce(&mut Vec<u8>)) {
    let mut bytes = std::fs::read(path).unwrap();
    change(&mut bytes);
    replace(path, &bytes);
}

#[test]
fn an_index_in_another_order_decides_the_rows() {
    let folder = tempfile::tempdir().unwrap();
    let path = three_lines(folder.path());
    assert_eq!(
        x_and_height(&shapefile::read_layer(&path, Some("h")).unwrap()),
        [(1., 10.), (2., 20.), (3., 30.)]
    );
    change(&path.with_extension("shx"), |bytes| {
        let (a, b) = bytes[100..].split_at_mut(8);
        a.swap_with_slice(&mut b[..8]);
    });
    let layer = shapefile::read_layer(&path, Some("h")).unwrap();
    assert_eq!(x_and_height(&layer), [(1., 20.), (2., 10.), (3., 30.)]);
    assert_eq!(layer.warnings, [] as [&str; 0]);
    // One that points nowhere decides nothing.
    change(&path.with_extension("shx"), |bytes| bytes[103] += 1);
    let layer = shapefile::read_layer(&path, Some("h")).unwrap();
    assert_eq!(x_and_height(&layer), [(1., 10.), (2., 20.), (3., 30.)]);
    assert!(
        layer.warnings[0]
            .plain()
            .starts_with(".shx not used: entry 1 points to byte"),
        "{:?}",
        layer.warnings
    );
}

#[test]
fn columns_follow_their_records() {
    let folder = tempfile::tempdir().unwrap();
    let path = three_lines(folder.path());
    let read = |columns: &[&str]| {
        let options = layer::Options {
            columns,
            ..layer::Options::default()
        };
        shapefile::read_layer_with(&path, &options, &|_| Ok(()))
    };
    assert_eq!(
        read(&["h"]).unwrap().column("H").unwrap().values,
        [10., 20., 30.]
    );
    change(&path.with_extension("shx"), |bytes| {
        let (a, b) = bytes[100..].split_at_mut(8);
        a.swap_with_slice(&mut b[..8]);
    });
    let layer = read(&["h", "H"]).unwrap();
    assert_eq!(layer.columns[0].values, [20., 10., 30.]);
    assert_eq!(
        (layer.columns.len(), layer.columns[1].name.as_str()),
        (2, "H")
    );
    assert_eq!(
        x_and_height(&layer),
        [(1., 0.), (2., 0.), (3., 0.)],
        "heights are those of the geometry"
    );

    let error = read(&["H", "WIDTH"]).unwrap_err().to_string();
    assert!(
        error.ends_with("three.dbf: there is no field WIDTH"),
        "{error}"
    );
    change(&path.with_extension("dbf"), |bytes| {
        let at = bytes.windows(2).rposition(|text| text == b"20").unwrap();
        bytes[at..at + 2].copy_from_slice(b"no");
    });
    let error = read(&["H"]).unwrap_err().to_string();
    assert!(
        error.contains("three.shp: record 1: field H: expected a number, found 'no"),
        "{error}"
    );
    std::fs::remove_file(path.with_extension("dbf")).unwrap();
    let error = read(&["H"]).unwrap_err().to_string();
    assert!(
        error.contains("no .dbf next to it with the field H"),
        "{error}"
    );
}

#[test]
fn older_copies_of_records_are_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let path = three_lines(folder.path());
    // As an editor does it that has no room: the second record again, behind the last.
    let (second, length) = SECOND;
    let mut behind = 0;
    change(&path, |bytes| {
        let copy = bytes[second..second + length].to_vec();
        behind = bytes.len();
        bytes.extend(copy);
        // Its x, to tell them apart.
        bytes[behind + 56..behind + 64].copy_from_slice(&7f64.to_le_bytes());
    });
    change(&path.with_extension("shx"), |bytes| {
        bytes[108..112].copy_from_slice(&(behind as u32 / 2).to_be_bytes());
    });
    let layer = shapefile::read_layer(&path, Some("H")).unwrap();
    assert_eq!(x_and_height(&layer), [(1., 10.), (3., 30.), (7., 20.)]);
    assert!(
        layer
            .warnings
            .iter()
            .any(|w| w.plain().starts_with("1 records are older copies")),
        "{:?}",
        layer.warnings
    );
}

#[test]
fn reading_goes_on_at_the_next_record_of_the_index() {
    let folder = tempfile::tempdir().unwrap();
    let path = three_lines(folder.path());
    for length in [0i32, -1, 1, i32::MAX, 70_000] {
        three_lines(folder.path());
        let second = SECOND.0;
        change(&path, |bytes| {
            bytes[second + 4..second + 8].copy_from_slice(&length.to_be_bytes())
        });
        let read = |cut| {
            let options = layer::Options {
                height_field: Some("H"),
                cut,
                ..layer::Options::default()
            };
            layer::read_with(&path, &options, &|_| Ok(()))
        };
        let error = read(OnDamage::Refuse).unwrap_err().to_string();
        assert!(
            error.contains("three.shp: record 2 (byte 220): content of"),
            "{error}"
        );
        let layer = read(OnDamage::Accept).unwrap();
        assert_eq!(x_and_height(&layer), [(1., 10.), (3., 30.)], "{length}");
        assert!(
            layer.warnings[0]
                .plain()
                .starts_with("record 2 (byte 220): content of"),
            "{:?}",
            layer.warnings
        );
        std::fs::remove_file(path.with_extension("shx")).unwrap();
        assert!(read(OnDamage::Refuse).is_err());
        assert_eq!(
            x_and_height(&read(OnDamage::Accept).unwrap()),
            [(1., 10.)],
            "{length}"
        );
    }
}

#[test]
fn the_first_damaged_records_are_told_the_rest_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("many.shp");
    let shapes = (0..15)
        .map(|i| Shape::Points(vec![[f64::from(i), 0.0, f64::NAN]]))
        .collect();
    shapefile::write_layer(
        &path,
        &Layer {
            shapes,
            ..Layer::default()
        },
        &[],
    )
    .unwrap();
    // Every type code but the first one's.
    change(&path, |bytes| {
        (1..15).for_each(|i| bytes[100 + 28 * i + 8] = 99)
    });
    let error = shapefile::read_layer(&path, None).unwrap_err().to_string();
    assert!(
        error.ends_with(
            "record 2 (byte 128): shape type 99 is not one of the format's; and 13 more parts cannot be read"
        )
    );
    let layer = read_what_is_there(&path).unwrap();
    assert_eq!((layer.shapes.len(), layer.warnings.len()), (1, 11));
    assert_eq!(
        layer.warnings[0],
        "record 2 (byte 128): shape type 99 is not one of the format's"
    );
    assert_eq!(
        layer.warnings[10],
        "and 4 more parts that could not be read"
    );
}

#[test]
fn deleted_rows_take_their_shapes_along() {
    let folder = tempfile::tempdir().unwrap();
    let path = three_lines(folder.path());
    change(&path.with_extension("dbf"), |bytes| bytes[65 + 25] = b'*');
    for field in [None, Some("H")] {
        let layer = shapefile::read_layer(&path, field).unwrap();
        assert_eq!(layer.shapes.len(), 2);
        assert_eq!(
            layer.warnings,
            ["1 records are marked as deleted in the .dbf; left out"]
        );
    }
}

#[test]
fn names_in_capitals() {
    let folder = tempfile::tempdir().unwrap();
    let path = three_lines(folder.path());
    for (from, to) in [("shp", "SHP"), ("shx", "Shx"), ("dbf", "DBF")] {
        std::fs::rename(path.with_extension(from), path.with_extension(to)).unwrap();
    }
    let layer = layer::read(&format!("{}:h", path.with_extension("SHP").display())).unwrap();
    assert_eq!(x_and_height(&layer), [(1., 10.), (2., 20.), (3., 30.)]);
}

#[test]
fn a_table_is_needed_for_heights_only() {
    let folder = tempfile::tempdir().unwrap();
    let path = three_lines(folder.path());
    change(&path.with_extension("dbf"), |bytes| bytes.truncate(40));
    assert_eq!(
        shapefile::read_layer(&path, None).unwrap().warnings,
        [".dbf not used: shorter than its header of 65 bytes"]
    );
    assert!(
        shapefile::read_layer(&path, Some("H"))
            .unwrap_err()
            .to_string()
            .ends_with("three.dbf: shorter than its header of 65 bytes")
    );
    std::fs::remove_file(path.with_extension("dbf")).unwrap();
    assert_eq!(
        shapefile::read_layer(&path, None).unwrap().warnings,
        [] as [&str; 0]
    );
    assert!(
        shapefile::read_layer(&path, Some("H"))
            .unwrap_err()
            .to_string()
            .contains("no .dbf next to it")
    );
}

#[test]
fn no_byte_can_make_the_reader_panic_or_invent_shapes() {
    let folder = tempfile::tempdir().unwrap();
    let path = three_lines(folder.path());
    for extension in ["shp", "shx", "dbf"] {
        let part = path.with_extension(extension);
        let good = std::fs::read(&part).unwrap();
        for at in 0..good.len() {
            for value in [0x00, 0x7F, 0x80, 0xFF, 0x2A] {
                let mut bad = good.clone();
                bad[at] = value;
                replace(&part, &bad);
                if let Ok(layer) = shapefile::read_layer(&path, Some("H")) {
                    assert!(layer.shapes.len() <= 3, "{extension}, byte {at}: {value}");
                }
            }
            replace(&part, &good[..at]);
            match shapefile::read_layer(&path, None) {
                Ok(layer) => assert!(
                    layer.shapes.len() == 3 && extension != "shp",
                    "{extension} cut at byte {at}"
                ),
                Err(_) => assert_eq!(extension, "shp", "cut at byte {at}"),
            }
            if let Ok(layer) = read_what_is_there(&path) {
                let whole = layer.shapes.len() == 3 && extension != "shp";
                assert!(
                    whole || !layer.warnings.is_empty(),
                    "{extension} cut at byte {at}"
                );
            }
        }
        replace(&part, &good);
    }
}
