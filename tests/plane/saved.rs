//! Triangulations through serde: what is read is what was saved, and damage is an error.

use std::collections::BTreeSet;

use crate::common::random::{Random, ulps};
use breakline::geometry::{Geometry, Plane, Weighted};
use breakline::tds::VertexId;
use breakline::triangulation::refine::Quality;
use breakline::triangulation::{
    Constrained, ConstrainedDelaunay, Delaunay, Level, LineId, OnCrossing, Regular, Triangulation,
};
use proptest::prelude::*;
use serde_json::Value;

/// The cells by their vertices, each from its smallest on.
fn cells<G: Geometry<3>, V, C: Copy + Default>(t: &Triangulation<G, 3, V, C>) -> BTreeSet<Vec<VertexId>> {
    let turned = |cell| {
        let mut vertices = t.tds().cell_vertices(cell).to_vec();
        let smallest = (0..vertices.len()).min_by_key(|&i| vertices[i]).unwrap_or(0);
        vertices.rotate_left(smallest);
        vertices
    };
    t.tds().cells().map(turned).collect()
}

fn through<T: serde::Serialize + serde::de::DeserializeOwned>(t: &T) -> T {
    serde_json::from_str(&serde_json::to_string(t).unwrap()).unwrap()
}

#[derive(Debug, Clone, Copy)]
enum Edit {
    Insert([i8; 2], i8),
    Remove(u8),
}

fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let insert = ([0i8..5, 0i8..5], 0i8..6).prop_map(|(place, weight)| Edit::Insert(place, weight));
    prop::collection::vec(prop_oneof![3 => insert, 1 => (0u8..12).prop_map(Edit::Remove)], 0..24)
}

fn place([x, y]: [i8; 2]) -> [f64; 2] {
    [f64::from(x), f64::from(y)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn delaunay_comes_back_and_goes_on_as_before(before in edits(), after in edits()) {
        let edit = |t: &mut Delaunay<Plane, 3, u8>, edits: &[Edit]| {
            for (k, edit) in edits.iter().enumerate() {
                match *edit {
                    Edit::Insert(p, _) => drop(t.insert_with(place(p), k as u8).unwrap()),
                    Edit::Remove(k) => drop(t.remove(VertexId::new(k.into()))),
                }
            }
        };
        let mut t = Delaunay::new(Plane::default());
        edit(&mut t, &before);
        let mut read = through(&t);
        for edits in [&[], &after[..]] {
            edit(&mut t, edits);
            edit(&mut read, edits);
            prop_assert_eq!(cells(&t), cells(&read));
            prop_assert_eq!(t.points(), read.points());
            for v in t.tds().vertices() {
                prop_assert_eq!(t.tds().vertex_data(v), read.tds().vertex_data(v));
            }
            prop_assert_eq!(read.check(Level::Law), []);
        }
    }

    #[test]
    fn regular_comes_back_with_what_it_hides(before in edits(), after in edits()) {
        let edit = |t: &mut Regular<Weighted>, edits: &[Edit]| {
            for edit in edits {
                match *edit {
                    Edit::Insert([x, y], w) => drop(t.insert([x.into(), y.into(), w.into()]).unwrap()),
                    Edit::Remove(k) => drop(t.remove(VertexId::new(k.into()))),
                }
            }
        };
        let mut t = Regular::new(Weighted::default());
        edit(&mut t, &before);
        let mut read = through(&t);
        for edits in [&[], &after[..]] {
            edit(&mut t, edits);
            edit(&mut read, edits);
            prop_assert_eq!(cells(&t), cells(&read));
            prop_assert!(t.hidden().eq(read.hidden()));
            prop_assert_eq!(read.check(Level::Law), []);
        }
    }

    #[test]
    fn constraints_come_back(
        points in prop::collection::vec([0i8..5, 0i8..5], 3..14),
        pairs in prop::collection::vec([0usize..14, 0..14], 0..8),
    ) {
        let mut t: Constrained<Plane> = Constrained::new(Plane::default());
        let vertices: Vec<_> = points.into_iter().map(|p| t.insert(place(p)).unwrap()).collect();
        for [a, b] in pairs {
            if let (Some(&a), Some(&b)) = (vertices.get(a), vertices.get(b)) {
                let _ = t.constrain(a, b);
            }
        }
        let read = through(&t);
        prop_assert_eq!(cells(&t), cells(&read));
        prop_assert_eq!(t.constrained_edges().collect::<BTreeSet<_>>(), read.constrained_edges().collect());
        prop_assert_eq!(read.check(Level::Law), []);
    }
}

/// Everything that differs from a value in one place: a number, an item that is missing, twice, or elsewhere.
fn damaged(value: &Value) -> Vec<Value> {
    let mut all = Vec::new();
    match value {
        Value::Array(items) => {
            for (k, item) in items.iter().enumerate() {
                let with = |replaced: Value| {
                    let mut items = items.clone();
                    items[k] = replaced;
                    Value::Array(items)
                };
                all.extend(damaged(item).into_iter().map(with));
                let mut fewer = items.clone();
                fewer.remove(k);
                all.push(Value::Array(fewer));
                let mut more = items.clone();
                more.insert(k, item.clone());
                all.push(Value::Array(more));
                let mut swapped = items.clone();
                swapped.swap(k, (k + 1) % items.len());
                all.push(Value::Array(swapped));
            }
        }
        Value::Object(fields) => {
            for (name, field) in fields {
                for replaced in damaged(field) {
                    let mut fields = fields.clone();
                    fields.insert(name.clone(), replaced);
                    all.push(Value::Object(fields));
                }
            }
        }
        Value::Number(number) if number.is_f64() => {
            all.extend([0.0, -1.0, -9.0, 0.5, 2.0, 3.5, 1e300, f64::MIN_POSITIVE].map(Value::from));
        }
        Value::Bool(is_so) => all.push(Value::Bool(!is_so)),
        _ => {
            all.extend((0..12).chain([255, i64::from(u32::MAX), -1]).map(Value::from));
            all.push(Value::Null);
        }
    }
    all
}

/// Reads everything that is damaged in one place; what is taken for sound must be, and stand edits.
fn read_damaged<T: serde::Serialize + serde::de::DeserializeOwned>(t: &T, is_sound: impl Fn(T) -> bool) {
    let saved = serde_json::to_value(t).unwrap();
    let mut errors = 0;
    for value in damaged(&saved) {
        match serde_json::from_value::<T>(value.clone()) {
            Ok(read) => assert!(is_sound(read), "{value}"),
            Err(_) => errors += 1,
        }
    }
    assert!(errors > 0);
}

const PLACES: [&[[f64; 2]]; 7] = [
    &[],
    &[[1.0, 2.0]],
    &[[0.0, 0.0], [1.0, 1.0]],
    &[[0.0, 0.0], [2.0, 2.0], [1.0, 1.0]],
    &[[0.0, 0.0], [2.0, 2.0], [1.0, 1.0], [3.0, 3.0]],
    &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
    &[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0], [0.0, 2.0], [2.0, 2.0]],
];

