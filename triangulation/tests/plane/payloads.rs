//! Payloads of cells: which payload a new cell inherits, by comparing all cells before and after.

use std::collections::BTreeMap;

use breakline_triangulation::geometry::{Geometry, Plane, Space, Weighted};
use breakline_triangulation::tds::{CellId, VertexId};
use breakline_triangulation::{
    Basic, Constrained, ConstrainedDelaunay, ConstrainedEdges, Delaunay, Level, OnCrossing,
    Regular, Triangulation,
};
use testkit::random::Random;

/// Cells by their vertices, with their payloads; and the dimension.
type Seen = (i32, BTreeMap<Vec<VertexId>, u32>);

fn seen<G: Geometry<N>, const N: usize, V>(t: &Triangulation<G, N, V, u32>) -> Seen {
    seen_as(t, |cell| *t.tds().cell_data(cell))
}

fn seen_between_constraints<G: Geometry<3>, V>(
    t: &Triangulation<G, 3, V, ConstrainedEdges<u32>>,
) -> Seen {
    seen_as(t, |cell| *t.cell_data(cell))
}

fn seen_as<G: Geometry<N>, const N: usize, V, C: Copy + Default>(
    t: &Triangulation<G, N, V, C>,
    payload: impl Fn(CellId) -> u32,
) -> Seen {
    let sorted = |cell: CellId| {
        let mut vertices = t.tds().cell_vertices(cell).to_vec();
        vertices.sort_unstable();
        (vertices, payload(cell))
    };
    (t.dimension(), t.tds().cells().map(sorted).collect())
}

/// Asserts that cells that stay keep their payload, and that a new one has the payload of the
/// removed cell that had the facet opposite the new vertex. If the dimension changes, all have the
/// default one.
fn judge_insertion((dimension, before): &Seen, (now, after): &Seen, vertex: VertexId) {
    for (cell, &data) in after {
        let facet: Vec<VertexId> = cell.iter().copied().filter(|&v| v != vertex).collect();
        let is_donor = |other: &Vec<VertexId>| {
            !after.contains_key(other) && facet.iter().all(|v| other.contains(v))
        };
        let donors = || {
            before
                .iter()
                .filter(|(other, _)| is_donor(other))
                .map(|(_, &data)| data)
        };
        match before.get(cell) {
            _ if dimension != now => assert_eq!(data, 0),
            Some(&old) => assert_eq!(data, old),
            None => assert_eq!(
                donors().collect::<Vec<_>>(),
                [data],
                "{cell:?} {before:?} {after:?}"
            ),
        }
    }
}

/// Asserts that cells that stay keep their payload, and that others have the default one.
fn judge_removal((dimension, before): &Seen, (now, after): &Seen) {
    for (cell, data) in after {
        let old = before.get(cell).filter(|_| dimension == now);
        assert_eq!(data, old.unwrap_or(&0), "{cell:?} {before:?} {after:?}");
    }
}

/// Gives each cell a payload of its own, never the default one.
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
                let _ = t.remove(vertex);
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

