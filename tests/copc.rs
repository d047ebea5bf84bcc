//! COPC by its octree: what is read for bounds is what reading everything and filtering gives.

#[path = "common/program.rs"]
mod program;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use breakline::data::{Bounds, PartRead, PointBatch, PointSource};
use breakline::error::Kind;
use breakline::io::las::{self as ours, Detail, ReadOptions};
use breakline::io::{OnDamage, OutputSet, points};
use breakline::run::{
    Context, Notice, PointsReport, PointsRequest, facts, read_points, write_points,
};
use program::run_in;
use testkit::copc::{Copc, ENTRY, INFO, Node, RECORD, STEP, Tree, copc};
use testkit::random::Random;

const TREE: Tree = Tree {
    low: [-1024, 50_000, 0],
    side: 4096,
    most: 12,
    levels_of_page: 2,
};

/// A file of many nodes on a slope, denser in one corner.
fn file_of(count: usize) -> Copc {
    let mut random = Random(7);
    let point = |i: usize| {
        let reach = [4096, 4096, 512][i % 3];
        let [x, y] = [0, 1].map(|_| random.below(reach) as i32);
        [TREE.low[0] + x, TREE.low[1] + y, (x + y) / 4]
    };
    copc(&(0..count).map(point).collect::<Vec<_>>(), &TREE)
}

fn square(low: [f64; 2], side: f64) -> Bounds {
    Bounds {
        min: [low[0], low[1], f64::NEG_INFINITY],
        max: [low[0] + side, low[1] + side, f64::INFINITY],
    }
}

/// Bounds of many sizes: within nodes, on their borders, outside, and around all.
fn windows() -> Vec<Bounds> {
    let mut random = Random(3);
    let low = [0, 1].map(|k| f64::from(TREE.low[k]) * STEP);
    let mut windows = vec![
        square(low, 40.96),
        square([low[0] - 1.0, low[1] - 1.0], 50.0),
        square([low[0] - 9.0, low[1]], 5.0),
        square([low[0] + 20.48, low[1] + 20.48], 0.0),
        square([low[0] + 20.47, low[1] + 10.24], 0.01),
    ];
    for _ in 0..15 {
        let at = [0, 1].map(|k| low[k] + random.below(4100) as f64 * STEP);
        windows.push(square(at, random.pick(&[0.0, 0.05, 1.0, 4.0, 10.24])));
    }
    windows
}

fn options(detail: Detail) -> ReadOptions {
    ReadOptions {
        detail,
        ..ReadOptions::default()
    }
}

fn open(bytes: &[u8], detail: Detail) -> breakline::Result<ours::LasReader> {
    ours::from_stream_with(bytes, "made.copc.laz", options(detail))
}

/// All that is left to read, in one batch.
fn rest(source: &mut dyn PointSource) -> breakline::Result<PointBatch> {
    let (mut all, mut batch) = (PointBatch::default(), PointBatch::default());
    loop {
        source.read(&mut batch)?;
        if batch.is_empty() {
            return Ok(all);
        }
        all.x.extend(&batch.x);
        all.y.extend(&batch.y);
        all.z.extend(&batch.z);
        all.class.extend(&batch.class);
        all.records.extend(&batch.records);
    }
}

fn within(mut batch: PointBatch, window: &Bounds) -> PointBatch {
    let keep: Vec<bool> = (0..batch.len())
        .map(|i| window.holds(batch.x[i], batch.y[i]))
        .collect();
    batch.retain(&keep);
    batch
}

