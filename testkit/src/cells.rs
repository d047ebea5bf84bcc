//! Triangulations as sets of cells, independent of the numbers of cells or vertices.

use std::collections::BTreeSet;

use breakline_triangulation::Triangulation;
use breakline_triangulation::geometry::{Coordinates, Geometry};
use breakline_triangulation::tds::{CellId, VertexId};

/// Returns the finite cells, in any dimension, each as the sorted keys of its corners' coordinates.
pub fn cells<G, const N: usize, V, C, K>(
    t: &Triangulation<G, N, V, C>,
    key: impl Fn(G::Coordinates) -> K,
) -> BTreeSet<Vec<K>>
where
    G: Coordinates<N>,
    C: Copy + Default,
    K: Ord,
{
    let key_of = |v: &VertexId| key(t.geometry().coordinates(t.point(*v)));
    t.finite_cells()
        .map(|cell| {
            let mut corners: Vec<K> = t.tds().cell_vertices(cell).iter().map(key_of).collect();
            corners.sort_unstable();
            corners
        })
        .collect()
}

/// Returns all cells of the plane, the infinite ones included, by the numbers of their vertices.
pub fn by_vertices<G: Geometry<3>, V, C: Copy + Default>(
    t: &Triangulation<G, 3, V, C>,
) -> BTreeSet<Vec<VertexId>> {
    t.tds().cells().map(|cell| vertices(t, cell)).collect()
}

/// Returns the vertices of a cell, starting with the smallest, so that the orientation is kept.
pub fn vertices<G: Geometry<3>, V, C: Copy + Default>(
    t: &Triangulation<G, 3, V, C>,
    cell: CellId,
) -> Vec<VertexId> {
    let mut vertices = t.tds().cell_vertices(cell).to_vec();
    let smallest = (0..vertices.len())
        .min_by_key(|&i| vertices[i])
        .unwrap_or(0);
    vertices.rotate_left(smallest);
    vertices
}
