//! A triangulation in space, as it is stored.

use crate::io::codec::triangle::Nodes;

/// The corners of the facet opposite each corner, counter-clockwise as seen from outside.
pub(crate) const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [2, 0, 3], [0, 1, 3], [1, 0, 2]];

/// A triangulation in space as stored in TetGen's files.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tetrahedralized {
    /// Vertices: all points of the input.
    pub nodes: Nodes<3>,
    /// Corners of the tetrahedra, as indices of vertices.
    pub tetrahedra: Vec<[u32; 4]>,
    /// The tetrahedron opposite each corner; empty if they are not known.
    pub neighbors: Vec<[Option<u32>; 4]>,
}

impl Tetrahedralized {
    /// Returns the facets of the convex hull, counter-clockwise as seen from outside.
    pub fn hull(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        let around = self.tetrahedra.iter().zip(&self.neighbors);
        around.flat_map(|(corners, neighbors)| {
            let free = (0..4).filter(|&i| neighbors[i].is_none());
            free.map(|i| FACETS[i].map(|k| corners[k]))
        })
    }

    /// Returns all edges in ascending order, each with its ends in ascending order, and true for
    /// those on the convex hull.
    ///
    /// # Complexity
    /// O(m log m) for m tetrahedra.
    pub fn edges(&self) -> Vec<([u32; 2], bool)> {
        let sorted = |a: u32, b: u32| [a.min(b), a.max(b)];
        let mut of_hull: Vec<[u32; 2]> = self
            .hull()
            .flat_map(|[a, b, c]| [sorted(a, b), sorted(b, c), sorted(c, a)])
            .collect();
        of_hull.sort_unstable();
        of_hull.dedup();
        let pairs = |&[a, b, c, d]: &[u32; 4]| [[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]];
        let mut all: Vec<[u32; 2]> = self
            .tetrahedra
            .iter()
            .flat_map(pairs)
            .map(|[a, b]| sorted(a, b))
            .collect();
        all.sort_unstable();
        all.dedup();
        all.into_iter()
            .map(|edge| (edge, of_hull.binary_search(&edge).is_ok()))
            .collect()
    }
}
