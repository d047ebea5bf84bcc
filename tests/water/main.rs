//! Water that lines, walls and other water cross, against a judge of what is promised of it.
//!
//! The environment sets the number of scenes of each family:
//!
//! ```text
//! BREAKLINE_WATER=1500 cargo test --release --test water
//! ```
//!
//! `BREAKLINE_WATER_SEED=7` judges this seed of each family alone.

mod judge;
mod levels;
mod plane;
mod scene;

use judge::Counts;
use rayon::prelude::*;
use scene::{FAMILIES, Scene};
use testkit::random::Random;

fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|n| n.parse().ok())
}

fn seeds() -> std::ops::Range<u64> {
    match number("BREAKLINE_WATER_SEED") {
        Some(seed) => seed..seed + 1,
        None => 0..number("BREAKLINE_WATER").unwrap_or(6),
    }
}

/// Water has the heights that it is to have at every vertex, along banks, and in all cells of a
/// DEM.
#[test]
fn water_is_level_across_and_never_rises() {
    let mut wrong: Vec<String> = Vec::new();
    for &(name, draw) in FAMILIES {
        let judged = seeds().into_par_iter().map(|seed| {
            let scene = Scene::new(&mut Random(seed), draw);
            judge::judge(&scene).map_err(|what| format!("{name}, seed {seed}: {what}\n{scene:?}"))
        });
        let judged: Vec<Result<Counts, String>> = judged.collect();
        let counts = judged
            .iter()
            .flatten()
            .fold(Counts::default(), |sum, counts| sum.plus(*counts));
        let scenes = judged.iter().flatten().count();
        eprintln!(
            "{name}: {} of {} are wrong, {counts:?}",
            judged.len() - scenes,
            judged.len()
        );
        wrong.extend(judged.into_iter().filter_map(Result::err));
        if number("BREAKLINE_WATER_SEED").is_some() {
            continue;
        }
        let is_enough = counts.vertices >= 8 * scenes && counts.cells >= 15 * scenes;
        if !is_enough && counts.on_walls < 5 * scenes {
            wrong.push(format!("{name}: too little was judged"));
        }
        if counts.in_steps + counts.skipped > counts.all() / 8 {
            wrong.push(format!("{name}: too much was left out"));
        }
    }
    if let Some(first) = wrong.first() {
        let all: Vec<&str> = wrong
            .iter()
            .filter_map(|what| what.lines().next())
            .take(40)
            .collect();
        panic!(
            "{} scenes are wrong:\n{}\n{first}",
            wrong.len(),
            all.join("\n")
        );
    }
}
