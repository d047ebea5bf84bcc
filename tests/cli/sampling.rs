//! `sample` as it is typed: what is added to points, and what is kept of them.

use serde_json::Value;

use super::{SLOPE, bytes, files_of, folder_with, geojson, run_in, run_with};
use testkit::lidar::las;

/// A plane: z = 10 + x, from 0 to 3.
const POINTS: &str = "id,x,y,note\n1,0.5,1.25,\"a, b\"\n# skipped\n2,3,3,\n3,9,9,far\n";

#[test]
fn text_is_kept_byte_by_byte_and_gets_columns() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("p.csv", POINTS)]);
    let run = run_in(&folder, &["sample", "a.xyz", "--at", "p.csv"]);
    run.works(&[
        "sampled     3 points, 1 outside",
        "warning: p.csv: 1 of 3 points are outside of the surface",
    ]);
    assert_eq!(
        run.stdout,
        "id,x,y,note,surface_z\n1,0.5,1.25,\"a, b\",10.5\n# skipped\n2,3,3,,13\n3,9,9,far,\n"
    );
    // To a file, with all that can be added.
    let add = "height,slope,slope-percent,aspect,gradient";
    run_in(
        &folder,
        &[
            "sample", "a.xyz", "--at", "p.csv", "--add", add, "--prefix", "s_", "-o", "o.csv",
        ],
    )
    .works(&[]);
    let written = String::from_utf8(bytes(&folder, "o.csv")).unwrap();
    let lines: Vec<&str> = written.lines().collect();
    assert_eq!(
        lines[0],
        "id,x,y,note,s_surface_z,s_slope,s_slope_pct,s_aspect,s_gradient_x,s_gradient_y"
    );
    assert_eq!(lines[1], "1,0.5,1.25,\"a, b\",10.5,45,100,270,1,0");
    assert_eq!(lines[4], "3,9,9,far,,,,,,");
}

#[test]
fn files_without_points_are_refused_and_nothing_is_written() {
    let nothing = r#"{"type":"FeatureCollection","features":[]}"#;
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("empty.xyz", ""),
        ("names.csv", "id,x,y\n"),
        ("empty.geojson", nothing),
    ]);
    std::fs::write(folder.path().join("empty.las"), las(&[], Some(25832))).unwrap();
    let before = files_of(folder.path());
    for (points, output) in [
        ("empty.xyz", "o.xyz"),
        ("names.csv", "o.csv"),
        ("empty.geojson", "o.geojson"),
        ("empty.las", "o.las"),
    ] {
        run_in(&folder, &["sample", "a.xyz", "--at", points, "-o", output])
            .fails(1, &[points, "no points"]);
    }
    assert_eq!(files_of(folder.path()), before);
}

#[test]
fn columns_of_points_in_plan_need_no_heights() {
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("n.csv", "A,1,0.5\nB,2,2.5\n"),
        ("two.xyz", "1 0.5\n2 2.5\n"),
    ]);
    // --columns is for the points of a surface, too.
    run_in(&folder, &["tin", "a.xyz", "-o", "a.tin"]).works(&[]);
    let sample = |words: &[&str]| run_in(&folder, &[&["sample", "a.tin", "--at"], words].concat());
    for (columns, said, heights) in [
        ("2,3", "columns     x 2, y 3", ["11", "12"]),
        ("SNE", "columns     x 3, y 2", ["10.5", "12.5"]),
    ] {
        let run = sample(&["n.csv", "--columns", columns]);
        run.works(&[said]);
        let [one, other] = heights;
        assert_eq!(run.stdout, format!("A,1,0.5,{one}\nB,2,2.5,{other}\n"));
    }
    let run = sample(&["two.xyz", "--columns", "XY"]);
    run.works(&["columns     x 1, y 2\n"]);
    assert_eq!(run.stdout, "1 0.5 11\n2 2.5 12\n");
    // Points of a surface have heights.
    run_in(
        &folder,
        &["tin", "a.xyz", "--columns", "1,2", "-o", "o.ply"],
    )
    .fails(
        2,
        &["a.xyz: no column has heights: x 1, y 2", "--columns 1,2,3"],
    );
}

