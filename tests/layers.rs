//! Vector layers: every real file against its facts, every damaged one against a table, and what is
//! written against what is read.

use std::io::Write;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use breakline::crs::Crs;
use breakline::data::{Bounds, ContourLine, Layer, Shape};
use breakline::error::Result;
use breakline::io::{Cut, contours, layer, shapefile};
use serde_json::Value;

fn facts() -> serde_json::Map<String, Value> {
    let text = std::fs::read_to_string(testkit::shared("FACTS.json")).unwrap();
    // Written by Python, which has numbers that JSON has not.
    let text = text.replace("NaN", "null").replace("-Infinity", "null").replace("Infinity", "null");
    let Value::Object(facts) = serde_json::from_str(&text).unwrap() else { panic!("FACTS.json is no object") };
    facts
}

fn read(path: &Path) -> Result<Layer> {
    layer::read(path.to_str().unwrap())
}

/// What is whole of a damaged file.
fn read_what_is_there(path: &Path) -> Result<Layer> {
    layer::read_with(path, &layer::Options { cut: Cut::Accept, ..layer::Options::default() }, &|_| Ok(()))
}

fn parts(layer: &Layer) -> usize {
    let parts = layer.shapes.iter().map(|shape| match shape {
        Shape::Lines(parts) | Shape::Polygon(parts) => parts.len(),
        _ => 0,
    });
    parts.sum()
}

fn bounds(layer: &Layer) -> Bounds {
    let mut bounds = Bounds::default();
    layer.shapes.iter().flat_map(Shape::vertices).for_each(|&v| bounds.add(v));
    bounds
}

