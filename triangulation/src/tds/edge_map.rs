use rustc_hash::FxHashMap;

use super::{CellId, Tds, VertexId};

/// Maps edges to values: data on edges, which a [`Tds`] does not store itself.
///
/// An edge is given by its ends, in either order, so that its value stays when the cells around it
/// change, or when it vanishes and comes again. Values of edges that vanished for good remain until
/// [`retain`](Self::retain). For data that depends on the direction, let the value have two parts:
/// [`key`](Self::key) returns the ends in the order that all calls use.
///
/// ```
/// use breakline_triangulation::Delaunay;
/// use breakline_triangulation::geometry::Plane;
/// use breakline_triangulation::tds::EdgeMap;
///
/// let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
/// let (mut t, v) = Delaunay::from_points(Plane::new(), &corners)?;
/// let mut names = EdgeMap::new();
/// names.insert([v[0], v[1]], "road");
/// names.insert([v[1], v[3]], "hedge");
/// assert_eq!(names.get([v[1], v[0]]), Some(&"road"));
///
/// t.insert([2.0, 1.5])?;
/// names.retain(|[a, b], _| t.tds().edge(a, b).is_some());
/// assert_eq!((names.len(), names.get([v[3], v[1]])), (1, None));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct EdgeMap<T> {
    values: FxHashMap<[VertexId; 2], T>,
}

impl<T> Default for EdgeMap<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T> EdgeMap<T> {
    /// Returns a map without values.
    pub fn new() -> Self {
        EdgeMap {
            values: FxHashMap::default(),
        }
    }

    /// Returns the ends of an edge in the order of their numbers.
    pub fn key([a, b]: [VertexId; 2]) -> [VertexId; 2] {
        if a <= b { [a, b] } else { [b, a] }
    }

    /// Sets the value of an edge, and returns the value that it had. O(1).
    pub fn insert(&mut self, ends: [VertexId; 2], value: T) -> Option<T> {
        self.values.insert(Self::key(ends), value)
    }

    /// Removes the value of an edge, and returns it. O(1).
    pub fn remove(&mut self, ends: [VertexId; 2]) -> Option<T> {
        self.values.remove(&Self::key(ends))
    }

    /// Returns the value of an edge. O(1).
    pub fn get(&self, ends: [VertexId; 2]) -> Option<&T> {
        self.values.get(&Self::key(ends))
    }

    /// Returns the value of an edge, mutable. O(1).
    pub fn get_mut(&mut self, ends: [VertexId; 2]) -> Option<&mut T> {
        self.values.get_mut(&Self::key(ends))
    }

    /// Returns the value of the edge opposite vertex `i` of a triangle; `None` if there is no such
    /// edge.
    pub fn of_edge<V, C: Copy + Default>(
        &self,
        tds: &Tds<3, V, C>,
        (cell, i): (CellId, usize),
    ) -> Option<&T> {
        let is_edge = tds.dimension() == 2 && i < 3 && tds.is_used(cell);
        is_edge
            .then(|| tds.edge_ends(cell, i))
            .and_then(|ends| self.get(ends))
    }

    /// Keeps the values of the edges for which `keep` returns true.
    pub fn retain(&mut self, mut keep: impl FnMut([VertexId; 2], &mut T) -> bool) {
        self.values.retain(|&ends, value| keep(ends, value));
    }

    /// The edges that have values, with the values, in order of the ends. O(n log n) for n values.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = ([VertexId; 2], &T)> {
        let mut values: Vec<_> = self
            .values
            .iter()
            .map(|(&ends, value)| (ends, value))
            .collect();
        values.sort_unstable_by_key(|&(ends, _)| ends);
        values.into_iter()
    }

    /// The number of values.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Returns true if there is no value.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }
}
