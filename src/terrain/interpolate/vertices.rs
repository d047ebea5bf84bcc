//! Interpolation from the nearest vertices, whatever lies between.

use rayon::prelude::*;

use crate::data::{Surface, faces_under};
use crate::terrain::boxes::{Boxed, Boxes, Extent, Near};

/// The number of vertices that inverse distance weighting uses.
pub(super) const NEIGHBORS: usize = 12;

/// The vertices of a surface, in a tree.
#[derive(Debug)]
pub(super) struct Vertices(Boxes<Vertex>);

#[derive(Debug, Clone, Copy)]
struct Vertex([f64; 3]);

impl Boxed for Vertex {
    fn extent(&self) -> Extent {
        Extent::of([self.0])
    }
}

/// A vertex and the square of its distance.
type Neighbor = (f64, [f64; 3]);

/// The memory of a search, kept from one position to the next.
#[derive(Debug, Default)]
pub(super) struct Search {
    nodes: Vec<Near>,
    found: Vec<Neighbor>,
}

impl Vertices {
    /// Collects the vertices of the triangles under a surface, without those between heights.
    ///
    /// # Complexity
    /// O(n log n); about 35 bytes for each vertex.
    pub(super) fn new<S: Surface + ?Sized>(surface: &S) -> Self {
        let mut is_used = vec![false; surface.vertex_count()];
        faces_under(surface)
            .flat_map(|face| face.corners)
            .for_each(|v| is_used[v as usize] = true);
        let used = is_used
            .into_par_iter()
            .enumerate()
            .filter(|&(v, is_used)| is_used && !surface.is_between(v as u32));
        Vertices(Boxes::new(
            used.map(|(v, _)| Vertex(surface.position(v as u32)))
                .collect(),
        ))
    }

    /// Returns the height of the nearest vertex; of several, that of the smallest by x, then y.
    pub(super) fn nearest(&self, q: [f64; 2], search: &mut Search) -> Option<f64> {
        let mut nearest: Option<Neighbor> = None;
        self.0.around(q, &mut search.nodes, |&Vertex(p)| {
            let found = (distance(p, q), p);
            if nearest.is_none_or(|nearest| key(&found) < key(&nearest)) {
                nearest = Some(found);
            }
            nearest.map_or(f64::INFINITY, |(distance, _)| distance)
        });
        nearest.map(|(_, p)| p[2])
    }

    /// Returns the mean height of the nearest [`NEIGHBORS`] vertices and of all that are exactly as
    /// far as the last of them, weighted with 1 over the square of the distance.
    pub(super) fn inverse_distance(&self, q: [f64; 2], search: &mut Search) -> Option<f64> {
        let Search { nodes, found } = search;
        found.clear();
        self.0.around(q, nodes, |&Vertex(p)| {
            let neighbor = (distance(p, q), p);
            let last = found
                .get(NEIGHBORS - 1)
                .map_or(f64::INFINITY, |(distance, _)| *distance);
            if neighbor.0 <= last {
                let at = found.partition_point(|other| key(other) < key(&neighbor));
                found.insert(at, neighbor);
                let last = found
                    .get(NEIGHBORS - 1)
                    .map_or(f64::INFINITY, |(distance, _)| *distance);
                while found.last().is_some_and(|(distance, _)| *distance > last) {
                    found.pop();
                }
                return last;
            }
            last
        });
        let &(nearest, [_, _, origin]) = found.first()?;
        if nearest == 0.0 {
            return Some(origin);
        }
        let (mut weights, mut heights) = (0.0, 0.0);
        for (distance, p) in found {
            let weight = nearest / *distance;
            weights += weight;
            heights += weight * (p[2] - origin);
        }
        Some(origin + heights / weights).filter(|height| height.is_finite())
    }
}

/// The square of a distance in plan.
#[inline]
fn distance(p: [f64; 3], q: [f64; 2]) -> f64 {
    let (x, y) = (p[0] - q[0], p[1] - q[1]);
    x * x + y * y
}

/// The order of neighbors: by distance, then x, then y.
#[inline]
fn key((distance, p): &Neighbor) -> (f64, f64, f64) {
    (*distance, p[0], p[1])
}