#[test]
fn damage_to_the_basic_and_delaunay_kinds_is_an_error() {
    for places in PLACES {
        let mut basic: Triangulation<Plane, 3, u8> = Triangulation::new(Plane::default());
        let mut delaunay: Delaunay<Plane, 3> = Delaunay::new(Plane::default());
        for &p in places {
            basic.insert_with(p, 7).unwrap();
            delaunay.insert(p).unwrap();
        }
        if places.len() > 2 {
            basic.remove(VertexId::new(1));
            delaunay.remove(VertexId::new(1));
        }
        read_damaged(&basic, |mut t| {
            let is_sound = t.check(Level::Law).is_empty();
            t.insert_with([0.25, 1.0], 1).unwrap();
            t.remove(VertexId::new(0));
            is_sound && t.check(Level::Law).is_empty()
        });
        read_damaged(&delaunay, |mut t| {
            let is_sound = t.check(Level::Law).is_empty();
            t.insert([0.25, 1.0]).unwrap();
            t.insert([1.25, 1.0]).unwrap();
            t.remove(VertexId::new(0));
            is_sound && t.check(Level::Law).is_empty()
        });
    }
}

#[test]
fn damage_to_regular_and_constrained_kinds_is_an_error() {
    for places in PLACES {
        let mut regular: Regular<Weighted> = Regular::new(Weighted::default());
        let mut constrained: Constrained<Plane> = Constrained::new(Plane::default());
        for (k, &[x, y]) in places.iter().enumerate() {
            regular.insert([x, y, if k % 3 == 1 { -4.0 } else { 0.0 }]).unwrap();
            constrained.insert([x, y]).unwrap();
        }
        let _ = constrained.constrain(VertexId::new(0), VertexId::new(places.len().saturating_sub(1)));
        read_damaged(&regular, |mut t| {
            // On a line a check looks for no law: the judge is a fresh build.
            let (fresh, _) = Regular::<Weighted>::from_points(Weighted::default(), t.points()).unwrap();
            let is_sound = t.check(Level::Law).is_empty() && t.vertex_count() == fresh.vertex_count();
            t.insert([0.25, 1.0, 0.5]).unwrap();
            t.remove(VertexId::new(0));
            is_sound && t.check(Level::Law).is_empty()
        });
        read_damaged(&constrained, |mut t| {
            let is_sound = t.check(Level::Law).is_empty();
            t.insert([0.25, 1.0]).unwrap();
            t.remove(VertexId::new(0));
            is_sound && t.check(Level::Law).is_empty()
        });
    }
}

