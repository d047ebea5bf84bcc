//! The program as it is run, in a temporary folder.

use std::path::Path;

use assert_cmd::Command;
use tempfile::TempDir;

/// What came out of a run.
struct Run {
    code: i32,
    stdout: String,
    stderr: String,
}

impl Run {
    /// Fails unless the run ended with this code and said all of this on stderr.
    #[track_caller]
    fn fails(&self, code: i32, said: &[&str]) {
        assert_eq!(self.code, code, "{}", self.stderr);
        self.says(said);
        assert!(self.stderr.contains("error: "), "{}", self.stderr);
    }

    /// Fails unless the run ended well and said all of this on stderr.
    #[track_caller]
    fn works(&self, said: &[&str]) {
        assert_eq!(self.code, 0, "{}", self.stderr);
        self.says(said);
    }

    #[track_caller]
    fn says(&self, said: &[&str]) {
        for part in said {
            assert!(self.stderr.contains(part), "expected `{part}` in:\n{}", self.stderr);
        }
    }
}

fn run_in(folder: &TempDir, args: &[&str]) -> Run {
    run_with(folder, args, "")
}

fn run_with(folder: &TempDir, args: &[&str], stdin: &str) -> Run {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("breakline"));
    let output = command.current_dir(folder.path()).args(args).write_stdin(stdin).output().unwrap();
    Run {
        code: output.status.code().expect("the program was killed"),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// A square of 4 x 4 points, 1 apart, on a slope.
const SLOPE: &str = "\
0 0 10\n1 0 11\n2 0 12\n3 0 13\n0 1 10\n1 1 11\n2 1 12\n3 1 13\n\
0 2 10\n1 2 11\n2 2 12\n3 2 13\n0 3 10\n1 3 11\n2 3 12\n3 3 13\n";

fn folder_with(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    folder
}

fn files_of(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// A GeoJSON layer of one geometry.
fn geojson(epsg: u32, kind: &str, coordinates: &str) -> String {
    format!(
        r#"{{"type":"FeatureCollection","crs":{{"type":"name","properties":{{"name":"urn:ogc:def:crs:EPSG::{epsg}"}}}},
        "features":[{{"type":"Feature","properties":{{"Z":11.5}},"geometry":{{"type":"{kind}","coordinates":{coordinates}}}}}]}}"#
    )
}

#[test]
fn help_goes_to_stdout_and_tells_each_verb_with_an_example() {
    let folder = folder_with(&[]);
    let run = run_in(&folder, &["--help"]);
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    for verb in ["info", "tin", "dem", "contour", "hillshade", "check", "demo"] {
        assert!(run.stdout.contains(&format!("\n  {verb} ")), "{verb}");
        let long = run_in(&folder, &[verb, "--help"]);
        assert_eq!(long.code, 0);
        assert!(long.stdout.contains(&format!("Example:\n  breakline {verb} ")), "{verb}");
        let short = run_in(&folder, &[verb, "-h"]);
        assert!(short.stdout.len() < long.stdout.len(), "{verb}");
    }
    assert!(run_in(&folder, &["--version"]).stdout.starts_with("breakline 0."));
}

