//! The main road from points to products, in one process and without files: `cargo bench`.
//!
//! The points are made up, like airborne lidar: a rolling ground, two points to the square metre, in steps of a
//! centimetre, flight line by flight line. Whole programs, files included, are compared outside of the crate.

use breakline::data::{Bounds, Frame, Grid};
use breakline::terrain::{Dem, Levels, Tin, TinBuilder, contours};
use divan::{Bencher, black_box, counter::ItemsCount};

/// Number of points.
const SIZES: [usize; 2] = [100_000, 1_000_000];

fn main() {
    divan::main();
}

#[divan::bench(args = SIZES, max_time = 10)]
fn tin(bencher: Bencher, count: usize) {
    let points = points(count);
    bencher.counter(ItemsCount::new(count)).bench_local(|| build(black_box(&points)));
}

/// Cells of a metre.
#[divan::bench(args = SIZES, max_time = 10)]
fn dem(bencher: Bencher, count: usize) {
    let points = points(count);
    let mut bounds = Bounds::default();
    points[0].iter().zip(&points[1]).for_each(|(&x, &y)| bounds.add([x, y, 0.0]));
    let frame = Frame::snapped(&bounds, 1.0).expect("a metre divides the extent");
    let tin = build(&points);
    bencher.counter(ItemsCount::new(frame.width * frame.height)).bench_local(|| {
        let dem = Dem::new(black_box(&tin), frame).expect("the frame was made for the TIN");
        Grid::collect(&dem).expect("a raster of a TIN reads nothing")
    });
}

/// A metre apart.
#[divan::bench(args = SIZES, max_time = 10)]
fn contour(bencher: Bencher, count: usize) {
    let tin = build(&points(count));
    let levels = Levels::every(1.0, 0.0).expect("a metre is an interval");
    bencher
        .counter(ItemsCount::new(count))
        .bench_local(|| contours(black_box(&tin), &levels).expect("there are few levels").count());
}

/// Columns x, y and z.
type Points = [Vec<f64>; 3];

fn build([x, y, z]: &Points) -> Tin {
    let mut builder = TinBuilder::default();
    builder.add_points(x, y, z);
    builder.build().expect("made-up points have a TIN")
}

fn points(count: usize) -> Points {
    let side = (count as f64 / 2.0).sqrt();
    let mut seed = 1u64;
    let mut unit = || {
        // Knuth's MMIX generator; its high bits are random enough for this.
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let centimetres = |v: f64| (v * 100.0).round() / 100.0;
    let rows = side.sqrt().ceil().max(1.0) as usize * 8;
    let mut columns = [Vec::new(), Vec::new(), Vec::new()];
    for i in 0..count {
        let row = i * rows / count;
        let x = centimetres(side * unit());
        let y = centimetres(side * (row as f64 + unit()) / rows as f64);
        let z = centimetres(220.0 + 25.0 * (x / 310.0).sin() * (y / 270.0).cos() + 3.0 * ((x + y) / 31.0).sin());
        for (column, value) in columns.iter_mut().zip([500_000.0 + x, 5_400_000.0 + y, z]) {
            column.push(value);
        }
    }
    columns
}
