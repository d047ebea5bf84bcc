//! What runs leave and say.

use super::{SLOPE, bytes, fixture, folder_with, geojson, run_in, run_with};
use testkit::lidar;

#[test]
fn a_run_ends_with_a_summary_on_stderr_and_nothing_on_stdout() {
    let folder = folder_with(&[]);
    let (points, lines) = (fixture("valley.laz"), fixture("breaklines.shp"));
    let run = run_in(
        &folder,
        &[
            "tin",
            &points,
            "--breaklines",
            &lines,
            "--max-edge",
            "none",
            "-o",
            "t.ply",
        ],
    );
    run.works(&[
        "note: points of class 2 (ground) are used",
        "62776 read, 59177 used",
        "40 withheld",
        "5: 2925, 6: 180, 9: 454",
        "25 at the position of another point (the lowest is kept)",
        "9 in, 1334 edges out",
        "vertices    60492",
        "triangles   120954",
        "EPSG:25832 (ETRS89 / UTM zone 32N), metre",
        "written     t.ply",
        "done in ",
    ]);
    assert_eq!(run.stdout, "");
    let quiet = run_in(
        &folder,
        &["tin", &points, "-q", "--max-edge", "none", "-o", "q.ply"],
    );
    assert_eq!(
        (quiet.code, quiet.stderr.as_str(), quiet.stdout.as_str()),
        (0, "", "")
    );

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
    assert_eq!(
        check.stdout,
        "60492 vertices, 120954 triangles, 1334 constrained edges: no flaw found\n"
    );
}

#[test]
fn classes_are_chosen() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let points = fixture("valley.laz");
    let run = run_in(&folder, &["tin", &points, "--class", "5,6", "-o", "t.ply"]);
    run.works(&["3105 used", "2: 59177, 9: 454"]);
    let run = run_in(&folder, &["tin", &points, "--class", "11", "-o", "u.ply"]);
    run.fails(
        1,
        &[
            "warning: no point has class 11",
            "no point is left of 62776 read",
            "hint: ",
            "2, 5, 6, 9",
        ],
    );
    // Text has no classes.
    run_in(&folder, &["tin", "a.xyz", "--class", "2", "-o", "v.ply"]).works(&["16 read, 16 used"]);
}

#[test]
fn the_longest_edge_is_100_metres_in_any_unit_and_said_so() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let note = |system: &str, name: &str| {
        run_in(&folder, &["tin", "a.xyz", "--a-srs", system, "-o", name])
    };
    note("EPSG:25832", "m.ply").works(&["edges over 100 m are left out"]);
    note("EPSG:2903", "f.ply").works(&["edges over 328.08 ftUS are left out"]);
    run_in(&folder, &["tin", "a.xyz", "-o", "u.ply"])
        .works(&["edges over 100 units", "no coordinate system is stated"]);
    run_in(
        &folder,
        &["tin", "a.xyz", "--max-edge", "none", "-o", "n.ply"],
    )
    .works(&["the whole convex hull is kept"]);
    let run = run_in(
        &folder,
        &["tin", "a.xyz", "--max-edge", "0.5", "-o", "s.ply"],
    );
    run.fails(
        1,
        &[
            "no triangle is left: 18 have edges over 0.5 units",
            "--max-edge none",
        ],
    );
    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "--a-srs",
            "EPSG:4326",
            "--force-degrees",
            "-o",
            "d.ply",
        ],
    );
    // The points are a degree apart.
    run.fails(
        1,
        &[
            "18 have edges over 0.000898 degrees",
            "note: x and y are in units of the degree, heights",
        ],
    );
}

#[test]
fn duplicates_go_by_the_rule() {
    let doubled = format!("{SLOPE}1 1 20\n1 1 5\n1 1 8\n");
    let folder = folder_with(&[("a.xyz", &doubled)]);
    for (rule, height) in [
        ("lowest", "5"),
        ("highest", "20"),
        ("mean", "11"),
        ("first", "11"),
        ("last", "8"),
    ] {
        let run = run_in(
            &folder,
            &[
                "tin",
                "a.xyz",
                "--duplicates",
                rule,
                "-o",
                "t.obj",
                "--overwrite",
            ],
        );
        run.works(&["3 at the position of another point"]);
        let text = String::from_utf8(bytes(&folder, "t.obj")).unwrap();
        assert!(
            text.lines().any(|line| line == format!("v 1 1 {height}")),
            "{rule}:\n{text}"
        );
    }
}

