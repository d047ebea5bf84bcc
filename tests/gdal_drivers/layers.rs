//! Vector layers by drivers of GDAL.

use breakline::data::{Layer, Shape, Value};
use breakline::io::gdal::read_layer_with;
use breakline::io::layer::{Options, read_with};
use tempfile::TempDir;

use super::program::{files_of, folder_with, run_in};
use super::{printed, run_verb, surface};

/// Drivers that keep heights and attributes, and an output with options.
const DRIVERS: &[(&str, &str, &[&str])] = &[
    ("CSV", "a.csv", &["-lco", "GEOMETRY=AS_WKT"]),
    ("GML", "a.gml", &["-co", "FORMAT=GML3"]),
    ("GPKG", "a.gpkg", &[]),
    ("JML", "a.jml", &[]),
    ("LIBKML", "a.kml", &[]),
    ("MapML", "a.mapml", &[]),
    ("OGR_GMT", "a.gmt", &[]),
    ("OpenFileGDB", "a.gdb", &[]),
    ("SQLite", "a.sqlite", &[]),
    ("SQLite", "b.sqlite", &["-co", "SPATIALITE=YES"]),
    ("netCDF", "a.nc", &[]),
];

/// The drivers of [`DRIVERS`] that write lines which GDAL reads without heights.
const FLAT: &[&str] = &["MapML"];

fn read(folder: &TempDir, name: &str) -> Layer {
    let options = Options {
        keeps_attributes: true,
        ..Options::default()
    };
    read_layer_with(&folder.path().join(name), &options, &|_| Ok(())).unwrap()
}

/// The lines of a layer in any order, rounded to what texts keep.
fn lines(layer: &Layer, is_flat: bool) -> Vec<Vec<[i64; 3]>> {
    let rounded = |v: f64| {
        if v.is_nan() {
            i64::MIN
        } else {
            (v * 1e4).round() as i64
        }
    };
    let vertex = |p: &[f64; 3]| {
        [
            rounded(p[0]),
            rounded(p[1]),
            if is_flat { 0 } else { rounded(p[2]) },
        ]
    };
    let mut lines: Vec<Vec<[i64; 3]>> = layer
        .shapes
        .iter()
        .map(|shape| match shape {
            Shape::Lines(parts) => parts.iter().flatten().map(vertex).collect(),
            other => panic!("{other:?}"),
        })
        .collect();
    lines.sort();
    lines
}

/// The values of an attribute, in any order.
fn values(layer: &Layer, name: &str) -> Vec<String> {
    let attributes = layer.attributes.as_ref().unwrap();
    let at = attributes
        .names
        .iter()
        .position(|own| own.eq_ignore_ascii_case(name));
    let at = at.unwrap_or_else(|| panic!("{name} of {:?}", attributes.names));
    let number = |value: &Value| match value {
        Value::Number(number) => format!("{number:.6}"),
        Value::Whole(whole) => format!("{:.6}", *whole as f64),
        Value::Text(text) => text
            .parse()
            .map_or(text.clone(), |n: f64| format!("{n:.6}")),
        other => format!("{other:?}"),
    };
    let mut values: Vec<String> = attributes.column(at).map(number).collect();
    values.sort();
    values
}

#[test]
fn contours_of_every_driver_are_those_of_ours() {
    let folder = surface();
    let contours = ["contour", "--interval", "2.5"];
    run_verb(&folder, &contours, &["-o", "ours.geojson"]).works(&[]);
    let ours = read_with(
        &folder.path().join("ours.geojson"),
        &Options {
            keeps_attributes: true,
            ..Options::default()
        },
        &|_| Ok(()),
    )
    .unwrap();
    assert!(ours.shapes.len() > 5);
    for &(driver, name, options) in DRIVERS {
        // GPKG is ours.
        let named = ["-of", driver, "-o", name];
        let run = run_verb(&folder, &contours, &[&named[..], options].concat());
        run.works(&[&format!("written     {name}")]);
        let theirs = read(&folder, name);
        let is_flat = FLAT.contains(&driver);
        let is_degrees = matches!(driver, "LIBKML" | "MapML");
        if is_degrees {
            // In degrees only: GDAL transforms.
            assert_eq!(theirs.shapes.len(), ours.shapes.len(), "{driver}");
        } else {
            assert_eq!(lines(&theirs, is_flat), lines(&ours, is_flat), "{driver}");
        }
        assert_eq!(values(&theirs, "ELEV"), values(&ours, "ELEV"), "{driver}");
        let judged = printed(&folder, "ogrinfo", &["-al", "-so", "-ro", name]);
        assert!(
            judged.contains(&format!("Feature Count: {}", ours.shapes.len())),
            "{judged}"
        );
        // GMT's text does not say what all lines have.
        let states_no_type = driver == "OGR_GMT" || judged.contains("Unknown (any)");
        let has_heights = states_no_type || judged.contains("3D ");
        assert!(is_flat || has_heights, "{driver}: {judged}");
    }
}