/// A surface in parts is asked from part to part, with the same results as in one piece.
#[test]
fn parts_have_what_the_whole_has() {
    let mut random = testkit::random::Random(3);
    // Positions on a small grid: many are on edges between parts, and on vertices.
    let mut rows = |count: usize, has_height: bool| -> String {
        let row = |_| {
            let [x, y] = [0; 2].map(|_| random.index(41));
            let z = if has_height { random.index(30) } else { 0 };
            format!("{x} {y} {z}\n")
        };
        (0..count).map(row).collect()
    };
    let (ground, points) = (rows(900, true), rows(700, false));
    let folder = folder_with(&[
        ("g.xyz", &ground),
        ("old.xyz", "0 0 9\n40 0 9\n40 40 12\n0 40 12\n"),
        ("p.xyz", &points),
    ]);
    run_in(
        &folder,
        &["tin", "old.xyz", "--max-edge", "none", "-o", "old.tin"],
    )
    .works(&[]);
    let commands: &[&[&str]] = &[
        &[
            "sample",
            "SURFACE",
            "--at",
            "p.xyz",
            "--add",
            "height,slope,aspect,gradient",
        ],
        &["accuracy", "SURFACE", "--checkpoints", "g.xyz", "--json"],
        &["volume", "SURFACE", "--levels", "5:20:2.5", "--json"],
        &["volume", "SURFACE", "old.tin", "--json"],
        &["volume", "old.tin", "SURFACE", "--json"],
        &[
            "compare",
            "SURFACE",
            "old.tin",
            "--resolution",
            "1",
            "--changed",
            "3",
            "--min-area",
            "0",
            "--json",
        ],
    ];
    // Bounds cut triangles: parts have fragments.
    for clip in [&[][..], &["--bounds", "3.3,3.7,33.1,30.9"]] {
        for (more, name) in [(&[][..], "whole.tin"), (&["--tiles", "3x2"], "parts.tins")] {
            let words = [&["tin", "g.xyz", "--overwrite", "-o", name][..], clip, more];
            run_in(&folder, &words.concat()).works(&[]);
        }
        for command in commands {
            let [whole, parts] = ["whole.tin", "parts.tins"].map(|name| {
                let words: Vec<&str> = command
                    .iter()
                    .map(|word| if *word == "SURFACE" { name } else { word })
                    .collect();
                let run = run_in(&folder, &words);
                assert_eq!(run.code, 0, "{words:?}: {}", run.stderr);
                run.stdout
            });
            assert!(whole.len() > 200, "{command:?}: {whole}");
            assert_eq!(whole, parts, "{command:?}, {clip:?}");
        }
    }
}

#[test]
fn ends_of_lines_marks_and_separators_stay() {
    for (text, expected) in [
        ("1 1\r\n2 2\r\n", "1 1 11\r\n2 2 12\r\n"),
        ("1\t1\t5\r2\t2\t6", "1\t1\t5\t11\r2\t2\t6\t12"),
        ("\n1;1;\n\n\n2;2;\n", "\n1;1;;11\n\n\n2;2;;12\n"),
        ("X;Y\n0,5;1,5\n", "X;Y;surface_z\n0,5;1,5;10,5\n"),
        ("\u{feff}x,y\n1,1\n", "\u{feff}x,y,surface_z\n1,1,11\n"),
        ("# x y\n1 1 \n", "# x y surface_z\n1 1  11\n"),
        ("2\n1 1 0\n9 9 0\n", "2\n1 1 0 11\n9 9 0 nan\n"),
    ] {
        let folder = folder_with(&[("a.xyz", SLOPE)]);
        let words = ["sample", "a.xyz", "--at", "-"];
        let run = run_with(&folder, &words, text);
        assert_eq!(
            (run.code, run.stdout.as_str()),
            (0, expected),
            "{}",
            run.stderr
        );
    }
}