#[test]
fn a_breakline_height_wins_and_lines_come_from_attributes_and_rings() {
    let flat = geojson(25832, "LineString", "[[1,1],[2,2]]");
    let ring = geojson(25832, "Polygon", "[[[1,1,7],[2,1,7],[2,2,7],[1,1,7]]]");
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("flat.geojson", &flat),
        ("ring.geojson", &ring),
    ]);
    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "--breaklines",
            "flat.geojson:Z",
            "-o",
            "t.obj",
        ],
    );
    run.works(&[
        "note: a.xyz states no coordinate system; EPSG:25832",
        "2 at a breakline's vertex",
        "1 in, 1 edges out",
    ]);
    let text = String::from_utf8(bytes(&folder, "t.obj")).unwrap();
    assert!(
        text.contains("v 1 1 11.5\n") && text.contains("v 2 2 11.5\n"),
        "{text}"
    );
    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "--breaklines",
            "ring.geojson",
            "-o",
            "r.obj",
        ],
    );
    let lost = "note: r.obj: 3 edges on breaklines or clip lines are not marked in this format; .ply keeps them";
    run.works(&["1 in, 3 edges out", lost]);
    run_in(&folder, &["check", "r.obj"]).works(&["the Delaunay law is not checked"]);
}

#[test]
fn the_surface_is_clipped_to_bounds_and_boundary() {
    let triangle = geojson(25832, "Polygon", "[[[0,0],[3,0],[0,3],[0,0]]]");
    let folder = folder_with(&[("a.xyz", SLOPE), ("b.geojson", &triangle)]);
    let extent = |args: &[&str], cut: &str| -> serde_json::Value {
        let run = run_in(
            &folder,
            &[&["tin", "a.xyz", "-o", "t.ply", "--overwrite"], args].concat(),
        );
        run.works(&[" clipped", cut]);
        let info = run_in(&folder, &["info", "--json", "t.ply"]);
        let files: serde_json::Value = serde_json::from_str(&info.stdout).unwrap();
        files[0]["bounds"].clone()
    };
    let close = |found: &serde_json::Value, expected: [f64; 3]| {
        for (i, value) in expected.into_iter().enumerate() {
            assert!(
                (found[i].as_f64().unwrap() - value).abs() < 1e-6,
                "{found}: expected {expected:?}"
            );
        }
    };
    let bounds = extent(&["--bounds", "0.5,-1,2.5,1.5"], "(7 clipped, 9 cut)");
    close(&bounds["min"], [0.5, 0.0, 10.5]);
    close(&bounds["max"], [2.5, 1.5, 12.5]);
    // The file tells clip lines and pieces, of which the Delaunay law is not asked.
    let check = run_in(&folder, &["check", "t.ply"]);
    check.works(&["clip lines  "]);
    assert!(
        check.stdout.ends_with("no flaw found\n") && !check.stderr.contains("breaklines"),
        "{}",
        check.stderr
    );
    let both = extent(
        &["--bounds", "1,-9,9,9", "--boundary", "b.geojson"],
        "(14 clipped)",
    );
    close(&both["min"], [1.0, 0.0, 11.0]);
    close(&both["max"], [3.0, 2.0, 13.0]);
    // The same boundary as lines.
    let lines = geojson(
        25832,
        "MultiLineString",
        "[[[0,0],[3,0],[0,3]],[[0,0],[0,3]]]",
    );
    std::fs::write(folder.path().join("b.geojson"), lines).unwrap();
    assert_eq!(
        extent(
            &["--bounds", "1,-9,9,9", "--boundary", "b.geojson"],
            "(14 clipped)"
        ),
        both
    );
    // Points beyond the buffer are not used, those in it are.
    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "--bounds",
            "0,0,1,1",
            "--max-edge",
            "1.5",
            "-o",
            "w.ply",
        ],
    );
    run.works(&[
        "points up to 1.5 units outside of the bounds are used",
        "9 used; dropped: 7 outside of the bounds",
    ]);
    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "--bounds",
            "5000,5000,6000,6000",
            "-o",
            "x.ply",
        ],
    );
    run.fails(
        1,
        &[
            "no point is left of 16 read",
            "16 outside of the bounds",
            "hint: compare --bounds",
        ],
    );
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
        dem(&option).fails(2, &["t.ply: ", option[0], "the input is a surface already"]);
    }
    run_in(&folder, &["dem", "t.ply", "a.xyz", "-o", "d.tif"])
        .fails(2, &["t.ply", "cannot be combined with other files"]);
    let run = dem(&["--a-srs", "EPSG:25832", "--resolution", "0.5"]);
    run.works(&[
        "6 x 6 cells of 0.5 m",
        "36 with a height, from 10.25 m to 12.75 m",
        "EPSG:25832",
    ]);
    let info = run_in(&folder, &["info", "--json", "d.tif"]);
    let files: serde_json::Value = serde_json::from_str(&info.stdout).unwrap();
    assert_eq!(files[0]["crs"]["epsg"], 25832);
    assert_eq!(files[0]["nodata"], -9999.0);
    assert_eq!(
        (&files[0]["min"], &files[0]["max"]),
        (&10.25.into(), &12.75.into())
    );
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
    assert_eq!(
        (size, cell),
        (
            serde_json::json!([7, 7]),
            json(&[-1.0, 0.5, 0.0, 2.5, 0.0, -0.5])
        )
    );
    let (size, cell) = dem("c.tif", &["--align-to", "b.tif"]);
    assert_eq!(
        (size, cell),
        (
            serde_json::json!([6, 6]),
            json(&[0.0, 0.5, 0.0, 3.0, 0.0, -0.5])
        )
    );
    let run = run_in(
        &folder,
        &[
            "dem",
            "a.xyz",
            "--align-to",
            "a.tif",
            "-o",
            "a.tif",
            "--overwrite",
        ],
    );
    run.fails(2, &["one of the inputs"]);
    let degrees = [
        "--a-srs",
        "EPSG:4326",
        "--force-degrees",
        "--max-edge",
        "none",
    ];
    let run = run_in(
        &folder,
        &[&["dem", "a.xyz", "-o", "e.tif"], &degrees[..]].concat(),
    );
    run.fails(2, &["no default resolution in degrees"]);
}