#[test]
fn wrong_usage_ends_with_2_and_leaves_nothing() {
    let folder =
        folder_with(&[("a.xyz", SLOPE), ("lines.geojson", &geojson(25832, "LineString", "[[0,0,1],[1,1,1]]"))]);
    let wrong: &[(&[&str], &str)] = &[
        (&[], "Usage"),
        (&["tim"], "unrecognized subcommand"),
        (&["tin"], "required"),
        (&["tin", "a.xyz"], "--output"),
        (&["tin", "a.xyz", "-o", "t.ply", "--max-edge", "-3"], "--max-edge"),
        (&["tin", "a.xyz", "-o", "t.ply", "--max-edge", "all"], "`none`"),
        (&["tin", "a.xyz", "-o", "t.ply", "--bounds", "3,0,1,2"], "xmin < xmax"),
        (&["tin", "a.xyz", "-o", "t.ply", "--class", "2,300"], "300"),
        (&["tin", "a.xyz", "-o", "t.ply", "--duplicates", "newest"], "lowest, highest, mean, first, last"),
        (&["tin", "a.xyz", "-o", "t.ply", "--a-srs", "EPSG:nonsense"], "--a-srs"),
        (&["tin", "a.xyz", "-o", "t.dxf"], ".ply, .obj, .stl"),
        (&["tin", "a.xyz", "-o", "t"], ".ply, .obj, .stl"),
        (&["dem", "a.xyz", "-o", "t.png"], ".tif"),
        (&["contour", "a.xyz", "-o", "t.dwg"], ".shp, .geojson"),
        (&["hillshade", "a.xyz", "-o", "t.jpg"], ".tif, .tiff, .png"),
        (&["dem", "a.xyz", "-o", "t.tif", "--resolution", "0"], "above zero"),
        (&["dem", "a.xyz", "-o", "t.tif", "--resolution", "1", "--align-to", "a.tif"], "cannot be used with"),
        (&["contour", "a.xyz", "-o", "t.shp", "--levels", "1,2", "--interval", "1"], "cannot be used with"),
        (&["hillshade", "a.xyz", "-o", "t.png", "--altitude", "91"], "between 0"),
        (&["tin", "a.xyz", "-o", "a.xyz"], "no format that can be written"),
        (
            &["contour", "a.xyz", "--breaklines", "lines.geojson", "-o", "lines.geojson", "--overwrite"],
            "one of the inputs",
        ),
        (&["tin", "a.xyz", "-o", "t.ply", "-o", "t.ply"], "named twice"),
        (&["tin", "a.xyz", "-o", "t.ply", "-q", "-v"], "cannot be used with"),
    ];
    let before = files_of(folder.path());
    for (args, said) in wrong {
        let run = run_in(&folder, args);
        assert_eq!(run.code, 2, "{args:?}: {}", run.stderr);
        assert!(run.stderr.contains(said), "{args:?}: expected `{said}` in:\n{}", run.stderr);
        assert_eq!(run.stdout, "", "{args:?}");
    }
    assert_eq!(files_of(folder.path()), before);
}

#[test]
fn negative_coordinates_are_no_options() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let run = run_in(&folder, &["tin", "a.xyz", "-o", "t.ply", "--bounds", "-5,-5,nonsense,1"]);
    run.fails(2, &["`nonsense` is not a finite number"]);
    let run = run_in(&folder, &["contour", "none.xyz", "-o", "t.shp", "--base", "-5"]);
    run.fails(1, &["none.xyz: no such file"]);
}

#[test]
fn what_exists_is_not_replaced_and_that_is_known_before_the_work() {
    let folder = folder_with(&[("broken.xyz", "no numbers at all\n"), ("t.ply", "mine"), ("c.dbf", "mine")]);
    let run = run_in(&folder, &["tin", "broken.xyz", "-o", "t.ply"]);
    run.fails(1, &["error: t.ply: the file exists", "hint: ", "--overwrite"]);
    // A shapefile is several files.
    let run = run_in(&folder, &["contour", "broken.xyz", "-o", "c.shp"]);
    run.fails(1, &["error: c.dbf: the file exists"]);
    let run = run_in(&folder, &["tin", "broken.xyz", "-o", "nowhere/t.ply"]);
    run.fails(1, &["nowhere/t.ply", "the folder does not exist"]);
    for name in ["t.ply", "c.dbf"] {
        assert_eq!(std::fs::read_to_string(folder.path().join(name)).unwrap(), "mine");
    }
}

