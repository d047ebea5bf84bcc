//! COPC as it is written: its points, its octree, what damage of it does, and what is refused.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use breakline::data::{PointBatch, PointSource};
use breakline::io::las::{self as ours, Detail};
use breakline::run::PointsRequest;
use testkit::random::Random;

use crate::program::run_in;
use crate::{copy, open, options, rest, square, within};

/// Many points, in two files of an old point format, with many at one position.
fn old_files(folder: &Path) -> [PathBuf; 2] {
    let mut random = Random(9);
    [0, 1].map(|number| {
        let path = folder.join(format!("{number}.las"));
        let mut builder = las::Builder::from((1, 2));
        builder.point_format = las::point::Format::new(3).unwrap();
        let transform = las::Transform {
            scale: 0.01,
            offset: 0.0,
        };
        builder.transforms = las::Vector {
            x: transform,
            y: transform,
            z: transform,
        };
        let mut writer = las::Writer::from_path(&path, builder.into_header().unwrap()).unwrap();
        for i in 0..60_000 {
            let side = if i % 3 == 0 { 100 } else { 4000 };
            let [x, y] = [0, 1].map(|_| random.below(side) as f64 * 0.05);
            let point = las::Point {
                x: x + f64::from(number) * 150.0,
                y,
                z: (x / 10.0).floor(),
                intensity: random.below(65536) as u16,
                return_number: 1,
                number_of_returns: 2,
                classification: las::point::Classification::Ground,
                gps_time: Some(f64::from(i)),
                color: Some(las::Color::new(1, 2, i as u16)),
                scan_angle: -7.0,
                ..las::Point::default()
            };
            writer.write_point(point).unwrap();
        }
        writer.close().unwrap();
        path
    })
}

fn sorted(batch: &PointBatch, length: usize) -> Vec<&[u8]> {
    let mut records: Vec<&[u8]> = batch.records.chunks_exact(length).collect();
    records.sort_unstable();
    records
}

#[test]
fn a_file_with_an_octree_has_all_points_of_those_it_is_made_of() {
    let folder = tempfile::tempdir().unwrap();
    let files = old_files(folder.path());
    let request = PointsRequest {
        files: files.to_vec(),
        ..PointsRequest::default()
    };
    let target = folder.path().join("all.copc.laz");
    let report = copy(&request, &target).unwrap();
    assert_eq!(report.written.count, 120_000);
    let reader = las_crate(&target);
    assert_eq!(reader.0, (7, 120_000));
    // By the crate: all fields of each point.
    let mut expected: Vec<String> = files.iter().flat_map(|path| las_crate(path).1).collect();
    expected.sort_unstable();
    let mut found = reader.1;
    found.sort_unstable();
    assert!(found == expected);

    // A copy of it as LAZ has the same records, and one with an octree the same bytes.
    let one = |from: &Path, to: &str| {
        let request = PointsRequest {
            files: vec![from.to_path_buf()],
            ..PointsRequest::default()
        };
        let target = folder.path().join(to);
        copy(&request, &target).unwrap();
        target
    };
    let open = |path: &Path| ours::open_with(path, options(Detail::Records)).unwrap();
    let plain = one(&target, "plain.laz");
    let (with, without) = (
        rest(&mut open(&target)).unwrap(),
        rest(&mut open(&plain)).unwrap(),
    );
    assert!(with.records == without.records && with.len() == 120_000);
    let again = one(&plain, "again.copc.laz");
    let again = rest(&mut open(&again)).unwrap();
    assert!(sorted(&again, 36) == sorted(&with, 36));

    // In part, by window and by level.
    let info = open(&target).info().clone();
    let mut fewer = 0;
    for part in 0..16 {
        let [i, j] = [part % 4, part / 4].map(f64::from);
        let window = square([i * 85.0 + 3.0, j * 50.0 - 1.0], 30.0);
        let mut source = open(&target);
        let read = source.narrow(&window).unwrap().unwrap();
        fewer += usize::from(read.points < 60_000);
        assert!(
            within(rest(&mut source).unwrap(), &window).records
                == within(with.clone(), &window).records
        );
    }
    assert!(fewer > 5, "{fewer}");
    let bounds = info.bounds.unwrap();
    // The cube is a step larger.
    let spacing = (bounds.max[0] - bounds.min[0] + 0.01) / 128.0;
    let mut counts = Vec::new();
    for level in 0..3 {
        let apart = 1.001 * spacing / f64::from(1 << level);
        let mut source = open(&target);
        source.coarsen(apart).unwrap().unwrap();
        let batch = rest(&mut source).unwrap();
        counts.push(batch.len());
        // Each point has one of the level that is as near as points of the level are apart.
        let cell = |batch: &PointBatch, i: usize| {
            [batch.x[i], batch.y[i]].map(|at| (at / apart).floor() as i64)
        };
        let cells: BTreeSet<[i64; 2]> = (0..batch.len()).map(|i| cell(&batch, i)).collect();
        for i in 0..with.len() {
            let [x, y] = cell(&with, i);
            let mut around = (-1..=1).flat_map(|j| (-1..=1).map(move |i| [x + i, y + j]));
            assert!(around.any(|cell| cells.contains(&cell)), "{level} {x} {y}");
        }
    }
    assert!(counts.is_sorted() && counts[0] * 4 < 120_000, "{counts:?}");
}

