//! Heights between vertices, timed: one million pseudo-random points, one million positions in
//! raster order, on one thread.
//!
//! ```text
//! bench_interpolation [POINTS]
//! ```

#![allow(clippy::print_stdout, reason = "what it is for")]

use std::error::Error;
use std::time::Instant;

use breakline::data::{BlockSource, Frame, Window};
use breakline::terrain::{Dem, Method, TinBuilder};

/// Cells along a side of the raster.
const SIDE: usize = 1000;

fn main() -> Result<(), Box<dyn Error>> {
    let count = std::env::args()
        .nth(1)
        .map_or(Ok(1_000_000), |text| text.parse())?;
    let mut state = 1u64;
    let mut unit = || {
        // Knuth's multiplier; the high bits are random enough for positions.
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let points: Vec<[f64; 3]> = (0..count)
        .map(|_| {
            let (x, y) = (1000.0 * unit(), 1000.0 * unit());
            [x, y, 50.0 * (x / 90.0).sin() * (y / 70.0).cos()]
        })
        .collect();
    let mut builder = TinBuilder::default();
    builder.add_owned_points(points);
    let tin = builder.build()?;
    let frame = Frame::north_up(0.0, 1000.0, 1000.0 / SIDE as f64, SIDE, SIDE);
    for method in [
        Method::Linear,
        Method::Nearest,
        Method::Natural,
        Method::Laplace,
        Method::Smooth,
        Method::Idw,
    ] {
        let start = Instant::now();
        let dem = Dem::new(&tin, frame)?.with_method(method)?;
        let prepared = start.elapsed();
        let start = Instant::now();
        let mut sum = 0.0;
        // In blocks of the size that a GeoTIFF has.
        for row in (0..SIDE).step_by(256) {
            for column in (0..SIDE).step_by(256) {
                let window = Window {
                    column,
                    row,
                    width: 256.min(SIDE - column),
                    height: 256.min(SIDE - row),
                };
                let mut block = vec![0.0; window.width * window.height];
                dem.fill(window, &mut block)?;
                sum += block
                    .iter()
                    .filter(|z| !z.is_nan())
                    .map(|z| f64::from(*z))
                    .sum::<f64>();
            }
        }
        let each = start.elapsed().as_secs_f64() / (SIDE * SIDE) as f64 * 1e6;
        println!(
            "{method:?}: prepared in {:.2} s, {each:.3} us a cell, sum {sum:.3}",
            prepared.as_secs_f64()
        );
    }
    Ok(())
}
