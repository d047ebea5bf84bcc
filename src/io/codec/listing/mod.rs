//! The code that all mesh formats share: lists the vertices and faces of a surface.

pub(crate) mod crs_text;
pub(crate) mod polygon;
pub(crate) mod text;

use crate::data::{self, EdgeKind, LineEdges, Surface};

const UNUSED: u32 = u32::MAX;

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
    /// Linear. Needs 4 bytes per vertex.
    pub(crate) fn new(surface: &'a dyn Surface) -> Self {
        let mut number = vec![UNUSED; surface.vertex_count()];
        let mut face_count = 0;
        let mut lines = LineEdges::default();
        let mut add = |corners: [u32; 3]| {
            face_count += 1;
            corners.iter().for_each(|&v| number[v as usize] = 0);
        };
        if surface.has_lines() {
            data::faces(surface).for_each(|face| {
                add(face.corners);
                lines.add(surface, face.number, face.edges);
            });
        } else {
            data::corners(surface).for_each(|(_, corners)| add(corners));
        }
        let mut vertex_count = 0;
        for number in number.iter_mut().filter(|n| **n != UNUSED) {
            *number = vertex_count;
            vertex_count += 1;
        }
        Listing {
            surface,
            number,
            vertex_count: vertex_count as usize,
            face_count,
            constrained_edges: lines.total(),
        }
    }

    pub(crate) fn vertices(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let used = (0..self.number.len() as u32).filter(|&v| self.number[v as usize] != UNUSED);
        used.map(|v| self.surface.position(v))
    }

    /// Returns the vertex numbers of each face, counter-clockwise.
    pub(crate) fn faces(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.corners()
            .map(|corners| corners.map(|v| self.number[v as usize]))
    }

    /// Returns each face with the kinds of the edges opposite its corners, and true if it is a
    /// fragment of a cut triangle.
    pub(crate) fn lined_faces(&self) -> impl Iterator<Item = ([u32; 3], [EdgeKind; 3], bool)> + '_ {
        data::faces(self.surface).map(|face| {
            let corners = face.corners.map(|v| self.number[v as usize]);
            (corners, face.edges, self.surface.is_fragment(face.number))
        })
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
        let kinds: Vec<_> = listing.lined_faces().map(|(_, kinds, _)| kinds).collect();
        let [rim, line] = [EdgeKind::Rim, EdgeKind::Breakline];
        assert_eq!(kinds, [[rim, rim, line], [rim, line, rim]]);
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