/// Returns the nodes that meet a window, by whole steps, and the root.
fn meeting<'a>(
    file: &'a Copc,
    tree: &'a Tree,
    window: &'a Bounds,
) -> impl Iterator<Item = &'a Node> {
    file.nodes.iter().filter(move |node| {
        let (low, side) = node.cube(tree);
        let meets = |k: usize| {
            let border = |steps: i32| {
                let is_outer = steps == tree.low[k] || steps == tree.low[k] + tree.side;
                let outside = f64::from(tree.side) / 1024.0;
                (
                    f64::from(steps) * STEP,
                    if is_outer {
                        0.01 + outside * STEP
                    } else {
                        0.01
                    },
                )
            };
            let [(min, below), (max, above)] = [low[k], low[k] + side].map(border);
            min - below - 1e-9 <= window.max[k] && window.min[k] <= max + above + 1e-9
        };
        node.level == 0 || (meets(0) && meets(1))
    })
}

#[test]
fn bounds_give_what_reading_everything_gives_from_the_nodes_that_meet_them() {
    let file = file_of(3_000);
    assert!(file.nodes.len() > 150 && file.pages.len() > 5);
    for detail in [Detail::Columns, Detail::Records] {
        let all = rest(&mut open(&file.bytes, detail).unwrap()).unwrap();
        assert_eq!(all.len(), 3_000);
        for window in windows() {
            let mut source = open(&file.bytes, detail).unwrap();
            let part = source.narrow(&window).unwrap().unwrap();
            let (nodes, points) = meeting(&file, &TREE, &window)
                .fold((0, 0), |(n, p), node| (n + 1, p + node.points));
            let expected = PartRead {
                parts: nodes,
                of: file.nodes.len(),
                points: points as u64,
            };
            assert_eq!(part, expected, "{window:?}");
            let read = rest(&mut source).unwrap();
            assert_eq!(read.len() as u64, part.points);
            let (found, all) = (within(read, &window), within(all.clone(), &window));
            assert_eq!(
                (found.x, found.y, found.z),
                (all.x, all.y, all.z),
                "{window:?}"
            );
            assert_eq!((found.class, found.records), (all.class, all.records));
        }
    }
}

/// Of a file of more than a thousand nodes, a hundredth of the area takes less than 5 % of the
/// bytes: the nodes that meet it, the hierarchy and the table of chunks, with what is read around
/// these.
#[test]
fn a_hundredth_of_the_area_takes_less_than_a_twentieth_of_the_bytes() {
    let tree = Tree {
        low: [0; 3],
        side: 1 << 14,
        most: 500,
        levels_of_page: 3,
    };
    let mut random = Random(1);
    let point = |_| {
        let [x, y] = [0, 1].map(|_| random.below(1 << 14) as i32);
        [x, y, (x + y) / 64]
    };
    let file = copc(&(0..530_000).map(point).collect::<Vec<_>>(), &tree);
    assert!(file.nodes.len() >= 1000, "{} nodes", file.nodes.len());
    let side = f64::from(tree.side) * STEP;
    let window = square([0.62 * side; 2], 0.1 * side);
    let mut source = open(&file.bytes, Detail::Columns).unwrap();
    let part = source.narrow(&window).unwrap().unwrap();
    let met = || meeting(&file, &tree, &window);
    assert_eq!(part.parts, met().count());
    assert_eq!(rest(&mut source).unwrap().len() as u64, part.points);
    let index: usize = file.pages.iter().map(|(_, bytes)| bytes).sum();
    // The table is read with room for 16 bytes a chunk, records through buffers of 8 KB.
    let around = 64 + 16 * file.nodes.len() + 375 + 2 * 8192;
    let read = met().map(|node| node.bytes).sum::<usize>() + index + around;
    let share = read as f64 / file.bytes.len() as f64;
    assert!(share < 0.05, "{read} of {} bytes", file.bytes.len());
}

