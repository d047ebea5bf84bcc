//! Edits, compared with the same edits of lists of cells: an edit succeeds exactly if the list
//! stays a manifold of the same kind.

use std::collections::BTreeSet;

use breakline_triangulation::tds::{CellId, EditError, Tds, VertexId};
use testkit::random::Random;

use crate::judge::{Cell, build, cells_of, euler, is_manifold, is_oriented};
use crate::{shapes, spaces, surfaces};

type Cells = BTreeSet<BTreeSet<usize>>;

/// The number of no vertex.
const NEW: usize = usize::MAX;

fn sets(cells: &[Cell]) -> Cells {
    cells
        .iter()
        .map(|cell| cell.iter().copied().collect())
        .collect()
}

fn lists(cells: &Cells) -> Vec<Cell> {
    cells
        .iter()
        .map(|cell| cell.iter().copied().collect())
        .collect()
}

/// Returns the cells that contain a face.
fn star(cells: &Cells, face: &BTreeSet<usize>) -> Cells {
    cells
        .iter()
        .filter(|cell| face.is_subset(cell))
        .cloned()
        .collect()
}

/// Replaces cells by those that join the facets of their border to a new vertex.
fn starred(cells: &Cells, hole: &Cells) -> Cells {
    let mut border: BTreeSet<BTreeSet<usize>> = BTreeSet::new();
    for cell in hole {
        for v in cell {
            let mut facet = cell.clone();
            facet.remove(v);
            if !border.remove(&facet) {
                border.insert(facet);
            }
        }
    }
    let new = border.into_iter().map(|mut facet| {
        facet.insert(NEW);
        facet
    });
    cells.difference(hole).cloned().chain(new).collect()
}

/// Flips a face: the vertices of its star that are not on the face span a face instead, if there
/// are as many as a flip needs.
fn flipped(cells: &Cells, face: &BTreeSet<usize>, width: usize) -> Option<Cells> {
    let star = star(cells, face);
    let around: BTreeSet<usize> = star.iter().flatten().copied().collect();
    if star.len() != width + 1 - face.len() || around.len() != width + 1 {
        return None;
    }
    let new = face
        .iter()
        .map(|a| around.iter().copied().filter(|v| v != a).collect());
    let rest = cells.difference(&star).cloned();
    // A cell that occurs twice cancels out.
    let all: Vec<BTreeSet<usize>> = rest.chain(new).collect();
    (all.iter().collect::<BTreeSet<_>>().len() == all.len()).then(|| all.into_iter().collect())
}

/// Replaces one vertex by another; `None` if two cells become one.
fn collapsed(cells: &Cells, from: usize, into: usize) -> Option<Cells> {
    let mut all = Vec::new();
    for cell in cells
        .iter()
        .filter(|cell| !(cell.contains(&from) && cell.contains(&into)))
    {
        all.push(
            cell.iter()
                .map(|&v| if v == from { into } else { v })
                .collect::<BTreeSet<usize>>(),
        );
    }
    (all.iter().collect::<BTreeSet<_>>().len() == all.len()).then(|| all.into_iter().collect())
}

/// Returns some cells, connected or not.
fn region<const N: usize>(random: &mut Random, tds: &Tds<N, usize>, all: &[CellId]) -> Vec<CellId> {
    let mut region = vec![random.pick(all)];
    for _ in 0..random.below(9) {
        let from = if random.below(12) == 0 {
            random.pick(all)
        } else {
            random.pick(&region)
        };
        let cell = tds.neighbor(from, random.index(N));
        if !region.contains(&cell) {
            region.push(cell);
        }
    }
    region
}

