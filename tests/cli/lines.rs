//! Lines and areas of all kinds, as typed.

use super::{SLOPE, folder_with, run_in};
use tempfile::TempDir;

/// A GeoJSON layer of features: kind of geometry, coordinates, properties.
fn features(list: &[(&str, &str, &str)]) -> String {
    let feature = |(kind, coordinates, properties): &(&str, &str, &str)| {
        format!(
            r#"{{"type":"Feature","properties":{properties},"geometry":{{"type":"{kind}","coordinates":{coordinates}}}}}"#
        )
    };
    let list: Vec<String> = list.iter().map(feature).collect();
    format!(
        r#"{{"type":"FeatureCollection","crs":{{"type":"name","properties":{{"name":"urn:ogc:def:crs:EPSG::25832"}}}},"features":[{}]}}"#,
        list.join(",")
    )
}

/// A folder with points on a slope and one layer.
fn folder(layer: &[(&str, &str, &str)]) -> TempDir {
    folder_with(&[("p.xyz", SLOPE), ("l.geojson", &features(layer))])
}

const LAKE: &str = "[[[0.5,0.5,9],[1.5,0.5,9],[1.5,1.5,9],[0.5,1.5,9],[0.5,0.5,9]]]";

#[test]
fn a_lake_is_level_in_every_product() {
    let folder = folder(&[("Polygon", LAKE, r#"{"W":8.5}"#)]);
    let tin = run_in(
        &folder,
        &[
            "tin",
            "p.xyz",
            "--flat",
            "l.geojson",
            "--flat-points",
            "out.csv",
            "-o",
            "t.ply",
            "-o",
            "t.tin",
        ],
    );
    tin.works(&[
        "1 in water or walls",
        "lakes       1 in, 4 edges out, of l.geojson",
    ]);
    assert_eq!(
        std::fs::read_to_string(folder.path().join("out.csv")).unwrap(),
        "x,y,z\n1,1,11\n"
    );
    for file in ["t.ply", "t.tin"] {
        let info = run_in(&folder, &["info", "--json", file]);
        assert!(info.stdout.contains("\"shores\": 4"), "{}", info.stdout);
        run_in(&folder, &["check", file]).works(&[]);
    }
    // The attribute, a number and the rules.
    for (height, z) in [("W", "8.5"), ("-3", "-3"), ("lowest", "9"), ("mean", "9")] {
        let args = [
            "tin",
            "p.xyz",
            "--flat",
            "l.geojson",
            "--flat-height",
            height,
            "-o",
            "h.obj",
            "--overwrite",
        ];
        run_in(&folder, &args).works(&[]);
        let obj = std::fs::read_to_string(folder.path().join("h.obj")).unwrap();
        let level = obj
            .lines()
            .filter(|line| line.starts_with('v') && line.ends_with(&format!(" {z}")))
            .count();
        assert_eq!(level, 4, "{height}: {obj}");
    }
}

#[test]
fn summaries_say_what_lines_became() {
    let line = "[[0.2,2.5,20],[2.8,2.5,20]]";
    let folder = folder(&[("LineString", line, r#"{"D":4}"#)]);
    for (option, more, said) in [
        (
            "--soft-lines",
            vec![],
            "soft lines  1 in, 1 edges out, of l.geojson",
        ),
        (
            "--walls",
            vec!["--wall-drop", "D"],
            "walls       1 in, 2 edges out, of l.geojson",
        ),
        (
            "--walls",
            vec!["--wall-bottom", "1"],
            "walls       1 in, 2 edges out, of l.geojson",
        ),
        (
            "--rivers",
            vec!["--river-width", "0.3"],
            "rivers      1 in, 6 edges out, of l.geojson",
        ),
        ("--draped-lines", vec![], "draped      1 in, of l.geojson ("),
        (
            "--breaklines",
            vec!["--densify", "0.5"],
            "breaklines  1 in, 6 edges out",
        ),
    ] {
        let run = run_in(
            &folder,
            &[
                &[
                    "tin",
                    "p.xyz",
                    option,
                    "l.geojson",
                    "-o",
                    "t.tin",
                    "--overwrite",
                ],
                &more[..],
            ]
            .concat(),
        );
        run.works(&[said]);
        run_in(&folder, &["check", "t.tin"]).works(&[]);
    }
}

#[test]
fn the_longest_edge_can_follow_from_the_points() {
    let folder = folder_with(&[("p.xyz", SLOPE)]);
    run_in(
        &folder,
        &["tin", "p.xyz", "--max-edge", "auto", "-o", "t.ply"],
    )
    .works(&["75 units"]);
    let run = run_in(
        &folder,
        &["tin", "p.xyz", "--max-edge-inside", "0.5", "-o", "u.ply"],
    );
    run.fails(1, &["no triangle is left"]);
}

/// Each mistake is an error that names what is wrong, or a warning; an error writes nothing.
#[test]
fn mistakes_are_named() {
    let open = "[[0.5,0.5,9],[1.5,0.5,9],[1.5,1.5,9]]";
    let flat = "[[0.5,0.5],[2.5,0.5]]";
    let nothing = "[[[0.5,0.5,9],[1.5,1.5,9],[0.5,0.5,9],[0.5,0.5,9]]]";
    let uneven = "[[[0.5,0.5,9],[1.5,0.5,9.5],[1.5,1.5,9],[0.5,0.5,9]]]";
    let other = "[[[1,1,7],[2.5,1,7],[2.5,2.5,7],[1,1,7]]]";
    let all = "[[[-9,-9],[9,-9],[9,9],[-9,9],[-9,-9]]]";
    let line = "[[0.5,0.5,9],[2.5,0.5,9]]";
    let two = "[[[0.2,0.4,5],[2.8,0.4,3]],[[0.2,1.4,5],[2.8,1.4,3]]]";
    type Case<'a> = (
        &'a [(&'a str, &'a str, &'a str)],
        &'a [&'a str],
        &'a [&'a str],
    );
    let cases: [Case; 12] = [
        (
            &[("Polygon", LAKE, "{}")],
            &["--rivers", "l.geojson"],
            &["record 1: a polygon is not a bank"],
        ),
        (
            &[("LineString", line, "{}"), ("MultiLineString", two, "{}")],
            &["--rivers", "l.geojson"],
            &["record 2: the record has two banks, but the record before has one"],
        ),
        (
            &[("LineString", open, "{}")],
            &["--flat", "l.geojson"],
            &["record 1: the shore is open", "close"],
        ),
        (
            &[("Polygon", nothing, "{}")],
            &["--flat", "l.geojson"],
            &["record 1: the shore at 0.5 0.5 encloses nothing"],
        ),
        (
            &[("Polygon", uneven, "{}")],
            &["--flat", "l.geojson"],
            &["the shore is not level: its heights are 9 to 9.5"],
        ),
        (
            &[("Polygon", LAKE, "{}"), ("Polygon", other, "{}")],
            &["--flat", "l.geojson"],
            &[
                "two lakes meet at",
                "l.geojson record 1",
                "l.geojson record 2",
            ],
        ),
        (
            &[("LineString", flat, "{}")],
            &["--soft-lines", "l.geojson"],
            &["the line has no heights", "--draped-lines"],
        ),
        (
            &[("LineString", flat, "{}")],
            &["--rivers", "l.geojson"],
            &["the line has no heights"],
        ),
        (
            &[("LineString", line, "{}")],
            &["--rivers", "l.geojson"],
            &["the bank has no opposite bank"],
        ),
        (
            &[("LineString", line, "{}")],
            &["--walls", "l.geojson"],
            &["the lower edge of the wall is not known"],
        ),
        (
            &[("LineString", line, "{}")],
            &["--walls", "l.geojson", "--wall-drop", "0"],
            &["record 1: the wall has no height"],
        ),
        (
            &[("Polygon", all, "{}")],
            &["--holes", "l.geojson"],
            &["no triangle is left"],
        ),
    ];
    for (layer, args, said) in cases {
        let folder = folder(layer);
        run_in(&folder, &[&["tin", "p.xyz", "-o", "t.ply"], args].concat()).fails(1, said);
        assert!(!folder.path().join("t.ply").exists(), "{args:?}");
    }
    let folder = folder(&[("LineString", line, "{}")]);
    let run = run_in(
        &folder,
        &[
            "tin",
            "p.xyz",
            "--walls",
            "l.geojson",
            "--wall-drop",
            "DEPTH",
            "-o",
            "t.ply",
        ],
    );
    run.fails(2, &["l.geojson: there is no field DEPTH"]);
}

#[test]
fn what_looks_wrong_is_a_warning() {
    let banks = "[[[0.2,0.4,5],[1.2,0.4,7],[2.8,0.4,3]],[[0.2,1.4,5],[2.8,1.4,3]]]";
    let river = folder(&[("MultiLineString", banks, "{}")]);
    let run = run_in(
        &river,
        &["tin", "p.xyz", "--rivers", "l.geojson", "-o", "t.ply"],
    );
    run.works(&[
        "warning: the banks of the river l.geojson record 1",
        "differ by up to",
    ]);
    let shore = folder(&[("Polygon", LAKE, "{}")]);
    let run = run_in(
        &shore,
        &["tin", "p.xyz", "--breaklines", "l.geojson", "-o", "t.ply"],
    );
    run.works(&[
        "warning: a closed line of one height has 1 point of other heights inside, by up to 2",
        "--flat",
    ]);
    let hairpin = folder(&[("LineString", "[[0.2,1,5],[2.5,1,4],[0.2,1.1,3]]", "{}")]);
    let run = run_in(
        &hairpin,
        &[
            "tin",
            "p.xyz",
            "--rivers",
            "l.geojson",
            "--river-width",
            "0.6",
            "-o",
            "t.ply",
        ],
    );
    run.works(&[
        "warning: the banks of the river l.geojson record 1 meet near",
        "twice is not water",
    ]);
    let quay = folder_with(&[
        ("p.xyz", SLOPE),
        ("lake.geojson", &features(&[("Polygon", LAKE, "{}")])),
        (
            "quay.geojson",
            &features(&[("LineString", "[[0.5,0.5,11],[1.5,0.5,11]]", "{}")]),
        ),
    ]);
    let args = [
        "tin",
        "p.xyz",
        "--flat",
        "lake.geojson",
        "--walls",
        "quay.geojson",
        "--wall-drop",
        "2",
        "-o",
        "t.ply",
    ];
    run_in(&quay, &args).works(&[
        "2 vertices of walls have the height of water",
        "of quay.geojson record 1",
    ]);
    let far = folder(&[("Polygon", "[[[50,50],[51,50],[51,51],[50,50]]]", "{}")]);
    for option in ["--holes", "--draped-lines"] {
        let run = run_in(
            &far,
            &[
                "tin",
                "p.xyz",
                option,
                "l.geojson",
                "-o",
                "t.ply",
                "--overwrite",
            ],
        );
        run.works(&[&format!("warning: nothing of {option} lies on the surface")]);
    }
}

/// Reaches that begin above the end of the one before.
#[test]
fn lowered_rivers_are_named_with_those_that_lower_them() {
    let reaches = [
        ("LineString", "[[0.2,1,5],[1.5,1,4]]", "{}"),
        ("LineString", "[[1.5,1,4.5],[2.2,1,3]]", "{}"),
        ("LineString", "[[2.2,1,3.2],[2.8,1,2]]", "{}"),
    ];
    let args = [
        "tin",
        "p.xyz",
        "--rivers",
        "l.geojson",
        "--river-width",
        "0.4",
        "-o",
        "t.ply",
    ];
    let first = [
        "the river l.geojson record 2 is lowered by up to 0.5",
        "from 1.5 1 on, to the river l.geojson record 1",
    ];
    let second = [
        "the river l.geojson record 3 is lowered by up to 0.2",
        "from 2.2 1 on, to the river l.geojson record 2",
    ];
    let run = run_in(&folder(&reaches[..2]), &args);
    run.works(&[&first[..], &["correct the heights of either"]].concat());
    assert!(!run.stderr.contains("not level"), "{}", run.stderr);
    let run = run_in(&folder(&reaches), &args);
    run.works(
        &[
            &["warning: 2 rivers are lowered to others"],
            &first[..],
            &second[..],
        ]
        .concat(),
    );
}

/// Steps between waters, and confluences.
#[test]
fn waters_that_meet_are_reported_where_they_contradict_each_other() {
    let across = ("LineString", "[[0.2,1,5],[2.8,1,5]]", "{}");
    let over = ("LineString", "[[1.5,2.8,8],[1.5,0.2,7]]", "{}");
    let args = [
        "tin",
        "p.xyz",
        "--rivers",
        "l.geojson",
        "--river-width",
        "0.5",
        "-o",
        "t.ply",
    ];
    let said = [
        "warning: two waters overlap or touch, and the lower height, or that of the lake, counts: a step of 2.4 m at",
        ", from l.geojson record 2 to l.geojson record 1",
    ];
    let crossing = folder(&[across, over]);
    run_in(&crossing, &args).works(&said);
    let tiled = [
        "dem",
        "p.xyz",
        "--tiles",
        "2x2",
        "--resolution",
        "0.5",
        "-o",
        "t.tif",
    ];
    run_in(&crossing, &[&tiled[..], &args[2..6]].concat()).works(&said);
    let tolerant = [&args[..], &["--crossing-tolerance", "2.5", "--overwrite"]].concat();
    assert!(!run_in(&crossing, &tolerant).stderr.contains("overlap"));
    let lake = features(&[("Polygon", LAKE, "{}")]);
    let folder_of = |rivers: &[(&str, &str, &str)]| {
        folder_with(&[
            ("p.xyz", SLOPE),
            ("l.geojson", &features(rivers)),
            ("lake.geojson", &lake),
        ])
    };
    let run = run_in(
        &folder_of(&[across, over]),
        &[&args[..], &["--flat", "lake.geojson"]].concat(),
    );
    run.works(&[
        "3 pairs of waters overlap or touch",
        "a step of 4 m at",
        "from l.geojson record 1 to lake.geojson record 1",
    ]);
    // A tributary from the north, which ends on the bank of the first river, rounded to mm.
    let main = (
        "MultiLineString",
        "[[[0.2,1.2,5],[2.8,1.2,4]],[[0.2,0.6,5],[2.8,0.6,4]]]",
        "{}",
    );
    let lowered = [
        "the river l.geojson record 1, part 1 is lowered by up to 0.3",
        "from 1.5 0.9005 on, to the river l.geojson record 2",
    ];
    for (south, said) in [(4.9, &[][..]), (4.2, &lowered)] {
        let bank = |x: f64| format!("[[{x},2.8,6],[{x},1.201,{south}]]");
        let tributary = format!("[{},{}]", bank(1.7), bank(1.5));
        let rivers = folder(&[main, ("MultiLineString", &tributary, "{}")]);
        let run = run_in(
            &rivers,
            &["tin", "p.xyz", "--rivers", "l.geojson", "-o", "t.ply"],
        );
        run.works(said);
        let is_reported = [&run.stderr, &run.stdout]
            .iter()
            .any(|text| text.contains("warning: the"));
        assert_eq!(
            is_reported,
            !said.is_empty(),
            "{}{}",
            run.stdout,
            run.stderr
        );
        assert!(
            !run.stderr.contains("overlap") && !run.stdout.contains("overlap"),
            "{}{}",
            run.stdout,
            run.stderr
        );
    }
}

/// Rings of a summit, as lines.
const SUMMIT: [(&str, &str, &str); 3] = [
    (
        "LineString",
        "[[0,0,10],[90,0,10],[90,90,10],[0,90,10],[0,0,10]]",
        "{}",
    ),
    (
        "LineString",
        "[[20,20,15],[70,20,15],[70,70,15],[20,70,15],[20,20,15]]",
        "{}",
    ),
    (
        "LineString",
        "[[35,35,20],[55,35,20],[55,55,20],[35,55,20],[35,35,20]]",
        "{}",
    ),
];

#[test]
fn contours_alone_are_a_surface() {
    let folder = folder(&SUMMIT);
    let flat = [
        "2 triangles, 4.9 % of the area, are flat",
        "(--add-ridges adds vertices",
    ];
    run_in(
        &folder,
        &["tin", "--breaklines", "l.geojson", "-o", "a.ply"],
    )
    .works(&flat);
    let plain = run_in(&folder, &["tin", "l.geojson", "-o", "b.ply"]);
    plain.works(&flat);
    plain.works(&["note: l.geojson: lines are breaklines"]);
    let file = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert!(file("a.ply") == file("b.ply"));
    let cured = run_in(
        &folder,
        &["tin", "l.geojson", "--add-ridges", "-o", "c.ply"],
    );
    cured.works(&["1 vertices were added on ridges and valleys"]);
    assert!(!cured.stderr.contains("are flat"), "{}", cured.stderr);
    run_in(
        &folder,
        &["dem", "l.geojson", "--resolution", "5", "-o", "d.tif"],
    )
    .works(&flat);
    // With points, and where no line can be one.
    run_in(&folder, &["tin", "p.xyz", "l.geojson", "-o", "e.ply"]).works(&["breaklines  3 in"]);
    run_in(&folder, &["tin", "a.ply", "l.geojson", "-o", "f.ply"])
        .fails(2, &["is a surface, and cannot be combined"]);
    run_in(&folder, &["tin", "-o", "g.ply"]).fails(2, &["required"]);
    run_in(
        &folder,
        &[
            "tin",
            "p.xyz",
            "--add-ridges",
            "--tiles",
            "2x2",
            "-o",
            "h.tins",
        ],
    )
    .fails(1, &["--add-ridges does not work with tiles yet"]);
}

#[test]
fn each_lake_has_the_lowest_height_of_its_shore() {
    let low = "[[[0.2,0.2,9],[1.2,0.2,9.21],[1.2,1.2,9.05],[0.2,1.2,9],[0.2,0.2,9]]]";
    let high = "[[[1.6,1.6,12],[2.6,1.6,12.02],[2.6,2.6,12],[1.6,2.6,12],[1.6,1.6,12]]]";
    let folder = folder(&[("Polygon", low, "{}"), ("Polygon", high, "{}")]);
    let run = run_in(
        &folder,
        &["tin", "p.xyz", "--flat", "l.geojson", "-o", "a.obj"],
    );
    run.works(&[
        "note: the shores of 2 lakes are not level: each lake has the lowest height of its shore, such as 9 m of l.geojson record 1",
        "the shore rises up to 0.21 m above it (--flat-height)",
    ]);
    let obj = std::fs::read_to_string(folder.path().join("a.obj")).unwrap();
    for level in [" 9", " 12"] {
        let of_level = obj
            .lines()
            .filter(|line| line.starts_with("v ") && line.ends_with(level));
        assert!(of_level.count() >= 4, "{level}: {obj}");
    }
    let strict = [
        "tin",
        "p.xyz",
        "--flat",
        "l.geojson",
        "--flat-tolerance",
        "0.1",
        "-o",
        "b.obj",
    ];
    run_in(&folder, &strict).fails(
        1,
        &[
            "record 1",
            "the shore is not level: its heights are 9 to 9.21",
        ],
    );
}

/// A channel beside a lake, drawn as a lake of its own, shares a part of its shore.
#[test]
fn lakes_that_meet_have_the_height_of_the_largest() {
    let lake = "[[[0.2,0.2,9],[1.7,0.2,9],[1.7,1.2,9],[1.7,1.5,9],[0.2,1.5,9],[0.2,0.2,9]]]";
    let channel = "[[[1.7,1.2,8.95],[2.6,1.2,8.97],[2.6,1.5,9.1],[1.7,1.5,9],[1.7,1.2,8.95]]]";
    let folder = folder(&[("Polygon", channel, "{}"), ("Polygon", lake, "{}")]);
    let said = "l.geojson record 1 meets a larger lake, l.geojson record 2, and has its height, which is 0.05 m";
    run_in(
        &folder,
        &["tin", "p.xyz", "--flat", "l.geojson", "-o", "a.obj"],
    )
    .works(&[said]);
    let obj = std::fs::read_to_string(folder.path().join("a.obj")).unwrap();
    let of_lakes = obj
        .lines()
        .filter(|line| line.starts_with("v ") && line.ends_with(" 9"));
    assert_eq!(of_lakes.count(), 7, "{obj}");
    let given = [
        "tin",
        "p.xyz",
        "--flat",
        "l.geojson",
        "--flat-height",
        "lowest",
        "-o",
        "b.obj",
    ];
    run_in(&folder, &given).fails(1, &["two lakes meet at"]);
}

#[test]
fn a_condition_chooses_the_records_of_the_layer_before_it() {
    let line = |y: f64| format!("[[0.2,{y},9],[1.8,{y},9]]");
    let lines = [line(0.5), line(0.8), line(1.3)];
    let folder = folder(&[
        ("LineString", &lines[0], r#"{"kind":"toe","width":2.5}"#),
        ("LineString", &lines[1], r#"{"kind":"top","width":null}"#),
        ("LineString", &lines[2], r#"{"kind":"Toe","width":4}"#),
    ]);
    let tin = |words: &[&str]| {
        let all = [&["tin", "p.xyz", "-o", "t.ply", "--overwrite"], words].concat();
        run_in(&folder, &all)
    };
    for (condition, count) in [
        ("kind='toe'", 1),
        ("kind ILIKE 'toe'", 2),
        ("width IS NULL OR width > 3", 2),
        ("NOT width > 3", 1),
    ] {
        let summary = format!("breaklines  {count} in");
        tin(&["--breaklines", "l.geojson", "--where", condition]).works(&[&summary]);
        let one_word = format!("l.geojson WHERE {condition}");
        tin(&["--breaklines", &one_word]).works(&[&summary]);
    }
    // Each option has its own, also of the same file.
    tin(&[
        "--breaklines",
        "l.geojson",
        "--where",
        "kind='toe'",
        "--soft-lines=l.geojson",
        "--where=kind='top'",
    ])
    .works(&["breaklines  1 in", "soft lines  1 in"]);
    let of = |condition: &str| tin(&["--breaklines", "l.geojson", "--where", condition]);
    of("kind = 'x'").works(&["none of 3 records is true for `kind = 'x'`"]);
    of("knd = 'x'").fails(
        2,
        &[
            "l.geojson",
            "condition `knd = 'x'`",
            "no field knd",
            "is \"kind\" meant?",
        ],
    );
    of("kind =").fails(2, &["character 7: expected an attribute or a value"]);
    of("kind > 5").fails(1, &["l.geojson", "record 1", "'toe' and 5 has no order"]);
    tin(&["--where", "kind = 'x'"]).fails(2, &["--where is not after a layer"]);
    run_in(
        &folder,
        &["tin", "p.xyz", "--where", "class = 2", "-o", "t.ply"],
    )
    .fails(2, &["p.xyz", "--where chooses records of a layer"]);
    // Records keep their numbers.
    let flat = "[[0.2,0.5],[1.8,0.5]]";
    let layer = features(&[
        ("LineString", &lines[0], r#"{"kind":"top"}"#),
        ("LineString", flat, r#"{"kind":"toe"}"#),
    ]);
    std::fs::write(folder.path().join("l.geojson"), layer).unwrap();
    of("kind = 'toe'").fails(1, &["record 2", "no heights"]);
    of("kind = 'top'").works(&["breaklines  1 in"]);
}
