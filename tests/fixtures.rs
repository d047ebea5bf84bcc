//! The committed fixtures are what `examples/make_fixtures.rs` makes, and what `fixtures/README.md`
//! says.

#[path = "../examples/fixtures/mod.rs"]
mod fixtures;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use fixtures::valley::{self, KERB_HEIGHT, LAKE_LEVEL};

fn folder() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures"))
}

/// Fails unless the table in the README has this row.
fn assert_stated(what: &str, value: impl std::fmt::Display) {
    let readme = std::fs::read_to_string(folder().join("README.md")).unwrap();
    let row = format!("| {what} | {value} |");
    assert!(
        readme.lines().any(|line| line == row),
        "fixtures/README.md lacks: {row}"
    );
}

#[test]
fn the_program_makes_the_same_bytes() {
    // Sets of lines that broke something once are kept beside:
    // triangulation/tests/lines_that_went_wrong.rs.
    let mut expected = BTreeSet::from(["README.md".to_owned(), "constraints".to_owned()]);
    let mut total = 0;
    for (name, bytes) in fixtures::files().unwrap() {
        let committed = std::fs::read(folder().join(name)).unwrap();
        assert!(
            committed == bytes,
            "{name} differs: cargo run --release --example make_fixtures -- fixtures"
        );
        total += bytes.len();
        expected.insert(name.to_owned());
    }
    assert!(total < 500_000, "{total} bytes");
    let present = std::fs::read_dir(folder())
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap());
    assert_eq!(present.collect::<BTreeSet<_>>(), expected);
}

#[test]
fn the_lidar_lies_on_the_ground() {
    let mut counts = BTreeMap::<u8, usize>::new();
    let mut lowest = BTreeMap::<[i32; 2], i32>::new();
    let (mut withheld, mut overlap, mut ground) = (0, 0, 0);
    let points = fixtures::cloud();
    for p in &points {
        *counts.entry(p.class).or_default() += 1;
        overlap += usize::from(p.overlap);
        let height = 100.0 * valley::height(f64::from(p.u) / 100.0, f64::from(p.v) / 100.0);
        let above = f64::from(p.z) - height;
        if p.withheld {
            withheld += 1;
            assert!(
                above.abs() > 2000.0,
                "a withheld point would not be missed: {p:?}"
            );
            continue;
        }
        match p.class {
            2 => {
                ground += 1;
                lowest
                    .entry([p.u, p.v])
                    .and_modify(|z| *z = p.z.min(*z))
                    .or_insert(p.z);
            }
            5 | 6 => assert!(above > 50.0, "{p:?} is {above} cm above the ground"),
            9 => assert_eq!(f64::from(p.z), 100.0 * LAKE_LEVEL),
            class => panic!("class {class}"),
        }
    }
    for (&[u, v], &z) in &lowest {
        let height = 100.0 * valley::height(f64::from(u) / 100.0, f64::from(v) / 100.0);
        assert!(
            (f64::from(z) - height).abs() <= 0.5 + 1e-9,
            "({u}, {v}): {z} cm, not {height}"
        );
    }
    assert_stated("points", points.len());
    for (class, count) in counts {
        assert_stated(&format!("class {class}"), count);
    }
    assert_stated("withheld", withheld);
    assert_stated("overlap", overlap);
    assert_stated("ground (class 2, not withheld)", ground);
    assert_stated("sites of ground points", lowest.len());
}

#[test]
fn the_breaklines_lie_on_the_ground() {
    let lines = fixtures::breaklines();
    for (kind, line) in &lines {
        for &[u, v, z] in line {
            // Rounding to millimetres in plan counts eight times over on the cliff.
            assert!(
                (z - valley::height(u, v)).abs() < 0.006,
                "{kind} at ({u}, {v}): {z}"
            );
            assert!(*kind != "shore" || z == LAKE_LEVEL);
        }
    }
    let kerbs: Vec<_> = lines
        .iter()
        .filter(|(kind, _)| *kind == "kerb")
        .map(|(_, line)| line)
        .collect();
    for pair in kerbs.chunks(2) {
        for (low, high) in pair[0].iter().zip(pair[1]) {
            assert!(
                (high[2] - low[2] - KERB_HEIGHT).abs() < 0.0011,
                "{low:?} {high:?}"
            );
        }
    }
    assert_stated("breaklines", lines.len());
}

/// Naive and exact: every pair of segments, in whole millimetres.
#[test]
fn the_breaklines_touch_at_vertices_only() {
    type Corner = [i64; 2];
    let millimetres = |x: f64| (x * 1000.0).round() as i64;
    let mut segments = Vec::<[Corner; 2]>::new();
    for (_, line) in fixtures::breaklines() {
        let sites: Vec<_> = line
            .iter()
            .map(|[u, v, _]| [millimetres(*u), millimetres(*v)])
            .collect();
        segments.extend(sites.windows(2).map(|pair| [pair[0], pair[1]]));
    }
    let side = |[a, b]: [Corner; 2], p: Corner| {
        ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])).signum()
    };
    for (i, &s) in segments.iter().enumerate() {
        assert_ne!(s[0], s[1], "a segment without length");
        for &t in &segments[i + 1..] {
            if s.iter().any(|p| t.contains(p)) {
                continue;
            }
            // Collinear segments that lie apart are on no side of each other: hence the boxes.
            let apart = (0..2).any(|k| {
                s[0][k].max(s[1][k]) < t[0][k].min(t[1][k])
                    || t[0][k].max(t[1][k]) < s[0][k].min(s[1][k])
            });
            let crosses =
                !apart && side(s, t[0]) * side(s, t[1]) <= 0 && side(t, s[0]) * side(t, s[1]) <= 0;
            assert!(!crosses, "{s:?} meets {t:?}");
        }
    }
    let vertices: BTreeSet<_> = segments.iter().flatten().collect();
    let lidar: BTreeSet<_> = fixtures::cloud()
        .iter()
        .map(|p| [10 * i64::from(p.u), 10 * i64::from(p.v)])
        .collect();
    assert!(
        vertices.iter().all(|v| !lidar.contains(*v)),
        "a lidar point at the place of a breakline's vertex"
    );
    assert_stated("breakline vertices (sites)", vertices.len());
    assert_stated("breakline segments", segments.len());
}

#[test]
fn the_raster_holds_the_heights() {
    let values = fixtures::values();
    let file = std::fs::File::open(folder().join("dem.tif")).unwrap();
    let mut decoder = tiff::decoder::Decoder::new(file).unwrap();
    assert_eq!(decoder.dimensions().unwrap(), (200, 150));
    let tiff::decoder::DecodingResult::F32(read) = decoder.read_image().unwrap() else {
        panic!("not Float32")
    };
    assert!(read == values);
    let valid: Vec<_> = values
        .iter()
        .copied()
        .filter(|z| *z != fixtures::NODATA)
        .collect();
    assert_stated("cells", values.len());
    assert_stated("cells with a height", valid.len());
    assert_stated(
        "lowest cell",
        format!("{:.3}", valid.iter().copied().fold(f32::INFINITY, f32::min)),
    );
    assert_stated(
        "highest cell",
        format!(
            "{:.3}",
            valid.iter().copied().fold(f32::NEG_INFINITY, f32::max)
        ),
    );
}
