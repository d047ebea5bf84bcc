use crate::crs::Crs;
use crate::data::{EdgeKind, Surface};

/// A surface under the coordinate system that the user says it has.
pub(super) struct Relabeled<S> {
    pub(super) surface: S,
    pub(super) crs: Option<Crs>,
}

impl<S: Surface> Surface for Relabeled<S> {
    fn vertex_count(&self) -> usize {
        self.surface.vertex_count()
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.surface.position(vertex)
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

    fn is_piece(&self, face: u32) -> bool {
        self.surface.is_piece(face)
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }
}
