use rayon::prelude::*;

use crate::data::Surface;

/// The vertices, faces and constrained edges of a surface in an order that depends on nothing but
/// where they are.
pub(super) struct Canonical {
    /// Those that faces use, ascending.
    pub(super) vertices: Vec<[f64; 3]>,
    /// Counter-clockwise, each from its smallest number; ascending.
    pub(super) faces: Vec<[u32; 3]>,
    /// Smaller number first; ascending, none twice.
    pub(super) constrained_edges: Vec<[u32; 2]>,
}

const UNUSED: u32 = u32::MAX;

impl Canonical {
    /// # Complexity
    /// O(n log n) for `n` vertices, linear if they are in order already. Needs 28 bytes a vertex and
    /// 12 a face beside what it returns.
    pub(super) fn new(surface: &dyn Surface) -> Self {
        let faces: Vec<[u32; 3]> = (0..surface.face_count() as u32).filter_map(|f| surface.face(f)).collect();
        let (vertices, number) = number_vertices(surface, &faces);
        let constrained_edges = constrained_edges(surface, &number);
        Canonical { faces: sort_faces(faces, &number, vertices.len()), vertices, constrained_edges }
    }
}

/// The vertices that are used, and for each vertex of the surface its number among them.
fn number_vertices(surface: &dyn Surface, faces: &[[u32; 3]]) -> (Vec<[f64; 3]>, Vec<u32>) {
    let mut number = vec![UNUSED; surface.vertex_count()];
    for &v in faces.iter().flatten() {
        number[v as usize] = 0;
    }
    let used = (0..number.len() as u32).filter(|&v| number[v as usize] != UNUSED);
    let mut sorted: Vec<([u64; 3], u32)> = used.map(|v| (surface.position(v).map(ascending), v)).collect();
    if !sorted.is_sorted() {
        sorted.par_sort_unstable();
    }
    let mut vertices = Vec::with_capacity(sorted.len());
    for (i, (_, v)) in sorted.into_iter().enumerate() {
        number[v as usize] = i as u32;
        vertices.push(surface.position(v));
    }
    (vertices, number)
}

/// A number that ascends with `value` (as `f64::total_cmp` has it).
fn ascending(value: f64) -> u64 {
    let bits = value.to_bits();
    if value.is_sign_negative() { !bits } else { bits | 1 << 63 }
}

/// Sorts by first corner by counting, and around each first corner by the second.
fn sort_faces(mut faces: Vec<[u32; 3]>, number: &[u32], vertex_count: usize) -> Vec<[u32; 3]> {
    let mut first = vec![0u32; vertex_count + 1];
    for face in &mut faces {
        let corners = face.map(|v| number[v as usize]);
        let smallest = (0..3).min_by_key(|&i| corners[i]).unwrap_or(0);
        *face = [0, 1, 2].map(|i| corners[(smallest + i) % 3]);
        first[face[0] as usize + 1] += 1;
    }
    for v in 0..vertex_count {
        first[v + 1] += first[v];
    }
    let mut sorted = vec![[0; 3]; faces.len()];
    let mut next = first.clone();
    for face in faces {
        let slot = &mut next[face[0] as usize];
        sorted[*slot as usize] = face;
        *slot += 1;
    }
    for range in first.windows(2) {
        sorted[range[0] as usize..range[1] as usize].sort_unstable();
    }
    sorted
}

fn constrained_edges(surface: &dyn Surface, number: &[u32]) -> Vec<[u32; 2]> {
    let mut edges = Vec::new();
    for f in 0..surface.face_count() as u32 {
        let Some(corners) = surface.face(f) else { continue };
        for i in 0..3 {
            if surface.is_constrained(f, i) {
                let [a, b] = [1, 2].map(|k| number[corners[(i + k) % 3] as usize]);
                edges.push([a.min(b), a.max(b)]);
            }
        }
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Mesh;

    #[test]
    fn numbering_does_not_show_and_unused_vertices_go() {
        let p = [[0.0, -1.0, 5.0], [-2.0, 0.0, 1.0], [0.0, 1.0, 2.0], [3.0, 0.0, 4.0], [9.0, 9.0, 9.0]];
        let one = Mesh::new(p.to_vec(), vec![[0, 2, 1], [0, 3, 2]], &[[0, 2]], None).unwrap();
        let q = vec![p[3], p[2], p[1], p[0]];
        let other = Mesh::new(q, vec![[1, 3, 0], [2, 3, 1]], &[[1, 3]], None).unwrap();
        for mesh in [one, other] {
            let canonical = Canonical::new(&mesh);
            assert_eq!(canonical.vertices, [p[1], p[0], p[2], p[3]]);
            assert_eq!(canonical.faces, [[0, 1, 2], [1, 3, 2]]);
            assert_eq!(canonical.constrained_edges, [[1, 2]]);
        }
    }
}
