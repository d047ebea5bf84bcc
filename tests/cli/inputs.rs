//! Inputs that are odd together, and sums that add up.

use super::{SLOPE, bytes, fixture, folder_with, geojson, run_in};
use testkit::lidar::{las, tile};

#[test]
fn a_file_that_gives_no_points_is_named_and_not_asked_for_its_system() {
    let folder = folder_with(&[("text.xyz", SLOPE)]);
    let write = |name: &str, class: u8, epsg: Option<u16>| {
        std::fs::write(
            folder.path().join(name),
            las(&tile([0.0, 0.0], class), epsg),
        )
        .unwrap();
    };
    write("ground.las", 2, None);
    write("utm.las", 2, Some(25832));
    write("trees.las", 5, Some(25833));
    std::fs::write(folder.path().join("none.las"), las(&[], Some(3005))).unwrap();
    let silent = "warning: trees.las: none of its points is used: it has none of class 2";
    let tin = |files: &[&str], said: &[&str]| {
        let run = run_in(
            &folder,
            &[&["tin", "-o", "t.ply", "--overwrite"], files].concat(),
        );
        run.works(said);
        run.stderr
    };
    for order in [["ground.las", "trees.las"], ["trees.las", "ground.las"]] {
        tin(
            &order,
            &[
                silent,
                "CRS         not known",
                "32 read from 2 files, 16 used",
            ],
        );
    }
    // Two systems are none if one of them is nobody's.
    tin(
        &["utm.las", "trees.las", "none.las"],
        &[
            silent,
            "warning: none.las: none of its points is used",
            "EPSG:25832",
        ],
    );
    let run = run_in(
        &folder,
        &[
            "tin",
            "utm.las",
            "trees.las",
            "--class",
            "2,5",
            "-o",
            "u.ply",
        ],
    );
    run.fails(1, &["two coordinate systems"]);
    // Where no file has ground, all give points.
    let said = tin(
        &["trees.las", "text.xyz"],
        &[
            "warning: no point has class 2 (ground): all classes",
            "25833",
        ],
    );
    assert!(!said.contains("none of its points is used"), "{said}");
    let said = tin(&["trees.las"], &["warning: no point has class 2"]);
    assert!(!said.contains("none of its points is used"), "{said}");
    assert!(!tin(&["utm.las", "ground.las"], &[]).contains("warning: "));
}

#[test]
fn what_lies_on_two_continents_is_told() {
    let far = "688000 5261000 1\n688004 5261000 2\n688000 5261004 3\n688004 5261004 4\n";
    let near = "40 0 1\n44 0 2\n40 4 3\n44 4 4\n";
    let lines = geojson(
        25832,
        "LineString",
        "[[688001,5261001,1],[688002,5261003,2]]",
    );
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("far.xyz", far),
        ("near.xyz", near),
        ("far.geojson", &lines),
    ]);
    let tin = |args: &[&str]| {
        run_in(
            &folder,
            &[&["tin", "-o", "t.ply", "--overwrite"], args].concat(),
        )
    };
    tin(&["far.xyz", "near.xyz", "a.xyz"]).works(&[
        "warning: near.xyz and far.xyz are 687956 units apart, with nothing between them",
    ]);
    assert!(!tin(&["near.xyz", "a.xyz"]).stderr.contains("warning: "));
    tin(&["a.xyz", "--breaklines", "far.geojson"]).works(&[
        "warning: the breaklines lie 5260998 m away from the points: are they in the same",
    ]);
}

#[test]
fn half_a_file_is_an_error_unless_that_is_wanted() {
    let folder = folder_with(&[]);
    let whole = las(&tile([0.0, 0.0], 2), None);
    std::fs::write(folder.path().join("cut.las"), &whole[..whole.len() - 30]).unwrap();
    let laz = std::fs::read(fixture("valley.laz")).unwrap();
    std::fs::write(folder.path().join("cut.laz"), &laz[..laz.len() / 10 * 9]).unwrap();
    for name in ["cut.las", "cut.laz"] {
        for verb in [&["tin", name, "-o", "t.ply"][..], &["info", name]] {
            run_in(&folder, verb).fails(1, &[name, "the file ", "hint: ", "--partial"]);
        }
        run_in(&folder, &["info", "--partial", name]).works(&["warning: cut.la", " the file "]);
    }
    assert!(!folder.path().join("t.ply").exists());
    run_in(&folder, &["tin", "cut.las", "--partial", "-o", "t.ply"]).works(&[
        "states 16 points, but the file holds 14 and 10 bytes of another",
        "14 read, 14 used",
    ]);
    run_in(&folder, &["tin", "cut.laz", "--partial", "-o", "u.ply"]).works(&[
        "states 62776 points, but the file holds 50000",
        "50000 read",
    ]);
}

