//! Terrain tiles as they are typed.

use std::io::Read;
use std::path::Path;

use breakline::data::{TilePosition, Tiling, WaterMask};
use breakline::io::quantized_mesh::{DecodedTile, decode};
use serde_json::Value;

use super::{folder_with, run_in};

/// Heights in degrees: a ridge, 21 x 21 points.
fn ridge() -> String {
    let mut text = String::new();
    for i in 0..21 {
        for j in 0..21 {
            let (x, y) = (7.0 + f64::from(i) * 0.0005, 46.0 + f64::from(j) * 0.0005);
            let z = 400 + 7 * (10 - (i - 10_i32).abs()) + j % 3;
            text += &format!("{x:.4} {y:.4} {z}\n");
        }
    }
    text
}

fn tile(path: &Path) -> DecodedTile {
    let bytes = std::fs::read(path).unwrap();
    let mut plain = Vec::new();
    match bytes.starts_with(&[0x1f, 0x8b]) {
        true => {
            let mut gzip = flate2::read::GzDecoder::new(&bytes[..]);
            gzip.read_to_end(&mut plain).unwrap();
        }
        false => plain = bytes,
    }
    decode(&plain).unwrap()
}

/// The names of all files below a folder.
fn files(folder: &Path) -> Vec<String> {
    let mut open = vec![folder.to_path_buf()];
    let mut files = Vec::new();
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap();
                files.push(name.to_str().unwrap().replace('\\', "/"));
            }
        }
    }
    files.sort();
    files
}

const RIDGE: &[&str] = &[
    "terrain-tiles",
    "ridge.xyz",
    "--a-srs",
    "EPSG:4326",
    "-o",
    "tiles",
];

#[test]
fn the_tiles_that_are_listed_are_there() {
    let folder = folder_with(&[("ridge.xyz", &ridge())]);
    let words = [
        RIDGE,
        &["--max-level", "14", "--json", "--vertical-offset", "0"],
    ]
    .concat();
    let run = run_in(&folder, &words);
    run.works(&["level 14"]);
    let report: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(report["levels"].as_array().unwrap().len(), 15);
    let tiles = folder.path().join("tiles");
    let layer: Value =
        serde_json::from_slice(&std::fs::read(tiles.join("layer.json")).unwrap()).unwrap();
    assert_eq!(layer["projection"], "EPSG:4326");
    assert_eq!(layer["scheme"], "tms");
    let mut listed = vec!["layer.json".to_owned()];
    for (level, ranges) in layer["available"].as_array().unwrap().iter().enumerate() {
        let before = listed.len();
        for range in ranges.as_array().unwrap() {
            let number = |name: &str| range[name].as_u64().unwrap();
            for x in number("startX")..=number("endX") {
                let rows = number("startY")..=number("endY");
                listed.extend(rows.map(|y| format!("{level}/{x}/{y}.terrain")));
            }
        }
        assert_eq!(report["levels"][level]["tiles"], listed.len() - before);
    }
    listed.sort();
    assert_eq!(files(&tiles), listed);
    for name in listed.iter().filter(|name| name.ends_with(".terrain")) {
        let tile = tile(&tiles.join(name));
        assert!(tile.triangles.len() >= 2, "{name}");
        assert_eq!(tile.water, None, "{name}");
        let level: u8 = name.split('/').next().unwrap().parse().unwrap();
        assert_eq!(tile.metadata.is_some(), level.is_multiple_of(10), "{name}");
        assert!(
            tile.borders.iter().all(|border| border.len() >= 2),
            "{name}"
        );
        let heights = (0..tile.vertices.len() as u32).map(|v| tile.height(v));
        assert!(
            heights.into_iter().all(|z| (399.0..475.0).contains(&z)),
            "{name}"
        );
    }
}

#[test]
fn a_folder_is_replaced_only_if_asked_for() {
    let folder = folder_with(&[("ridge.xyz", &ridge())]);
    let words = [RIDGE, &["--max-level", "9", "--no-gzip"]].concat();
    run_in(&folder, &words).works(&["heights above the ellipsoid", "--vertical-offset METERS"]);
    let again = run_in(&folder, &words);
    again.fails(2, &["the folder exists", "--overwrite"]);
    let over = [&words[..], &["--overwrite", "--format", "3dtiles"]].concat();
    run_in(&folder, &over).works(&[]);
    let tiles = folder.path().join("tiles");
    let names = files(&tiles);
    assert!(names.contains(&"tileset.json".to_owned()), "{names:?}");
    assert!(names.contains(&"content/0/0/0.glb".to_owned()), "{names:?}");
    assert!(!names.contains(&"layer.json".to_owned()), "{names:?}");
    let glb = std::fs::read(tiles.join("content/0/0/0.glb")).unwrap();
    assert!(glb.starts_with(b"glTF"));
    let at = |target| [RIDGE[..5].to_vec(), vec![target, "--overwrite"]].concat();
    // A file of somebody else, in a folder of tiles: before anything is read.
    std::fs::write(tiles.join("index.html"), "mine").unwrap();
    let refused = run_in(&folder, &at("tiles"));
    refused.fails(2, &["not replaced", "index.html is not of terrain tiles"]);
    assert!(!refused.stderr.contains("vertices"), "{}", refused.stderr);
    assert_eq!(std::fs::read(tiles.join("index.html")).unwrap(), b"mine");
    std::fs::create_dir(folder.path().join("web")).unwrap();
    std::fs::write(folder.path().join("web/layer.json"), "{}").unwrap();
    let other = ["no layer.json or tileset.json that this program"];
    run_in(&folder, &at("web")).fails(2, &other);
    run_in(&folder, &at(".")).fails(2, &["no name of its own"]);
    run_in(&folder, &at("no/tiles")).fails(1, &["does not exist", "mkdir -p no"]);
}