/// Other nodes may be anything: no byte of them is decoded.
#[test]
fn other_nodes_are_not_decoded() {
    let file = file_of(3_000);
    let all = rest(&mut open(&file.bytes, Detail::Records).unwrap()).unwrap();
    let window = square([0.0, 505.0], 4.0);
    let mut bytes = file.bytes.clone();
    let met: Vec<usize> = meeting(&file, &TREE, &window)
        .map(|node| node.start)
        .collect();
    for node in file.nodes.iter().filter(|node| !met.contains(&node.start)) {
        bytes[node.start..node.start + node.bytes].fill(0xff);
    }
    let mut source = open(&bytes, Detail::Records).unwrap();
    source.narrow(&window).unwrap();
    assert_eq!(
        within(rest(&mut source).unwrap(), &window).records,
        within(all, &window).records
    );
    assert!(rest(&mut open(&bytes, Detail::Records).unwrap()).is_err());
}

#[test]
fn levels_are_read_down_to_a_spacing() {
    let file = file_of(3_000);
    let root = f64::from(TREE.side) * STEP / 16.0;
    let deepest = file.nodes.iter().map(|node| node.level).max().unwrap();
    for (spacing, level) in [
        (root * 2.0, 0),
        (root, 0),
        (root * 0.99, 1),
        (root / 2.0, 1),
        (root / 5.0, 3),
        (1e-30, deepest),
    ] {
        let mut source = open(&file.bytes, Detail::Columns).unwrap();
        let part = source.coarsen(spacing).unwrap().unwrap();
        let kept = || file.nodes.iter().filter(|node| node.level <= level);
        let points = kept().map(|node| node.points).sum::<usize>() as u64;
        assert_eq!(
            (part.parts, part.points),
            (kept().count(), points),
            "{spacing}"
        );
        assert_eq!(source.info().count, Some(points));
        // Both choices together.
        let window = square([0.0, 505.0], 4.0);
        let part = source.narrow(&window).unwrap().unwrap();
        let both = meeting(&file, &TREE, &window).filter(|node| node.level <= level);
        assert_eq!(part.parts, both.count());
        assert_eq!(rest(&mut source).unwrap().len() as u64, part.points);
    }
}

/// Each byte of the index, with its lowest or its highest bit flipped: an error that names the
/// place, or what reading everything gives. Only what says where nodes are may be wrong without
/// being found out, of nodes that are not read; then points are missing, but none is wrong.
#[test]
fn a_damaged_index_is_an_error_or_adds_nothing() {
    let file = file_of(300);
    let window = square([0.0, 505.0], 4.0);
    let all = within(
        rest(&mut open(&file.bytes, Detail::Records).unwrap()).unwrap(),
        &window,
    );
    let expected: BTreeSet<&[u8]> = all.records.chunks_exact(RECORD).collect();
    let of_cubes = (INFO..INFO + 32).map(|at| (at, true));
    let of_info = (INFO + 32..INFO + 160).map(|at| (at, false));
    let of_pages = file
        .pages
        .iter()
        .flat_map(|&(start, bytes)| (0..bytes).map(move |at| (start + at, at % ENTRY < 16)));
    let (mut errors, mut fewer, mut total) = (0, 0, 0);
    for (at, is_position) in of_cubes.chain(of_info).chain(of_pages) {
        for bit in [0, 7] {
            let mut bytes = file.bytes.clone();
            bytes[at] ^= 1 << bit;
            let mut source = open(&bytes, Detail::Records).unwrap();
            let read = source
                .narrow(&window)
                .and_then(|_| rest(&mut source))
                .map(|read| within(read, &window).records);
            total += 1;
            match read {
                Ok(read) if read == all.records => {}
                Ok(read) => {
                    assert!(is_position, "byte {at}, bit {bit}");
                    let mut records = read.chunks_exact(RECORD);
                    assert!(records.all(|record| expected.contains(record)));
                    fewer += 1;
                }
                Err(error) => {
                    errors += 1;
                    assert_eq!(error.kind(), Kind::Format);
                    let text = error.to_string();
                    assert!(text.starts_with("made.copc.laz: "), "{text}");
                    assert!(text.contains("the octree is damaged: "), "{text}");
                    assert!(error.cure_text().is_some());
                }
            }
            // Without bounds the index does not matter.
            if at % 97 == 0 {
                let whole = rest(&mut open(&bytes, Detail::Columns).unwrap()).unwrap();
                assert_eq!(whole.len(), 300);
            }
        }
    }
    assert!(errors * 2 > total, "{errors} of {total}");
    assert!(fewer * 50 < total, "{fewer} of {total}");
}

