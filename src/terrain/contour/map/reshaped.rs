//! Surfaces with the triangles of another one.

use crate::crs::Crs;
use crate::data::{EdgeKind, Surface};
use crate::error::Result;

/// A surface with other heights.
pub(super) struct Reshaped<'a> {
    pub(super) surface: &'a dyn Surface,
    /// The height of each vertex.
    pub(super) heights: Vec<f64>,
}

impl Surface for Reshaped<'_> {
    fn vertex_count(&self) -> usize {
        self.surface.vertex_count()
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        let [x, y, z] = self.surface.position(vertex);
        let height = self.heights.get(vertex as usize);
        [x, y, height.copied().unwrap_or(z)]
    }

    fn face_count(&self) -> usize {
        self.surface.face_count()
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        self.surface.face(face)
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        self.surface.neighbor(face, i)
    }

    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        self.surface.edge_kind(face, i)
    }

    fn has_lines(&self) -> bool {
        self.surface.has_lines()
    }

    fn least_width(&self) -> f64 {
        self.surface.least_width()
    }

    fn crs(&self) -> Option<&Crs> {
        self.surface.crs()
    }

    fn ensure_intact(&self) -> Result<()> {
        self.surface.ensure_intact()
    }
}

/// Returns true if the edge opposite a corner is held: on a hard breakline, a wall, a shore or a
/// bank.
pub(super) fn is_held(surface: &dyn Surface, face: u32, i: usize) -> bool {
    surface.has_lines() && surface.edge_kind(face, i).is_hard()
}

/// A surface whose faces are not linked across held edges: those of hard breaklines, walls, shores
/// and banks.
pub(super) struct Divided<'a>(pub(super) &'a dyn Surface);

impl Surface for Divided<'_> {
    fn vertex_count(&self) -> usize {
        self.0.vertex_count()
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.0.position(vertex)
    }

    fn face_count(&self) -> usize {
        self.0.face_count()
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        self.0.face(face)
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        let is_linked = !is_held(self.0, face, i);
        self.0.neighbor(face, i).filter(|_| is_linked)
    }

    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        self.0.edge_kind(face, i)
    }

    fn crs(&self) -> Option<&Crs> {
        self.0.crs()
    }

    fn ensure_intact(&self) -> Result<()> {
        self.0.ensure_intact()
    }
}
