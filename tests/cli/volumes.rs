//! Cut and fill as they are typed.

use serde_json::Value;

use super::{Run, SLOPE, bytes, files_of, fixture, folder_with, geojson, run_in};
use tempfile::TempDir;

/// The corners of a rectangle at 11, which overlaps [`SLOPE`] from 1 to 3.
const FLAT: &str = "1 0 11\n5 0 11\n5 3 11\n1 3 11\n";

/// A pile of 4 cubic units on ground that falls to the west.
const PILE: &str = "0 0 5\n4 0 7\n4 4 7\n0 4 5\n1 1 5.5\n3 1 6.5\n3 3 6.5\n1 3 5.5\n2 2 9\n";

/// Returns a GeoJSON layer of features.
fn collection(features: impl Iterator<Item = String>) -> String {
    let features: Vec<String> = features.collect();
    let system = r#"{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::25832"}}"#;
    format!(
        r#"{{"type":"FeatureCollection","crs":{system},"features":[{}]}}"#,
        features.join(",")
    )
}

/// Returns a GeoJSON layer of polygons, each a list of corners.
fn polygons(rings: &[&str]) -> String {
    let features = rings.iter().map(|ring| {
        format!(r#"{{"type":"Feature","properties":{{}},"geometry":{{"type":"Polygon","coordinates":[{ring}]}}}}"#)
    });
    collection(features)
}

#[track_caller]
fn json(run: &Run) -> Value {
    assert_eq!(run.code, 0, "{}", run.stderr);
    serde_json::from_str(&run.stdout).unwrap()
}

#[track_caller]
fn near(row: &Value, expected: &[(&str, f64)]) {
    for (key, value) in expected {
        let found = row[*key]
            .as_f64()
            .unwrap_or_else(|| panic!("{key} in {row}"));
        assert!(
            (found - value).abs() <= 1e-12 * value.abs().max(1.0),
            "{key}: {found} for {value}"
        );
    }
}

fn of(folder: &TempDir, words: &[&str]) -> Value {
    json(&run_in(folder, &[&["volume", "--json"], words].concat()))
}

#[test]
fn two_surfaces_enclose_a_known_volume_where_both_are() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("b.xyz", FLAT)]);
    let run = run_in(&folder, &["volume", "a.xyz", "b.xyz"]);
    run.works(&["note: no coordinate system is stated"]);
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    let lines: Vec<String> = run.stdout.lines().map(words).collect();
    for line in [
        "cut 6 cubic units",
        "fill 0 cubic units",
        "net 6 cubic units",
        "common area 6 square units",
        "surface only 3 square units",
        "base only 6 square units",
    ] {
        assert!(
            lines.iter().any(|found| found == line),
            "{line}: {}",
            run.stdout
        );
    }
    let found = of(&folder, &["a.xyz", "b.xyz"]);
    assert_eq!(
        (&found["unit"], &found["area_unit"]),
        (&Value::Null, &Value::Null)
    );
    let other = of(&folder, &["b.xyz", "a.xyz"]);
    assert_eq!(found["rows"][0]["cut"], other["rows"][0]["fill"]);
    near(
        &other["rows"][0],
        &[
            ("cut", 0.0),
            ("net", -6.0),
            ("fill_area", 6.0),
            ("surface_only", 6.0),
            ("base_only", 3.0),
        ],
    );
    // A surface and itself, whatever it is read from.
    run_in(&folder, &["tin", "a.xyz", "-o", "a.tin", "-o", "a.ply"]).works(&[]);
    for pair in [["a.xyz", "a.tin"], ["a.ply", "a.xyz"], ["a.tin", "a.ply"]] {
        let row = &of(&folder, &pair)["rows"][0];
        near(
            row,
            &[
                ("cut", 0.0),
                ("fill", 0.0),
                ("level_area", 9.0),
                ("common_area", 9.0),
            ],
        );
    }
}