fn entry(bytes: &mut [u8], at: usize, key: [i32; 4], start: u64, size: i32, points: i32) {
    let mut put = |offset: usize, value: &[u8]| {
        bytes[at + offset..at + offset + value.len()].copy_from_slice(value)
    };
    key.iter()
        .enumerate()
        .for_each(|(i, number)| put(4 * i, &number.to_le_bytes()));
    put(16, &start.to_le_bytes());
    put(24, &size.to_le_bytes());
    put(28, &points.to_le_bytes());
}

#[test]
fn what_is_wrong_with_an_index_is_named() {
    let file = file_of(300);
    let refusal = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = file.bytes.clone();
        change(&mut bytes);
        let mut source = open(&bytes, Detail::Columns).unwrap();
        let read = source
            .narrow(&square([0.0, 505.0], 4.0))
            .and_then(|_| rest(&mut source));
        let mut partial =
            ours::from_stream_with(&bytes[..], "made.copc.laz", OnDamage::Accept).unwrap();
        let part = partial.narrow(&square([0.0, 505.0], 4.0)).unwrap();
        // With what is left of damaged files, all is read.
        if part.is_none() {
            assert_eq!(partial.warnings().len(), 1);
            assert_eq!(rest(&mut partial).unwrap().len(), 300);
        }
        read.map(|_| ()).unwrap_err().to_string()
    };
    let (page, _) = file.pages[0];
    let last = file.bytes.len() as u64;
    let node = file.nodes.iter().find(|node| node.level == 1).unwrap();
    type Change<'a> = &'a dyn Fn(&mut Vec<u8>);
    let cases: [(Change<'_>, &str); 9] = [
        (
            &|b| entry(b, page, [0, 1, 0, 0], 0, 0, 0),
            "there is no node 0-1-0-0 in an octree",
        ),
        (
            &|b| entry(b, page, [-1, 0, 0, 0], 0, 0, 0),
            "there is no node -1-0-0-0",
        ),
        (
            &|b| entry(b, page, [3, 0, 0, 0], 0, -5, 1),
            "node 3-0-0-0 is said to have 1 points in -5 bytes",
        ),
        (
            &|b| entry(b, page, [9, 0, 0, 0], last, 40, 7),
            "where no such chunk is",
        ),
        (
            &|b| {
                entry(
                    b,
                    page,
                    [9, 0, 0, 0],
                    node.start as u64,
                    node.bytes as i32,
                    node.points as i32,
                )
            },
            "has the points of node",
        ),
        (
            &|b| entry(b, page, [0, 0, 0, 0], page as u64, ENTRY as i32, -1),
            "node 0-0-0-0 has a second page",
        ),
        (
            &|b| {
                entry(
                    b,
                    page,
                    [9, 1, 1, 1],
                    (page + ENTRY) as u64,
                    ENTRY as i32,
                    -1,
                )
            },
            "which it is not part of",
        ),
        (
            &|b| entry(b, page, [9, 1, 1, 1], last, 32, -1),
            "the page of node 9-1-1-1 is said to have 32 bytes",
        ),
        (
            &|b| b[INFO + 24..INFO + 32].copy_from_slice(&f64::NAN.to_le_bytes()),
            "the octree is said to be NaN wide",
        ),
    ];
    for (change, expected) in cases {
        let text = refusal(change);
        assert!(text.contains(expected), "{text}\n{expected}");
    }
    // Nodes that are smaller than their points are wide.
    let half = f64::from(TREE.side) * STEP / 4.0;
    let text = refusal(&|b| b[INFO + 24..INFO + 32].copy_from_slice(&half.to_le_bytes()));
    assert!(text.contains("is outside of its node"), "{text}");
    // A chunk that no node has.
    let text = refusal(&|b| entry(b, page, [9, 1, 1, 1], 0, 0, 0));
    assert!(
        text.contains("no node has the points of chunk") || text.contains("is not below"),
        "{text}"
    );
}

