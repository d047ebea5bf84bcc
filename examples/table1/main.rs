//! Arithmetic against point location: Table 1 of *Triangulations in CGAL* (Boissonnat, Devillers,
//! Pion, Teillaud and Yvinec 2002), with the paper's times beside ours.
//!
//! ```text
//! cargo run --release --features bench --example table1 -- [--points N] [FILE.laz | FILE.xy | FILE.xyz ...]
//! ```
//!
//! A row is a kernel, a column a strategy that finds where a point lies: points are inserted one by
//! one, in an order that looks random, the same in every run. What is printed are seconds; where
//! the paper has a time, that and how many times as long it is. A ratio says how far machines and
//! programs have come since, no more. The last row of a set is construction from all points at
//! once, on all threads, beside the fastest program of the paper.
//!
//! The points of the table are made. In the plane: 100 000 whole numbers in a square of 2^24; 120
//! 658 as airborne lidar leaves them on the ground, in scan lines and steps of a centimeter; 100
//! 000 almost on a parabola. In space: 100 000 whole numbers in a cube of 2^24; 145 300 on a
//! surface with bumps; 5 000 almost on the moment curve, which have two million cells. The paper's
//! terrain and object are different ones of the same size. A kernel that does not take the
//! coordinates has no times.
//!
//! Files, if there are any, take the place of these: LAS or LAZ, of which the ground is thinned
//! evenly to the number of the table's terrain, or pairs (triples) of coordinates, as little-endian
//! 64-bit floating point. `--points` takes some of the points only: exact arithmetic without a
//! filter takes long. The walk is that of `Near`: from the last insertion, and on from a nearer
//! vertex if it takes more than 64 steps. Under each kernel walks go by rounded numbers first; the
//! kernel is asked where these end.

#![allow(clippy::print_stdout, reason = "what it is for")]

mod points;
mod published;

use std::hint::black_box;
use std::io::Write;
use std::process::ExitCode;
use std::time::Instant;

use breakline::triangulation::geometry::{Coordinates, Plane, Space};
use breakline::triangulation::kernel::{
    Adaptive, Exact, Expansions, Fast, Fixed, Interval, Kernel,
};
use breakline::triangulation::{
    Delaunay, Delaunay2, Delaunay3, Hierarchy, JumpAndWalk, Locate, Near,
};
use points::PointSet;

/// A point of the plane or of space.
trait Point<const N: usize>: Copy + AsRef<[f64]> {
    type Geometry<K: Kernel>: Coordinates<N, Point = Self> + Default + Clone;
    type Hierarchy<K: Kernel>: Locate<Self::Geometry<K>, N>;

    fn hierarchy<K: Kernel>() -> Self::Hierarchy<K>;
}

impl Point<3> for [f64; 2] {
    type Geometry<K: Kernel> = Plane<K>;
    type Hierarchy<K: Kernel> = Hierarchy<Plane<K>, 3>;

    fn hierarchy<K: Kernel>() -> Self::Hierarchy<K> {
        Hierarchy::new(Plane::default())
    }
}

impl Point<4> for [f64; 3] {
    type Geometry<K: Kernel> = Space<K>;
    type Hierarchy<K: Kernel> = Hierarchy<Space<K>, 4>;

    fn hierarchy<K: Kernel>() -> Self::Hierarchy<K> {
        Hierarchy::new(Space::default())
    }
}

/// Seconds of the insertions, and cells.
fn time<P: Point<N>, const N: usize, K: Kernel>(
    points: &[P],
    mut strategy: impl Locate<P::Geometry<K>, N>,
) -> Result<(f64, usize), String> {
    let start = Instant::now();
    let mut delaunay: Delaunay<P::Geometry<K>, N> = Delaunay::new(P::Geometry::<K>::default());
    for &p in points {
        delaunay
            .insert_by(&mut strategy, p, ())
            .map_err(|refused| refused.to_string())?;
    }
    let seconds = start.elapsed().as_secs_f64();
    Ok((seconds, black_box(&delaunay).finite_cells().count()))
}

/// Prints seconds, with those of the paper and the ratio, if there are any.
fn print(seconds: f64, published: Option<f64>) -> Result<(), String> {
    let beside = published.map_or(String::new(), |paper| {
        format!("{paper} {:.0}x", paper / seconds)
    });
    print!("{seconds:>10.3} {beside:<13}");
    std::io::stdout().flush().map_err(|error| error.to_string())
}

