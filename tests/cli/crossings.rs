//! Breaklines that cross, through the program.

use super::*;

/// Two features that cross at (1.5, 1.5), one of two parts, at heights 20 and 30.5; the second's
/// other part meets the first's vertex at (3, 3), which lies at 20, with 21.
const CROSSING: [&str; 2] = [
    r#"{"type":"LineString","coordinates":[[0,0,20],[3,3,20]]}"#,
    r#"{"type":"MultiLineString","coordinates":[[[3,0,30],[0,3,31]],[[3,3,21],[2.5,3,21]]]}"#,
];

fn layer(geometries: &[&str]) -> String {
    let features: Vec<String> = geometries
        .iter()
        .map(|g| format!(r#"{{"type":"Feature","properties":{{}},"geometry":{g}}}"#))
        .collect();
    let crs = r#"{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::25832"}}"#;
    format!(
        r#"{{"type":"FeatureCollection","crs":{crs},"features":[{}]}}"#,
        features.join(",")
    )
}

/// In one file.
fn folder() -> TempDir {
    folder_with(&[("p.xyz", SLOPE), ("l.geojson", &layer(&CROSSING))])
}

/// The height where the lines cross, read off an .obj.
fn height_at_crossing(folder: &TempDir, options: &[&str]) -> String {
    let args = ["tin", "p.xyz", "-o", "t.obj", "--overwrite"];
    run_in(folder, &[&args, options].concat()).works(&[]);
    let text = String::from_utf8(bytes(folder, "t.obj")).unwrap();
    let vertex = text
        .lines()
        .find_map(|line| line.strip_prefix("v 1.5 1.5 "))
        .unwrap();
    vertex.to_owned()
}

#[test]
fn the_height_at_a_crossing_goes_by_the_rule() {
    let [first, second] = CROSSING.map(|line| layer(&[line]));
    let folder = folder_with(&[
        ("p.xyz", SLOPE),
        ("a.geojson", &first),
        ("b.geojson", &second),
    ]);
    for (rule, ab, ba) in [
        ("lowest", "20", "20"),
        ("highest", "30.5", "30.5"),
        ("mean", "25.25", "25.25"),
        ("first", "20", "30.5"),
        ("last", "30.5", "20"),
    ] {
        let height = |a, b| {
            height_at_crossing(
                &folder,
                &["--breaklines", a, "--breaklines", b, "--crossing-z", rule],
            )
        };
        assert_eq!(
            (
                height("a.geojson", "b.geojson"),
                height("b.geojson", "a.geojson")
            ),
            (ab.into(), ba.into()),
            "{rule}"
        );
    }
    assert_eq!(
        height_at_crossing(
            &folder,
            &["--breaklines", "a.geojson", "--breaklines", "b.geojson"]
        ),
        "20"
    );
}

#[test]
fn lines_that_differ_in_height_are_told_by_file_and_feature() {
    let folder = folder();
    let run = run_in(
        &folder,
        &["tin", "p.xyz", "--breaklines", "l.geojson", "-o", "t.ply"],
    );
    run.works(&[
        "note: crossings of breaklines are rounded to 4.4e-16 m; no line moves by more than half of that",
        "warning: breaklines meet with different heights at 2 points, by up to 10.5 m (at 1.5 1.5)",
        "1.5 1.5: 20 of l.geojson record 1, 30.5 of l.geojson record 2, part 1; 20 is used",
        "3 3: 20 of l.geojson record 1, 21 of l.geojson record 2, part 2; 20 is used",
        "1 crossings between vertices",
    ]);
    let tolerant = [
        "dem",
        "p.xyz",
        "--breaklines",
        "l.geojson",
        "-o",
        "t.tif",
        "--crossing-tolerance",
        "10.5",
    ];
    let run = run_in(&folder, &tolerant);
    run.works(&["note: crossings of breaklines"]);
    assert!(!run.stderr.contains("different heights"), "{}", run.stderr);
}

#[test]
fn the_report_has_every_place_and_is_written_by_every_verb() {
    let folder = folder();
    let expected = "x,y,z,vertex,difference,low_file,low_fid,low_part,low_z,high_file,high_fid,high_part,high_z\n\
        1.5,1.5,20,added,10.5,l.geojson,0,1,20,l.geojson,1,1,30.5\n\
        3,3,20,given,1,l.geojson,0,1,20,l.geojson,1,2,21\n";
    for (verb, out) in [
        ("tin", "t.ply"),
        ("dem", "t.tif"),
        ("contour", "t.shp"),
        ("hillshade", "s.png"),
        ("check", ""),
    ] {
        let report = format!("{verb}.csv");
        let mut args = vec![
            verb,
            "p.xyz",
            "--breaklines",
            "l.geojson",
            "--crossing-report",
            &report,
        ];
        if !out.is_empty() {
            args.extend(["-o", out]);
        }
        run_in(&folder, &args).works(&[&format!("written     {report}")]);
        assert_eq!(
            String::from_utf8(bytes(&folder, &report)).unwrap(),
            expected,
            "{verb}"
        );
        if out.is_empty() {
            run_in(&folder, &args).fails(1, &["check.csv: the file exists", "--overwrite"]);
            args.push("--overwrite");
            run_in(&folder, &args).works(&[]);
        }
    }
    let none = ["check", "p.xyz", "--crossing-report", "none.csv"];
    run_in(&folder, &none).works(&[]);
    assert_eq!(
        bytes(&folder, "none.csv"),
        expected
            .lines()
            .next()
            .map(|line| format!("{line}\n"))
            .unwrap()
            .as_bytes()
    );
}

#[test]
fn what_is_refused_names_both_lines_and_leaves_nothing() {
    let folder = folder();
    let before = files_of(folder.path());
    let args = [
        "tin",
        "p.xyz",
        "--breaklines",
        "l.geojson",
        "-o",
        "t.ply",
        "--crossing-report",
        "r.csv",
    ];
    let run = |options: &[&str]| run_in(&folder, &[&args, options].concat());
    run(&["--on-crossing", "reject"]).fails(
        1,
        &[
            "l.geojson record 1 and l.geojson record 2, part 1 cross at 1.5 1.5 without a common vertex",
            "--on-crossing split",
        ],
    );
    run(&["--crossing-z", "error"]).fails(
        1,
        &[
            "different heights at 1.5 1.5: 20 of l.geojson record 1, 30.5 of l.geojson record 2, part 1, expected within 0.01",
            "(2 such sites in total)",
        ],
    );
    run(&["--crossing-z", "error", "--crossing-tolerance", "-1"]).fails(2, &["-1 is below zero"]);
    run(&["--crossing-report", "r.csv"]).fails(2, &["--crossing-report"]);
    assert_eq!(files_of(folder.path()), before);
    run(&["--crossing-z", "error", "--crossing-tolerance", "11"]).works(&[]);
    run_in(&folder, &["check", "t.ply", "--crossing-z", "mean"])
        .fails(2, &["--crossing-z is for building a TIN"]);
    run_in(&folder, &["check", "p.xyz", "--crossing-report", "r.txt"])
        .fails(2, &["`.txt` is not a format", ".csv"]);
    run_in(
        &folder,
        &["check", "p.xyz", "--crossing-report", "no/r.csv"],
    )
    .fails(1, &["the folder does not exist"]);
}

#[test]
fn a_line_keeps_its_name_where_bounds_cut_it_into_runs() {
    let folder = folder_with(&[
        ("p.xyz", SLOPE),
        // Out of the window and in again, where it is crossed.
        (
            "a.geojson",
            &layer(&[
                r#"{"type":"LineString","coordinates":[[0,1.5,9],[900,1.5,9],[900,900,9],[900,2.5,9],[0,2.5,9]]}"#,
            ]),
        ),
        (
            "b.geojson",
            &layer(&[r#"{"type":"LineString","coordinates":[[1.5,2.2,5],[1.5,2.8,5]]}"#]),
        ),
    ]);
    let lines = ["--breaklines", "a.geojson", "--breaklines", "b.geojson"];
    let run = run_in(
        &folder,
        &[&["check", "p.xyz", "--bounds", "0,0,3,3"][..], &lines].concat(),
    );
    run.works(&["1.5 2.5: 5 of b.geojson record 1, 9 of a.geojson record 1; 5 is used"]);
}
