use testkit::random::Random;

use super::index::{self, Extent, NODE_SIZE};
use super::schema::MAGIC;
use super::*;
use crate::crs::Crs;
use crate::data::{Attributes, ContourLine, Layer, Shape, Value};
use crate::error::{Kind, Result};
use crate::io::bytes::watch::unwatched;
use crate::io::options::layer::Options;

fn parse(bytes: &[u8]) -> Result<Layer> {
    let options = Options {
        keeps_attributes: true,
        ..Options::default()
    };
    read::parse(bytes, bytes.len() as u64, "a", &options, &unwatched)
}

fn written(layer: &Layer) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.fgb");
    assert!(write_lines(path.as_path(), layer).unwrap().is_empty());
    std::fs::read(path).unwrap()
}

fn ring(x: f64, y: f64, side: f64) -> Vec<[f64; 3]> {
    let corner = |i: f64, j: f64| [x + i * side, y + j * side, 7.0 + i];
    // Clockwise.
    vec![
        corner(0.0, 0.0),
        corner(0.0, 1.0),
        corner(1.0, 1.0),
        corner(1.0, 0.0),
        corner(0.0, 0.0),
    ]
}

fn hole(x: f64, y: f64, side: f64) -> Vec<[f64; 3]> {
    ring(x, y, side).into_iter().rev().collect()
}

fn text(text: &str) -> Value {
    Value::Text(text.to_owned())
}

/// A layer of these shapes, with attributes of all types.
fn layer(shapes: Vec<Shape>) -> Layer {
    let row = |i: usize| match i % 3 {
        0 => vec![
            text("é"),
            Value::Whole(i64::MIN),
            Value::Missing,
            Value::Truth(true),
        ],
        1 => vec![
            text(""),
            Value::Whole(i as i64),
            Value::Number(-0.1),
            Value::Missing,
        ],
        _ => vec![Value::Missing; 4],
    };
    let rows = (0..shapes.len()).map(row).collect();
    Layer {
        shapes,
        crs: Some(Crs::from_epsg(25832).unwrap()),
        attributes: Some(Attributes {
            names: ["kind", "n", "width", "flag"].map(str::to_owned).into(),
            rows,
        }),
        ..Layer::default()
    }
}

/// The shapes and the rows of a layer, as texts that also compare NaN, sorted.
fn content(layer: &Layer) -> Vec<String> {
    let rows = &layer.attributes.as_ref().unwrap().rows;
    let pairs = layer.shapes.iter().zip(rows);
    let mut all: Vec<String> = pairs.map(|pair| format!("{pair:?}")).collect();
    all.sort_unstable();
    all
}

#[test]
fn what_is_written_is_read() {
    let line = vec![[0.1, 0.2, 3.0], [1e6, -2.0, f64::NAN]];
    let flat = vec![[0.0, 0.0, f64::NAN], [1.0, 1.0, f64::NAN]];
    let polygon = Shape::Polygon(vec![ring(0.0, 0.0, 9.0), hole(1.0, 1.0, 2.0)]);
    let polygons = Shape::Polygon(vec![
        ring(0.0, 0.0, 9.0),
        hole(1.0, 1.0, 2.0),
        hole(4.0, 4.0, 1.0),
        ring(20.0, 0.0, 5.0),
    ]);
    let cases: [(&str, Vec<Shape>); 8] = [
        ("LineString", vec![Shape::Lines(vec![line.clone()]); 2]),
        ("LineString", vec![Shape::Lines(vec![flat.clone()])]),
        (
            "MultiLineString",
            vec![
                Shape::Lines(vec![line.clone()]),
                Shape::Lines(vec![line.clone(), flat.clone()]),
            ],
        ),
        ("Point", vec![Shape::Points(vec![[1.0, 2.0, 3.0]]); 40]),
        ("MultiPoint", vec![Shape::Points(line.clone())]),
        ("Polygon", vec![polygon.clone()]),
        ("MultiPolygon", vec![polygon.clone(), polygons.clone()]),
        (
            "of several types",
            vec![
                polygons,
                Shape::Null,
                Shape::Lines(vec![line]),
                Shape::Points(vec![[5.0, 6.0, 7.0]]),
            ],
        ),
    ];
    for (kind, shapes) in cases {
        let layer = layer(shapes);
        let back = parse(&written(&layer)).unwrap();
        assert_eq!(back.format, format!("FlatGeobuf {kind}"));
        assert_eq!(content(&back), content(&layer), "{kind}");
        assert_eq!(back.fields, layer.attributes.as_ref().unwrap().names);
        assert_eq!(back.crs.unwrap().epsg, Some(25832));
        assert!(back.warnings.is_empty());
    }
    let none = parse(&written(&layer(Vec::new()))).unwrap();
    assert!(none.shapes.is_empty() && none.fields.len() == 4);
}