#[test]
fn a_plane_and_levels_are_exact_and_written_as_a_table() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let row = &of(&folder, &["a.xyz", "--plane", "11.5"])["rows"][0];
    near(
        row,
        &[
            ("level", 11.5),
            ("cut", 3.375),
            ("fill", 3.375),
            ("cut_area", 4.5),
            ("base_only", 0.0),
        ],
    );
    let run = run_in(
        &folder,
        &[
            "volume", "a.xyz", "--levels", "10:13:1", "-o", "t.csv", "-q",
        ],
    );
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    assert!(
        run.stdout
            .starts_with("volumes in cubic units, areas in square units\n"),
        "{}",
        run.stdout
    );
    assert_eq!(run.stdout.lines().count(), 6);
    let table = String::from_utf8(bytes(&folder, "t.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(rows[0][..5], ["record", "level", "cut", "fill", "net"]);
    let numbers: Vec<(f64, f64, f64)> = rows[1..]
        .iter()
        .map(|row| [1, 3, 6].map(|column: usize| row[column].parse().unwrap()))
        .map(|[level, below, area]: [f64; 3]| (level, below, area))
        .collect();
    let expected = [
        (10.0, 0.0, 0.0),
        (11.0, 1.5, 3.0),
        (12.0, 6.0, 6.0),
        (13.0, 13.5, 9.0),
    ];
    for (found, expected) in numbers.iter().zip(expected) {
        assert_eq!(found.0, expected.0);
        assert!(
            (found.1 - expected.1).abs() < 1e-12 && (found.2 - expected.2).abs() < 1e-12,
            "{found:?}"
        );
    }
    // It is not replaced by accident.
    let again = ["volume", "a.xyz", "--plane", "1", "-o", "t.csv"];
    run_in(&folder, &again).fails(1, &["t.csv", "--overwrite"]);
    assert_eq!(bytes(&folder, "t.csv"), table.as_bytes());
    run_in(&folder, &[&again[..], &["--overwrite"]].concat()).works(&["written     t.csv"]);
}

#[test]
fn units_of_plan_and_heights_are_converted() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let cut = |words: &[&str]| {
        let found = of(&folder, &[&["a.xyz", "--plane", "10"], words].concat());
        (
            found["rows"][0]["cut"].as_f64().unwrap(),
            found["unit"].clone(),
        )
    };
    let foot = 1200.0 / 3937.0;
    for (system, factor) in [
        ("EPSG:25832", 1.0),
        ("EPSG:25832+6360", foot),
        ("EPSG:2229", foot * foot * foot),
        ("EPSG:2229+5703", foot * foot),
    ] {
        let (found, unit) = cut(&["--a-srs", system]);
        assert!(
            (found - 13.5 * factor).abs() < 1e-12 * found,
            "{system}: {found}"
        );
        assert_eq!(unit, "m3");
        let (yards, unit) = cut(&["--a-srs", system, "--unit", "yd3"]);
        assert!(
            (yards * 0.9144f64.powi(3) - found).abs() < 1e-12 * found,
            "{system}: {yards}"
        );
        assert_eq!(unit, "yd3");
        for (named, feet) in [("ft3", 1.0), ("acre-ft", 43_560.0)] {
            let (volume, unit) = cut(&["--a-srs", system, "--unit", named]);
            let cubic_meters = volume * feet * 0.3048f64.powi(3);
            assert!((cubic_meters - found).abs() < 1e-12 * found, "{system}");
            assert_eq!(unit, named);
        }
    }
    let words = ["a.xyz", "--plane", "1", "--a-srs", "EPSG:25832"];
    let areas = |unit| {
        let found = of(&folder, &[&words[..], &["--unit", unit]].concat());
        ["common_area", "slope_area"].map(|name| found["rows"][0][name].as_f64().unwrap())
    };
    let acre = 43_560.0 * 0.3048 * 0.3048;
    let squares = [
        ("m3", 1.0),
        ("yd3", 0.9144 * 0.9144),
        ("ft3", 0.3048 * 0.3048),
    ];
    for (unit, meters) in squares.into_iter().chain([("acre-ft", acre)]) {
        for (found, expected) in areas(unit).into_iter().zip(areas("m3")) {
            assert!(
                (found * meters - expected).abs() < 1e-12 * expected,
                "{unit}"
            );
        }
    }
    run_in(
        &folder,
        &["volume", "a.xyz", "--plane", "1", "--unit", "yd3"],
    )
    .fails(2, &["no coordinate system", "--a-srs CRS", "--unit"]);
}