#[test]
fn half_a_shapefile_is_an_error_unless_that_is_wanted() {
    let folder = folder_with(&[]);
    for extension in ["shp", "dbf", "prj"] {
        let bytes = std::fs::read(fixture(&format!("breaklines.{extension}"))).unwrap();
        let end = if extension == "shp" {
            bytes.len() / 2
        } else {
            bytes.len()
        };
        std::fs::write(
            folder.path().join(format!("half.{extension}")),
            &bytes[..end],
        )
        .unwrap();
    }
    let points = fixture("valley.laz");
    let tin = |more: &[&str]| {
        run_in(
            &folder,
            &[
                &[
                    "tin",
                    &points,
                    "--breaklines",
                    "half.shp",
                    "-o",
                    "t.ply",
                    "--overwrite",
                ],
                more,
            ]
            .concat(),
        )
    };
    tin(&[]).fails(
        1,
        &[
            "half.shp: byte ",
            "its header states ",
            "hint: ",
            "--partial",
        ],
    );
    assert!(!folder.path().join("t.ply").exists());
    tin(&["--partial"]).works(&[
        "warning: half.shp: its header states ",
        "warning: half.shp: record ",
    ]);
    run_in(&folder, &["info", "half.shp"]).fails(1, &["half.shp: ", "--partial"]);
    run_in(&folder, &["info", "half.shp", "--partial"]).works(&["warning: "]);
    run_in(
        &folder,
        &["tin", &points, "--boundary", "half.shp", "-o", "u.ply"],
    )
    .fails(1, &["half.shp: byte "]);
}

#[test]
fn systems_with_heights_are_compared_and_what_is_not_understood_is_not_joined() {
    let named = |name: &str| {
        format!(
            r#"{{"type":"FeatureCollection","crs":{{"type":"name","properties":{{"name":"{name}"}}}},"features":[{{"type":
            "Feature","properties":{{}},"geometry":{{"type":"LineString","coordinates":[[0.5,0.5,1],[2.5,2,2]]}}}}]}}"#
        )
    };
    let folder = folder_with(&[
        (
            "33.geojson",
            &named("urn:ogc:def:crs,crs:EPSG::32633,crs:EPSG::5783"),
        ),
        (
            "32.geojson",
            &named("urn:ogc:def:crs,crs:EPSG::32632,crs:EPSG::5783"),
        ),
        ("ign.geojson", &named("urn:ogc:def:crs:IGNF::LAMB93")),
        ("plain.xyz", SLOPE),
    ]);
    std::fs::write(
        folder.path().join("utm.las"),
        las(&tile([0.0, 0.0], 2), Some(32632)),
    )
    .unwrap();
    let tin = |points: &str, lines: &str, more: &[&str]| {
        run_in(
            &folder,
            &[
                &[
                    "tin",
                    points,
                    "--breaklines",
                    lines,
                    "-o",
                    "t.ply",
                    "--overwrite",
                ],
                more,
            ]
            .concat(),
        )
    };
    tin("utm.las", "33.geojson", &[])
        .fails(1, &["two coordinate systems", "EPSG:32632", "EPSG:32633"]);
    tin("utm.las", "32.geojson", &[]).works(&["EPSG:32632", "EPSG:5783"]);
    tin("utm.las", "ign.geojson", &[]).fails(
        1,
        &["a coordinate system that is not understood: ign.geojson states \"urn:ogc:def:crs:IGNF::LAMB93\", utm.las is in"],
    );
    let assigned = ["--a-srs", "http://www.opengis.net/def/crs/EPSG/0/32632"];
    tin("utm.las", "ign.geojson", &assigned)
        .works(&["warning: ign.geojson: crs not used", "EPSG:32632"]);
    tin("plain.xyz", "ign.geojson", &[]).works(&["warning: ign.geojson: crs not used"]);
}

