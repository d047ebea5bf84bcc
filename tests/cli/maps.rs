//! Contours for maps, as they are typed.

use std::fmt::Write;

use serde_json::Value;

use super::{bytes, folder_with, run_in};

/// Rough hills of 60 x 60 points, 2 apart.
fn hills() -> String {
    let mut text = String::new();
    for k in 0..3600_u32 {
        let [x, y] = [k % 60, k / 60].map(|c| 2.0 * f64::from(c));
        let rough = f64::from(k.wrapping_mul(2_654_435_761) >> 24) / 400.0;
        let z = 6.0 * (x / 19.0).sin() * (y / 23.0).cos() + rough;
        writeln!(text, "{x} {y} {z:.2}").unwrap();
    }
    text
}

fn features(bytes: &[u8]) -> Vec<Value> {
    let read: Value = serde_json::from_slice(bytes).unwrap();
    read["features"].as_array().unwrap().clone()
}

#[test]
fn a_map_has_lines_labels_and_a_promise() {
    let folder = folder_with(&[("hills.xyz", &hills())]);
    run_in(&folder, &["contour", "hills.xyz", "-o", "exact.geojson"]).works(&["contours "]);
    let words = [
        "contour",
        "hills.xyz",
        "--preset",
        "cartographic",
        "--labels-output",
        "labels.geojson",
        "-o",
        "map.geojson",
        "-o",
        "map.shp",
    ];
    run_in(&folder, &words).works(&[
        "left out    ",
        "off the surface at most, measured along all lines",
        "labels      ",
        "written     map.geojson",
        "written     labels.geojson",
    ]);
    let [exact, map, labels] = ["exact.geojson", "map.geojson", "labels.geojson"]
        .map(|name| features(&bytes(&folder, name)));
    assert!(map.len() < exact.len() && !labels.is_empty());
    for line in &map {
        let of = &line["properties"];
        let level = of["ELEV"].as_f64().unwrap();
        assert_eq!(of["INDEX"] == 1, level % 5.0 == 0.0, "{of}");
        assert!(of["DEPRESSION"] == 0 || of["DEPRESSION"] == 1, "{of}");
    }
    for label in &labels {
        assert_eq!(label["geometry"]["type"], "Point");
        let rotation = label["properties"]["ROTATION"].as_f64().unwrap();
        assert!(-90.0 < rotation && rotation <= 90.0);
        assert_eq!(label["properties"]["ELEV"].as_f64().unwrap() % 5.0, 0.0);
    }
    assert!(bytes(&folder, "map.shp").len() > 100);
    run_in(&folder, &words).fails(1, &["map.geojson: the file exists"]);
}

#[test]
fn neither_order_nor_threads_show_in_the_bytes() {
    let text = hills();
    let mut rows: Vec<&str> = text.lines().collect();
    rows.sort_by_key(|row| row.bytes().rev().collect::<Vec<u8>>());
    let folder = folder_with(&[("a.xyz", &text), ("b.xyz", &rows.join("\n"))]);
    let make = |input: &str, threads: &str| {
        let labels = ["--labels", "uphill", "--labels-output", "l.geojson"];
        let words = [
            "contour",
            input,
            "--smooth",
            "0.25",
            "--simplify",
            "0.1",
            "--threads",
            threads,
        ];
        let outputs = ["-o", "c.geojson", "--overwrite"];
        run_in(&folder, &[&words[..], &labels, &outputs].concat()).works(&["deviation   0.2"]);
        (bytes(&folder, "c.geojson"), bytes(&folder, "l.geojson"))
    };
    assert!(make("a.xyz", "1") == make("b.xyz", "2"));
}

#[test]
fn bands_are_polygons_with_both_heights() {
    let folder = folder_with(&[("hills.xyz", &hills())]);
    for (more, promise) in [
        (&[][..], "bands "),
        (&["--preset", "cartographic"][..], "deviation "),
    ] {
        let words = [
            "contour",
            "hills.xyz",
            "--interval",
            "2",
            "-p",
            "-o",
            "b.geojson",
            "--overwrite",
        ];
        run_in(&folder, &[&words[..], more].concat()).works(&[promise]);
        let bands = features(&bytes(&folder, "b.geojson"));
        assert!(bands.len() > 5);
        for band in bands {
            assert_eq!(band["geometry"]["type"], "Polygon");
            let of = &band["properties"];
            let [low, high] = ["ELEV_MIN", "ELEV_MAX"].map(|name| of[name].as_f64().unwrap());
            assert_eq!(high - low, 2.0, "{of}");
        }
    }
}