/// A folder with one file, and the path of that.
fn folder_of(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}

/// The file without its index, as LAZ.
fn plain(file: &Copc) -> Vec<u8> {
    let mut bytes = file.bytes.clone();
    bytes[INFO - 52..INFO - 36].copy_from_slice(b"nobody\0\0\0\0\0\0\0\0\0\0");
    bytes
}

fn copy(request: &PointsRequest, target: &Path) -> breakline::Result<PointsReport> {
    let set = OutputSet::default();
    let report = write_points(request, set.at(target), &Context::default())?;
    set.commit()?;
    Ok(report)
}

#[test]
fn the_points_written_are_those_of_a_file_without_an_index() {
    let file = file_of(3_000);
    let (folder, path) = folder_of("a.copc.laz", &file.bytes);
    let without = folder.path().join("b.laz");
    std::fs::write(&without, plain(&file)).unwrap();
    for (i, window) in windows().into_iter().enumerate() {
        let request = |file: &Path| PointsRequest {
            files: vec![file.to_path_buf()],
            bounds: Some(window),
            ..PointsRequest::default()
        };
        let [a, b] = ["a", "b"].map(|name| folder.path().join(format!("{name}{i}.laz")));
        match (copy(&request(&path), &a), copy(&request(&without), &b)) {
            (Ok(fewer), Ok(all)) => {
                assert_eq!(fewer.written, all.written);
                assert!(fewer.read <= all.read);
                let records = |path: &Path| {
                    let mut source = ours::open_with(path, options(Detail::Records)).unwrap();
                    rest(&mut source).unwrap().records
                };
                assert_eq!(records(&a), records(&b));
                let part = meeting(&file, &TREE, &window).count() < file.nodes.len();
                let is_noted = fewer
                    .notices
                    .iter()
                    .any(|notice| matches!(notice, Notice::NodesRead { .. }));
                assert_eq!(is_noted, part, "{window:?}");
            }
            (Err(a), Err(b)) => assert_eq!(a.kind(), b.kind()),
            (a, b) => panic!("{a:?} {b:?}"),
        }
    }
}

#[test]
fn the_level_is_an_option_of_reading() {
    let file = file_of(5000);
    let (folder, path) = folder_of("a.copc.laz", &file.bytes);
    let read = |resolution| points::Options {
        resolution,
        ..points::Options::default()
    };
    let points = file
        .nodes
        .iter()
        .filter(|node| node.level <= 1)
        .map(|node| node.points)
        .sum::<usize>();
    let request = |file: &Path| PointsRequest {
        files: vec![file.to_path_buf()],
        read: read(Some(f64::from(TREE.side) * STEP / 32.0)),
        ..PointsRequest::default()
    };
    let product = read_points(&request(&path), &Context::default()).unwrap();
    assert_eq!(product.points.len(), points);
    assert!(facts(&path, read(Some(1e9)), &Context::default()).is_ok());
    for wrong in [0.0, -1.0, f64::NAN] {
        let error = facts(&path, read(Some(wrong)), &Context::default())
            .map(|_| ())
            .unwrap_err();
        assert_eq!(error.kind(), Kind::Usage);
    }
    let without = folder.path().join("b.laz");
    std::fs::write(&without, plain(&file)).unwrap();
    let error = read_points(&request(&without), &Context::default())
        .map(|_| ())
        .unwrap_err();
    assert!(error.to_string().contains("has no octree"), "{error}");
}

