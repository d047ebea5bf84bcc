//! What is asked for and makes no sense, and what is refused; help, lists and `info`.

use super::{Run, SLOPE, files_of, folder_with, geojson, run_in, run_with};

#[test]
fn help_goes_to_stdout_and_tells_each_verb_with_an_example() {
    let folder = folder_with(&[]);
    let run = run_in(&folder, &["--help"]);
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    for verb in [
        "info",
        "points",
        "ground",
        "tin",
        "simplify",
        "triangulate",
        "dem",
        "contour",
        "hillshade",
        "color-relief",
        "slope",
        "aspect",
        "curvature",
        "roughness",
        "tri",
        "tpi",
        "volume",
        "compare",
        "profile",
        "drape",
        "terrain-tiles",
        "sample",
        "accuracy",
        "check",
        "crs",
        "demo",
    ] {
        assert!(run.stdout.contains(&format!("\n  {verb} ")), "{verb}");
        let long = run_in(&folder, &[verb, "--help"]);
        assert_eq!(long.code, 0);
        assert!(
            long.stdout
                .contains(&format!("Example:\n  breakline {verb} ")),
            "{verb}"
        );
        let short = run_in(&folder, &[verb, "-h"]);
        assert!(short.stdout.len() < long.stdout.len(), "{verb}");
    }
    assert!(
        run_in(&folder, &["--version"])
            .stdout
            .starts_with("breakline 0.")
    );
}

#[test]
fn wrong_usage_ends_with_2_and_leaves_nothing() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        (
            "lines.geojson",
            &geojson(25832, "LineString", "[[0,0,1],[1,1,1]]"),
        ),
    ]);
    let wrong: &[(&[&str], &str)] = &[
        (&[], "Usage"),
        (&["tim"], "unrecognized subcommand"),
        (&["tin"], "required"),
        (&["tin", "a.xyz"], "--output"),
        (
            &["triangulate", "a.xyz", "-o", "t.tif"],
            ".ele, .node, .poly, .edge, .neigh, .ply, .obj, .off, .xml",
        ),
        (
            &[
                "triangulate",
                "a.xyz",
                "-o",
                "t.ele",
                "--on-crossing",
                "ignore",
            ],
            "split, reject",
        ),
        (
            &["triangulate", "a.xyz", "-o", "t.ele", "--kernel", "wide"],
            "adaptive, exact, fast",
        ),
        (
            &["tin", "a.xyz", "-o", "t.ply", "--max-edge", "-3"],
            "--max-edge",
        ),
        (
            &["tin", "a.xyz", "-o", "t.ply", "--max-edge", "all"],
            "`none`",
        ),
        (
            &["tin", "a.xyz", "-o", "t.ply", "--bounds", "3,0,1,2"],
            "xmin < xmax",
        ),
        (&["tin", "a.xyz", "-o", "t.ply", "--class", "2,300"], "300"),
        (
            &["tin", "a.xyz", "-o", "t.ply", "--duplicates", "newest"],
            "lowest, highest, mean, first, last",
        ),
        (
            &["tin", "a.xyz", "-o", "t.ply", "--a-srs", "EPSG:nonsense"],
            "--a-srs",
        ),
        (&["tin", "a.xyz", "-o", "t.dwg"], ".ply, .obj, .off, .xml"),
        (&["tin", "a.xyz", "-o", "t"], ".ply, .obj, .off, .xml"),
        (&["dem", "a.xyz", "-o", "t.png"], ".tif"),
        (&["contour", "a.xyz", "-o", "t.dwg"], ".shp, .geojson"),
        (&["hillshade", "a.xyz", "-o", "t.doc"], ".tif, .tiff, .png"),
        (
            &["dem", "a.xyz", "-o", "t.tif", "--resolution", "0"],
            "above zero",
        ),
        (
            &[
                "dem",
                "a.xyz",
                "-o",
                "t.tif",
                "--resolution",
                "1",
                "--align-to",
                "a.tif",
            ],
            "cannot be used with",
        ),
        (
            &[
                "contour",
                "a.xyz",
                "-o",
                "t.shp",
                "--levels",
                "1,2",
                "--interval",
                "1",
            ],
            "cannot be used with",
        ),
        (
            &["hillshade", "a.xyz", "-o", "t.png", "--altitude", "91"],
            "between 0",
        ),
        (
            &[
                "hillshade",
                "a.xyz",
                "-o",
                "t.png",
                "-multidirectional",
                "-az",
                "10",
            ],
            "--azimuth is given, but multidirectional shades are those of four lights",
        ),
        (
            &["hillshade", "a.xyz", "-o", "t.png", "-igor", "-alt", "10"],
            "leave it out, or choose another --shading",
        ),
        (
            &["hillshade", "a.xyz", "-o", "t.png", "-igor", "-combined"],
            "cannot be used multiple times",
        ),
        (
            &["tin", "a.xyz", "-o", "a.xyz"],
            "not a format that can be written",
        ),
        (
            &[
                "contour",
                "a.xyz",
                "--breaklines",
                "lines.geojson",
                "-o",
                "lines.geojson",
                "--overwrite",
            ],
            "one of the inputs",
        ),
        (
            &["tin", "a.xyz", "-o", "t.ply", "-o", "t.ply"],
            "named twice",
        ),
        (
            &["tin", "a.xyz", "-o", "t.ply", "-q", "-v"],
            "cannot be used with",
        ),
    ];
    let before = files_of(folder.path());
    for (args, said) in wrong {
        let run = run_in(&folder, args);
        assert_eq!(run.code, 2, "{args:?}: {}", run.stderr);
        assert!(
            run.stderr.contains(said),
            "{args:?}: expected `{said}` in:\n{}",
            run.stderr
        );
        assert_eq!(run.stdout, "", "{args:?}");
    }
    assert_eq!(files_of(folder.path()), before);
}

