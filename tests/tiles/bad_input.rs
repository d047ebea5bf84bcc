//! A file that is damaged, or lies about its extent, among others.

use breakline::io::geotiff;
use tempfile::TempDir;

use super::{bytes, landscape, output_of, program};
use program::{files_of, run_in};
use testkit::lidar;

/// A landscape in 4 by 4 files, of which one is cut off.
fn folder_with_a_bad_file() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    landscape::write(&folder.path().join("in"), 16_000, 4).unwrap();
    let path = folder.path().join("in/002_001.laz");
    let whole = bytes(&path);
    std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    folder
}

#[test]
fn a_bad_file_is_named() {
    let folder = folder_with_a_bad_file();
    let words = ["dem", "in/*.laz", "--tiles", "auto", "-o", "dem.tif"];
    run_in(&folder, &words).fails(1, &["error: in/002_001.laz: byte"]);
    assert_eq!(files_of(folder.path()), ["in"]);
}

#[test]
fn a_bad_file_may_leave_a_hole() {
    let folder = folder_with_a_bad_file();
    let (_, said) = output_of(&folder, "dem in/*.laz --tiles auto --skip-bad", "tiled.tif");
    assert!(said.contains("skipped: in/002_001.laz: byte") && said.contains("tiles       15 (the files)"), "{said}");
    std::fs::remove_file(folder.path().join("in/002_001.laz")).unwrap();
    let (tiled, _) = output_of(&folder, "dem in/*.laz --tiles 3x5", "others.tif");
    assert!(tiled == bytes(folder.path().join("tiled.tif")));
}

/// Also a file whose points are damaged: coordinates that leave the extent are how that shows.
#[test]
fn a_header_that_lies_is_an_error_that_names_tile_and_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut names = Vec::new();
    for i in 0..9 {
        let name = format!("{i}.las");
        let corner = [f64::from(i % 3) * 10.0, f64::from(i / 3) * 10.0];
        std::fs::write(folder.path().join(&name), lidar::las(&lidar::tile(corner, 2), Some(25832))).unwrap();
        names.push(name);
    }
    let files = names.join(" ");
    let (whole, _) = output_of(&folder, &format!("dem {files}"), "whole.tif");
    // The largest x of the file at 10 0, which is 13 in truth.
    let good = bytes(folder.path().join("1.las"));
    let mut lying = good.clone();
    lying[179..187].copy_from_slice(&12.5f64.to_le_bytes());
    std::fs::write(folder.path().join("1.las"), lying).unwrap();
    let said = "there is a point at 13 0, but the header states an extent from 10 0 to 12.5 3";
    for (tiles, location, kept) in [("auto", "1.las: tile 1: ", 8), ("2x1", "1.las: ", 8)] {
        let words = format!("dem {files} --tiles {tiles} -o dem.tif --job {tiles} --threads 1");
        let words: Vec<&str> = words.split(' ').collect();
        run_in(&folder, &words).fails(1, &[&format!("error: {location}{said}"), "are kept", "go on with --resume"]);
        assert!(!folder.path().join("dem.tif").exists());
        let tasks = files_of(&folder.path().join(tiles).join("tasks"));
        assert!(tasks.len() < kept && tasks.iter().all(|name| name.ends_with(".task")), "{tasks:?}");

        let words = format!("dem {files} --tiles {tiles} --job {tiles} --resume --skip-bad");
        let (_, said_then) = output_of(&folder, &words, "hole.tif");
        assert!(said_then.contains(&format!("skipped: 1.las: {said}")), "{said_then}");
        // No triangle spans the file that is missing; around it all is there.
        assert!(said_then.contains("left out over skipped files"), "{said_then}");
        let grid = geotiff::open(folder.path().join("hole.tif")).unwrap().read_grid().unwrap();
        let height = |x: f64, y: f64| {
            let [column, row] = grid.frame.inverse().apply(x, y);
            grid.values[row as usize * grid.frame.width + column as usize]
        };
        assert!(height(11.5, 1.5).is_nan() && !height(1.5, 1.5).is_nan() && !height(11.5, 11.5).is_nan());
    }
    // A file with another extent is not the one that was planned with.
    std::fs::remove_dir_all(folder.path().join("auto")).unwrap();
    std::fs::write(folder.path().join("1.las"), good).unwrap();
    let (tiled, _) = output_of(&folder, &format!("dem {files} --tiles auto"), "dem.tif");
    assert!(tiled == whole);
}