/// The first number behind some words in a text.
fn number_before(text: &str, what: &str) -> i64 {
    let Some(at) = text.find(what) else { return 0 };
    let digits: String = text[..at]
        .trim_end()
        .chars()
        .rev()
        .take_while(char::is_ascii_digit)
        .collect();
    digits
        .chars()
        .rev()
        .collect::<String>()
        .parse()
        .unwrap_or_else(|_| panic!("no number before {what} in {text}"))
}

#[test]
fn sums_of_vertices_add_up() {
    let apart: String = (0..260)
        .map(|i| format!("{} {} 1\n", 1000 * (i % 20 + 1), 1000 * (i / 20 + 1)))
        .collect();
    let folder = folder_with(&[("a.xyz", &format!("{SLOPE}{apart}"))]);
    let run = run_in(&folder, &["tin", "a.xyz", "-o", "a.ply"]);
    run.works(&[
        "276 used",
        "\nvertices    16 (260 left out with triangles at the rim)\n",
    ]);
    let (points, lines, ring) = (
        fixture("valley.laz"),
        fixture("breaklines.shp"),
        fixture("boundary.shp"),
    );
    for more in [
        &["--max-edge", "none"][..],
        &["--max-edge", "3"],
        &["--max-edge", "3", "--boundary", &ring],
        &[
            "--max-edge",
            "none",
            "--bounds",
            "688100,5261050,688200,5261150",
        ],
    ] {
        let args = [
            &[
                "tin",
                &points,
                "--breaklines",
                &lines,
                "-o",
                "b.ply",
                "--overwrite",
            ],
            more,
        ]
        .concat();
        let run = run_in(&folder, &args);
        run.works(&[]);
        let said = |what: &str| number_before(&run.stderr, what);
        let vertices = run.stderr.split("\nvertices    ").nth(1).unwrap();
        let count: i64 = vertices.split([' ', '\n']).next().unwrap().parse().unwrap();
        let sum = said(" used;")
            - said(" at the position of another point")
            - said(" at a breakline's vertex")
            + said(" vertices, ").max(said(" vertices\n"))
            + said(" crossings between vertices")
            - said(" left out with triangles at the rim")
            - number_before(vertices.lines().next().unwrap(), " clipped")
            + said(" added by the clip");
        assert_eq!(sum, count, "{more:?}\n{}", run.stderr);
    }
}

#[test]
fn a_vertex_that_is_nowhere_is_a_flaw_also_without_a_face() {
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
                  element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let folder = folder_with(&[(
        "m.ply",
        &format!("{header}0 0 1\n1 0 1\n0 1 1\nnan 5 1\n3 0 1 2\n"),
    )]);
    run_in(&folder, &["dem", "m.ply", "-o", "d.tif"]).fails(1, &["m.ply: vertex 3 is at NaN 5 1"]);
    let run = run_in(&folder, &["check", "m.ply"]);
    assert_eq!(run.code, 1, "{}", run.stdout);
    assert!(
        run.stdout.contains("vertex 3: a coordinate is not finite")
            && run.stdout.contains("1 flaw"),
        "{}",
        run.stdout
    );
}

#[test]
fn tiles_that_a_tiff_leaves_out_are_0_unless_something_stands_for_none() {
    let tiff = |nodata: Option<&[u8; 4]>| {
        let mut entries: Vec<(u16, u16, u32, [u8; 4])> = Vec::new();
        for (tag, value) in [
            (256, 32),
            (257, 16),
            (258, 8),
            (259, 1),
            (262, 1),
            (277, 1),
            (322, 16),
            (323, 16),
        ] {
            entries.push((tag, 4, 1, u32::to_le_bytes(value)));
        }
        let count = entries.len() as u32 + 2 + u32::from(nodata.is_some());
        let tables = 8 + 2 + 12 * count + 4;
        entries.push((324, 4, 2, tables.to_le_bytes()));
        entries.push((325, 4, 2, (tables + 8).to_le_bytes()));
        entries.extend(nodata.map(|text| (42113, 2, 4, *text)));
        let mut file = b"II*\0\x08\0\0\0".to_vec();
        file.extend((count as u16).to_le_bytes());
        for (tag, kind, length, value) in entries {
            file.extend(tag.to_le_bytes());
            file.extend(kind.to_le_bytes());
            file.extend(length.to_le_bytes());
            file.extend(value);
        }
        file.extend([0; 4]);
        // The first tile is there, the second is not.
        for value in [tables + 16, 0, 256, 0] {
            file.extend(value.to_le_bytes());
        }
        file.extend([7; 256]);
        file
    };
    let folder = folder_with(&[]);
    for (name, nodata, min) in [
        ("plain.tif", None, 0.0),
        ("nodata.tif", Some(b"255\0"), 7.0),
    ] {
        std::fs::write(folder.path().join(name), tiff(nodata)).unwrap();
        let run = run_in(&folder, &["info", "--json", name]);
        let files: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        assert_eq!(
            (files[0]["min"].as_f64(), files[0]["max"].as_f64()),
            (Some(min), Some(7.0)),
            "{}",
            run.stdout
        );
        assert_eq!(
            run.stderr
                .contains("1 of 2 blocks are not in the file: their cells are 0"),
            nodata.is_none()
        );
    }
}

