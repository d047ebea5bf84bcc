//! Outputs by the drivers of GDAL, and inputs that only it can open, judged by GDAL's own programs.
#![cfg(feature = "gdal")]

#[path = "../common/program.rs"]
mod program;

mod conditions;
mod damaged;
mod layers;
mod names;
mod options;
mod rasters;
mod tiles;

use std::process::Command;

use program::{Run, folder_with, run_in};
use serde_json::Value;
use tempfile::TempDir;

/// A surface over 6 x 5 cells of 1 that is not symmetric in any way, with a cut corner, in UTM.
fn surface() -> TempDir {
    let mut points = String::new();
    for row in 0..6 {
        for column in 0..7 {
            // The corner is cut off.
            if row + column < 10 {
                let height = 100.0 + 3.25 * f64::from(column) - 1.5 * f64::from(row * row);
                let [x, y] = [500_000 + column, 5_300_000 + row];
                points.push_str(&format!("{x} {y} {height}\n"));
            }
        }
    }
    folder_with(&[("points.xyz", &points)])
}

/// The options that every raster and every layer of [`surface`] has.
const OF_SURFACE: &[&str] = &["points.xyz", "--a-srs", "EPSG:25832"];

/// Runs a verb on [`surface`].
fn run_verb(folder: &TempDir, verb: &[&str], options: &[&str]) -> Run {
    run_in(folder, &[verb, OF_SURFACE, options].concat())
}

/// What a program of GDAL prints about a file.
#[track_caller]
fn printed(folder: &TempDir, program: &str, args: &[&str]) -> String {
    let output = Command::new(program)
        .current_dir(folder.path())
        .args(args)
        .output()
        .unwrap_or_else(|error| panic!("{program} (apt-get install gdal-bin): {error}"));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{program} {args:?}: {text}{said}");
    text
}

/// What `gdalinfo` finds in a raster.
#[track_caller]
fn gdalinfo(folder: &TempDir, name: &str) -> Value {
    serde_json::from_str(&printed(folder, "gdalinfo", &["-json", "-stats", name])).unwrap()
}