#[test]
fn four_values_may_stand_apart() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let typed: [(&str, &[&str]); 3] = [
        (
            "a",
            &["a.xyz", "--te", "-1,-1,2.5,2.2", "--bounds", "-0.5,0,2,2"],
        ),
        (
            "b",
            &[
                "--te", "-1", "-1", "2.5", "2.2", "--bounds", "-0.5", "0", "2", "2", "a.xyz",
            ],
        ),
        (
            "c",
            &["--te=-1,-1,2.5,2.2", "--bounds", "-0.5 0 2 2", "a.xyz"],
        ),
    ];
    for (name, args) in typed {
        let run = run_in(
            &folder,
            &[
                &["dem", "--resolution", "0.5", "-o", &format!("{name}.tif")],
                args,
            ]
            .concat(),
        );
        run.works(&["7 x 7 cells of 0.5 units", "16 with a height"]);
        assert_eq!(
            bytes(&folder, &format!("{name}.tif")),
            bytes(&folder, "a.tif")
        );
    }
    let run = run_in(
        &folder,
        &["dem", "a.xyz", "-o", "d.tif", "--te", "0", "0", "2"],
    );
    run.fails(2, &["expected four numbers xmin,ymin,xmax,ymax, found 1"]);
}

#[test]
fn a_raster_beside_the_surface_is_told() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let beside = ["--te", "50", "50", "60", "60"];
    let run = run_in(
        &folder,
        &[&["dem", "a.xyz", "-o", "d.tif"], &beside[..]].concat(),
    );
    run.works(&[
        "warning: the rectangle of --te does not touch the surface",
        "warning: no cell has a height",
    ]);
    run_in(
        &folder,
        &[&["hillshade", "a.xyz", "-o", "d.png"], &beside[..]].concat(),
    )
    .works(&["warning: the rectangle of --te does not touch the surface"]);
}

#[test]
fn breaklines_far_beyond_the_points_are_told() {
    let far = geojson(25832, "LineString", "[[1,1,11],[1,900,12]]");
    let square = geojson(25832, "Polygon", "[[[0,0],[3,0],[3,3],[0,3],[0,0]]]");
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("far.geojson", &far),
        ("square.geojson", &square),
    ]);
    let tin = |name: &str, args: &[&str]| {
        let run = run_in(
            &folder,
            &[
                &["tin", "a.xyz", "--breaklines", "far.geojson", "-o", name],
                args,
            ]
            .concat(),
        );
        run.works(&["1 in, "]);
        run.stderr
            .contains("warning: breaklines reach 897 m beyond the points")
    };
    assert!(tin("a.ply", &[]));
    assert!(!tin("b.ply", &["--bounds", "0,0,3,3"]));
    assert!(!tin("c.ply", &["--boundary", "square.geojson"]));
    assert!(!tin("d.ply", &["--max-edge", "900"]));
}

