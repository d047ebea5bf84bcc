use std::io::Write;
use std::ops::Range;

use super::{Census, EdgeKind, FaceAcross, LineEdges, Surface};
use crate::crs::Crs;
use crate::error::{Error, Result, Setting, wording};

/// A surface without its lines: what programs read that know vertices and triangles only.
#[derive(Clone, Copy)]
pub struct WithoutLines<'a>(pub &'a dyn Surface);

impl Surface for WithoutLines<'_> {
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
        self.0.neighbor(face, i)
    }

    fn across(&self, face: u32, i: usize) -> Option<FaceAcross> {
        self.0.across(face, i)
    }

    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        match self.0.neighbor(face, i) {
            Some(_) => EdgeKind::Plain,
            None => EdgeKind::Rim,
        }
    }

    fn has_lines(&self) -> bool {
        false
    }

    fn is_between(&self, vertex: u32) -> bool {
        self.0.is_between(vertex)
    }

    fn faces_at(&self, q: [f64; 2], near: &mut Option<u32>, faces: &mut Vec<u32>) -> bool {
        self.0.faces_at(q, near, faces)
    }

    fn crs(&self) -> Option<&Crs> {
        self.0.crs()
    }

    fn ensure_intact(&self) -> Result<()> {
        self.0.ensure_intact()
    }

    fn write_tin(&self, _out: &mut dyn Write) -> Result<()> {
        Err(
            Error::usage("a .tin holds the triangulation with its lines").cure(wording![
                "leave ",
                Setting::Plain,
                " out, or write .ply"
            ]),
        )
    }

    fn census(&self) -> Census {
        Census {
            lines: LineEdges::default(),
            ..self.0.census()
        }
    }

    fn corners_in(&self, range: Range<u32>, out: &mut Vec<(u32, [u32; 3])>) {
        self.0.corners_in(range, out);
    }
}