#[test]
fn a_glob_or_a_name_without_a_file_is_an_error() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    run_in(&folder, &["tin", "a.xyz", "tiles/*.laz", "-o", "t.ply"]).fails(1, &["no file matches `tiles/*.laz`"]);
    run_in(&folder, &["tin", "a.xyz", "b.xyz", "-o", "t.ply"]).fails(1, &["b.xyz: no such file"]);
    run_in(&folder, &["tin", "[", "-o", "t.ply"]).fails(2, &["no valid glob"]);
    let run = run_in(&folder, &["tin", "a.xyz", "--breaklines", "no.shp:Z", "-o", "t.ply"]);
    run.fails(1, &["no.shp:Z: no such file"]);
    assert_eq!(files_of(folder.path()), ["a.xyz"]);
}

#[test]
fn info_counts_what_is_in_files_lists_globs_and_stdin() {
    let list = "# tiles\n\ntiles/a.xyz   # the first\ntiles/[b-c].xyz\n";
    let folder = folder_with(&[
        ("lists/all.txt", list),
        ("lists/tiles/a.xyz", SLOPE),
        ("lists/tiles/b.xyz", "1.5 2.25 -3\n"),
        ("lists/tiles/c.xyz", "4 5 6\n7 8 9\n"),
    ]);
    let run = run_in(&folder, &["info", "--json", "@lists/all.txt"]);
    run.works(&[]);
    let counts = |run: &Run| -> Vec<u64> {
        let files: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        files.as_array().unwrap().iter().map(|file| file["count"].as_u64().unwrap()).collect()
    };
    assert_eq!(counts(&run), [16, 1, 2]);
    assert_eq!(counts(&run_in(&folder, &["info", "--json", "lists/tiles/*.xyz"])), [16, 1, 2]);
    assert_eq!(counts(&run_with(&folder, &["info", "--json", "-"], SLOPE)), [16]);

    let run = run_in(&folder, &["info", "--json", "lists/tiles/b.xyz", "./lists/tiles/b.xyz"]);
    run.works(&["note: ./lists/tiles/b.xyz is named twice and used once"]);
    let files: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(files[0]["bounds"], serde_json::json!({"min": [1.5, 2.25, -3.0], "max": [1.5, 2.25, -3.0]}));
    assert_eq!(files[0]["crs"], serde_json::Value::Null);

    let text = run_in(&folder, &["info", "lists/tiles/b.xyz"]);
    assert!(text.stdout.contains("x 1.5 .. 1.5, y 2.25 .. 2.25, z -3 .. -3"), "{}", text.stdout);
}

#[test]
fn a_list_names_its_line_when_a_file_is_missing() {
    let folder = folder_with(&[("list.txt", "# nothing\n\nno*.laz\n"), ("empty.txt", "# nothing\n")]);
    run_in(&folder, &["info", "@list.txt"]).fails(1, &["list.txt: line 3: no file matches"]);
    run_in(&folder, &["info", "@empty.txt"]).fails(2, &["the input names no file"]);
    run_in(&folder, &["info", "@none.txt"]).fails(1, &["none.txt"]);
}

#[test]
fn info_goes_on_after_a_file_that_cannot_be_read() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("b.laz", "this is no lidar"), ("c.xyz", "1 2 3\n")]);
    let run = run_in(&folder, &["info", "a.xyz", "b.laz", "c.xyz"]);
    run.fails(1, &["error: b.laz: "]);
    assert!(run.stdout.contains("a.xyz\n") && run.stdout.contains("c.xyz\n"), "{}", run.stdout);
}

#[test]
fn degrees_and_geocentric_systems_are_refused_with_the_cure() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let run = run_in(&folder, &["tin", "a.xyz", "--a-srs", "EPSG:4326", "-o", "t.ply"]);
    run.fails(1, &["a.xyz", "EPSG:4326", "degree", "hint: ", "--t-srs", "--force-degrees"]);
    let run = run_in(&folder, &["tin", "a.xyz", "--a-srs", "EPSG:4978", "--force-degrees", "-o", "t.ply"]);
    run.fails(1, &["a.xyz", "EPSG:4978", "geocentric", "hint: ", "--t-srs"]);
    assert_eq!(files_of(folder.path()), ["a.xyz"]);
}

