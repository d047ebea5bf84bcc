//! One answer: the same bytes whatever the order of points, lines and files, and the number of
//! threads.

use std::collections::BTreeMap;
use std::path::Path;

use crate::random::Random;
use crate::{breakline, fixture, folder, geojson, text};

type Points = Vec<[f64; 3]>;
type Lines = Vec<Vec<[f64; 3]>>;

const WEST: f64 = 688_000.0;
const SOUTH: f64 = 5_261_000.0;

/// Points on a lattice of half a metre, so that most circles go through four or more, with gaps and
/// with sites that have two, three or four heights.
fn ground() -> Points {
    let mut random = Random(7);
    let mut points = Vec::new();
    for i in 0..60 {
        for j in 0..50 {
            let (x, y) = (WEST + f64::from(i) / 2.0, SOUTH + f64::from(j) / 2.0);
            let height = |random: &mut Random| {
                800.0 + f64::from((i * j) % 97) / 20.0 + random.below(40) as f64 / 100.0
            };
            // Seven out of eight sites have a point, every eighth of them more than one.
            let count = if random.below(8) == 0 {
                random.below(4)
            } else {
                1
            };
            for _ in 0..count {
                points.push([x, y, height(&mut random)]);
            }
        }
    }
    points
}

/// Lines that cross, touch, overlap and repeat each other, run through points, and share vertices
/// at other heights.
fn breaklines() -> Lines {
    let line = |vertices: &[[f64; 3]]| {
        vertices
            .iter()
            .map(|[x, y, z]| [WEST + x, SOUTH + y, 800.0 + z])
            .collect()
    };
    vec![
        line(&[[1.0, 1.0, 2.0], [11.3, 9.7, 4.0], [28.1, 22.2, 3.0]]),
        line(&[[2.2, 21.0, 1.0], [27.0, 3.1, 5.0]]),
        line(&[[3.0, 12.0, 2.0], [26.0, 12.0, 2.5]]),
        line(&[[10.0, 12.0, 7.0], [20.0, 12.0, 8.0]]),
        line(&[[20.0, 12.0, 1.0], [20.0, 20.25, 2.0], [11.3, 9.7, 6.0]]),
        line(&[[1.0, 1.0, 2.0], [11.3, 9.7, 4.0]]),
        line(&[
            [5.0, 5.0, 3.0],
            [8.0, 5.0, 3.0],
            [8.0, 8.0, 3.0],
            [5.0, 8.0, 3.0],
            [5.0, 5.0, 3.0],
        ]),
    ]
}

/// Every product of the inputs, by file name.
fn products(inputs: &[(&str, String)], lines: &Lines, extra: &[&str]) -> BTreeMap<String, Vec<u8>> {
    products_with(
        inputs,
        "lines.geojson",
        |path| std::fs::write(path, geojson(lines)).unwrap(),
        extra,
    )
}

fn products_with(
    inputs: &[(&str, String)],
    lines: &str,
    write_lines: impl FnOnce(&Path),
    extra: &[&str],
) -> BTreeMap<String, Vec<u8>> {
    let work = folder();
    for (name, content) in inputs {
        std::fs::write(work.path().join(name), content).unwrap();
    }
    write_lines(&work.path().join(lines));
    let out = work.path().join("out");
    std::fs::create_dir(&out).unwrap();
    let mut surface: Vec<&str> = inputs.iter().map(|(name, _)| *name).collect();
    surface.extend(["--breaklines", lines, "--a-srs", "EPSG:25832", "-q"]);
    surface.extend(extra);
    let frame = ["--resolution", "0.25"];
    let run =
        |verb: &str, more: &[&str]| breakline(work.path(), &[&[verb], &surface[..], more].concat());
    run(
        "tin",
        &["-o", "out/t.ply", "-o", "out/t.obj", "-o", "out/t.stl"],
    );
    run("dem", &[&["-o", "out/d.tif"], &frame[..]].concat());
    run(
        "contour",
        &[
            "--interval",
            "0.25",
            "-o",
            "out/c.shp",
            "-o",
            "out/c.geojson",
        ],
    );
    run(
        "hillshade",
        &[&["-o", "out/h.png", "-o", "out/h.tif"], &frame[..]].concat(),
    );
    let files = std::fs::read_dir(out).unwrap().map(|entry| entry.unwrap());
    files
        .map(|file| {
            (
                file.file_name().into_string().unwrap(),
                std::fs::read(file.path()).unwrap(),
            )
        })
        .collect()
}

#[track_caller]
fn assert_same(
    found: &BTreeMap<String, Vec<u8>>,
    expected: &BTreeMap<String, Vec<u8>>,
    what: &str,
) {
    let names: Vec<&String> = found.keys().collect();
    assert!(
        names.iter().copied().eq(expected.keys()),
        "{what}: {names:?}"
    );
    for (name, bytes) in found {
        assert!(*bytes == expected[name], "{what}: {name} differs");
    }
}