#[test]
fn negative_coordinates_are_no_options() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "-o",
            "t.ply",
            "--bounds",
            "-5,-5,nonsense,1",
        ],
    );
    run.fails(2, &["`nonsense` is not a finite number"]);
    let run = run_in(
        &folder,
        &["contour", "none.xyz", "-o", "t.shp", "--base", "-5"],
    );
    run.fails(1, &["none.xyz: no such file"]);
}

#[test]
fn what_exists_is_not_replaced_and_that_is_known_before_the_work() {
    let folder = folder_with(&[
        ("broken.xyz", "no numbers at all\n"),
        ("t.ply", "mine"),
        ("c.dbf", "mine"),
    ]);
    let run = run_in(&folder, &["tin", "broken.xyz", "-o", "t.ply"]);
    run.fails(
        1,
        &["error: t.ply: the file exists", "hint: ", "--overwrite"],
    );
    // A shapefile is several files.
    let run = run_in(&folder, &["contour", "broken.xyz", "-o", "c.shp"]);
    run.fails(1, &["error: c.dbf: the file exists"]);
    let run = run_in(&folder, &["tin", "broken.xyz", "-o", "nowhere/t.ply"]);
    run.fails(1, &["nowhere/t.ply", "the folder does not exist"]);
    for name in ["t.ply", "c.dbf"] {
        assert_eq!(
            std::fs::read_to_string(folder.path().join(name)).unwrap(),
            "mine"
        );
    }
}

#[test]
fn a_glob_or_a_name_without_a_file_is_an_error() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    run_in(&folder, &["tin", "a.xyz", "tiles/*.laz", "-o", "t.ply"])
        .fails(1, &["no file matches `tiles/*.laz`"]);
    run_in(&folder, &["tin", "a.xyz", "b.xyz", "-o", "t.ply"]).fails(1, &["b.xyz: no such file"]);
    run_in(&folder, &["tin", "[", "-o", "t.ply"]).fails(2, &["not a valid glob"]);
    let run = run_in(
        &folder,
        &["tin", "a.xyz", "--breaklines", "no.shp:Z", "-o", "t.ply"],
    );
    run.fails(1, &["no.shp:Z: no such file"]);
    assert_eq!(files_of(folder.path()), ["a.xyz"]);
}

