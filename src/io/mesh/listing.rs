use crate::data::{self, Surface};

const UNUSED: u32 = u32::MAX;

/// The vertices, faces and constrained edges of a surface as a mesh file lists them: in the surface's own
/// order, without what no face uses.
pub(super) struct Listing<'a> {
    surface: &'a dyn Surface,
    /// For each vertex of the surface its number in the file.
    number: Vec<u32>,
    pub(super) vertex_count: usize,
    pub(super) face_count: usize,
    /// Smaller number first; ascending, none twice.
    pub(super) constrained_edges: Vec<[u32; 2]>,
}

impl<'a> Listing<'a> {
    /// # Complexity
    /// Linear. Needs 4 bytes a vertex and 8 a constrained edge.
    pub(super) fn new(surface: &'a dyn Surface) -> Self {
        let mut number = vec![UNUSED; surface.vertex_count()];
        let mut face_count = 0;
        let mut lines = Vec::new();
        data::faces(surface).for_each(|face| {
            face_count += 1;
            face.corners.iter().for_each(|&v| number[v as usize] = 0);
            let constrained = (0..3).filter(|&i| face.edges[i].is_constrained());
            lines.extend(constrained.map(|i| [1, 2].map(|k| face.corners[(i + k) % 3])));
        });
        let mut vertex_count = 0;
        for number in number.iter_mut().filter(|n| **n != UNUSED) {
            *number = vertex_count;
            vertex_count += 1;
        }
        let ends = |[a, b]: [u32; 2]| [a.min(b), a.max(b)];
        let mut constrained_edges: Vec<[u32; 2]> =
            lines.into_iter().map(|line: [u32; 2]| ends(line.map(|v| number[v as usize]))).collect();
        constrained_edges.sort_unstable();
        constrained_edges.dedup();
        Listing { surface, number, vertex_count: vertex_count as usize, face_count, constrained_edges }
    }

    pub(super) fn vertices(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let used = (0..self.number.len() as u32).filter(|&v| self.number[v as usize] != UNUSED);
        used.map(|v| self.surface.position(v))
    }

    /// The corners' numbers, counter-clockwise.
    pub(super) fn faces(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        self.corners().map(|corners| corners.map(|v| self.number[v as usize]))
    }

    /// The corners' places, counter-clockwise.
    pub(super) fn triangles(&self) -> impl Iterator<Item = [[f64; 3]; 3]> + '_ {
        self.corners().map(|corners| corners.map(|v| self.surface.position(v)))
    }

    fn corners(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        data::corners(self.surface)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Mesh;

    #[test]
    fn unused_vertices_go() {
        let p = [[9.0, 9.0, 9.0], [0.0, -1.0, 5.0], [-2.0, 0.0, 1.0], [0.0, 1.0, 2.0], [3.0, 0.0, 4.0]];
        let mesh = Mesh::new(p.to_vec(), vec![[1, 3, 2], [1, 4, 3]], &[[3, 1]], None).unwrap();
        let listing = Listing::new(&mesh);
        assert!(listing.vertices().eq(p[1..].iter().copied()));
        assert!(listing.faces().eq([[0, 2, 1], [0, 3, 2]]));
        assert!(listing.triangles().eq([[p[1], p[3], p[2]], [p[1], p[4], p[3]]]));
        assert_eq!(listing.constrained_edges, [[0, 2]]);
        assert_eq!((listing.vertex_count, listing.face_count), (4, 2));
    }
}
