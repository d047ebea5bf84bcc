//! Draped lines as they are typed.

use serde_json::Value;

use super::{SLOPE, bytes, files_of, fixture, folder_with, geojson, run_in};

/// Two lines with attributes of all kinds: one leaves [`SLOPE`] and comes back, one is beside it.
fn lines() -> String {
    let system = r#"{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::25832"}}"#;
    let row = r#""name":"Weg \"A\", Höhe","lanes":2,"width":2.5,"open":true,"note":null,"a_name_of_14_1":1,"a_name_of_14_2":-7"#;
    format!(
        r#"{{"type":"FeatureCollection","crs":{system},"features":[
{{"type":"Feature","properties":{{{row}}},"geometry":{{"type":"LineString","coordinates":[[0.5,0.5,99],[2.5,1.5,99],[9,1.5,99],[9,2,99],[1,2,99]]}}}},
{{"type":"Feature","properties":{{"name":"off"}},"geometry":{{"type":"LineString","coordinates":[[10,0],[12,1]]}}}}]}}"#
    )
}

fn features(text: &[u8]) -> Vec<Value> {
    let all: Value = serde_json::from_slice(text).unwrap();
    all["features"].as_array().unwrap().clone()
}

#[test]
fn a_geopackage_keeps_what_geojson_has() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("l.geojson", &lines())]);
    let drape = |lines: &str, output: &str| {
        let words = ["drape", "a.xyz", "--lines", lines, "-o", output];
        run_in(&folder, &words).works(&[output]);
    };
    drape("l.geojson", "o.gpkg");
    drape("l.geojson", "direct.geojson");
    drape("o.gpkg:o", "again.geojson");
    let [again, direct] =
        ["again.geojson", "direct.geojson"].map(|name| features(&bytes(&folder, name)));
    for (again, direct) in again.iter().zip(&direct) {
        for (name, value) in direct["properties"].as_object().unwrap() {
            assert_eq!(&again["properties"][name], value, "{name}");
        }
        assert_eq!(again["geometry"]["type"], direct["geometry"]["type"]);
    }
    // Lines that lie on the surface stay as they are, up to the last bit of a crossing.
    assert_eq!(again.len(), direct.len());
    run_in(
        &folder,
        &["tin", "a.xyz", "--breaklines", "o.gpkg", "-o", "t.ply"],
    )
    .works(&["breaklines  2 in, 9 edges out"]);
    run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "--breaklines",
            "o.gpkg:p",
            "-o",
            "t.ply",
            "--overwrite",
        ],
    )
    .fails(2, &["there is no layer \"p\"", "FILE:LAYER: o"]);
    run_in(&folder, &["contour", "a.xyz", "-o", "c.gpkg"]).works(&["c.gpkg"]);
    let facts = run_in(&folder, &["info", "c.gpkg"]).stdout;
    assert!(facts.contains("GeoPackage LINESTRING") && facts.contains("ID, ELEV"));
    assert_eq!(
        files_of(folder.path()),
        [
            "a.xyz",
            "again.geojson",
            "c.gpkg",
            "direct.geojson",
            "l.geojson",
            "o.gpkg",
            "t.ply"
        ]
    );
}