#[test]
fn files_of_the_wrong_kind_are_named_before_the_work() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("d.tif", "II*\0"),
        ("p.las", "LASF"),
        ("folder/a.xyz", SLOPE),
    ]);
    let tin = |args: &[&str]| run_in(&folder, &[&["tin", "a.xyz", "-o", "t.ply"], args].concat());
    tin(&["--breaklines", "d.tif"]).fails(
        2,
        &["d.tif: --breaklines takes lines or polygons, this is a raster"],
    );
    tin(&["--breaklines", "p.las"]).fails(2, &["p.las: ", "this is lidar points"]);
    tin(&["--boundary", "p.las"]).fails(
        2,
        &["p.las: --boundary takes polygons or closed lines, this is lidar points"],
    );
    tin(&["--class", "2", "8"]).fails(1, &["8: no such file", "hint: ", "commas", "--class 2,8"]);
    tin(&["folder"]).fails(1, &["folder: this is a folder", "hint: ", "folder/*.laz"]);
    let run = run_in(
        &folder,
        &["dem", "a.xyz", "-o", "e.tif", "--align-to", "no.tif"],
    );
    run.fails(1, &["no.tif: no such file"]);
    assert!(!run.stderr.contains("note: "), "{}", run.stderr);
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
        files
            .as_array()
            .unwrap()
            .iter()
            .map(|file| file["count"].as_u64().unwrap())
            .collect()
    };
    assert_eq!(counts(&run), [16, 1, 2]);
    assert_eq!(
        counts(&run_in(&folder, &["info", "--json", "lists/tiles/*.xyz"])),
        [16, 1, 2]
    );
    assert_eq!(
        counts(&run_with(&folder, &["info", "--json", "-"], SLOPE)),
        [16]
    );

    let run = run_in(
        &folder,
        &["info", "--json", "lists/tiles/b.xyz", "./lists/tiles/b.xyz"],
    );
    run.works(&["note: ./lists/tiles/b.xyz is named twice and used once"]);
    let files: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(
        files[0]["bounds"],
        serde_json::json!({"min": [1.5, 2.25, -3.0], "max": [1.5, 2.25, -3.0]})
    );
    assert_eq!(files[0]["crs"], serde_json::Value::Null);

    let text = run_in(&folder, &["info", "lists/tiles/b.xyz"]);
    assert!(
        text.stdout
            .contains("x 1.5 .. 1.5, y 2.25 .. 2.25, z -3 .. -3"),
        "{}",
        text.stdout
    );
}

#[test]
fn a_list_names_its_line_when_a_file_is_missing() {
    let folder = folder_with(&[
        ("list.txt", "# nothing\n\nno*.laz\n"),
        ("empty.txt", "# nothing\n"),
    ]);
    run_in(&folder, &["info", "@list.txt"]).fails(1, &["list.txt: line 3: no file matches"]);
    run_in(&folder, &["info", "@empty.txt"]).fails(2, &["the input names no file"]);
    run_in(&folder, &["info", "@none.txt"]).fails(1, &["none.txt"]);
}

#[test]
fn info_goes_on_after_a_file_that_cannot_be_read() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("b.laz", "this is no lidar"),
        ("c.xyz", "1 2 3\n"),
    ]);
    let run = run_in(&folder, &["info", "a.xyz", "b.laz", "c.xyz"]);
    run.fails(1, &["error: b.laz: "]);
    assert!(
        run.stdout.contains("a.xyz\n") && run.stdout.contains("c.xyz\n"),
        "{}",
        run.stdout
    );
}

