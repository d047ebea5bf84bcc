//! Scores the ground filter: `cargo run --release --features bench --example isprs -- [--maps
//! FOLDER] FILE...`, for files whose points of class 2 are the ground.
//!
//! Prints the share of ground that was lost (type I), of objects that were kept (type II), of all
//! that is wrong, and Cohen's kappa, in percent: for each file, and their means. A map shows ground
//! in green and objects in gray, lost ground in red, and objects that were kept in blue.

#![allow(clippy::print_stdout, reason = "what it is for")]

mod map;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use breakline::data::PointBatch;
use breakline::io::points;
use breakline::terrain::ground::{GroundOptions, PointClass, classify};

/// The class of the ground, by ASPRS.
const GROUND: u8 = 2;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args_os().skip(1).peekable();
    let maps = args
        .next_if(|arg| arg == "--maps")
        .and_then(|_| args.next())
        .map(PathBuf::from);
    let files: Vec<PathBuf> = args.map(PathBuf::from).collect();
    if files.is_empty() {
        return Err("usage: isprs [--maps FOLDER] FILE...".into());
    }
    println!("file              I     II  total  kappa   us/point");
    let mut sum = [0.0; 4];
    for file in &files {
        let (points, is_ground) = read(file)?;
        let start = Instant::now();
        let options = GroundOptions::default();
        let classes = classify(&points, &options, &AtomicBool::new(false))?;
        let each = start.elapsed().as_secs_f64() * 1e6 / points.len() as f64;
        let found: Vec<bool> = classes
            .iter()
            .map(|class| *class == PointClass::Ground)
            .collect();
        let scores = scores(&is_ground, &found);
        for (sum, score) in sum.iter_mut().zip(scores) {
            *sum += score;
        }
        let name = file.file_stem().unwrap_or_default().to_string_lossy();
        print(&name, scores, &format!("{each:10.2}"));
        if let Some(folder) = &maps {
            let target = folder.join(format!("{name}.png"));
            map::write(&target, &points, &is_ground, &found)?;
        }
    }
    print("mean", sum.map(|sum| sum / files.len() as f64), "");
    Ok(())
}

fn print(name: &str, [lost, kept, total, kappa]: [f64; 4], rest: &str) {
    println!("{name:12} {lost:6.2} {kept:6.2} {total:6.2} {kappa:6.2} {rest}");
}

/// Points, and which of them are ground.
type Sample = (Vec<[f64; 3]>, Vec<bool>);

fn read(file: &Path) -> Result<Sample, Box<dyn Error>> {
    let mut source = points::open(file)?;
    let (mut points, mut is_ground) = (Vec::new(), Vec::new());
    let mut batch = PointBatch::default();
    loop {
        source.read(&mut batch)?;
        if batch.is_empty() {
            return Ok((points, is_ground));
        }
        points.extend((0..batch.len()).map(|at| [batch.x[at], batch.y[at], batch.z[at]]));
        is_ground.extend((0..batch.len()).map(|at| batch.class.get(at) == Some(&GROUND)));
    }
}

/// Returns type I, type II, total error and kappa, in percent.
fn scores(is_ground: &[bool], found: &[bool]) -> [f64; 4] {
    let count = |ground: bool, called: bool| {
        let pairs = is_ground.iter().zip(found);
        pairs.filter(|pair| *pair == (&ground, &called)).count() as f64
    };
    let (kept, lost) = (count(true, true), count(true, false));
    let (wrong, right) = (count(false, true), count(false, false));
    let all = kept + lost + wrong + right;
    let total = (lost + wrong) / all;
    let by_chance = ((kept + lost) * (kept + wrong) + (wrong + right) * (lost + right)) / all / all;
    [
        lost / (kept + lost),
        wrong / (wrong + right),
        total,
        (1.0 - total - by_chance) / (1.0 - by_chance),
    ]
    .map(|share| 100.0 * share)
}