/// Names of the types of a file, as in its facts.
fn format_name(code: u64) -> &'static str {
    match code {
        1 => "Point",
        3 => "PolyLine",
        5 => "Polygon",
        8 => "MultiPoint",
        11 => "PointZ",
        13 => "PolyLineZ",
        15 => "PolygonZ",
        18 => "MultiPointZ",
        21 => "PointM",
        23 => "PolyLineM",
        25 => "PolygonM",
        31 => "MultiPatch",
        other => panic!("type {other}"),
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_sound_shapefile_has_the_facts() {
    let facts = facts();
    let mut seen = 0;
    for (name, fact) in facts.iter().filter(|(name, _)| name.ends_with(".shp") && !name.contains("/broken")) {
        let layer = read(&testkit::shared(name)).unwrap_or_else(|e| panic!("{e}"));
        let number = |key: &str| fact[key].as_u64().unwrap_or_else(|| panic!("{name}: no {key}")) as usize;
        seen += 1;
        assert_eq!(layer.format, format!("shapefile {}", format_name(number("hdr_type") as u64)), "{name}");
        assert_eq!(layer.shapes.len(), number("records"), "{name}: records");
        let nulls = layer.shapes.iter().filter(|shape| matches!(shape, Shape::Null)).count();
        assert_eq!(nulls, number("nulls"), "{name}: nulls");
        // Parts of a multipatch become faces; the test below looks at them.
        if number("hdr_type") != 31 {
            assert_eq!(parts(&layer), number("parts"), "{name}: parts");
            let vertices = layer.shapes.iter().flat_map(Shape::vertices).count();
            // Its three rings lack their last vertex.
            let closed = if name == "shp/types/polygon.shp" { 3 } else { 0 };
            assert_eq!(vertices, number("points") + closed, "{name}: points");
        }
        let found = bounds(&layer);
        let bbox: Vec<f64> = fact["hdr_bbox"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
        // The header of this one was written before its points were moved.
        if name != "shp/shapelib_eg/3dpoints.shp" {
            assert_eq!([found.min[0], found.min[1], found.max[0], found.max[1]], bbox[..], "{name}: bbox");
        }
        match fact["z"].as_array() {
            Some(z) => {
                assert_eq!([found.min[2], found.max[2]], [z[0].as_f64().unwrap(), z[1].as_f64().unwrap()], "{name}: z")
            }
            None => assert!(found.min[2] > found.max[2], "{name}: no heights"),
        }
    }
    assert_eq!(seen, 65);
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
        Refused(&["no record can be read", "record 1 (byte 100)", "5 points take 80 bytes", "60 left"]),
    ),
    (
        "broken/buggymultipoint.shp",
        Refused(&["no record can be read", "record 1 (byte 100)", "3 points take 48 bytes", "32 left"]),
    ),
    // Some bytes behind the last record, and behind the last row.
    ("broken/corrupt_too_long.shp", Full(10, 30, &["record 11 (byte 1140): 5 bytes, too few for a record"])),
    ("broken/empty.shp", Full(0, 0, &[])),
    ("broken/emptymultiline.shp", Full(1, 0, &["4 points belong to no part"])),
    ("broken/extentnan.shp", Full(0, 0, &[])),
    (
        "broken/mixed_shape_type_non_conformant.shp",
        Full(6, 21, &["the header states PolyLine, the records are 1 Point, 2 PolyLine, 2 Polygon, 1 MultiPoint"]),
    ),
    // Two outer rings that are one another's neighbors; nobody asks here which is inside which.
    ("broken/multipolygon_as_invalid_polygon.shp", Full(2, 16, &[])),
    ("broken_mut/brklinz__filelen_wrong.shp", Full(122, 1736, &["its header states 101096 bytes, the file has 50548"])),
    ("broken_mut/brklinz__inf_x.shp", Refused(&["record 1 (byte 100): x of vertex 2 is inf"])),
    ("broken_mut/brklinz__nan_z.shp", Full(122, 1736, &["1 points have no height"])),
    ("broken_mut/brklinz__no_dbf.shp", Full(122, 1736, &[])),
    ("broken_mut/brklinz__no_shx.shp", Full(122, 1736, &[])),
    ("broken_mut/brklinz__nodata_z.shp", Full(122, 1736, &["1 points have no height"])),
    ("broken_mut/brklinz__null_record_with_body.shp", Full(122, 1644, &["1 records are of the type null, but"])),
    ("broken_mut/brklinz__numpoints_huge.shp", Partial(121, 1644, &["record 1 (byte 100): 1000092 points"])),
    (
        "broken_mut/brklinz__part_index_out_of_range.shp",
        Partial(121, 1644, &["record 1 (byte 100): part 1 holds points 97 to 92"]),
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
        Full(122, 1736, &[".shx not used: its header states 1076 bytes, the file has 588"]),
    ),
];

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_damaged_shapefile_is_in_the_table() {
    let folder = testkit::shared("shp");
    let mut there = Vec::new();
    for sub in ["broken", "broken_mut"] {
        for entry in std::fs::read_dir(folder.join(sub)).unwrap() {
            let name = format!("{sub}/{}", entry.unwrap().file_name().into_string().unwrap());
            there.extend(name.ends_with(".shp").then_some(name));
        }
    }
    there.sort();
    assert_eq!(there, DAMAGED.iter().map(|row| row.0).collect::<Vec<_>>());

    for (name, outcome) in DAMAGED {
        let start = Instant::now();
        let result = read(&folder.join(name));
        assert!(start.elapsed() < Duration::from_secs(5), "{name} took {:?}", start.elapsed());
        let result = match outcome {
            Partial(_, _, words) => {
                let error = result.expect_err(name);
                assert!(words.iter().any(|word| error.to_string().contains(word)), "{name}: {error}");
                assert!(error.cure_text().is_some_and(|cure| cure.plain().contains("partial")), "{name}");
                read_what_is_there(&folder.join(name))
            }
            Full(..) | Refused(_) => result,
        };
        match (outcome, result) {
            (Full(shapes, vertices, words) | Partial(shapes, vertices, words), Ok(layer)) => {
                assert_eq!(layer.shapes.len(), *shapes, "{name}");
                assert_eq!(layer.shapes.iter().flat_map(Shape::vertices).count(), *vertices, "{name}");
                assert_eq!(layer.warnings.len(), words.len(), "{name}: {:?}", layer.warnings);
                for (warning, word) in layer.warnings.iter().zip(*words) {
                    assert!(warning.plain().contains(word), "{name}: {warning:?} without {word:?}");
                }
            }
            (Refused(words), Err(error)) => {
                let text = error.to_string();
                assert!(error.path().is_some() && error.cure_text().is_some(), "{name}: {error:?}");
                words.iter().for_each(|word| assert!(text.contains(word), "{name}: {text:?} without {word:?}"));
            }
            (expected, found) => panic!("{name}: {expected:?} expected, found {found:?}"),
        }
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn multipatches_become_faces() {
    // A fan and a strip of n vertices give n - 2 triangles; a file has a ring with two holes.
    let holes: &[usize] = &[9, 5, 5];
    for (name, triangles, last) in
        [("shp/gdal/multipatch.shp", 4 + 6, holes), ("shp/types/multipatch.shp", 8 + 4, &[4])]
    {
        let layer = read(&testkit::shared(name)).unwrap();
        let [Shape::Faces(faces)] = &layer.shapes[..] else { panic!("{name}: {:?}", layer.shapes) };
        let lengths: Vec<Vec<usize>> = faces.iter().map(|face| face.iter().map(Vec::len).collect()).collect();
        assert_eq!(lengths.iter().filter(|rings| **rings == [4]).count(), triangles, "{name}");
        assert_eq!(lengths.last().unwrap(), last, "{name}");
        assert_eq!(layer.warnings, [] as [&str; 0], "{name}");
    }
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn heights_come_from_an_attribute() {
    let path = testkit::shared("lidar/ign_0292_6833/Lignes_3d_0292_6833.shp");
    let spec = |field: &str| format!("{}:{field}", path.display());
    let layer = layer::read(&spec("recupz")).unwrap();
    assert_eq!(layer.shapes.len(), 1189);
    let heights = bounds(&layer);
    assert!(layer.shapes.iter().flat_map(Shape::vertices).all(|v| v[2].is_finite()));

    // The same lines as GeoJSON, for the lines in the tile: the heights agree line by line.
    let twin = testkit::shared("lidar/ign_0292_6833/Lignes_2d_0292_6833.geojson");
    let twin = layer::read(&format!("{}:RecupZ", twin.display())).unwrap();
    assert_eq!(twin.shapes.len(), 48);
    let find = |v: &[f64; 3]| {
        let all = layer.shapes.iter().flat_map(Shape::vertices);
        let same = |w: &&[f64; 3]| (v[0] - w[0]).abs() < 1e-6 && (v[1] - w[1]).abs() < 1e-6;
        all.filter(same).map(|w| w[2]).collect::<Vec<f64>>()
    };
    for v in twin.shapes.iter().flat_map(Shape::vertices) {
        assert!(find(v).contains(&v[2]), "{v:?}: {:?}", find(v));
        assert!(heights.min[2] <= v[2] && v[2] <= heights.max[2]);
    }

    let error = layer::read(&spec("ELEV")).unwrap_err();
    assert_eq!(*error.cure_text().unwrap(), "name one of FID, ID_seg, RecupZ");
    assert!(error.to_string().ends_with("Lignes_3d_0292_6833.dbf: there is no field ELEV"), "{error}");
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn geojson_has_heights_of_its_own() {
    let layer = read(&testkit::shared("lidar/ign_0292_6833/Points_virtuels_0292_6833.geojson")).unwrap();
    assert_eq!((layer.shapes.len(), layer.format.as_str()), (2423, "GeoJSON"));
    assert!(layer.shapes.iter().all(|s| matches!(s, Shape::Points(p) if p.len() == 1 && p[0][2].is_finite())));
}

/// Three lines, at heights 10, 20 and 30 by their field, as a set of files.
fn three_lines(folder: &Path) -> std::path::PathBuf {
    let line = |x: f64, vertices: usize| Shape::Lines(vec![(0..vertices).map(|i| [x, i as f64, 0.0]).collect()]);
    let layer = Layer { shapes: vec![line(1.0, 2), line(2.0, 3), line(3.0, 2)], ..Layer::default() };
    let path = folder.join("three.shp");
    let values = [10.0, 20.0, 30.0];
    shapefile::write_layer(&path, &layer, &[shapefile::Column { name: "H", values: &values }]).unwrap();
    path
}

/// Where the second of them begins, and its length with its header.
const SECOND: (usize, usize) = (100 + 8 + 64 + 2 * 24, 8 + 64 + 3 * 24);

/// x and height of each shape's first vertex.
fn x_and_height(layer: &Layer) -> Vec<(f64, f64)> {
    layer.shapes.iter().filter_map(|s| s.vertices().next().map(|v| (v[0], v[2]))).collect()
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
    assert_eq!(x_and_height(&shapefile::read_layer(&path, Some("h")).unwrap()), [(1., 10.), (2., 20.), (3., 30.)]);
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
    assert!(layer.warnings[0].plain().starts_with(".shx not used: entry 1 points to byte"), "{:?}", layer.warnings);
}

#[test]
fn columns_follow_their_records() {
    let folder = tempfile::tempdir().unwrap();
    let path = three_lines(folder.path());
    let read = |columns: &[&str]| {
        let options = layer::Options { columns, ..layer::Options::default() };
        shapefile::read_layer_with(&path, &options, &|_| Ok(()))
    };
    assert_eq!(read(&["h"]).unwrap().column("H").unwrap().values, [10., 20., 30.]);
    change(&path.with_extension("shx"), |bytes| {
        let (a, b) = bytes[100..].split_at_mut(8);
        a.swap_with_slice(&mut b[..8]);
    });
    let layer = read(&["h", "H"]).unwrap();
    assert_eq!(layer.columns[0].values, [20., 10., 30.]);
    assert_eq!((layer.columns.len(), layer.columns[1].name.as_str()), (2, "H"));
    assert_eq!(x_and_height(&layer), [(1., 0.), (2., 0.), (3., 0.)], "heights are those of the geometry");

    let error = read(&["H", "WIDTH"]).unwrap_err().to_string();
    assert!(error.ends_with("three.dbf: there is no field WIDTH"), "{error}");
    change(&path.with_extension("dbf"), |bytes| {
        let at = bytes.windows(2).rposition(|text| text == b"20").unwrap();
        bytes[at..at + 2].copy_from_slice(b"no");
    });
    let error = read(&["H"]).unwrap_err().to_string();
    assert!(error.contains("three.shp: record 1: field H: expected a number, found 'no"), "{error}");
    std::fs::remove_file(path.with_extension("dbf")).unwrap();
    let error = read(&["H"]).unwrap_err().to_string();
    assert!(error.contains("no .dbf next to it with the field H"), "{error}");
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
    assert!(layer.warnings.iter().any(|w| w.plain().starts_with("1 records are older copies")), "{:?}", layer.warnings);
}

#[test]
fn reading_goes_on_at_the_next_record_of_the_index() {
    let folder = tempfile::tempdir().unwrap();
    let path = three_lines(folder.path());
    for length in [0i32, -1, 1, i32::MAX, 70_000] {
        three_lines(folder.path());
        let second = SECOND.0;
        change(&path, |bytes| bytes[second + 4..second + 8].copy_from_slice(&length.to_be_bytes()));
        let read = |cut| {
            let options = layer::Options { height_field: Some("H"), cut, ..layer::Options::default() };
            layer::read_with(&path, &options, &|_| Ok(()))
        };
        let error = read(Cut::Refuse).unwrap_err().to_string();
        assert!(error.contains("three.shp: record 2 (byte 220): content of"), "{error}");
        let layer = read(Cut::Accept).unwrap();
        assert_eq!(x_and_height(&layer), [(1., 10.), (3., 30.)], "{length}");
        assert!(layer.warnings[0].plain().starts_with("record 2 (byte 220): content of"), "{:?}", layer.warnings);
        std::fs::remove_file(path.with_extension("shx")).unwrap();
        assert!(read(Cut::Refuse).is_err());
        assert_eq!(x_and_height(&read(Cut::Accept).unwrap()), [(1., 10.)], "{length}");
    }
}

#[test]
fn the_first_damaged_records_are_told_the_rest_counted() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("many.shp");
    let shapes = (0..15).map(|i| Shape::Points(vec![[f64::from(i), 0.0, f64::NAN]])).collect();
    shapefile::write_layer(&path, &Layer { shapes, ..Layer::default() }, &[]).unwrap();
    // Every type code but the first one's.
    change(&path, |bytes| (1..15).for_each(|i| bytes[100 + 28 * i + 8] = 99));
    let error = shapefile::read_layer(&path, None).unwrap_err().to_string();
    assert!(
        error.ends_with(
            "record 2 (byte 128): shape type 99 is not one of the format's; and 13 more parts cannot be read"
        )
    );
    let layer = read_what_is_there(&path).unwrap();
    assert_eq!((layer.shapes.len(), layer.warnings.len()), (1, 11));
    assert_eq!(layer.warnings[0], "record 2 (byte 128): shape type 99 is not one of the format's");
    assert_eq!(layer.warnings[10], "and 4 more parts that could not be read");
}

#[test]
fn deleted_rows_take_their_shapes_along() {
    let folder = tempfile::tempdir().unwrap();
    let path = three_lines(folder.path());
    change(&path.with_extension("dbf"), |bytes| bytes[65 + 25] = b'*');
    for field in [None, Some("H")] {
        let layer = shapefile::read_layer(&path, field).unwrap();
        assert_eq!(layer.shapes.len(), 2);
        assert_eq!(layer.warnings, ["1 records are marked as deleted in the .dbf; left out"]);
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
    assert_eq!(shapefile::read_layer(&path, None).unwrap().warnings, [] as [&str; 0]);
    assert!(shapefile::read_layer(&path, Some("H")).unwrap_err().to_string().contains("no .dbf next to it"));
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
                Ok(layer) => assert!(layer.shapes.len() == 3 && extension != "shp", "{extension} cut at byte {at}"),
                Err(_) => assert_eq!(extension, "shp", "cut at byte {at}"),
            }
            if let Ok(layer) = read_what_is_there(&path) {
                let whole = layer.shapes.len() == 3 && extension != "shp";
                assert!(whole || !layer.warnings.is_empty(), "{extension} cut at byte {at}");
            }
        }
        replace(&part, &good);
    }
}

fn lines() -> Vec<ContourLine> {
    vec![
        ContourLine { level: 12.3, points: vec![[0.5, 0.25], [1e6 + 0.1, 5e6 + 0.7]] },
        ContourLine { level: 0.0, points: vec![[0., 0.], [1., 0.], [1., 1.], [0., 0.]] },
        ContourLine { level: -1.0 / 3.0, points: vec![[0., 0.], [0., 1.], [0., 2.], [3., 2.]] },
    ]
}

fn expected() -> Vec<Vec<[f64; 3]>> {
    lines().iter().map(|line| line.points.iter().map(|p| [p[0], p[1], line.level]).collect()).collect()
}

#[test]
fn contours_come_back_from_both_formats() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["c.shp", "c.geojson", "c.JSON", "c.geojsonl"] {
        let target = folder.path().join(name);
        let summary = contours::write(&target, &mut lines().into_iter(), None).unwrap();
        assert_eq!((summary.lines, summary.vertices, summary.closed), (3, 10, 1));
        assert_eq!((summary.bounds.min, summary.bounds.max), ([0., 0., -1.0 / 3.0], [1e6 + 0.1, 5e6 + 0.7, 12.3]));
        for spec in [target.display().to_string(), format!("{}:elev", target.display())] {
            let layer = layer::read(&spec).unwrap();
            let shapes: Vec<Shape> = expected().into_iter().map(|line| Shape::Lines(vec![line])).collect();
            assert_eq!(layer.shapes, shapes, "{spec}");
            assert!(layer.fields.contains(&"ELEV".to_owned()));
        }
    }
    let error = contours::write(&folder.path().join("c.dxf"), &mut lines().into_iter(), None).unwrap_err();
    assert!(
        error.to_string().ends_with("c.dxf: contours are written as .shp, .geojson, .json, .geojsonl or .geojsons")
    );
}

#[test]
fn another_reader_agrees_on_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("c.shp");
    contours::write(&target, &mut lines().into_iter(), None).unwrap();
    let mut reader = ::shapefile::Reader::from_path(&target).unwrap();
    for (i, pair) in reader.iter_shapes_and_records().enumerate() {
        let (::shapefile::Shape::PolylineZ(line), record) = pair.unwrap() else { panic!("no PolyLineZ") };
        let vertices: Vec<[f64; 3]> = line.parts().iter().flatten().map(|p| [p.x, p.y, p.z]).collect();
        assert_eq!(vertices, expected()[i]);
        let number = |name: &str| match record.get(name) {
            Some(::shapefile::dbase::FieldValue::Numeric(Some(value))) => *value,
            other => panic!("{name}: {other:?}"),
        };
        assert_eq!((number("ID"), number("ELEV")), (i as f64 + 1.0, lines()[i].level));
    }
    assert_eq!(reader.shape_count().unwrap(), 3);
}

