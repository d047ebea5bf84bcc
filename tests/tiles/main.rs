//! Surfaces in tiles: the bytes of the surface in one piece, whatever the tiles, whatever happens
//! to the job in between.

#[path = "../common/program.rs"]
mod program;

#[path = "../../examples/landscape/mod.rs"]
mod landscape;

mod bad_input;
mod counts;
mod damage;
mod equality;
mod interruption;
mod judge;
mod notices;
mod opened;
mod parts;
mod real;
mod removal;
mod reprojection;
mod stored;
mod trust;
mod update;
mod workers;

use std::path::Path;

use program::{Run, run_in};
use tempfile::TempDir;

/// The valley of the fixtures.
fn valley() -> String {
    format!("{}/fixtures/valley.laz", env!("CARGO_MANIFEST_DIR"))
}

/// Runs the program in a folder.
fn run(folder: &TempDir, words: &str) -> Run {
    run_in(folder, &words.split_whitespace().collect::<Vec<_>>())
}

/// Plans the job `j`: heights of the valley in four tiles.
#[track_caller]
fn plan_valley(folder: &TempDir) {
    let words = format!("job plan j -- dem {} --tiles 2x2 -o dem.tif", valley());
    run(folder, &words).works(&[]);
}

/// Runs the program, which must succeed, and returns the bytes of the file `out` in the folder, and
/// what was printed.
#[track_caller]
fn output_of(folder: &TempDir, words: &str, out: &str) -> (Vec<u8>, String) {
    output_with(folder, words, out, 0)
}

/// Like [`output_of`], for a run that ends with this status.
#[track_caller]
fn output_with(folder: &TempDir, words: &str, out: &str, code: i32) -> (Vec<u8>, String) {
    let words: Vec<&str> = words
        .split_whitespace()
        .chain(["-o", out, "--overwrite"])
        .collect();
    let run = run_in(folder, &words);
    assert_eq!(run.code, code, "{words:?}: {}", run.stderr);
    (std::fs::read(folder.path().join(out)).unwrap(), run.stderr)
}

/// Fails unless heights of a surface are the same from a TIN and from its parts.
#[track_caller]
fn assert_parts_are_whole(folder: &TempDir, words: &str) {
    let [whole, parts] = ["whole.tin", "parts.tins"].map(|surface| {
        output_of(folder, &format!("tin {words}"), surface);
        output_of(folder, &format!("dem {surface}"), "dem.tif").0
    });
    assert!(whole == parts, "{words}");
}

/// The bytes of a file.
fn bytes(path: impl AsRef<Path>) -> Vec<u8> {
    std::fs::read(path).unwrap()
}

/// What the names of temporary files of a job contain.
fn mark_of(folder: &TempDir, job: &str) -> String {
    let plan = String::from_utf8(bytes(folder.path().join(job).join("plan.json"))).unwrap();
    let value: serde_json::Value = serde_json::from_str(plan.split_once('\n').unwrap().1).unwrap();
    format!("{:016x}", value["name"].as_u64().unwrap())
}

/// A layer of lines of one kind.
fn layer(lines: &[Vec<[f64; 3]>], kind: &str) -> String {
    let features: Vec<String> = lines
        .iter()
        .map(|line| {
            let points: Vec<String> = line.iter().map(|[x, y, z]| format!("[{x},{y},{z}]")).collect();
            let (open, close) = if kind == "Polygon" { ("[[", "]]") } else { ("[", "]") };
            let coordinates = format!("{open}{}{close}", points.join(","));
            format!(
                r#"{{"type":"Feature","properties":{{}},"geometry":{{"type":"{kind}","coordinates":{coordinates}}}}}"#
            )
        })
        .collect();
    format!(
        r#"{{"type":"FeatureCollection","crs":{{"type":"name","properties":{{"name":"urn:ogc:def:crs:EPSG::25832"}}}},"features":[{}]}}"#,
        features.join(",")
    )
}