/// One edit, and the judge's expectation: the new vertex, if there is one, and the cells, if the
/// edit is allowed.
fn edit<const N: usize>(
    random: &mut Random,
    tds: &mut Tds<N, usize>,
) -> (
    &'static str,
    Result<Option<VertexId>, EditError>,
    Option<Cells>,
) {
    let before = sets(&cells_of(tds));
    let all: Vec<CellId> = tds.cells().collect();
    let cell = random.pick(&all);
    let i = random.index(N);
    let j = (i + 1 + random.index(N - 1)) % N;
    let set = |cell: CellId| {
        tds.cell_vertices(cell)
            .iter()
            .map(|v| v.index())
            .collect::<BTreeSet<usize>>()
    };
    let ends @ [a, b] = [i, j].map(|k| tds.vertex(cell, k));
    let edge = BTreeSet::from([a.index(), b.index()]);
    let mut facet = set(cell);
    facet.remove(&a.index());
    match random.below(10) {
        0 => {
            let expected = starred(&before, &Cells::from([set(cell)]));
            (
                "split_cell",
                tds.split_cell(cell, 0).map(Some),
                Some(expected),
            )
        }
        1 => (
            "split_facet",
            tds.split_facet(cell, i, 0).map(Some),
            Some(starred(&before, &star(&before, &facet))),
        ),
        2 => (
            "split_edge",
            tds.split_edge(ends, 0).map(Some),
            Some(starred(&before, &star(&before, &edge))),
        ),
        3 | 4 => (
            "flip",
            tds.flip(cell, i).map(|_| None),
            flipped(&before, &facet, N),
        ),
        5 => (
            "flip_edge",
            tds.flip_edge(ends).map(|_| None),
            flipped(&before, &edge, N),
        ),
        6 => {
            let expected = flipped(&before, &BTreeSet::from([a.index()]), N);
            ("unsplit_cell", tds.unsplit_cell(a).map(|_| None), expected)
        }
        7 => {
            let region = region(random, tds, &all);
            let expected = starred(&before, &region.iter().map(|&cell| set(cell)).collect());
            (
                "star_hole",
                tds.star_hole(&region, 0).map(Some),
                Some(expected),
            )
        }
        _ => (
            "collapse",
            tds.collapse(a, b).map(|()| None),
            collapsed(&before, a.index(), b.index()),
        ),
    }
}

/// Edits a complex, and counts successful and refused edits.
fn edit_for_a_while<const N: usize>(
    random: &mut Random,
    vertices: usize,
    cells: &[Cell],
    edits: usize,
) -> [usize; 2] {
    let mut tds = build::<N>(vertices, cells).unwrap();
    let characteristic = euler(cells);
    let mut counts = [0; 2];
    for _ in 0..edits {
        let before = (cells_of(&tds), tds.vertex_count());
        let (name, result, expected) = edit(random, &mut tds);
        let keeps_kind =
            |cells: &Cells| is_manifold(&lists(cells)) && euler(&lists(cells)) == characteristic;
        assert_eq!(
            result.is_ok(),
            expected.as_ref().is_some_and(keeps_kind),
            "{name}: {result:?} of {before:?}"
        );
        counts[usize::from(result.is_err())] += 1;
        assert_eq!(tds.check_links(), [], "{name}");
        assert_eq!(tds.check_manifold(), [], "{name}");
        let after = cells_of(&tds);
        match (result, expected) {
            (Ok(vertex), Some(expected)) => {
                let new = vertex.map_or(NEW, VertexId::index);
                let named = |v: &usize| if *v == NEW { new } else { *v };
                assert_eq!(
                    sets(&after),
                    expected
                        .iter()
                        .map(|cell| cell.iter().map(named).collect())
                        .collect(),
                    "{name}"
                );
                assert!(is_oriented(&after), "{name}");
                let used: BTreeSet<usize> = after.iter().flatten().copied().collect();
                assert!(tds.vertices().map(VertexId::index).eq(used), "{name}");
            }
            _ => assert_eq!((after, tds.vertex_count()), before, "{name}"),
        }
    }
    counts
}

#[test]
fn edits_of_surfaces_succeed_exactly_where_the_judge_allows_them() {
    let mut random = Random(4);
    for ((vertices, cells), _) in surfaces() {
        let [done, refused] = edit_for_a_while::<3>(&mut random, vertices, &cells, 300);
        assert!(done > 100 && refused > 30, "{done} {refused}");
    }
}