#[test]
fn summaries_of_rasters_and_meshes_tell_what_they_hold() {
    let folder = folder_with(&[]);
    let dem = fixture("dem.tif");
    let extent =
        "x 688000 .. 688400, y 5261000 .. 5261300, z 796.669 .. 883.985\nCRS         EPSG:25832";
    run_in(&folder, &["hillshade", &dem, "-o", "s.png"]).works(&["200 x 150 cells of 2 m", extent]);
    let run = run_in(
        &folder,
        &[
            "contour",
            &dem,
            "--interval",
            "1",
            "--threads",
            "1",
            "-o",
            "c.shp",
        ],
    );
    run.works(&[extent, "304 lines (43 closed) from 797 m to 883 m"]);
    assert!(
        !run.stderr.contains("drawing"),
        "progress is for terminals: {}",
        run.stderr
    );
    run_in(
        &folder,
        &[
            "contour",
            &dem,
            "--interval",
            "1",
            "--threads",
            "3",
            "-o",
            "d.shp",
        ],
    )
    .works(&[]);
    assert!(
        bytes(&folder, "c.shp") == bytes(&folder, "d.shp"),
        "contours depend on the number of threads"
    );
    let lines = fixture("breaklines.shp");
    run_in(
        &folder,
        &[
            "tin",
            &fixture("valley.laz"),
            "--breaklines",
            &lines,
            "-o",
            "t.ply",
        ],
    )
    .works(&[]);
    run_in(&folder, &["check", "t.ply"]).works(&["breaklines  1334 edges", "vertices    60492"]);
}

#[test]
fn contours_and_shades_come_from_tins_and_from_dems() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let run = run_in(
        &folder,
        &["contour", "a.xyz", "--base", "-0.5", "-o", "c.geojson"],
    );
    run.works(&[
        "contours are 1 unit apart",
        "3 lines (0 closed) from 10.5 units to 12.5 units",
    ]);
    let text = String::from_utf8(bytes(&folder, "c.geojson")).unwrap();
    let layer: serde_json::Value = serde_json::from_str(&text).unwrap();
    let levels: Vec<f64> = layer["features"]
        .as_array()
        .unwrap()
        .iter()
        .map(|feature| feature["properties"]["ELEV"].as_f64().unwrap())
        .collect();
    assert_eq!(levels, [10.5, 11.5, 12.5]);

    let run = run_in(
        &folder,
        &[
            "contour",
            "a.xyz",
            "--levels",
            "11.25,-7,11.25",
            "-o",
            "l.shp",
        ],
    );
    run.works(&["1 line (0 closed) from 11.25 units to 11.25 units"]);
    let run = run_in(
        &folder,
        &["contour", "a.xyz", "--levels", "100", "-o", "none.geojson"],
    );
    run.works(&["warning: no contour crosses the surface"]);

    run_in(
        &folder,
        &["dem", "a.xyz", "--resolution", "0.5", "-o", "d.tif"],
    )
    .works(&[]);
    let run = run_in(
        &folder,
        &["contour", "d.tif", "--levels", "11.5", "-o", "d.geojson"],
    );
    run.works(&["1 line (0 closed) from 11.5 units to 11.5 units"]);
    run_in(
        &folder,
        &["hillshade", "d.tif", "-o", "d.png", "-o", "s.tif"],
    )
    .works(&["6 x 6 cells", "written     d.png"]);
    run_in(
        &folder,
        &["hillshade", "a.xyz", "--resolution", "0.5", "-o", "a.png"],
    )
    .works(&["6 x 6 cells"]);
    run_in(
        &folder,
        &["hillshade", "d.tif", "--resolution", "2", "-o", "e.png"],
    )
    .fails(2, &["a DEM keeps its own cells"]);
}