/// Returns the point format and the count of a file, and its points in words, by the crate `las`.
fn las_crate(path: &Path) -> ((u8, u64), Vec<String>) {
    let mut reader = las::Reader::from_path(path).unwrap();
    let format = reader.header().point_format().to_u8().unwrap() & 0x3f;
    let count = reader.header().number_of_points();
    let all = reader.read_all().unwrap();
    let points = all
        .points()
        .map(|point| {
            let las::Point {
                x,
                y,
                z,
                intensity,
                gps_time,
                color,
                scan_angle,
                ..
            } = point.unwrap();
            format!("{x} {y} {z} {intensity} {gps_time:?} {color:?} {scan_angle:.0}")
        })
        .collect();
    ((format, count), points)
}

/// Whatever is damaged of a written file: an error that says where, and what to do, or points that
/// the file had.
#[test]
fn a_written_file_that_is_damaged_is_refused_or_read() {
    let folder = tempfile::tempdir().unwrap();
    let files = old_files(folder.path());
    let target = folder.path().join("a.copc.laz");
    let request = PointsRequest {
        files: files[..1].to_vec(),
        bounds: Some(square([0.0, 0.0], 100.0)),
        ..PointsRequest::default()
    };
    copy(&request, &target).unwrap();
    let whole = std::fs::read(&target).unwrap();
    let mut random = Random(21);
    let (mut errors, mut read_count) = (0, 0);
    let damaged = folder.path().join("b.copc.laz");
    let output = folder.path().join("c.laz");
    let cases = std::env::var("BREAKLINE_MUTATIONS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(100);
    for i in 0..cases {
        let mut bytes = whole.clone();
        // The header, the records, the table and the pages are short: half of the time, those.
        let at = match i % 4 {
            0 => random.index(700),
            1 => bytes.len() - 1 - random.index(1500),
            _ => random.index(bytes.len()),
        };
        match i % 5 {
            0 => bytes.truncate(at),
            1 => bytes[at..].iter_mut().take(4).for_each(|byte| *byte = 0xff),
            2 => bytes[at] = random.below(256) as u8,
            3 => drop(bytes.drain(at..(at + 40).min(whole.len()))),
            _ => bytes[at] ^= 1 << random.below(8),
        }
        std::fs::write(&damaged, &bytes).unwrap();
        let request = PointsRequest {
            files: vec![damaged.clone()],
            bounds: Some(square([2.0, 2.0], 30.0)),
            ..PointsRequest::default()
        };
        match copy(&request, &output) {
            Ok(_) => read_count += 1,
            Err(error) => {
                errors += 1;
                let text = error.to_string();
                assert!(text.contains("b.copc.laz"), "{text}");
                assert!(error.cure_text().is_some(), "{text}");
                assert!(!output.exists());
            }
        }
        let _ = std::fs::remove_file(&output);
    }
    assert!(
        errors * 4 > cases && read_count * 25 > cases,
        "{errors} {read_count}"
    );
}

/// Keys may say nothing of heights but their unit; an octree has WKT, which says it, too.
#[test]
fn the_unit_of_heights_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let [old, new] = ["a.las", "a.copc.laz"].map(|name| folder.path().join(name));
    let points = [[0.0, 0.0, 5.0], [9.0, 0.0, 6.0], [0.0, 9.0, 7.0]].map(|p| (p, 2));
    std::fs::write(
        &old,
        testkit::lidar::las_with_heights_in_feet(&points, 26917),
    )
    .unwrap();
    let request = PointsRequest {
        files: vec![old.clone()],
        ..PointsRequest::default()
    };
    copy(&request, &new).unwrap();
    let unit = |path: &Path| {
        let bytes = std::fs::read(path).unwrap();
        let crs = open(&bytes, Detail::Columns)
            .unwrap()
            .info()
            .crs
            .clone()
            .unwrap();
        (crs.epsg, crs.vertical_unit.unwrap().factor)
    };
    for (code, factor) in [unit(&old), unit(&new)] {
        // Text has 17 digits.
        assert_eq!(code, Some(26917));
        assert!((factor / (1200.0 / 3937.0) - 1.0).abs() < 1e-15, "{factor}");
    }
}

#[test]
fn what_has_no_room_in_an_octree_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    old_files(folder.path());
    let run = run_in(&folder, &["points", "0.las", "-o", "a.COPC.laz"]);
    run.works(&["60000 points"]);
    // A version whose header has more fields.
    let mut bytes = std::fs::read(folder.path().join("a.COPC.laz")).unwrap();
    bytes[25] = 5;
    std::fs::write(folder.path().join("1.laz"), &bytes).unwrap();
    let run = run_in(&folder, &["points", "1.laz", "-o", "b.copc.laz"]);
    run.fails(1, &["COPC is LAS 1.4", ".laz"]);
    assert!(!folder.path().join("b.copc.laz").exists());
    let info = run_in(&folder, &["info", "a.COPC.laz", "--copc-resolution", "2"]);
    assert!(info.stdout.contains(" points"), "{}", info.stderr);
}
