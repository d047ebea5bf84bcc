//! COPC by its octree: what is read for bounds is what reading everything and filtering gives.

mod damaged;
#[path = "../common/program.rs"]
mod program;
mod written;

use std::path::{Path, PathBuf};

use breakline::data::{Bounds, PartRead, PointBatch, PointSource};
use breakline::error::Kind;
use breakline::io::las::{self as ours, Detail, ReadOptions};
use breakline::io::{OutputSet, points};
use breakline::run::{
    Context, Notice, PointsReport, PointsRequest, facts, read_points, write_points,
};
use program::run_in;
use testkit::copc::{Copc, INFO, Node, STEP, Tree, copc};
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

/// A hundredth of the area of a file with more than a thousand nodes is read with less than 5 % of
/// the bytes: the nodes that meet it, the hierarchy and the table of chunks, and what lies around
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