#[test]
fn drivers_with_attributes_of_their_own_keep_the_lines() {
    let folder = surface();
    let contours = ["contour", "--interval", "2.5"];
    run_verb(&folder, &contours, &["-o", "ours.geojson"]).works(&[]);
    let ours = read(&folder, "ours.geojson");
    for (driver, name) in [("DGN", "a.dgn"), ("S57", "a.000")] {
        let run = run_verb(&folder, &contours, &["-of", driver, "-o", name]);
        if driver == "DGN" {
            run.works(&["a.dgn: without ID, ELEV: the driver DGN has a fixed set of attributes"]);
            let theirs = read(&folder, name);
            let found: usize = theirs
                .shapes
                .iter()
                .map(|shape| shape.vertices().count())
                .sum();
            let wanted: usize = ours
                .shapes
                .iter()
                .map(|shape| shape.vertices().count())
                .sum();
            assert_eq!(found, wanted);
        } else {
            assert_ne!(run.code, 0);
            assert!(!folder.path().join(name).exists());
        }
    }
}

/// Lines with attributes of every type, some missing, some in several parts.
const LINES: &str = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::25832"}},"features":[
{"type":"Feature","properties":{"name":"Äußerer Weg, \"1\"","count":7,"width":2.5},"geometry":{"type":"LineString","coordinates":[[500000.5,5300001.5],[500004.5,5300002.5]]}},
{"type":"Feature","properties":{"name":null,"count":null,"width":null},"geometry":{"type":"MultiLineString","coordinates":[[[500001,5300000.5],[500001,5300003.5]],[[500002,5300000.5],[500002,5300003.5]]]}},
{"type":"Feature","properties":{"name":"道","count":-3,"width":1e-3},"geometry":{"type":"LineString","coordinates":[[500003.5,5300000.5],[500003.5,5300004.5]]}}]}"#;

#[test]
fn attributes_keep_their_types_texts_and_what_is_missing() {
    let folder = surface();
    std::fs::write(folder.path().join("lines.geojson"), LINES).unwrap();
    for (driver, name, options) in [
        ("SQLite", "a.sqlite", &[][..]),
        ("GML", "a.gml", &[]),
        ("OpenFileGDB", "a.gdb", &[]),
        ("JML", "a.jml", &[]),
        (
            "CSV",
            "a.csv",
            &["-lco", "GEOMETRY=AS_WKT", "-lco", "CREATE_CSVT=YES"],
        ),
        ("MapInfo File", "a.mif", &["-lco", "ENCODING=UTF-8"]),
        ("PGDUMP", "a.sql", &[]),
    ] {
        let verb = ["drape", "--lines", "lines.geojson"];
        run_verb(
            &folder,
            &verb,
            &[&["-of", driver, "-o", name], options].concat(),
        )
        .works(&[]);
        if driver == "PGDUMP" {
            let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
            assert!(text.contains("COMMIT") && text.contains("道"), "{text}");
            continue;
        }
        let layer = read(&folder, name);
        assert_eq!(layer.shapes.len(), 3, "{driver}");
        let attributes = layer.attributes.as_ref().unwrap();
        let row = |field: &str| {
            let at = attributes
                .names
                .iter()
                .position(|own| own.eq_ignore_ascii_case(field));
            attributes
                .column(at.unwrap())
                .cloned()
                .collect::<Vec<Value>>()
        };
        let texts = row("name");
        assert_eq!(
            texts[0],
            Value::Text("Äußerer Weg, \"1\"".to_owned()),
            "{driver}"
        );
        assert_eq!(texts[2], Value::Text("道".to_owned()), "{driver}");
        // Text formats have no difference between nothing and an empty text.
        let is_nothing =
            |value: &Value| matches!(value, Value::Missing) || *value == Value::Text(String::new());
        assert!(is_nothing(&texts[1]), "{driver}: {texts:?}");
        assert_eq!(row("count")[0], Value::Whole(7), "{driver}");
        assert_eq!(row("width")[0], Value::Number(2.5), "{driver}");
        if driver != "MapInfo File" {
            assert!(
                is_nothing(&row("count")[1]) && is_nothing(&row("width")[1]),
                "{driver}"
            );
        }
        let parts: Vec<usize> = layer
            .shapes
            .iter()
            .map(|shape| match shape {
                Shape::Lines(parts) => parts.len(),
                other => panic!("{other:?}"),
            })
            .collect();
        assert_eq!(parts, [1, 2, 1], "{driver}");
    }
}

