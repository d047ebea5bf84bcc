//! A file that is damaged, or lies about its extent, among others.

use breakline::io::geotiff;
use tempfile::TempDir;

use super::{bytes, landscape, output_of, output_with, program};
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

/// Returns the height of a raster in the folder at a position; NaN where it has none.
fn height(folder: &TempDir, name: &str, x: f64, y: f64) -> f64 {
    let grid = geotiff::open(folder.path().join(name))
        .unwrap()
        .read_grid()
        .unwrap();
    let [column, row] = grid.frame.inverse().apply(x, y);
    grid.values[row as usize * grid.frame.width + column as usize]
}

/// The header of a file that was cut off can be read. Once the file is repaired, the job goes on:
/// what was done of other files is kept.
#[test]
fn a_bad_file_may_leave_a_hole_until_it_is_repaired() {
    let folder = folder_with_a_bad_file();
    let path = folder.path().join("in/002_001.laz");
    let bad = bytes(&path);
    let whole = tempfile::tempdir().unwrap();
    landscape::write(&whole.path().join("in"), 16_000, 4).unwrap();
    let good = bytes(whole.path().join("in/002_001.laz"));
    std::fs::write(&path, &good).unwrap();
    let (expected, _) = output_of(&folder, "dem in/*.laz", "whole.tif");
    std::fs::write(&path, &bad).unwrap();
    for tiles in ["auto", "3x5"] {
        let words = format!("dem in/*.laz --tiles {tiles} --skip-bad");
        let (_, said) = output_with(&folder, &words, "tiled.tif", 3);
        let hole = "skipped: in/002_001.laz: byte";
        assert!(
            said.contains(hole) && said.contains("its extent is left empty, from "),
            "{said}"
        );
        assert!(said.contains(
            "note: the result has holes: 1 file skipped; finished tasks are kept in tiled.tif.job"
        ));
        let header = breakline::io::las::stated(&path).unwrap().bounds.unwrap();
        let [x, y] = [0, 1].map(|k| (header.min[k] + header.max[k]) / 2.0);
        assert!(
            height(&folder, "tiled.tif", x, y).is_nan()
                && !height(&folder, "whole.tif", x, y).is_nan(),
            "{tiles}"
        );
        let tasks = folder.path().join("tiled.tif.job/tasks");
        let before = files_of(&tasks).len();
        // Nothing has changed; the option is part of the plan.
        let words = format!("dem in/*.laz --tiles {tiles} --resume");
        let (again, said) = output_with(&folder, &words, "tiled.tif", 3);
        assert!(said.contains(hole) && again != expected, "{said}");
        assert_eq!(files_of(&tasks).len(), before);
        std::fs::write(&path, &good).unwrap();
        let (tiled, said) = output_of(&folder, &words, "tiled.tif");
        assert!(tiled == expected && said.contains("resumed     "), "{said}");
        assert!(!folder.path().join("tiled.tif.job").exists());
        std::fs::write(&path, &bad).unwrap();
    }
}

/// If not even the header can be read, the file is no part of the plan, which is made anew once it
/// can be read.
#[test]
fn a_file_without_a_header_is_planned_with_once_it_has_one() {
    let folder = folder_with_a_bad_file();
    let path = folder.path().join("in/002_001.laz");
    let whole = tempfile::tempdir().unwrap();
    landscape::write(&whole.path().join("in"), 16_000, 4).unwrap();
    std::fs::write(&path, "LASF, but nothing else").unwrap();
    let (_, said) = output_with(
        &folder,
        "dem in/*.laz --tiles auto --skip-bad",
        "tiled.tif",
        3,
    );
    assert!(
        said.contains("skipped: in/002_001.laz: byte 22: ")
            && said.contains("its extent is not known"),
        "{said}"
    );
    assert!(said.contains("tiles       15 (the files)"), "{said}");
    let (_, said) = output_with(
        &folder,
        "dem in/*.laz --tiles auto --resume",
        "tiled.tif",
        3,
    );
    assert!(
        said.contains("resumed     ") && !said.contains("planned again"),
        "{said}"
    );
    std::fs::write(&path, bytes(whole.path().join("in/002_001.laz"))).unwrap();
    let (tiled, said) = output_of(&folder, "dem in/*.laz --tiles auto --resume", "tiled.tif");
    assert!(
        said.contains("in/002_001.laz was skipped, and can be read now: the job is planned again"),
        "{said}"
    );
    let (expected, _) = output_of(&folder, "dem in/*.laz", "whole.tif");
    assert!(tiled == expected && !folder.path().join("tiled.tif.job").exists());
}