#[test]
fn edits_of_spaces_succeed_exactly_where_the_judge_allows_them() {
    let mut random = Random(5);
    for (vertices, cells) in spaces() {
        let edits = if cells.len() > 100 { 30 } else { 150 };
        let [done, refused] = edit_for_a_while::<4>(&mut random, vertices, &cells, edits);
        assert!(done > edits / 4 && refused > edits / 10, "{done} {refused}");
    }
}

/// A surface of genus one keeps its genus if a hole contains its handle.
#[test]
fn a_hole_with_a_handle_is_refused() {
    let (vertices, cells) = shapes::torus(3, 3);
    let mut tds = build::<3>(vertices, &cells).unwrap();
    let all_but_one: Vec<CellId> = tds.cells().skip(1).collect();
    assert_eq!(tds.star_hole(&all_but_one, 0), Err(EditError::Hole));
    assert_eq!(
        tds.star_hole(&tds.cells().collect::<Vec<_>>(), 0),
        Err(EditError::Hole)
    );
    assert_eq!(tds.star_hole(&[], 0), Err(EditError::Hole));
    let cell = CellId::new(0);
    assert_eq!(tds.star_hole(&[cell, cell], 0), Err(EditError::Hole));
}

#[test]
fn what_does_not_exist_is_refused() {
    let (vertices, cells) = shapes::octahedron();
    let mut tds = build::<3>(vertices, &cells).unwrap();
    let (no_cell, no_vertex) = (CellId::new(8), VertexId::new(6));
    assert_eq!(tds.split_cell(no_cell, 0), Err(EditError::Cell(no_cell)));
    assert_eq!(
        tds.flip(CellId::new(0), 3),
        Err(EditError::Facet {
            cell: CellId::new(0),
            facet: 3
        })
    );
    assert_eq!(
        tds.unsplit_cell(no_vertex),
        Err(EditError::Vertex(no_vertex))
    );
    assert_eq!(
        tds.unsplit_cell(VertexId::INFINITE),
        Err(EditError::Vertex(VertexId::INFINITE))
    );
    assert_eq!(
        tds.unsplit_cell(VertexId::new(0)),
        Err(EditError::Star { cells: 4 })
    );
    let ends = [0, 2].map(VertexId::new);
    assert_eq!(tds.flip_edge(ends), Err(EditError::Edge(ends)));
    assert_eq!(
        tds.split_edge([ends[0]; 2], 0),
        Err(EditError::Edge([ends[0]; 2]))
    );
    assert_eq!(
        Tds::<3>::new().split_cell(no_cell, ()),
        Err(EditError::NotFull)
    );
    // In a tetrahedron every edge exists, and no vertex can be removed.
    let (vertices, cells) = shapes::simplex(4);
    let mut tds = build::<3>(vertices, &cells).unwrap();
    let [a, b] = [0, 1].map(VertexId::new);
    assert_eq!(tds.flip(CellId::new(0), 0), Err(EditError::Exists));
    assert_eq!(tds.unsplit_cell(a), Err(EditError::Exists));
    assert_eq!(tds.collapse(a, b), Err(EditError::Links([a, b])));
}

#[test]
fn payloads_pass_to_the_parts() {
    let (vertices, cells) = shapes::torus(4, 4);
    let mut tds = build::<3>(vertices, &cells)
        .unwrap()
        .with_cell_data(|cell| cell.index() + 100);
    let cell = CellId::new(5);
    let beside = tds.neighbor(cell, 1);
    let on_edge = tds.split_facet(cell, 1, 77).unwrap();
    assert_eq!(*tds.vertex_data(on_edge), 77);
    let mut found: Vec<usize> = tds
        .around(on_edge)
        .map(|cell| *tds.cell_data(cell))
        .collect();
    found.sort_unstable();
    let mut expected = [105, 105, beside.index() + 100, beside.index() + 100];
    expected.sort_unstable();
    assert_eq!(found, expected);
    let inside = tds.split_cell(CellId::new(20), 78).unwrap();
    assert!(tds.around(inside).all(|cell| *tds.cell_data(cell) == 120));
    let one = tds.unsplit_cell(inside).unwrap();
    assert_eq!(*tds.cell_data(one), 0);
}