/// Titles of windows, colors, C1 and a text that runs backwards are not for the terminal.
#[test]
fn escape_sequences_in_files_do_not_reach_the_terminal() {
    let evil = "x\u{1b}]0;owned\u{7}\u{1b}[31m\u{9b}2J\u{202e}gnp.\u{2066}\r";
    let lines = geojson(25832, "LineString", "[[0,0,1],[2,2,1]]");
    let (name, other) = (format!("{evil}.xyz"), format!("{evil}.geojson"));
    let folder = folder_with(&[(&name, SLOPE), (&other, &lines)]);
    let wkt = format!(
        "PROJCS[\"{evil}\",GEOGCS[\"{evil}\",DATUM[\"d\",SPHEROID[\"s\",6378137,298.25]],PRIMEM[\"g\",0],\
         UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Mercator_1SP\"],UNIT[\"metre\",1]]"
    );
    let runs = [
        run_in(&folder, &["info", &name, &other, "none\u{1b}[2J.xyz"]),
        run_in(&folder, &["info", &name, &other]),
        run_in(&folder, &["info", "--json", &name, &other]),
        run_in(
            &folder,
            &[
                "-v",
                "tin",
                &name,
                "--breaklines",
                &other,
                "--a-srs",
                &wkt,
                "-o",
                "\u{9b}t.ply",
            ],
        ),
        run_in(&folder, &["info", "\u{9b}t.ply"]),
        run_in(&folder, &["check", "\u{9b}t.ply"]),
    ];
    for run in &runs {
        let all = format!("{}{}", run.stdout, run.stderr);
        let hidden = |c: &char| (c.is_control() && *c != '\n') || "\u{202e}\u{2066}".contains(*c);
        assert_eq!(all.chars().find(hidden), None, "{all:?}");
    }
    assert!(
        runs[1]
            .stdout
            .contains(r"x\u{1b}]0;owned\u{7}\u{1b}[31m\u{9b}2J\u{202e}gnp."),
        "{}",
        runs[1].stdout
    );
    assert!(
        runs[4].stdout.contains(r"x\u{1b}]0;owned"),
        "{}{}",
        runs[3].stderr,
        runs[4].stdout
    );
    let files: serde_json::Value = serde_json::from_str(&runs[2].stdout).unwrap();
    assert_eq!(files[0]["file"], name.as_str());
}

/// A file of half a megabyte may be one block of half a gigabyte: its values are not held twice.
#[test]
#[cfg(target_os = "linux")]
fn a_huge_block_is_held_once() {
    let (side, run_length) = (4096_u32, 128);
    // PackBits: each pair of bytes repeats a zero 128 times.
    let data = [0x81, 0].repeat((side * side / run_length) as usize);
    let tags = [
        (256, side),
        (257, side),
        (258, 8),
        (259, 32773),
        (262, 1),
        (273, 8 + 2 + 12 * 9 + 4),
        (277, 1),
        (278, side),
        (279, data.len() as u32),
    ];
    let mut file = b"II*\0\x08\0\0\0\x09\0".to_vec();
    for (tag, value) in tags {
        file.extend(u16::to_le_bytes(tag));
        file.extend([4, 0, 1, 0, 0, 0]);
        file.extend(value.to_le_bytes());
    }
    file.extend([0; 4]);
    file.extend(data);
    let folder = folder_with(&[]);
    std::fs::write(folder.path().join("bomb.tif"), file).unwrap();
    let run = run_in(
        &folder,
        &["contour", "bomb.tif", "--levels", "5", "-o", "c.geojson"],
    );
    run.works(&["no contour crosses", "4096 x 4096 cells"]);
    // 8 bytes a cell, and one as it is stored: 151 MB.
    let peak = run
        .stderr
        .split("peak memory ")
        .nth(1)
        .unwrap()
        .split('.')
        .next()
        .unwrap();
    let peak: u32 = peak.trim_end().trim_end_matches(" MB").parse().unwrap();
    assert!((134..230).contains(&peak), "{}", run.stderr);
}

