//! The ground of lidar points, as it is typed.

use std::fs;

use serde_json::Value;
use tempfile::TempDir;
use testkit::copc::{Tree, copc};
use testkit::lidar::las;

use super::{bytes, files_of, folder_with, run_in, run_with};

/// Points a meter apart on a slope with a house of 10 m by 10 m, from one column up to another. The
/// classes are 0 and 1, and of some points 5; a few are flagged as withheld.
fn town(columns: std::ops::Range<u32>, unit: f64) -> Vec<([f64; 3], u8)> {
    let mut points = Vec::new();
    for i in columns {
        for j in 0..50 {
            let (x, y) = (f64::from(i), f64::from(j));
            let class = match (i * 7 + j * 13) % 29 {
                0 => 5,
                1 => 0x80,
                k => (k % 2) as u8,
            };
            let z = 100.0 + 0.1 * x + if is_house(i, j) { 6.0 } else { 0.0 };
            points.push(([x / unit, y / unit, z / unit], class));
        }
    }
    points
}

fn is_house(i: u32, j: u32) -> bool {
    (25..35).contains(&i) && (20..30).contains(&j)
}

/// The bytes with the classes of a LAS file of format 0.
fn classes(file: &[u8]) -> Vec<u8> {
    let start = u32::from_le_bytes(file[96..100].try_into().unwrap()) as usize;
    file[start..]
        .chunks_exact(20)
        .map(|record| record[15])
        .collect()
}

/// The class that each point of the town is to get.
fn expected(points: &[([f64; 3], u8)]) -> Vec<u8> {
    let house = |(p, _): &([f64; 3], u8)| is_house(p[0] as u32, p[1] as u32);
    let of = |point: &([f64; 3], u8)| match point.1 {
        0 | 1 if house(point) => 1,
        0 | 1 => 2,
        kept => kept,
    };
    points.iter().map(of).collect()
}

fn folder_of(files: &[(&str, Vec<u8>)]) -> TempDir {
    let folder = folder_with(&[]);
    for (name, file) in files {
        fs::write(folder.path().join(name), file).unwrap();
    }
    folder
}

#[test]
fn a_house_is_no_ground_and_only_classes_change() {
    let points = town(0..60, 1.0);
    let folder = folder_of(&[("a.las", las(&points, Some(25832)))]);
    let run = run_in(&folder, &["ground", "a.las", "-o", "b.las", "--json"]);
    run.works(&[
        "3000 points in 1 file, ",
        "class 2 ",
        "(ground), before 0",
        "written     b.las",
    ]);
    let [a, b] = ["a.las", "b.las"].map(|name| bytes(&folder, name));
    assert_eq!(classes(&b), expected(&points));
    let other = |file: &[u8]| -> Vec<u8> {
        let start = u32::from_le_bytes(file[96..100].try_into().unwrap()) as usize;
        let is_class = |at: usize| at >= start && (at - start) % 20 == 15;
        (0..file.len())
            .filter(|at| !is_class(*at))
            .map(|at| file[at])
            .collect()
    };
    assert!(other(&a) == other(&b));
    let found: Value = serde_json::from_str(&run.stdout).unwrap();
    let file = &found["files"][0];
    let count = |of: &dyn Fn(u8) -> bool, list: &[u8]| {
        list.iter().filter(|class| of(**class & 0x1f)).count() as u64
    };
    assert_eq!(file["points"], 3000);
    assert_eq!(
        (&file["path"], &file["output"]),
        (&"a.las".into(), &"b.las".into())
    );
    let (before, after) = (classes(&a), classes(&b));
    for class in [0, 1, 2, 5] {
        let is = |known: u8| known == class;
        let stated = |when: &str| file[when][class.to_string()].as_u64().unwrap_or(0);
        assert_eq!(stated("before"), count(&is, &before), "{class}");
        assert_eq!(stated("after"), count(&is, &after), "{class}");
    }
    assert!(found["seconds"].as_f64().unwrap() >= 0.0);
    // A class that is not named stays.
    let words = [
        "ground",
        "a.las",
        "-o",
        "c.las",
        "--from-class",
        "1",
        "--quiet",
    ];
    run_in(&folder, &words).works(&[]);
    let kept = |(now, then): (u8, u8)| then == 1 || now == then;
    assert!(
        classes(&bytes(&folder, "c.las"))
            .into_iter()
            .zip(before.clone())
            .all(kept)
    );
    // All are single returns: there are no others.
    let words = ["ground", "a.las", "-o", "d.las", "--return", "2", "--quiet"];
    run_in(&folder, &words).works(&[]);
    let none = classes(&bytes(&folder, "d.las"));
    assert!(none.iter().zip(&before).all(|(now, then)| match then {
        0 | 1 => *now == 1,
        then => now == then,
    }));
}