/// Files that touch are usual: the hole is that of the one that is missing.
#[test]
fn a_file_that_touches_others_leaves_a_hole() {
    let folder = tempfile::tempdir().unwrap();
    for i in 0..3 {
        let corner = [f64::from(i) * 3.0, 0.0];
        let points = lidar::las(&lidar::tile(corner, 2), Some(25832));
        std::fs::write(folder.path().join(format!("{i}.las")), points).unwrap();
    }
    // The largest y of the file in the middle, which is 3 in truth.
    let path = folder.path().join("1.las");
    let mut lying = bytes(&path);
    lying[195..203].copy_from_slice(&2.5f64.to_le_bytes());
    std::fs::write(&path, lying).unwrap();
    for tiles in ["auto", "3x1", "2x2"] {
        let (_, said) = output_of(&folder, &format!("dem 0.las 1.las 2.las --tiles {tiles} --skip-bad"), "hole.tif");
        let grid = geotiff::open(folder.path().join("hole.tif")).unwrap().read_grid().unwrap();
        let [column, row] = grid.frame.inverse().apply(4.5, 1.5);
        assert!(grid.values[row as usize * grid.frame.width + column as usize].is_nan(), "{tiles}: {said}");
    }
}

/// A file that was damaged, and was replaced by the good one, is taken as it is now; finished tasks
/// are not done again. One that tasks have read may not change.
#[test]
fn a_file_that_was_repaired_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let mut names = Vec::new();
    for i in 0..4 {
        let name = format!("{i}.las");
        let corner = [f64::from(i % 2) * 10.0, f64::from(i / 2) * 10.0];
        std::fs::write(folder.path().join(&name), lidar::las(&lidar::tile(corner, 2), Some(25832))).unwrap();
        names.push(name);
    }
    let files = names.join(" ");
    let (whole, _) = output_of(&folder, &format!("dem {files}"), "whole.tif");
    let path = folder.path().join("3.las");
    let good = bytes(&path);
    // The x of the last point, far outside.
    let mut damaged = good.clone();
    let record = good.len() - lidar_record(&good);
    damaged[record..record + 4].copy_from_slice(&i32::MAX.to_le_bytes());
    std::fs::write(&path, &damaged).unwrap();
    let words = format!("dem {files} --tiles auto -o dem.tif --threads 1");
    let run = |words: &str| run_in(&folder, &words.split(' ').collect::<Vec<_>>());
    run(&words).fails(1, &["3.las: tile 3", "there is a point at"]);
    let tasks = folder.path().join("dem.tif.job/tasks");
    let times = || -> Vec<_> {
        files_of(&tasks).iter().map(|name| tasks.join(name).metadata().unwrap().modified().unwrap()).collect()
    };
    let before = times();
    std::fs::write(&path, &good).unwrap();
    let (tiled, said) =
        output_of(&folder, &format!("{words} --resume").replace(" -o dem.tif", " --job dem.tif.job"), "dem.tif");
    assert!(tiled == whole && said.contains("resumed"), "{said}");
    assert!(times()[..before.len()] == before[..]);
    // Once it is read, it must stay.
    std::fs::write(&path, &damaged).unwrap();
    run(&format!("{words} --resume --overwrite")).fails(2, &["3.las", "has changed since the job was planned"]);
}

/// The length of a point's record.
fn lidar_record(file: &[u8]) -> usize {
    usize::from(u16::from_le_bytes([file[105], file[106]]))
}