#[test]
fn the_same_lines_give_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = |name: &str| {
        let target = folder.path().join(name);
        contours::write(&target, &mut lines().into_iter(), None).unwrap();
        ["shp", "shx", "dbf", "cpg"].map(|extension| std::fs::read(target.with_extension(extension)).unwrap())
    };
    let [shp, shx, dbf, cpg] = bytes("a.shp");
    assert_eq!([&shp, &shx, &dbf, &cpg], bytes("b.shp").each_ref());
    assert_eq!(dbf[..4], [3, 70, 1, 1], "the date is constant");
    assert_eq!((cpg.as_slice(), shx.len(), dbf.len()), (b"UTF-8".as_slice(), 100 + 3 * 8, 32 + 64 + 1 + 3 * 35 + 1));
}

#[test]
fn a_failure_leaves_the_old_files() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("c.shp");
    // A folder where the .dbf should go; it is committed before the .shp.
    std::fs::create_dir(target.with_extension("dbf")).unwrap();
    std::fs::File::create(&target).unwrap().write_all(b"old").unwrap();
    let error = contours::write(&target, &mut lines().into_iter(), None).unwrap_err();
    assert!(error.to_string().contains("c.dbf"), "{error}");
    assert_eq!(std::fs::read(&target).unwrap(), b"old");
}