#[test]
fn two_systems_are_an_error_that_names_both_and_the_files() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("l.geojson", &geojson(25832, "LineString", "[[0,0,1],[1,1,1]]")),
        ("m.geojson", &geojson(25833, "LineString", "[[0,0,1],[1,1,1]]")),
    ]);
    let run =
        run_in(&folder, &["tin", "a.xyz", "--breaklines", "l.geojson", "--breaklines", "m.geojson", "-o", "t.ply"]);
    run.fails(1, &["l.geojson", "EPSG:25832", "m.geojson", "EPSG:25833", "hint: ", "--t-srs", "--a-srs"]);
}

#[test]
fn breaklines_without_heights_are_refused_never_taken_as_0() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("flat.geojson", &geojson(25832, "LineString", "[[0,0],[1,1]]")),
        ("part.geojson", &geojson(25832, "LineString", "[[0,0,7],[1,1]]")),
        ("points.geojson", &geojson(25832, "Point", "[0,0,7]")),
    ]);
    let tin = |lines: &str| run_in(&folder, &["tin", "a.xyz", "--breaklines", lines, "-o", "t.ply"]);
    tin("flat.geojson").fails(1, &["flat.geojson: record 1: the breakline has no heights", "FILE:FIELD", "Z"]);
    tin("part.geojson").fails(1, &["part.geojson: record 1: vertex 2 at 1 1 has no height"]);
    tin("points.geojson").fails(1, &["points.geojson", "no lines"]);
    let run = run_in(&folder, &["tin", "a.xyz", "--boundary", "flat.geojson", "-o", "t.ply"]);
    run.fails(1, &["flat.geojson", "no polygons"]);
    assert!(!folder.path().join("t.ply").exists());
}

#[test]
fn a_feature_that_is_not_built_in_is_named() {
    if cfg!(feature = "proj") {
        return;
    }
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let run = run_in(&folder, &["tin", "a.xyz", "--a-srs", "EPSG:25832", "--t-srs", "EPSG:25833", "-o", "t.ply"]);
    run.fails(1, &["PROJ", "hint: ", "--features proj"]);
}

#[test]
fn a_raster_is_no_input_of_tin_or_dem() {
    let folder = folder_with(&[("d.tif", "II*\0"), ("a.xyz", SLOPE)]);
    run_in(&folder, &["dem", "d.tif", "-o", "e.tif"]).fails(2, &["d.tif: the input is a raster"]);
    run_in(&folder, &["contour", "d.tif", "a.xyz", "-o", "e.shp"]).fails(2, &["d.tif", "whole surface"]);
    run_in(&folder, &["contour", "d.tif", "--class", "2", "-o", "e.shp"]).fails(2, &["d.tif", "--class"]);
    run_in(&folder, &["hillshade", "d.tif", "-o", "d.tif", "--overwrite"]).fails(2, &["one of the inputs"]);
}