#[test]
fn ground_swells_when_it_is_dug_out_and_shrinks_as_fill() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    // 3.375 are cut, and as much is to be filled.
    let plain = of(&folder, &["a.xyz", "--plane", "11.5"]);
    assert!(plain["rows"][0].get("balance").is_none());
    let both = &[
        "a.xyz", "--plane", "11.5", "--swell", "1.25", "--shrink", "0.75",
    ];
    let moved = [
        ("cut", 3.375),
        ("loose_cut", 3.375 * 1.25),
        ("bank_fill", 4.5),
        ("balance", -1.125),
        ("slope_area", 9.0 * 2.0_f64.sqrt()),
    ];
    near(&of(&folder, both)["rows"][0], &moved);
    let shrinks = &["a.xyz", "--plane", "11.5", "--shrink", "0.75"];
    near(
        &of(&folder, shrinks)["rows"][0],
        &[("loose_cut", 3.375), ("balance", -1.125)],
    );
    run_in(&folder, &[&["volume", "-o", "t.csv"], &both[..]].concat()).works(&[]);
    let table = String::from_utf8(bytes(&folder, "t.csv")).unwrap();
    assert!(
        table.starts_with("record,level,cut,fill,net,cut_area,fill_area,level_area,common_area,surface_only,base_only,slope_area,loose_cut,bank_fill,balance,unit,area_unit\n"),
        "{table}"
    );
    for factor in ["0", "-1", "nan", "inf", "0.25", "25"] {
        run_in(
            &folder,
            &["volume", "a.xyz", "--plane", "1", "--swell", factor],
        )
        .fails(2, &["--swell", factor]);
    }
}

#[test]
fn an_attribute_names_polygons() {
    let layer = r#"{"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::25832"}},"features":[
        {"type":"Feature","properties":{"Lot":"north, \"1\"","n":7},"geometry":{"type":"Polygon",
            "coordinates":[[[0,2],[3,2],[3,3],[0,3],[0,2]]]}},
        {"type":"Feature","properties":{"Lot":null,"n":8},"geometry":{"type":"Polygon",
            "coordinates":[[[0,0],[3,0],[3,1],[0,1],[0,0]]]}}]}"#;
    let folder = folder_with(&[("a.xyz", SLOPE), ("lots.geojson", layer)]);
    let words = |field: &'static str| {
        [
            "volume",
            "a.xyz",
            "--plane",
            "10",
            "--within",
            "lots.geojson",
            "--name-by",
            field,
        ]
    };
    let table = run_in(&folder, &[&words("LOT")[..], &["-o", "v.csv"]].concat());
    table.works(&[]);
    assert!(table.stdout.contains("north, \"1\""), "{}", table.stdout);
    let csv = String::from_utf8(bytes(&folder, "v.csv")).unwrap();
    let starts: Vec<&str> = csv
        .lines()
        .map(|line| &line[..line.len().min(23)])
        .collect();
    assert_eq!(starts[0], "record,name,level,cut,f");
    assert!(starts[1].starts_with("1,\"north, \"\"1\"\"\",10,"), "{csv}");
    assert!(starts[2].starts_with("2,,10,"), "{csv}");
    let rows = json(&run_in(&folder, &[&words("n")[..], &["--json"]].concat()));
    assert_eq!(
        (&rows["rows"][0]["name"], &rows["rows"][1]["name"]),
        (&"7".into(), &"8".into())
    );
    run_in(&folder, &words("street"))
        .fails(2, &["lots.geojson: there is no field street", "Lot, n"]);
    run_in(
        &folder,
        &["volume", "a.xyz", "--plane", "10", "--name-by", "n"],
    )
    .fails(2, &["--within"]);
}

