//! Surfaces of fewer vertices, as they are typed.

use std::fmt::Write;

use super::{SLOPE, bytes, fixture, folder_with, geojson, run_in};

/// A hill of 40 x 40 points, 1 apart, in whole decimetres.
fn hill(order: impl Fn(usize) -> usize) -> String {
    let mut text = String::new();
    for k in (0..1600).map(order) {
        let [x, y] = [k % 40, k / 40];
        let z = (100.0 * (x as f64 / 9.0).sin() * (y as f64 / 7.0).cos()).round() / 10.0;
        writeln!(text, "{x} {y} {z}").unwrap();
    }
    text
}

#[test]
fn points_tins_and_dems_are_simplified_within_a_bound_that_is_printed() {
    let folder = folder_with(&[("hill.xyz", &hill(|k| k))]);
    run_in(
        &folder,
        &["tin", "hill.xyz", "--max-error", "0.5", "-o", "a.tin"],
    )
    .works(&[
        "note: simplified to ",
        " of 1600 vertices: all heights are within 0.5 units, the largest error is 0.4",
        "the root mean square 0.",
        "points      1600 read, 1600 used",
    ]);
    let check = run_in(&folder, &["check", "a.tin"]);
    assert!(check.stdout.contains("no flaw found"), "{}", check.stdout);
    run_in(&folder, &["tin", "hill.xyz", "-o", "whole.ply"]).works(&[]);
    run_in(
        &folder,
        &["simplify", "whole.ply", "--max-error", "0.5", "-o", "b.tin"],
    )
    .works(&["note: simplified to "]);
    run_in(
        &folder,
        &["dem", "hill.xyz", "--resolution", "1", "-o", "dem.tif"],
    )
    .works(&[]);
    run_in(
        &folder,
        &["tin", "dem.tif", "--max-error", "0.5", "-o", "c.tin"],
    )
    .works(&["simplified to ", " of 1521 vertices"]);
    // Twice, of whole inputs and outputs by position.
    run_in(
        &folder,
        &["simplify", "dem.tif", "d.ply", "--target", "100"],
    )
    .works(&["simplified to ", " of 1521 vertices", "written     d.ply"]);
    let volume = run_in(&folder, &["volume", "c.tin", "dem.tif", "--json"]);
    assert_eq!(volume.code, 0, "{}", volume.stderr);
}

#[test]
fn neither_order_nor_threads_show_in_the_bytes() {
    let folder = folder_with(&[
        ("a.xyz", &hill(|k| k)),
        ("b.xyz", &hill(|k| (k * 7 + 3) % 1600)),
    ]);
    let make = |input: &str, threads: &str, output: &str| {
        let words = [
            "tin",
            input,
            "--max-error",
            "0.3",
            "--threads",
            threads,
            "-o",
            output,
        ];
        run_in(&folder, &words).works(&["simplified"]);
        bytes(&folder, output)
    };
    let first = make("a.xyz", "1", "a1.tin");
    assert!(first == make("a.xyz", "2", "a2.tin"));
    assert!(first == make("b.xyz", "3", "b3.tin"));
}

#[test]
fn lines_are_counted_and_a_tolerance_of_theirs_is_kept_to() {
    let line: Vec<String> = (4..70)
        .map(|k| {
            format!(
                "[{},{},12]",
                f64::from(k) / 2.0,
                20.0 + f64::from(k % 2) / 8.0
            )
        })
        .collect();
    let line = format!("[{}]", line.join(","));
    let folder = folder_with(&[
        ("a.xyz", &hill(|k| k)),
        ("line.geojson", &geojson(25832, "LineString", &line)),
    ]);
    let simplified = |tolerance: &[&str], output: &str| {
        let words = [
            "tin",
            "a.xyz",
            "--breaklines",
            "line.geojson",
            "--max-error",
            "2",
        ];
        run_in(&folder, &[&words, tolerance, &["-o", output]].concat())
    };
    simplified(&[], "a.tin").works(&["of 66 on lines"]);
    simplified(&["--line-tolerance", "0"], "b.tin").works(&["66 of 66 on lines"]);
    simplified(&["--line-tolerance", "-1"], "c.tin").fails(2, &["-1 is not a tolerance of lines"]);
}

#[test]
fn limits_that_make_no_sense_are_refused_before_anything_is_written() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("row.xyz", "0 0 1\n1 0 1\n2 0 1\n")]);
    let refused = |words: &[&str], expected: &str| {
        let words = [words, &["-o", "t.tin"]].concat();
        run_in(&folder, &words).fails(2, &[expected]);
        assert!(!folder.path().join("t.tin").exists());
    };
    refused(
        &["tin", "a.xyz", "--max-error", "0"],
        "0 is not a bound of errors",
    );
    refused(
        &["tin", "a.xyz", "--max-error", "-1"],
        "-1 is not a bound of errors",
    );
    refused(&["tin", "a.xyz", "--max-error", "nan"], "nan");
    refused(
        &["tin", "a.xyz", "--target", "2"],
        "a surface of 2 vertices does not exist",
    );
    refused(
        &["tin", "a.xyz", "--target", "9", "--max-error", "1"],
        "cannot be used with",
    );
    refused(&["tin", "a.xyz", "--line-tolerance", "1"], "required");
    refused(&["simplify", "a.xyz"], "--max-error");
    run_in(
        &folder,
        &["tin", "a.xyz", "--max-error", "1", "-o", "t.tins"],
    )
    .fails(
        2,
        &["t.tins: a surface is simplified in one piece", "--bounds"],
    );
    let valley = fixture("valley.laz");
    run_in(
        &folder,
        &["dem", &valley, "--resolution", "5", "-o", "d.tif"],
    )
    .works(&[]);
    refused(&["tin", "d.tif"], "pass --max-error HEIGHT or --target N");
    refused(
        &["simplify", "d.tif", "--max-error", "1", "--class", "2"],
        "--class",
    );
    run_in(
        &folder,
        &["tin", "row.xyz", "--max-error", "1", "-o", "t.tin"],
    )
    .fails(1, &["do not span a surface"]);
}

#[test]
fn the_area_of_a_dem_with_missing_cells_stays() {
    let folder = folder_with(&[("hill.xyz", &hill(|k| k))]);
    let run = |line: &str| run_in(&folder, &line.split(' ').collect::<Vec<_>>());
    run("dem hill.xyz --resolution 1 --te=-6,-5,47,46 -o d.tif").works(&[]);
    run("tin d.tif --max-error 0.25 -o t.tin").works(&["of 1521 vertices", "within 0.25 units"]);
    let volume = run("volume t.tin d.tif --json");
    let row: serde_json::Value = serde_json::from_str(&volume.stdout).unwrap();
    let row = &row["rows"][0];
    // Each square of 38 by 38, and the corners of its triangles rounded.
    assert_eq!(row["common_area"], 1444.0, "{row}");
    for only in ["surface_only", "base_only"] {
        assert!(row[only].as_f64().unwrap() < 1e-9, "{row}");
    }
}
