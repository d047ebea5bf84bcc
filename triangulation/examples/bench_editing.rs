//! Measures building, querying and dismantling a triangulation one point at a time, with the
//! Delaunay hierarchy. Prints lines in the format of `bench_triangulation`, to compare with those
//! of `benches/cgal_editing.cpp`.
//!
//! ```text
//! bench_editing FILE.xy
//! ```
//!
//! The points (pairs of 64-bit little-endian floating-point numbers) are inserted in the order of
//! the file. The midpoints of consecutive points are located, and their nearest vertices found.
//! Then every second point is removed. The last number but one of a line counts triangles, or
//! points that were found.

#![allow(clippy::print_stdout, reason = "what it is for")]

use std::process::ExitCode;
use std::time::Instant;

use breakline_triangulation::geometry::Plane;
use breakline_triangulation::{Delaunay, Hierarchy, Locate, Location};

fn run(stem: &str, points: &[[f64; 2]]) -> Result<(), Box<dyn std::error::Error>> {
    let timed = |name: &str, start: Instant, done: usize| {
        let seconds = start.elapsed().as_secs_f64();
        println!("breakline_{name} {stem} {} 1 {seconds:.4} 0 0 {done} {seconds:.4}", points.len());
    };
    let (mut t, mut hierarchy) =
        (Delaunay::<Plane, 3>::new(Plane::default()), Hierarchy::<Plane, 3>::new(Plane::default()));
    let mut vertices = Vec::with_capacity(points.len());

    let start = Instant::now();
    for &p in points {
        vertices.push(t.insert_by(&mut hierarchy, p, ())?.vertex);
    }
    timed("insert", start, t.finite_cells().count());

    let middle = |pair: &[[f64; 2]]| [0, 1].map(|k| 0.5 * (pair[0][k] + pair[1][k]));
    let start = Instant::now();
    let is_inside = |location: &Location| !matches!(location, Location::OutsideHull { .. });
    let inside = points.windows(2).map(|pair| hierarchy.locate(&t, &middle(pair))).filter(is_inside).count();
    timed("locate", start, inside);

    let start = Instant::now();
    let nearest = points.windows(2).filter_map(|pair| {
        let q = middle(pair);
        t.nearest(&q, hierarchy.locate(&t, &q).cell(&t))
    });
    let nearest = nearest.count();
    timed("nearest", start, nearest);

    let start = Instant::now();
    for &vertex in vertices.iter().step_by(2) {
        t.remove_by(&mut hierarchy, vertex)?;
    }
    timed("remove", start, t.finite_cells().count());
    Ok(())
}

fn main() -> ExitCode {
    let path = std::env::args().nth(1).unwrap_or_default();
    let bytes = match std::fs::read(&path) {
        Ok(bytes) => bytes,
        Err(error) => {
            eprintln!("{path}: {error}");
            return ExitCode::FAILURE;
        }
    };
    let numbers: Vec<f64> = bytes.as_chunks::<8>().0.iter().map(|number| f64::from_le_bytes(*number)).collect();
    let stem = std::path::Path::new(&path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    match run(&stem, numbers.as_chunks::<2>().0) {
        Ok(()) => ExitCode::SUCCESS,
        Err(refused) => {
            eprintln!("{path}: {refused}");
            ExitCode::FAILURE
        }
    }
}