#[test]
fn a_flaw_is_listed_and_ends_with_1() {
    // The wrong diagonal of a kite. An .obj could have a breakline there.
    let kite = "v 0 0 0\nv 4 -1 0\nv 8 0 0\nv 4 1 0\nf 1 2 3\nf 1 3 4\n";
    let same = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
                element face 2\nproperty list uchar int vertex_indices\nend_header\n\
                0 0 0 4 -1 0 8 0 0 4 1 0 3 0 1 2 3 0 2 3\n";
    let turned = "v 0 0 0\nv 4.5 -1 0\nv 8 0 0\nf 1 2 3\nf 2 1 3\n";
    let folder = folder_with(&[
        ("kite.obj", kite),
        ("kite.ply", same),
        ("turned.obj", turned),
        ("a.xyz", SLOPE),
    ]);
    let run = run_in(&folder, &["check", "kite.ply"]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    let flaw = "face 0, edge 1: the vertex beyond lies in the circumcircle, at (8 0) (0 0)\n";
    assert_eq!(
        run.stdout,
        format!("{flaw}4 vertices, 2 triangles, 0 constrained edges: 1 flaw\n")
    );
    let run = run_in(&folder, &["check", "kite.obj"]);
    run.works(&[
        "note: kite.obj: the format does not store breaklines: the Delaunay law is not checked",
    ]);
    let run = run_in(&folder, &["check", "turned.obj"]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    assert!(
        run.stdout
            .starts_with("face 1: no area in plan, or clockwise, at (4.5 -1) (0 0) (8 0)\n"),
        "{}",
        run.stdout
    );
    let run = run_in(&folder, &["check", "a.xyz"]);
    run.works(&[]);
    assert_eq!(
        run.stdout,
        "16 vertices, 18 triangles, 0 constrained edges: no flaw found\n"
    );
}

#[test]
fn results_do_not_depend_on_the_order_of_files_or_on_threads() {
    let rows: Vec<&str> = SLOPE.lines().collect();
    let mut shuffled = rows.clone();
    shuffled.rotate_left(7);
    shuffled.swap(2, 11);
    let halves = [shuffled[..5].join("\n"), shuffled[5..].join("\n")];
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("b.xyz", &halves[0]),
        ("c.xyz", &halves[1]),
    ]);
    let orders: [&[&str]; 3] = [
        &["a.xyz"],
        &["b.xyz", "c.xyz", "--threads", "1"],
        &["c.xyz", "b.xyz", "--threads", "2"],
    ];
    for (i, order) in orders.into_iter().enumerate() {
        for (verb, extension) in [
            ("tin", "ply"),
            ("tin", "obj"),
            ("dem", "tif"),
            ("contour", "shp"),
            ("hillshade", "png"),
        ] {
            let name = format!("{verb}{i}.{extension}");
            run_in(&folder, &[&[verb, "-o", &name], order].concat()).works(&[]);
            assert_eq!(
                bytes(&folder, &name),
                bytes(&folder, &format!("{verb}0.{extension}")),
                "{name}"
            );
        }
        assert_eq!(
            bytes(&folder, &format!("contour{i}.dbf")),
            bytes(&folder, "contour0.dbf")
        );
    }
}

#[test]
fn points_come_from_stdin() {
    let folder = folder_with(&[]);
    run_with(&folder, &["tin", "-", "-o", "t.ply"], SLOPE)
        .works(&["16 read, 16 used", "triangles   18"]);
}

#[test]
fn points_are_selected_clipped_and_merged() {
    let ring = "[[[0,0],[2,0],[2,2],[0,2],[0,0]]]";
    let folder = folder_with(&[("site.geojson", &geojson(25832, "Polygon", ring))]);
    let write = |name: &str, points: &[([f64; 3], u8)]| {
        std::fs::write(folder.path().join(name), lidar::las(points, Some(25832))).unwrap();
    };
    write("a.las", &lidar::tile([0.0, 0.0], 2));
    write("b.las", &lidar::tile([10.0, 0.0], 5));
    let run = run_in(&folder, &["points", "a.las", "b.las", "-o", "c.laz"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(
        run.stderr.contains("points      32 points of 32\n"),
        "{}",
        run.stderr
    );
    let info = run_in(&folder, &["info", "c.laz"]);
    for part in [
        "LAS 1.2, point format 0, LAZ",
        "32 points",
        "2 (ground): 16",
        "25832",
    ] {
        assert!(info.stdout.contains(part), "{part}: {}", info.stdout);
    }
    let run = run_in(
        &folder,
        &[
            "points",
            "a.las",
            "b.las",
            "--boundary",
            "site.geojson",
            "-o",
            "d.csv",
        ],
    );
    assert!(
        run.stderr
            .contains("points      9 points of 32, 23 outside\n"),
        "{}",
        run.stderr
    );
    assert!(
        String::from_utf8(bytes(&folder, "d.csv"))
            .unwrap()
            .starts_with("x,y,z,class\n0,0,0,2\n1,0,1,2\n")
    );
    let run = run_in(&folder, &["points", "a.las", "--class", "9", "-o", "e.las"]);
    assert_ne!(run.code, 0);
    assert!(
        run.stderr.contains("no point is left of 16 read"),
        "{}",
        run.stderr
    );
    assert!(!folder.path().join("e.las").exists());
    let run = run_in(&folder, &["points", "a.las", "-o", "a.tif"]);
    assert!(
        run.stderr
            .contains(".las, .copc.laz, .laz, .xyz, .txt, .csv"),
        "{}",
        run.stderr
    );
    // What LAStools' users type.
    let run = run_in(
        &folder,
        &["las2las", "-i", "b.las", "-keep_class", "5", "-o", "f.las"],
    );
    assert_eq!(run.code, 0, "{}", run.stderr);
}
