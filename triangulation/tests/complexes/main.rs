//! Standalone complexes of any genus, built from cells and edited. Each result is judged by
//! counting faces.

mod edits;
mod in_space;
mod judge;
mod shapes;

use breakline_triangulation::tds::{CellId, Tds, TdsError, VertexId};
use judge::{Cell, build, cells_of, euler, is_manifold, is_oriented, is_sound};
use testkit::random::Random;

/// Closed surfaces, with their Euler characteristics.
fn surfaces() -> Vec<((usize, Vec<Cell>), i64)> {
    let double = shapes::connected_sum(shapes::torus(3, 4), shapes::torus(4, 3));
    let spheres = shapes::connected_sum(shapes::octahedron(), shapes::simplex(4));
    vec![
        (shapes::simplex(4), 2),
        (shapes::octahedron(), 2),
        (spheres, 2),
        (shapes::torus(3, 3), 0),
        (double.clone(), -2),
        (shapes::connected_sum(double, shapes::torus(3, 3)), -4),
        (shapes::both(shapes::octahedron(), shapes::torus(3, 3)), 2),
    ]
}

/// Closed 3-manifolds.
fn spaces() -> Vec<(usize, Vec<Cell>)> {
    vec![
        shapes::simplex(5),
        shapes::suspension(shapes::octahedron()),
        shapes::three_torus(3),
    ]
}

#[test]
fn closed_manifolds_of_any_genus_are_taken() {
    for ((vertices, cells), expected) in surfaces() {
        assert!(
            is_sound(vertices, &cells) && euler(&cells) == expected,
            "the judge"
        );
        let tds = build::<3>(vertices, &cells).unwrap();
        assert_eq!(tds.euler_characteristic(), expected);
        assert_eq!(cells_of(&tds), cells);
        assert_eq!(tds.edges().count(), judge::faces(&cells, 2).len());
        assert!(tds.vertices().all(|v| *tds.vertex_data(v) == v.index()));
    }
    for (vertices, cells) in spaces() {
        assert!(
            is_sound(vertices, &cells) && euler(&cells) == 0,
            "the judge"
        );
        let tds = build::<4>(vertices, &cells).unwrap();
        assert_eq!(tds.euler_characteristic(), 0);
        assert_eq!(cells_of(&tds), cells);
    }
}

#[test]
fn payloads_of_cells_follow_their_numbers() {
    let (vertices, cells) = shapes::torus(4, 4);
    let tds = build::<3>(vertices, &cells)
        .unwrap()
        .with_cell_data(|cell| cell.index() * 10);
    assert!(
        tds.cells()
            .all(|cell| *tds.cell_data(cell) == cell.index() * 10)
    );
}

#[test]
fn a_fault_is_named() {
    let cell = CellId::new;
    let (_, tetrahedron) = shapes::simplex(4);
    assert_eq!(
        build::<3>(4, &tetrahedron[..3]).err(),
        Some(TdsError::OneCell {
            cell: cell(0),
            facet: 2
        })
    );
    assert_eq!(
        build::<3>(5, &tetrahedron).err(),
        Some(TdsError::Isolated(VertexId::new(4)))
    );
    let fourth = TdsError::Vertex {
        cell: cell(0),
        vertex: VertexId::new(3),
    };
    assert_eq!(build::<3>(3, &tetrahedron).err(), Some(fourth));
    let twice = [vec![0, 1, 1], vec![0, 1, 2]];
    let vertex = VertexId::new(1);
    assert_eq!(
        build::<3>(3, &twice).err(),
        Some(TdsError::Vertex {
            cell: cell(0),
            vertex
        })
    );
    let three: Vec<Cell> = tetrahedron.iter().cloned().chain([vec![0, 1, 4]]).collect();
    assert_eq!(
        build::<3>(5, &three).err(),
        Some(TdsError::ThreeCells {
            cell: cell(4),
            facet: 2
        })
    );
    let mut turned = tetrahedron.clone();
    turned[0].swap(0, 1);
    assert_eq!(
        build::<3>(4, &turned).err(),
        Some(TdsError::NotOriented {
            cell: cell(0),
            facet: 0
        })
    );
    // Two triangles, back to back.
    let pair = [vec![0, 1, 2], vec![0, 2, 1]];
    assert_eq!(
        build::<3>(3, &pair).err(),
        Some(TdsError::Neighbor {
            cell: cell(0),
            facet: 1
        })
    );
    // Two spheres that share a vertex.
    let (m, a) = shapes::octahedron();
    let touching: Vec<Cell> = a
        .iter()
        .cloned()
        .chain(a.iter().map(|c| {
            c.iter()
                .map(|&v| if v == 0 { 0 } else { v + m - 1 })
                .collect()
        }))
        .collect();
    assert!(!is_manifold(&touching));
    assert_eq!(
        build::<3>(2 * m - 1, &touching).err(),
        Some(TdsError::Link(VertexId::new(0)))
    );
    // Tetrahedra around a vertex whose link is a torus.
    let (vertices, cells) = shapes::suspension(shapes::torus(3, 3));
    assert!(!is_manifold(&cells) && is_oriented(&cells));
    assert_eq!(
        build::<4>(vertices, &cells).err(),
        Some(TdsError::Link(VertexId::new(9)))
    );
    let (vertices, cells) = shapes::klein_bottle(4, 5);
    assert!(is_manifold(&cells) && !is_oriented(&cells) && euler(&cells) == 0);
    assert!(matches!(
        build::<3>(vertices, &cells).err(),
        Some(TdsError::NotOriented { .. })
    ));
    for error in [
        fourth,
        TdsError::OneCell {
            cell: cell(0),
            facet: 1,
        },
        TdsError::Link(VertexId::INFINITE),
    ] {
        assert!(!error.to_string().is_empty());
    }
}