#[test]
fn areas_have_their_holes_in_every_driver() {
    // A hill in the middle: the outer bands have a hole.
    let mut points = String::new();
    for row in -6i32..=6 {
        for column in -6i32..=6 {
            points.push_str(&format!(
                "{} {} {}\n",
                500 + column,
                500 + row,
                20 - row.abs().max(column.abs())
            ));
        }
    }
    let folder = folder_with(&[("points.xyz", &points)]);
    let make = |name: &str, driver: &str| {
        run_in(
            &folder,
            &[
                "contour",
                "points.xyz",
                "--interval",
                "2",
                "--bands",
                "-of",
                driver,
                "-o",
                name,
            ],
        )
        .works(&[])
    };
    make("ours.geojson", "GeoJSON");
    let rings = |name: &str| {
        let layer = read(&folder, name);
        let mut rings: Vec<usize> = layer
            .shapes
            .iter()
            .map(|shape| match shape {
                Shape::Polygon(rings) => rings.len(),
                other => panic!("{other:?}"),
            })
            .collect();
        rings.sort_unstable();
        rings
    };
    let ours = rings("ours.geojson");
    assert!(ours.contains(&2), "{ours:?}");
    for (driver, name) in [
        ("SQLite", "a.sqlite"),
        ("GML", "a.gml"),
        ("OpenFileGDB", "a.gdb"),
        ("MapInfo File", "a.tab"),
    ] {
        make(name, driver);
        assert_eq!(rings(name), ours, "{driver}");
    }
}

#[test]
fn folders_appear_whole_and_are_not_replaced() {
    let folder = surface();
    run_verb(&folder, &["contour"], &["-o", "a.gdb"]).works(&["written     a.gdb"]);
    assert!(folder.path().join("a.gdb").is_dir());
    let before = files_of(&folder.path().join("a.gdb"));
    run_verb(&folder, &["contour"], &["-o", "a.gdb"]).fails(1, &["a.gdb: the file exists"]);
    run_verb(&folder, &["contour"], &["-o", "a.gdb", "--overwrite"])
        .fails(1, &["there is a folder with this name"]);
    assert_eq!(files_of(&folder.path().join("a.gdb")), before);
    assert_eq!(files_of(folder.path()), ["a.gdb", "points.xyz"]);
}

#[test]
fn what_fails_leaves_nothing() {
    let folder = surface();
    // A file of GPX has no lines in meters: the driver refuses vertices beyond 180 degrees.
    let run = run_verb(
        &folder,
        &["contour"],
        &["-of", "GPX", "-o", "a.gpx", "-o", "b.geojson"],
    );
    assert_ne!(run.code, 0, "{}", run.stderr);
    assert!(run.stderr.contains("a.gpx: "), "{}", run.stderr);
    assert!(run.stderr.contains("GDAL: "), "{}", run.stderr);
    assert!(!run.stderr.contains(".breakline-"), "{}", run.stderr);
    assert_eq!(files_of(folder.path()), ["points.xyz"]);
}

#[test]
fn a_height_that_a_record_lacks_is_not_zero() {
    let table = "WKT,Z\n\"LINESTRING (0 0,1 1)\",\n\"LINESTRING (2 0,3 1)\",7.5\n";
    let folder = folder_with(&[("a.csv", table), ("a.csvt", "\"String\",\"Real\"\n")]);
    let options = Options {
        height_field: Some("Z"),
        ..Options::default()
    };
    let layer = read_layer_with(&folder.path().join("a.csv"), &options, &|_| Ok(())).unwrap();
    let heights = |shape: &Shape| shape.vertices().map(|p| p[2]).collect::<Vec<f64>>();
    assert!(heights(&layer.shapes[0]).iter().all(|z| z.is_nan()));
    assert_eq!(heights(&layer.shapes[1]), [7.5, 7.5]);
    assert_eq!(layer.warnings.len(), 1, "{:?}", layer.warnings);
}