#[test]
fn contours_have_numbers_and_levels() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("c.fgb");
    let line = |level: f64| ContourLine {
        level,
        points: vec![[level, 0.0], [level, 1.0]],
    };
    let mut lines = (0..50).map(|i| line(f64::from(i) / 2.0));
    let crs = Crs::from_user("EPSG:25832+7837").unwrap();
    let summary = write_contours(path.as_path(), &mut lines, Some(&crs)).unwrap();
    assert_eq!(summary.lines, 50);
    let bytes = std::fs::read(&path).unwrap();
    let back = parse(&bytes).unwrap();
    assert!(back.crs.unwrap().is_same(&crs));
    let mut rows = back.attributes.unwrap().rows;
    rows.sort_by(|a, b| {
        a[0].text()
            .len()
            .cmp(&b[0].text().len())
            .then(a[0].text().cmp(&b[0].text()))
    });
    for (i, row) in (0..50_i64).zip(rows) {
        assert_eq!(row, [Value::Whole(i + 1), Value::Number(i as f64 / 2.0)]);
    }
    // The same data gives the same bytes.
    let mut lines = (0..50).map(|i| line(f64::from(i) / 2.0));
    write_contours(path.as_path(), &mut lines, Some(&crs)).unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), bytes);
}

/// The nodes of the index of a file, the bytes of its records, and the number of records.
fn parts_of(bytes: &[u8], records: u64) -> (Vec<(Extent, u64)>, &[u8]) {
    let header = u32::from_le_bytes(*bytes[8..].first_chunk().unwrap()) as usize;
    let rest = &bytes[12 + header..];
    let size = index::size(records, NODE_SIZE).unwrap() as usize;
    let nodes = rest[..size].chunks_exact(40).map(|node| {
        let number = |at: usize| *node[8 * at..].first_chunk().unwrap();
        let sides = [0, 1, 2, 3].map(|at| f64::from_le_bytes(number(at)));
        (sides, u64::from_le_bytes(number(4)))
    });
    (nodes.collect(), &rest[size..])
}

#[test]
fn the_index_leads_to_each_record() {
    let random = &mut Random(5);
    for count in [1, 2, 15, 16, 17, 256, 257, 300] {
        let mut shapes = Vec::new();
        for _ in 0..count {
            let [x, y] = [0, 1].map(|_| random.index(40) as f64);
            let line = vec![[x, y, 0.0], [x + random.index(3) as f64, y, 0.0]];
            shapes.push(Shape::Lines(vec![line]));
        }
        let bytes = written(&layer(shapes));
        let (nodes, records) = parts_of(&bytes, count);
        let first_leaf = nodes.len() - count as usize;
        // From the root, each node has its children within its extent, and each record is met once.
        let (mut open, mut met) = (vec![0], Vec::new());
        while let Some(at) = open.pop() {
            let (extent, number) = nodes[at];
            if at >= first_leaf {
                met.push((number as usize, extent));
                continue;
            }
            let child = number as usize;
            // The level of the children ends where the next begins.
            let mut level_end = nodes.len();
            let mut size = count as usize;
            while child < level_end - size {
                level_end -= size;
                size = size.div_ceil(16);
            }
            let children = child..(child + 16).min(level_end);
            let all = children.clone().map(|child| nodes[child].0);
            assert_eq!(all.reduce(index::merged).unwrap(), extent);
            open.extend(children);
        }
        met.sort_by_key(|&(position, _)| position);
        let mut position = 0;
        let layer = parse(&bytes).unwrap();
        assert_eq!(met.len(), layer.shapes.len());
        for ((found, extent), shape) in met.into_iter().zip(&layer.shapes) {
            assert_eq!(found, position);
            let vertices = shape.vertices().map(|p| [p[0], p[1], p[0], p[1]]);
            assert_eq!(vertices.reduce(index::merged).unwrap(), extent);
            let length = u32::from_le_bytes(*records[position..].first_chunk().unwrap());
            position += 4 + length as usize;
        }
        assert_eq!(position, records.len());
    }
}

