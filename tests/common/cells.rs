//! Triangulations by their cells, whatever numbers these and the vertices have.

use std::collections::BTreeSet;

use breakline::geometry::Coordinates;
use breakline::tds::VertexId;
use breakline::triangulation::Triangulation;

/// The finite cells of any dimension, each as the sorted keys of its corners' coordinates.
pub(crate) fn cells<G, const N: usize, V, C, K>(
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
