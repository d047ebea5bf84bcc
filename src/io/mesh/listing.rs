use crate::data::Surface;

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
        for corners in (0..surface.face_count() as u32).filter_map(|f| surface.face(f)) {
            face_count += 1;
            corners.iter().for_each(|&v| number[v as usize] = 0);
        }
        let mut vertex_count = 0;
        for number in number.iter_mut().filter(|n| **n != UNUSED) {
            *number = vertex_count;
            vertex_count += 1;
        }
        let mut listing =
            Listing { surface, number, vertex_count: vertex_count as usize, face_count, constrained_edges: Vec::new() };
        listing.constrained_edges = listing.find_constrained_edges();
        listing
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
        (0..self.surface.face_count() as u32).filter_map(|f| self.surface.face(f))
    }

    fn find_constrained_edges(&self) -> Vec<[u32; 2]> {
        let mut edges = Vec::new();
        for f in 0..self.surface.face_count() as u32 {
            let Some(corners) = self.surface.face(f) else { continue };
            for i in (0..3).filter(|&i| self.surface.is_constrained(f, i)) {
                let [a, b] = [1, 2].map(|k| self.number[corners[(i + k) % 3] as usize]);
                edges.push([a.min(b), a.max(b)]);
            }
        }
        edges.sort_unstable();
        edges.dedup();
        edges
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
