//! Measures inserting lines into and removing them from a triangulation of 500 000 points, one by
//! one: microseconds for each, among 4 000 lines and among 400 000.
//!
//! ```text
//! bench_lines [POINTS [EDITS]]
//! ```
//!
//! The points are spread evenly, one to a square meter, far from zero. The lines that are there
//! first are 100 m and 1.5 m long, so that a new one, of 10 m, crosses about five to eight of them.
//! New lines come in spatial order.

#![allow(clippy::print_stdout, reason = "what it is for")]

use std::process::ExitCode;
use std::time::Instant;

use breakline_triangulation::geometry::Plane;
use breakline_triangulation::{ConstrainedDelaunay, InputError, LineId, OnCrossing, spatial_order};
use testkit::random::Random;

type Point = [f64; 2];

/// Returns a segment of some length in a random direction.
fn line(random: &mut Random, side: f64, length: f64) -> [Point; 2] {
    let [x, y] = [0; 2].map(|_| random.unit() * (side - 2.0 * length) + length);
    let (sin, cos) = (random.unit() * std::f64::consts::TAU).sin_cos();
    [
        [500_000.0 + x, 4_649_000.0 + y],
        [500_000.0 + x + length * cos, 4_649_000.0 + y + length * sin],
    ]
}

fn run(count: usize, edits: usize, lines: usize, length: f64) -> Result<(), InputError> {
    let mut random = Random(1);
    let side = (count as f64).sqrt();
    let mut points: Vec<Point> = (0..count)
        .map(|_| {
            [
                500_000.0 + side * random.unit(),
                4_649_000.0 + side * random.unit(),
            ]
        })
        .collect();
    let mut there: Vec<[u32; 2]> = Vec::with_capacity(lines);
    for _ in 0..lines {
        there.push([points.len() as u32, points.len() as u32 + 1]);
        points.extend(line(&mut random, side, length));
    }
    let start = Instant::now();
    let (mut t, _) = ConstrainedDelaunay::<_>::from_lines(
        <Plane>::default(),
        &points,
        &there,
        OnCrossing::Split,
    )?;
    println!(
        "{lines} lines: built in {:.2} s",
        start.elapsed().as_secs_f64()
    );

    let new: Vec<[Point; 2]> = (0..edits).map(|_| line(&mut random, side, 10.0)).collect();
    let order = spatial_order(new.len(), |i| new[i][0])?;
    let start = Instant::now();
    let first = t.insert_lines(&[new[order[0] as usize]])?;
    println!(
        "{lines} lines: first edit {:.1} ms",
        1e3 * start.elapsed().as_secs_f64()
    );
    t.remove_line(first[0]);

    let before = (t.crossings().len(), t.rearrangements());
    let mut ids: Vec<LineId> = Vec::with_capacity(edits);
    let start = Instant::now();
    for &i in &order {
        ids.extend(t.insert_lines(&[new[i as usize]])?);
    }
    let inserted = start.elapsed().as_secs_f64();
    let crossed = t.crossings().len() - before.0;
    let start = Instant::now();
    ids.into_iter().for_each(|line| _ = t.remove_line(line));
    let removed = start.elapsed().as_secs_f64();
    println!(
        "{lines} lines: {:.1} us to insert a line, which crosses {:.1}; {:.1} us to remove one; {} rearrangements",
        1e6 * inserted / edits as f64,
        crossed as f64 / edits as f64,
        1e6 * removed / edits as f64,
        t.rearrangements() - before.1,
    );
    Ok(())
}

fn main() -> ExitCode {
    let mut numbers = std::env::args()
        .skip(1)
        .map(|number| number.parse::<usize>());
    let count = numbers.next().and_then(Result::ok).unwrap_or(500_000);
    let edits = numbers.next().and_then(Result::ok).unwrap_or(10_000);
    match run(count, edits, 4_000, 100.0).and_then(|()| run(count, edits, 400_000, 1.5)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(refused) => {
            eprintln!("{refused}");
            ExitCode::FAILURE
        }
    }
}
