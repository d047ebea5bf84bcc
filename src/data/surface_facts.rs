use super::surface::{LineEdges, faces};
use super::{Bounds, Surface};

/// Counts and extent of a surface. Vertices that no face uses do not count.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFacts {
    /// Vertices that some face uses.
    pub vertices: usize,
    /// Triangles.
    pub triangles: usize,
    /// Edges on lines.
    pub edges: LineEdges,
    /// The box around these vertices.
    pub extent: Bounds,
}

impl SurfaceFacts {
    /// Returns the counts over all faces of a surface.
    ///
    /// # Complexity
    /// Linear.
    pub fn of(surface: &dyn Surface) -> Self {
        let mut is_used = vec![false; surface.vertex_count()];
        let mut edges = LineEdges::default();
        let (mut vertices, mut triangles, mut extent) = (0, 0, Bounds::default());
        faces(surface).for_each(|face| {
            triangles += 1;
            edges.add(surface, face.number, face.edges);
            for vertex in face.corners {
                if !std::mem::replace(&mut is_used[vertex as usize], true) {
                    vertices += 1;
                    extent.add(surface.position(vertex));
                }
            }
        });
        SurfaceFacts {
            vertices,
            triangles,
            edges,
            extent,
        }
    }
}
