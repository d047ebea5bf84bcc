//! Triangulations through serde: what is read is what was saved, and damage is an error.

mod lines;
mod space;

use std::collections::{BTreeMap, BTreeSet};

use breakline_triangulation::geometry::{Plane, Weighted};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{
    Basic, Constrained, ConstrainedDelaunay, Delaunay, Level, OnCrossing, Regular,
};
use proptest::prelude::*;
use serde_json::Value;
use testkit::cells::{by_vertices, vertices};

fn through<T: serde::Serialize + serde::de::DeserializeOwned>(t: &T) -> T {
    serde_json::from_str(&serde_json::to_string(t).unwrap()).unwrap()
}

#[derive(Debug, Clone, Copy)]
enum Edit {
    Insert([i8; 2], i8),
    Remove(u8),
}

fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let insert = ([0i8..5, 0i8..5], 0i8..6).prop_map(|(site, weight)| Edit::Insert(site, weight));
    prop::collection::vec(
        prop_oneof![3 => insert, 1 => (0u8..12).prop_map(Edit::Remove)],
        0..24,
    )
}

fn site([x, y]: [i8; 2]) -> [f64; 2] {
    [f64::from(x), f64::from(y)]
}

/// Edits a triangulation, saves and reads it, and requires the same answers of both, at once and
/// after more edits.
fn goes_on_as_before<T: serde::Serialize + serde::de::DeserializeOwned, E: Copy>(
    mut t: T,
    before: &[E],
    after: &[E],
    edit: impl Fn(&mut T, usize, E),
    same: impl Fn(&T, &T) -> Result<(), TestCaseError>,
) -> Result<(), TestCaseError> {
    let edit_all = |t: &mut T, edits: &[E]| {
        edits
            .iter()
            .enumerate()
            .for_each(|(k, &what)| edit(t, k, what))
    };
    edit_all(&mut t, before);
    let mut read = through(&t);
    for edits in [&[], after] {
        edit_all(&mut t, edits);
        edit_all(&mut read, edits);
        same(&t, &read)?;
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn delaunay_comes_back_and_goes_on_as_before(before in edits(), after in edits()) {
        let edit = |t: &mut Delaunay<Plane, 3, u8>, k: usize, edit| match edit {
            Edit::Insert(p, _) => drop(t.insert_with(site(p), k as u8).unwrap()),
            Edit::Remove(k) => drop(t.remove(VertexId::new(k.into()))),
        };
        goes_on_as_before(Delaunay::new(Plane::default()), &before, &after, edit, |t, read| {
            prop_assert_eq!(by_vertices(t), by_vertices(read));
            prop_assert_eq!(t.points(), read.points());
            for v in t.tds().vertices() {
                prop_assert_eq!(t.tds().vertex_data(v), read.tds().vertex_data(v));
            }
            prop_assert_eq!(read.check(Level::Law), []);
            Ok(())
        })?;
    }

    #[test]
    fn regular_comes_back_with_what_it_hides(before in edits(), after in edits()) {
        let edit = |t: &mut Regular<Weighted, 3>, _, edit| match edit {
            Edit::Insert([x, y], w) => drop(t.insert([x.into(), y.into(), w.into()]).unwrap()),
            Edit::Remove(k) => drop(t.remove(VertexId::new(k.into()))),
        };
        goes_on_as_before(Regular::new(Weighted::default()), &before, &after, edit, |t, read| {
            prop_assert_eq!(by_vertices(t), by_vertices(read));
            prop_assert!(t.hidden().eq(read.hidden()));
            prop_assert_eq!(read.check(Level::Law), []);
            Ok(())
        })?;
    }

    #[test]
    fn constraints_come_back(
        points in prop::collection::vec([0i8..5, 0i8..5], 3..14),
        pairs in prop::collection::vec([0usize..14, 0..14], 0..8),
    ) {
        let mut t: Constrained<Plane> = Constrained::new(Plane::default());
        let vertices: Vec<_> = points.into_iter().map(|p| t.insert(site(p)).unwrap()).collect();
        for [a, b] in pairs {
            if let (Some(&a), Some(&b)) = (vertices.get(a), vertices.get(b)) {
                let _ = t.constrain(a, b);
            }
        }
        let read = through(&t);
        prop_assert_eq!(by_vertices(&t), by_vertices(&read));
        prop_assert_eq!(t.constrained_edges().collect::<BTreeSet<_>>(), read.constrained_edges().collect());
        prop_assert_eq!(read.check(Level::Law), []);
    }
}

/// Returns everything that differs from a value in one entry: a number changed, an item missing,
/// duplicated, or moved.
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
            all.extend(
                (0..12)
                    .chain([255, i64::from(u32::MAX), -1])
                    .map(Value::from),
            );
            all.push(Value::Null);
        }
    }
    all
}

