use std::cmp::Ordering;

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
    /// Linear for vertices that are spread somewhat evenly, O(n log n) at worst. Needs 64 bytes a vertex
    /// and 12 a face beside what it returns.
    pub(super) fn new(surface: &dyn Surface) -> Self {
        let mut faces: Vec<[u32; 3]> = Vec::with_capacity(surface.face_count());
        faces.extend((0..surface.face_count() as u32).filter_map(|f| surface.face(f)));
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
    let mut places: Vec<Place> = used.map(|v| Place { at: surface.position(v), vertex: v }).collect();
    if !places.is_sorted_by(|p, q| p.order(q).is_le()) {
        places = sort_places(&places);
    }
    for (i, place) in places.iter().enumerate() {
        number[place.vertex as usize] = i as u32;
    }
    (places.into_iter().map(|place| place.at).collect(), number)
}

#[derive(Clone, Copy)]
struct Place {
    at: [f64; 3],
    vertex: u32,
}

impl Place {
    /// By x, then y, then z. Vertices at one place in space are told apart by number: a surface has
    /// none.
    fn order(&self, other: &Self) -> Ordering {
        let axes = self.at.iter().zip(&other.at).map(|(p, q)| p.total_cmp(q));
        axes.fold(Ordering::Equal, Ordering::then).then(self.vertex.cmp(&other.vertex))
    }
}

/// Distributes over bins of equal width in x, of four places on average, and sorts these.
fn sort_places(places: &[Place]) -> Vec<Place> {
    let xs = || places.iter().map(|place| place.at[0]);
    let (min, max) = (xs().fold(f64::INFINITY, f64::min), xs().fold(f64::NEG_INFINITY, f64::max));
    let count = places.len() / 4 + 1;
    let per_unit = count as f64 / (max - min);
    // Ascends with x, whatever is rounded; NaN, where all x are the same, is cast to 0.
    let bin = |place: &Place| (((place.at[0] - min) * per_unit) as usize).min(count - 1);
    let mut first = vec![0u32; count + 1];
    for place in places {
        first[bin(place) + 1] += 1;
    }
    for i in 0..count {
        first[i + 1] += first[i];
    }
    let mut sorted = vec![Place { at: [0.0; 3], vertex: 0 }; places.len()];
    let mut next = first.clone();
    for place in places {
        let slot = &mut next[bin(place)];
        sorted[*slot as usize] = *place;
        *slot += 1;
    }
    for range in first.windows(2) {
        sorted[range[0] as usize..range[1] as usize].sort_unstable_by(Place::order);
    }
    sorted
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

    #[test]
    fn places_are_sorted_however_they_lie() {
        let mut state = 7u64;
        let mut below = |end: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % end
        };
        for (columns, far) in [(1, 0.0), (7, 0.0), (1000, 0.0), (1000, 1e300), (3, -1e300)] {
            let mut places: Vec<Place> = (0..500)
                .map(|vertex| Place { at: [below(columns) as f64 - 3.0, below(9) as f64, below(3) as f64], vertex })
                .collect();
            places[17].at[0] = far;
            let sorted: Vec<u32> = sort_places(&places).iter().map(|place| place.vertex).collect();
            places.sort_by(Place::order);
            assert!(sorted.iter().eq(places.iter().map(|place| &place.vertex)));
        }
    }
}