#[test]
fn numbers_in_the_file_are_aligned() {
    // Programs use lists of doubles where they are: 8 bytes from the length of their buffer on.
    let shape = Shape::Lines(vec![vec![[1.5, 2.5, 3.5], [4.5, 5.5, 6.5]]]);
    let bytes = written(&layer(vec![shape; 3]));
    let (_, records) = parts_of(&bytes, 3);
    let mut start = 0;
    while start < records.len() {
        let length = 4 + u32::from_le_bytes(*records[start..].first_chunk().unwrap()) as usize;
        let record = &records[start..start + length];
        for number in [1.5_f64, 3.5] {
            let bytes = number.to_le_bytes();
            let at = record.windows(8).position(|window| window == bytes);
            assert_eq!(at.unwrap() % 8, 0);
        }
        start += length;
    }
}

#[test]
fn damage_is_an_error_with_a_place() {
    let polygons = Shape::Polygon(vec![
        ring(0.0, 0.0, 9.0),
        hole(1.0, 1.0, 2.0),
        ring(20.0, 0.0, 5.0),
    ]);
    let lines = Shape::Lines(vec![vec![[0.0, 0.0, 1.0], [1.0, 1.0, 2.0]]]);
    let bytes = written(&layer(vec![polygons, lines.clone(), lines]));
    let located = |bytes: &[u8]| {
        let error = parse(bytes).unwrap_err();
        let known = matches!(error.kind(), Kind::Format | Kind::Unsupported | Kind::Limit);
        assert!(known && error.location().is_some(), "{error}");
        error.to_string()
    };
    for length in 0..bytes.len() {
        located(&bytes[..length]);
    }
    let random = &mut Random(11);
    let mut errors = 0;
    for _ in 0..4_000 {
        let mut bad = bytes.clone();
        for _ in 0..1 + random.index(3) {
            let at = random.index(bad.len());
            bad[at] = match random.index(3) {
                0 => bad[at] ^ (1 << random.index(8)),
                1 => 0xff,
                _ => random.index(256) as u8,
            };
        }
        if parse(&bad).is_err() {
            errors += 1;
            located(&bad);
        }
    }
    assert!(errors > 400, "{errors}");
    assert!(located(b"fgb\x02fgb\x00").contains("version 2"));
}

#[test]
fn parts_that_overlap_are_refused() {
    /// Members of each level: one geometry, many times.
    const MEMBERS: usize = 200;
    // A list of slots, a table with a type and its members, and the list of these.
    let level = 20 + 12 + 4 + 4 * MEMBERS;
    let mut feature: Vec<u8> = Vec::new();
    let word = |bytes: &mut Vec<u8>, word: usize| bytes.extend((word as u32).to_le_bytes());
    // The root is a feature whose geometry is the first level.
    word(&mut feature, 12);
    feature.extend([6, 0, 8, 0, 4, 0, 0, 0]); // slots: the geometry at 4
    word(&mut feature, 8);
    word(&mut feature, 4 + 20);
    for _ in 0..10 {
        let start = feature.len();
        let mut slots = [0_u16; 10];
        (slots[0], slots[1]) = (20, 12);
        (slots[2 + 6], slots[2 + 7]) = (4, 8);
        slots
            .iter()
            .for_each(|slot| feature.extend(slot.to_le_bytes()));
        word(&mut feature, 20);
        feature.extend([super::schema::kind::COLLECTION, 0, 0, 0]);
        word(&mut feature, 4);
        word(&mut feature, MEMBERS);
        for _ in 0..MEMBERS {
            let next = start + level + 20;
            let here = feature.len();
            word(&mut feature, next - here);
        }
    }
    feature.extend([0; 64]);
    let mut bytes = written(&layer(Vec::new()));
    word(&mut bytes, feature.len());
    bytes.extend(&feature);
    let error = parse(&bytes).unwrap_err().to_string();
    assert_eq!(
        error,
        "record 1: its parts overlap: they are larger than the table that they are in"
    );
    assert!(bytes.starts_with(MAGIC));
}