#[test]
fn bytes_depend_on_the_set_alone() {
    let (points, lines) = (ground(), breaklines());
    let mut random = Random(11);
    let mut shuffled = points.clone();
    random.shuffle(&mut shuffled);
    let mut turned = lines.clone();
    random.shuffle(&mut turned);
    turned.iter_mut().for_each(|line| line.reverse());
    let (first, rest) = shuffled.split_at(shuffled.len() / 3);
    let (second, third) = rest.split_at(rest.len() / 2);
    let (one, two, three) = (text(first), text(second), text(third));

    let mut by_rule = Vec::new();
    for rule in ["lowest", "highest", "mean"] {
        let options = ["--duplicates", rule];
        let expected = products(
            &[("a.xyz", text(&points))],
            &lines,
            &[&options[..], &["--threads", "2"]].concat(),
        );
        let names = expected
            .keys()
            .map(String::as_str)
            .collect::<Vec<_>>()
            .join(" ");
        assert_eq!(
            names,
            "c.cpg c.dbf c.geojson c.prj c.shp c.shx d.tif h.pgw h.png h.png.aux.xml h.tif \
             t.obj t.ply t.stl t.stl.origin.txt"
        );
        let again = |inputs: &[(&str, String)], lines: &Lines, more: &[&str], what: &str| {
            let found = products(inputs, lines, &[&options[..], more].concat());
            assert_same(&found, &expected, &format!("{rule}, {what}"));
        };
        let all = [("a.xyz", text(&shuffled))];
        again(&all, &lines, &["--threads", "1"], "shuffled points");
        again(
            &all,
            &turned,
            &["--threads", "2"],
            "shuffled lines, turned around",
        );
        let files = [
            ("z.xyz", three.clone()),
            ("m.xyz", one.clone()),
            ("b.xyz", two.clone()),
        ];
        again(&files, &turned, &["--threads", "1"], "three files");
        let files = [
            ("b.xyz", two.clone()),
            ("m.xyz", one.clone()),
            ("z.xyz", three.clone()),
        ];
        again(&files, &lines, &[], "three files in another order");
        by_rule.push(expected["t.obj"].clone());
    }
    // The rules do make a difference here.
    assert!(by_rule[0] != by_rule[1] && by_rule[1] != by_rule[2] && by_rule[0] != by_rule[2]);
}

#[test]
fn first_and_last_follow_the_order_of_appearance() {
    let (points, lines) = (ground(), breaklines());
    let backwards: Points = points.iter().rev().copied().collect();
    // Vertices that breaklines share at different heights follow the rule as well.
    let lines_backwards: Lines = lines
        .iter()
        .rev()
        .map(|line| line.iter().rev().copied().collect())
        .collect();
    let tin =
        |inputs: &[(&str, String)], rule: &str| products(inputs, &lines, &["--duplicates", rule]);
    let from_the_end = |rule: &str| {
        products(
            &[("a.xyz", text(&backwards))],
            &lines_backwards,
            &["--duplicates", rule],
        )
    };
    let whole = [("a.xyz", text(&points))];
    let first = tin(&whole, "first");
    let last = tin(&whole, "last");
    assert!(first["t.ply"] != last["t.ply"]);
    assert_same(&from_the_end("last"), &first, "last, from the end");
    assert_same(&from_the_end("first"), &last, "first, from the end");
    // The order of files counts as well; the cut lies between points of one place.
    let cut = points
        .windows(2)
        .rposition(|pair| pair[0][..2] == pair[1][..2] && pair[0][2] != pair[1][2])
        .unwrap()
        + 1;
    let [start, end] = [text(&points[..cut]), text(&points[cut..])];
    let files = [("z.xyz", start.clone()), ("b.xyz", end.clone())];
    assert_same(&tin(&files, "first"), &first, "first, two files");
    let files = [("b.xyz", end), ("z.xyz", start)];
    assert!(tin(&files, "first")["t.ply"] != first["t.ply"]);
}

/// The same lines from a shapefile that another program wrote.
#[test]
fn the_format_of_the_lines_makes_no_difference() {
    let (points, lines) = (ground(), breaklines());
    let expected = products(&[("a.xyz", text(&points))], &lines, &[]);
    let write = |path: &Path| {
        use shapefile::{NO_DATA, PointZ, PolylineZ};
        let table = shapefile::dbase::TableWriterBuilder::new().add_numeric_field(
            shapefile::dbase::FieldName::try_from("ID").unwrap(),
            6,
            0,
        );
        let mut writer = shapefile::Writer::from_path(path, table).unwrap();
        for line in lines.iter().rev() {
            let line = line
                .iter()
                .rev()
                .map(|&[x, y, z]| PointZ::new(x, y, z, NO_DATA))
                .collect();
            let mut row = shapefile::dbase::Record::default();
            row.insert(
                "ID".to_owned(),
                shapefile::dbase::FieldValue::Numeric(Some(1.0)),
            );
            writer
                .write_shape_and_record(&PolylineZ::new(line), &row)
                .unwrap();
        }
    };
    let found = products_with(&[("a.xyz", text(&points))], "lines.shp", write, &[]);
    assert_same(&found, &expected, "shapefile");
}

#[test]
fn the_fixtures_give_the_same_bytes_on_one_thread_and_on_two() {
    let work = folder();
    let (points, lines, rim) = (
        fixture("valley.laz"),
        fixture("breaklines.shp"),
        fixture("boundary.shp"),
    );
    let run = |threads: &str, verb: &str, more: &[&str]| {
        let surface = [
            points.as_str(),
            "--breaklines",
            &lines,
            "--boundary",
            &rim,
            "--threads",
            threads,
        ];
        breakline(work.path(), &[&[verb], &surface[..], more].concat());
    };
    for (verb, name) in [
        ("tin", "t.ply"),
        ("dem", "d.tif"),
        ("contour", "c.shp"),
        ("hillshade", "h.png"),
    ] {
        let [one, two] = [format!("1{name}"), format!("2{name}")];
        run("1", verb, &["-o", &one]);
        run("2", verb, &["-o", &two]);
        let read = |name: &str| std::fs::read(work.path().join(name)).unwrap();
        assert!(read(&one) == read(&two), "{name}");
    }
}
