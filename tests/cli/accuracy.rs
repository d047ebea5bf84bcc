//! `accuracy` as it is typed: statistics, classes, groups, and what is refused.

use serde_json::Value;

use super::{SLOPE, bytes, files_of, folder_with, run_in};

/// Checkpoints on the plane z = 10 + x: 0.1 and 0.3 below, 0.2 above, one outside.
const SURVEY: &str = "\
id,x,y,z,cover
a,1,1,10.9,road
b,2,2,11.7,road
c,0.5,0.5,10.7,forest
d,50,50,0,road
";

fn near(found: &Value, expected: f64) {
    let found = found.as_f64().unwrap();
    assert!((found - expected).abs() < 1e-12, "{found} for {expected}");
}

fn json(words: &[&str]) -> Value {
    let folder = folder_with(&[("a.xyz", SLOPE), ("s.csv", SURVEY)]);
    let base = ["accuracy", "a.xyz", "--checkpoints", "s.csv", "--json"];
    let run = run_in(&folder, &[&base, words].concat());
    assert!(run.code < 2, "{}", run.stderr);
    serde_json::from_str(&run.stdout).unwrap()
}

#[test]
fn differences_are_the_surface_minus_the_checkpoint() {
    let found = json(&[]);
    let all = &found["sets"][0];
    assert_eq!((&all["set"], &all["n"]), (&"all".into(), &3.into()));
    near(&all["mean"], 0.2 / 3.0);
    near(&all["median"], 0.1);
    near(&all["rmse"], (0.14_f64 / 3.0).sqrt());
    near(&all["accuracy"], (0.14_f64 / 3.0).sqrt());
    near(&all["nmad"], 1.4826 * 0.2);
    near(&all["min"], -0.2);
    near(&all["max"], 0.3);
    assert_eq!(found["class"], Value::Null);
    assert_eq!(found["unit"], Value::Null);
    let points = found["points"].as_array().unwrap();
    let lines: Vec<u64> = points.iter().map(|p| p["line"].as_u64().unwrap()).collect();
    assert_eq!(lines, [2, 3, 4, 5]);
    assert_eq!(points[3]["surface_z"], Value::Null);
    near(&points[1]["difference"], 0.3);
    let counts = found["histogram"]["counts"].as_array().unwrap();
    assert_eq!(counts.iter().filter_map(Value::as_u64).sum::<u64>(), 3);
}

#[test]
fn the_error_of_checkpoints_is_part_of_the_accuracy() {
    let found = json(&["--checkpoint-error", "5cm", "--accuracy-class", "22cm"]);
    near(&found["checkpoint_error"], 0.05);
    near(&found["sets"][0]["rmse"], (0.14_f64 / 3.0).sqrt());
    near(
        &found["sets"][0]["accuracy"],
        (0.14_f64 / 3.0 + 0.0025).sqrt(),
    );
    assert_eq!(found["class"]["is_met"], false);
    let found = json(&["--accuracy-class", "22cm"]);
    assert_eq!(found["class"]["is_met"], true);
    near(&found["class"]["limit"], 0.22);
}

#[test]
fn groups_have_statistics_and_vegetation_does_not_decide() {
    let groups = ["--group-by", "COVER"];
    let found = json(&groups);
    let sets = found["sets"].as_array().unwrap();
    let names: Vec<String> = sets
        .iter()
        .map(|set| format!("{} {} {}", set["set"], set["group"], set["n"]))
        .collect();
    assert_eq!(
        names,
        [
            r#""all" null 3"#,
            r#""group" "forest" 1"#,
            r#""group" "road" 2"#
        ]
    );
    let found = json(
        &[
            &groups[..],
            &["--vegetated", "forest", "--accuracy-class", "0.23"],
        ]
        .concat(),
    );
    near(&found["sets"][1]["rmse"], 0.05_f64.sqrt());
    near(&found["sets"][2]["rmse"], 0.2);
    assert_eq!(found["class"]["set"], "non-vegetated");
    assert_eq!(found["class"]["is_met"], true);
}

#[test]
fn a_report_for_people_names_what_is_outside_and_few() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("s.csv", SURVEY)]);
    let run = run_in(
        &folder,
        &[
            "accuracy",
            "a.xyz",
            "--checkpoints",
            "s.csv",
            "--accuracy-class",
            "10cm",
            "-o",
            "rows.csv",
            "--histogram",
            "bins.csv",
            "--group-by",
            "cover",
        ],
    );
    run.ends(
        1,
        &[
            "warning: s.csv: line 5: outside of the surface, and not counted",
            "warning: 3 checkpoints decide: the standard of ASPRS (2023) asks for at least 30",
            "note: no coordinate system states the unit of heights",
            "class 0.1 units: not met, accuracy 0.216 units by 3 checkpoints (all)",
            "NMAD",
        ],
    );
    let rows = String::from_utf8(bytes(&folder, "rows.csv")).unwrap();
    assert!(rows.starts_with("line,x,y,z,surface_z,difference,group\n2,1,1,10.9,11,0.0999"));
    assert!(rows.ends_with("5,50,50,0,,,road\n"), "{rows}");
    let bins = String::from_utf8(bytes(&folder, "bins.csv")).unwrap();
    assert!(bins.starts_with("from,to,count\n"), "{bins}");
}