#[test]
fn where_a_surface_is_must_be_known() {
    let folder = folder_with(&[("ridge.xyz", &ridge())]);
    let nowhere = ["terrain-tiles", "ridge.xyz", "-o", "tiles"];
    run_in(&folder, &nowhere).fails(2, &["coordinate system", "--a-srs EPSG:CODE"]);
    let squares = [RIDGE, &["--tiling", "mercator", "--format", "3dtiles"]].concat();
    run_in(&folder, &squares).fails(1, &["3D Tiles are squares of degrees"]);
    for offset in ["1e9", "nan", "-20001"] {
        let option = format!("--vertical-offset={offset}");
        let far = [RIDGE, &[&option]].concat();
        run_in(&folder, &far).fails(2, &["--vertical-offset METERS"]);
    }
    let deep = [RIDGE, &["--fill", "-12000000"]].concat();
    run_in(&folder, &deep).fails(2, &["--fill METERS"]);
    let level = [RIDGE, &["--max-level", "29"]].concat();
    run_in(&folder, &level).fails(2, &["there is no level 29", "--max-level"]);
    assert!(!folder.path().join("tiles").exists());
}

/// Vertices are linear in latitude between the edges of their tile, and heights are those of a
/// slope there, which rises to the north.
#[test]
fn tiles_of_mercator_are_read_in_degrees() {
    let mut slope = String::new();
    for i in 0..21 {
        for j in 0..21 {
            let (x, y) = (7.0 + f64::from(i) * 0.05, 46.0 + f64::from(j) * 0.05);
            slope += &format!("{x:.2} {y:.2} {}\n", 100.0 * (y - 46.0));
        }
    }
    let folder = folder_with(&[("ridge.xyz", &slope)]);
    let how = [
        "--tiling",
        "mercator",
        "--max-level",
        "8",
        "--max-error",
        "2",
        "--fill",
        "0",
    ];
    let words = [
        RIDGE,
        &how,
        &["--vertical-offset", "0", "--max-edge", "none"],
    ]
    .concat();
    run_in(&folder, &words).works(&["level 8"]);
    let tiles = folder.path().join("tiles");
    let layer: Value =
        serde_json::from_slice(&std::fs::read(tiles.join("layer.json")).unwrap()).unwrap();
    assert_eq!(layer["projection"], "EPSG:3857");
    let bounds: Vec<f64> = serde_json::from_value(layer["bounds"].clone()).unwrap();
    assert!(
        bounds
            .iter()
            .zip([7.0, 46.0, 8.0, 47.0])
            .all(|(a, b)| (a - b).abs() < 1e-9)
    );
    let mut judged = 0;
    for name in files(&tiles).iter().filter(|name| name.starts_with("8/")) {
        let numbers: Vec<&str> = name.trim_end_matches(".terrain").split('/').collect();
        let [column, row] = [1, 2].map(|k| numbers[k].parse::<f64>().unwrap());
        let latitude = |row: f64| {
            let y = std::f64::consts::PI * (2.0 * row / 256.0 - 1.0);
            (2.0 * y.exp().atan() - std::f64::consts::FRAC_PI_2).to_degrees()
        };
        let [south, north] = [row, row + 1.0].map(latitude);
        let tile = tile(&tiles.join(name));
        for (number, [u, v, _]) in (0..).zip(&tile.vertices) {
            let x = (column + f64::from(*u) / 32_767.0) * 360.0 / 256.0 - 180.0;
            let y = south + f64::from(*v) / 32_767.0 * (north - south);
            if (7.0..=8.0).contains(&x) && (46.0..=47.0).contains(&y) {
                let off = (tile.height(number) - 100.0 * (y - 46.0)).abs();
                assert!(off < 0.1, "{name} {x} {y} {off}");
                judged += 1;
            }
        }
    }
    assert!(judged > 2, "{judged}");
}

