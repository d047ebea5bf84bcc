//! Damaged files, through the program, in bounded time and memory. What becomes of each of them is
//! in the tables of `tests/points.rs`, `tests/rasters/` and `tests/layers/`; here it is that
//! nothing worse can happen.

use std::path::{Path, PathBuf};
use std::time::Duration;

use assert_cmd::Command;

use crate::{folder, program};
use testkit::shared;

/// Address space that a run may have, in kilobytes, and how long it may take.
const MEMORY: &str = "1000000";
const TIME: Duration = Duration::from_secs(5);

/// Files of a folder of the shared data with one of these extensions.
fn files(folder: &str, extensions: &[&str]) -> Vec<PathBuf> {
    let paths = std::fs::read_dir(shared(folder))
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = paths
        .filter(|path| {
            path.extension()
                .is_some_and(|e| extensions.contains(&e.to_str().unwrap()))
        })
        .collect();
    files.sort();
    assert!(!files.is_empty());
    files
}

/// Runs a verb on a damaged file, `FILE` in the arguments; its exit code.
#[track_caller]
fn survive(file: &Path, args: &[&str]) -> i32 {
    let name = file.to_str().unwrap();
    let work = folder();
    let args: Vec<&str> = args
        .iter()
        .map(|arg| if *arg == "FILE" { name } else { arg })
        .collect();
    let output = Command::new("sh")
        .current_dir(work.path())
        .args(["-c", "ulimit -v \"$0\" && exec \"$@\"", MEMORY])
        .arg(program())
        .args(&args)
        .timeout(TIME)
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    // None if it was killed: by the clock, or for memory that it could not get.
    let code = output
        .status
        .code()
        .unwrap_or_else(|| panic!("{name}: killed ({})\n{said}", output.status));
    assert!(code == 0 || code == 1, "{name}: exit code {code}\n{said}");
    assert!(!said.contains("panicked"), "{name}:\n{said}");
    let left: Vec<_> = std::fs::read_dir(work.path())
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    if code == 1 {
        let error = said
            .lines()
            .find(|line| line.starts_with("error: "))
            .unwrap_or_else(|| panic!("{name}: {said}"));
        // A boundary that is somewhere else is no fault of one file.
        assert!(
            error.contains(name) || error.contains("no triangle is left"),
            "the file is not named: {error}"
        );
        assert!(
            said.lines().any(|line| line.starts_with("hint: ")),
            "{name}: no hint\n{said}"
        );
        assert!(left.is_empty(), "{name}: {left:?} is left after\n{said}");
    } else {
        assert!(!left.is_empty(), "{name}: nothing is written\n{said}");
    }
    code
}

/// How many runs ended well and how many in an error: neither is all of them.
#[track_caller]
fn survive_all(files: &[PathBuf], args: &[&str]) {
    let failed: i32 = files.iter().map(|file| survive(file, args)).sum();
    assert!(
        0 < failed && (failed as usize) < files.len(),
        "{failed} of {}",
        files.len()
    );
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn lidar() {
    survive_all(
        &files("lidar/broken", &["las", "laz"]),
        &["tin", "FILE", "-o", "t.ply"],
    );
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn rasters() {
    let files = files("dem/broken", &["tif"]);
    survive_all(
        &files,
        &["contour", "FILE", "-o", "c.shp", "-o", "c.geojson"],
    );
    survive_all(&files, &["hillshade", "FILE", "-o", "h.png", "-o", "h.tif"]);
}

#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn breaklines() {
    let points = shared("shp/shapelib_eg/masspntz.shp");
    let mut files = files("shp/broken", &["shp"]);
    files.extend(self::files("shp/broken_mut", &["shp"]));
    let points = points.to_str().unwrap();
    survive_all(
        &files,
        &["tin", points, "--breaklines", "FILE", "-o", "t.ply"],
    );
    for file in &files {
        survive(file, &["tin", points, "--boundary", "FILE", "-o", "t.ply"]);
    }
}
