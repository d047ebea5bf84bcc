use super::{Complex, VertexId, plane, space};

/// A complex whose vertices list their neighbors: every [`Complex`] of the plane or of space.
/// Algorithms that are the same in both need no more than this.
pub trait Neighbors<const N: usize>: Complex<N> {
    /// Returns the vertices that a vertex is joined to by an edge, the infinite one included. In
    /// the plane each is met once, in the order of [`plane::vertices_around`]; in space at least
    /// once, while the star of the vertex is still being searched.
    ///
    /// # Errors
    /// If the vertex does not exist, or a link around it does not hold.
    fn neighbors_of(
        &self,
        vertex: VertexId,
    ) -> Result<impl Iterator<Item = Result<VertexId, Self::Error>> + use<'_, Self, N>, Self::Error>;
}

impl<T: Complex<3>> Neighbors<3> for T {
    #[inline]
    fn neighbors_of(
        &self,
        vertex: VertexId,
    ) -> Result<impl Iterator<Item = Result<VertexId, T::Error>> + use<'_, T>, T::Error> {
        plane::vertices_around(self, vertex)
    }
}

impl<T: Complex<4>> Neighbors<4> for T {
    fn neighbors_of(
        &self,
        vertex: VertexId,
    ) -> Result<impl Iterator<Item = Result<VertexId, T::Error>> + use<'_, T>, T::Error> {
        space::neighbors_of(self, vertex)
    }
}
