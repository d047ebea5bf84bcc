//! What becomes of points, up to products, in one process: `cargo bench`. Run once, to see that it
//! runs: `cargo bench --bench products -- --test`.
//!
//! The points are made up. Whole programs, files included, are compared in `docs/performance.md`.

use std::path::Path;

use breakline::data::{Bounds, Frame, Grid, Stretch};
use breakline::io;
use breakline::terrain::{
    Dem, Levels, Locator, Method, Sampler, Selection, Tin, TinBuilder, contours,
};
use divan::{Bencher, black_box, counter::ItemsCount};
use rayon::prelude::*;

/// Number of points.
const SIZES: [usize; 2] = [100_000, 1_000_000];

/// How points lie in plan; two to the square metre.
#[derive(Debug, Clone, Copy)]
enum Lay {
    /// Like airborne lidar: in steps of a centimetre, flight line by flight line.
    Lidar,
    /// Anywhere, in no order.
    Random,
    /// On the crossings of a grid, row by row: every circle goes through four of them.
    Grid,
}

fn main() {
    divan::main();
}

#[divan::bench(args = [(Lay::Lidar, 100_000), (Lay::Random, 100_000), (Lay::Lidar, 1_000_000), (Lay::Random, 1_000_000), (Lay::Grid, 1_000_000)], max_time = 10)]
fn tin(bencher: Bencher, (lay, count): (Lay, usize)) {
    let points = points(lay, count);
    bencher
        .counter(ItemsCount::new(count))
        .bench_local(|| build(black_box(&points)));
}

/// From file to columns of ground points.
#[divan::bench(args = SIZES, max_time = 10)]
fn read_laz(bencher: Bencher, count: usize) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("points.laz");
    write_laz(&path, &points(Lay::Lidar, count));
    bencher.counter(ItemsCount::new(count)).bench_local(|| {
        let mut source = io::points::open(&path).expect("the file was just written");
        let mut selection = Selection::default();
        selection
            .add_source(&mut *source)
            .expect("the file is sound");
        selection.finish()
    });
}

#[divan::bench(args = SIZES, max_time = 10)]
fn write_ply(bencher: Bencher, count: usize) {
    let tin = build(&points(Lay::Lidar, count));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("mesh.ply");
    bencher.counter(ItemsCount::new(count)).bench_local(|| {
        io::mesh::write(&path, black_box(&tin)).expect("there is room for the file")
    });
}

/// Cells of a metre.
#[divan::bench(args = SIZES, max_time = 10)]
fn dem(bencher: Bencher, count: usize) {
    let points = points(Lay::Lidar, count);
    let mut bounds = Bounds::default();
    points[0]
        .iter()
        .zip(&points[1])
        .for_each(|(&x, &y)| bounds.add([x, y, 0.0]));
    let frame = Frame::snapped(&bounds, 1.0).expect("a metre divides the extent");
    let tin = build(&points);
    bencher
        .counter(ItemsCount::new(frame.width * frame.height))
        .bench_local(|| {
            let dem = Dem::new(black_box(&tin), frame).expect("the frame was made for the TIN");
            Grid::collect(&dem).expect("a raster of a TIN reads nothing")
        });
}

/// Heights and gradients of a TIN at as many positions as it has points, in rows and at random.
#[divan::bench(args = [(Lay::Grid, 1_000_000), (Lay::Random, 1_000_000)], max_time = 10)]
fn sample(bencher: Bencher, (lay, count): (Lay, usize)) {
    let tin = build(&points(Lay::Random, count));
    let [x, y, _] = points(lay, count);
    // Beside the vertices.
    let beside = |(x, y): (f64, f64)| [x + 0.1, y + 0.2];
    let positions: Vec<[f64; 2]> = x.into_iter().zip(y).map(beside).collect();
    let sampler = Sampler::new(&tin, Method::Linear).expect("nothing is prepared");
    bencher
        .counter(ItemsCount::new(count))
        .bench_local(|| sampler.samples(black_box(&positions)));
}

/// A metre apart.
#[divan::bench(args = SIZES, max_time = 10)]
fn contour(bencher: Bencher, count: usize) {
    let tin = build(&points(Lay::Lidar, count));
    let levels = Levels::every(1.0, 0.0).expect("a metre is an interval");
    bencher.counter(ItemsCount::new(count)).bench_local(|| {
        contours(black_box(&tin), &levels)
            .expect("there are few levels")
            .count()
    });
}

