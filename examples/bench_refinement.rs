//! Quality meshes of Triangle's files, timed: to be put beside Triangle itself.
//!
//! ```text
//! bench_refinement FILE.poly [DEGREES [AREA]]
//! ```
//!
//! The best of 200 runs in one process, or of as many as a few seconds take, from coordinates in
//! memory to the finished mesh; 20.7 degrees and no bound on areas if nothing is said.

#![allow(clippy::print_stdout, reason = "what it is for")]

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use breakline::io::triangle;
use breakline::triangulation::geometry::Plane;
use breakline::triangulation::refine::{Domain, Quality};
use breakline::triangulation::{ConstrainedDelaunay, OnCrossing};

fn run(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    const RUNS: usize = 200;
    const ENOUGH: f64 = 3.0;
    let number =
        |k: usize, otherwise: f64| arguments.get(k).map_or(Ok(otherwise), |text| text.parse());
    let path = arguments
        .first()
        .ok_or("a file is expected: .poly or .node")?;
    let graph = triangle::read(Path::new(path))?;
    let lines: Vec<[u32; 2]> = graph.segments.iter().map(|segment| segment.ends).collect();
    let holes = graph.holes.iter().map(|hole| hole.at).collect();
    let domain = if lines.is_empty() {
        Domain::Hull { holes }
    } else {
        Domain::Enclosed { holes }
    };
    let quality = Quality {
        min_angle: number(1, 20.7)?,
        max_area: number(2, f64::INFINITY)?,
        domain,
        ..Quality::default()
    };

    let all = Instant::now();
    let mut best = [f64::INFINITY; 2];
    let mut counts = [0; 3];
    for _ in 0..RUNS {
        let start = Instant::now();
        let (t, _) = ConstrainedDelaunay::<Plane>::from_lines(
            Plane::default(),
            &graph.nodes.points,
            &lines,
            OnCrossing::Split,
        )?;
        let built = start.elapsed().as_secs_f64();
        let mesh = t.refined(&quality);
        let seconds = [start.elapsed().as_secs_f64(), built];
        best = [0, 1].map(|k| best[k].min(seconds[k]));
        counts = [
            mesh.vertex_count(),
            mesh.inside().count(),
            mesh.shortfall().len(),
        ];
        if all.elapsed().as_secs_f64() > ENOUGH {
            break;
        }
    }
    let [vertices, triangles, short] = counts;
    println!(
        "{path}: {} vertices, refined {vertices}, {triangles} triangles, {short} short of it",
        graph.nodes.points.len()
    );
    println!(
        "{:.1} us, {:.1} of it for the triangulation",
        best[0] * 1e6,
        best[1] * 1e6
    );
    Ok(())
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