#[test]
fn many_points_come_back_in_order() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let count = 200_000;
    let rows = (0..count).map(|i| format!("{i},{},{}\n", f64::from(i % 301) / 100.0, i % 4));
    let text: String = ["id,x,y\n".to_owned()].into_iter().chain(rows).collect();
    let run = run_with(&folder, &["sample", "a.xyz", "--at", "-"], &text);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let found: Vec<&str> = run.stdout.lines().collect();
    assert_eq!(found.len(), count as usize + 1);
    for (i, (line, before)) in found.iter().zip(text.lines()).enumerate().skip(1) {
        let height = line
            .strip_prefix(before)
            .and_then(|rest| rest.strip_prefix(','));
        let height: f64 = height.unwrap().parse().unwrap();
        let x = f64::from((i as i32 - 1) % 301) / 100.0;
        assert!((height - 10.0 - x).abs() < 1e-12, "{line}");
    }
}

#[test]
fn any_surface_is_sampled() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("p.csv", "x,y\n1.5,1.5\n")]);
    for words in [
        &["tin", "a.xyz", "-o", "a.tin"][..],
        &["tin", "a.xyz", "-o", "a.ply"],
        &["dem", "a.xyz", "--resolution", "1", "-o", "a.tif"],
    ] {
        run_in(&folder, words).works(&[]);
    }
    for surface in ["a.xyz", "a.tin", "a.ply", "a.tif"] {
        let run = run_in(&folder, &["sample", surface, "--at", "p.csv"]);
        assert_eq!(
            run.stdout, "x,y,surface_z\n1.5,1.5,11.5\n",
            "{surface}: {}",
            run.stderr
        );
    }
    let smooth = ["sample", "a.tin", "--at", "p.csv", "--method", "smooth"];
    assert_eq!(run_in(&folder, &smooth).code, 0);
    let run = run_in(&folder, &[&smooth[..], &["--add", "slope"]].concat());
    run.fails(2, &["slopes are those of the triangles"]);
}

#[test]
fn points_take_the_assigned_system() {
    let zone = |code| geojson(code, "Point", "[1, 1, 11.5]");
    let folder = folder_with(&[("a.xyz", SLOPE), ("p.geojson", &zone(25833))]);
    run_in(
        &folder,
        &["tin", "a.xyz", "--a-srs", "EPSG:25832", "-o", "a.tin"],
    )
    .works(&[]);
    for verb in [
        &["sample", "a.tin", "--at"],
        &["accuracy", "a.tin", "--checkpoints"],
    ] {
        let words = [&verb[..], &["p.geojson"]].concat();
        run_in(&folder, &words).fails(
            1,
            &[
                "two coordinate systems",
                "EPSG:25833",
                "state the system of all files with --a-srs",
            ],
        );
        run_in(&folder, &[&words[..], &["--a-srs", "EPSG:25832"]].concat()).works(&[]);
    }
}

#[test]
fn columns_are_those_that_are_named() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("p.txt", "1 2.5 0.5 a\n2 1.5 2 b\n")]);
    run_in(&folder, &["tin", "a.xyz", "-o", "a.tin"]).works(&[]);
    let words = ["sample", "a.tin", "--at", "p.txt", "--columns", "3,2,1"];
    let run = run_in(&folder, &words);
    assert_eq!(
        run.stdout, "1 2.5 0.5 a 10.5\n2 1.5 2 b 12\n",
        "{}",
        run.stderr
    );
}