/// A strip over a file that is damaged has points there, but fewer: what is missing would not show.
#[test]
fn a_hole_is_empty_where_other_files_have_points_too() {
    let folder = tempfile::tempdir().unwrap();
    let strip: Vec<([f64; 3], u8)> = (0..120)
        .map(|i| {
            (
                [f64::from(i % 20) - 6.0, f64::from(i / 20), f64::from(i % 7)],
                2,
            )
        })
        .collect();
    for (name, points) in [
        ("a.las", lidar::tile([0.0, 0.0], 2)),
        ("b.las", lidar::tile([20.0, 0.0], 2)),
        ("strip.las", strip),
    ] {
        std::fs::write(folder.path().join(name), lidar::las(&points, Some(25832))).unwrap();
    }
    let whole = bytes(folder.path().join("a.las"));
    std::fs::write(folder.path().join("a.las"), &whole[..whole.len() - 30]).unwrap();
    let mut rasters = Vec::new();
    for tiles in ["auto", "1x1", "2x2", "7x3"] {
        let words =
            format!("dem a.las b.las strip.las --resolution 0.5 --tiles {tiles} --skip-bad");
        let (raster, said) = output_with(&folder, &words, "hole.tif", 3);
        assert!(
            said.contains("from 0 0 to 3 3, also where strip.las has points"),
            "{said}"
        );
        assert!(
            height(&folder, "hole.tif", 1.3, 1.3).is_nan()
                && height(&folder, "hole.tif", 2.8, 2.8).is_nan()
        );
        assert!(
            !height(&folder, "hole.tif", -2.5, 1.3).is_nan()
                && !height(&folder, "hole.tif", 1.3, 4.2).is_nan()
        );
        rasters.push(raster);
        std::fs::remove_dir_all(folder.path().join("hole.tif.job")).unwrap();
    }
    assert!(rasters.iter().all(|raster| *raster == rasters[0]));
    // The surface of the others, without the triangles that reach into the hole.
    output_of(
        &folder,
        "dem b.las strip.las --resolution 0.5 --te -6,0,23,5",
        "others.tif",
    );
    output_with(
        &folder,
        "dem a.las b.las strip.las --resolution 0.5 --te -6,0,23,5 --skip-bad",
        "hole.tif",
        3,
    );
    let read = |name: &str| {
        geotiff::open(folder.path().join(name))
            .unwrap()
            .read_grid()
            .unwrap()
    };
    let (others, hole) = (read("others.tif"), read("hole.tif"));
    let mut empty = 0;
    for (at, (a, b)) in others.values.iter().zip(&hole.values).enumerate() {
        let [x, y] = others
            .frame
            .center(at % others.frame.width, at / others.frame.width);
        let is_inside = 0.0 < x && x < 3.0 && 0.0 < y && y < 3.0;
        // Triangles of the strip are a unit wide.
        let is_near = -1.0 < x && x < 4.0 && y < 4.0;
        assert!(
            if is_inside {
                b.is_nan()
            } else {
                is_near || a.to_bits() == b.to_bits()
            },
            "{x} {y}: {a} {b}"
        );
        empty += usize::from(is_inside);
    }
    assert_eq!(empty, 36);
}