/// A surface within bounds is that of all points, to the byte, however few are read.
#[test]
fn surfaces_within_bounds_are_those_of_a_file_without_an_index() {
    let file = file_of(3_000);
    let (folder, _) = folder_of("a.copc.laz", &file.bytes);
    std::fs::write(folder.path().join("b.laz"), plain(&file)).unwrap();
    for (i, bounds) in ["0,505,4,509", "-9,500.5,-8,501.25", "10,520,30,540"]
        .iter()
        .enumerate()
    {
        // Classes, all of them, and ground by default, which a part may not have.
        for class in ["--class=all", "--class=2"] {
            let tin = |input: &str, output: &str| {
                let run = run_in(
                    &folder,
                    &[
                        "tin",
                        input,
                        "--bounds",
                        bounds,
                        class,
                        "-v",
                        "--max-edge=2",
                        "-o",
                        output,
                        "--overwrite",
                    ],
                );
                run.works(&[]);
                (run, std::fs::read(folder.path().join(output)).unwrap())
            };
            let (run, part) = tin("a.copc.laz", "a.ply");
            let (_, all) = tin("b.laz", "b.ply");
            assert!(part == all, "{bounds} {class}");
            let is_noted = run.stderr.contains("nodes of the octree are read");
            assert!(is_noted || i == 2, "{}", run.stderr);
        }
    }
}

#[test]
fn the_program_takes_a_level() {
    let file = file_of(5000);
    let (folder, _) = folder_of("a.copc.laz", &file.bytes);
    std::fs::write(folder.path().join("b.laz"), plain(&file)).unwrap();
    let root = file
        .nodes
        .iter()
        .find(|node| node.level == 0)
        .unwrap()
        .points;
    let info = ["info", "a.copc.laz", "--copc-resolution", "100"];
    let run = run_in(&folder, &info);
    assert!(
        run.stdout.contains(&format!(" {root} points")),
        "{}{}",
        run.stdout,
        run.stderr
    );
    let points = [
        "points",
        "a.copc.laz",
        "--copc-resolution",
        "100",
        "-o",
        "c.laz",
    ];
    run_in(&folder, &points).works(&[&format!("{root} points of {root}")]);
    let without = ["points", "b.laz", "--copc-resolution", "100", "-o", "d.laz"];
    run_in(&folder, &without).fails(2, &["b.laz: the file has no octree", "--copc-resolution"]);
    let zero = ["info", "a.copc.laz", "--copc-resolution", "0"];
    run_in(&folder, &zero).fails(2, &["is not above zero"]);
}

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

/// Files of other programs agree with their own index.
#[test]
#[cfg_attr(not(has_shared), ignore = "needs ../shared")]
fn real_files_are_narrowed() {
    for name in [
        "lone-star",
        "simple_with_page",
        "1.2-with-color",
        "no-extrabytes-dataset",
    ] {
        let path = testkit::shared(&format!("lidar/formats/{name}.copc.laz"));
        check_real(&path);
    }
}

fn check_real(path: &Path) {
    let open = || ours::open_with(path, options(Detail::Records)).unwrap();
    let all = rest(&mut open()).unwrap();
    let bounds = open().info().bounds.unwrap();
    for part in 0..16 {
        let [i, j] = [part % 4, part / 4].map(f64::from);
        let at = |k: usize, share: f64| bounds.min[k] + (bounds.max[k] - bounds.min[k]) * share;
        let window = Bounds {
            min: [at(0, i / 4.0), at(1, j / 4.0), f64::NEG_INFINITY],
            max: [
                at(0, (i + 1.0) / 4.0),
                at(1, (j + 1.0) / 4.0),
                f64::INFINITY,
            ],
        };
        let mut source = open();
        source.narrow(&window).unwrap().unwrap();
        let (found, all) = (
            within(rest(&mut source).unwrap(), &window),
            within(all.clone(), &window),
        );
        assert!(found.records == all.records, "{}", path.display());
    }
    assert!(open().coarsen(1.0).unwrap().is_some());
}
