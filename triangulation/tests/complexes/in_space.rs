//! Edges, facets, stars and rings of complexes in space, against searches through all cells.

use std::collections::BTreeSet;

use breakline_triangulation::Delaunay;
use breakline_triangulation::geometry::{Geometry, Space};
use breakline_triangulation::num::Sign;
use breakline_triangulation::tds::space::{Edge, beside};
use breakline_triangulation::tds::{CellId, Tds, VertexId};
use testkit::random::Random;

use super::judge::{Cell, build, cells_of, faces};
use super::{shapes, spaces};

/// Compares all that can be asked with searches through all cells.
fn judge<V, C: Copy + Default>(tds: &Tds<4, V, C>) {
    let cells = cells_of(tds);
    let width = (tds.dimension() + 1) as usize;
    let has = |cell: CellId, vertices: &[VertexId]| {
        vertices.iter().all(|v| tds.cell_vertices(cell).contains(v))
    };
    let infinite = VertexId::INFINITE.index();
    let set = |vertices: &[VertexId]| -> Cell {
        let mut set: Cell = vertices.iter().copied().map(VertexId::index).collect();
        set.sort_unstable();
        set
    };

    // Each facet and each edge once, at the cell with the smallest number.
    let facets: Vec<(CellId, usize)> = tds.facets().collect();
    let edges: Vec<Edge> = tds.edges().collect();
    assert!(facets.is_sorted() && edges.is_sorted());
    let without = |cell, i| {
        let vertices = tds.cell_vertices(cell).iter().enumerate();
        vertices
            .filter(|&(k, _)| k != i)
            .map(|(_, &v)| v)
            .collect::<Vec<VertexId>>()
    };
    let facet_sets: BTreeSet<Cell> = facets
        .iter()
        .map(|&(cell, i)| set(&without(cell, i)))
        .collect();
    let edge_sets: BTreeSet<Cell> = edges
        .iter()
        .map(|&edge| set(&tds.edge_ends(edge)))
        .collect();
    assert_eq!(
        (facet_sets.len(), edge_sets.len()),
        (facets.len(), edges.len())
    );
    if tds.dimension() > 0 {
        assert_eq!(facet_sets, faces(&cells, width - 1));
        assert_eq!(edge_sets, faces(&cells, 2));
    }
    assert_eq!(
        tds.finite_edges().count(),
        edge_sets
            .iter()
            .filter(|edge| !edge.contains(&infinite))
            .count()
    );
    assert_eq!(
        tds.finite_facets().count(),
        facet_sets
            .iter()
            .filter(|facet| !facet.contains(&infinite))
            .count()
    );

    // Stars.
    for vertex in tds
        .vertices()
        .chain([VertexId::INFINITE])
        .filter(|&v| tds.cell_of(v).is_some())
    {
        let star = tds.cells_around(vertex);
        assert!(star.iter().all(|&(cell, i)| tds.vertex(cell, i) == vertex));
        let found: BTreeSet<CellId> = star.iter().map(|&(cell, _)| cell).collect();
        assert_eq!(found.len(), star.len(), "each once");
        assert_eq!(
            found,
            tds.cells().filter(|&cell| has(cell, &[vertex])).collect()
        );
        let joined = edge_sets
            .iter()
            .filter(|edge| edge.contains(&vertex.index()));
        let others: BTreeSet<usize> = joined
            .flatten()
            .copied()
            .filter(|&v| v != vertex.index())
            .collect();
        let around = tds.vertices_around(vertex);
        assert!(around.is_sorted());
        assert_eq!(
            around
                .iter()
                .copied()
                .map(VertexId::index)
                .collect::<BTreeSet<usize>>(),
            others
        );
        assert_eq!(
            (around.len(), tds.degree(vertex)),
            (others.len(), others.len())
        );
    }

    // Rings.
    for &edge in &edges {
        let ends = tds.edge_ends(edge);
        assert!(tds.cell_with(&ends).is_some_and(|cell| has(cell, &ends)));
        let ring: Vec<Edge> = tds.cells_around_edge(edge).collect();
        if tds.dimension() < 3 {
            assert_eq!(ring, []);
            continue;
        }
        assert_eq!(ring[0], edge);
        let found: BTreeSet<CellId> = ring.iter().map(|&(cell, ..)| cell).collect();
        assert_eq!(found.len(), ring.len(), "each once");
        assert_eq!(
            found,
            tds.cells().filter(|&cell| has(cell, &ends)).collect()
        );
        let mut back: Vec<Edge> = tds.cells_around_edge(edge).rev().collect();
        back.reverse();
        assert_eq!(back, ring);
        let mut both = tds.cells_around_edge(edge);
        let mut met = BTreeSet::new();
        while let Some((cell, ..)) = both.next() {
            met.insert(cell);
            met.extend(both.next_back().map(|(cell, ..)| cell));
        }
        assert_eq!(met, found, "from both ends");
        for (k, &(cell, i, j)) in ring.iter().enumerate() {
            assert_eq!([tds.vertex(cell, i), tds.vertex(cell, j)], ends);
            let (next, ..) = ring[(k + 1) % ring.len()];
            assert_eq!(tds.neighbor(cell, beside(i, j)[0]), next);
        }
        let facets: Vec<(CellId, usize)> = tds.facets_around_edge(edge).collect();
        let beyond: Vec<CellId> = facets
            .iter()
            .map(|&(cell, i)| tds.neighbor(cell, i))
            .collect();
        assert!(
            facets
                .iter()
                .map(|facet| facet.0)
                .eq(ring.iter().map(|cell| cell.0))
        );
        assert!(
            beyond.iter().eq(ring
                .iter()
                .map(|cell| &cell.0)
                .cycle()
                .skip(1)
                .take(ring.len()))
        );
        assert_eq!(tds.cells_around_edge((edge.0, edge.1, edge.1)).count(), 0);
        assert_eq!(tds.cell_with(&[ends[0], ends[1], ends[0]]), None);
        assert!(
            facets
                .iter()
                .all(|&(cell, i)| without(cell, i).contains(&ends[0]))
        );
        assert!(
            facets
                .iter()
                .all(|&(cell, i)| without(cell, i).contains(&ends[1]))
        );
    }
}

