//! All parts as one surface.

use std::ops::Range;

use crate::crs::Crs;
use crate::data::{BaseFace, EdgeKind, Mesh, Surface};

/// All parts as one surface, with the triangles under it: so each method of interpolation gives the
/// heights of the surface in one piece.
///
/// Whole faces are numbered first, then the triangles that are only under the surface, then
/// fragments.
#[derive(Debug)]
pub(crate) struct JoinedTin {
    /// The whole faces, then the fragments.
    pub(super) faces: Mesh,
    /// The whole faces, then the other triangles under the surface; `None` if the faces are all.
    pub(super) under: Option<Mesh>,
    /// The number of whole faces.
    pub(super) whole: u32,
}

impl JoinedTin {
    /// The position of a face in the list of faces.
    fn listed(&self, face: u32) -> Option<u32> {
        match face.checked_sub(self.base_count() as u32) {
            Some(fragment) => Some(self.whole + fragment),
            None => Some(face).filter(|&face| face < self.whole),
        }
    }

    /// The number of a face in the list of faces.
    fn number(&self, listed: u32) -> u32 {
        match listed.checked_sub(self.whole) {
            Some(fragment) => self.base_count() as u32 + fragment,
            None => listed,
        }
    }
}

impl Surface for JoinedTin {
    fn vertex_count(&self) -> usize {
        self.faces.vertex_count()
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.faces.position(vertex)
    }

    fn face_count(&self) -> usize {
        self.base_count() + self.faces.face_count() - self.whole as usize
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        self.faces.face(self.listed(face)?)
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        self.faces
            .neighbor(self.listed(face)?, i)
            .map(|listed| self.number(listed))
    }

    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        self.listed(face)
            .map_or(EdgeKind::Rim, |listed| self.faces.edge_kind(listed, i))
    }

    fn is_fragment(&self, face: u32) -> bool {
        face as usize >= self.base_count()
    }

    fn crs(&self) -> Option<&Crs> {
        self.faces.crs()
    }

    fn base_count(&self) -> usize {
        self.under
            .as_ref()
            .map_or(self.whole as usize, Surface::face_count)
    }

    fn base_faces_in(&self, numbers: Range<u32>, faces: &mut Vec<BaseFace>) {
        self.under
            .as_ref()
            .unwrap_or(&self.faces)
            .base_faces_in(numbers, faces);
    }
}
