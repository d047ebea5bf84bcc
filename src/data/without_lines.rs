use std::io::Write;

use super::{Census, EdgeKind, FaceAcross, LineEdges, Surface, same_faces};
use crate::error::{Error, Result, Setting, wording};

/// A surface without its lines: what programs read that know vertices and triangles only.
#[derive(Clone, Copy)]
pub struct WithoutLines<'a>(pub &'a dyn Surface);

impl Surface for WithoutLines<'_> {
    same_faces!(0);

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.0.position(vertex)
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
}