/// Vertices with many neighbors are removed by another algorithm.
#[test]
fn delaunay_cells_around_a_hub() {
    let rim = (0..40)
        .map(|k| f64::from(k) * 0.157)
        .map(|turn| [turn.cos(), turn.sin()]);
    let points: Vec<[f64; 2]> = rim.chain([[0.0, 0.0]]).collect();
    let (t, vertices) = Delaunay::from_points(
        Plane::<breakline_triangulation::kernel::Adaptive>::default(),
        &points,
    )
    .unwrap();
    let mut t = t.with_cell_data(another);
    let before = seen(&t);
    assert!(t.tds().around(vertices[40]).count() > 20);
    let _ = t.remove(vertices[40]);
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
        let mut t = Regular::<Weighted, 3>::new(Weighted::default()).with_cell_data(|_| 0u32);
        for _ in 0..25 {
            t = t.with_cell_data(another);
            let (before, hidden) = (seen(&t), t.hidden().len());
            match vertex_to_remove(&mut dice) {
                None => {
                    let vertex = t.insert([0; 3].map(|_| dice.below(4) as f64)).unwrap();
                    judge_insertion(&before, &seen(&t), vertex);
                }
                // Points that become visible are inserted again.
                Some(vertex) => {
                    let _ = t.remove(vertex);
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
        let mut t = Basic::<Plane, 3>::new(Plane::default()).with_cell_data(|_| 0u32);
        for _ in 0..25 {
            t = t.with_cell_data(another);
            let before = seen(&t);
            if let Some(vertex) = vertex_to_remove(&mut dice) {
                let _ = t.remove(vertex);
                judge_removal(&before, &seen(&t));
            } else if dice.below(3) == 0 {
                let cells: Vec<CellId> = t.tds().cells().collect();
                let has_flipped = !cells.is_empty() && t.flip(dice.pick(&cells), dice.index(3));
                judge_removal(&before, &seen(&t));
                flips += usize::from(has_flipped);
            } else {
                let vertex = t
                    .insert([dice.below(5) as f64, dice.below(5) as f64])
                    .unwrap();
                judge_insertion(&before, &seen(&t), vertex);
            }
            assert_eq!(t.check(Level::Orientation), []);
        }
    }
    assert!(flips > 100, "{flips}");
}

#[test]
fn constrained_cells_inherit_what_they_replace() {
    let mut dice = Random(5);
    let mut constraints = 0;
    for _ in 0..400 {
        let mut t = Constrained::<Plane>::new(Plane::default()).with_cell_data(|_| 0u32);
        let mut vertices = Vec::new();
        for _ in 0..30 {
            t = t.with_cell_data(another);
            let before = seen_between_constraints(&t);
            let constrained: Vec<_> = t.constrained_edges().collect();
            match dice.below(6) {
                0 if !vertices.is_empty() => {
                    let _ = t.remove(dice.pick(&vertices));
                    judge_removal(&before, &seen_between_constraints(&t));
                }
                1 | 2 if vertices.len() > 2 => {
                    let is_new = t
                        .constrain(dice.pick(&vertices), dice.pick(&vertices))
                        .is_ok();
                    judge_removal(&before, &seen_between_constraints(&t));
                    constraints += usize::from(is_new);
                }
                3 if !constrained.is_empty() => {
                    let [a, b] = dice.pick(&constrained);
                    assert!(t.release(a, b));
                    assert_eq!(seen_between_constraints(&t), before);
                }
                _ => {
                    let vertex = t
                        .insert([dice.below(5) as f64, dice.below(5) as f64])
                        .unwrap();
                    judge_insertion(&before, &seen_between_constraints(&t), vertex);
                    vertices.push(vertex);
                }
            }
            let constrained: Vec<_> = t.constrained_edges().collect();
            t = t.with_cell_data(another);
            assert!(t.constrained_edges().eq(constrained));
            assert_eq!(t.check(Level::Law), []);
        }
    }
    assert!(constraints > 100, "{constraints}");
}

/// Each edit arranges lines anew: what stays keeps its payload, and what is new has one that was
/// there, or the default one.
#[test]
fn cells_between_lines_keep_their_payloads() {
    let mut dice = Random(6);
    for _ in 0..300 {
        let mut t = ConstrainedDelaunay::<Plane>::new(Plane::default()).with_cell_data(|_| 0u32);
        for _ in 0..20 {
            t = t.with_cell_data(another);
            let before = seen_between_constraints(&t);
            let lines: Vec<_> = t.lines().collect();
            let mut point = || [dice.below(5) as f64, dice.below(5) as f64];
            match t.lines().count() {
                0 | 1 => drop(t.insert_lines(&[[point(), point()]]).unwrap()),
                count if count > 3 => assert!(t.remove_line(dice.pick(&lines))),
                _ => {
                    let vertex = t.insert(point()).unwrap();
                    if dice.below(3) == 0 {
                        let _ = t.remove(vertex);
                    } else {
                        t.insert_lines(&[[*t.point(vertex), [dice.below(5) as f64, 4.0]]])
                            .unwrap();
                    }
                }
            }
            let after = seen_between_constraints(&t);
            for (cell, &data) in &after.1 {
                assert!(
                    data == 0 || before.1.values().any(|&old| old == data),
                    "{cell:?} {data}"
                );
            }
            assert_eq!(t.check(Level::Law), []);
        }
    }
}

/// Inserts a point into an area between constraints.
#[test]
fn areas_between_constraints_are_marked() {
    let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    let lines = [vec![0, 2], vec![0, 1, 2, 3, 0]];
    let geometry: Plane = Plane::default();
    let (t, vertices) =
        ConstrainedDelaunay::<_, ()>::from_lines(geometry, &square, &lines, OnCrossing::Split)
            .unwrap();
    let sides: Vec<bool> = t
        .tds()
        .cells()
        .map(|cell| t.tds().corners(cell).contains(&vertices[1]))
        .collect();
    let mut t = t.with_cell_data(|cell| if sides[cell.index()] { 'A' } else { 'B' });
    assert!(t.cell_data(t.tds().cells().next().unwrap()) != &char::default());
    let inside = t.insert([3.0, 1.0]).unwrap();
    assert!(t.tds().around(inside).all(|cell| *t.cell_data(cell) == 'A'));
    let cell = t.tds().around(inside).next().unwrap();
    *t.cell_data_mut(cell) = 'C';
    assert_eq!(
        t.tds()
            .cells()
            .filter(|&cell| *t.cell_data(cell) == 'C')
            .count(),
        1
    );
    assert_eq!(t.constrained_edges().count(), 5);
}