/// The fixtures that come with the program.
fn fixture(name: &str) -> String {
    format!("{}/fixtures/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn bytes(folder: &TempDir, name: &str) -> Vec<u8> {
    std::fs::read(folder.path().join(name)).unwrap()
}

#[test]
fn a_run_ends_with_a_summary_on_stderr_and_nothing_on_stdout() {
    let folder = folder_with(&[]);
    let (points, lines) = (fixture("valley.laz"), fixture("breaklines.shp"));
    let run = run_in(&folder, &["tin", &points, "--breaklines", &lines, "--max-edge", "none", "-o", "t.ply"]);
    run.works(&[
        "note: class 2 (ground) is used",
        "62776 read, 59177 used",
        "40 withheld",
        "5: 2925, 6: 180, 9: 454",
        "25 at the place of another point (the lowest is kept)",
        "9 in, 1334 edges out",
        "vertices    60492",
        "triangles   120954",
        "EPSG:25832 (ETRS89 / UTM zone 32N), metre",
        "written     t.ply",
        "done in ",
    ]);
    assert_eq!(run.stdout, "");
    let quiet = run_in(&folder, &["tin", &points, "-q", "--max-edge", "none", "-o", "q.ply"]);
    assert_eq!((quiet.code, quiet.stderr.as_str(), quiet.stdout.as_str()), (0, "", ""));

    // What was written comes back with its breaklines and its system.
    let info = run_in(&folder, &["info", "--json", "t.ply"]);
    let files: serde_json::Value = serde_json::from_str(&info.stdout).unwrap();
    let expected = serde_json::json!({"vertices": 60492, "triangles": 120_954, "breaklines": 1334});
    for (key, value) in expected.as_object().unwrap() {
        assert_eq!(&files[0][key], value, "{key}");
    }
    assert_eq!(files[0]["crs"]["epsg"], 25832);
    let check = run_in(&folder, &["check", "t.ply"]);
    check.works(&[]);
    assert_eq!(check.stdout, "60492 vertices, 120954 triangles, 1334 breakline edges: no flaw found\n");
}

#[test]
fn classes_are_chosen() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let points = fixture("valley.laz");
    let run = run_in(&folder, &["tin", &points, "--class", "5,6", "-o", "t.ply"]);
    run.works(&["3105 used", "2: 59177, 9: 454"]);
    let run = run_in(&folder, &["tin", &points, "--class", "11", "-o", "u.ply"]);
    run.fails(1, &["warning: no point is of class 11", "no point is left of 62776 read", "hint: ", "2, 5, 6, 9"]);
    // Text has no classes.
    run_in(&folder, &["tin", "a.xyz", "--class", "2", "-o", "v.ply"]).works(&["16 read, 16 used"]);
}

#[test]
fn the_longest_edge_is_100_metres_in_any_unit_and_said_so() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let note = |system: &str, name: &str| run_in(&folder, &["tin", "a.xyz", "--a-srs", system, "-o", name]);
    note("EPSG:25832", "m.ply").works(&["edges over 100 m are left out"]);
    note("EPSG:2903", "f.ply").works(&["edges over 328.08 ftUS are left out"]);
    run_in(&folder, &["tin", "a.xyz", "-o", "u.ply"])
        .works(&["edges over 100 units", "no coordinate system is stated"]);
    run_in(&folder, &["tin", "a.xyz", "--max-edge", "none", "-o", "n.ply"]).works(&["the whole convex hull is kept"]);
    let run = run_in(&folder, &["tin", "a.xyz", "--max-edge", "0.5", "-o", "s.ply"]);
    run.fails(1, &["no triangle is left: 18 have edges over 0.5 units", "--max-edge none"]);
    let run = run_in(&folder, &["tin", "a.xyz", "--a-srs", "EPSG:4326", "--force-degrees", "-o", "d.ply"]);
    // The points are a degree apart.
    run.fails(1, &["18 have edges over 0.000898 degrees", "note: the plan is in units of the degree, heights"]);
}

#[test]
fn duplicates_go_by_the_rule() {
    let doubled = format!("{SLOPE}1 1 20\n1 1 5\n1 1 8\n");
    let folder = folder_with(&[("a.xyz", &doubled)]);
    for (rule, height) in [("lowest", "5"), ("highest", "20"), ("mean", "11"), ("first", "11"), ("last", "8")] {
        let run = run_in(&folder, &["tin", "a.xyz", "--duplicates", rule, "-o", "t.obj", "--overwrite"]);
        run.works(&["3 at the place of another point"]);
        let text = String::from_utf8(bytes(&folder, "t.obj")).unwrap();
        assert!(text.lines().any(|line| line == format!("v 1 1 {height}")), "{rule}:\n{text}");
    }
}

