//! Points in tiles, as it is typed.

use std::collections::BTreeMap;
use std::fs;

use super::{bytes, folder_with, run_in};
use tempfile::TempDir;
use testkit::lidar::las;
use testkit::random::Random;

/// Points at multiples of 0.25, many of them on the borders of tiles.
fn cloud(random: &mut Random, count: usize) -> Vec<([f64; 3], u8)> {
    let point = |_| {
        let [x, y] = [0, 1].map(|_| (random.index(120) as f64 - 40.0) / 4.0);
        ([x, y, random.index(9) as f64], 2 + random.index(2) as u8)
    };
    (0..count).map(point).collect()
}

fn folder() -> TempDir {
    let folder = folder_with(&[]);
    let random = &mut Random(9);
    for name in ["a.las", "b.las"] {
        let file = las(&cloud(random, 800), Some(25832));
        fs::write(folder.path().join(name), file).unwrap();
    }
    folder
}

/// The records of a LAS file in format 0.
fn records(file: &[u8]) -> Vec<Vec<u8>> {
    let start = u32::from_le_bytes(file[96..100].try_into().unwrap()) as usize;
    let records = file[start..].chunks_exact(20);
    records.map(<[u8]>::to_vec).collect()
}

/// The position of a record in plan, in hundredths.
fn position(record: &[u8]) -> [i32; 2] {
    [0, 4].map(|at| i32::from_le_bytes(record[at..at + 4].try_into().unwrap()))
}

/// The tiles of records by their names, each record as often as it is near one.
fn expected(all: &[Vec<u8>], size: i32, buffer: i32, flag: u8) -> BTreeMap<String, Vec<Vec<u8>>> {
    let mut tiles: BTreeMap<String, Vec<Vec<u8>>> = BTreeMap::new();
    for column in -10..20 {
        for row in -10..20 {
            let low = [column * size, row * size];
            let is_own = |p: [i32; 2]| (0..2).all(|k| low[k] <= p[k] && p[k] < low[k] + size);
            let is_near = |p: [i32; 2]| {
                (0..2).all(|k| low[k] - buffer <= p[k] && p[k] <= low[k] + size + buffer)
            };
            if !all.iter().any(|record| is_own(position(record))) {
                continue;
            }
            let mut tile = Vec::new();
            for record in all {
                let p = position(record);
                let mut record = record.clone();
                if !is_own(p) {
                    record[15] |= flag;
                }
                if is_own(p) || (buffer > 0 && is_near(p)) {
                    tile.push(record);
                }
            }
            let [x, y] = low.map(|steps| f64::from(steps) / 100.0);
            tiles.insert(format!("{x}_{y}.las"), tile);
        }
    }
    tiles
}

fn tiles_in(folder: &TempDir, name: &str) -> BTreeMap<String, Vec<Vec<u8>>> {
    let files = fs::read_dir(folder.path().join(name)).unwrap();
    let tile = |file: std::io::Result<fs::DirEntry>| {
        let file = file.unwrap();
        let name = file.file_name().into_string().unwrap();
        (name, records(&fs::read(file.path()).unwrap()))
    };
    files.map(tile).collect()
}

#[test]
fn each_tile_has_its_points_and_those_near_it() {
    let folder = folder();
    run_in(&folder, &["points", "a.las", "b.las", "-o", "all.las"]).works(&[]);
    let all = records(&bytes(&folder, "all.las"));
    for (number, (size, buffer, words)) in [
        (500, 0, &["--tile", "5"][..]),
        (500, 100, &["--tile", "5m", "--buffer", "1m"]),
        (
            250,
            250,
            &["--tile", "2.5", "--buffer", "2.5", "--flag-buffer"],
        ),
        (
            700,
            50,
            &["--tile", "0.007km", "--buffer", "0.5", "--threads", "1"],
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let name = format!("tiles{number}");
        let out = ["points", "a.las", "b.las", "-o", &name];
        let run = run_in(&folder, &[&out, words].concat());
        run.works(&[
            "points      1600 points of 1600",
            &format!(" files in {name}"),
        ]);
        let flag = if words.contains(&"--flag-buffer") {
            0x80
        } else {
            0
        };
        let expected = expected(&all, size, buffer, flag);
        assert!(expected.len() > 10);
        assert!(tiles_in(&folder, &name) == expected, "{words:?}");
    }
    // Tiles with a flagged buffer are one file again.
    let merge = [
        "points",
        "tiles2/*.las",
        "--drop-withheld",
        "-o",
        "again.las",
    ];
    run_in(&folder, &merge).works(&["1600 points of"]);
    let sorted = |file: &str| {
        let mut all = records(&bytes(&folder, file));
        all.sort();
        all
    };
    assert!(sorted("again.las") == sorted("all.las"));
}

#[test]
fn tiles_are_all_there_or_none() {
    let folder = folder();
    let run = |words: &[&str]| run_in(&folder, &[&["points", "a.las"], words].concat());
    run(&["--tile", "5", "--class", "2", "-o", "t"]).works(&[" of other classes"]);
    let before = tiles_in(&folder, "t");
    run(&["--tile", "5", "-o", "t"]).fails(1, &["t/", ".las", "--overwrite"]);
    assert!(tiles_in(&folder, "t") == before);
    run(&["--tile", "5", "-o", "t", "--overwrite"]).works(&[]);
    assert!(tiles_in(&folder, "t") != before);
    run(&["--tile", "1", "--buffer", "2", "-o", "new"]).fails(2, &["wider than a tile"]);
    assert!(!folder.path().join("new").exists());
    run(&["--buffer", "2", "-o", "new"]).fails(2, &["--tile"]);
    run(&["--tile", "5", "-o", "u", "--class", "7"]).fails(2, &["no point is left"]);
    assert!(!folder.path().join("u").exists());
    run(&["--tile", "5", "-o", "no/folder"]).fails(1, &["no/folder"]);
    // A tile would be the input.
    let input = folder.path().join("in");
    fs::create_dir(&input).unwrap();
    fs::copy(folder.path().join("t/0_0.las"), input.join("0_0.las")).unwrap();
    let words = [
        "points",
        "in/0_0.las",
        "--tile",
        "5",
        "-o",
        "in",
        "--overwrite",
    ];
    run_in(&folder, &words).fails(2, &["in/0_0.las", "would replace an input"]);
    fs::write(folder.path().join("a.xyz"), "1 2 3\n4 5 6\n").unwrap();
    run_in(&folder, &["points", "a.xyz", "--tile", "5", "-o", "x"]).fails(1, &["LAS"]);
    let unknown = las(&cloud(&mut Random(1), 50), None);
    fs::write(folder.path().join("d.las"), unknown).unwrap();
    let words = [
        "points",
        "d.las",
        "--a-srs",
        "EPSG:4326",
        "--tile",
        "1km",
        "-o",
        "x",
    ];
    run_in(&folder, &words).fails(2, &["the coordinates are angles", "--t-srs"]);
    assert!(!folder.path().join("x").exists());
}
