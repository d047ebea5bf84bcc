//! Lines through serde: what is read behaves as before, and damage is an error.

use std::collections::BTreeSet;

use super::{SITES, read_damaged, through};
use breakline_triangulation::geometry::Plane;
use breakline_triangulation::refine::Quality;
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{ConstrainedDelaunay, Level, LineId, OnCrossing};
use serde_json::Value;
use testkit::cells::by_vertices;
use testkit::random::{Random, ulps};

/// Everything observable of lines.
fn lines_of(t: &ConstrainedDelaunay<Plane>) -> impl PartialEq + std::fmt::Debug + use<> {
    let lines: Vec<LineId> = t.lines().collect();
    let chains: Vec<_> = lines
        .iter()
        .map(|&line| (t.line_vertices(line).to_vec(), t.chain(line)))
        .collect();
    let edges: BTreeSet<_> = t.constrained_edges().collect();
    let through: Vec<Vec<LineId>> = edges
        .iter()
        .map(|&[a, b]| t.lines_through(a, b).collect())
        .collect();
    (
        lines,
        chains,
        edges,
        through,
        t.crossings().to_vec(),
        t.rounding(),
    )
}

/// What is saved in addition to the triangulation.
fn tables_of(t: &ConstrainedDelaunay<Plane>) -> Value {
    let mut saved = serde_json::to_value(t).unwrap();
    saved["triangulation"].take();
    saved
}

/// Makes one of all possible edits.
fn edit_lines(
    t: &mut ConstrainedDelaunay<Plane>,
    dice: &mut Random,
    site: &mut impl FnMut(&mut Random) -> [f64; 2],
) {
    let line = LineId::new(dice.index(8));
    let vertex = VertexId::new(dice.index(t.points().len() + 2));
    match dice.below(10) {
        0..=2 => {
            let line: Vec<_> = (0..dice.index(4)).map(|_| site(dice)).collect();
            t.insert_lines(&[line, vec![site(dice), site(dice)]])
                .unwrap();
        }
        3 | 4 => drop(t.insert(site(dice)).unwrap()),
        5 => drop(t.remove_line(line)),
        6 => drop(t.split_line(line, dice.index(3))),
        7 => drop(t.join_lines(line, LineId::new(dice.index(8)))),
        8 => drop(t.remove(vertex)),
        _ => drop((t.remove_with_lines(vertex), t.simplify_line(line, 1.0))),
    }
}

/// Saves and reads again: both are equal, and stay equal under three edits. Returns the names of
/// the tables that are not empty.
fn comes_back(
    t: &ConstrainedDelaunay<Plane>,
    dice: &mut Random,
    site: &mut impl FnMut(&mut Random) -> [f64; 2],
) -> BTreeSet<String> {
    let (mut original, mut read) = (t.clone(), through(t));
    let seed = dice.below(u64::MAX);
    for t in [&mut original, &mut read] {
        let mut dice = Random(seed);
        (0..3).for_each(|_| edit_lines(t, &mut dice, site));
    }
    for (t, read) in [(t, &through(t)), (&original, &read)] {
        assert_eq!(by_vertices(t), by_vertices(read));
        assert_eq!(lines_of(t), lines_of(read));
        assert_eq!(t.points(), read.points());
        assert_eq!(tables_of(t), tables_of(read));
        assert_eq!(read.check(Level::Law), []);
    }
    let is_empty = |table: &Value| {
        *table == Value::Null || *table == false || *table == Value::Array(Vec::new())
    };
    let tables = tables_of(t);
    let used = tables
        .as_object()
        .unwrap()
        .iter()
        .filter(|(_, table)| !is_empty(table));
    used.map(|(name, _)| name.clone()).collect()
}

/// Calls [`comes_back`] after each of some edits.
fn lines_come_back(
    seed: u64,
    rounds: usize,
    mut site: impl FnMut(&mut Random) -> [f64; 2],
) -> BTreeSet<String> {
    let mut dice = Random(seed);
    let mut used = BTreeSet::new();
    for _ in 0..rounds {
        let mut t: ConstrainedDelaunay<Plane> = ConstrainedDelaunay::new(Plane::default());
        for _ in 0..8 {
            edit_lines(&mut t, &mut dice, &mut site);
            assert_eq!(t.check(Level::Law), []);
            used.extend(comes_back(&t, &mut dice, &mut site));
        }
    }
    used
}

#[test]
fn lines_come_back_on_tiny_grids() {
    let used = lines_come_back(1, 150, |dice| [dice.below(5) as f64, dice.below(5) as f64]);
    assert!(
        used.iter().eq([
            "added", "bent", "lines", "owned", "rounding", "splits", "waiting"
        ]),
        "{used:?}"
    );
}