#[test]
fn info_reads_whatever_the_program_writes() {
    let poly = "4 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n";
    let folder = folder_with(&[("a.xyz", SLOPE), ("p.poly", poly)]);
    let run = |line: &str| run_in(&folder, &line.split(' ').collect::<Vec<_>>());
    let all =
        "tin a.xyz --a-srs EPSG:25832 --crossing-report r.csv -o t.ply -o t.obj -o t.off -o t.stl";
    run(all).works(&[
        "written     r.csv",
        "written     t.stl",
        "written     t.stl.origin.txt",
    ]);
    run("contour a.xyz --a-srs EPSG:25832 -o c.shp -o c.geojson")
        .works(&["c.shp", "c.shx", "c.dbf", "c.prj", "c.cpg"]);
    run("hillshade a.xyz --a-srs EPSG:25832 -o s.png -o s.tif")
        .works(&["written     s.pgw", "written     s.png.aux.xml"]);
    run("triangulate p.poly -o q.ele -o q.edge -o q.neigh -o q.stl").works(&[
        "written     q.neigh",
        "q.stl: 4 edges",
        "q.stl: coordinates are relative to",
        "q.stl.origin.txt",
    ]);
    for (file, facts) in [
        ("r.csv", &["r.csv"][..]),
        ("t.ply", &["triangles  18", "EPSG:25832"]),
        ("t.obj", &["triangles  18", "EPSG:25832"]),
        ("t.off", &["triangles  18", "EPSG:25832"]),
        (
            "t.stl",
            &[
                "STL, binary",
                "triangles  18",
                "x 0 .. 3, y 0 .. 3, z 10 .. 13",
            ],
        ),
        ("c.shp", &["lines: 2", "EPSG:25832"]),
        ("c.geojson", &["lines: 2", "EPSG:25832"]),
        (
            "s.png",
            &[
                "PNG, 8 bits, gray and alpha",
                "3 x 3 cells",
                "x 0 .. 3, y 0 .. 3",
                "EPSG:25832",
            ],
        ),
        ("s.tif", &["3 x 3 cells", "EPSG:25832"]),
        ("q.node", &["vertices   4"]),
        ("q.poly", &["segments   4", "vertices   4"]),
        ("q.ele", &["triangles  2", "vertices   4"]),
        ("q.edge", &["edges      5"]),
        ("q.neigh", &["triangles  2"]),
        ("q.stl", &["STL, binary", "triangles  2"]),
    ] {
        let info = run(&format!("info {file}"));
        assert_eq!(info.code, 0, "{file}: {}", info.stderr);
        facts.iter().for_each(|fact| {
            assert!(
                info.stdout.contains(fact),
                "{file}: expected `{fact}` in {}",
                info.stdout
            )
        });
    }
    // Parts go with their main files; without a system there is no auxiliary file, nor is an old
    // one left.
    let info = run("info s.png s.pgw s.png.aux.xml c.shp c.prj c.dbf t.stl t.stl.origin.txt");
    assert_eq!(
        (info.code, info.stdout.matches("  format ").count()),
        (0, 3),
        "{}{}",
        info.stdout,
        info.stderr
    );
    run("hillshade a.xyz --overwrite -o s.png").works(&[]);
    assert!(!files_of(folder.path()).contains(&"s.png.aux.xml".to_owned()));
}

#[test]
fn breaklines_without_heights_are_refused_never_taken_as_0() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        (
            "flat.geojson",
            &geojson(25832, "LineString", "[[0,0],[1,1]]"),
        ),
        (
            "part.geojson",
            &geojson(25832, "LineString", "[[0,0,7],[1,1]]"),
        ),
        ("points.geojson", &geojson(25832, "Point", "[0,0,7]")),
    ]);
    let tin = |lines: &str| {
        run_in(
            &folder,
            &["tin", "a.xyz", "--breaklines", lines, "-o", "t.ply"],
        )
    };
    tin("flat.geojson").fails(
        1,
        &[
            "flat.geojson: record 1: the line has no heights",
            "FILE:FIELD",
            "Z",
        ],
    );
    tin("part.geojson").fails(
        1,
        &["part.geojson: record 1: vertex 2 at 1 1 has no height"],
    );
    tin("points.geojson").fails(1, &["points.geojson", "no lines"]);
    let run = run_in(
        &folder,
        &["tin", "a.xyz", "--boundary", "flat.geojson", "-o", "t.ply"],
    );
    run.fails(
        1,
        &[
            "flat.geojson: record 1: the lines are not closed: one ends at 0 0",
            "1.414213562 away, at 1 1",
        ],
    );
    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "--boundary",
            "points.geojson",
            "-o",
            "t.ply",
        ],
    );
    run.fails(1, &["points.geojson", "no polygons and no lines"]);
    assert!(!folder.path().join("t.ply").exists());
}