#[test]
fn lines_get_heights_at_every_edge_and_keep_their_attributes() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("l.geojson", &lines())]);
    let words = [
        "drape",
        "a.xyz",
        "--lines",
        "l.geojson",
        "-o",
        "o.geojson",
        "-o",
        "o.shp",
        "-o",
        "o.dxf",
        "--json",
    ];
    let run = run_in(&folder, &words);
    run.works(&[
        "warning: l.geojson: record 2: not on a.xyz",
        "warning: l.geojson: record 1: only in part on a.xyz",
        "warning: o.shp: attribute a_name_of_14_2 is called a_name_o_1",
        "warning: o.dxf: a DXF drawing has no attributes",
        "lines       2 records, 2 parts on the surface with ",
    ]);
    let counts: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(
        (&counts["off"][0], &counts["partly_off"][0]),
        (&2.into(), &1.into())
    );
    let found = features(&bytes(&folder, "o.geojson"));
    let properties = &features(lines().as_bytes())[0]["properties"];
    assert_eq!(&found[0]["properties"], properties);
    assert_eq!(found[1]["geometry"], Value::Null);
    assert_eq!(found[1]["properties"]["name"], "off");
    let parts = found[0]["geometry"]["coordinates"].as_array().unwrap();
    assert_eq!((parts.len(), &counts["parts"]), (2, &2.into()));
    let vertices: usize = parts
        .iter()
        .map(|part| part.as_array().unwrap().len())
        .sum();
    assert_eq!(counts["vertices"], vertices);
    for position in parts.iter().flat_map(|part| part.as_array().unwrap()) {
        let [x, z] = [0, 2].map(|k| position[k].as_f64().unwrap());
        assert!((z - 10.0 - x).abs() < 1e-14, "{position}");
    }
    // From the shapefile, the same: values and types are kept.
    let again = [
        "drape",
        "a.xyz",
        "--lines",
        "o.shp",
        "-o",
        "again.geojson",
        "-q",
    ];
    let run = run_in(&folder, &again);
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    let again = features(&bytes(&folder, "again.geojson"));
    assert_eq!(again[0]["geometry"], found[0]["geometry"]);
    for name in ["name", "lanes", "width", "open", "note"] {
        assert_eq!(again[0]["properties"][name], properties[name], "{name}");
    }
    assert_eq!(again[0]["properties"]["a_name_o_1"], -7);
    let drawing = String::from_utf8(bytes(&folder, "o.dxf")).unwrap();
    assert_eq!(drawing.matches("\nPOLYLINE\n").count(), 2);
}

#[test]
fn by_a_step_lines_keep_their_vertices() {
    let line = geojson(25832, "LineString", "[[0,1],[1.25,1],[1.25,2.5]]");
    let folder = folder_with(&[("a.xyz", SLOPE), ("l.geojson", &line)]);
    let words = [
        "drape",
        "a.xyz",
        "--lines",
        "l.geojson",
        "--step",
        "1",
        "-o",
        "o.geojsonl",
    ];
    run_in(&folder, &words).works(&[]);
    let text = bytes(&folder, "o.geojsonl");
    let feature: Value = serde_json::from_slice(&text).unwrap();
    let found: Vec<Vec<f64>> =
        serde_json::from_value(feature["geometry"]["coordinates"].clone()).unwrap();
    let expected = [
        [0.0, 1.0, 10.0],
        [1.0, 1.0, 11.0],
        [1.25, 1.0, 11.25],
        [1.25, 1.75, 11.25],
        [1.25, 2.5, 11.25],
    ];
    assert_eq!(found, expected);
}

#[test]
fn a_raster_and_a_tin_in_its_file_are_surfaces() {
    let folder = folder_with(&[
        (
            "l.geojson",
            &geojson(25832, "LineString", "[[0.2,0.7],[2.9,2.2]]"),
        ),
        ("a.xyz", SLOPE),
    ]);
    run_in(&folder, &["tin", "a.xyz", "-o", "a.tin"]).works(&[]);
    run_in(
        &folder,
        &["dem", "a.xyz", "--resolution", "0.5", "-o", "a.tif"],
    )
    .works(&[]);
    for surface in ["a.tin", "a.tif"] {
        let words = [
            "drape",
            surface,
            "--lines",
            "l.geojson",
            "--overwrite",
            "-o",
            "o.geojson",
        ];
        run_in(&folder, &words).works(&[]);
        let found = features(&bytes(&folder, "o.geojson"));
        let line = found[0]["geometry"]["coordinates"].as_array().unwrap();
        assert!(line.len() > 2, "{surface}");
        for position in line {
            let [x, z] = [0, 2].map(|k| position[k].as_f64().unwrap());
            assert!((z - 10.0 - x).abs() < 1e-6, "{surface}: {position}");
        }
    }
    let valley = fixture("valley.laz");
    let breaklines = fixture("breaklines.shp");
    let words = ["drape", &valley, "--lines", &breaklines, "-o", "v.shp"];
    run_in(&folder, &words).works(&["on the surface"]);
}