#[test]
fn the_report_is_json() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("p.csv", POINTS)]);
    let run = run_in(
        &folder,
        &["sample", "a.xyz", "--at", "p.csv", "--json", "-o", "o.csv"],
    );
    let found: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(
        found,
        serde_json::json!({"points": 3, "outside": 1, "columns": ["surface_z"]})
    );
}

#[test]
fn bad_input_is_refused_and_nothing_is_written() {
    let far = "x,y\n500,500\n600,600\n";
    let odd = "x,y\n1,1\n1,nan\n";
    let taken = "x,y,SURFACE_Z\n1,1,1\n";
    let text = "hello\n";
    let folder = folder_with(&[
        ("a.xyz", SLOPE),
        ("far.csv", far),
        ("odd.csv", odd),
        ("taken.csv", taken),
        ("text.csv", text),
        ("ragged.csv", "x,y,note\n1,1,a\n2,2\n"),
        ("cut.pts", "3\n1 1 0\n2 2 0\n"),
        (
            "line.geojson",
            &geojson(25832, "LineString", "[[1, 1], [2, 2]]"),
        ),
    ]);
    std::fs::write(
        folder.path().join("p.las"),
        las(&[([1.0, 1.0, 5.0], 2)], None),
    )
    .unwrap();
    let before = files_of(folder.path());
    for (points, words, code, message) in [
        (
            "far.csv",
            &[][..],
            2,
            "far.csv: all 2 points are outside of a.xyz",
        ),
        ("odd.csv", &[], 1, "odd.csv: line 3: y is \"nan\""),
        ("taken.csv", &[], 2, "there is a column surface_z already"),
        ("text.csv", &[], 1, "neither a point nor a header"),
        ("none.csv", &[], 1, "none.csv: no such file"),
        ("far.csv", &["--add", "slope,slope"], 2, "named twice"),
        (
            "ragged.csv",
            &[],
            1,
            "ragged.csv: line 3: 2 fields separated by commas, but the header has 3",
        ),
        (
            "cut.pts",
            &[],
            1,
            "cut.pts: the end: the first line states 3 points, but there are 2",
        ),
        (
            "odd.csv",
            &["--prefix", "a,b"],
            2,
            "is not one field between commas",
        ),
        ("a.xyz", &["-o", "o.tif"], 2, "o.tif"),
        ("a.xyz", &["-o", "a.xyz", "--overwrite"], 2, "a.xyz"),
        ("p.las", &["-o", "o.csv"], 2, "written as .las or .laz"),
        (
            "a.xyz",
            &["-o", "o.las"],
            2,
            "written as .csv or .txt or .xyz",
        ),
        (
            "line.geojson",
            &["-o", "o.geojson"],
            1,
            "feature 1: the geometry is not a point",
        ),
    ] {
        let base = ["sample", "a.xyz", "--at", points, "-o", "o.csv"];
        let base = if words.contains(&"-o") {
            &base[..4]
        } else {
            &base[..]
        };
        let run = run_in(&folder, &[base, words].concat());
        run.fails(code, &[message]);
        assert_eq!(files_of(folder.path()), before, "{points}");
    }
    let mut waves = las(&[([1.0, 1.0, 5.0], 2)], None);
    waves[104] = 4;
    waves[105] = 57;
    waves.resize(waves.len() + 37, 0);
    std::fs::write(folder.path().join("w.las"), waves).unwrap();
    let run = run_in(
        &folder,
        &["sample", "a.xyz", "--at", "w.las", "-o", "o.las"],
    );
    run.fails(1, &["w.las: point format 4 refers to waveforms"]);
    let run = run_in(&folder, &["sample", "-", "--at", "-"]);
    run.fails(2, &["cannot both be stdin"]);
    let run = run_in(&folder, &["sample", "a.xyz", "--at", "a.xyz", "--json"]);
    assert_eq!(run.code, 2);
}