#[test]
fn the_layer_and_the_field_of_heights_follow_the_file() {
    let flat = geojson(25832, "LineString", "[[1,1],[2,3]]");
    let named = flat.replacen("{", r#"{"name":"edges","#, 1);
    let ring = geojson(25832, "Polygon", "[[[0,0],[3,0],[3,3],[0,3],[0,0]]]");
    let points = geojson(25832, "MultiPoint", "[[0,0],[4,0],[0,4]]");
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("l.geojson", &named),
        ("10:30/l:Z.geojson", &flat),
        ("ring.geojson", &ring),
        ("p.geojson", &points),
        ("a.kml", "<?xml version=\"1.0\"?><kml/>"),
    ]);
    let tin = |args: &[&str]| {
        run_in(
            &folder,
            &[&["tin", "-o", "t.ply", "--overwrite"], args].concat(),
        )
    };
    let lines = |spec: &str| tin(&["a.xyz", "--breaklines", spec]);
    for spec in [
        "l.geojson:Z",
        "l.geojson:l:Z",
        "l.geojson:edges:z",
        "l.geojson::Z",
        "10:30/l:Z.geojson:Z",
    ] {
        lines(spec).works(&["breaklines  1 in"]);
    }
    lines("l.geojson").fails(
        1,
        &[
            "l.geojson: record 1: the line has no heights",
            "FILE:LAYER:FIELD",
        ],
    );
    lines("l.geojson:roads:Z").fails(
        2,
        &[
            "there is no layer \"roads\"",
            "\"edges\" or \"l\"",
            "FILE::Z",
        ],
    );
    lines("l.geojson:H").fails(2, &["there is no field H", "name one of Z"]);
    lines("l.geojson:").fails(2, &["no name after the colon", "FILE::FIELD"]);
    lines("none.geojson:Z").fails(1, &["no such file"]);
    for spec in ["p.geojson:Z", "p.geojson:p:Z", "p.geojson::Z"] {
        tin(&[spec]).works(&["3 used"]);
    }
    tin(&["p.geojson:q:Z"]).fails(2, &["there is no layer \"q\""]);
    tin(&["a.xyz", "--boundary", "ring.geojson:ring:Z"]).works(&[]);
    tin(&["a.xyz", "--boundary", "ring.geojson:site:Z"]).fails(2, &["there is no layer \"site\""]);
    if !breakline::io::gdal::IS_AVAILABLE {
        lines("a.kml:roads:Z").fails(
            1,
            &[
                "a.kml: not a vector format of this build",
                "--features gdal",
            ],
        );
    }
}

