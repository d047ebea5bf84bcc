//! The same in space.

use std::collections::BTreeSet;

use breakline_triangulation::geometry::{Geometry, Space, WeightedSpace};
use breakline_triangulation::tds::VertexId;
use breakline_triangulation::{Basic, Delaunay, Flaw, Level, Regular, Triangulation};
use proptest::prelude::*;

use super::{goes_on_as_before, read_damaged};

#[derive(Debug, Clone, Copy)]
enum Edit {
    Insert([i8; 3], i8),
    Remove(u8),
}

/// Points on a tiny grid, the first ones in a plane.
fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let site = |depth: i8| [0i8..3, 0i8..3, 0..depth];
    let insert =
        |depth| (site(depth), 0i8..5).prop_map(|(site, weight)| Edit::Insert(site, weight));
    let edits = |depth| prop_oneof![3 => insert(depth), 1 => (0u8..9).prop_map(Edit::Remove)];
    (
        prop::collection::vec(edits(1), 0..8),
        prop::collection::vec(edits(3), 0..10),
    )
        .prop_map(|(flat, full)| [flat, full].concat())
}

fn site(p: [i8; 3]) -> [f64; 3] {
    p.map(f64::from)
}

/// All cells, by the numbers of their vertices.
fn cells<G: Geometry<4>, V, C: Copy + Default>(
    t: &Triangulation<G, 4, V, C>,
) -> BTreeSet<Vec<VertexId>> {
    let sorted = |cell| {
        let mut vertices = t.tds().cell_vertices(cell).to_vec();
        vertices.sort_unstable();
        vertices
    };
    t.tds().cells().map(sorted).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn delaunay_comes_back_and_goes_on_as_before(before in edits(), after in edits()) {
        let edit = |t: &mut Delaunay<Space, 4, u8>, k: usize, edit| match edit {
            Edit::Insert(p, _) => drop(t.insert_with(site(p), k as u8).unwrap()),
            Edit::Remove(k) => drop(t.remove(VertexId::new(k.into()))),
        };
        goes_on_as_before(Delaunay::new(Space::default()), &before, &after, edit, |t, read| {
            prop_assert_eq!(cells(t), cells(read));
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
        let edit = |t: &mut Regular<WeightedSpace, 4>, _, edit| match edit {
            Edit::Insert([x, y, z], w) => drop(t.insert([x, y, z, w].map(f64::from)).unwrap()),
            Edit::Remove(k) => drop(t.remove(VertexId::new(k.into()))),
        };
        goes_on_as_before(Regular::new(WeightedSpace::default()), &before, &after, edit, |t, read| {
            prop_assert_eq!(cells(t), cells(read));
            prop_assert!(t.hidden().eq(read.hidden()));
            prop_assert_eq!(read.check(Level::Law), []);
            Ok(())
        })?;
    }
}

const SITES: [&[[f64; 3]]; 8] = [
    &[],
    &[[1.0, 2.0, 0.0]],
    &[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]],
    &[[0.0, 0.0, 0.0], [2.0, 2.0, 2.0], [1.0, 1.0, 1.0]],
    &[[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]],
    &[
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [2.0, 2.0, 0.0],
        [1.0, 0.0, 0.0],
    ],
    &[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ],
    &[
        [0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
        [2.0, 2.0, 0.0],
        [0.0, 0.0, 2.0],
        [2.0, 2.0, 2.0],
    ],
];

#[test]
fn damage_to_the_basic_and_delaunay_kinds_is_an_error() {
    for sites in SITES {
        let mut basic: Basic<Space, 4, u8> = Basic::new(Space::default());
        let mut delaunay: Delaunay<Space, 4> = Delaunay::new(Space::default());
        for &p in sites {
            basic.insert_with(p, 7).unwrap();
            delaunay.insert(p).unwrap();
        }
        if sites.len() == 5 {
            let _ = delaunay.remove(VertexId::new(1));
        }
        read_damaged(&basic, |mut t| {
            let is_sound = t.check(Level::Law).is_empty();
            t.insert_with([0.25, 1.0, 0.5], 1).unwrap();
            is_sound && t.check(Level::Law).is_empty()
        });
        read_damaged(&delaunay, |mut t| {
            let is_sound = t.check(Level::Law).is_empty();
            t.insert([0.25, 1.0, 0.5]).unwrap();
            t.insert([1.25, 1.0, 0.5]).unwrap();
            let _ = t.remove(VertexId::new(0));
            is_sound && t.check(Level::Law).is_empty()
        });
    }
}

#[test]
fn damage_to_the_regular_kind_is_an_error() {
    for sites in SITES {
        let mut regular: Regular<WeightedSpace, 4> = Regular::new(WeightedSpace::default());
        for (k, &[x, y, z]) in sites.iter().enumerate() {
            regular
                .insert([x, y, z, if k % 3 == 1 { -4.0 } else { 0.0 }])
                .unwrap();
        }
        read_damaged(&regular, |mut t| {
            let (fresh, _) =
                Regular::<_, 4>::from_points(WeightedSpace::new(), t.points()).unwrap();
            let is_sound =
                t.check(Level::Law).is_empty() && t.vertex_count() == fresh.vertex_count();
            t.insert([0.25, 1.0, 0.5, 0.5]).unwrap();
            let _ = t.remove(VertexId::new(0));
            is_sound && t.check(Level::Law).is_empty()
        });
    }
}

/// A file of the plane is none of space, and the other direction.
#[test]
fn dimensions_do_not_mix() {
    let (t, _) = Delaunay::from_points(Space::new(), SITES[6]).unwrap();
    let mut saved = serde_json::to_value(&t).unwrap();
    saved["dimension"] = 4.into();
    let error = serde_json::from_value::<Delaunay<Space, 4>>(saved)
        .unwrap_err()
        .to_string();
    assert_eq!(
        error,
        "damaged triangulation: the dimension is below -1, or above that of the plane or space"
    );
}

/// Points of a plane that are moved out of it, or turned around in it, are found by the checker.
#[test]
fn coplanar_points_are_checked() {
    let (t, v) = Delaunay::from_points(Space::new(), SITES[5]).unwrap();
    assert!(t.dimension() == 2 && t.check(Level::Law).is_empty());
    let damaged = |vertex: VertexId, at: [f64; 3]| {
        let mut saved = serde_json::to_value(&t).unwrap();
        saved["points"][vertex.index()] = serde_json::json!(at);
        serde_json::from_value::<Delaunay<Space, 4>>(saved)
            .unwrap_err()
            .to_string()
    };
    assert!(damaged(v[4], [1.0, 0.0, 1.0]).contains("is outside of the flat of all others"));
    assert!(damaged(v[4], [1.0, 9.0, 0.0]).contains("is flat or turned around"));
    assert!(damaged(v[4], [1.0, 0.5, 0.0]).contains("the hull turns inwards"));
    assert_eq!(
        Flaw::NotInFlat(v[4]).to_string(),
        format!(
            "vertex {} is outside of the flat of all others",
            v[4].index()
        )
    );
}
