//! Damaged files of each format that is read: an error names the file and a place in it.

use std::path::Path;

use breakline::crs::Crs;
use breakline::data::{Attributes, Layer, Shape, Value};
use breakline::io::{ascii_grid, layer, mesh};
use testkit::random::Random;

use crate::sample::field;

type Read = fn(&Path) -> breakline::Result<()>;

/// The number of damaged files of each format.
fn cases(few: usize) -> usize {
    std::env::var("BREAKLINE_MUTATIONS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(few)
}

fn read_layer(path: &Path) -> breakline::Result<()> {
    let options = layer::Options {
        keeps_attributes: true,
        ..layer::Options::default()
    };
    layer::read_with(path, &options, &|_| Ok(())).map(drop)
}

/// Lines with attributes of all kinds.
fn lines() -> Layer {
    let shape = |i: i32| {
        let at = |k: i32| [512_000.0 + f64::from(i), 5_403_000.5 + f64::from(k), 100.25];
        Shape::Lines(vec![(0..4).map(at).collect()])
    };
    let row = |i: i32| {
        vec![
            Value::Whole(i.into()),
            Value::Number(f64::from(i) / 3.0),
            Value::Text(format!("line {i}")),
            Value::Truth(i > 2),
        ]
    };
    Layer {
        shapes: (0..6).map(shape).collect(),
        crs: Some(Crs::from_user("EPSG:25832").unwrap()),
        attributes: Some(Attributes {
            names: ["id", "width", "name", "open"].map(String::from).into(),
            rows: (0..6).map(row).collect(),
        }),
        ..Layer::default()
    }
}

/// Changes some bytes.
fn mutated(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bad = bytes.to_vec();
    for _ in 0..1 + random.index(3) {
        let at = random
            .index(bad.len().max(1))
            .min(bad.len().saturating_sub(1));
        let end = (at + 1 + random.index(12)).min(bad.len());
        match random.index(6) {
            0 => bad[at] ^= 1 << random.index(8),
            1 => bad.truncate(at),
            2 => drop(bad.drain(at..end)),
            3 => {
                let part = bad[at..end].to_vec();
                bad.splice(at..at, part);
            }
            4 => bad[at..end].fill(0xff),
            _ => {
                let large = b"9999999999";
                let end = (at + large.len()).min(bad.len());
                bad[at..end].copy_from_slice(&large[..end - at]);
            }
        }
        if bad.is_empty() {
            break;
        }
    }
    bad
}

#[test]
fn a_damaged_file_is_an_error_that_names_file_and_place() {
    let cases = cases(500);
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(102);
    let grid = "ncols 4\nnrows 3\nxllcorner 512000.5\nyllcorner 5403000\ncellsize 2\nNODATA_value -9999\n\
                250.5 251 252.25 253\n250 -9999 252 253.125\n251 252 253.5 254\n";
    let samples: [(&str, Read); 8] = [
        ("xml", |path| mesh::read_triangles(path).map(drop)),
        ("glb", |path| mesh::read_triangles(path).map(drop)),
        ("nc", |path| mesh::read_triangles(path).map(drop)),
        ("2dm", |path| mesh::read_triangles(path).map(drop)),
        ("dxf", |path| {
            layer::read(&format!("{}:BOUNDARY", path.display())).map(drop)
        }),
        ("fgb", read_layer),
        ("gpkg", read_layer),
        ("asc", |path| {
            let grid = ascii_grid::open(path)?;
            grid.read_grid_with(&|_| Ok(())).map(drop)
        }),
    ];
    for (extension, read) in samples {
        let path = folder.path().join(format!("a.{extension}"));
        match extension {
            "asc" => std::fs::write(&path, grid).unwrap(),
            "fgb" | "gpkg" => drop(layer::write_lines(&path, &lines()).unwrap()),
            _ => drop(mesh::write(&path, &field(Some("EPSG:25832"))).unwrap()),
        }
        read(&path).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let mut errors = 0;
        for case in 0..cases {
            std::fs::remove_file(&path).unwrap();
            std::fs::write(&path, mutated(&bytes, &mut random)).unwrap();
            if let Err(error) = read(&path) {
                errors += 1;
                let text = error.to_string();
                assert!(
                    error.path().is_some() && text.contains(&format!("a.{extension}: ")),
                    "case {case}: {text}"
                );
                assert!(
                    error.location().is_some() || extension == "gpkg",
                    "case {case}, no place: {text}"
                );
                assert!(error.cure_text().is_some(), "case {case}, no cure: {text}");
            }
        }
        assert!(errors * 3 > cases, "{extension}: {errors} of {cases}");
    }
}