#[test]
fn polygons_have_a_row_each() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("b.xyz", FLAT),
        (
            "zones.geojson",
            &polygons(&[
                "[[0,0],[2,0],[2,9],[0,9],[0,0]]",
                "[[2,-1],[9,-1],[9,9],[2,9],[2,-1]]",
                "[[70,0],[80,0],[80,1],[70,0]]",
            ]),
        ),
    ]);
    let run = run_in(
        &folder,
        &[
            "volume",
            "a.xyz",
            "b.xyz",
            "--within",
            "zones.geojson",
            "--json",
        ],
    );
    run.works(&[
        "warning: zones.geojson: record 3: nothing",
        "zones.geojson: 2 polygons are counted only where the surface and its base are (record 1: 3 of 18 m2, record 2: 3 of 70 m2)",
    ]);
    let found = json(&run);
    assert_eq!(found["unit"], "m3");
    let rows = &found["rows"];
    near(
        &rows[0],
        &[
            ("record", 1.0),
            ("polygon_area", 18.0),
            ("cut", 1.5),
            ("surface_only", 3.0),
            ("base_only", 0.0),
        ],
    );
    near(
        &rows[1],
        &[
            ("record", 2.0),
            ("cut", 4.5),
            ("surface_only", 0.0),
            ("base_only", 6.0),
        ],
    );
    near(
        &rows[2],
        &[("record", 3.0), ("cut", 0.0), ("common_area", 0.0)],
    );
    assert_eq!(rows.as_array().unwrap().len(), 3);
    let levels = [
        "volume",
        "a.xyz",
        "--levels",
        "11:12:1",
        "--within",
        "zones.geojson",
    ];
    assert_eq!(run_in(&folder, &levels).stdout.lines().count(), 8);
}

/// The corners of the base are on the plane but for rounding: nothing is cut, and nothing filled.
#[test]
fn a_plane_is_level_with_its_own_rim() {
    let plane = |[x, y]: [f64; 2]| 0.1 * x + 0.3 * y + 100.0 / 3.0;
    let corners = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0], [4.3, 3.9]];
    let points: Vec<String> = corners
        .iter()
        .map(|&[x, y]| format!("{x} {y} {}", plane([x, y])))
        .collect();
    let ring = "[[1.1,1.3],[7.7,2.1],[6.9,7.3],[2.3,5.9],[1.1,1.3]]";
    let folder = folder_with(&[
        ("p.xyz", &points.join("\n")),
        ("r.geojson", &polygons(&[ring])),
    ]);
    let words = ["p.xyz", "--a-srs", "EPSG:25832", "--max-edge", "none"];
    let rim = ["--base", "rim", "--within", "r.geojson"];
    let row = of(&folder, &[&words[..], &rim].concat())["rows"][0].clone();
    for number in ["cut", "fill", "cut_area", "fill_area"] {
        assert_eq!(row[number], 0.0, "{row}");
    }
    assert!(row["common_area"].as_f64().unwrap() > 20.0);
}

#[test]
fn a_pile_stands_on_its_rim() {
    let outline = |ring: &str| geojson(25832, "Polygon", &format!("[{ring}]"));
    let folder = folder_with(&[
        ("pile.xyz", PILE),
        ("foot.geojson", &outline("[[1,1],[3,1],[3,3],[1,3],[1,1]]")),
        ("far.geojson", &outline("[[1,1],[30,1],[3,3],[1,3],[1,1]]")),
    ]);
    let row = &of(
        &folder,
        &["pile.xyz", "--base", "rim", "--within", "foot.geojson"],
    )["rows"][0];
    near(
        row,
        &[
            ("cut", 4.0),
            ("fill", 0.0),
            ("cut_area", 4.0),
            ("surface_only", 0.0),
        ],
    );
    run_in(
        &folder,
        &[
            "volume",
            "pile.xyz",
            "--base",
            "rim",
            "--within",
            "far.geojson",
        ],
    )
    .fails(
        1,
        &[
            "far.geojson: record 1: the outline leaves the surface at 30 1",
            "within the surface",
        ],
    );
    run_in(&folder, &["volume", "pile.xyz", "--base", "rim"]).fails(2, &["--base rim", "--within"]);
}

#[test]
fn the_valley_and_its_dem_are_nearly_one_surface() {
    let folder = folder_with(&[]);
    let (points, dem) = (fixture("valley.laz"), fixture("dem.tif"));
    // The options are those of building the TIN; the DEM is read as it is.
    let found = of(&folder, &[&points, &dem, "--class", "ground"]);
    let row = &found["rows"][0];
    let number = |key: &str| row[key].as_f64().unwrap();
    let area = number("common_area");
    assert!(area > 100_000.0, "{row}");
    assert!(
        number("cut") / area < 0.05 && number("fill") / area < 0.05,
        "{row}"
    );
}