#[test]
fn what_cannot_be_draped_is_an_error_and_writes_nothing() {
    let far = geojson(25832, "LineString", "[[50,50],[60,60]]");
    let points = geojson(25832, "Point", "[1,1]");
    let other = geojson(25833, "LineString", "[[0,1],[2,1]]");
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("far.geojson", &far),
        ("points.geojson", &points),
        (
            "empty.geojson",
            r#"{"type":"FeatureCollection","features":[]}"#,
        ),
        ("other.geojson", &other),
    ]);
    let before = files_of(folder.path());
    let draped = |words: &[&str]| {
        run_in(
            &folder,
            &[&["drape", "a.xyz", "-o", "o.shp"], words].concat(),
        )
    };
    draped(&["--lines", "far.geojson"]).fails(
        2,
        &["far.geojson: no line is on a.xyz", "coordinate system"],
    );
    draped(&["--lines", "points.geojson"]).fails(1, &["points.geojson", "no lines"]);
    draped(&["--lines", "empty.geojson"]).fails(1, &["empty.geojson", "no lines"]);
    let profile = [
        "profile",
        "a.xyz",
        "--along",
        "empty.geojson",
        "-o",
        "o.csv",
    ];
    run_in(&folder, &profile).fails(1, &["empty.geojson", "no lines"]);
    draped(&["--lines", "missing.shp"]).fails(1, &["missing.shp"]);
    draped(&["--lines", "far.geojson", "--step", "0"]).fails(2, &["0 is not above zero"]);
    draped(&[]).fails(2, &["--lines"]);
    run_in(
        &folder,
        &["drape", "a.xyz", "--lines", "far.geojson", "-o", "o.tif"],
    )
    .fails(2, &["o.tif", ".shp"]);
    let words = [
        "drape",
        "a.xyz",
        "--a-srs",
        "EPSG:25832",
        "--lines",
        "far.geojson",
        "-o",
        "far.geojson",
        "--overwrite",
    ];
    run_in(&folder, &words).fails(2, &["far.geojson"]);
    let near = geojson(25832, "LineString", "[[0,1],[2,1]]");
    std::fs::write(folder.path().join("near.geojson"), near).unwrap();
    let tiny = ["--lines", "near.geojson", "--step", "1e-9"];
    draped(&tiny).fails(1, &["by a step of", "--step"]);
    std::fs::remove_file(folder.path().join("near.geojson")).unwrap();
    // The system that is stated is that of all inputs of one run; two files state two.
    run_in(
        &folder,
        &["tin", "a.xyz", "--a-srs", "EPSG:25832", "-o", "a.ply"],
    )
    .works(&[]);
    run_in(
        &folder,
        &["drape", "a.ply", "--lines", "other.geojson", "-o", "o.shp"],
    )
    .fails(1, &["25833"]);
    std::fs::remove_file(folder.path().join("a.ply")).unwrap();
    assert_eq!(files_of(folder.path()), before);
}

#[test]
fn records_that_are_off_are_listed_by_their_numbers() {
    let off = |count: usize| {
        let line = |x: usize| format!("[[{},0],[{},1]]", x + 10, x + 10);
        let feature = |coordinates: String| {
            format!(
                r#"{{"type":"Feature","properties":{{}},"geometry":{{"type":"LineString","coordinates":{coordinates}}}}}"#
            )
        };
        let lines = std::iter::once("[[0,1],[2,1]]".to_owned()).chain((0..count).map(line));
        lines.map(feature).collect::<Vec<_>>().join("\n")
    };
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("one.geojsonl", &off(1)),
        ("few.geojsonl", &off(3)),
        ("many.geojsonl", &off(9)),
    ]);
    for (name, text) in [
        ("one", "record 2: not on a.xyz"),
        ("few", "records 2, 3, 4: not on a.xyz"),
        ("many", "records 2, 3, 4, 5, 6 and 4 more: not on a.xyz"),
    ] {
        let lines = format!("{name}.geojsonl");
        let words = ["drape", "a.xyz", "--lines", &lines, "-o", "o.geojson"];
        run_in(
            &folder,
            &[&words[..], &["--overwrite", "--a-srs", "EPSG:25832"]].concat(),
        )
        .works(&[&format!("warning: {lines}: {text}")]);
    }
}
