//! Measures one construction, and prints a line that can be compared with those of other programs.
//!
//! ```text
//! bench_triangulation FILE.xy [FILE.seg] [--threads N] [--one-by-one] [--check]
//! bench_triangulation FILE.xyz|FILE.xyzw [--threads N] [--one-by-one]
//! ```
//!
//! A file contains coordinates one after the other, little-endian 64-bit floating point: pairs
//! (`.xy`) to be triangulated in the plane, triples (`.xyz`) in space, or quadruples (`.xyzw`) with
//! weights. Segments (`.seg`) are pairs of 32-bit indices of points.
//!
//! The line consists of: program, data, points, threads, seconds, peak memory in MB and the part of
//! it that the construction added, triangles (or tetrahedra), and processor seconds. The time
//! includes the caller's indices, but not reading the file.
//!
//! `--one-by-one` inserts the points one after the other, in the order of the file. `--check`
//! checks the result, and counts the predicates that reached each stage of the arithmetic; both
//! take time, so that the line to compare is that of a build without.

#![allow(clippy::print_stdout, reason = "what it is for")]

use std::error::Error;
use std::hint::black_box;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::Instant;

use breakline_triangulation::geometry::{Plane, Space, WeightedSpace};
use breakline_triangulation::kernel::{
    Adaptive, ErrorBound, Expansions, Filter, Filtered, Kernel, OnFineLattice, OnLattice,
    Predicate, Range,
};
use breakline_triangulation::num::Sign;
use breakline_triangulation::{ConstrainedDelaunay, Delaunay, Level, OnCrossing, Regular};

/// The stages of [`Adaptive`] except the pairs of doubles; each counts its calls.
type Counting = Filtered<Counted<0, ErrorBound>, Filtered<Counted<1, OnLattice>, OnFineGrid>>;
type OnFineGrid = Filtered<Counted<2, OnFineLattice>, Counted<3, Expansions>>;

static ASKED: [AtomicU64; 4] = [const { AtomicU64::new(0) }; 4];

#[derive(Debug, Clone, Copy, Default)]
struct Counted<const STAGE: usize, K>(K);

impl<const STAGE: usize, K: Filter> Filter for Counted<STAGE, K> {
    const RANGE: Range = K::RANGE;

    fn try_sign<P: Predicate>(predicate: &P) -> Option<Sign> {
        ASKED[STAGE].fetch_add(1, Relaxed);
        K::try_sign(predicate)
    }
}

impl<const STAGE: usize, K: Kernel> Kernel for Counted<STAGE, K> {
    const RANGE: Range = K::RANGE;

    fn sign<P: Predicate>(predicate: &P) -> Sign {
        ASKED[STAGE].fetch_add(1, Relaxed);
        K::sign(predicate)
    }
}

struct Options {
    points: String,
    segments: Option<String>,
    threads: usize,
    one_by_one: bool,
    check: bool,
}

fn options() -> Result<Options, String> {
    let mut options = Options {
        points: String::new(),
        segments: None,
        threads: 1,
        one_by_one: false,
        check: false,
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--threads" => {
                let count = arguments.next().unwrap_or_default();
                options.threads = count
                    .parse()
                    .map_err(|_| format!("--threads {count}: a number is expected"))?;
            }
            "--one-by-one" => options.one_by_one = true,
            "--check" => options.check = true,
            _ if argument.ends_with(".seg") => options.segments = Some(argument),
            _ => options.points = argument,
        }
    }
    if options.points.is_empty() {
        return Err(
            "usage: bench_triangulation FILE.xy|FILE.xyz|FILE.xyzw [FILE.seg] [--threads N] [--one-by-one] [--check]"
                .into(),
        );
    }
    Ok(options)
}

fn read(path: &str) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|error| format!("{path}: {error}"))
}

fn points<const D: usize>(path: &str) -> Result<Vec<[f64; D]>, String> {
    let bytes = read(path)?;
    let numbers = bytes
        .as_chunks::<8>()
        .0
        .iter()
        .map(|number| f64::from_le_bytes(*number));
    let numbers: Vec<f64> = numbers.collect();
    Ok(numbers.as_chunks::<D>().0.to_vec())
}

fn segments(path: &str) -> Result<Vec<[u32; 2]>, String> {
    let bytes = read(path)?;
    let numbers: Vec<u32> = bytes
        .as_chunks::<4>()
        .0
        .iter()
        .map(|number| u32::from_le_bytes(*number))
        .collect();
    Ok(numbers.as_chunks::<2>().0.to_vec())
}

/// Returns a number of kilobytes from the system's account of this process, in MB; zero if there is
/// none.
fn memory(name: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(name));
    line.and_then(|rest| rest.split_whitespace().next()?.parse::<f64>().ok())
        .unwrap_or(0.0)
        / 1024.0
}

/// Returns the seconds that the threads of this process have run.
fn processor_seconds() -> f64 {
    let tasks = std::fs::read_dir("/proc/self/task")
        .into_iter()
        .flatten()
        .flatten();
    let of_task = |task: std::fs::DirEntry| {
        let stat = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        stat.split_whitespace().next()?.parse::<f64>().ok()
    };
    tasks.filter_map(of_task).sum::<f64>() * 1e-9
}

