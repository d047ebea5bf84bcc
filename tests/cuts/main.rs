//! Surfaces that are cut by boundaries and bounds, against an exact judge that knows no triangulation.
//!
//! Takes the number of sets of each kind from the environment:
//!
//! ```text
//! BREAKLINE_CUTS=2500 cargo test --release --test cuts
//! ```

#[path = "../common/mod.rs"]
mod common;
mod found;
mod judge;
mod scene;

use common::random::Random;
use scene::{KINDS, Scene};

fn count() -> u64 {
    std::env::var("BREAKLINE_CUTS").ok().and_then(|n| n.parse().ok()).unwrap_or(25)
}

/// Where vertices of steep slivers lie a unit apart on both of their sides.
const HARD: [u64; 2] = [101, 138];

/// A few hundred sets of clip polygons over a surface with breaklines, on small grids of whole numbers and in UTM.
#[test]
fn what_is_left_is_what_the_rings_enclose() {
    let mut cut = 0;
    for (kind, (name, draw)) in KINDS.iter().enumerate() {
        for seed in (0..count()).chain(HARD) {
            for units in scene::UNITS {
                let scene = Scene::new(&mut Random(1000 * seed + kind as u64), units, *draw);
                match judge::judge(&scene) {
                    Ok(faces) => cut += usize::from(faces > 0),
                    Err(what) => panic!("{name}, seed {seed}, in {units:?}: {what}\n{scene:?}"),
                }
            }
        }
    }
    assert!(cut as u64 > count() * KINDS.len() as u64, "{cut} sets left something");
}