/// Returns a GeoJSON layer of features, each a type of geometry and its coordinates.
fn features(shapes: &[(&str, &str)]) -> String {
    let feature = |(kind, coordinates): &(&str, &str)| {
        format!(
            r#"{{"type":"Feature","properties":{{}},"geometry":{{"type":"{kind}","coordinates":{coordinates}}}}}"#
        )
    };
    collection(shapes.iter().map(feature))
}

#[test]
fn closed_lines_have_a_row_each_and_those_within_them_are_holes() {
    let lines = features(&[
        ("LineString", "[[0,0],[2,0],[2,2],[0,2],[0,0]]"),
        ("LineString", "[[1,1],[3,1],[3,3],[1,3],[1,1]]"),
        ("Polygon", "[[[0,0],[1,0],[1,1],[0,1],[0,0]]]"),
        ("LineString", "[[0.5,0.5],[1,0.5],[1,1],[0.5,1],[0.5,0.5]]"),
        ("LineString", "[[2,0],[3,0],[3,1]]"),
        ("LineString", "[[3,1],[2,1],[2,0]]"),
    ]);
    let twice = features(&[(
        "MultiPolygon",
        "[[[[0,0],[2,0],[2,2],[0,2],[0,0]]],[[[1,1],[3,1],[3,3],[1,3],[1,1]]]]",
    )]);
    let folder = folder_with(&[("a.xyz", SLOPE), ("l.json", &lines), ("m.json", &twice)]);
    let within = |name| {
        [
            "volume", "a.xyz", "--plane", "0", "--json", "--within", name,
        ]
    };
    let run = run_in(&folder, &within("l.json"));
    assert!(!run.stderr.contains("overlap"), "{}", run.stderr);
    let rows = &json(&run)["rows"];
    let areas = [(1.0, 3.75), (2.0, 4.0), (3.0, 1.0), (5.0, 1.0)];
    assert_eq!(rows.as_array().unwrap().len(), areas.len());
    for (row, (record, area)) in rows.as_array().unwrap().iter().zip(areas) {
        near(
            row,
            &[
                ("record", record),
                ("common_area", area),
                ("polygon_area", area),
            ],
        );
    }
    let run = run_in(&folder, &within("m.json"));
    run.works(&[
        "warning: m.json: record 1: rings overlap each other",
        "repair",
    ]);
    near(&json(&run)["rows"][0], &[("common_area", 6.0)]);
}

/// Two squares of 10 by 10, of which the second begins in the middle of the first.
#[test]
fn faces_that_overlap_are_named() {
    let square = |x: i32| [[x, 0], [x + 10, 0], [x + 10, 10], [x, 10]];
    let mesh = |second: i32| {
        let corners = [square(0), square(second)].concat();
        let vertices = corners.iter().map(|[x, y]| format!("v {x} {y} 5\n"));
        let faces = "f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\n".to_owned();
        vertices.chain([faces]).collect::<String>()
    };
    let folder = folder_with(&[("a.obj", &mesh(5)), ("b.obj", &mesh(20))]);
    let volume = |name| run_in(&folder, &["volume", name, "--plane", "0"]);
    volume("a.obj").works(&[
        "warning: a.obj: faces may overlap in plan (face 0, edge 2",
        "`breakline check a.obj` names all such places",
    ]);
    let apart = volume("b.obj");
    apart.works(&[]);
    assert!(!apart.stderr.contains("overlap"), "{}", apart.stderr);
}

/// A square of 3 by 3, beside which a point makes a triangle of 13.5.
#[test]
fn a_surface_that_has_lost_half_of_its_hull_is_named() {
    let square = (0..16).map(|i| format!("{} {} 2\n", i % 4, i / 4));
    let points = square.chain(["12 0 2\n".to_owned()]).collect::<String>();
    let folder = folder_with(&[("a.xyz", &points)]);
    let words = |limit| ["volume", "a.xyz", "--plane", "0", "--max-edge", limit];
    run_in(&folder, &words("5")).works(&[
        "warning: 60.0 % of the area of the convex hull is left out at the rim",
        "--max-edge LENGTH or --max-edge none",
    ]);
    let whole = run_in(&folder, &words("50"));
    whole.works(&[]);
    assert!(
        !whole.stderr.contains("convex hull is left out"),
        "{}",
        whole.stderr
    );
}