#[test]
fn files_are_one_area_and_the_unit_makes_no_difference() {
    let (left, right) = (town(0..30, 1.0), town(30..60, 1.0));
    // US survey feet.
    let foot = 1200.0 / 3937.0;
    let points = town(0..60, 1.0);
    let folder = folder_of(&[
        ("left.las", las(&left, Some(25832))),
        ("right.las", las(&right, Some(25832))),
        ("feet.las", las(&town(0..60, foot), Some(2264))),
    ]);
    run_in(&folder, &["ground", "left.las", "right.las", "-o", "out"]).works(&["in 2 files"]);
    assert_eq!(
        files_of(&folder.path().join("out")),
        ["left.las", "right.las"]
    );
    let both = ["out/left.las", "out/right.las"].map(|name| classes(&bytes(&folder, name)));
    assert_eq!(both.concat(), expected(&points));
    run_in(&folder, &["ground", "feet.las", "-o", "m.las"]).works(&[]);
    assert_eq!(classes(&bytes(&folder, "m.las")), expected(&points));
    // The folder is kept, and so are its files.
    let again = ["ground", "left.las", "-o", "out"];
    run_in(&folder, &again).fails(1, &["left.las", "exists", "--overwrite"]);
    let over = [
        "ground",
        "left.las",
        "-o",
        "out",
        "--overwrite",
        "--from-class",
        "31",
    ];
    run_in(&folder, &over).works(&[]);
    assert_eq!(bytes(&folder, "out/left.las"), bytes(&folder, "left.las"));
}

#[test]
fn what_makes_no_sense_is_refused_and_leaves_nothing() {
    let points = town(0..10, 1.0);
    let tree = Tree {
        low: [0; 3],
        side: 1024,
        most: 20,
        levels_of_page: 2,
    };
    let octree = copc(&[[1, 2, 3], [700, 3, 9]], &tree).bytes;
    let mut cut = las(&points, None);
    cut.truncate(cut.len() - 7);
    let folder = folder_of(&[
        ("a.las", las(&points, Some(25832))),
        ("b.las", las(&points, Some(2264))),
        ("cut.las", cut),
        ("tile.copc.laz", octree),
        ("a.xyz", b"1 2 3\n4 5 6\n".to_vec()),
    ]);
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::write(folder.path().join("sub/a.las"), las(&points, Some(25832))).unwrap();
    let before = files_of(folder.path());
    for (words, code, said) in [
        (
            &["a.xyz", "-o", "o.las"][..],
            1,
            &["a.xyz", "LAS and LAZ only", "breakline tin"][..],
        ),
        (
            &["a.las", "-o", "a.las", "--overwrite"],
            2,
            &["one of the inputs"],
        ),
        (
            &["a.las", "cut.las", "-o", "out"],
            1,
            &["cut.las", "byte", "it was cut"],
        ),
        (
            &["a.las", "cut.las", "-o", "out.laz"],
            2,
            &["2 files", "a folder"],
        ),
        (&["a.las", "b.las", "-o", "out"], 1, &["a.las", "b.las"]),
        (&["a.las", "sub/a.las", "-o", "out"], 2, &["named twice"]),
        (
            &["a.las", "-o", "o.copc.laz"],
            2,
            &["order of an octree", "breakline points"],
        ),
        (&["a.las", "-o", "o.tif"], 2, &[".las", ".laz"]),
        (
            &["none.las", "-o", "o.las"],
            1,
            &["none.las", "no such file"],
        ),
        (
            &["a.las", "-o", "o.las", "--a-srs", "EPSG:nonsense"],
            2,
            &["--a-srs"],
        ),
        (
            &["a.las", "-o", "o.las", "--bridges", "up"],
            2,
            &["off, ground"],
        ),
    ] {
        let run = run_in(&folder, &[&["ground"], words].concat());
        run.fails(code, said);
        assert_eq!(files_of(folder.path()), before, "{words:?}");
    }
    let stdin = run_with(&folder, &["ground", "-", "-o", "o.las"], "1 2 3\n");
    stdin.fails(2, &["only once", "copy it to a file"]);
    run_in(&folder, &["ground", "tile.copc.laz", "-o", "sub"])
        .works(&["octree of COPC is left out"]);
    assert_eq!(files_of(&folder.path().join("sub")), ["a.las", "tile.laz"]);
}