#[test]
fn the_bytes_do_not_depend_on_the_order_of_points_or_on_threads() {
    let text = ridge();
    let mut lines: Vec<&str> = text.lines().collect();
    lines.reverse();
    let folder = folder_with(&[("ridge.xyz", &text), ("back.xyz", &lines.join("\n"))]);
    let mut written = Vec::new();
    for (name, threads) in [("ridge.xyz", "1"), ("back.xyz", "3")] {
        let words = [
            "terrain-tiles",
            name,
            "--a-srs",
            "EPSG:4326",
            "-o",
            "tiles",
            "--overwrite",
            "--max-level",
            "14",
            "--threads",
            threads,
        ];
        run_in(&folder, &words).works(&[]);
        let tiles = folder.path().join("tiles");
        let names = files(&tiles);
        let bytes: Vec<Vec<u8>> = names
            .iter()
            .map(|name| std::fs::read(tiles.join(name)).unwrap())
            .collect();
        written.push((names, bytes));
    }
    assert!(written[0] == written[1]);
}

/// A lake with an island and a narrow finger of land without points, and a river beside it, on the
/// ridge.
const WATER: [(&str, &str); 2] = [
    (
        "lake.geojson",
        r#"{"type":"Polygon","coordinates":[
            [[7.002,46.002,405],[7.007,46.002,405],[7.007,46.006,405],
            [7.0044,46.006,405],[7.0044,46.0057,405],[7.0044,46.0053,405],[7.0044,46.005,405],
            [7.0041,46.005,405],[7.0041,46.0052,405],[7.0041,46.0056,405],[7.0041,46.006,405],[7.002,46.006,405],[7.002,46.002,405]],
            [[7.0037,46.0032,405],[7.0037,46.0047,405],[7.0052,46.0047,405],[7.0052,46.0032,405],[7.0037,46.0032,405]]]}"#,
    ),
    (
        "river.geojson",
        r#"{"type":"MultiLineString","coordinates":[
            [[7.0021,46.0071,430],[7.0091,46.0072,420]],[[7.0021,46.0081,430],[7.0091,46.0082,420]]]}"#,
    ),
];

/// Returns true if the water of [`WATER`] is at a position.
fn is_water([x, y]: [f64; 2]) -> bool {
    let is_in = |x0: f64, y0: f64, x1: f64, y1: f64| (x0..x1).contains(&x) && (y0..y1).contains(&y);
    let island = is_in(7.0037, 46.0032, 7.0052, 46.0047);
    let finger = is_in(7.0041, 46.005, 7.0044, 46.006);
    let lake = is_in(7.002, 46.002, 7.007, 46.006) && !island && !finger;
    let bank = 46.0071 + (x - 7.0021) / 0.007 * 0.0001;
    lake || (is_in(7.0021, 46.0, 7.0091, 47.0) && (bank..bank + 0.001).contains(&y))
}

#[test]
fn tiles_say_where_water_is() {
    let lines: Vec<(&str, &str)> = WATER.to_vec();
    let ridge = ridge();
    let folder = folder_with(&[&lines[..], &[("ridge.xyz", &ridge[..])]].concat());
    let water = [
        "--flat",
        "lake.geojson",
        "--rivers",
        "river.geojson",
        "--max-level",
        "16",
        "--vertical-offset",
        "0",
        "--tiling",
    ];
    for (name, tiling) in [
        ("geographic", Tiling::Geographic),
        ("mercator", Tiling::WebMercator),
    ] {
        run_in(
            &folder,
            &[RIDGE, &["--overwrite"], &water, &[name]].concat(),
        )
        .works(&[]);
        let tiles = folder.path().join("tiles");
        let layer = std::fs::read_to_string(tiles.join("layer.json")).unwrap();
        assert!(layer.contains("watermask"), "{layer}");
        let mut cells_of_water = 0;
        for path in files(&tiles)
            .iter()
            .filter(|path| path.ends_with(".terrain"))
        {
            let numbers: Vec<u32> = path
                .trim_end_matches(".terrain")
                .split('/')
                .map(|number| number.parse().unwrap())
                .collect();
            let at = TilePosition {
                level: numbers[0] as u8,
                column: numbers[1],
                row: numbers[2],
            };
            let [[west, south], [east, north]] = tiling.bounds(at);
            let side = WaterMask::SIDE;
            let mask = tile(&tiles.join(path)).water.unwrap();
            for cell in 0..side * side {
                let along = |n: usize| (n as f64 + 0.5) / side as f64;
                let x = west + (east - west) * along(cell % side);
                let y = north - (north - south) * along(cell / side);
                let found = match &mask {
                    WaterMask::Land => false,
                    WaterMask::Water => true,
                    WaterMask::Cells(cells) => cells[cell],
                };
                cells_of_water += usize::from(found);
                // Whatever the rounding of the lines between.
                let around = [-1e-9, 1e-9].map(|by| is_water([x + by, y + by]));
                if around[0] == around[1] {
                    assert_eq!(found, around[0], "{path} {x} {y}");
                }
            }
        }
        assert!(cells_of_water > 10_000, "{cells_of_water}");
    }
}