/// All that can be seen of lines.
fn lines_of(t: &ConstrainedDelaunay<Plane>) -> impl PartialEq + std::fmt::Debug + use<> {
    let lines: Vec<LineId> = t.lines().collect();
    let ways: Vec<_> = lines.iter().map(|&line| (t.line_vertices(line).to_vec(), t.chain(line))).collect();
    let edges: BTreeSet<_> = t.constrained_edges().collect();
    let through: Vec<Vec<LineId>> = edges.iter().map(|&[a, b]| t.lines_through(a, b).collect()).collect();
    (lines, ways, edges, through, t.crossings().to_vec(), t.rounding())
}

/// What is saved beside the triangulation.
fn tables_of(t: &ConstrainedDelaunay<Plane>) -> Value {
    let mut saved = serde_json::to_value(t).unwrap();
    saved["triangulation"].take();
    saved
}

/// One of all edits that there are.
fn edit_lines(t: &mut ConstrainedDelaunay<Plane>, dice: &mut Random, place: &mut impl FnMut(&mut Random) -> [f64; 2]) {
    let line = LineId::new(dice.index(8));
    let vertex = VertexId::new(dice.index(t.points().len() + 2));
    match dice.below(10) {
        0..=2 => {
            let line: Vec<_> = (0..dice.index(4)).map(|_| place(dice)).collect();
            t.insert_lines(&[line, vec![place(dice), place(dice)]]).unwrap();
        }
        3 | 4 => drop(t.insert(place(dice)).unwrap()),
        5 => drop(t.remove_line(line)),
        6 => drop(t.split_line(line, dice.index(3))),
        7 => drop(t.join_lines(line, LineId::new(dice.index(8)))),
        8 => drop(t.remove(vertex)),
        _ => drop((t.remove_with_lines(vertex), t.simplify_line(line, 1.0))),
    }
}

/// Saves and reads again: both are equal, and stay equal under three edits. Returns which tables have anything in them.
fn comes_back(
    t: &ConstrainedDelaunay<Plane>,
    dice: &mut Random,
    place: &mut impl FnMut(&mut Random) -> [f64; 2],
) -> BTreeSet<String> {
    let (mut original, mut read) = (t.clone(), through(t));
    let seed = dice.below(u64::MAX);
    for t in [&mut original, &mut read] {
        let mut dice = Random(seed);
        (0..3).for_each(|_| edit_lines(t, &mut dice, place));
    }
    for (t, read) in [(t, &through(t)), (&original, &read)] {
        assert_eq!(cells(t), cells(read));
        assert_eq!(lines_of(t), lines_of(read));
        assert_eq!(t.points(), read.points());
        assert_eq!(tables_of(t), tables_of(read));
        assert_eq!(read.check(Level::Law), []);
    }
    let is_empty = |table: &Value| *table == Value::Null || *table == false || *table == Value::Array(Vec::new());
    let tables = tables_of(t);
    let used = tables.as_object().unwrap().iter().filter(|(_, table)| !is_empty(table));
    used.map(|(name, _)| name.clone()).collect()
}

/// The same after each of some edits.
fn lines_come_back(seed: u64, rounds: usize, mut place: impl FnMut(&mut Random) -> [f64; 2]) -> BTreeSet<String> {
    let mut dice = Random(seed);
    let mut used = BTreeSet::new();
    for _ in 0..rounds {
        let mut t: ConstrainedDelaunay<Plane> = ConstrainedDelaunay::new(Plane::default());
        for _ in 0..8 {
            edit_lines(&mut t, &mut dice, &mut place);
            assert_eq!(t.check(Level::Law), []);
            used.extend(comes_back(&t, &mut dice, &mut place));
        }
    }
    used
}