#[test]
fn lines_come_back_that_bend() {
    lines_come_back(2, 60, |dice| {
        [
            ulps(500_000.37, dice.around(3)),
            ulps(4_649_000.12, dice.around(3)),
        ]
    });
    let fine =
        |dice: &mut Random| ulps(0.5, dice.around(3)) * if dice.below(4) == 0 { 64.0 } else { 1.0 };
    lines_come_back(3, 60, |dice| [fine(dice), fine(dice)]);
    lines_come_back(4, 60, |dice| [dice.unit() - 0.5, dice.unit() - 0.5]);
}

/// Lines that cross again once their crossings have been rounded.
#[test]
fn lines_come_back_that_cross_again() {
    let (low, high) = (|n: i64| n as f64 * 2f64.powi(-53), |n: i64| ulps(1.0, n));
    let segments = [
        [[high(-3), low(0)], [low(3), high(-1)]],
        [[low(2), high(1)], [low(3), low(-2)]],
        [[low(0), high(-2)], [low(-2), high(2)]],
        [[high(0), low(-3)], [low(-1), high(2)]],
        [[high(-3), high(3)], [low(-2), low(3)]],
        [[high(-1), low(2)], [high(2), low(-1)]],
        [[low(2), low(2)], [high(-2), high(2)]],
        [[low(0), low(1)], [high(-3), low(-1)]],
    ];
    let mut t: ConstrainedDelaunay<Plane> = ConstrainedDelaunay::new(Plane::default());
    t.insert_lines(&segments).unwrap();
    let near = |dice: &mut Random| {
        if dice.below(2) == 0 {
            low(dice.around(3))
        } else {
            high(dice.around(3))
        }
    };
    let mut dice = Random(6);
    for _ in 0..40 {
        assert!(
            comes_back(&t, &mut dice, &mut |dice| [near(dice), near(dice)]).contains("recrossed")
        );
    }
}

/// Vertices that refinement has added on constraints may lie off them by a rounding.
#[test]
fn quality_meshes_come_back() {
    let mut dice = Random(5);
    for _ in 0..60 {
        let points: Vec<_> = (0..6).map(|_| [dice.unit(), dice.unit()]).collect();
        let lines = [[0, 1], [2, 3], [4, 5]];
        let (t, _) = ConstrainedDelaunay::<Plane>::from_lines(
            Plane::default(),
            &points,
            &lines,
            OnCrossing::Split,
        )
        .unwrap();
        let mesh = t.refined(&Quality::default());
        let t: &ConstrainedDelaunay<Plane> = &mesh;
        let read = through(t);
        assert_eq!(by_vertices(t), by_vertices(&read));
        assert_eq!(lines_of(t), lines_of(&read));
        assert_eq!(read.check(Level::Law), []);
    }
}

#[test]
fn damage_to_lines_is_an_error() {
    const CROSS: &[[f64; 2]] = &[[0.0, 0.0], [2.0, 2.0], [0.0, 2.0], [2.0, 0.0], [1.0, 0.0]];
    // They cross at a point of no grid that its coordinates have.
    const FAN: &[[f64; 2]] = &[
        [0.0, 0.0],
        [3.0, 1.0],
        [0.0, 1.0],
        [3.0, 0.0],
        [1.0, 0.0],
        [1.0, 2.0],
    ];
    for sites in [CROSS, FAN].into_iter().chain(SITES) {
        let pair = |a: usize, b: usize| Some([*sites.get(a)?, *sites.get(b)?]);
        let lines: Vec<_> = [pair(0, 1), pair(2, 3), pair(0, 3), pair(4, 5)]
            .into_iter()
            .flatten()
            .collect();
        let mut t: ConstrainedDelaunay<Plane> = ConstrainedDelaunay::new(Plane::default());
        for &p in sites {
            t.insert(p).unwrap();
        }
        t.insert_lines(&lines).unwrap();
        t.remove_line(LineId::new(2));
        read_damaged(&t, |mut t| {
            let mut is_sound = t.check(Level::Law).is_empty();
            let _ = lines_of(&t);
            let (edited, mut dice) = (
                t.insert_lines(&[[[0.25, -1.0], [0.75, 3.0]]]).unwrap(),
                Random(7),
            );
            is_sound &= t.check(Level::Law).is_empty() && edited.len() == 1;
            for _ in 0..6 {
                edit_lines(&mut t, &mut dice, &mut |dice| {
                    [dice.below(4) as f64, dice.below(4) as f64]
                });
                is_sound &= t.check(Level::Law).is_empty();
            }
            is_sound
        });
        // A missing field.
        let serde_json::Value::Object(fields) = serde_json::to_value(&t).unwrap() else {
            panic!()
        };
        for name in fields.keys() {
            let mut fewer = fields.clone();
            fewer.remove(name);
            let is_read =
                serde_json::from_value::<ConstrainedDelaunay<Plane>>(fewer.into()).is_ok();
            assert_eq!(is_read, name == "rounding", "{name}"); // what is optional counts as none
        }
    }
}