#[test]
fn some_formats_take_labels_with_the_lines() {
    let folder = folder_with(&[("hills.xyz", &hills())]);
    let words = |name: &'static str, labels: &'static str| {
        let own = ["contour", "hills.xyz", "--preset", "cartographic", "-o"];
        [&own[..], &[name, "--labels-output", labels]].concat()
    };
    run_in(&folder, &words("m.dxf", "./m.dxf")).works(&["labels      ", "written     m.dxf"]);
    run_in(&folder, &words("m.geojson", "l.geojson")).works(&["labels      "]);
    let drawing = String::from_utf8(bytes(&folder, "m.dxf")).unwrap();
    let pairs: Vec<&str> = drawing.lines().collect();
    let count = |of: [&str; 2]| {
        let is_begun = |pairs: &&[&str]| **pairs == ["0", of[0], "8", of[1]];
        pairs.windows(4).filter(is_begun).count()
    };
    let [lines, labels] = ["m.geojson", "l.geojson"].map(|name| features(&bytes(&folder, name)));
    let is_index = |line: &&Value| line["properties"]["INDEX"] == 1;
    let index = lines.iter().filter(is_index).count();
    assert_eq!(count(["POLYLINE", "CONTOURS_INDEX"]), index);
    assert_eq!(count(["POLYLINE", "CONTOURS"]), lines.len() - index);
    assert_eq!(count(["TEXT", "CONTOUR_LABELS"]), labels.len());
    assert!(!labels.is_empty() && index > 0);
    let has_records = |layer: &str, count: usize| {
        let said = run_in(&folder, &["info", layer]).stdout;
        assert!(
            said.contains(&format!("count      {count} records")),
            "{said}"
        );
    };
    has_records("m.dxf", lines.len());
    if cfg!(feature = "gpkg") {
        run_in(&folder, &words("m.gpkg", "m.gpkg")).works(&["written     m.gpkg"]);
        has_records("m.gpkg:m", lines.len());
        has_records("m.gpkg:m_labels", labels.len());
    }
    let cure = "give labels another name, or write both as .gpkg or .dxf";
    for name in ["m.shp", "n.geojson"] {
        run_in(&folder, &words(name, name)).fails(2, &["the output is named twice", cure]);
    }
    // Two names, and one table of attributes.
    let shared = [
        "another output writes m.shx, too",
        "give one of them another name",
    ];
    run_in(&folder, &words("m.shp", "m.SHP")).fails(2, &shared);
    let twice = ["contour", "hills.xyz", "-o", "m.shp", "-o", "m.SHP"];
    run_in(&folder, &twice).fails(2, &shared);
    let apart = ["contour", "hills.xyz", "-o", "x.shp", "-o", "x.geojson"];
    run_in(&folder, &apart).works(&["written     x.shp"]);
}

/// Returns the value behind a code, from a position on.
fn value_of(pairs: &[&str], from: usize, code: &str) -> f64 {
    let mut behind = pairs[from..].chunks_exact(2);
    let pair = behind.find(|pair| pair[0].trim() == code).unwrap();
    pair[1].parse().unwrap()
}

#[test]
fn drawings_have_heights_and_take_labels_alone_but_no_areas() {
    let folder = folder_with(&[("hills.xyz", &hills())]);
    let words = ["contour", "hills.xyz", "--preset", "cartographic", "--2d"];
    let make = |more: &[&str]| run_in(&folder, &[&words[..], more].concat());
    make(&["-o", "both.dxf", "--labels-output", "both.dxf"]).works(&["written     both.dxf"]);
    make(&["-o", "m.geojson", "--labels-output", "l.dxf"]).works(&["written     l.dxf"]);
    make(&["-o", "n.geojson", "--labels-output", "l.geojson"]).works(&[]);
    let count = features(&bytes(&folder, "l.geojson")).len();
    assert!(count > 0);
    for (name, has_lines) in [("both.dxf", true), ("l.dxf", false)] {
        let drawing = String::from_utf8(bytes(&folder, name)).unwrap();
        let pairs: Vec<&str> = drawing.lines().collect();
        let starts_of = |of: [&str; 2]| -> Vec<usize> {
            let is_start = |&at: &usize| pairs.get(at..at + 2) == Some(&of[..]);
            (0..pairs.len()).step_by(2).filter(is_start).collect()
        };
        let texts = starts_of(["0", "TEXT"]);
        assert_eq!(texts.len(), count, "{name}");
        assert_eq!(!starts_of(["0", "POLYLINE"]).is_empty(), has_lines);
        for at in texts {
            assert_eq!(value_of(&pairs, at, "30"), value_of(&pairs, at, "1"));
        }
        let [low, high] = ["$EXTMIN", "$EXTMAX"].map(|corner| starts_of(["9", corner])[0]);
        for code in ["10", "20"] {
            let [low, high] = [low, high].map(|at| value_of(&pairs, at, code));
            assert!(0.0 <= low && low < high && high <= 118.0, "{name}");
        }
        assert!(value_of(&pairs, low, "30") <= value_of(&pairs, high, "30"));
        assert!(!drawing.to_lowercase().contains("nan"), "{name}");
    }
    let refused = [
        "both.dxf: a DXF drawing has no areas",
        "write the areas as .gpkg",
    ];
    make(&["--bands", "-o", "b.shp", "-o", "both.dxf", "--overwrite"]).fails(2, &refused);
    assert!(!folder.path().join("b.shp").exists());
}