#[test]
fn a_breakline_height_wins_and_lines_come_from_attributes_and_rings() {
    let flat = geojson(25832, "LineString", "[[1,1],[2,2]]");
    let ring = geojson(25832, "Polygon", "[[[1,1,7],[2,1,7],[2,2,7],[1,1,7]]]");
    let folder = folder_with(&[("a.xyz", SLOPE), ("flat.geojson", &flat), ("ring.geojson", &ring)]);
    let run = run_in(&folder, &["tin", "a.xyz", "--breaklines", "flat.geojson:Z", "-o", "t.obj"]);
    run.works(&[
        "note: a.xyz states no coordinate system; EPSG:25832",
        "2 at a breakline's vertex",
        "1 in, 1 edges out",
    ]);
    let text = String::from_utf8(bytes(&folder, "t.obj")).unwrap();
    assert!(text.contains("v 1 1 11.5\n") && text.contains("v 2 2 11.5\n"), "{text}");
    let run = run_in(&folder, &["tin", "a.xyz", "--breaklines", "ring.geojson", "-o", "r.obj"]);
    run.works(&["1 in, 3 edges out"]);
}

#[test]
fn the_surface_is_clipped_to_bounds_and_boundary() {
    let triangle = geojson(25832, "Polygon", "[[[0,0],[3,0],[0,3],[0,0]]]");
    let folder = folder_with(&[("a.xyz", SLOPE), ("b.geojson", &triangle)]);
    let extent = |args: &[&str]| -> serde_json::Value {
        let run = run_in(&folder, &[&["tin", "a.xyz", "-o", "t.ply", "--overwrite"], args].concat());
        run.works(&[" clipped)"]);
        let info = run_in(&folder, &["info", "--json", "t.ply"]);
        let files: serde_json::Value = serde_json::from_str(&info.stdout).unwrap();
        files[0]["bounds"].clone()
    };
    let close = |found: &serde_json::Value, expected: [f64; 3]| {
        for (i, value) in expected.into_iter().enumerate() {
            assert!((found[i].as_f64().unwrap() - value).abs() < 1e-6, "{found}: expected {expected:?}");
        }
    };
    let bounds = extent(&["--bounds", "0.5,-1,2.5,1.5"]);
    close(&bounds["min"], [0.5, 0.0, 10.5]);
    close(&bounds["max"], [2.5, 1.5, 12.5]);
    let both = extent(&["--bounds", "1,-9,9,9", "--boundary", "b.geojson"]);
    close(&both["min"], [1.0, 0.0, 11.0]);
    close(&both["max"], [3.0, 2.0, 13.0]);
    // Points beyond the buffer are not used, those in it are.
    let run = run_in(&folder, &["tin", "a.xyz", "--bounds", "0,0,1,1", "--max-edge", "1.5", "-o", "w.ply"]);
    run.works(&["points up to 1.5 units outside of the bounds are used", "9 used; dropped: 7 outside of the bounds"]);
    let run = run_in(&folder, &["tin", "a.xyz", "--bounds", "5000,5000,6000,6000", "-o", "x.ply"]);
    run.fails(1, &["no point is left of 16 read", "16 outside of the bounds"]);
}

