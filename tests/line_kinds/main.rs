//! Surfaces with lines and areas of all kinds, against an exact judge of what each promises.
//!
//! The environment sets the number of sets of each selection of kinds:
//!
//! ```text
//! BREAKLINE_KINDS=100 cargo test --release --test line_kinds
//! ```

mod judge;
mod known;
mod scene;
mod walls;

use std::path::Path;

use breakline::data::{Mesh, Surface};
use breakline::io::mesh;
use breakline::terrain::CompactTin;
use rayon::prelude::*;
use scene::Scene;
use testkit::random::Random;

/// The number of selections of the seven kinds.
const SELECTIONS: u64 = 1 << 7;

fn count() -> u64 {
    std::env::var("BREAKLINE_KINDS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(4)
}

#[test]
fn each_kind_keeps_its_promises_whatever_it_meets() {
    let sets: Vec<(u64, u64)> = (1..SELECTIONS)
        .flat_map(|kinds| (0..count()).map(move |seed| (kinds, seed)))
        .collect();
    let judged = sets.par_iter().map(|&(kinds, seed)| {
        let scene = Scene::random(&mut Random(1000 * seed + kinds), kinds);
        judge::judge(&scene)
            .map_err(|what| format!("kinds {kinds:07b}, seed {seed}: {what}\n{scene:?}"))
    });
    let judged: Vec<Result<usize, String>> = judged.collect();
    let wrong: Vec<&String> = judged
        .iter()
        .filter_map(|judged| judged.as_ref().err())
        .collect();
    if let Some(first) = wrong.first() {
        let all: Vec<&str> = wrong
            .iter()
            .filter_map(|what| what.lines().next())
            .take(40)
            .collect();
        panic!(
            "{} of {} sets are wrong:\n{}\n{first}",
            wrong.len(),
            judged.len(),
            all.join("\n")
        );
    }
    let built = judged
        .iter()
        .filter(|judged| matches!(judged, Ok(1..)))
        .count();
    assert!(
        built as u64 > count() * SELECTIONS / 2,
        "{built} sets were built"
    );
}

/// The faces of a surface, with heights and kinds of edges, in an order of their own.
fn content(tin: &dyn Surface) -> Vec<String> {
    let faces = (0..tin.face_count() as u32).filter_map(|face| {
        tin.face(face)?;
        let mut corners: Vec<String> = (0..3)
            .map(|i| {
                format!(
                    "{:?} {:?}",
                    tin.triangle(face).map(|t| t[i].map(f64::to_bits)),
                    tin.edge_kind(face, i)
                )
            })
            .collect();
        corners.sort();
        Some(corners.concat())
    });
    let mut faces: Vec<String> = faces.collect();
    faces.sort();
    faces
}

/// A `.tin` and a `.ply` have the same faces with the same kinds of edges.
#[test]
fn files_keep_the_kinds() {
    let folder = tempfile::tempdir().unwrap();
    for kinds in (1..SELECTIONS).step_by(5) {
        let scene = Scene::random(&mut Random(500 + kinds), kinds);
        let Ok(tin) = scene.build(0) else { continue };
        let expected = content(&tin);
        let mut bytes = Vec::new();
        tin.write_tin(&mut bytes).unwrap();
        let opened = CompactTin::open(bytes, Path::new("x.tin")).unwrap();
        opened.check().unwrap();
        assert!(content(&opened) == expected, "kinds {kinds:07b} as .tin");
        let path = folder.path().join("x.ply");
        mesh::write(&path, &tin).unwrap();
        let read: Mesh = mesh::read(&path).unwrap();
        assert!(content(&read) == expected, "kinds {kinds:07b} as .ply");
    }
}

#[test]
fn the_order_of_the_input_changes_nothing() {
    let shuffles = if count() > 4 { 100 } else { 5 };
    let selections: Vec<u64> = (1..SELECTIONS).step_by(3).collect();
    selections.into_par_iter().for_each(|kinds| {
        let scene = Scene::random(&mut Random(77 + kinds), kinds);
        let Ok(first) = scene.build(0) else { return };
        let expected = content(&first);
        for order in 1..=shuffles {
            let again = scene
                .build(order)
                .unwrap_or_else(|error| panic!("{kinds:07b}, order {order}: {error}"));
            assert!(
                content(&again) == expected,
                "kinds {kinds:07b}, order {order}: {scene:?}"
            );
        }
    });
}