const STRATEGIES: [&str; 3] = ["walk", "jump and walk", "hierarchy"];

/// One kernel under all strategies.
fn row<P: Point<N>, const N: usize, K: Kernel>(
    name: &str,
    filter: &str,
    set: &str,
    points: &[P],
) -> Result<(), String> {
    print!("{:<28}", format!("{filter} ({name})"));
    if !points
        .iter()
        .flat_map(|p| p.as_ref())
        .all(|&x| K::RANGE.admits(x))
    {
        println!(
            "{}",
            format!("{:>10} {:13}", "-", "").repeat(STRATEGIES.len())
        );
        return Ok(());
    }
    let column = |strategy: usize, result: Result<(f64, usize), String>| -> Result<usize, String> {
        let (seconds, cells) = result?;
        print(seconds, published::of_cgal(name, STRATEGIES[strategy], set))?;
        Ok(cells)
    };
    let cells = [
        column(0, time::<P, N, K>(points, Near::default()))?,
        column(1, time::<P, N, K>(points, JumpAndWalk))?,
        column(2, time::<P, N, K>(points, P::hierarchy::<K>()))?,
    ];
    println!("{:>11}", cells[0]);
    Ok(())
}

/// Prints all kernels for a set of points, then the time of `at_once`, which returns the number of
/// cells.
fn table<P: Point<N>, const N: usize>(
    set: &str,
    points: &[P],
    at_once: impl Fn() -> usize,
) -> Result<(), String> {
    println!("{set}, {} points", points.len());
    print!("{:<28}", "");
    STRATEGIES
        .iter()
        .for_each(|strategy| print!("{strategy:>10} {:<13}", "paper"));
    println!("{:>11}", "cells");
    row::<P, N, Fast>("Fast", "double", set, points)?;
    row::<P, N, Fixed>("Fixed", "static filter", set, points)?;
    row::<P, N, Adaptive>("Adaptive", "error bound", set, points)?;
    row::<P, N, Interval>("Interval", "interval filter", set, points)?;
    row::<P, N, Expansions>("Expansions", "no filter", set, points)?;
    row::<P, N, Exact>("Exact", "no filter", set, points)?;
    print!("{:<28}", "all points at once");
    let start = Instant::now();
    let cells = black_box(at_once());
    print(start.elapsed().as_secs_f64(), published::least(set))?;
    println!("{:>59}\n", cells);
    Ok(())
}

/// Returns the first points of a set, and the name by which the paper has them: none if it is not
/// the whole set.
fn part<const D: usize>(set: &PointSet<D>, count: usize) -> (String, &[[f64; D]]) {
    if count < set.points.len() {
        (format!("part of {}", set.name), &set.points[..count])
    } else {
        (set.name.clone(), &set.points)
    }
}

fn in_plane(set: &PointSet<2>, count: usize) -> Result<(), String> {
    let (name, points) = part(set, count);
    table(&name, points, || {
        Delaunay2::from_points(Plane::new(), points).map_or(0, |(t, _)| t.finite_cells().count())
    })
}

fn in_space(set: &PointSet<3>, count: usize) -> Result<(), String> {
    let (name, points) = part(set, count);
    table(&name, points, || {
        Delaunay3::from_points(Space::new(), points).map_or(0, |(t, _)| t.finite_cells().count())
    })
}

fn run() -> Result<(), String> {
    let mut count = usize::MAX;
    let mut files = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if argument == "--points" {
            let number = arguments.next().unwrap_or_default();
            count = number
                .parse()
                .map_err(|_| format!("--points {number}: a number is expected"))?;
        } else {
            files.push(argument);
        }
    }
    for path in &files {
        match path.rsplit('.').next() {
            Some("las" | "laz") => in_plane(
                &points::lidar(path).map_err(|error| error.to_string())?,
                count,
            )?,
            Some("xyz") => in_space(&points::read(path)?, count)?,
            _ => in_plane(&points::read(path)?, count)?,
        }
    }
    if files.is_empty() {
        [points::square(), points::terrain(), points::parabola()]
            .iter()
            .try_for_each(|set| in_plane(set, count))?;
        [points::cube(), points::object(), points::moment()]
            .iter()
            .try_for_each(|set| in_space(set, count))?;
    }
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