#[test]
fn thirty_checkpoints_are_enough_and_layers_are_read() {
    let row = |i: usize| format!("{},{},{}\n", i as f64 / 10.0, 1, 10.0 + i as f64 / 10.0);
    let text: String = (0..30).map(row).collect();
    let folder = folder_with(&[("a.xyz", SLOPE), ("s.csv", &text)]);
    let base = ["accuracy", "a.xyz", "--checkpoints"];
    let run = run_in(
        &folder,
        &[&base[..], &["s.csv", "--accuracy-class", "1mm"]].concat(),
    );
    run.works(&[]);
    assert!(!run.stderr.contains("ASPRS"), "{}", run.stderr);
    assert!(
        run.stdout.contains("class 0.001 units: met"),
        "{}",
        run.stdout
    );
    let layer = super::geojson(25832, "Point", "[1, 1, 11.5]");
    std::fs::write(folder.path().join("s.geojson"), layer).unwrap();
    let words = ["s.geojson", "--json", "--group-by", "Z"];
    let run = run_in(&folder, &[&base[..], &words].concat());
    run.works(&[]);
    let found: Value = serde_json::from_str(&run.stdout).unwrap();
    near(&found["sets"][0]["mean"], -0.5);
    assert_eq!(found["sets"][1]["group"], "11.5");
    assert_eq!(found["points"][0]["record"], 1);
    assert_eq!(found["unit"], "metre");
    let layer = super::geojson(25832, "Point", "[1, 1, 11.5]").replace("11.5}", "\"oak\"}");
    std::fs::write(folder.path().join("s.geojson"), layer).unwrap();
    let run = run_in(
        &folder,
        &[&base[..], &["s.geojson", "--json", "--group-by", "z"]].concat(),
    );
    let found: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(found["sets"][1]["group"], "oak");
    let words = ["s.geojson", "--group-by", "cover"];
    run_in(&folder, &[&base[..], &words].concat())
        .fails(2, &["s.geojson: there is no field cover", "name one of Z"]);
}

#[test]
fn the_columns_that_are_read_are_named() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("two.csv", "id,x,y,height,elev\n1,1,1,11,5\n"),
    ]);
    run_in(&folder, &["tin", "a.xyz", "-o", "a.tin"]).works(&[]);
    let words = [
        "accuracy",
        "a.tin",
        "--checkpoints",
        "two.csv",
        "--columns",
        "2,3,4",
    ];
    run_in(&folder, &words).works(&["columns     x 2, y 3, z 4"]);
}

#[test]
fn bad_input_is_refused_and_nothing_is_written() {
    let flat = super::geojson(25832, "Point", "[1, 1]");
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("s.csv", SURVEY),
        ("far.csv", "500,500,1\n"),
        ("plain.csv", "1,1,1\n"),
        ("nan.csv", "1,1,1\n1,1,nan\n"),
        ("flat.geojson", &flat),
        ("empty.csv", "x,y,z\n"),
        ("two.csv", "id,x,y,height,elev\n1,1,1,11,5\n"),
        ("none.csv", "x,y,height\n"),
    ]);
    let before = files_of(folder.path());
    for (points, words, code, message) in [
        (
            "far.csv",
            &[][..],
            2,
            "far.csv: the only point is outside of a.xyz",
        ),
        ("nan.csv", &[], 1, "nan.csv: line 2: z is \"nan\""),
        ("empty.csv", &[], 1, "empty.csv: the file has no points"),
        (
            "two.csv",
            &[],
            1,
            "two.csv: line 1: columns 4 (\"height\") and 5 (\"elev\") all have names of heights",
        ),
        (
            "flat.geojson",
            &[],
            1,
            "flat.geojson: record 1: the checkpoint has no height",
        ),
        (
            "s.csv",
            &["--group-by", "kind"],
            2,
            "s.csv: there is no column kind",
        ),
        (
            "plain.csv",
            &["--group-by", "kind"],
            2,
            "there is no column kind",
        ),
        (
            "s.csv",
            &["--group-by", "cover", "--vegetated", "trees"],
            2,
            "no checkpoint is in the group trees",
        ),
        (
            "s.csv",
            &[
                "--group-by",
                "cover",
                "--vegetated",
                "forest,road",
                "--accuracy-class",
                "1m",
            ],
            2,
            "no checkpoint outside of vegetation",
        ),
        ("missing.csv", &[], 1, "missing.csv: no such file"),
    ] {
        let base = ["accuracy", "a.xyz", "--checkpoints", points, "-o", "o.csv"];
        let run = run_in(&folder, &[&base, words].concat());
        run.fails(code, &[message]);
        assert_eq!(files_of(folder.path()), before, "{points}");
    }
    let words = [
        "accuracy",
        "a.xyz",
        "--checkpoints",
        "s.csv",
        "--accuracy-class",
        "1km",
    ];
    let run = run_in(&folder, &words);
    assert_eq!(run.code, 2, "{}", run.stderr);
    let words = [&words[..4], &["--checkpoint-error", "-1cm"]].concat();
    run_in(&folder, &words).ends(2, &["expected a length that is not negative"]);
}

#[test]
fn withheld_points_are_no_checkpoints() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let points = [([1.0, 1.0, 99.0], 2), ([1.0, 2.0, 10.5], 2)];
    let mut file = testkit::lidar::las(&points, None);
    let path = folder.path().join("s.las");
    // The byte of class and flags.
    let first = file.len() - 2 * 20 + 15;
    file[first] |= 0x80;
    std::fs::write(&path, &file).unwrap();
    let base = ["accuracy", "a.xyz", "--checkpoints", "s.las"];
    let run = run_in(&folder, &[&base[..], &["--json"]].concat());
    run.works(&["warning: 1 checkpoint decides: "]);
    let found: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(found["sets"][0]["n"], 1);
    near(&found["sets"][0]["mean"], 0.5);
    assert_eq!(found["points"][0]["point"], 2);
    file[first + 20] |= 0x80;
    std::fs::write(&path, &file).unwrap();
    run_in(&folder, &base).fails(1, &["s.las: all points are withheld"]);
}
