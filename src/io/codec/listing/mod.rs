//! The code that all mesh formats share: lists the vertices and faces of a surface.

pub(crate) mod crs_text;
pub(crate) mod ids;
pub(crate) mod lines;
pub(crate) mod loss;
pub(crate) mod polygon;

use std::ops::Range;
use std::path::PathBuf;

use crate::data::{self, Census, EdgeKind, Surface};

const UNUSED: u32 = u32::MAX;

/// What differs in a written file from the surface.
#[derive(Debug, Clone, Default)]
pub(crate) struct Remarks {
    /// A local origin: what was subtracted from all coordinates, and the file that states it.
    pub(crate) origin: Option<([f64; 3], PathBuf)>,
    /// What the format cannot store.
    pub(crate) notes: Vec<String>,
}

/// The vertices and faces of a surface as listed in a mesh file: in the surface's own order,
/// without unused vertices.
pub(crate) struct Listing<'a> {
    pub(crate) surface: &'a dyn Surface,
    /// Maps each vertex of the surface to its number in the file.
    number: Vec<u32>,
    pub(crate) vertex_count: usize,
    pub(crate) face_count: usize,
    /// Number of edges on lines.
    pub(crate) constrained_edges: usize,
}

impl<'a> Listing<'a> {
    /// Numbers the vertices of a surface.
    ///
    /// # Complexity
    /// Linear, on all threads. Needs 5 bytes per vertex, of which 4 are kept.
    pub(crate) fn new(surface: &'a dyn Surface) -> Self {
        let Census { used, faces, lines } = surface.census();
        let mut next = 0;
        let number_of = |is_used: bool| {
            let number = if is_used { next } else { UNUSED };
            next += u32::from(is_used);
            number
        };
        Listing {
            surface,
            number: used.into_iter().map(number_of).collect(),
            vertex_count: next as usize,
            face_count: faces,
            constrained_edges: lines.total(),
        }
    }

    /// Appends the coordinates of the vertices of the file that have these numbers in the surface.
    pub(crate) fn vertices_in(&self, numbers: Range<u32>, vertices: &mut Vec<[f64; 3]>) {
        let used = numbers.filter(|&v| self.number[v as usize] != UNUSED);
        vertices.extend(used.map(|v| self.surface.position(v)));
    }

    pub(crate) fn vertices(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let used = (0..self.number.len() as u32).filter(|&v| self.number[v as usize] != UNUSED);
        used.map(|v| self.surface.position(v))
    }

    /// Returns the vertex numbers of each face, counter-clockwise.
    pub(crate) fn faces(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.corners().map(|corners| self.numbers(corners))
    }

    /// Returns the numbers of the corners of a face of the surface.
    #[inline]
    pub(crate) fn numbers(&self, corners: [u32; 3]) -> [u32; 3] {
        corners.map(|v| self.number[v as usize])
    }

    /// Returns the numbers of the faces that are fragments of cut triangles.
    pub(crate) fn fragments(&self) -> impl Iterator<Item = u32> + '_ {
        (0..)
            .zip(data::corners(self.surface))
            .filter(|(_, (face, _))| self.surface.is_fragment(*face))
            .map(|(number, _)| number)
    }

    /// Returns all edges, each with its kind: once, with the face of the smaller number.
    pub(crate) fn edges(&self) -> impl Iterator<Item = ([u32; 2], EdgeKind)> + '_ {
        data::faces(self.surface).flat_map(move |face| {
            let is_first = move |i: &usize| {
                self.surface
                    .neighbor(face.number, *i)
                    .is_none_or(|other| face.number < other)
            };
            let ends =
                move |i: usize| [1, 2].map(|k| self.number[face.corners[(i + k) % 3] as usize]);
            (0..3)
                .filter(is_first)
                .map(move |i| (ends(i), face.edges[i]))
        })
    }

    /// Returns the coordinates of each face's corners, counter-clockwise.
    pub(crate) fn triangles(&self) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
        self.corners()
            .map(|corners| corners.map(|v| self.surface.position(v)))
    }

    fn corners(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        data::corners(self.surface).map(|(_, corners)| corners)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Mesh;

    #[test]
    fn unused_vertices_go() {
        let p = [
            [9.0, 9.0, 9.0],
            [0.0, -1.0, 5.0],
            [-2.0, 0.0, 1.0],
            [0.0, 1.0, 2.0],
            [3.0, 0.0, 4.0],
        ];
        let mesh = Mesh::new(p.to_vec(), vec![[1, 3, 2], [1, 4, 3]], &[[3, 1]], None).unwrap();
        let listing = Listing::new(&mesh);
        assert!(listing.vertices().eq(p[1..].iter().copied()));
        assert!(listing.faces().eq([[0, 2, 1], [0, 3, 2]]));
        assert!(
            listing
                .triangles()
                .eq([[p[1], p[3], p[2]], [p[1], p[4], p[3]]])
        );
        assert_eq!(
            (
                listing.vertex_count,
                listing.face_count,
                listing.constrained_edges
            ),
            (4, 2, 1)
        );
        let [rim, line] = [EdgeKind::Rim, EdgeKind::Breakline];
        let edges: Vec<_> = listing.edges().collect();
        assert_eq!(
            edges,
            [
                ([2, 1], rim),
                ([1, 0], rim),
                ([0, 2], line),
                ([3, 2], rim),
                ([0, 3], rim)
            ]
        );
    }
}
