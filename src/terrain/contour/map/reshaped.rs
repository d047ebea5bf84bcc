//! Surfaces with the triangles of another one.

use std::ops::Range;

use crate::data::{EdgeKind, Face, FaceAcross, Surface, same_faces};

/// A surface with other heights.
pub(super) struct Reshaped<'a> {
    pub(super) surface: &'a dyn Surface,
    /// The height of each vertex.
    pub(super) heights: Vec<f64>,
}

impl Reshaped<'_> {
    /// Calls `take` with each face in a range of numbers and its corners.
    fn each_in(&self, numbers: Range<u32>, take: impl FnMut((u32, [u32; 3]))) {
        let mut faces = Vec::with_capacity(numbers.len());
        self.corners_in(numbers, &mut faces);
        faces.into_iter().for_each(take);
    }

    fn height(&self, vertex: u32) -> f64 {
        let height = self.heights.get(vertex as usize).copied();
        height.unwrap_or_else(|| self.surface.position(vertex)[2])
    }
}

impl Surface for Reshaped<'_> {
    same_faces!(surface);

    fn position(&self, vertex: u32) -> [f64; 3] {
        let [x, y, _] = self.surface.position(vertex);
        [x, y, self.height(vertex)]
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        self.surface.neighbor(face, i)
    }

    fn across(&self, face: u32, i: usize) -> Option<FaceAcross> {
        let mut across = self.surface.across(face, i)?;
        let corners = self.surface.face(across.number)?;
        across.apex[2] = self.height(*corners.get(across.corner)?);
        Some(across)
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

    fn triangles_in(&self, numbers: Range<u32>, triangles: &mut Vec<(u32, [[f64; 3]; 3])>) {
        self.each_in(numbers, |(face, corners)| {
            triangles.push((face, corners.map(|v| self.position(v))));
        });
    }

    fn faces_in(&self, numbers: Range<u32>, faces: &mut Vec<Face>) {
        self.surface.faces_in(numbers, faces);
    }

    fn heights_in(
        &self,
        numbers: Range<u32>,
        is_wanted: &dyn Fn(f64, f64) -> bool,
        faces: &mut Vec<(u32, [f64; 3])>,
    ) {
        self.each_in(numbers, |(face, corners)| {
            let [a, b, c] = corners.map(|v| self.height(v));
            if is_wanted(a.min(b).min(c), a.max(b).max(c)) {
                faces.push((face, [a, b, c]));
            }
        });
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
    same_faces!(0);

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.0.position(vertex)
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        let is_linked = !is_held(self.0, face, i);
        self.0.neighbor(face, i).filter(|_| is_linked)
    }

    fn across(&self, face: u32, i: usize) -> Option<FaceAcross> {
        let is_linked = !is_held(self.0, face, i);
        is_linked.then(|| self.0.across(face, i))?
    }

    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        self.0.edge_kind(face, i)
    }
}