#[test]
fn of_closed_manifolds() {
    for (vertices, cells) in spaces()
        .into_iter()
        .chain([shapes::both(shapes::simplex(5), shapes::three_torus(3))])
    {
        let tds = build::<4>(vertices, &cells).unwrap();
        judge(&tds);
        assert!(tds.edges().all(|(cell, i, j)| i < j && tds.is_used(cell)));
        for cell in tds.cells() {
            assert_eq!(tds.cell_with(tds.cell_vertices(cell)), Some(cell));
        }
    }
}

/// Points of small grids, where many are collinear or coplanar, so that all dimensions occur.
#[test]
fn of_triangulations_of_any_dimension() {
    let mut random = Random(1);
    let mut dimensions = BTreeSet::new();
    for round in 0..60 {
        let sizes: [u64; 3] = [[4, 1, 1], [3, 3, 1], [2, 2, 2], [3, 3, 3]][round % 4];
        let count = random.below(13);
        let points: Vec<[f64; 3]> = (0..count)
            .map(|_| sizes.map(|size| random.below(size) as f64))
            .collect();
        let (t, _) = Delaunay::<Space, 4>::from_points(Space::new(), &points).unwrap();
        dimensions.insert(t.dimension());
        judge(t.tds());
        let infinite = t
            .tds()
            .cells()
            .filter(|&cell| t.dimension() == 3 && t.tds().is_infinite(cell));
        let beyond: BTreeSet<CellId> = t.tds().hull_facets().map(|(cell, _)| cell).collect();
        assert_eq!(beyond, infinite.collect());
        let all: Vec<VertexId> = t.tds().vertices().collect();
        for triple in all.windows(3) {
            let has = |cell: CellId| {
                triple
                    .iter()
                    .all(|v| t.tds().cell_vertices(cell).contains(v))
            };
            assert_eq!(
                t.tds().cell_with(triple).is_some(),
                t.tds().cells().any(has)
            );
        }
    }
    assert_eq!(dimensions, BTreeSet::from([-1, 0, 1, 2, 3]));
}

/// Seen from the end of an edge, cells follow each other counter-clockwise.
#[test]
fn rings_are_counter_clockwise() {
    let space = <Space>::new();
    let at = [
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
    ];
    let points: Vec<[f64; 3]> = [[0.0, 0.0, -0.5], [0.0, 0.0, 0.5]]
        .into_iter()
        .chain(
            (0..6)
                .map(|k| (f64::from(k) * std::f64::consts::FRAC_PI_3).sin_cos())
                .map(|(y, x)| [x, y, 0.0]),
        )
        .collect();
    let (t, v) = Delaunay::<Space, 4>::from_points(space, &points).unwrap();
    let tds = t.tds();
    let cell = tds.cell_with(&[v[0], v[1]]).unwrap();
    let [i, j] = [v[0], v[1]].map(|vertex| tds.index_of(cell, vertex).unwrap());
    let ring: Vec<Edge> = tds.cells_around_edge((cell, i, j)).collect();
    assert_eq!(ring.len(), 6);
    for (k, &(cell, i, j)) in ring.iter().enumerate() {
        let [from, to] = beside(i, j).map(|k| t.point(tds.vertex(cell, k)));
        assert!(
            from[0] * to[1] - from[1] * to[0] > 0.0,
            "cell {k}: from {from:?} to {to:?}"
        );
    }
    assert_eq!(
        space.orientation(at.each_ref()),
        Sign::Positive,
        "the orientation of a cell"
    );
}