#[test]
fn surfaces_of_the_ground_are_those_of_its_class() {
    let points = town(0..60, 1.0);
    let classes = expected(&points);
    let text = |is_used: &dyn Fn(usize) -> bool| -> Vec<u8> {
        let used = (0..points.len()).filter(|i| is_used(*i));
        let lines = used.map(|i| {
            let [x, y, z] = points[i].0;
            format!("{x} {y} {z:.2}\n")
        });
        lines.collect::<String>().into_bytes()
    };
    let folder = folder_of(&[
        ("a.las", las(&points, Some(25832))),
        ("a.xyz", text(&|i| points[i].1 < 2)),
        ("ground.xyz", text(&|i| classes[i] == 2)),
    ]);
    run_in(&folder, &["ground", "a.las", "-o", "b.las"]).works(&[]);
    let verbs: &[(&str, &str, &[&str])] = &[
        ("tin", "ply", &[]),
        ("dem", "tif", &[]),
        ("dem", "tif", &["--bounds", "20,15,40,35"]),
        ("hillshade", "tif", &["--resolution", "2"]),
        ("contour", "geojson", &["--interval", "0.5"]),
    ];
    for (number, (verb, extension, options)) in verbs.iter().enumerate() {
        let surface = |input: &str, how: &[&str], name: &str| {
            let output = format!("{name}-{number}.{extension}");
            let words = [
                &[*verb, input, "-o", &output, "--a-srs", "EPSG:25832"],
                how,
                options,
            ];
            let run = run_in(&folder, &words.concat());
            (run, bytes(&folder, &output))
        };
        let (_, wanted) = surface("b.las", &["--class", "2"], "wanted");
        let (run, found) = surface("a.las", &["--ground", "--class", "0,1"], "found");
        run.works(&["points are on the ground, and are used"]);
        assert!(found == wanted, "{verb} {options:?}");
        // Numbers of text are other doubles than those of a lattice.
        let (_, wanted) = surface("ground.xyz", &[], "wanted-text");
        let (_, of_text) = surface("a.xyz", &["--ground"], "text");
        assert!(of_text == wanted, "{verb} {options:?}");
    }
    // By default all classes but noise are searched.
    let run = run_in(&folder, &["dem", "a.las", "--ground", "-o", "all.tif"]);
    run.works(&["points of all classes are used, except noise"]);
    let tiles = ["dem", "a.las", "--ground", "-o", "t.tif", "--tiles", "2x2"];
    run_in(&folder, &tiles).fails(1, &["--ground does not work with tiles yet"]);
    let of_surface = ["dem", "wanted-0.ply", "--ground", "-o", "s.tif"];
    run_in(&folder, &of_surface).fails(2, &["--ground is for building a TIN"]);
}

#[test]
fn heights_above_the_ground_are_those_above_its_surface() {
    let points = town(0..60, 1.0);
    let folder = folder_of(&[
        ("a.las", las(&points, None)),
        ("a.xyz", b"1 2 3\n".to_vec()),
    ]);
    let words = [
        "sample",
        "a.las",
        "--ground",
        "--at",
        "a.las",
        "--add",
        "height-above",
    ];
    run_in(&folder, &[&words[..], &["-o", "b.las"]].concat()).works(&["3000 points"]);
    let file = bytes(&folder, "b.las");
    let start = u32::from_le_bytes(file[96..100].try_into().unwrap()) as usize;
    let heights = file[start..].chunks_exact(28);
    assert_eq!(heights.len(), points.len());
    for ((p, class), record) in points.iter().zip(heights) {
        let height = f64::from_le_bytes(record[20..].try_into().unwrap());
        let is_house = is_house(p[0] as u32, p[1] as u32);
        let wanted = if is_house { 6.0 } else { 0.0 };
        assert!((height - wanted).abs() < 0.011, "{p:?}: {height}");
        let is_vertex = !is_house && *class != 0x80;
        assert!(!is_vertex || height == 0.0, "{p:?}: {height}");
    }
    assert!(file.windows(17).any(|bytes| bytes == b"HeightAboveGround"));
    // The ground under the house is further away.
    let near = [&words[..], &["--max-edge-inside", "2", "-o", "c.las"]].concat();
    run_in(&folder, &near).works(&["3000 points, ", "outside"]);
    let of_text = ["sample", "a.las", "--at", "a.xyz", "--add", "height-above"];
    run_in(&folder, &of_text).fails(1, &["a.xyz", "LAS and LAZ only"]);
}

