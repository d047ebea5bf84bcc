//! Surfaces cut by boundaries and bounds, against an exact judge that uses no triangulation.
//!
//! The environment sets the number of scenes of each kind:
//!
//! ```text
//! BREAKLINE_CUTS=2500 cargo test --release --test cuts
//! ```

mod found;
mod judge;
mod scene;

use rayon::prelude::*;
use scene::{KINDS, Scene};
use testkit::random::Random;

fn count() -> u64 {
    std::env::var("BREAKLINE_CUTS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(25)
}

/// Scenes with vertices of steep slivers a unit apart on both of their sides, or next to other
/// edges.
const HARD: [u64; 6] = [101, 138, 524, 536, 636, 689];

/// A few hundred sets of clip polygons over a surface with breaklines, on small integer grids and
/// in UTM.
#[test]
fn what_is_left_is_what_the_rings_enclose() {
    let judged = |(kind, seed): (usize, u64)| {
        let (name, draw) = KINDS[kind];
        scene::UNITS.map(|units| {
            let scene = Scene::new(&mut Random(1000 * seed + kind as u64), units, draw);
            judge::judge(&scene)
                .map_err(|what| format!("{name}, seed {seed}, in {units:?}: {what}\n{scene:?}"))
        })
    };
    let seeds: Vec<u64> = (0..count()).chain(HARD).collect();
    let sets: Vec<(usize, u64)> = (0..KINDS.len())
        .flat_map(|kind| seeds.iter().map(move |&seed| (kind, seed)))
        .collect();
    let judged: Vec<Result<usize, String>> =
        sets.into_par_iter().map(judged).flatten_iter().collect();
    let wrong: Vec<&String> = judged
        .iter()
        .filter_map(|judged| judged.as_ref().err())
        .collect();
    if let Some(first) = wrong.first() {
        let all: Vec<&str> = wrong
            .iter()
            .filter_map(|what| what.lines().next())
            .collect();
        panic!(
            "{} of {} sets are cut wrong:\n{}\n{first}",
            wrong.len(),
            judged.len(),
            all.join("\n")
        );
    }
    let cut = judged
        .iter()
        .filter(|judged| matches!(judged, Ok(1..)))
        .count();
    assert!(
        cut as u64 > count() * KINDS.len() as u64,
        "{cut} sets left something"
    );
}