#[test]
fn files_that_state_to_be_far_outside_of_the_bounds_are_not_read() {
    let folder = folder_with(&[]);
    let write = |name: &str, corner: [f64; 2], class: u8| {
        let points = las(&tile(corner, class), Some(25832));
        std::fs::write(folder.path().join(name), points).unwrap();
    };
    write("near.las", [0.0, 0.0], 2);
    write("far.las", [5000.0, 0.0], 2);
    write("beyond.las", [9000.0, 4000.0], 2);
    let left_out = "2 of 3 files are not read: by their headers they lie more than 10 m outside";
    let window = ["--bounds", "1,1,2,2", "--max-edge", "10"];
    let tin = |inputs: &[&str], options: &[&str], output: &str| {
        run_in(
            &folder,
            &[&["tin"], inputs, options, &["-o", output]].concat(),
        )
    };
    let all = ["near.las", "far.las", "beyond.las"];
    let run = tin(&all, &window, "some.ply");
    run.works(&[left_out, "16 read from 3 files, 16 used"]);
    // What the whole has within the same bounds.
    let boundary = geojson(25832, "Polygon", "[[[1,1],[2,1],[2,2],[1,2],[1,1]]]");
    std::fs::write(folder.path().join("b.geojson"), boundary).unwrap();
    let cut = ["--boundary", "b.geojson", "--max-edge", "10"];
    tin(&all, &cut, "whole.ply").works(&["48 read from 3 files"]);
    assert_eq!(bytes(&folder, "some.ply"), bytes(&folder, "whole.ply"));

    // Ground far away decides that other classes are not used, here too.
    write("near.las", [0.0, 0.0], 5);
    tin(&all, &window, "none.ply").fails(
        1,
        &["no triangle is left: 12 have edges over 10 m at the rim, 36 are clipped"],
    );
    // Without ground, the others are looked into; classes that they may have are not denied.
    write("far.las", [5000.0, 0.0], 5);
    write("beyond.las", [9000.0, 4000.0], 6);
    tin(&all, &window, "searched.ply").works(&[
        "2 of 3 files are read only until one has a ground point, as no other file has: by their headers",
        "16 read from 3 files",
    ]);
    let classes = [&window[..], &["--class", "5,6"]].concat();
    tin(&all, &classes, "five.ply").works(&[
        left_out,
        "no point that was read has class 6; outside of the bounds, 2 files were not read",
    ]);
    write("far.las", [5000.0, 0.0], 2);
    // A header that was not filled in is not trusted, and one without area is not.
    let mut unfilled = las(&tile([0.0, 0.0], 2), Some(25832));
    unfilled[179..227].fill(0);
    std::fs::write(folder.path().join("near.las"), &unfilled).unwrap();
    tin(&all, &window, "unfilled.ply").works(&[left_out, "16 used"]);
    assert_eq!(bytes(&folder, "some.ply"), bytes(&folder, "unfilled.ply"));

    let run = run_in(
        &folder,
        &[
            "points",
            "near.las",
            "far.las",
            "beyond.las",
            "--bounds",
            "1,1,2,2",
            "-o",
            "p.las",
        ],
    );
    run.works(&[
        "2 of 3 files are not read: by their headers they lie outside of the bounds",
        "4 points of 16, 12 outside",
    ]);
    run_in(
        &folder,
        &["points", "far.las", "--bounds", "1,1,2,2", "-o", "q.las"],
    )
    .fails(2, &["no point is left: by their headers", "breakline info"]);
}

#[test]
fn a_glob_of_layers_may_name_the_attribute_with_the_heights() {
    let line = |y: f64| geojson(25832, "LineString", &format!("[[0,{y}],[3,{y}]]"));
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("edges-1.geojson", &line(0.5)),
        ("edges-2.geojson", &line(1.5)),
    ]);
    let run = run_in(
        &folder,
        &[
            "tin",
            "a.xyz",
            "--breaklines",
            "edges-*.geojson:Z",
            "-o",
            "t.ply",
        ],
    );
    run.works(&["breaklines  2 in"]);
    let missing = |pattern: &str, said: &str| {
        run_in(
            &folder,
            &["tin", "a.xyz", "--breaklines", pattern, "-o", "u.ply"],
        )
        .fails(1, &[said]);
    };
    missing("none-*.geojson:Z", "no file matches `none-*.geojson`");
    missing("none.geojson:Z", "no such file");
}

/// Contours need no lengths, and shades state those of a degree.
#[test]
fn a_dem_in_degrees_has_contours_and_shades() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let flags = [
        "--a-srs",
        "EPSG:4326",
        "--max-edge",
        "none",
        "--force-degrees",
        "--resolution",
        "0.5",
    ];
    run_in(
        &folder,
        &[&["dem", "a.xyz", "-o", "e.tif"], &flags[..]].concat(),
    )
    .works(&[]);
    run_in(&folder, &["contour", "e.tif", "-o", "c.shp"])
        .works(&["note: x and y are in units of the degree"]);
    run_in(&folder, &["hillshade", "e.tif", "-o", "s.tif"]).works(&[
        "note: coordinates are angles: one unit of x is taken as 111",
        "units of the heights, one of y as 111195, as in the middle of the raster (--z-factor",
    ]);
    let with_factor = |factor: &str| {
        let words = ["hillshade", "e.tif", "--z-factor", factor, "-o", "z.tif"];
        run_in(&folder, &[&words[..], &["--overwrite"]].concat())
    };
    let run = with_factor("0.001");
    run.works(&[]);
    assert!(!run.stderr.contains("angles"), "{}", run.stderr);
    // Twice the heights are meant.
    with_factor("2").works(&[
        "warning: coordinates are angles: with a factor of 2, slopes are 222390 times too steep",
        "twice the heights are --z-factor 1.80e-5",
    ]);
}
