//! What Voronoi and power diagrams of the plane and of space share: their edges, half spaces, and
//! vectors.

/// An edge of a Voronoi or power diagram: the points that both ends of an edge are nearest to, or
/// in space (`D = 3`) all corners of a facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VoronoiEdge<const D: usize = 2> {
    /// Between the centers of the two cells at an edge (facet); of length zero if these are equal,
    /// as when all corners lie on one circle (sphere).
    Segment([[f64; D]; 2]),
    /// From the center of the only cell at an edge (facet) of the hull, outward.
    Ray {
        /// The start of the ray.
        from: [f64; D],
        /// The direction: perpendicular to the edge, and as long; in space to the facet, and as
        /// long as twice its area is large.
        direction: [f64; D],
    },
    /// Between two neighbors among collinear vertices; in space, of a face among coplanar ones.
    Line {
        /// A point on the line through both; halfway between them if their weights are equal. In
        /// space, the center of the face in its plane.
        through: [f64; D],
        /// The direction, as that of a ray.
        direction: [f64; D],
    },
}

/// The points whose product with `normal` is at most `offset`: a half plane, or half of space.
pub(super) struct HalfSpace<const D: usize> {
    pub(super) normal: [f64; D],
    pub(super) offset: f64,
}

impl<const D: usize> HalfSpace<D> {
    /// Returns the points nearer to the origin than to `p`.
    pub(super) fn nearer_than(p: [f64; D]) -> Self {
        Self::of_less_power(p, 0.0)
    }

    /// Returns the points of less power to the origin than to `p`, where the weight of the origin
    /// is larger `by` this much.
    pub(super) fn of_less_power(p: [f64; D], by: f64) -> Self {
        HalfSpace {
            normal: p,
            offset: (dot(p, p) + by) / 2.0,
        }
    }

    /// Returns how far a point lies beyond the border, times the length of the normal.
    pub(super) fn excess(&self, p: [f64; D]) -> f64 {
        dot(self.normal, p) - self.offset
    }

    /// Returns the part of a convex polygon in the half space.
    pub(super) fn clip(&self, polygon: Vec<[f64; D]>) -> Vec<[f64; D]> {
        self.clip_with_sides(polygon, |_| ())
    }

    /// Returns the part of a convex polygon in the half space, and reports its new sides, which run
    /// along the border (Sutherland and Hodgman 1974, for one line). Polygons that share a side are
    /// cut at the same point of it.
    pub(super) fn clip_with_sides(
        &self,
        polygon: Vec<[f64; D]>,
        mut new_side: impl FnMut([[f64; D]; 2]),
    ) -> Vec<[f64; D]> {
        if polygon.iter().all(|&p| self.excess(p) <= 0.0) {
            return polygon;
        }
        let mut clipped = Vec::with_capacity(polygon.len() + 1);
        // Where the polygon leaves the half space, and where it returned before it ever left.
        let (mut exit, mut first_return) = (None, None);
        for (k, &p) in polygon.iter().enumerate() {
            let q = polygon[(k + 1) % polygon.len()];
            let (at_p, at_q) = (self.excess(p), self.excess(q));
            if at_p <= 0.0 {
                clipped.push(p);
            }
            if at_p <= 0.0 && at_q > 0.0 {
                let border = between((p, at_p), (q, at_q));
                if at_p < 0.0 {
                    clipped.push(border);
                }
                exit = Some(border);
            } else if at_p > 0.0 && at_q <= 0.0 {
                let border = between((q, at_q), (p, at_p));
                if at_q < 0.0 {
                    clipped.push(border);
                }
                match exit.take() {
                    Some(exit) => new_side([exit, border]),
                    None => first_return = Some(border),
                }
            }
        }
        if let (Some(exit), Some(border)) = (exit, first_return) {
            new_side([exit, border]);
        }
        clipped
    }
}

/// Returns the point of a segment on the border of a half space, given how far a point within and
/// one beyond it lie beyond the border. The direction is fixed, so that it is one point for all
/// polygons with this side.
fn between<const D: usize>(
    (inside, below): ([f64; D], f64),
    (beyond, above): ([f64; D], f64),
) -> [f64; D] {
    if below == 0.0 {
        return inside;
    }
    let along = below / (below - above);
    plus(inside, minus(beyond, inside).map(|x| along * x))
}

pub(super) fn dot<const D: usize>(p: [f64; D], q: [f64; D]) -> f64 {
    (1..D).fold(p[0] * q[0], |sum, k| sum + p[k] * q[k])
}

pub(super) fn minus<const D: usize>(p: [f64; D], q: [f64; D]) -> [f64; D] {
    std::array::from_fn(|k| p[k] - q[k])
}

pub(super) fn plus<const D: usize>(p: [f64; D], q: [f64; D]) -> [f64; D] {
    std::array::from_fn(|k| p[k] + q[k])
}