#[test]
fn what_makes_no_sense_is_refused_with_the_cure() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("b.xyz", FLAT),
        ("far.xyz", "70 0 1\n71 0 1\n70 1 1\n"),
        ("far.geojson", &polygons(&["[[70,0],[80,0],[80,1],[70,0]]"])),
        ("thin.geojson", &polygons(&["[[0,0],[1,1],[2,2],[0,0]]"])),
        (
            "line.geojson",
            &geojson(25832, "LineString", "[[0,0],[1,1]]"),
        ),
    ]);
    for (name, system) in [
        ("m.ply", "EPSG:25832"),
        ("u.ply", "EPSG:25833"),
        ("d.ply", "EPSG:4326"),
    ] {
        let tin = [
            "tin",
            "a.xyz",
            "--a-srs",
            system,
            "--force-degrees",
            "--max-edge",
            "none",
            "-o",
            name,
        ];
        run_in(&folder, &tin).works(&[]);
    }
    let wrong: &[(&[&str], i32, &[&str])] = &[
        (
            &["a.xyz"],
            2,
            &["the base of the volumes is missing", "--plane Z"],
        ),
        (
            &["a.xyz", "b.xyz", "--plane", "1"],
            2,
            &["b.xyz: two bases", "leave out"],
        ),
        (
            &["a.xyz", "b.xyz", "far.xyz"],
            2,
            &["far.xyz: a third surface", "quote a glob"],
        ),
        (&["a.xyz", "--plane", "nan"], 2, &["not a finite number"]),
        (
            &["a.xyz", "--plane", "1", "--levels", "1:2:1"],
            2,
            &["cannot be used with"],
        ),
        (&["a.xyz", "--levels", "2:1:1"], 2, &["FROM <= TO"]),
        (
            &["a.xyz", "--plane", "1e200"],
            1,
            &["extend over 1e200", "other units"],
        ),
        (
            &["a.xyz", "far.xyz", "-o", "t.csv"],
            2,
            &["a.xyz and far.xyz do not overlap", "compare their extents"],
        ),
        (
            &["a.xyz", "--plane", "1", "--within", "far.geojson"],
            2,
            &["far.geojson: no polygon is where", "compare their extents"],
        ),
        (&["a.xyz", "none.xyz"], 1, &["none.xyz: no such file"]),
        (
            &["a.xyz", "--plane", "1", "--within", "none.shp"],
            1,
            &["none.shp: no such file"],
        ),
        (
            &["a.xyz", "--plane", "1", "--within", "thin.geojson"],
            1,
            &[
                "thin.geojson: record 1: the polygon has no area",
                "remove the record",
            ],
        ),
        (
            &["a.xyz", "--plane", "1", "--within", "line.geojson"],
            1,
            &["line.geojson: record 1: the lines are not closed"],
        ),
        (
            &["m.ply", "u.ply"],
            1,
            &["two coordinate systems: m.ply is in", "u.ply in"],
        ),
        (
            &["d.ply", "--plane", "1", "--force-degrees"],
            1,
            &["degrees", "reproject"],
        ),
        (
            &["a.xyz", "--plane", "1", "-o", "t.json"],
            2,
            &["t.json", ".csv"],
        ),
        (
            &[
                "a.xyz",
                "--plane",
                "1",
                "-o",
                "a.csv",
                "--crossing-report",
                "r.csv",
            ],
            2,
            &["leave out --crossing-report"],
        ),
        (
            &["m.ply", "m.ply", "--class", "2"],
            2,
            &["m.ply: --class is for building a TIN"],
        ),
    ];
    let before = files_of(folder.path());
    for (words, code, said) in wrong {
        run_in(&folder, &[&["volume"], *words].concat()).fails(*code, said);
    }
    assert_eq!(files_of(folder.path()), before);
}