/// Damage does not keep a job from being planned, neither where classes are looked for nor where
/// systems are compared; each verb of `job` ends with the status of a result with holes.
#[test]
fn damaged_files_do_not_stop_planning() {
    let folder = folder_with_a_bad_file();
    let path = folder.path().join("in/000_000.laz");
    let mut damaged = bytes(&path);
    // The compressed points, which begin after the header and its records.
    let start = u32::from_le_bytes(damaged[96..100].try_into().unwrap()) as usize + 8;
    let end = damaged.len() - 40;
    damaged[start..end].fill(0xff);
    std::fs::write(&path, &damaged).unwrap();
    std::fs::write(folder.path().join("in/t.xyz"), "0 0 0\n1 0 0\n0 1 x\n").unwrap();
    let files = "in/*.laz in/t.xyz";
    let run = |words: &str| run_in(&folder, &words.split(' ').collect::<Vec<_>>());
    let planned = run(&format!(
        "job plan j -- dem {files} -o dem.tif --tiles auto --skip-bad"
    ));
    planned.works(&["next        breakline job run j"]);
    let ran = run("job run j");
    let skipped = ["000_000.laz: ", "002_001.laz: byte", "t.xyz: line 3"];
    assert_eq!(ran.code, 3, "{}", ran.stderr);
    // A job has whole names.
    let inputs = folder.path().canonicalize().unwrap().join("in");
    let is_skipped = |text: &str| {
        ran.stderr
            .contains(&format!("skipped: {}/{text}", inputs.display()))
    };
    assert!(skipped.into_iter().all(is_skipped), "{}", ran.stderr);
    assert!(
        ran.stderr.contains("holes: 3 files skipped") && ran.stderr.contains("`breakline job run "),
        "{}",
        ran.stderr
    );
    let status = run("job status j --json");
    assert!(
        status.stdout.contains(r#""holes":true"#),
        "{}",
        status.stdout
    );
    let first = bytes(folder.path().join("dem.tif"));
    let again = run("job run j");
    assert_eq!(again.code, 3, "{}", again.stderr);
    assert!(bytes(folder.path().join("dem.tif")) == first);
}

/// Also a file whose points are damaged: coordinates that leave the extent are how that shows.
#[test]
fn a_header_that_lies_is_an_error_that_names_tile_and_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut names = Vec::new();
    for i in 0..9 {
        let name = format!("{i}.las");
        let corner = [f64::from(i % 3) * 10.0, f64::from(i / 3) * 10.0];
        std::fs::write(
            folder.path().join(&name),
            lidar::las(&lidar::tile(corner, 2), Some(25832)),
        )
        .unwrap();
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
        run_in(&folder, &words).fails(
            1,
            &[
                &format!("error: {location}{said}"),
                "are kept",
                "go on with --resume",
            ],
        );
        assert!(!folder.path().join("dem.tif").exists());
        let tasks = files_of(&folder.path().join(tiles).join("tasks"));
        assert!(
            tasks.len() < kept && tasks.iter().all(|name| name.ends_with(".task")),
            "{tasks:?}"
        );

        let words = format!("dem {files} --tiles {tiles} --job {tiles} --resume --skip-bad");
        let (_, said_then) = output_with(&folder, &words, "hole.tif", 3);
        assert!(
            said_then.contains(&format!("skipped: 1.las: {said}")),
            "{said_then}"
        );
        // No triangle spans the file that is missing; around it all is there.
        assert!(
            said_then.contains("left out over skipped files"),
            "{said_then}"
        );
        let grid = geotiff::open(folder.path().join("hole.tif"))
            .unwrap()
            .read_grid()
            .unwrap();
        let height = |x: f64, y: f64| {
            let [column, row] = grid.frame.inverse().apply(x, y);
            grid.values[row as usize * grid.frame.width + column as usize]
        };
        assert!(
            height(11.5, 1.5).is_nan()
                && !height(1.5, 1.5).is_nan()
                && !height(11.5, 11.5).is_nan()
        );
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
        let words = format!("dem 0.las 1.las 2.las --tiles {tiles} --skip-bad");
        let (_, said) = output_with(&folder, &words, "hole.tif", 3);
        std::fs::remove_dir_all(folder.path().join("hole.tif.job")).unwrap();
        let grid = geotiff::open(folder.path().join("hole.tif"))
            .unwrap()
            .read_grid()
            .unwrap();
        let [column, row] = grid.frame.inverse().apply(4.5, 1.5);
        assert!(
            grid.values[row as usize * grid.frame.width + column as usize].is_nan(),
            "{tiles}: {said}"
        );
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
        std::fs::write(
            folder.path().join(&name),
            lidar::las(&lidar::tile(corner, 2), Some(25832)),
        )
        .unwrap();
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
        files_of(&tasks)
            .iter()
            .map(|name| tasks.join(name).metadata().unwrap().modified().unwrap())
            .collect()
    };
    let before = times();
    std::fs::write(&path, &good).unwrap();
    let (tiled, said) = output_of(
        &folder,
        &format!("{words} --resume").replace(" -o dem.tif", " --job dem.tif.job"),
        "dem.tif",
    );
    assert!(tiled == whole && said.contains("resumed"), "{said}");
    assert!(times()[..before.len()] == before[..]);
    // Once it is read, it must stay.
    std::fs::write(&path, &damaged).unwrap();
    run(&format!("{words} --resume --overwrite"))
        .fails(2, &["3.las", "has changed since the job was planned"]);
}

/// The length of a point's record.
fn lidar_record(file: &[u8]) -> usize {
    usize::from(u16::from_le_bytes([file[105], file[106]]))
}

/// Files that are all gone are not damaged: their file system is not mounted.
#[test]
fn a_folder_that_is_gone_is_no_hole() {
    let folder = tempfile::tempdir().unwrap();
    landscape::write(&folder.path().join("in"), 16_000, 4).unwrap();
    let [inputs, away] = ["in", "away"].map(|name| folder.path().join(name));
    let work = |words: &str| run_in(&folder, &words.split_whitespace().collect::<Vec<_>>());
    work("job plan j -- dem in/*.laz -o dem.tif --tiles 2x2 --skip-bad").works(&[]);
    std::fs::rename(&inputs, &away).unwrap();
    let is_gone = [
        "laz: the file is missing, and so is its folder",
        "is mounted",
    ];
    work("job run j").fails(2, &is_gone);
    work("job run j --task 0").fails(2, &is_gone);
    work("dem in/000_000.laz in/001_000.laz -o new.tif --tiles 2x2 --skip-bad")
        .fails(1, &["in/000_000.laz: no such file"]);
    std::fs::create_dir(&inputs).unwrap();
    work("job run j").fails(
        2,
        &["the file is missing, and so are all others of its folder"],
    );
    // One that is missing among others is a hole.
    std::fs::remove_dir(&inputs).unwrap();
    std::fs::rename(&away, &inputs).unwrap();
    std::fs::remove_file(inputs.join("001_001.laz")).unwrap();
    assert_eq!(work("job run j").code, 3);
}