#[test]
fn lines_in_the_plane_have_no_heights() {
    let folder = folder_with(&[("hills.xyz", &hills())]);
    let words = ["contour", "hills.xyz", "-o", "c.geojson", "--overwrite"];
    for (more, axes) in [(&[][..], 3), (&["--2d"], 2), (&["--2d", "--smooth"], 2)] {
        run_in(&folder, &[&words[..], more].concat()).works(&["contours "]);
        let lines = features(&bytes(&folder, "c.geojson"));
        assert!(!lines.is_empty());
        for line in lines {
            let first = line["geometry"]["coordinates"][0].as_array().unwrap();
            assert_eq!(first.len(), axes, "{more:?}");
            assert!(line["properties"]["ELEV"].is_number());
        }
    }
}

/// Hills so far away that 32 bits of a coordinate are not enough for the tolerance.
#[test]
fn where_rounding_is_coarse_a_warning_says_so() {
    let moved = |shift: f64| {
        let move_row = |row: &str| {
            let (x, rest) = row.split_once(' ').unwrap();
            format!("{} {rest}\n", x.parse::<f64>().unwrap() + shift)
        };
        hills().lines().map(move_row).collect::<String>()
    };
    let folder = folder_with(&[("far.xyz", &moved(1e10)), ("near.xyz", &moved(6.7e6))]);
    let words = ["--max-edge", "none", "-o", "c.geojson", "--overwrite"];
    let make = |name: &str, more: &[&str]| {
        let own = ["contour", name];
        run_in(&folder, &[&own[..], &words, more].concat())
    };
    let warning = "coordinates up to 1.0e10 have too few digits for contours within 0.5 units";
    for options in [
        &["--smooth"][..],
        &["--min-area", "5"],
        &["--simplify", "1"],
    ] {
        make("far.xyz", options).works(&[warning, "lines may meet; shift the input toward 0"]);
        let near = make("near.xyz", options);
        near.works(&[]);
        assert!(!near.stderr.contains("too few digits"), "{}", near.stderr);
    }
    let exact = make("far.xyz", &["--index-every", "5"]);
    exact.works(&[]);
    assert!(!exact.stderr.contains("too few digits"), "{}", exact.stderr);
}

#[test]
fn what_cannot_be_is_refused_with_a_cure() {
    let folder = folder_with(&[
        ("hills.xyz", &hills()),
        ("degrees.xyz", "6.1 50.1 1\n6.2 50.1 2\n6.1 50.2 3\n"),
    ]);
    for (words, expected) in [
        (
            "contour hills.xyz --smooth 0.7 -o c.shp",
            &["more than half of the interval 1", "use 0.5 at most"][..],
        ),
        (
            "contour --smooth hills.xyz -o c.shp",
            &[
                "`hills.xyz` is not a finite number",
                "`hills.xyz --smooth -o ...`",
                "`--smooth 0.25 hills.xyz`",
            ],
        ),
        (
            "contour hills.xyz --smooth 0 -o c.shp",
            &["0 is not above zero"],
        ),
        (
            "contour degrees.xyz --a-srs EPSG:4326 --force-degrees --max-edge none --smooth -o c.shp",
            &["the coordinates are in degrees", "reproject"],
        ),
        (
            "contour hills.xyz --labels uphill -o c.shp",
            &["--labels-output <FILE>"],
        ),
        (
            "contour hills.xyz --smooth --labels-output c.shp -o c.shp",
            &["the output is named twice"],
        ),
        (
            "contour hills.xyz --labels-output l.tif -o c.shp",
            &["`.tif` is not a format"],
        ),
    ] {
        let words: Vec<&str> = words.split(' ').collect();
        let code = if words.contains(&"--force-degrees") {
            1
        } else {
            2
        };
        run_in(&folder, &words).fails(code, expected);
    }
    assert!(!folder.path().join("c.shp").exists());
}

#[test]
fn options_of_maps_work_alone_and_with_a_dem() {
    let folder = folder_with(&[("hills.xyz", &hills())]);
    run_in(
        &folder,
        &["dem", "hills.xyz", "--resolution", "2", "-o", "d.tif"],
    )
    .works(&[]);
    for options in [
        &["--smooth"][..],
        &["--simplify", "1"],
        &["--min-length", "20"],
        &["--min-area", "40", "--keep-depressions"],
        &["--index-every", "2"],
        &["--labels-output", "l.shp", "--label-height", "3"],
        &["--levels", "1,2.5,4", "--smooth"],
    ] {
        for input in ["hills.xyz", "d.tif"] {
            let words = ["contour", input, "-o", "c.geojson", "--overwrite"];
            run_in(&folder, &[&words[..], options].concat()).works(&["contours "]);
            assert!(!features(&bytes(&folder, "c.geojson")).is_empty());
        }
    }
}