#[test]
fn lidar_gets_extra_bytes_and_keeps_its_records() {
    let folder = folder_with(&[("a.xyz", SLOPE)]);
    let points = [
        ([0.5, 1.25, 40.0], 2),
        ([3.0, 3.0, 41.0], 6),
        ([9.0, 9.0, 42.0], 1),
    ];
    std::fs::write(folder.path().join("p.las"), las(&points, None)).unwrap();
    let add = ["--add", "height,gradient"];
    for (from, to) in [("p.las", "o.las"), ("p.las", "o.laz")] {
        let words = ["sample", "a.xyz", "--at", from, "-o", to];
        run_in(&folder, &[&words[..], &add].concat()).works(&["3 points, 1 outside"]);
        let read = |name: &str| -> Vec<::las::Point> {
            let mut reader = ::las::Reader::from_path(folder.path().join(name)).unwrap();
            let all = reader.read_all().unwrap();
            all.points().map(Result::unwrap).collect()
        };
        for (before, after) in read(from).into_iter().zip(read(to)) {
            let numbers: Vec<f64> = after
                .extra_bytes
                .chunks_exact(8)
                .map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap()))
                .collect();
            if before.x > 3.0 {
                assert!(numbers.iter().all(|number| number.is_nan()));
            } else {
                assert_eq!(numbers, [10.0 + before.x, 1.0, 0.0]);
            }
            let kept = ::las::Point {
                extra_bytes: Vec::new(),
                ..after
            };
            assert_eq!(kept, before);
        }
    }
    // The new bytes are added to those that are there.
    let words = ["sample", "a.xyz", "--at", "o.las", "-o", "again.las"];
    run_in(&folder, &words).fails(2, &["there is a dimension surface_z already"]);
    run_in(&folder, &[&words[..], &["--prefix", "two_"]].concat()).works(&[]);
    let reader = ::las::Reader::from_path(folder.path().join("again.las")).unwrap();
    assert_eq!(reader.header().point_format().extra_bytes, 32);
}

#[test]
fn what_is_left_of_points_that_were_cut_is_sampled() {
    let folder = folder_with(&[("a.xyz", SLOPE), ("cut.pts", "3\n1 1 0\n2 2 0\n")]);
    let points = las(&[([1.0, 1.0, 5.0], 2), ([2.0, 2.0, 5.0], 2)], None);
    std::fs::write(folder.path().join("cut.las"), &points[..points.len() - 20]).unwrap();
    run_in(&folder, &["tin", "a.xyz", "-o", "a.tin"]).works(&[]);
    for surface in ["a.xyz", "a.tin"] {
        for (points, to) in [("cut.las", "o.las"), ("cut.pts", "o.xyz")] {
            let words = ["sample", surface, "--at", points, "-o", to, "--overwrite"];
            run_in(&folder, &words).fails(1, &[points, "--partial"]);
            let accepted = [&words[..], &["--partial"]].concat();
            run_in(&folder, &accepted).works(&["warning: cut.", "sampled "]);
        }
        let words = ["accuracy", surface, "--checkpoints", "cut.las"];
        run_in(&folder, &words).fails(1, &["cut.las", "--partial"]);
        run_in(&folder, &[&words[..], &["--partial"]].concat()).works(&["warning: cut.las"]);
    }
}

