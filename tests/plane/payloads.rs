//! Payloads of cells: whose a new cell inherits, by looking at all cells before and after.

use std::collections::BTreeMap;

use crate::common::random::Random;
use breakline::geometry::{Geometry, Plane, Space, Weighted};
use breakline::tds::{CellId, VertexId};
use breakline::triangulation::{Delaunay, Level, Regular, Triangulation};

/// Cells by their vertices, with their payloads; and the dimension.
type Seen = (i32, BTreeMap<Vec<VertexId>, u32>);

fn seen<G: Geometry<N>, const N: usize, V>(t: &Triangulation<G, N, V, u32>) -> Seen {
    let sorted = |cell: CellId| {
        let mut vertices = t.tds().cell_vertices(cell).to_vec();
        vertices.sort_unstable();
        (vertices, *t.tds().cell_data(cell))
    };
    (t.dimension(), t.tds().cells().map(sorted).collect())
}

/// Cells that stay keep their payload; a new one has that of the cell that is gone and had the facet opposite the new
/// vertex. With another dimension all have the default one.
fn judge_insertion((dimension, before): &Seen, (now, after): &Seen, vertex: VertexId) {
    for (cell, &data) in after {
        let facet: Vec<VertexId> = cell.iter().copied().filter(|&v| v != vertex).collect();
        let is_donor = |other: &Vec<VertexId>| !after.contains_key(other) && facet.iter().all(|v| other.contains(v));
        let donors = || before.iter().filter(|(other, _)| is_donor(other)).map(|(_, &data)| data);
        match before.get(cell) {
            _ if dimension != now => assert_eq!(data, 0),
            Some(&old) => assert_eq!(data, old),
            None => assert_eq!(donors().collect::<Vec<_>>(), [data], "{cell:?} {before:?} {after:?}"),
        }
    }
}

/// Cells that stay keep their payload; others have the default one.
fn judge_removal((dimension, before): &Seen, (now, after): &Seen) {
    for (cell, data) in after {
        let old = before.get(cell).filter(|_| dimension == now);
        assert_eq!(data, old.unwrap_or(&0), "{cell:?} {before:?} {after:?}");
    }
}

/// Another payload for each cell, none of them the default one.
fn another(cell: CellId) -> u32 {
    cell.index() as u32 + 1
}

/// Removes one time in three.
fn vertex_to_remove(dice: &mut Random) -> Option<VertexId> {
    (dice.below(3) == 0).then(|| VertexId::new(dice.index(16)))
}

#[test]
fn delaunay_cells_inherit_what_they_replace() {
    let mut dice = Random(1);
    for round in 0..400 {
        let side = 1 + dice.below(5);
        let mut t = Delaunay::<Plane, 3>::new(Plane::default()).with_cell_data(|_| 0u32);
        for _ in 0..25 {
            t = t.with_cell_data(another);
            let before = seen(&t);
            if let Some(vertex) = vertex_to_remove(&mut dice) {
                t.remove(vertex);
                judge_removal(&before, &seen(&t));
            } else {
                let y = if round % 4 == 0 { 2 } else { dice.below(side) };
                let vertex = t.insert([dice.below(side) as f64, y as f64]).unwrap();
                judge_insertion(&before, &seen(&t), vertex);
            }
            assert_eq!(t.check(Level::Law), []);
        }
    }
}

/// Vertices with many neighbors are taken out another way.
#[test]
fn delaunay_cells_around_a_hub() {
    let rim = (0..40).map(|k| f64::from(k) * 0.157).map(|turn| [turn.cos(), turn.sin()]);
    let points: Vec<[f64; 2]> = rim.chain([[0.0, 0.0]]).collect();
    let (t, vertices) = Delaunay::from_points(Plane::<breakline::kernel::Adaptive>::default(), &points).unwrap();
    let mut t = t.with_cell_data(another);
    let before = seen(&t);
    assert!(t.tds().around(vertices[40]).count() > 20);
    t.remove(vertices[40]);
    judge_removal(&before, &seen(&t));
    assert!(before.1.values().all(|&data| data > 0) && seen(&t).1.values().any(|&data| data == 0));
}

#[test]
fn cells_in_space_inherit_what_they_replace() {
    let mut dice = Random(2);
    for _ in 0..60 {
        let mut t = Delaunay::<Space, 4>::new(Space::default()).with_cell_data(|_| 0u32);
        for _ in 0..20 {
            t = t.with_cell_data(another);
            let before = seen(&t);
            let vertex = t.insert([0; 3].map(|_| dice.below(3) as f64)).unwrap();
            judge_insertion(&before, &seen(&t), vertex);
        }
    }
}

#[test]
fn regular_cells_inherit_what_they_replace() {
    let mut dice = Random(3);
    for _ in 0..400 {
        let mut t = Regular::<Weighted>::new(Weighted::default()).with_cell_data(|_| 0u32);
        for _ in 0..25 {
            t = t.with_cell_data(another);
            let (before, hidden) = (seen(&t), t.hidden().len());
            match vertex_to_remove(&mut dice) {
                None => {
                    let vertex = t.insert([0; 3].map(|_| dice.below(4) as f64)).unwrap();
                    judge_insertion(&before, &seen(&t), vertex);
                }
                // What comes to light is inserted again.
                Some(vertex) => {
                    t.remove(vertex);
                    if t.hidden().len() == hidden {
                        judge_removal(&before, &seen(&t));
                    }
                }
            }
            assert_eq!(t.check(Level::Law), []);
        }
    }
}

#[test]
fn cells_without_a_law_inherit_what_they_replace() {
    let mut dice = Random(4);
    let mut flips = 0;
    for _ in 0..400 {
        let mut t: Triangulation<Plane, 3, (), u32> = Triangulation::new(Plane::default());
        for _ in 0..25 {
            t = t.with_cell_data(another);
            let before = seen(&t);
            if let Some(vertex) = vertex_to_remove(&mut dice) {
                t.remove(vertex);
                judge_removal(&before, &seen(&t));
            } else if dice.below(3) == 0 {
                let cells: Vec<CellId> = t.tds().cells().collect();
                let has_flipped = !cells.is_empty() && t.flip(dice.pick(&cells), dice.index(3));
                judge_removal(&before, &seen(&t));
                flips += usize::from(has_flipped);
            } else {
                let vertex = t.insert([dice.below(5) as f64, dice.below(5) as f64]).unwrap();
                judge_insertion(&before, &seen(&t), vertex);
            }
            assert_eq!(t.check(Level::Orientation), []);
        }
    }
    assert!(flips > 100, "{flips}");
}

#[cfg(feature = "serde")]
#[test]
fn payloads_are_saved() {
    let points = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0], [2.0, 2.0], [1.0, 1.0]];
    let (t, vertices) = Delaunay::from_points(Plane::default(), &points).unwrap();
    let mut t: Delaunay<Plane, 3, (), u32> = t.with_cell_data(|cell| 7 * cell.index() as u32);
    t.remove(vertices[0]);
    let read: Delaunay<Plane, 3, (), u32> = serde_json::from_str(&serde_json::to_string(&t).unwrap()).unwrap();
    assert_eq!(seen(&t), seen(&read));
}
