//! Finds by walking what lies near a segment or a vertex.

use crate::geometry::Crossing;
use crate::tds::{CellId, VertexId};

use super::chains::{Ends, undirected};
use super::mesh::{Mesh, position};

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
        !is_beside(self.ends[0], self.along, self.reach, [u, w])
            && !is_beside(u, edge, self.reach, self.ends)
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
    sides.iter().all(|(side, limit)| side > limit)
        || sides.iter().all(|(side, limit)| *side < -limit)
}

/// What lies near a segment or a vertex.
#[derive(Debug)]
pub(super) struct Nearby {
    /// The constrained edges that the band may meet, each once, in order, with a triangle beside
    /// it.
    pub(super) edges: Vec<(Ends, CellId)>,
    /// The finite vertices in the band, each once, in order.
    pub(super) vertices: Vec<VertexId>,
}

/// Returns what lies in a band. The walk starts at a vertex in it.
///
/// The intersection of the band and the hull is convex. So the triangles whose interiors meet the
/// band are connected by edges that meet it.
///
/// # Complexity
/// Linear in the number of triangles that the band meets, and in the degree of the vertex.
pub(super) fn near<G: Crossing, V, C: Copy + Default>(
    t: &mut Mesh<G, V, C>,
    band: &Band,
    start: VertexId,
) -> Nearby {
    let mut nearby = Nearby {
        edges: Vec::new(),
        vertices: Vec::new(),
    };
    let Some(first) = t.tds.around(start).find(|&cell| !t.tds.is_infinite(cell)) else {
        return nearby;
    };
    let mut zone = t.take_zone();
    let meets =
        |cell: CellId, i: usize| band.meets(t.tds.edge_ends(cell, i).map(|v| position(t, v)));
    let mut meet = |vertex: VertexId| {
        if band.has(position(t, vertex)) {
            nearby.vertices.push(vertex);
        }
    };
    t.tds.corners(first).iter().for_each(|&corner| meet(corner));
    zone.grow(&t.tds, first, |cell, i, beyond| {
        let is_near = !t.tds.is_infinite(beyond) && meets(cell, i);
        if is_near {
            meet(t.tds.vertex(beyond, t.tds.index_of_neighbor(beyond, cell)));
        }
        is_near
    });
    for &cell in zone.cells() {
        for i in (0..3).filter(|&i| t.is_constrained(cell, i) && meets(cell, i)) {
            let [a, b] = t.tds.edge_ends(cell, i);
            nearby.edges.push((undirected(a, b), cell));
        }
    }
    zone.finish();
    t.zone = Some(zone);
    nearby.edges.sort_unstable();
    nearby.edges.dedup_by_key(|(edge, _)| *edge);
    nearby.vertices.sort_unstable();
    nearby.vertices.dedup();
    nearby
}
