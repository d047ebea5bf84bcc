use crate::geometry::Coordinates;
use crate::tds::VertexId;

use super::super::Triangulation;
use super::{Locate, Location};

/// A grid of squares over the plane, each of which remembers one vertex in it: the last one
/// inserted.
///
/// A walk from that vertex takes a few steps if the squares contain about equally many points. 4
/// bytes a square.
#[derive(Debug, Clone)]
pub struct Buckets {
    low: [f64; 2],
    /// Squares per unit of length.
    scale: f64,
    columns: usize,
    vertices: Vec<Option<VertexId>>,
}

impl Buckets {
    /// Creates a grid of about `count` squares over a box, which need not contain all points:
    /// points outside belong to the squares on its border.
    pub fn over([low, high]: [[f64; 2]; 2], count: usize) -> Self {
        let count = count.clamp(1, 1 << 28) as f64;
        let [width, height] = [0, 1].map(|k| (high[k] - low[k]).max(0.0));
        let side = [width, height].map(|length| (length / count.sqrt()).sqrt());
        let side = (side[0] * side[1]).max(width / count).max(height / count);
        let scale = if side > 0.0 && side.is_finite() { 1.0 / side } else { 0.0 };
        let [columns, rows] = [width, height].map(|length| (length * scale).ceil().max(1.0) as usize);
        Buckets { low, scale, columns, vertices: vec![None; columns * rows] }
    }

    /// Creates a grid for the vertices of a triangulation, two vertices to a square on average.
    pub fn of<G: Coordinates<3>, V, C: Copy + Default>(triangulation: &Triangulation<G, 3, V, C>) -> Self {
        let site = |v: VertexId| site(triangulation.geometry(), triangulation.point(v));
        let nothing = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let bounds = triangulation
            .tds
            .vertices()
            .map(site)
            .fold(nothing, |[low, high], p| [[0, 1].map(|k| low[k].min(p[k])), [0, 1].map(|k| high[k].max(p[k]))]);
        let mut buckets = Self::over(bounds, triangulation.vertex_count() / 2);
        for vertex in triangulation.tds.vertices() {
            let at = buckets.bucket(site(vertex));
            buckets.vertices[at] = Some(vertex);
        }
        buckets
    }

    fn bucket(&self, site: [f64; 2]) -> usize {
        let rows = self.vertices.len() / self.columns;
        let along = |k: usize, end: usize| (((site[k] - self.low[k]) * self.scale) as usize).min(end - 1);
        along(1, rows) * self.columns + along(0, self.columns)
    }
}

fn site<G: Coordinates<3>>(geometry: &G, p: &G::Point) -> [f64; 2] {
    match *geometry.coordinates(p).as_ref() {
        [x, y, ..] => [x, y],
        _ => [0.0; 2],
    }
}

impl<G: Coordinates<3>> Locate<G, 3> for Buckets {
    fn locate<V, C: Copy + Default>(&self, triangulation: &Triangulation<G, 3, V, C>, q: &G::Point) -> Location {
        let vertex = self.vertices[self.bucket(site(triangulation.geometry(), q))];
        let vertex = vertex.filter(|&v| triangulation.tds.is_vertex(v));
        triangulation.locate(q, vertex.and_then(|v| triangulation.tds.cell_of(v)))
    }

    fn inserted(&mut self, geometry: &G, vertex: VertexId, point: &G::Point) {
        let at = self.bucket(site(geometry, point));
        self.vertices[at] = Some(vertex);
    }
}