/// The page runs as it is written, on the valley of the demo.
#[test]
fn the_page_on_raw_tiles_runs() {
    let folder = folder_with(&[]);
    run_in(&folder, &["demo", "."]).works(&[]);
    super::jobs::run_page(include_str!("../../docs/ground.md"), &folder);
    let files = files_of(folder.path());
    for name in [
        "classified.laz",
        "terrain.tif",
        "canopy.tif",
        "heights.laz",
        "terrain.geojson",
    ] {
        assert!(files.iter().any(|file| file == name), "{name}");
    }
}

#[test]
fn files_that_do_not_fit_into_memory_get_the_classes_of_the_whole() {
    // Hills with houses, in two files that share a border. 32 MB have room for some of the points.
    let of_columns = |columns: std::ops::Range<u32>| {
        let cells = columns.flat_map(|i| (0..400).map(move |j| (i, j)));
        let point = |(i, j): (u32, u32)| {
            let hill = 10.0 * (f64::from(i) / 70.0).sin() * (f64::from(j) / 50.0).cos();
            let is_house = i % 41 < 12 && j % 37 < 9;
            let height = hill + if is_house { 6.0 } else { 0.0 };
            ([f64::from(i), f64::from(j), height], 0)
        };
        las(&cells.map(point).collect::<Vec<_>>(), None)
    };
    let folder = folder_of(&[
        ("west.las", of_columns(0..200)),
        ("east.las", of_columns(200..400)),
    ]);
    let ground = ["ground", "west.las", "east.las"];
    let whole = run_in(&folder, &[&ground[..], &["-o", "whole"]].concat());
    whole.works(&[]);
    let few = ["-o", "tiled", "--memory", "32MB"];
    let tiled = run_in(&folder, &[&ground[..], &few].concat());
    tiled.works(&[]);
    for name in ["west.las", "east.las"] {
        let of = |of: &str| bytes(&folder, &format!("{of}/{name}"));
        assert_eq!(classes(&of("whole")), classes(&of("tiled")), "{name}");
        let ground = classes(&of("whole"))
            .iter()
            .filter(|&&class| class == 2)
            .count();
        assert!((60_000..79_000).contains(&ground), "{ground}");
    }
}

#[test]
fn two_classifications_of_the_same_points_are_compared() {
    let points = town(0..60, 1.0);
    let mut other = points.clone();
    other.swap(7, 8);
    let folder = folder_of(&[
        ("a.las", las(&points, None)),
        ("swapped.las", las(&other, None)),
        ("few.las", las(&points[..2000], None)),
    ]);
    run_in(&folder, &["ground", "a.las", "-o", "b.laz"]).works(&[]);
    let compare = |words: &[&str]| run_in(&folder, &[&["compare", "--classes"], words].concat());
    let found: Value =
        serde_json::from_str(&compare(&["b.laz", "a.las", "--json"]).stdout).unwrap();
    let pairs = |keep: fn(u64, u64) -> bool| -> u64 {
        let pairs = found["pairs"].as_array().unwrap().iter();
        let of =
            |pair: &Value| ["first", "second", "points"].map(|key| pair[key].as_u64().unwrap());
        let counts = pairs.map(of).filter(|[a, b, _]| keep(*a, *b));
        counts.map(|[_, _, count]| count).sum()
    };
    assert_eq!((&found["points"], pairs(|_, _| true)), (&3000.into(), 3000));
    // Nothing was ground before: all that is ground is kept wrongly, and none is lost.
    let classes = expected(&points);
    let ground = classes.iter().filter(|class| **class & 0x1f == 2).count() as u64;
    assert_eq!(pairs(|first, _| first == 2), ground);
    assert_eq!(found["ground"]["type_1"], Value::Null);
    assert_eq!(found["ground"]["type_2"], ground as f64 / 3000.0);
    assert_eq!(
        pairs(|first, second| first != second),
        found["changed"].as_u64().unwrap()
    );
    let text = compare(&["b.laz", "a.las"]).stdout;
    assert!(text.contains("2 (ground), and 0 ("), "{text}");
    for (words, said) in [
        (&["a.las"][..], "nothing to compare it with"),
        (&["a.las", "few.las"], "2000 points, and a.las has more"),
        (
            &["a.las", "swapped.las"],
            "point 7 (counted from 0) is at 0 7 100, and in swapped.las at 0 8 100",
        ),
        (&["a.las", "b.laz", "few.las"], "a third file"),
        (&["a.las", "b.laz", "--changed", "1"], "cannot be used with"),
    ] {
        let run = compare(words);
        assert!(
            run.code != 0 && run.stderr.contains(said),
            "{words:?}: {}",
            run.stderr
        );
    }
}
