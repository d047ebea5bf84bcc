//! Small surfaces with integer coordinates and heights, where levels often meet vertices.

use breakline::crs::Crs;
use breakline::data::{EdgeKind, Surface};
use proptest::prelude::*;
use std::collections::HashMap;

/// Triangles with their neighbors, found naively.
#[derive(Clone, Debug)]
pub(crate) struct Faces {
    pub(crate) vertices: Vec<[f64; 3]>,
    pub(crate) faces: Vec<[u32; 3]>,
    neighbors: HashMap<[u32; 2], u32>,
}

impl Faces {
    pub(crate) fn new(vertices: Vec<[f64; 3]>, faces: Vec<[u32; 3]>) -> Self {
        let mut neighbors = HashMap::new();
        for (id, corners) in faces.iter().enumerate() {
            for i in 0..3 {
                let half = [corners[(i + 1) % 3], corners[(i + 2) % 3]];
                assert!(
                    neighbors.insert(half, id as u32).is_none(),
                    "two faces on one side of an edge"
                );
            }
        }
        Faces {
            vertices,
            faces,
            neighbors,
        }
    }

    pub(crate) fn subset(&self, keep: impl Fn(usize) -> bool) -> Self {
        let faces = self
            .faces
            .iter()
            .enumerate()
            .filter(|(i, _)| keep(*i))
            .map(|(_, face)| *face)
            .collect();
        Faces::new(self.vertices.clone(), faces)
    }

    /// The same triangles with other numbers: `order` is the key by which they are sorted.
    pub(crate) fn renumbered(&self, order: &[u32]) -> Self {
        let key = |i: usize| order[i % order.len()].rotate_left((i / order.len()) as u32);
        let mut old_of_new: Vec<usize> = (0..self.vertices.len()).collect();
        old_of_new.sort_by_key(|&i| key(i));
        let mut new_of_old = vec![0; old_of_new.len()];
        for (new, &old) in old_of_new.iter().enumerate() {
            new_of_old[old] = new as u32;
        }
        let mut faces = Vec::new();
        for (i, face) in self.faces.iter().enumerate() {
            let mut face = face.map(|v| new_of_old[v as usize]);
            face.rotate_left(key(i) as usize % 3);
            faces.push((key(i + 1), face));
        }
        faces.sort();
        let vertices = old_of_new.iter().map(|&i| self.vertices[i]).collect();
        Faces::new(vertices, faces.into_iter().map(|(_, face)| face).collect())
    }
}

impl Surface for Faces {
    fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.vertices[vertex as usize]
    }

    fn face_count(&self) -> usize {
        self.faces.len()
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        self.faces.get(face as usize).copied()
    }

    fn neighbor(&self, face: u32, i: usize) -> Option<u32> {
        let corners = self.faces[face as usize];
        self.neighbors
            .get(&[corners[(i + 2) % 3], corners[(i + 1) % 3]])
            .copied()
    }

    fn edge_kind(&self, _face: u32, _i: usize) -> EdgeKind {
        EdgeKind::Plain
    }

    fn crs(&self) -> Option<&Crs> {
        None
    }
}

/// A grid of unit quads, each split along one of its diagonals.
pub(crate) fn grid(width: usize, heights: &[i32], rising: impl Fn(usize) -> bool) -> Faces {
    let vertices = heights
        .iter()
        .enumerate()
        .map(|(i, &h)| [(i % width) as f64, (i / width) as f64, h.into()]);
    let mut faces = Vec::new();
    for row in 1..heights.len() / width {
        for column in 1..width {
            let quad = (row - 1) * (width - 1) + column - 1;
            let [a, b] =
                [(row - 1) * width + column - 1, (row - 1) * width + column].map(|i| i as u32);
            let [d, c] = [a, b].map(|i| i + width as u32);
            faces.extend(if rising(quad) {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            });
        }
    }
    Faces::new(vertices.collect(), faces)
}

/// A vertex in a ring of eight; the angles between its neighbors are below 90 degrees.
pub(crate) fn wheel(center: i32, ring: [i32; 8], keep: u32) -> Faces {
    const RING: [[f64; 2]; 8] = [
        [2.0, 0.0],
        [2.0, 2.0],
        [0.0, 2.0],
        [-2.0, 2.0],
        [-2.0, 0.0],
        [-2.0, -2.0],
        [0.0, -2.0],
        [2.0, -2.0],
    ];
    let mut vertices = vec![[0.0, 0.0, center.into()]];
    vertices.extend(RING.iter().zip(ring).map(|([x, y], h)| [*x, *y, h.into()]));
    let faces = (0..8)
        .filter(|i| keep >> i & 1 == 1)
        .map(|i| [0, 1 + i, 1 + (i + 1) % 8])
        .collect();
    Faces::new(vertices, faces)
}

/// Random grids with heights 0 to 3, random diagonals and a random part of the faces.
pub(crate) fn any_grid() -> impl Strategy<Value = (Faces, Vec<bool>)> {
    (2_usize..7, 2_usize..7).prop_flat_map(|(width, height)| {
        let quads = (width - 1) * (height - 1);
        (
            prop::collection::vec(0..4, width * height),
            prop::collection::vec(any::<bool>(), quads),
            prop::collection::vec(prop::bool::weighted(0.7), 2 * quads),
        )
            .prop_map(move |(heights, rising, keep)| {
                (grid(width, &heights, |quad| rising[quad]), keep)
            })
    })
}
