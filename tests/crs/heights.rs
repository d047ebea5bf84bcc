//! Heights by grids, which are looked for in the folders of the environment: the program is run.

use std::path::Path;
use std::process::Command;

use breakline::io::quantized_mesh::decode;
use serde_json::Value;
use tempfile::TempDir;

/// The geoid EGM96 under the name that PROJ's database has for its old format.
const EGM96: &str = "egm96_15.gtx";

/// Where Debian's `proj-data` puts it.
const INSTALLED: &str = "/usr/share/proj";

struct Ran {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

impl Ran {
    fn json(&self) -> Value {
        assert_eq!(self.code, Some(0), "{}", self.stderr);
        serde_json::from_str(&self.stdout).unwrap_or_else(|e| panic!("{e}: {}", self.stdout))
    }
}

/// Runs the program in a folder, with grids of another folder and no others.
fn run(folder: &Path, grids: &Path, args: &[&str]) -> Ran {
    let output = Command::new(env!("CARGO_BIN_EXE_breakline"))
        .current_dir(folder)
        .args(args)
        .env("PROJ_DATA", grids)
        .env("PROJ_SKIP_READ_USER_WRITABLE_DIRECTORY", "YES")
        .env_remove("PROJ_NETWORK")
        .output()
        .unwrap();
    Ran {
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// From heights above EGM96 to heights above the ellipsoid.
const UP: [&str; 2] = ["EPSG:4326+5773", "EPSG:4979"];
/// From heights above the ellipsoid to heights above EGM96.
const DOWN: [&str; 2] = ["EPSG:4979", "EPSG:4326+5773"];

const REQUIRED: &[&str] = &["--require-grids"];

/// Transforms a point from one system to another with these options.
fn transform(folders: [&Path; 2], [from, to]: [&str; 2], at: &[f64], options: &[&str]) -> Ran {
    let [folder, grids] = folders;
    let numbers: Vec<String> = at.iter().map(f64::to_string).collect();
    let mut args = vec!["crs", from, to, "--json"];
    args.extend(options);
    args.push("--at");
    args.extend(numbers.iter().map(String::as_str));
    run(folder, grids, &args)
}

/// A geoid that is a plane in longitude and latitude, so that it is the same between its nodes.
fn geoid(longitude: f64, latitude: f64) -> f64 {
    latitude / 4.0 - longitude / 8.0 + 3.0
}

/// Writes that geoid for the whole earth, in the format GTX.
fn write_geoid(folder: &Path) {
    const STEP: f64 = 15.0;
    let (rows, columns) = (13, 25);
    let mut bytes = Vec::new();
    for number in [-90.0, -180.0, STEP, STEP] {
        bytes.extend_from_slice(&f64::to_be_bytes(number));
    }
    for count in [rows, columns] {
        bytes.extend_from_slice(&i32::to_be_bytes(count));
    }
    for row in 0..rows {
        for column in 0..columns {
            let [x, y] = [column, row].map(|i| f64::from(i) * STEP);
            bytes.extend_from_slice(&f32::to_be_bytes(geoid(x - 180.0, y - 90.0) as f32));
        }
    }
    std::fs::write(folder.join(EGM96), bytes).unwrap();
}

fn folders() -> (TempDir, TempDir) {
    (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap())
}

fn moved(ran: &Ran) -> [f64; 3] {
    let found = ran.json();
    [0, 1, 2].map(|k| found["point"]["to"][k].as_f64().unwrap())
}

#[test]
fn heights_are_transformed_by_a_grid_that_is_installed() {
    let (folder, grids) = folders();
    write_geoid(grids.path());
    for [x, y] in [[15.5, 47.0], [-70.25, -33.0], [179.0, 5.125]] {
        let at = [x, y, 300.0];
        let transform = |systems| transform([folder.path(), grids.path()], systems, &at, REQUIRED);
        let up = transform(UP);
        let [u, v, height] = moved(&up);
        assert!(
            (height - 300.0 - geoid(x, y)).abs() < 1e-3,
            "{height} at {x} {y}"
        );
        assert!((u - x).abs() < 1e-9 && (v - y).abs() < 1e-9);
        assert_eq!(up.json()["heights_are_transformed"], true);
        let down = transform(DOWN);
        assert!((moved(&down)[2] - 300.0 + geoid(x, y)).abs() < 1e-3);
        // A system in plan, with heights above its ellipsoid.
        let raised = transform(["EPSG:4326+ellipsoid", "EPSG:4326+5773"]);
        assert_eq!(moved(&raised), moved(&down));
    }
}

#[test]
fn heights_are_transformed_with_the_plan_and_from_the_center_of_the_earth() {
    let (folder, grids) = folders();
    write_geoid(grids.path());
    let transform =
        |systems, at: &[f64]| transform([folder.path(), grids.path()], systems, at, &[]);
    let [x, y, z] = moved(&transform(
        ["EPSG:32633+5773", "EPSG:4979"],
        &[538_012.754_99, 5_205_285.415_38, 100.0],
    ));
    assert!(
        (x - 15.5).abs() < 1e-9 && (y - 47.0).abs() < 1e-9,
        "{x} {y}"
    );
    assert!((z - 100.0 - geoid(15.5, 47.0)).abs() < 1e-3);
    let [.., z] = moved(&transform(
        ["EPSG:4978", "EPSG:32633+5773"],
        &[4_194_423.0, 1_162_702.0, 4_647_245.0],
    ));
    let wanted = 537.325_021_646_9 - geoid(15.493_474_331_5, 47.067_133_849);
    assert!((z - wanted).abs() < 1e-3, "{z} instead of {wanted}");
    // A point without a height has none afterwards.
    let systems = ["EPSG:32633+5773", "EPSG:4979"];
    let found = transform(systems, &[500_000.0, 5_200_000.0]).json();
    assert!(found["point"]["to"][2].is_null());
}

#[test]
fn a_missing_grid_is_named_and_heights_stay_or_it_is_an_error() {
    let (folder, grids) = folders();
    let at = [15.5, 47.0, 300.0];
    let transform = |options: &[&str]| transform([folder.path(), grids.path()], UP, &at, options);
    let kept = transform(&[]);
    assert_eq!(moved(&kept), [15.5, 47.0, 300.0]);
    let found = kept.json();
    assert_eq!(found["heights_are_transformed"], false);
    let listed = found["operations"].as_array().unwrap();
    let states: Vec<&str> = listed
        .iter()
        .flat_map(|one| one["grids"].as_array().unwrap())
        .map(|grid| grid["state"].as_str().unwrap())
        .collect();
    assert!(states.contains(&"missing"), "{found:#}");
    for part in [
        "heights keep their datum",
        "us_nga_egm",
        "not installed",
        "PROJ_DATA",
    ] {
        assert!(kept.stderr.contains(part), "{part}: {}", kept.stderr);
    }
    let refused = transform(REQUIRED);
    assert_eq!(refused.code, Some(1), "{}", refused.stderr);
    for part in [
        "error: heights cannot be transformed",
        "us_nga_egm",
        "hint: put https://",
    ] {
        assert!(refused.stderr.contains(part), "{part}: {}", refused.stderr);
    }
}

/// Returns the lowest and the highest height of a tile of the finest level.
fn range_of_tile(tiles: &Path) -> [f64; 2] {
    let folder = |at: &Path| {
        std::fs::read_dir(at)
            .unwrap()
            .next()
            .unwrap()
            .unwrap()
            .path()
    };
    let bytes = std::fs::read(folder(&folder(&tiles.join("12")))).unwrap();
    let tile = decode(&bytes).unwrap();
    let heights = (0..tile.vertices.len() as u32).map(|v| tile.height(v));
    heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| {
        [low.min(z), high.max(z)]
    })
}

#[test]
fn terrain_tiles_have_heights_above_the_ellipsoid_by_a_grid() {
    let (folder, grids) = folders();
    let level = "15 47 300\n15.001 47 300\n15.001 47.001 300\n15 47.001 300\n";
    std::fs::write(folder.path().join("level.xyz"), level).unwrap();
    let tiles = folder.path().join("tiles");
    let make = |options: &[&str]| {
        let words = "terrain-tiles level.xyz --max-edge none --force-degrees --max-level 12 \
            --no-gzip --overwrite -o tiles";
        let args: Vec<&str> = words
            .split_whitespace()
            .chain(options.iter().copied())
            .collect();
        run(folder.path(), grids.path(), &args)
    };
    let expect = |ran: &Ran, height: f64, has_warning: bool| {
        assert_eq!(ran.code, Some(0), "{}", ran.stderr);
        let warnings = [
            "heights keep their datum",
            "they are used as heights above the ellipsoid",
        ];
        let is_warned = warnings.iter().any(|text| ran.stderr.contains(text));
        assert_eq!(is_warned, has_warning, "{}", ran.stderr);
        let [low, high] = range_of_tile(&tiles);
        // Steps of heights are a meter or two.
        assert!(low > height - 2.5 && high < height + 2.5, "{low} {high}");
    };
    let system = &["--a-srs", "EPSG:4326+5773"];
    let missing = make(system);
    expect(&missing, 300.0, true);
    assert!(missing.stderr.contains("us_nga_egm"), "{}", missing.stderr);
    let refused = make(&[&system[..], REQUIRED].concat());
    assert_eq!(refused.code, Some(1), "{}", refused.stderr);
    write_geoid(grids.path());
    let raised = 300.0 + geoid(15.0, 47.0);
    expect(&make(system), raised, false);
    expect(&make(&[&system[..], REQUIRED].concat()), raised, false);
    // An offset is taken instead.
    expect(
        &make(&[&system[..], &["--vertical-offset", "7"]].concat()),
        307.0,
        false,
    );
    expect(&make(&["--a-srs", "EPSG:4979"]), 300.0, false);
    expect(&make(&["--a-srs", "EPSG:4326"]), 300.0, true);
}

#[test]
fn what_is_not_a_grid_is_not_used() {
    let (folder, grids) = folders();
    std::fs::write(grids.path().join(EGM96), "not a grid").unwrap();
    let at = [15.5, 47.0, 300.0];
    let transform = |options: &[&str]| transform([folder.path(), grids.path()], UP, &at, options);
    let kept = transform(&[]);
    assert_eq!(moved(&kept), [15.5, 47.0, 300.0]);
    assert!(
        kept.stderr.contains("heights keep their datum"),
        "{}",
        kept.stderr
    );
    let refused = transform(REQUIRED);
    assert_eq!(refused.code, Some(1), "{}", refused.stderr);
}

#[test]
fn an_old_database_beside_the_grids_is_not_used() {
    let (folder, grids) = folders();
    write_geoid(grids.path());
    std::fs::write(grids.path().join("proj.db"), "not a database").unwrap();
    let at = [15.5, 47.0, 300.0];
    let [.., height] = moved(&transform([folder.path(), grids.path()], UP, &at, &[]));
    assert!(
        (height - 300.0 - geoid(15.5, 47.0)).abs() < 1e-3,
        "{height}"
    );
}

#[test]
fn a_plan_that_needs_a_grid_is_an_error_where_grids_are_required() {
    let (folder, grids) = folders();
    let args = ["crs", "EPSG:4326", "EPSG:27700", "--at", "-1.5", "52.5"];
    let coarse = run(folder.path(), grids.path(), &args);
    assert_eq!(coarse.code, Some(0), "{}", coarse.stderr);
    for part in ["accurate to", "uk_os_OSTN15", "not installed"] {
        assert!(coarse.stderr.contains(part), "{part}: {}", coarse.stderr);
    }
    let refused = run(
        folder.path(),
        grids.path(),
        &[&args[..], &["--require-grids"]].concat(),
    );
    assert_eq!(
        refused.code,
        Some(1),
        "{}{}",
        refused.stdout,
        refused.stderr
    );
    assert!(
        refused.stderr.contains("uk_os_OSTN15"),
        "{}",
        refused.stderr
    );
}

#[test]
fn files_are_reprojected_with_their_heights_in_one_piece_and_in_tiles() {
    let (folder, grids) = folders();
    write_geoid(grids.path());
    let run = |args: &[&str]| {
        let ran = run(folder.path(), grids.path(), args);
        assert_eq!(ran.code, Some(0), "{}", ran.stderr);
        assert!(!ran.stderr.contains("heights keep"), "{}", ran.stderr);
    };
    let mut text = String::new();
    for i in 0..20 {
        for j in 0..20 {
            text += &format!(
                "{} {} {}\n",
                500_000 + 7 * i + j,
                5_200_000 + 7 * j - i,
                100 + i
            );
        }
    }
    std::fs::write(folder.path().join("a.xyz"), text).unwrap();
    let systems = [
        "--a-srs",
        "EPSG:32633+ellipsoid",
        "--t-srs",
        "EPSG:32633+5773",
        "--require-grids",
    ];
    run(&[&["points", "a.xyz", "-o", "p.xyz"], &systems[..]].concat());
    let read = |name: &str| -> Vec<[f64; 3]> {
        let text = std::fs::read_to_string(folder.path().join(name)).unwrap();
        text.lines()
            .map(|line| {
                let mut numbers = line
                    .split([' ', ',', '\t'])
                    .map(|word| word.parse().unwrap());
                [(); 3].map(|()| numbers.next().unwrap())
            })
            .collect()
    };
    for (before, after) in read("a.xyz").iter().zip(read("p.xyz")) {
        // Within 200 m of longitude 15 and latitude 46.95 the geoid is as flat as a plane.
        let moved = before[2] - after[2];
        assert!(
            (moved - geoid(15.0, 46.954)).abs() < 0.01,
            "{before:?} {after:?}"
        );
        assert!((before[0] - after[0]).abs() < 1e-3);
    }
    let dem = ["dem", "a.xyz", "--max-edge", "none", "--resolution", "5"];
    run(&[&dem[..], &["-o", "one.tif"], &systems[..]].concat());
    run(&[
        &dem[..],
        &["--tiles", "2x2", "-o", "tiles.tif"],
        &systems[..],
    ]
    .concat());
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert_eq!(bytes("one.tif"), bytes("tiles.tif"));
}

/// Heights of EGM96 by its full harmonic expansion, as NGA publishes them with its program F477; a
/// grid of a quarter of a degree is off by some centimeters between its nodes.
#[test]
fn egm96_is_what_nga_has_published() {
    if !Path::new(INSTALLED).join(EGM96).exists() {
        eprintln!("skipped: {INSTALLED}/{EGM96} is not installed");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    for (latitude, longitude, wanted) in [
        (38.628_155_0, -90.220_845_0, -31.628),
        (-14.621_217_0, -54.978_886_0, -2.969),
        (46.874_319_0, 102.448_729_0, -43.575),
        (-23.617_446_0, 133.874_712_0, 15.871),
        (38.625_473_0, -0.000_500_0, 50.066),
        (-0.466_744_0, 0.002_300_0, 17.329),
    ] {
        let at = [longitude, latitude, 0.0];
        let folders = [folder.path(), Path::new(INSTALLED)];
        let [.., height] = moved(&transform(folders, UP, &at, REQUIRED));
        assert!(
            (height - wanted).abs() < 0.1,
            "{height} instead of {wanted} at {at:?}"
        );
    }
}

/// A geoid in the format GTX, with a naive reader.
struct Gtx {
    bytes: Vec<u8>,
}

impl Gtx {
    fn number(&self, i: usize) -> f64 {
        f64::from_be_bytes(self.bytes[8 * i..8 * i + 8].try_into().unwrap())
    }

    fn columns(&self) -> usize {
        i32::from_be_bytes(self.bytes[36..40].try_into().unwrap()) as usize
    }

    fn node(&self, row: usize, column: usize) -> f64 {
        let at = 40 + 4 * (row * self.columns() + column % self.columns());
        f64::from(f32::from_be_bytes(
            self.bytes[at..at + 4].try_into().unwrap(),
        ))
    }

    fn height(&self, longitude: f64, latitude: f64) -> f64 {
        let [south, west, step_y, step_x] = [0, 1, 2, 3].map(|i| self.number(i));
        let x = (longitude - west).rem_euclid(360.0) / step_x;
        let y = (latitude - south) / step_y;
        let (column, row) = (x.floor() as usize, y.floor() as usize);
        let (s, t) = (x.fract(), y.fract());
        (1.0 - t) * ((1.0 - s) * self.node(row, column) + s * self.node(row, column + 1))
            + t * ((1.0 - s) * self.node(row + 1, column) + s * self.node(row + 1, column + 1))
    }
}

#[test]
fn egm96_is_interpolated_between_the_nodes_of_the_grid() {
    let Ok(bytes) = std::fs::read(Path::new(INSTALLED).join(EGM96)) else {
        eprintln!("skipped: {INSTALLED}/{EGM96} is not installed");
        return;
    };
    let grid = Gtx { bytes };
    let folder = tempfile::tempdir().unwrap();
    for [x, y] in [
        [15.5, 47.0],
        [-70.25, -33.1],
        [139.7, 35.6],
        [-100.3, 40.05],
        [2.3, 48.85],
    ] {
        let at = [x, y, 250.0];
        let folders = [folder.path(), Path::new(INSTALLED)];
        let [.., height] = moved(&transform(folders, UP, &at, &[]));
        let wanted = 250.0 + grid.height(x, y);
        assert!(
            (height - wanted).abs() < 1e-3,
            "{height} instead of {wanted} at {at:?}"
        );
    }
}