#[test]
fn ogrinfo_reads_the_contours() {
    if Command::new("ogrinfo").arg("--version").output().is_err() {
        eprintln!("skipped: ogrinfo is not here (apt-get install gdal-bin)");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (name, elevation) in
        [("c.shp", ["ELEV: Real (24.6)", "= 12.300000\n"]), ("c.geojson", ["ELEV: Real (0.0)", "= 12.3\n"])]
    {
        let target = folder.path().join(name);
        contours::write(&target, &mut lines().into_iter(), None).unwrap();
        let output = Command::new("ogrinfo").args(["-al", "-ro"]).arg(&target).output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout);
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{name}");
        for wanted in [
            "Geometry: 3D Line String",
            "Feature Count: 3",
            "Extent: (0.000000, 0.000000) - (1000000.100000, 5000000.700000)",
            "LINESTRING Z (0.5 0.25 12.3,1000000.1 5000000.7 12.3)",
        ]
        .into_iter()
        .chain(elevation)
        {
            assert!(text.contains(wanted), "{name}: {wanted:?} is not in\n{text}");
        }
    }
}

/// Every file with a `.prj`, by folder.
const SYSTEMS: &[(&str, &[&str], u32)] = &[
    ("dem/hintereisferner", &["Hintereisferner"], 4326),
    ("dem/hintereisferner", &["Hintereisferner_UTM"], 32632),
    ("dem/lux", &["lux"], 4326),
    ("dem/qgis_3d", &["buildings", "points_with_z"], 27700),
    ("lidar/delft_ahn3_bgt", &["breaklines_z_derived"], 28992),
    (
        "lidar/delft_ahn3_bgt/bgt_shp",
        &["bgt_begroeidterreindeel", "bgt_kunstwerkdeel", "bgt_onbegroeidterreindeel"],
        28992,
    ),
    ("lidar/delft_ahn3_bgt/bgt_shp", &["bgt_overbruggingsdeel", "bgt_pand", "bgt_scheiding"], 28992),
    ("lidar/delft_ahn3_bgt/bgt_shp", &["bgt_waterdeel", "bgt_wegdeel"], 28992),
    ("lidar/ign_0292_6833", &["Lignes_3d_0292_6833"], 2154),
    ("lidar/quebec_lidR", &["efi_plot", "lake_polygons_UTM17"], 26917),
    ("shp/geotools", &["archsites", "bugsites", "roads", "rstrct", "streams"], 26713),
];

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn every_prj_names_its_system() {
    let facts = facts();
    let mut seen = 0;
    for (folder, names, code) in SYSTEMS {
        for name in *names {
            let layer = read(&testkit::shared(&format!("{folder}/{name}.shp"))).unwrap();
            assert_eq!(layer.crs.and_then(|crs| crs.epsg), Some(*code), "{folder}/{name}");
            seen += 1;
        }
    }
    let with_prj = |fact: &Value| fact["sidecars"].as_array().is_some_and(|list| list.contains(&"prj".into()));
    assert_eq!(seen, facts.values().filter(|fact| with_prj(fact)).count());
    for name in ["Lignes_2d", "Lignes_3d", "Points_virtuels"] {
        let path = testkit::shared(&format!("lidar/ign_0292_6833/{name}_0292_6833.geojson"));
        assert_eq!(read(&path).unwrap().crs.and_then(|crs| crs.epsg), Some(2154), "{name}");
    }
}

