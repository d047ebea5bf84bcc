//! Finds by walking what lies near a segment or a vertex.

use rustc_hash::FxHashSet;

use crate::geometry::Crossing;
use crate::tds::{CellId, VertexId};

use super::constrain::{Mesh, position};
use super::paths::{Ends, undirected};

/// The points within some distance of a segment on each axis: a hexagon; for a point, a rectangle.
///
/// Its tests use rounded numbers and may return true too often, but never false wrongly.
pub(super) struct Band {
    ends: [[f64; 2]; 2],
    along: [f64; 2],
    reach: [f64; 2],
    low: [f64; 2],
    high: [f64; 2],
}

impl Band {
    pub(super) fn around(ends: [[f64; 2]; 2], reach: [f64; 2]) -> Self {
        let [p, q] = ends;
        Band {
            ends,
            along: [0, 1].map(|k| q[k] - p[k]),
            reach,
            low: [0, 1].map(|k| p[k].min(q[k]) - reach[k]),
            high: [0, 1].map(|k| p[k].max(q[k]) + reach[k]),
        }
    }

    /// Returns true if the band may meet a segment: no line parallel to either of them separates
    /// the two.
    fn meets(&self, [u, w]: [[f64; 2]; 2]) -> bool {
        let apart = |k: usize| u[k].max(w[k]) < self.low[k] || u[k].min(w[k]) > self.high[k];
        if apart(0) || apart(1) {
            return false;
        }
        let edge = [0, 1].map(|k| w[k] - u[k]);
        !is_beside(self.ends[0], self.along, self.reach, [u, w]) && !is_beside(u, edge, self.reach, self.ends)
    }

    fn has(&self, p: [f64; 2]) -> bool {
        (0..2).all(|k| self.low[k] <= p[k] && p[k] <= self.high[k])
            && !is_beside(self.ends[0], self.along, self.reach, [p, p])
    }
}

/// Returns true if two points certainly lie on one side of a line, given by a point and a
/// direction, and farther away than the reach.
fn is_beside(from: [f64; 2], along: [f64; 2], reach: [f64; 2], points: [[f64; 2]; 2]) -> bool {
    let width = reach[1] * along[0].abs() + reach[0] * along[1].abs();
    let sides = points.map(|p| {
        let products = [along[0] * (p[1] - from[1]), along[1] * (p[0] - from[0])];
        // Each product has an error of at most two roundings, and so have its factors.
        let doubt = 8.0 * f64::EPSILON * (products[0].abs() + products[1].abs());
        (products[0] - products[1], width + doubt)
    });
    sides.iter().all(|(side, limit)| side > limit) || sides.iter().all(|(side, limit)| *side < -limit)
}

/// Returns the constrained edges that a band may meet, and the finite vertices in it, each once, in
/// order. The walk starts at a vertex in the band.
///
/// The intersection of the band and the hull is convex. So the triangles whose interiors meet the
/// band are connected by edges that meet it.
///
/// # Complexity
/// Linear in the number of triangles that the band meets, and in the degree of the vertex.
pub(super) fn near<G: Crossing, V, C: Copy + Default>(
    t: &Mesh<G, V, C>,
    band: &Band,
    start: VertexId,
) -> (Vec<Ends>, Vec<VertexId>) {
    let mut open: Vec<CellId> = t.tds.around(start).filter(|&cell| !t.tds.is_infinite(cell)).collect();
    let mut seen: FxHashSet<CellId> = open.iter().copied().collect();
    let (mut edges, mut vertices) = (Vec::new(), Vec::new());
    while let Some(cell) = open.pop() {
        let corners = *t.tds.corners(cell);
        let positions = corners.map(|v| position(t, v));
        let is_inside = positions.map(|p| band.has(p));
        vertices.extend((0..3).filter(|&i| is_inside[i]).map(|i| corners[i]));
        for i in 0..3 {
            let [j, k] = [(i + 1) % 3, (i + 2) % 3];
            if !is_inside[j] && !is_inside[k] && !band.meets([positions[j], positions[k]]) {
                continue;
            }
            if t.is_constrained(cell, i) {
                edges.push(undirected(corners[j], corners[k]));
            }
            let beyond = t.tds.neighbor(cell, i);
            if !t.tds.is_infinite(beyond) && seen.insert(beyond) {
                open.push(beyond);
            }
        }
    }
    edges.sort_unstable();
    edges.dedup();
    vertices.sort_unstable();
    vertices.dedup();
    (edges, vertices)
}