/// Reads everything that is damaged in one entry; whatever is accepted must be sound, and survive
/// edits.
fn read_damaged<T: serde::Serialize + serde::de::DeserializeOwned>(
    t: &T,
    is_sound: impl Fn(T) -> bool,
) {
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

const SITES: [&[[f64; 2]]; 7] = [
    &[],
    &[[1.0, 2.0]],
    &[[0.0, 0.0], [1.0, 1.0]],
    &[[0.0, 0.0], [2.0, 2.0], [1.0, 1.0]],
    &[[0.0, 0.0], [2.0, 2.0], [1.0, 1.0], [3.0, 3.0]],
    &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
    &[
        [0.0, 0.0],
        [1.0, 0.0],
        [2.0, 0.0],
        [0.0, 1.0],
        [1.0, 1.0],
        [2.0, 1.0],
        [0.0, 2.0],
        [2.0, 2.0],
    ],
];

#[test]
fn damage_to_the_basic_and_delaunay_kinds_is_an_error() {
    for sites in SITES {
        let mut basic: Basic<Plane, 3, u8> = Basic::new(Plane::default());
        let mut delaunay: Delaunay<Plane, 3> = Delaunay::new(Plane::default());
        for &p in sites {
            basic.insert_with(p, 7).unwrap();
            delaunay.insert(p).unwrap();
        }
        if sites.len() > 2 {
            let _ = basic.remove(VertexId::new(1));
            let _ = delaunay.remove(VertexId::new(1));
        }
        read_damaged(&basic, |mut t| {
            let is_sound = t.check(Level::Law).is_empty();
            t.insert_with([0.25, 1.0], 1).unwrap();
            let _ = t.remove(VertexId::new(0));
            is_sound && t.check(Level::Law).is_empty()
        });
        read_damaged(&delaunay, |mut t| {
            let is_sound = t.check(Level::Law).is_empty();
            t.insert([0.25, 1.0]).unwrap();
            t.insert([1.25, 1.0]).unwrap();
            let _ = t.remove(VertexId::new(0));
            is_sound && t.check(Level::Law).is_empty()
        });
    }
}

#[test]
fn damage_to_regular_and_constrained_kinds_is_an_error() {
    for sites in SITES {
        let mut regular: Regular<Weighted, 3> = Regular::new(Weighted::default());
        let mut constrained: Constrained<Plane> = Constrained::new(Plane::default());
        for (k, &[x, y]) in sites.iter().enumerate() {
            regular
                .insert([x, y, if k % 3 == 1 { -4.0 } else { 0.0 }])
                .unwrap();
            constrained.insert([x, y]).unwrap();
        }
        let _ = constrained.constrain(
            VertexId::new(0),
            VertexId::new(sites.len().saturating_sub(1)),
        );
        read_damaged(&regular, |mut t| {
            let (fresh, _) =
                Regular::<Weighted, 3>::from_points(Weighted::default(), t.points()).unwrap();
            let is_sound =
                t.check(Level::Law).is_empty() && t.vertex_count() == fresh.vertex_count();
            t.insert([0.25, 1.0, 0.5]).unwrap();
            let _ = t.remove(VertexId::new(0));
            is_sound && t.check(Level::Law).is_empty()
        });
        read_damaged(&constrained, |mut t| {
            let is_sound = t.check(Level::Law).is_empty();
            t.insert([0.25, 1.0]).unwrap();
            let _ = t.remove(VertexId::new(0));
            is_sound && t.check(Level::Law).is_empty()
        });
    }
}

/// Bits of payloads are checked for each cell: here those of the edge from a vertex to infinity, on
/// both sides.
#[test]
fn a_constraint_to_infinity_is_an_error() {
    let mut t: Constrained<Plane> = Constrained::new(Plane::default());
    for p in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]] {
        t.insert(p).unwrap();
    }
    let mut saved = serde_json::to_value(&t).unwrap();
    let vertices = saved["cells"].as_array().unwrap().clone();
    for (k, cell) in vertices.chunks(3).enumerate() {
        let is_end = |vertex: &Value| vertex.is_null() || *vertex == 0;
        if cell.iter().filter(|&vertex| is_end(vertex)).count() == 2 && cell.contains(&Value::Null)
        {
            let opposite = cell.iter().position(|vertex| !is_end(vertex)).unwrap();
            saved["cell_data"][k][0] = Value::from(1 << opposite);
        }
    }
    let error = serde_json::from_value::<Constrained<Plane>>(saved)
        .unwrap_err()
        .to_string();
    assert_eq!(
        error,
        "damaged triangulation: an edge that does not exist is constrained"
    );
}

#[test]
fn payloads_of_cells_are_saved() {
    let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0], [1.0, 1.0]];
    let (t, of_points) = Delaunay::from_points(Plane::default(), &points).unwrap();
    let mut t: Delaunay<Plane, 3, (), u32> = t.with_cell_data(|cell| 7 * cell.index() as u32);
    let _ = t.remove(of_points[0]);
    let seen = |t: &Delaunay<Plane, 3, (), u32>| -> BTreeMap<_, _> {
        t.tds()
            .cells()
            .map(|cell| (vertices(t, cell), *t.tds().cell_data(cell)))
            .collect()
    };
    assert_eq!(seen(&t), seen(&through(&t)));

    let lines = [[0, 3], [1, 4]];
    let (t, _) = ConstrainedDelaunay::<_, ()>::from_lines(
        Plane::default(),
        &points,
        &lines,
        OnCrossing::Split,
    )
    .unwrap();
    let t: ConstrainedDelaunay<Plane, (), u32> = t.with_cell_data(|cell| cell.index() as u32 + 1);
    let seen = |t: &ConstrainedDelaunay<Plane, (), u32>| -> BTreeMap<_, _> {
        t.tds()
            .cells()
            .map(|cell| (vertices(t, cell), *t.cell_data(cell)))
            .collect()
    };
    let read = through(&t);
    assert_eq!(seen(&t), seen(&read));
    assert!(read.constrained_edges().eq(t.constrained_edges()));
}