#[test]
fn contours_keep_their_system() {
    let folder = tempfile::tempdir().unwrap();
    for code in [25832, 2154, 2263, 26917, 28992, 4326] {
        let crs = Crs::from_epsg(code).unwrap();
        for name in ["c.shp", "c.geojson"] {
            let target = folder.path().join(name);
            // Where degrees can be, so that GeoJSON without a `crs` member means EPSG:4326.
            let line = ContourLine { level: 5.0, points: vec![[1.0, 2.0], [3.0, 4.0]] };
            let summary = contours::write(&target, &mut [line].into_iter(), Some(&crs)).unwrap();
            assert_eq!(summary.warnings, [] as [&str; 0]);
            let layer = read(&target).unwrap();
            assert_eq!(layer.warnings, [] as [&str; 0], "{name} in EPSG:{code}");
            assert!(layer.crs.is_some_and(|found| found.is_same(&crs)), "{name} in EPSG:{code}");
            if let Ok(output) = Command::new("ogrinfo").args(["-al", "-so", "-ro"]).arg(&target).output() {
                let text = String::from_utf8_lossy(&output.stdout);
                // GDAL makes WGS 84 with heights of GeoJSON that names no system.
                let shown = if name == "c.geojson" && code == 4326 { 4979 } else { code };
                let last = text.lines().rfind(|line| line.contains("ID[\"EPSG\""));
                assert_eq!(last.map(str::trim), Some(format!("ID[\"EPSG\",{shown}]]").as_str()), "{name}:\n{text}");
            }
        }
    }
}