#[test]
fn a_shapefile_gets_fields_and_keeps_its_bytes() {
    use ::shapefile::dbase::{FieldValue, Record, TableWriterBuilder};
    let folder = folder_with(&[("a.xyz", SLOPE), ("p.prj", "LOCAL_CS[\"x\"]")]);
    let path = |name: &str| folder.path().join(name);
    let table = TableWriterBuilder::new().add_character_field("NAME".try_into().unwrap(), 8);
    let mut writer = ::shapefile::Writer::from_path(path("p.shp"), table).unwrap();
    for (x, y, name) in [(0.5, 1.25, "oak"), (9.0, 9.0, "far")] {
        let mut record = Record::default();
        record.insert(
            "NAME".to_owned(),
            FieldValue::Character(Some(name.to_owned())),
        );
        let point = ::shapefile::Point::new(x, y);
        writer.write_shape_and_record(&point, &record).unwrap();
    }
    drop(writer);
    let words = [
        "sample",
        "a.xyz",
        "--at",
        "p.shp",
        "-o",
        "o.shp",
        "--add",
        "height,slope-percent",
    ];
    run_in(&folder, &words).works(&["2 points, 1 outside"]);
    for extension in ["shp", "shx", "prj"] {
        let [before, after] = ["p", "o"].map(|stem| bytes(&folder, &format!("{stem}.{extension}")));
        assert!(before == after, "{extension}");
    }
    let rows: Vec<Record> = ::shapefile::read(path("o.shp"))
        .unwrap()
        .into_iter()
        .map(|(_, record)| record)
        .collect();
    let number = |row: usize, name: &str| rows[row].get(name).cloned().unwrap();
    assert_eq!(
        number(0, "NAME"),
        FieldValue::Character(Some("oak".to_owned()))
    );
    assert_eq!(number(0, "surface_z"), FieldValue::Numeric(Some(10.5)));
    assert_eq!(number(0, "slope_pct"), FieldValue::Numeric(Some(100.0)));
    assert_eq!(
        number(1, "NAME"),
        FieldValue::Character(Some("far".to_owned()))
    );
    assert_eq!(number(1, "surface_z"), FieldValue::Numeric(None));
    let again = ["sample", "a.xyz", "--at", "o.shp", "-o", "again.shp"];
    run_in(&folder, &again).fails(2, &["a field surface_z already", "--prefix n, or rename"]);
    let other = [&again[..5], &["other.shp", "--prefix", "n"]].concat();
    run_in(&folder, &other).works(&[]);
    let long = ["--prefix", "much_too_"];
    run_in(&folder, &[&again[..], &long].concat()).fails(2, &["more than the 10 bytes"]);
    run_in(&folder, &["sample", "a.xyz", "--at", "p.shp"]).fails(2, &["written to a stream"]);
    let table = bytes(&folder, "p.dbf");
    std::fs::write(path("p.dbf"), &table[..table.len() - 6]).unwrap();
    run_in(
        &folder,
        &["sample", "a.xyz", "--at", "p.shp", "-o", "short.shp"],
    )
    .fails(
        1,
        &["p.dbf: the table ends in row 2 of 2", "copy all files"],
    );
    std::fs::write(path("p.dbf"), &table).unwrap();
    // Rows are in the order of the index.
    let mut index = bytes(&folder, "p.shx");
    let (one, other) = index[100..].split_at_mut(8);
    one.swap_with_slice(other);
    std::fs::write(path("p.shx"), index).unwrap();
    run_in(
        &folder,
        &["sample", "a.xyz", "--at", "p.shp", "-o", "odd.shp"],
    )
    .fails(1, &["p.shx"]);
    assert!(!path("odd.shp").exists());
}

#[test]
fn geojson_gets_properties_and_keeps_its_text() {
    let text = r#"{ "type":"FeatureCollection", "crs":{"type":"name","properties":{"name":"EPSG:25832"}},
 "features":[ {"type":"Feature","properties":{"a":1.10},"geometry":{"type":"Point","coordinates":[0.5,1.25,7]}} ] }"#;
    let folder = folder_with(&[("a.xyz", SLOPE), ("p.geojson", text)]);
    let words = ["sample", "a.xyz", "--at", "p.geojson"];
    let run = run_in(&folder, &words);
    let expected = text.replace("1.10}", "1.10,\"surface_z\":10.5}");
    assert_eq!(run.stdout, expected, "{}", run.stderr);
    run_in(&folder, &[&words[..], &["-o", "o.geojson"]].concat()).works(&[]);
    assert_eq!(bytes(&folder, "o.geojson"), expected.as_bytes());
}