#[test]
fn a_surface_that_is_there_takes_no_options_for_building_one() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    run_in(&folder, &["tin", "a.xyz", "-o", "t.ply"]).works(&[]);
    let dem = |args: &[&str]| run_in(&folder, &[&["dem", "t.ply", "-o", "d.tif"], args].concat());
    for option in [
        ["--breaklines", "a.xyz"],
        ["--boundary", "a.xyz"],
        ["--bounds", "0,0,1,1"],
        ["--max-edge", "none"],
        ["--class", "2"],
        ["--duplicates", "mean"],
        ["--t-srs", "EPSG:25832"],
    ] {
        dem(&option).fails(2, &["t.ply: ", option[0], "whole surface"]);
    }
    run_in(&folder, &["dem", "t.ply", "a.xyz", "-o", "d.tif"]).fails(2, &["t.ply", "other files are given with it"]);
    let run = dem(&["--a-srs", "EPSG:25832", "--resolution", "0.5"]);
    run.works(&["6 x 6 cells of 0.5 m", "36 with a height, from 10.25 m to 12.75 m", "EPSG:25832"]);
    let info = run_in(&folder, &["info", "--json", "d.tif"]);
    let files: serde_json::Value = serde_json::from_str(&info.stdout).unwrap();
    assert_eq!(files[0]["crs"]["epsg"], 25832);
    assert_eq!(files[0]["nodata"], -9999.0);
    assert_eq!((&files[0]["min"], &files[0]["max"]), (&10.25.into(), &12.75.into()));
}

#[test]
fn rasters_are_placed_as_asked() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let dem = |name: &str, args: &[&str]| {
        let run = run_in(&folder, &[&["dem", "a.xyz", "-o", name], args].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        let info = run_in(&folder, &["info", "--json", name]);
        let files: serde_json::Value = serde_json::from_str(&info.stdout).unwrap();
        (files[0]["size"].clone(), files[0]["cell"].clone())
    };
    let json = |value: &[f64]| serde_json::json!(value);
    assert_eq!(dem("a.tif", &[]).1, json(&[0.0, 1.0, 0.0, 3.0, 0.0, -1.0]));
    let (size, cell) = dem("b.tif", &["--te", "-1,-1,2.5,2.2", "--resolution", "0.5"]);
    assert_eq!((size, cell), (serde_json::json!([7, 7]), json(&[-1.0, 0.5, 0.0, 2.5, 0.0, -0.5])));
    let (size, cell) = dem("c.tif", &["--align-to", "b.tif"]);
    assert_eq!((size, cell), (serde_json::json!([6, 6]), json(&[0.0, 0.5, 0.0, 3.0, 0.0, -0.5])));
    let run = run_in(&folder, &["dem", "a.xyz", "--align-to", "a.tif", "-o", "a.tif", "--overwrite"]);
    run.fails(2, &["one of the inputs"]);
    let degrees = ["--a-srs", "EPSG:4326", "--force-degrees", "--max-edge", "none"];
    let run = run_in(&folder, &[&["dem", "a.xyz", "-o", "e.tif"], &degrees[..]].concat());
    run.fails(2, &["no default resolution in degrees"]);
}

#[test]
fn contours_and_shades_come_from_tins_and_from_dems() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let run = run_in(&folder, &["contour", "a.xyz", "--base", "-0.5", "-o", "c.geojson"]);
    run.works(&["contours are 1 unit apart", "3 lines (0 closed) from 10.5 units to 12.5 units"]);
    let text = String::from_utf8(bytes(&folder, "c.geojson")).unwrap();
    let layer: serde_json::Value = serde_json::from_str(&text).unwrap();
    let levels: Vec<f64> = layer["features"]
        .as_array()
        .unwrap()
        .iter()
        .map(|feature| feature["properties"]["ELEV"].as_f64().unwrap())
        .collect();
    assert_eq!(levels, [10.5, 11.5, 12.5]);

    let run = run_in(&folder, &["contour", "a.xyz", "--levels", "11.25,-7,11.25", "-o", "l.shp"]);
    run.works(&["1 line (0 closed) from 11.25 units to 11.25 units"]);
    let run = run_in(&folder, &["contour", "a.xyz", "--levels", "100", "-o", "none.geojson"]);
    run.works(&["warning: no contour crosses the surface"]);

    run_in(&folder, &["dem", "a.xyz", "--resolution", "0.5", "-o", "d.tif"]).works(&[]);
    let run = run_in(&folder, &["contour", "d.tif", "--levels", "11.5", "-o", "d.geojson"]);
    run.works(&["1 line (0 closed) from 11.5 units to 11.5 units"]);
    run_in(&folder, &["hillshade", "d.tif", "-o", "d.png", "-o", "s.tif"]).works(&["6 x 6 cells", "written     d.png"]);
    run_in(&folder, &["hillshade", "a.xyz", "--resolution", "0.5", "-o", "a.png"]).works(&["6 x 6 cells"]);
    run_in(&folder, &["hillshade", "d.tif", "--resolution", "2", "-o", "e.png"])
        .fails(2, &["a DEM keeps its own cells"]);
}