/// Measures a construction and prints its line, given a function that counts the cells.
fn time<T, E: std::fmt::Display>(
    options: &Options,
    count: usize,
    build: impl FnOnce() -> Result<T, E>,
    cells: impl Fn(&T) -> usize,
) -> Result<(), String> {
    // The peak so far does not count. Where it cannot be reset, nothing is lost.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
    let (before, processor, start) = (memory("VmRSS:"), processor_seconds(), Instant::now());
    let built = black_box(build().map_err(|refused| format!("{}: {refused}", options.points))?);
    let (seconds, processor) = (
        start.elapsed().as_secs_f64(),
        processor_seconds() - processor,
    );
    let peak = memory("VmHWM:");
    let stem = std::path::Path::new(&options.points)
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let data = if options.segments.is_some() {
        stem + "+seg"
    } else {
        stem
    };
    let program = if options.one_by_one {
        "breakline_one_by_one"
    } else {
        "breakline"
    };
    println!(
        "{program} {data} {count} {} {seconds:.4} {peak:.1} {:.1} {} {processor:.4}",
        options.threads,
        peak - before,
        cells(&built)
    );
    Ok(())
}

/// Reports the flaws of a triangulation, and how often each stage was called while it was built.
fn report(asked: [u64; 4], flaws: usize) -> Result<(), String> {
    let [all, lattice, fine, exact] = asked;
    eprintln!(
        "check: {flaws} flaws; asked of the kernel {all}, not certain by the error bound {lattice}, \
         nor as integers of 128 bits {fine}, nor of 256 {exact}"
    );
    if flaws == 0 {
        Ok(())
    } else {
        Err(format!("{flaws} flaws"))
    }
}

fn asked() -> [u64; 4] {
    [0, 1, 2, 3].map(|stage: usize| ASKED[stage].load(Relaxed))
}

/// A triangulation, and the number of points.
type Built<K> = (Delaunay<Plane<K>, 3>, usize);

fn plane<K: Kernel>(points: &[[f64; 2]], one_by_one: bool) -> Result<Built<K>, Box<dyn Error>> {
    if !one_by_one {
        let (t, vertices) = Delaunay::from_points(Plane::default(), points)?;
        return Ok((t, vertices.len()));
    }
    let mut t = Delaunay::new(Plane::default());
    for &p in points {
        t.insert(p)?;
    }
    Ok((t, points.len()))
}

fn space(points: &[[f64; 3]], one_by_one: bool) -> Result<Delaunay<Space, 4>, Box<dyn Error>> {
    let mut t = Delaunay::new(Space::new());
    if !one_by_one {
        return Ok(Delaunay::from_points(Space::new(), points)?.0);
    }
    for &p in points {
        t.insert(p)?;
    }
    Ok(t)
}

fn weighted(
    points: &[[f64; 4]],
    one_by_one: bool,
) -> Result<Regular<WeightedSpace, 4>, Box<dyn Error>> {
    let mut t = Regular::new(WeightedSpace::new());
    if !one_by_one {
        return Ok(Regular::from_points(WeightedSpace::new(), points)?.0);
    }
    for &p in points {
        t.insert(p)?;
    }
    Ok(t)
}

fn run(options: &Options) -> Result<(), String> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build_global();
    pool.map_err(|error| error.to_string())?;
    if options.points.ends_with(".xyz") {
        let points = points::<3>(&options.points)?;
        return time(
            options,
            points.len(),
            || space(&points, options.one_by_one),
            |t| t.finite_cells().count(),
        );
    }
    if options.points.ends_with(".xyzw") {
        let points = points::<4>(&options.points)?;
        return time(
            options,
            points.len(),
            || weighted(&points, options.one_by_one),
            |t| t.finite_cells().count(),
        );
    }
    let points = points::<2>(&options.points)?;
    let Some(path) = &options.segments else {
        if options.check {
            let (t, _) = plane::<Counting>(&points, options.one_by_one)
                .map_err(|refused| refused.to_string())?;
            let asked = asked();
            report(asked, t.check(Level::Law).len())?;
        }
        let build = || plane::<Adaptive>(&points, options.one_by_one);
        return time(options, points.len(), build, |(t, _)| {
            t.finite_cells().count()
        });
    };
    let segments = segments(path)?;
    if options.check {
        let built = ConstrainedDelaunay::<Plane<Counting>>::from_lines(
            Plane::default(),
            &points,
            &segments,
            OnCrossing::Split,
        );
        let (t, _) = built.map_err(|refused| refused.to_string())?;
        let asked = asked();
        report(asked, t.check(Level::Law).len())?;
    }
    let build = || {
        ConstrainedDelaunay::<Plane<Adaptive>>::from_lines(
            Plane::default(),
            &points,
            &segments,
            OnCrossing::Split,
        )
    };
    time(options, points.len(), build, |(t, _)| {
        t.finite_cells().count()
    })
}

fn main() -> ExitCode {
    match options().and_then(|options| run(&options)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
