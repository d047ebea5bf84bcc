//! Measures building, querying and dismantling a triangulation one point at a time, with the
//! Delaunay hierarchy. Prints lines in the format of `bench_triangulation`, to compare with those
//! of `benches/cgal_editing.cpp`.
//!
//! ```text
//! bench_editing FILE.xy|FILE.xyz
//! ```
//!
//! The points (pairs or triples of 64-bit little-endian floating-point numbers) are inserted in the
//! order of the file. The midpoints of consecutive points are located, and their nearest vertices
//! found. Then every second point is removed. In a regular triangulation of one cell around them,
//! all points are inserted, too light to be seen, and removed. In space, the alpha shapes of the
//! points, for all alphas, are built from their Delaunay triangulation. The last number but one of
//! a line counts cells, alphas, or points that were found.

#![allow(clippy::print_stdout, reason = "what it is for")]

use std::process::ExitCode;
use std::time::Instant;

use breakline_triangulation::geometry::{Plane, Space, Weighted, WeightedSpace};
use breakline_triangulation::{Delaunay, Hierarchy, Locate, Location, Regular};

/// A function that measures in a geometry. A generic one would have to repeat what the
/// triangulations ask of it.
macro_rules! in_geometry {
    ($name:ident, $geometry:ty, $weighted:ty, $dimension:literal, $vertices_of_a_cell:literal) => {
        fn $name(
            stem: &str,
            points: &[[f64; $dimension]],
        ) -> Result<(), Box<dyn std::error::Error>> {
            let timed = |name: &str, start: Instant, done: usize| {
                let seconds = start.elapsed().as_secs_f64();
                println!(
                    "breakline_{name} {stem} {} 1 {seconds:.4} 0 0 {done} {seconds:.4}",
                    points.len()
                );
            };
            let mut t = Delaunay::<$geometry, $vertices_of_a_cell>::new(<$geometry>::default());
            let mut hierarchy =
                Hierarchy::<$geometry, $vertices_of_a_cell>::new(<$geometry>::default());
            let mut vertices = Vec::with_capacity(points.len());

            let start = Instant::now();
            for &p in points {
                vertices.push(t.insert_by(&mut hierarchy, p, ())?.vertex);
            }
            timed("insert", start, t.finite_cells().count());

            let middle = |pair: &[[f64; $dimension]]| {
                std::array::from_fn(|k| 0.5 * (pair[0][k] + pair[1][k]))
            };
            let start = Instant::now();
            let is_inside = |location: &Location| !matches!(location, Location::OutsideHull { .. });
            let inside = points
                .windows(2)
                .map(|pair| hierarchy.locate(&t, &middle(pair)))
                .filter(is_inside)
                .count();
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

            // All points under one cell around them, too light to be seen.
            let numbers = || points.iter().flatten().copied();
            let (low, high) = (
                numbers().fold(f64::MAX, f64::min),
                numbers().fold(f64::MIN, f64::max),
            );
            let span = high - low + 1.0;
            let mut corners = [[low - span; $dimension + 1]; $vertices_of_a_cell];
            (0..$dimension).for_each(|k| corners[k + 1][k] += 4.0 * f64::from($dimension) * span);
            corners
                .iter_mut()
                .for_each(|corner| corner[$dimension] = 0.0);
            let light = |p: &[f64; $dimension]| {
                let mut light = [-100.0 * span * span; $dimension + 1];
                light[..$dimension].copy_from_slice(p);
                light
            };
            let (mut t, _) = Regular::<$weighted, $vertices_of_a_cell>::from_points(
                <$weighted>::default(),
                &corners,
            )?;
            let start = Instant::now();
            let hidden = points
                .iter()
                .map(|p| t.insert(light(p)))
                .collect::<Result<Vec<_>, _>>()?;
            timed("hide", start, hidden.len());

            let start = Instant::now();
            for &vertex in &hidden {
                t.remove(vertex)?;
            }
            timed("remove_hidden", start, hidden.len());
            Ok(())
        }
    };
}

in_geometry!(in_plane, Plane, Weighted, 2, 3);
in_geometry!(in_space, Space, WeightedSpace, 3, 4);

fn alpha_shapes(stem: &str, points: &[[f64; 3]]) -> Result<(), Box<dyn std::error::Error>> {
    let (t, _) = Delaunay::<Space, 4>::from_points(Space::default(), points)?;
    let start = Instant::now();
    let alphas = t.alpha_shapes().alphas().len();
    let seconds = start.elapsed().as_secs_f64();
    let count = points.len();
    println!("breakline_alpha {stem} {count} 1 {seconds:.4} 0 0 {alphas} {seconds:.4}");
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
    let numbers: Vec<f64> = bytes
        .as_chunks::<8>()
        .0
        .iter()
        .map(|number| f64::from_le_bytes(*number))
        .collect();
    let stem = std::path::Path::new(&path)
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let done = if path.ends_with(".xyz") {
        let points = numbers.as_chunks::<3>().0;
        in_space(&stem, points).and_then(|()| alpha_shapes(&stem, points))
    } else {
        in_plane(&stem, numbers.as_chunks::<2>().0)
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(refused) => {
            eprintln!("{path}: {refused}");
            ExitCode::FAILURE
        }
    }
}
