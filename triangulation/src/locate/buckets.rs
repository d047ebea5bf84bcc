use crate::embedded::position;
use crate::geometry::Coordinates;
use crate::tds::VertexId;
use crate::triangulation::Triangulation;

use super::{Locate, Location};

/// A grid of squares over the plane, or of cubes in space, each of which remembers one vertex in
/// it: the last one inserted.
///
/// A walk from that vertex takes a few steps if the buckets contain about equally many points. 4
/// bytes a bucket.
#[derive(Debug, Clone)]
pub struct Buckets {
    /// In the plane, the last coordinate is zero.
    low: [f64; 3],
    /// Buckets per unit of length.
    scale: f64,
    /// Buckets along each axis.
    counts: [usize; 3],
    vertices: Vec<Option<VertexId>>,
}

impl Buckets {
    /// Creates a grid of about `count` buckets over a box of two or three dimensions, which need
    /// not contain all points: points outside belong to the buckets on its border.
    pub fn over<const D: usize>([low, high]: [[f64; D]; 2], count: usize) -> Self {
        let padded = |site: [f64; D]| std::array::from_fn(|k| site.get(k).copied().unwrap_or(0.0));
        Self::over_box([padded(low), padded(high)], count)
    }

    fn over_box([low, high]: [[f64; 3]; 2], count: usize) -> Self {
        let count = count.clamp(1, 1 << 28) as f64;
        let [x, y, z] = [0, 1, 2].map(|k| (high[k] - low[k]).max(0.0));
        // The sides of buckets that fill the box, one layer of it, one row: the largest prevents
        // that a flat box has too many. Roots come first, so that no product overflows.
        let root = |length: f64| (length / count.sqrt()).sqrt();
        let of_box = [x, y, z]
            .map(|length| (length / count.cbrt()).cbrt())
            .iter()
            .product();
        let of_layers = [root(x) * root(y), root(y) * root(z), root(z) * root(x)];
        let of_rows = [x, y, z].map(|length| length / count);
        let side = of_layers.into_iter().chain(of_rows).fold(of_box, f64::max);
        let scale = if (1.0 / side).is_finite() {
            1.0 / side
        } else {
            0.0
        };
        let counts = [x, y, z].map(|length| (length * scale).ceil().max(1.0) as usize);
        Buckets {
            low,
            scale,
            counts,
            vertices: vec![None; counts.iter().product()],
        }
    }

    /// Creates a grid for the vertices of a triangulation, two vertices to a bucket on average.
    pub fn of<G: Coordinates<N>, const N: usize, V, C: Copy + Default>(
        triangulation: &Triangulation<G, N, V, C>,
    ) -> Self {
        let site = |v: VertexId| position(triangulation.geometry(), triangulation.point(v));
        let nothing = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let bounds = triangulation
            .tds
            .vertices()
            .map(site)
            .fold(nothing, |[low, high], p| {
                [
                    [0, 1, 2].map(|k| low[k].min(p[k])),
                    [0, 1, 2].map(|k| high[k].max(p[k])),
                ]
            });
        let mut buckets = Self::over_box(bounds, triangulation.vertex_count() / 2);
        for vertex in triangulation.tds.vertices() {
            let at = buckets.bucket(site(vertex));
            buckets.vertices[at] = Some(vertex);
        }
        buckets
    }

    fn bucket(&self, site: [f64; 3]) -> usize {
        let along =
            |k: usize| (((site[k] - self.low[k]) * self.scale) as usize).min(self.counts[k] - 1);
        (along(2) * self.counts[1] + along(1)) * self.counts[0] + along(0)
    }
}

impl<G: Coordinates<N>, const N: usize> Locate<G, N> for Buckets {
    fn locate<V, C: Copy + Default>(
        &self,
        triangulation: &Triangulation<G, N, V, C>,
        q: &G::Point,
    ) -> Location {
        let vertex = self.vertices[self.bucket(position(triangulation.geometry(), q))];
        let vertex = vertex.filter(|&v| triangulation.tds.is_vertex(v));
        triangulation.locate(q, vertex.and_then(|v| triangulation.tds.cell_of(v)))
    }

    fn inserted(&mut self, geometry: &G, vertex: VertexId, point: &G::Point) {
        let at = self.bucket(position(geometry, point));
        self.vertices[at] = Some(vertex);
    }
}
