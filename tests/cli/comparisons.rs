//! The difference of two surfaces as it is typed.

use serde_json::Value;
use tempfile::TempDir;

use super::{SLOPE, files_of, folder_with, run_in};

/// Ground one unit lower than [`SLOPE`] in the west, two in the east.
const LOWER: &str = "0 0 9\n3 0 11\n3 3 11\n0 3 9\n";

#[track_caller]
fn of(folder: &TempDir, words: &[&str]) -> Value {
    let run = run_in(folder, &[&["compare", "--json"], words].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    serde_json::from_str(&run.stdout).unwrap()
}

#[track_caller]
fn near(found: &Value, expected: f64) {
    let found = found.as_f64().unwrap_or(f64::NAN);
    assert!((found - expected).abs() <= 1e-6, "{found} for {expected}");
}

#[test]
fn statistics_places_and_cells_are_those_of_the_difference() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("b.xyz", LOWER)]);
    let found = of(
        &folder,
        &[
            "a.xyz",
            "b.xyz",
            "--resolution",
            "1",
            "--changed",
            "1.4",
            "-o",
            "d.tif",
        ],
    );
    // One rises by 1 for each column, the other by two thirds.
    assert_eq!(found["cells"], 9);
    near(&found["mean"], 1.5);
    near(&found["median"], 1.5);
    near(&found["max"], 1.0 + 2.5 / 3.0);
    near(&found["min"], 1.0 + 0.5 / 3.0);
    assert_eq!(found["changed"]["raised_cells"], 6);
    assert_eq!(found["changed"]["lowered_cells"], 0);
    near(&found["changed"]["raised_area"], 6.0);
    let worst = &found["worst"][0];
    near(&worst["difference"], 1.0 + 2.5 / 3.0);
    assert_eq!(
        (worst["x"].as_f64(), worst["y"].as_f64()),
        (Some(2.5), Some(2.5))
    );
    assert_eq!(found["worst"].as_array().unwrap().len(), 1);
    // The same from a DEM of each, and from one of each kind.
    for name in ["a", "b"] {
        let (points, dem) = (format!("{name}.xyz"), format!("{name}.tif"));
        run_in(&folder, &["dem", &points, "--resolution", "1", "-o", &dem]).works(&[]);
    }
    for pair in [["a.tif", "b.tif"], ["a.tif", "b.xyz"], ["a.xyz", "b.tif"]] {
        let other = of(&folder, &pair);
        assert_eq!(other["cells"], 9);
        near(&other["mean"], 1.5);
        near(&other["max"], 1.0 + 2.5 / 3.0);
    }
    // The difference is a DEM.
    let zero = of(&folder, &["d.tif", "d.tif"]);
    assert_eq!(
        (&zero["rmse"], &zero["worst"]),
        (&0.0.into(), &Value::Array(vec![]))
    );
    run_in(
        &folder,
        &["contour", "d.tif", "--levels", "1.5", "-o", "c.geojson"],
    )
    .works(&[]);
    let text = run_in(&folder, &["compare", "a.tif", "b.tif", "--changed", "1.4"]);
    text.works(&[]);
    for words in ["mean", "raised", "largest at"] {
        assert!(text.stdout.contains(words), "{}", text.stdout);
    }
}

#[test]
fn a_raster_of_other_cells_is_a_surface_between_their_centers() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    for (name, resolution) in [("fine.tif", "0.25"), ("coarse.tif", "1")] {
        let dem = ["dem", "a.xyz", "--resolution", resolution, "-o", name];
        run_in(&folder, &dem).works(&[]);
    }
    let found = of(&folder, &["fine.tif", "coarse.tif"]);
    // On a plane these are heights of the ground. Of 12 rows and columns, 8 are between centers.
    assert_eq!(found["cells"], 64);
    near(&found["rmse"], 0.0);
}

