//! Measures how the time for many long parallel or similar lines grows with their number.
//!
//! ```text
//! bench_bundles [--shape parallel|varied|fan|rings|crossed|random] [--check] [COUNT...]
//! ```
//!
//! For each of the four combinations of `from_lines` and `insert_lines` with the lines in order and
//! shuffled, prints the seconds for each count, and the slope of their logarithm over that of the
//! count, between the smallest and the largest. Default counts: 25000, 50000, 100000. `--check`
//! checks the triangulations.
//!
//! | shape | lines |
//! |---|---|
//! | `parallel` | from (0.1 i, 0) to (0.1 i + 1000, 1000) |
//! | `varied` | no two in the same direction, none of which cross |
//! | `fan` | from one point to points around it |
//! | `rings` | like contours around a peak, of 500 vertices each |
//! | `crossed` | like `parallel`, with three lines over all of them |
//! | `random` | in any direction, each crossing a few others |

#![allow(clippy::print_stdout, reason = "what it is for")]

use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

use breakline_triangulation::geometry::Plane;
use breakline_triangulation::{ConstrainedDelaunay, Level, OnCrossing};

type Line = Vec<[f64; 2]>;
type Build = fn(&[Line]) -> ConstrainedDelaunay<Plane>;

/// Pseudo-random numbers.
struct Random(u64);

impl Random {
    /// From 0 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, limit: usize) -> usize {
        (self.next() * limit as f64) as usize
    }
}

fn around(angle: f64, radius: f64) -> [f64; 2] {
    [radius * angle.cos(), radius * angle.sin()]
}

/// Generates about `count` segments; `None` for an unknown shape.
fn bundle(shape: &str, count: usize) -> Option<Vec<Line>> {
    let turn = std::f64::consts::TAU / count as f64;
    let from = |i: usize| [0.1 * i as f64, 0.0];
    let mut random = Random(1);
    Some(match shape {
        "parallel" => (0..count)
            .map(|i| vec![from(i), [from(i)[0] + 1000.0, 1000.0]])
            .collect(),
        "varied" => (0..count)
            .map(|i| vec![from(i), [1.3 * from(i)[0] + 1000.0, 1000.0]])
            .collect(),
        "fan" => (0..count)
            .map(|i| vec![[0.0; 2], around(i as f64 * turn, 1000.0)])
            .collect(),
        "rings" => {
            let vertex = |ring: usize, k: usize| {
                let angle = (k % 500) as f64 / 500.0 * std::f64::consts::TAU;
                around(angle, (ring + 1) as f64 * (5.0 + (3.0 * angle).sin()))
            };
            (0..count.div_ceil(500))
                .map(|ring| (0..=500).map(|k| vertex(ring, k)).collect())
                .collect()
        }
        "crossed" => {
            let length = from(count)[0] + 1000.0;
            let over =
                [0.25, 0.5, 0.75].map(|h| vec![[-1.0, 1000.0 * h], [length, 1000.0 * h + 1.0]]);
            bundle("parallel", count - 3)?
                .into_iter()
                .chain(over)
                .collect()
        }
        "random" => {
            let length = 2.0 / (count as f64).sqrt();
            let segment = |_| {
                let at = [random.next(), random.next()];
                let offset = around(random.next() * std::f64::consts::TAU, length);
                vec![at, [at[0] + offset[0], at[1] + offset[1]]]
            };
            (0..count).map(segment).collect()
        }
        _ => return None,
    })
}

fn shuffle(lines: &mut [Line]) {
    let mut random = Random(2);
    for i in (1..lines.len()).rev() {
        lines.swap(i, random.below(i + 1));
    }
}

fn from_lines(lines: &[Line]) -> ConstrainedDelaunay<Plane> {
    let points = lines.concat();
    let mut next = 0;
    let mut numbers = |line: &Line| {
        next += line.len() as u32;
        (next - line.len() as u32..next).collect::<Vec<u32>>()
    };
    let indexes: Vec<Vec<u32>> = lines.iter().map(&mut numbers).collect();
    let built =
        ConstrainedDelaunay::from_lines(Plane::default(), &points, &indexes, OnCrossing::Split);
    built.expect("the coordinates are finite").0
}

fn insert_lines(lines: &[Line]) -> ConstrainedDelaunay<Plane> {
    let mut triangulation = ConstrainedDelaunay::new(Plane::default());
    triangulation
        .insert_lines(lines)
        .expect("the coordinates are finite");
    triangulation
}

fn main() -> ExitCode {
    let (mut shape, mut is_checked, mut counts) = ("parallel".to_string(), false, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--shape" => shape = arguments.next().unwrap_or_default(),
            "--check" => is_checked = true,
            _ => counts.push(argument.parse().unwrap_or(0)),
        }
    }
    if counts.is_empty() {
        counts = vec![25_000, 50_000, 100_000];
    }
    if counts.contains(&0) || bundle(&shape, 8).is_none() {
        eprintln!(
            "usage: bench_bundles [--shape parallel|varied|fan|rings|crossed|random] [--check] [COUNT...]"
        );
        return ExitCode::FAILURE;
    }
    let builders: [(&str, Build); 2] = [("from_lines", from_lines), ("insert_lines", insert_lines)];
    for (builder, build) in builders {
        for is_shuffled in [false, true] {
            let mut times = Vec::new();
            for &count in &counts {
                let mut lines = bundle(&shape, count).unwrap_or_default();
                if is_shuffled {
                    shuffle(&mut lines);
                }
                let start = Instant::now();
                let built = black_box(build(&lines));
                times.push((count, start.elapsed().as_secs_f64()));
                if is_checked {
                    assert!(
                        built.check(Level::Law).is_empty(),
                        "{shape} {builder} {count}"
                    );
                }
            }
            let order = if is_shuffled { "shuffled" } else { "sorted" };
            print!("{shape} {builder} {order}:");
            times
                .iter()
                .for_each(|(count, seconds)| print!(" {count} {seconds:.3} s"));
            match times[..] {
                [(few, short), .., (many, long)] => {
                    println!(
                        ", slope {:.2}",
                        (long / short).ln() / (many as f64 / few as f64).ln()
                    );
                }
                _ => println!(),
            }
        }
    }
    ExitCode::SUCCESS
}
