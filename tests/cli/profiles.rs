//! Profiles and cross-sections as they are typed.

use serde_json::Value;
use tempfile::TempDir;

use super::{Run, SLOPE, bytes, files_of, folder_with, geojson, run_in};

/// The corners of a rectangle at 11, which overlaps [`SLOPE`] from 1 to 3.
const FLAT: &str = "1 0 11\n5 0 11\n5 3 11\n1 3 11\n";

fn folder() -> TempDir {
    folder_with(&[
        ("a.xyz", SLOPE),
        ("b.xyz", FLAT),
        (
            "l.geojson",
            &geojson(25832, "LineString", "[[0.5,1.5],[4.5,1.5]]"),
        ),
    ])
}

#[track_caller]
fn json(run: &Run) -> Value {
    assert_eq!(run.code, 0, "{}", run.stderr);
    serde_json::from_str(&run.stdout).unwrap()
}

fn of(folder: &TempDir, words: &[&str]) -> Value {
    json(&run_in(folder, &[&["profile", "--json"], words].concat()))
}

/// The points of a surface in a profile: stretches of distance, x, y, z.
fn points(profile: &Value, surface: usize) -> Vec<Vec<[f64; 4]>> {
    serde_json::from_value(profile["surfaces"][surface].clone()).unwrap()
}

#[test]
fn several_surfaces_have_their_heights_and_their_gaps() {
    let folder = folder();
    let run = run_in(
        &folder,
        &[
            "profile",
            "a.xyz",
            "b.xyz",
            "--along",
            "l.geojson",
            "--json",
        ],
    );
    run.works(&[
        "warning: l.geojson: record 1: only in part on a.xyz",
        "warning: l.geojson: record 1: only in part on b.xyz",
    ]);
    let found = json(&run);
    assert_eq!(
        (&found["unit"], &found["height_unit"]),
        (&"m".into(), &"m".into())
    );
    assert_eq!(found["surfaces"], serde_json::json!(["a.xyz", "b.xyz"]));
    let profile = &found["profiles"][0];
    assert_eq!(
        (&profile["from"], &profile["to"], &profile["record"]),
        (&0.0.into(), &4.0.into(), &1.into())
    );
    let [slope, flat] = [0, 1].map(|surface| points(profile, surface).concat());
    assert!(
        slope
            .iter()
            .all(|[d, x, _, z]| (x - d - 0.5).abs() < 1e-15 && (z - 10.0 - x).abs() < 1e-14)
    );
    assert_eq!([slope[0][0], slope[slope.len() - 1][0]], [0.0, 2.5]);
    assert_eq!(
        [flat[0], flat[flat.len() - 1]],
        [[0.5, 1.0, 1.5, 11.0], [4.0, 4.5, 1.5, 11.0]]
    );
    // By a step: multiples of it, and ends.
    let found = of(&folder, &["a.xyz", "--along", "l.geojson", "--step", "1"]);
    let distances: Vec<f64> = points(&found["profiles"][0], 0)
        .concat()
        .iter()
        .map(|p| p[0])
        .collect();
    assert_eq!(distances, [0.0, 1.0, 2.0, 2.5]);
}