/// [`SLOPE`] with a mound of 2 on it, and a pit of 3.
const WORKED: &str = "0 0 10\n10 0 10\n10 10 10\n0 10 10\n2 2 10\n3 3 12\n4 2 10\n3 1 10\n2 4 10\n\
    3 5 10\n4 4 10\n6 7 10\n7 8 7\n8 7 10\n7 6 10\n6 9 10\n7 10 10\n8 9 10\n";
const FLAT: &str = "0 0 10\n10 0 10\n10 10 10\n0 10 10\n";

#[test]
fn areas_that_differ_are_written_as_polygons() {
    let folder = folder_with(&[("new.xyz", WORKED), ("old.xyz", FLAT)]);
    let words = [
        "new.xyz",
        "old.xyz",
        "--resolution",
        "1",
        "--changed",
        "0.5",
        "--a-srs",
        "EPSG:25832",
    ];
    let with = |more: &[&'static str]| [&words[..], more].concat();
    let found = of(
        &folder,
        &with(&[
            "-o",
            "d.tif",
            "-o",
            "c.geojson",
            "-o",
            "c.shp",
            "-o",
            "c.dxf",
        ]),
    );
    let areas = &found["areas"];
    let rows = areas["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    let keys: Vec<[&Value; 3]> = rows
        .iter()
        .map(|row| ["change", "x", "y"].map(|key| &row[key]))
        .collect();
    let [pit, mound] = [["7.0", "8.0"], ["3.0", "3.0"]].map(|at| at.map(|c| c.parse::<f64>()));
    let number = |c: &Result<f64, _>| Value::from(*c.as_ref().unwrap());
    assert_eq!(
        keys[0],
        [&"lowered".into(), &number(&pit[0]), &number(&pit[1])]
    );
    assert_eq!(
        keys[1],
        [&"raised".into(), &number(&mound[0]), &number(&mound[1])]
    );
    near(&rows[0]["largest"], -3.0);
    assert_eq!(
        (&areas["unit"], &found["height_unit"]),
        (&Value::from("m3"), &Value::from("m"))
    );
    // The same in the files, of which one is read as polygons again.
    let text = std::fs::read_to_string(folder.path().join("c.geojson")).unwrap();
    let written: Value = serde_json::from_str(&text).unwrap();
    let features = written["features"].as_array().unwrap();
    assert_eq!(features.len(), 2);
    for (feature, row) in features.iter().zip(rows) {
        assert_eq!(feature["geometry"]["type"], "Polygon");
        assert_eq!(feature["properties"]["CHANGE"], row["change"]);
        assert_eq!(feature["properties"]["AREA"], row["area"]);
        assert_eq!(feature["properties"]["LARGEST_X"], row["x"]);
    }
    for file in ["c.shp", "c.geojson"] {
        let within = [
            "volume",
            "new.xyz",
            "old.xyz",
            "--within",
            file,
            "--name-by",
            "change",
            "--a-srs",
            "EPSG:25832",
            "--json",
        ];
        let run = run_in(&folder, &within);
        assert_eq!(run.code, 0, "{}", run.stderr);
        let volumes: Value = serde_json::from_str(&run.stdout).unwrap();
        let names = [0, 1].map(|row| &volumes["rows"][row]["name"]);
        assert_eq!(names, ["lowered", "raised"]);
        near(
            &volumes["rows"][0]["fill"],
            rows[0]["volume"].as_f64().unwrap(),
        );
        near(
            &volumes["rows"][1]["cut_area"],
            rows[1]["area"].as_f64().unwrap(),
        );
    }
    let drawing = std::fs::read_to_string(folder.path().join("c.dxf")).unwrap();
    assert_eq!(drawing.matches("POLYLINE").count(), 2);
    assert!(folder.path().join("d.tif").exists());
    // Smaller ones are left out, and text has sums and units.
    let fewer = run_in(
        &folder,
        &[&["compare"], &with(&["--min-area", "3.4"])[..]].concat(),
    );
    fewer.works(&[]);
    for words in [
        "0 polygons, area 0 m2, volume 0 m3",
        "1 smaller polygons",
        " m at ",
    ] {
        assert!(fewer.stdout.contains(words), "{words}: {}", fewer.stdout);
    }
    // Where nothing differs by as much, a file has no polygons.
    let none = [
        "compare",
        "new.xyz",
        "old.xyz",
        "--resolution",
        "1",
        "--changed",
        "9",
    ];
    run_in(
        &folder,
        &[&none[..], &["-o", "none.geojson", "-o", "none.shp"]].concat(),
    )
    .works(&[]);
    let text = std::fs::read_to_string(folder.path().join("none.geojson")).unwrap();
    let written: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(written["features"], Value::Array(vec![]));
}

#[test]
fn what_makes_no_sense_is_refused_and_nothing_is_written() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("far.xyz", "90 90 1\n99 90 1\n90 99 1\n")]);
    run_in(
        &folder,
        &["dem", "a.xyz", "--resolution", "1", "-o", "a.tif"],
    )
    .works(&[]);
    for (system, name) in [("EPSG:25832", "m.ply"), ("EPSG:2056", "u.ply")] {
        let tin = ["tin", "a.xyz", "--a-srs", system, "-o", name];
        run_in(&folder, &tin).works(&[]);
    }
    let wrong: &[(&[&str], i32, &[&str])] = &[
        (
            &["a.xyz"],
            2,
            &[
                "a.xyz: there is nothing to compare it with",
                "second surface",
            ],
        ),
        (
            &["a.xyz", "a.tif", "far.xyz"],
            2,
            &["far.xyz: a third surface"],
        ),
        (&["a.xyz", "none.tif"], 1, &["none.tif: no such file"]),
        (
            &["a.tif", "a.xyz", "--resolution", "2"],
            2,
            &["a DEM keeps its own cells"],
        ),
        (
            &["a.xyz", "far.xyz", "--resolution", "0"],
            2,
            &["--resolution"],
        ),
        (&["a.xyz", "far.xyz", "--changed", "-1"], 2, &["--changed"]),
        (&["a.xyz", "far.xyz", "--min-area", "1"], 2, &["--changed"]),
        (
            &["a.xyz", "far.xyz", "--changed", "1", "--min-area", "-1"],
            2,
            &["--min-area"],
        ),
        (
            &["a.xyz", "far.xyz", "-o", "c.shp"],
            2,
            &["c.shp", "--changed HEIGHT"],
        ),
        (
            &[
                "a.xyz",
                "far.xyz",
                "--changed",
                "1",
                "-o",
                "c.shp",
                "--method",
                "natural",
            ],
            2,
            &["another method has none", "--method"],
        ),
        (
            &["a.tif", "a.tif", "--method", "nearest"],
            2,
            &["--method is for a TIN", "leave it out"],
        ),
        (
            &["a.xyz", "far.xyz", "--resolution", "1", "-o", "d.tif"],
            2,
            &["a.xyz and far.xyz do not overlap", "compare their extents"],
        ),
        (
            &["a.xyz", "a.xyz", "--resolution", "1000"],
            2,
            &[
                "no center of a cell is on both a.xyz and a.xyz",
                "smaller cells with --resolution",
            ],
        ),
        (&["a.xyz", "a.tif", "-o", "a.tif"], 2, &["a.tif"]),
        (&["a.xyz", "a.tif", "-o", "d.ply"], 2, &["d.ply"]),
        (&["m.ply", "u.ply"], 1, &["two coordinate systems"]),
        (
            &["a.xyz", "a.tif", "--crossing-report", "r.csv"],
            2,
            &["leave out --crossing-report"],
        ),
    ];
    let before = files_of(folder.path());
    for (words, code, said) in wrong {
        run_in(&folder, &[&["compare"], *words].concat()).fails(*code, said);
    }
    assert_eq!(files_of(folder.path()), before);
}
