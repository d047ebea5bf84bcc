use crate::crs::Crs;

/// A surface of triangles, in plan without overlaps: a TIN, a mesh from a file, the cells of a grid.
///
/// Vertices and faces are numbered from 0; some numbers may be unused. Corners are
/// counter-clockwise in plan, and neighbor `i` of a face lies across the edge opposite corner `i`.
pub trait Surface: Sync {
    /// One more than the largest vertex number.
    fn vertex_count(&self) -> usize;

    /// Where a vertex is.
    fn position(&self, vertex: u32) -> [f64; 3];

    /// One more than the largest face number.
    fn face_count(&self) -> usize;

    /// The corners of a face, counter-clockwise; `None` where the number is unused or the face is
    /// not part of the surface.
    fn face(&self, face: u32) -> Option<[u32; 3]>;

    /// The face across the edge opposite corner `i`; `None` at the edge of the surface.
    fn neighbor(&self, face: u32, i: usize) -> Option<u32>;

    /// Whether the edge opposite corner `i` is a breakline (or another constraint).
    fn is_constrained(&self, face: u32, i: usize) -> bool;

    /// Coordinate system, if known.
    fn crs(&self) -> Option<&Crs>;
}