#[test]
fn tables_plots_and_drawings_are_written_together() {
    let folder = folder();
    let words = [
        "profile",
        "a.xyz",
        "b.xyz",
        "--along",
        "l.geojson",
        "-o",
        "t.csv",
        "-o",
        "t.svg",
        "-o",
        "t.dxf",
        "--title",
        "A < B & \"C\"",
        "--exaggeration",
        "2",
        "--datum",
        "8",
    ];
    let run = run_in(&folder, &words);
    run.works(&[
        "written     t.csv",
        "written     t.svg",
        "written     t.dxf",
    ]);
    assert!(
        run.stdout
            .starts_with("record 1, 4 m\n  a.xyz: 2.5 m on it, heights 10.5 .. 13 m, "),
        "{}",
        run.stdout
    );
    let table = String::from_utf8(bytes(&folder, "t.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(
        rows[0].join(","),
        "record,part,station,surface,stretch,distance,x,y,z"
    );
    assert_eq!(
        rows[1],
        ["1", "", "", "a.xyz", "1", "0", "0.5", "1.5", "10.5"]
    );
    assert_eq!(
        rows[rows.len() - 1],
        ["1", "", "", "b.xyz", "1", "4", "4.5", "1.5", "11"]
    );
    let plot = String::from_utf8(bytes(&folder, "t.svg")).unwrap();
    for part in [
        "A &lt; B &amp; &quot;C&quot;",
        "vertical exaggeration 2 : 1, datum 8 m",
        "record 1",
        ">a.xyz</text>",
        "height [m]",
    ] {
        assert!(plot.contains(part), "{part}: {plot}");
    }
    assert_eq!(plot.matches("<polyline class=\"ground\"").count(), 2);
    let drawing = String::from_utf8(bytes(&folder, "t.dxf")).unwrap();
    assert!(drawing.contains("\nB_XYZ\n") && drawing.ends_with("0\nEOF\n"));
    // None is replaced by accident, and none is written if one cannot be.
    let again = [
        "profile",
        "a.xyz",
        "--along",
        "l.geojson",
        "-o",
        "new.csv",
        "-o",
        "t.svg",
    ];
    run_in(&folder, &again).fails(1, &["t.svg", "--overwrite"]);
    let wrong = [
        "profile",
        "a.xyz",
        "--along",
        "l.geojson",
        "-o",
        "new.csv",
        "-o",
        "new.svg",
        "--datum",
        "12",
    ];
    run_in(&folder, &wrong).fails(
        2,
        &[
            "new.svg: a datum of 12 is above the lowest height of record 1, 10.5",
            "--datum",
        ],
    );
    assert!(
        !files_of(folder.path())
            .iter()
            .any(|name| name.contains("new"))
    );
}

#[test]
fn sections_are_across_the_axis_at_its_stations() {
    let folder = folder();
    let axis = geojson(25832, "LineString", "[[0.5,1],[2.5,1]]");
    std::fs::write(folder.path().join("axis.geojson"), axis).unwrap();
    let words = [
        "a.xyz",
        "--along",
        "axis.geojson",
        "--left",
        "1",
        "--right",
        "0.5",
    ];
    let found = of(
        &folder,
        &[&words[..], &["--interval", "1", "--start", "99.5"]].concat(),
    );
    let profiles = found["profiles"].as_array().unwrap();
    let stations: Vec<(f64, &str)> = profiles
        .iter()
        .map(|profile| {
            (
                profile["station"].as_f64().unwrap(),
                profile["name"].as_str().unwrap(),
            )
        })
        .collect();
    assert_eq!(stations, [(100.0, "0+100"), (101.0, "0+101")]);
    for (profile, x) in profiles.iter().zip([1.0, 2.0]) {
        assert_eq!(
            (&profile["from"], &profile["to"]),
            (&(-1.0).into(), &0.5.into())
        );
        let points = points(profile, 0).concat();
        assert_eq!(
            [points[0], points[points.len() - 1]],
            [[-1.0, x, 2.0, 10.0 + x], [0.5, x, 0.5, 10.0 + x]]
        );
        assert!(points.iter().any(|p| p[0] == 0.0));
    }
    let listed = [
        &words[..],
        &[
            "--stations",
            "0,0.25,2",
            "--station-format",
            "0.00",
            "--angle",
            "45",
        ],
    ]
    .concat();
    let found = of(&folder, &listed);
    assert_eq!(found["profiles"][1]["name"], "0.25");
    let first = points(&found["profiles"][0], 0).concat()[0];
    assert!(
        (first[1] - 0.5 - 0.5f64.sqrt()).abs() < 1e-15 && first[0] == -1.0,
        "{first:?}"
    );
    // Sections at the inside of a bend.
    let bend = geojson(25832, "LineString", "[[0,1],[2,1],[2,3]]");
    std::fs::write(folder.path().join("bend.geojson"), bend).unwrap();
    let words = [
        "profile",
        "a.xyz",
        "--along",
        "bend.geojson",
        "--interval",
        "1.9",
        "--left",
        "1.9",
        "-o",
        "s.svg",
    ];
    run_in(&folder, &words)
        .works(&["warning: bend.geojson: record 1: sections cross: 0+001.9 and 0+003.8"]);
    let plot = String::from_utf8(bytes(&folder, "s.svg")).unwrap();
    assert!(plot.contains("station 0+001.9") && plot.contains("negative to the left"));
}

#[test]
fn what_has_no_profile_is_an_error_and_writes_nothing() {
    let folder = folder();
    let far = geojson(25832, "LineString", "[[50,50],[60,60]]");
    std::fs::write(folder.path().join("far.geojson"), far).unwrap();
    let before = files_of(folder.path());
    let fails = |words: &[&str], code: i32, texts: &[&str]| {
        run_in(&folder, &[&["profile", "-o", "t.csv"], words].concat()).fails(code, texts);
    };
    let line = ["a.xyz", "--along", "l.geojson"];
    let and = |more: &[&'static str]| [&line[..], more].concat();
    fails(
        &["a.xyz", "--along", "far.geojson"],
        2,
        &["far.geojson: no line is on a.xyz"],
    );
    fails(&["--along", "l.geojson"], 2, &["required"]);
    fails(&["a.xyz"], 2, &["--along"]);
    fails(&and(&["--step", "-1"]), 2, &["-1 is not above zero"]);
    fails(&and(&["--interval", "1"]), 2, &["--left and --right"]);
    fails(&and(&["--left", "1"]), 2, &["--interval or --stations"]);
    fails(
        &and(&["--interval", "1", "--left", "0"]),
        2,
        &["one of them above zero"],
    );
    fails(
        &and(&["--interval", "1", "--left", "1", "--angle", "180"]),
        2,
        &["between 0 and 180"],
    );
    fails(
        &and(&["--interval", "1", "--stations", "1"]),
        2,
        &["cannot be used with"],
    );
    fails(
        &and(&["--interval", "1e-9", "--left", "1"]),
        1,
        &["sections along", "--interval"],
    );
    fails(
        &and(&["--interval", "70", "--start", "1", "--left", "1"]),
        2,
        &["no line has a station"],
    );
    fails(
        &and(&["--stations", "1,5", "--left", "1"]),
        2,
        &[
            "l.geojson: record 1: station 0+005 is beyond the line, which has 0+000 to 0+004",
            "--stations",
            "--start",
        ],
    );
    fails(
        &and(&["--stations", "1", "--left", "1", "--station-format", "km"]),
        2,
        &["0+000"],
    );
    run_in(
        &folder,
        &["profile", "a.xyz", "--along", "l.geojson", "-o", "t.tif"],
    )
    .fails(2, &["t.tif", ".csv, .svg, .dxf"]);
    let steep = [
        "profile",
        "a.xyz",
        "--along",
        "l.geojson",
        "-o",
        "t.svg",
        "--exaggeration",
        "1e6",
    ];
    run_in(&folder, &steep).fails(2, &["times as high as it is wide", "--exaggeration"]);
    // Other systems, and points without a height.
    std::fs::write(
        folder.path().join("other.geojson"),
        geojson(25833, "LineString", "[[0,1],[2,1]]"),
    )
    .unwrap();
    run_in(
        &folder,
        &["tin", "a.xyz", "--a-srs", "EPSG:25832", "-o", "a.ply"],
    )
    .works(&[]);
    fails(&["a.ply", "--along", "other.geojson"], 1, &["25833"]);
    for name in ["other.geojson", "a.ply"] {
        std::fs::remove_file(folder.path().join(name)).unwrap();
    }
    assert_eq!(files_of(folder.path()), before);
}

/// A rectangle from 0 to 20 at a height; its edges are oblique, so that few lines meet one at a
/// round distance.
fn plain(z: f64) -> String {
    format!("0 0 {z}\n20 0 {z}\n20 20 {z}\n0 20 {z}\n7.3 9.1 {z}\n")
}

/// A folder with a plain at 100, and lines in it.
fn plain_folder(lines: &[(&str, &str)]) -> TempDir {
    let folder = folder_with(&[("p.xyz", &plain(100.0))]);
    for (name, coordinates) in lines {
        let kind = match coordinates.starts_with("[[[") {
            true => "MultiLineString",
            false => "LineString",
        };
        let text = geojson(25832, kind, coordinates);
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

#[test]
fn stations_are_found_wherever_the_line_begins() {
    let folder = plain_folder(&[("l.geojson", "[[5,5],[15,5]]")]);
    let words = ["p.xyz", "--along", "l.geojson", "--left", "1"];
    let names = |more: &[&str]| -> Vec<String> {
        let found = of(&folder, &[&words[..], more].concat());
        let profiles = found["profiles"].as_array().unwrap();
        let names = profiles.iter().map(|profile| profile["name"].as_str());
        names.map(|name| name.unwrap().to_owned()).collect()
    };
    // 16.1 - 6.1 is above 10.
    assert_eq!(
        names(&["--start", "6.1", "--stations", "16.1"]),
        ["0+016.1"]
    );
    assert_eq!(
        names(&["--start", "6.1", "--stations", "6.1,0+016.1"]),
        ["0+006.1", "0+016.1"]
    );
    assert_eq!(
        names(&["--start", "1+250", "--interval", "5"]),
        ["1+250", "1+255", "1+260"]
    );
    assert_eq!(
        names(&["--start", "-0+005", "--stations", "-0+005,-2,0+005"]),
        ["-0+005", "-0+002", "0+005"]
    );
    let fails = |more: &[&str], texts: &[&str]| {
        run_in(&folder, &[&["profile"], &words[..], more].concat()).fails(2, texts);
    };
    // There, multiples of the interval are equal numbers.
    let texts = ["at an interval of 50", "--start", "--interval"];
    fails(&["--interval", "50", "--start", "1e300"], &texts);
    fails(
        &["--interval", "1e-3", "--start=-1e15"],
        &["at an interval of 0.001"],
    );
    fails(&["--stations", "1+2x"], &["1+2x", "1+250"]);
}

#[test]
fn sections_have_a_point_on_the_axis_and_count_from_it() {
    let folder = plain_folder(&[("l.geojson", "[[5,3],[13,7]]")]);
    let words = ["p.xyz", "--along", "l.geojson", "--interval", "4"];
    let widths = ["--left", "2.5", "--right", "1.25"];
    for step in [None, Some("1")] {
        let step: Vec<&str> = step.iter().flat_map(|step| ["--step", step]).collect();
        let found = of(&folder, &[&words[..], &widths, &step].concat());
        let profiles = found["profiles"].as_array().unwrap();
        assert_eq!(profiles.len(), 3);
        for profile in profiles {
            let points = points(profile, 0).concat();
            let distances: Vec<f64> = points.iter().map(|p| p[0]).collect();
            assert!(distances.is_sorted());
            assert_eq!((distances[0], distances[distances.len() - 1]), (-2.5, 1.25));
            let axis = points.iter().find(|p| p[0] == 0.0).unwrap();
            let along = profile["station"].as_f64().unwrap() / 5f64.sqrt();
            for (k, at) in [(1, 5.0 + 2.0 * along), (2, 3.0 + along)] {
                assert!((axis[k] - at).abs() < 1e-12, "{axis:?}");
            }
            if !step.is_empty() {
                assert_eq!(distances, [-2.5, -2.0, -1.0, 0.0, 1.0, 1.25]);
            }
        }
    }
    // On one side, the axis is an end.
    let found = of(&folder, &[&words[..], &["--right", "2"]].concat());
    let distances = points(&found["profiles"][0], 0).concat();
    assert_eq!(
        [distances[0][0], distances[distances.len() - 1][0]],
        [0.0, 2.0]
    );
}

#[test]
fn sections_across_several_lines_are_titled_by_their_records() {
    let folder = plain_folder(&[
        ("two.geojson", "[[[5,5],[15,5]],[[5,9],[15,9]]]"),
        ("one.geojson", "[[5,5],[15,5]]"),
    ]);
    let title = |along: &str| {
        let words = [
            "profile",
            "p.xyz",
            "--along",
            along,
            "--interval",
            "5",
            "--left",
            "1",
        ];
        let run = run_in(&folder, &words);
        run.works(&[]);
        run.stdout.lines().next().unwrap().to_owned()
    };
    assert_eq!(title("one.geojson"), "station 0+000, 1 m");
    assert_eq!(title("two.geojson"), "record 1, part 1, station 0+000, 1 m");
}

#[test]
fn of_sections_that_cross_some_are_listed() {
    let folder = plain_folder(&[("bend.geojson", "[[5,5],[10,5],[10,10]]")]);
    let words = [
        "profile",
        "p.xyz",
        "--along",
        "bend.geojson",
        "--left",
        "5",
        "--interval",
    ];
    let of = |interval| run_in(&folder, &[&words[..], &[interval]].concat());
    of("1").works(&[
        "sections cross: 0+000 and 0+006, 0+000 and 0+007, ",
        " more",
    ]);
    of("0.05").works(&[" and at least 995 more"]);
}

#[test]
fn plots_are_as_high_as_what_is_on_a_surface() {
    let lines = "[[[1,5],[15,5]],[[50,50],[60,60]]]";
    let folder = plain_folder(&[("l.geojson", lines), ("s.geojson", "[[3,5],[15,5]]")]);
    let plot = |words: &[&str]| {
        let all = ["profile", "--overwrite", "-o", "t.svg"];
        run_in(&folder, &[&all[..], words].concat())
    };
    // The line beside the surface has no heights: neither for the datum nor for the exaggeration.
    std::fs::write(
        folder.path().join("slope.xyz"),
        "0 0 500\n20 0 501\n20 20 501\n0 20 500\n",
    )
    .unwrap();
    let exaggeration = |along: &str| {
        plot(&["slope.xyz", "--along", along]).works(&[]);
        let text = String::from_utf8(bytes(&folder, "t.svg")).unwrap();
        let (_, note) = text.split_once("vertical exaggeration ").unwrap();
        note.split_once(',').unwrap().0.to_owned()
    };
    assert_eq!(exaggeration("l.geojson"), exaggeration("s.geojson"));
    let with_datum = ["slope.xyz", "--along", "l.geojson", "--datum", "499"];
    plot(&with_datum).works(&[]);
    let level = ["p.xyz", "--along", "s.geojson"];
    plot(&level).works(&[]);
    for factor in ["1e300", "1e308"] {
        plot(&[&level[..], &["--exaggeration", factor]].concat()).fails(2, &["--exaggeration"]);
    }
}

#[test]
fn what_an_option_is_for_has_to_be_asked_for() {
    let folder = plain_folder(&[("l.geojson", "[[5,5],[15,5]]")]);
    let line = ["profile", "p.xyz", "--along", "l.geojson"];
    let fails = |more: &[&str], texts: &[&str]| {
        run_in(&folder, &[&line[..], more].concat()).fails(2, texts);
    };
    for option in ["--start", "--angle", "--station-format"] {
        let value = if option == "--angle" { "45" } else { "0" };
        let text = format!("{option} is for cross-sections");
        fails(&[option, value], &[&text, "--interval or --stations"]);
    }
    for option in ["--exaggeration", "--datum", "--title"] {
        let text = format!("{option} is for plots");
        fails(&[option, "5"], &[&text, ".svg"]);
        fails(&[option, "5", "-o", "t.csv"], &[&text, ".svg"]);
        let with_plot = [option, "5", "-o", "t.csv", "-o", "t.DXF"];
        run_in(&folder, &[&line[..], &with_plot, &["--overwrite"]].concat()).works(&[]);
    }
}

#[test]
fn sections_need_lengths() {
    let folder = folder_with(&[
        ("p.xyz", &plain(100.0)),
        ("l.geojson", &geojson(4326, "LineString", "[[5,5],[15,5]]")),
    ]);
    let words = [
        "profile",
        "p.xyz",
        "--a-srs",
        "EPSG:4326",
        "--force-degrees",
        "--max-edge",
        "none",
        "--along",
        "l.geojson",
    ];
    run_in(&folder, &words).works(&[]);
    let sections = ["--interval", "1", "--left", "1"];
    run_in(&folder, &[&words[..], &sections].concat())
        .fails(1, &["in degrees: sections need lengths", "reproject"]);
}

#[test]
fn lines_without_a_length_are_named() {
    let folder = plain_folder(&[
        ("one.geojson", "[[5,5],[5,5]]"),
        ("two.geojson", "[[[5,5],[15,5]],[[5,5],[5,5]]]"),
    ]);
    let along = |name| run_in(&folder, &["profile", "p.xyz", "--along", name]);
    along("one.geojson").fails(2, &["one.geojson: no line has a length"]);
    let run = along("two.geojson");
    run.works(&["warning: two.geojson: record 1, part 2: no length"]);
    assert!(!run.stderr.contains("not on"), "{}", run.stderr);
    let draped = |name| {
        let words = ["drape", "p.xyz", "--lines", name, "-o", "o.geojson"];
        run_in(&folder, &words)
    };
    draped("one.geojson").fails(2, &["one.geojson: no line has a length"]);
    draped("two.geojson").works(&["warning: two.geojson: record 1: no length"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_table_on_stdout_is_alone_there() {
    let folder = plain_folder(&[("l.geojson", "[[5,5],[15,5]]")]);
    let words = ["profile", "p.xyz", "--along", "l.geojson", "-o"];
    run_in(&folder, &[&words[..], &["t.csv"]].concat()).works(&[]);
    std::os::unix::fs::symlink("/dev/stdout", folder.path().join("out.csv")).unwrap();
    for target in ["/dev/stdout", "out.csv"] {
        let run = run_in(&folder, &[&words[..], &[target]].concat());
        run.works(&[]);
        assert_eq!(run.stdout.as_bytes(), bytes(&folder, "t.csv"), "{target}");
        run_in(&folder, &[&words[..], &[target, "--json"]].concat()).fails(2, &["--json"]);
    }
}

#[test]
fn stations_are_written_as_the_step_is() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("l.geojson", &geojson(25832, "LineString", "[[0,1],[3,1]]")),
    ]);
    let words = [
        "profile",
        "a.xyz",
        "--along",
        "l.geojson",
        "--a-srs",
        "EPSG:25832",
    ];
    let run = run_in(
        &folder,
        &[&words[..], &["--step", "0.1", "-o", "p.csv"]].concat(),
    );
    run.works(&[]);
    let table = String::from_utf8(super::bytes(&folder, "p.csv")).unwrap();
    assert_eq!(table.lines().count(), 32);
    assert!(
        table.lines().any(|row| row.contains(",0.3,0.3,1,10.3")),
        "{table}"
    );
}

#[test]
fn lines_in_degrees_by_their_format_alone_are_a_warning() {
    let line = r#"{"type":"LineString","coordinates":[[0,1],[3,1]]}"#;
    let folder = folder_with(&[("a.xyz", SLOPE), ("l.geojson", line)]);
    let words = ["profile", "a.xyz", "--along", "l.geojson", "-o", "p.csv"];
    run_in(&folder, &words).works(&[
        "warning: a.xyz states no coordinate system",
        "taken to be degrees",
        "--a-srs",
    ]);
}