#[test]
fn lines_come_back_on_tiny_grids() {
    let used = lines_come_back(1, 150, |dice| [dice.below(5) as f64, dice.below(5) as f64]);
    assert!(used.iter().eq(["added", "led", "lent", "lines", "rounding", "splits", "waiting"]), "{used:?}");
}

#[test]
fn lines_come_back_that_bend() {
    lines_come_back(2, 60, |dice| [ulps(500_000.37, dice.around(3)), ulps(4_649_000.12, dice.around(3))]);
    let fine = |dice: &mut Random| ulps(0.5, dice.around(3)) * if dice.below(4) == 0 { 64.0 } else { 1.0 };
    lines_come_back(3, 60, |dice| [fine(dice), fine(dice)]);
    lines_come_back(4, 60, |dice| [dice.unit() - 0.5, dice.unit() - 0.5]);
}

/// Lines that cross again once their crossings have been rounded.
#[test]
fn lines_come_back_that_tangle() {
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
    let near = |dice: &mut Random| if dice.below(2) == 0 { low(dice.around(3)) } else { high(dice.around(3)) };
    let mut dice = Random(6);
    for _ in 0..40 {
        assert!(comes_back(&t, &mut dice, &mut |dice| [near(dice), near(dice)]).contains("was_tangled"));
    }
}

/// Vertices that refinement has put on constraints may lie beside them by a rounding.
#[test]
fn quality_meshes_come_back() {
    let mut dice = Random(5);
    for _ in 0..60 {
        let points: Vec<_> = (0..6).map(|_| [dice.unit(), dice.unit()]).collect();
        let lines = [[0, 1], [2, 3], [4, 5]];
        let (t, _) =
            ConstrainedDelaunay::<Plane>::from_lines(Plane::default(), &points, &lines, OnCrossing::Split).unwrap();
        let mesh = t.refined(&Quality::default());
        let t: &ConstrainedDelaunay<Plane> = &mesh;
        let read = through(t);
        assert_eq!(cells(t), cells(&read));
        assert_eq!(lines_of(t), lines_of(&read));
        assert_eq!(read.check(Level::Law), []);
    }
}

#[test]
fn damage_to_lines_is_an_error() {
    const CROSS: &[[f64; 2]] = &[[0.0, 0.0], [2.0, 2.0], [0.0, 2.0], [2.0, 0.0], [1.0, 0.0]];
    // They cross at a point of no grid that its coordinates have.
    const FAN: &[[f64; 2]] = &[[0.0, 0.0], [3.0, 1.0], [0.0, 1.0], [3.0, 0.0], [1.0, 0.0], [1.0, 2.0]];
    for places in [CROSS, FAN].into_iter().chain(PLACES) {
        let pair = |a: usize, b: usize| Some([*places.get(a)?, *places.get(b)?]);
        let lines: Vec<_> = [pair(0, 1), pair(2, 3), pair(0, 3), pair(4, 5)].into_iter().flatten().collect();
        let mut t: ConstrainedDelaunay<Plane> = ConstrainedDelaunay::new(Plane::default());
        for &p in places {
            t.insert(p).unwrap();
        }
        t.insert_lines(&lines).unwrap();
        t.remove_line(LineId::new(2));
        read_damaged(&t, |mut t| {
            let mut is_sound = t.check(Level::Law).is_empty();
            let _ = lines_of(&t);
            let (edited, mut dice) = (t.insert_lines(&[[[0.25, -1.0], [0.75, 3.0]]]).unwrap(), Random(7));
            is_sound &= t.check(Level::Law).is_empty() && edited.len() == 1;
            for _ in 0..6 {
                edit_lines(&mut t, &mut dice, &mut |dice| [dice.below(4) as f64, dice.below(4) as f64]);
                is_sound &= t.check(Level::Law).is_empty();
            }
            is_sound
        });
        // A field that is missing.
        let serde_json::Value::Object(fields) = serde_json::to_value(&t).unwrap() else { panic!() };
        for name in fields.keys() {
            let mut fewer = fields.clone();
            fewer.remove(name);
            let is_read = serde_json::from_value::<ConstrainedDelaunay<Plane>>(fewer.into()).is_ok();
            assert_eq!(is_read, name == "rounding", "{name}"); // what is optional counts as none
        }
    }
}