#[test]
fn no_cells_are_a_complex() {
    assert!(
        Tds::<3>::from_cells(Vec::new(), &[])
            .is_ok_and(|tds| (tds.cell_count(), tds.dimension()) == (0, -1))
    );
    assert!(
        Tds::<4>::from_cells(Vec::new(), &[])
            .is_ok_and(|tds| (tds.cell_count(), tds.dimension()) == (0, -1))
    );
    assert!(Tds::<4>::from_cells(vec![()], &[]).is_err());
}

/// The kinds require a single sphere.
#[test]
fn only_spheres_pass_the_check_of_the_kinds() {
    let close = |(vertices, cells): (usize, Vec<Cell>)| {
        let last = VertexId::new(vertices - 1);
        let infinite = |v: usize| {
            if VertexId::new(v) == last {
                VertexId::INFINITE
            } else {
                VertexId::new(v)
            }
        };
        let cells: Vec<[VertexId; 3]> = cells
            .iter()
            .map(|c| std::array::from_fn(|k| infinite(c[k])))
            .collect();
        Tds::<3>::from_cells(vec![(); vertices - 1], &cells).unwrap()
    };
    assert_eq!(close(shapes::octahedron()).check_sphere(), []);
    assert_eq!(
        close(shapes::torus(3, 3)).check_sphere(),
        [TdsError::Euler(0)]
    );
    let two = close(shapes::both(shapes::octahedron(), shapes::torus(3, 3)));
    assert_eq!(two.check_sphere(), [TdsError::NotConnected(CellId::new(8))]);
    let (vertices, cells) = shapes::octahedron();
    let finite = build::<3>(vertices, &cells).unwrap();
    assert_eq!(
        finite.check_sphere(),
        [TdsError::Isolated(VertexId::INFINITE)]
    );
}

/// Damages a list of cells somewhere.
fn damage(random: &mut Random, vertices: usize, cells: &mut Vec<Cell>) {
    let k = random.index(cells.len());
    let i = random.index(cells[k].len());
    match random.below(6) {
        0 => drop(cells.remove(k)),
        1 => cells.push(cells[k].clone()),
        2 => cells[k].swap(i, 0),
        3 => cells[k].rotate_left(1),
        4 => {
            // One vertex is replaced by another one everywhere.
            let [from, to] = [(); 2].map(|()| random.index(vertices));
            cells
                .iter_mut()
                .flatten()
                .filter(|v| **v == from)
                .for_each(|v| *v = to);
        }
        _ => cells[k][i] = random.index(vertices + 1),
    }
}

#[test]
fn damage_is_refused_exactly_where_the_judge_refuses_it() {
    let mut random = Random(17);
    let (mut taken, mut refused) = (0, 0);
    let mut compare = |vertices: usize, cells: &[Cell], width: usize| {
        let result = if width == 3 {
            build::<3>(vertices, cells).err()
        } else {
            build::<4>(vertices, cells).err()
        };
        let is_sound = is_sound(vertices, cells);
        assert_eq!(result.is_none(), is_sound, "{result:?}: {cells:?}");
        *(if is_sound { &mut taken } else { &mut refused }) += 1;
    };
    for _ in 0..60 {
        for ((vertices, mut cells), _) in surfaces() {
            (0..1 + random.below(2)).for_each(|_| damage(&mut random, vertices, &mut cells));
            compare(vertices, &cells, 3);
        }
        for (vertices, mut cells) in spaces().into_iter().take(2) {
            damage(&mut random, vertices, &mut cells);
            compare(vertices, &cells, 4);
        }
    }
    assert!(taken > 20 && refused > 200, "{taken} {refused}");
}