/// Columns x, y and z.
type Points = [Vec<f64>; 3];

/// The number of lines of a kilometer that are followed.
const LINES: usize = 10_000;

/// Lines over 5 million triangles, with a point at every edge; the locator is prepared each time.
#[divan::bench(sample_count = 5)]
fn profile(bencher: Bencher) {
    let points = points(Lay::Lidar, 2_500_000);
    let tin = build(&points);
    let ends = [0, 1].map(|k| {
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        let wider = |[low, high]: [f64; 2], c: &f64| [low.min(*c), high.max(*c)];
        points[k].iter().fold(ends, wider)
    });
    // By the golden ratio, so that they are everywhere and in all directions.
    let part = |number: usize, step: f64| (number as f64 * step).fract();
    let lines: Vec<[[f64; 2]; 2]> = (0..LINES)
        .map(|number| {
            let angle = std::f64::consts::TAU * part(number, 0.618_033_988_749_895);
            let half = [angle.cos(), angle.sin()].map(|c| 500.0 * c);
            let steps = [0.754_877_666, 0.569_840_29];
            let middle = [0, 1].map(|k| {
                let [low, high] = ends[k];
                let room = (high - low - 1000.0).max(0.0);
                (low + high) / 2.0 + room * (part(number, steps[k]) - 0.5)
            });
            [1.0, -1.0].map(|sign| [0, 1].map(|k| middle[k] + sign * half[k]))
        })
        .collect();
    bencher.counter(ItemsCount::new(LINES)).bench_local(|| {
        let locator = Locator::new(black_box(&tin)).expect("a TIN in memory is sound");
        let found: Vec<Vec<Stretch>> = lines
            .par_iter()
            .map(|line| locator.along(line).expect("coordinates are finite"))
            .collect();
        found
    });
}

fn build([x, y, z]: &Points) -> Tin {
    let mut builder = TinBuilder::default();
    builder.add_points(x, y, z);
    builder.build().expect("made-up points have a TIN")
}

fn points(lay: Lay, count: usize) -> Points {
    let side = (count as f64 / 2.0).sqrt();
    let mut seed = 1u64;
    let mut unit = || {
        // Knuth's MMIX generator; its high bits are random enough for this.
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let centimetres = |v: f64| (v * 100.0).round() / 100.0;
    let rows = side.sqrt().ceil().max(1.0) as usize * 8;
    let columns = (count as f64).sqrt().ceil() as usize;
    let mut points = [Vec::new(), Vec::new(), Vec::new()];
    for i in 0..count {
        let [x, y] = match lay {
            Lay::Lidar => {
                let row = i * rows / count;
                [side * unit(), side * (row as f64 + unit()) / rows as f64].map(centimetres)
            }
            Lay::Random => [side * unit(), side * unit()],
            Lay::Grid => [i % columns, i / columns].map(|k| centimetres(k as f64 * 0.71)),
        };
        let z = centimetres(
            220.0 + 25.0 * (x / 310.0).sin() * (y / 270.0).cos() + 3.0 * ((x + y) / 31.0).sin(),
        );
        for (column, value) in points.iter_mut().zip([500_000.0 + x, 5_400_000.0 + y, z]) {
            column.push(value);
        }
    }
    points
}

/// LAZ as it is delivered: LAS 1.4, point format 6, ground, steps of a centimetre.
fn write_laz(path: &Path, [x, y, z]: &Points) {
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(6).expect("there is a format 6");
    builder.point_format.is_compressed = true;
    let axis = |offset| las::Transform {
        scale: 0.01,
        offset,
    };
    builder.transforms = las::Vector {
        x: axis(500_000.0),
        y: axis(5_400_000.0),
        z: axis(0.0),
    };
    let header = builder.into_header().expect("the header is sound");
    let mut writer = las::Writer::from_path(path, header).expect("there is room for the file");
    for i in 0..x.len() {
        let point = las::Point {
            x: x[i],
            y: y[i],
            z: z[i],
            classification: las::point::Classification::Ground,
            return_number: 1,
            number_of_returns: 1,
            gps_time: Some(i as f64 * 2e-6),
            ..Default::default()
        };
        writer
            .write_point(point)
            .expect("the point fits the format");
    }
    writer.close().expect("the file can be ended");
}
