//! Arithmetic against point location: incremental insertion of points in random order, in the
//! manner of the table in *Triangulations in CGAL* (Boissonnat, Devillers, Pion, Teillaud and
//! Yvinec 2002).
//!
//! ```text
//! cargo run --release --example table1 -- [--points N] [FILE.laz | FILE.xy ...]
//! ```
//!
//! A row is a kernel, a column a strategy that finds where a point lies; what is printed are
//! seconds. The points of the table are made: 100 000 whole numbers in a square of 2^24; 120 658 as
//! airborne lidar leaves them on the ground, in scan lines and steps of a centimeter; 100 000
//! fractions on a parabola. They are inserted in an order that looks random, the same in every run;
//! a kernel that does not take the coordinates has no times. The times that the paper prints are
//! not beside them: no copy of it was at hand.
//!
//! Files, if there are any, take the place of these: LAS or LAZ, of which the ground is thinned
//! evenly to the number of the table's terrain, or pairs of coordinates, as little-endian 64-bit
//! floating point. `--points` takes some of the points only: exact arithmetic without a filter
//! takes long. The walk is that of `Near`: from the last insertion, and on from a nearer vertex if
//! it takes more than 64 steps. Under each kernel walks go by rounded numbers first; the kernel is
//! asked where these end.

#![allow(clippy::print_stdout, reason = "what it is for")]

use std::hint::black_box;
use std::io::Write;
use std::process::ExitCode;
use std::time::Instant;

use breakline::triangulation::geometry::Plane;
use breakline::triangulation::kernel::{Adaptive, Exact, Expansions, Fast, Fixed, Interval, Kernel};
use breakline::triangulation::{Delaunay, Hierarchy, JumpAndWalk, Locate, Near};
use breakline::{io, terrain};

/// Points of the table's terrain.
const TERRAIN: usize = 120_658;

/// splitmix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, (self.next() % (i as u64 + 1)) as usize);
        }
    }
}

struct PointSet {
    name: String,
    points: Vec<[f64; 2]>,
}

fn square() -> PointSet {
    let mut random = Random(1);
    let points = (0..100_000).map(|_| [(); 2].map(|()| (random.next() >> 40) as f64)).collect();
    PointSet { name: "square".into(), points }
}

fn parabola() -> PointSet {
    let mut random = Random(2);
    let mut unit = || (random.next() >> 11) as f64 / (1u64 << 53) as f64;
    let points = (0..100_000).map(|_| 2.0 * unit() - 1.0).map(|x| [x, x * x]).collect();
    PointSet { name: "parabola".into(), points }
}

/// Ground under a swinging mirror: 300 points to a line, half a meter apart, in centimeters.
fn terrain() -> PointSet {
    const LINE: usize = 300;
    let mut random = Random(4);
    let mut jitter = || (random.next() % 21) as f64 - 10.0;
    let mut points: Vec<[f64; 2]> = (0..TERRAIN)
        .map(|k| {
            let (line, along) = (k / LINE, k % LINE);
            let along = if line % 2 == 0 { along } else { LINE - 1 - along };
            [50 * along, 50 * line + 25 * along / LINE].map(|x| x as f64 + jitter())
        })
        .collect();
    random.shuffle(&mut points);
    PointSet { name: "terrain".into(), points }
}

/// The ground of a lidar tile, thinned.
fn lidar(path: &str) -> breakline::Result<PointSet> {
    let mut ground = terrain::Selection::default();
    ground.add_source(&mut *io::points::open(path)?)?;
    let (all, _) = ground.finish();
    let count = all.len().min(TERRAIN);
    let mut points: Vec<[f64; 2]> = (0..count).map(|k| all[k * all.len() / count]).map(|[x, y, _]| [x, y]).collect();
    Random(3).shuffle(&mut points);
    Ok(PointSet { name: path.into(), points })
}

fn read(path: &str) -> Result<PointSet, String> {
    if path.ends_with(".las") || path.ends_with(".laz") {
        return lidar(path).map_err(|error| error.to_string());
    }
    let bytes = std::fs::read(path).map_err(|error| format!("{path}: {error}"))?;
    let numbers: Vec<f64> = bytes.as_chunks::<8>().0.iter().map(|number| f64::from_le_bytes(*number)).collect();
    let mut points = numbers.as_chunks::<2>().0.to_vec();
    Random(3).shuffle(&mut points);
    Ok(PointSet { name: path.into(), points })
}

/// Seconds of the insertions, and triangles.
fn time<K: Kernel>(points: &[[f64; 2]], mut strategy: impl Locate<Plane<K>, 3>) -> Result<(f64, usize), String> {
    let start = Instant::now();
    let mut delaunay = Delaunay::new(Plane::<K>::default());
    for &p in points {
        delaunay.insert_by(&mut strategy, p, ()).map_err(|refused| refused.to_string())?;
    }
    let seconds = start.elapsed().as_secs_f64();
    Ok((seconds, black_box(&delaunay).finite_cells().count()))
}

const STRATEGIES: [&str; 3] = ["walk", "jump and walk", "hierarchy"];

/// One kernel under all strategies.
fn row<K: Kernel>(name: &str, points: &[[f64; 2]]) -> Result<(), String> {
    print!("{name:<28}");
    if !points.as_flattened().iter().all(|&x| K::RANGE.admits(x)) {
        println!("{}", format!("{:>15}", "-").repeat(STRATEGIES.len()));
        return Ok(());
    }
    let column = |result: Result<(f64, usize), String>| -> Result<usize, String> {
        let (seconds, triangles) = result?;
        print!("{seconds:>15.3}");
        std::io::stdout().flush().map_err(|error| error.to_string())?;
        Ok(triangles)
    };
    let triangles = [
        column(time::<K>(points, Near::default()))?,
        column(time::<K>(points, JumpAndWalk))?,
        column(time::<K>(points, Hierarchy::new(Plane::<K>::default())))?,
    ];
    println!("{:>12}", triangles[0]);
    Ok(())
}

fn table(PointSet { name, points }: &PointSet) -> Result<(), String> {
    println!("{name}, {} points", points.len());
    print!("{:<28}", "");
    STRATEGIES.iter().for_each(|strategy| print!("{strategy:>15}"));
    println!("{:>12}", "triangles");
    row::<Fast>("double (Fast)", points)?;
    row::<Fixed>("static filter (Fixed)", points)?;
    row::<Adaptive>("error bound (Adaptive)", points)?;
    row::<Interval>("interval filter (Interval)", points)?;
    row::<Expansions>("no filter (Expansions)", points)?;
    row::<Exact>("no filter (Exact)", points)?;
    println!();
    Ok(())
}

fn run() -> Result<(), String> {
    let mut count = usize::MAX;
    let mut sets = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if argument == "--points" {
            let number = arguments.next().unwrap_or_default();
            count = number.parse().map_err(|_| format!("--points {number}: a number is expected"))?;
        } else {
            sets.push(read(&argument)?);
        }
    }
    if sets.is_empty() {
        sets = vec![square(), terrain(), parabola()];
    }
    sets.iter_mut().for_each(|set| set.points.truncate(count));
    sets.iter().try_for_each(table)
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
