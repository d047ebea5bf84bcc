//! All parts as one surface where they are, linked within each part only.

use std::ops::Range;

use super::TinParts;
use crate::crs::Crs;
use crate::data::{Bounds, EdgeKind, Surface};
use crate::error::{Error, Result};
use crate::io::mapped::Mapped;
use crate::terrain::CompactTin;

/// All parts as one surface, in their files: for what needs triangles, but not their neighbors in
/// other parts. Positions on an edge between parts are on a face of each.
pub(crate) struct UnjoinedTin<'a> {
    parts: Vec<Part>,
    faces: usize,
    vertices: usize,
    crs: Option<&'a Crs>,
}

struct Part {
    tin: CompactTin<Mapped>,
    extent: Bounds,
    /// The numbers of its first face and its first vertex.
    first_face: u32,
    first_vertex: u32,
}

impl TinParts {
    /// Returns the surface without joining its parts, which stay in their files.
    ///
    /// # Errors
    /// If a part is damaged, or there are more faces than can be numbered.
    ///
    /// # Complexity
    /// Linear in the number of parts.
    pub(crate) fn unjoined(&self) -> Result<UnjoinedTin<'_>> {
        let mut all = UnjoinedTin {
            parts: Vec::with_capacity(self.index.parts.len()),
            faces: 0,
            vertices: 0,
            crs: self.crs(),
        };
        for (number, part) in self.index.parts.iter().enumerate() {
            let tin = self.part(number)?;
            let (first_face, first_vertex) = (all.faces, all.vertices);
            all.faces += tin.face_count();
            all.vertices += tin.vertex_count();
            if all.faces.max(all.vertices) > u32::MAX as usize {
                return Err(Error::limit(format!(
                    "a surface of more than {} numbered triangles",
                    u32::MAX
                ))
                .in_file(&self.path)
                .cure("take a part of it"));
            }
            all.parts.push(Part {
                tin,
                extent: part.extent,
                first_face: first_face as u32,
                first_vertex: first_vertex as u32,
            });
        }
        Ok(all)
    }
}

impl UnjoinedTin<'_> {
    /// Returns the part of a face, and its number there.
    fn of_face(&self, face: u32) -> Option<(&Part, u32)> {
        let next = self.parts.partition_point(|part| part.first_face <= face);
        let part = self.parts.get(next.checked_sub(1)?)?;
        Some((part, face - part.first_face))
    }

    /// Calls a function for each part that has faces in a range of numbers, with the range there.
    fn each_part(&self, numbers: Range<u32>, mut each: impl FnMut(&Part, Range<u32>)) {
        for part in &self.parts {
            let count = part.tin.face_count() as u32;
            let start = numbers.start.saturating_sub(part.first_face);
            let end = numbers.end.saturating_sub(part.first_face).min(count);
            if start < end {
                each(part, start..end);
            }
        }
    }
}

impl Surface for UnjoinedTin<'_> {
    fn vertex_count(&self) -> usize {
        self.vertices
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        let next = self
            .parts
            .partition_point(|part| part.first_vertex <= vertex);
        match next.checked_sub(1).and_then(|part| self.parts.get(part)) {
            Some(part) => part.tin.position(vertex - part.first_vertex),
            None => [f64::NAN; 3],
        }
    }

    fn face_count(&self) -> usize {
        self.faces
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        let (part, face) = self.of_face(face)?;
        Some(part.tin.face(face)?.map(|v| v + part.first_vertex))
    }

    fn triangle(&self, face: u32) -> Option<[[f64; 3]; 3]> {
        let (part, face) = self.of_face(face)?;
        part.tin.triangle(face)
    }

    /// The neighbor in the same part; none is known in another one.
    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        let (part, face) = self.of_face(face)?;
        Some(part.tin.neighbor(face, i)? + part.first_face)
    }

    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        self.of_face(face)
            .map_or(EdgeKind::Rim, |(part, face)| part.tin.edge_kind(face, i))
    }

    fn is_fragment(&self, face: u32) -> bool {
        self.of_face(face)
            .is_some_and(|(part, face)| part.tin.is_fragment(face))
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs
    }

    fn ensure_intact(&self) -> Result<()> {
        self.parts
            .iter()
            .try_for_each(|part| part.tin.ensure_intact())
    }

    fn corners_in(&self, numbers: Range<u32>, faces: &mut Vec<(u32, [u32; 3])>) {
        self.each_part(numbers, |part, numbers| {
            let start = faces.len();
            part.tin.corners_in(numbers, faces);
            for (face, corners) in &mut faces[start..] {
                *face += part.first_face;
                *corners = corners.map(|v| v + part.first_vertex);
            }
        });
    }

    fn triangles_in(&self, numbers: Range<u32>, triangles: &mut Vec<(u32, [[f64; 3]; 3])>) {
        self.each_part(numbers, |part, numbers| {
            let start = triangles.len();
            part.tin.triangles_in(numbers, triangles);
            for (face, _) in &mut triangles[start..] {
                *face += part.first_face;
            }
        });
    }

    /// # Complexity
    /// A comparison for each part, and a walk in those whose extent has the position.
    fn faces_at(&self, q: [f64; 2], near: &mut Option<u32>, faces: &mut Vec<u32>) -> bool {
        let before = near.and_then(|face| self.of_face(face));
        let (before, start) = (
            before.map(|(part, face)| (part.first_face, face)),
            faces.len(),
        );
        for part in &self.parts {
            if !part.extent.holds(q[0], q[1]) {
                continue;
            }
            let mut own = before
                .filter(|(first, _)| *first == part.first_face)
                .map(|(_, face)| face);
            let first = faces.len();
            if !part.tin.faces_at(q, &mut own, faces) {
                faces.truncate(start);
                return false;
            }
            faces[first..]
                .iter_mut()
                .for_each(|face| *face += part.first_face);
            *near = own.map(|face| face + part.first_face).or(*near);
        }
        true
    }
}