#[test]
fn a_flaw_is_listed_and_ends_with_1() {
    // The wrong diagonal of a kite.
    let kite = "v 0 0 0\nv 4 -1 0\nv 8 0 0\nv 4 1 0\nf 1 2 3\nf 1 3 4\n";
    let folder = folder_with(&[("kite.obj", kite), ("a.xyz", SLOPE)]);
    let run = run_in(&folder, &["check", "kite.obj"]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert!(run.stdout.contains("circumscribed circle") && run.stdout.contains(" flaws\n"), "{}", run.stdout);
    let run = run_in(&folder, &["check", "a.xyz"]);
    run.works(&[]);
    assert_eq!(run.stdout, "16 vertices, 18 triangles, 0 breakline edges: no flaw found\n");
}

#[test]
fn results_do_not_depend_on_the_order_of_files_or_on_threads() {
    let rows: Vec<&str> = SLOPE.lines().collect();
    let mut shuffled = rows.clone();
    shuffled.rotate_left(7);
    shuffled.swap(2, 11);
    let halves = [shuffled[..5].join("\n"), shuffled[5..].join("\n")];
    let folder = folder_with(&[("a.xyz", SLOPE), ("b.xyz", &halves[0]), ("c.xyz", &halves[1])]);
    let orders: [&[&str]; 3] =
        [&["a.xyz"], &["b.xyz", "c.xyz", "--threads", "1"], &["c.xyz", "b.xyz", "--threads", "2"]];
    for (i, order) in orders.into_iter().enumerate() {
        for (verb, extension) in
            [("tin", "ply"), ("tin", "obj"), ("dem", "tif"), ("contour", "shp"), ("hillshade", "png")]
        {
            let name = format!("{verb}{i}.{extension}");
            run_in(&folder, &[&[verb, "-o", &name], order].concat()).works(&[]);
            assert_eq!(bytes(&folder, &name), bytes(&folder, &format!("{verb}0.{extension}")), "{name}");
        }
        assert_eq!(bytes(&folder, &format!("contour{i}.dbf")), bytes(&folder, "contour0.dbf"));
    }
}

#[test]
fn points_come_from_stdin() {
    let folder = folder_with(&[]);
    run_with(&folder, &["tin", "-", "-o", "t.ply"], SLOPE).works(&["16 read, 16 used", "triangles   18"]);
}

#[test]
fn the_demo_runs_every_verb_and_prints_each_command() {
    let folder = folder_with(&[]);
    let run = run_in(&folder, &["demo", "a valley"]);
    run.works(&[
        "$ breakline info 'a valley/valley.laz'",
        "$ breakline tin ",
        "$ breakline check ",
        "$ breakline dem ",
        "$ breakline hillshade ",
        "$ breakline contour ",
    ]);
    assert!(!run.stderr.contains("warning: "), "{}", run.stderr);
    assert!(run.stdout.contains("62776 points") && run.stdout.contains("no flaw found"), "{}", run.stdout);
    let made = files_of(&folder.path().join("a valley"));
    for name in
        ["ground.ply", "ground.obj", "ground.tif", "hillshade.png", "contours.shp", "contours.prj", "contours.geojson"]
    {
        assert!(made.iter().any(|file| file == name), "{name} is not in {made:?}");
    }
    // Once more, over what is there.
    run_in(&folder, &["demo", "a valley", "-q"]).works(&[]);
}
