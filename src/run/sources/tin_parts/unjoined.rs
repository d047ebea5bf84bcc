//! All parts as one surface where they are.

use std::ops::Range;

use super::TinParts;
use super::seams::Seams;
use crate::crs::Crs;
use crate::data::{Bounds, EdgeKind, FaceAcross, Surface};
use crate::error::{Error, Result};
use crate::io::mapped::Mapped;
use crate::run::context::Context;
use crate::run::context::watched::Watched;
use crate::terrain::CompactTin;

/// All parts as one surface, in their files. A vertex that parts share has a number in each of
/// them. Positions on an edge between parts are on a face of each.
pub(crate) struct UnjoinedTin<'a> {
    parts: Vec<Part>,
    /// None if only the faces of each part are linked.
    seams: Seams,
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
    /// Returns the surface without joining its parts, which stay in their files. Only the faces of
    /// each part are linked.
    ///
    /// # Errors
    /// If a part is damaged, or there are more faces than can be numbered.
    ///
    /// # Complexity
    /// Linear in the number of parts.
    pub(crate) fn unjoined(&self) -> Result<UnjoinedTin<'_>> {
        let mut all = UnjoinedTin {
            parts: Vec::with_capacity(self.index.parts.len()),
            seams: Seams::default(),
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

    /// Like [`unjoined`](Self::unjoined), but faces of different parts are linked, too.
    ///
    /// # Errors
    /// Those of [`unjoined`](Self::unjoined), and if the run is canceled.
    ///
    /// # Complexity
    /// Linear in the faces, on all threads; 16 bytes for each side of an edge between parts.
    pub(crate) fn linked(&self, context: &Context) -> Result<UnjoinedTin<'_>> {
        let all = self.unjoined()?;
        let polled = Watched::polled(&all, context)?;
        let seams = Seams::of(&polled, &|vertex| all.number_in_parts(vertex));
        polled.end()?;
        Ok(UnjoinedTin { seams, ..all })
    }
}

impl UnjoinedTin<'_> {
    /// Returns the part of a face, and its number there.
    fn of_face(&self, face: u32) -> Option<(&Part, u32)> {
        let next = self.parts.partition_point(|part| part.first_face <= face);
        let part = self.parts.get(next.checked_sub(1)?)?;
        Some((part, face - part.first_face))
    }

    /// Returns the part of a vertex, and its number there.
    fn of_vertex(&self, vertex: u32) -> Option<(&Part, u32)> {
        let next = self
            .parts
            .partition_point(|part| part.first_vertex <= vertex);
        let part = self.parts.get(next.checked_sub(1)?)?;
        Some((part, vertex - part.first_vertex))
    }

    /// Returns the number of a vertex that is the same in all parts which share it.
    fn number_in_parts(&self, vertex: u32) -> Option<u64> {
        let (part, vertex) = self.of_vertex(vertex)?;
        let [tile, number] = part.tin.number_in_parts(vertex)?;
        Some(u64::from(tile) << 32 | u64::from(number))
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
        match self.of_vertex(vertex) {
            Some((part, vertex)) => part.tin.position(vertex),
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

    /// The neighbor in the same part; in another one only if parts are linked.
    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        let (part, own) = self.of_face(face)?;
        match part.tin.neighbor(own, i) {
            Some(neighbor) => Some(neighbor + part.first_face),
            None => self.seams.across(face, i).map(|side| side.face),
        }
    }

    fn across(&self, face: u32, i: usize) -> Option<FaceAcross> {
        let (part, own) = self.of_face(face)?;
        if let Some(across) = part.tin.across(own, i) {
            let number = across.number + part.first_face;
            return Some(FaceAcross { number, ..across });
        }
        let side = self.seams.across(face, i)?;
        let corner = usize::from(side.corner);
        Some(FaceAcross {
            number: side.face,
            corner,
            apex: self.triangle(side.face)?[corner],
        })
    }

    fn edge_kind(&self, face: u32, i: usize) -> EdgeKind {
        let Some((part, own)) = self.of_face(face) else {
            return EdgeKind::Rim;
        };
        match part.tin.edge_kind(own, i) {
            EdgeKind::Rim if self.seams.across(face, i).is_some() => EdgeKind::Plain,
            kind => kind,
        }
    }

    fn has_lines(&self) -> bool {
        self.parts.iter().any(|part| part.tin.has_lines())
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