#[test]
fn a_feature_that_is_not_built_in_is_named() {
    if cfg!(feature = "proj") {
        return;
    }
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "--a-srs",
            "EPSG:25832",
            "--t-srs",
            "EPSG:25833",
            "-o",
            "t.ply",
        ],
    );
    run.fails(1, &["PROJ", "hint: ", "--features proj"]);
    let run = run_in(
        &folder,
        &[
            "points",
            "a.xyz",
            "--a-srs",
            "EPSG:25832",
            "-t_srs",
            "EPSG:25833",
            "-o",
            "t.xyz",
        ],
    );
    run.fails(1, &["PROJ", "hint: ", "--features proj"]);
}

#[test]
fn a_raster_is_no_input_of_tin_or_dem() {
    let folder = folder_with(&[("d.tif", "II*\0"), ("a.xyz", SLOPE)]);
    run_in(&folder, &["dem", "d.tif", "-o", "e.tif"]).fails(2, &["d.tif: the input is a raster"]);
    run_in(&folder, &["contour", "d.tif", "a.xyz", "-o", "e.shp"])
        .fails(2, &["d.tif", "the file is a surface"]);
    run_in(
        &folder,
        &["contour", "d.tif", "--class", "2", "-o", "e.shp"],
    )
    .fails(2, &["d.tif", "--class"]);
    run_in(
        &folder,
        &["hillshade", "d.tif", "-o", "d.tif", "--overwrite"],
    )
    .fails(2, &["one of the inputs"]);
}

#[test]
fn messages_name_what_is_wrong_in_few_digits() {
    let ring = geojson(25832, "Polygon", "[[[10,10],[11,10],[11,11],[10,10]]]");
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("far.geojson", &ring),
        ("high.xyz", "0 0 1\n1 0 1e300\n0 1 2\n1 1 3\n"),
        ("full.ply/x", ""),
    ]);
    let run = |line: &str| run_in(&folder, &line.split(' ').collect::<Vec<_>>());
    run("tin a.xyz --boundary far.geojson -o t.ply")
        .fails(1, &["18 lie outside of the boundary far.geojson\n"]);
    run("tin a.xyz --bounds 3.5,3.5,4,4 -o t.ply").fails(1, &["18 lie outside of the bounds\n"]);
    run("tin a.xyz --bounds 3.5,3.5,4,4 --holes far.geojson -o t.ply").fails(
        1,
        &["outside of the bounds or in the holes of far.geojson\n"],
    );
    run("points a.xyz --boundary far.geojson -o p.xyz")
        .fails(2, &["16 outside of the boundary far.geojson\n"]);
    run("tin a.xyz -o t.ply/").fails(
        2,
        &[
            "t.ply/: the output is a file",
            "hint: leave the separator out: t.ply\n",
        ],
    );
    run("tin a.xyz -o full.ply/").fails(2, &["hint: name a file in it, such as full.ply/out.ply"]);
    for line in [
        "contour high.xyz --interval 1 -o c.shp",
        "contour high.xyz --interval 1e-300 -o c.shp",
        "dem a.xyz --te 1e299,1e299,1e300,1e300 -o d.tif",
        "tin high.xyz --max-edge 1e300 -o t.ply",
        "info high.xyz",
    ] {
        let run = run(line);
        let text = run.stdout + &run.stderr;
        let longest = text
            .split(|c: char| !c.is_ascii_digit())
            .map(str::len)
            .max();
        assert!(longest.unwrap_or(0) < 20, "{line}: {text}");
    }
}
