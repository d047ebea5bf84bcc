//! The rim that points alone would have: the border of what a longest edge leaves of their hull.
//!
//! The rim of many points is that of a few of them, which tiles can find one by one. A face is left
//! out if it can be reached from outside over long edges. A long edge has a disk without points
//! around it that is wider than the edge. So a point is of no matter if all triangles around it
//! have narrow disks, in the triangulation of any of the points: more points make the region that
//! is nearest to it smaller, and with it the disks. Without such points some faces differ, but only
//! where all edges around are short, where no way from outside leads.

use super::peel::{finite_faces, peel};
use super::rim_rule::RimRule;
use super::window::{ReadWindow, uncertain};
use crate::data::Bounds;
use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::{CellId, VertexId};

/// The surface of points alone.
pub(super) struct PointRim {
    triangulation: ConstrainedDelaunay<Terrain>,
    /// For each cell number: true if the cell is part of the surface.
    inside: Vec<bool>,
}

impl PointRim {
    /// Triangulates points and leaves out what can be reached from outside over edges longer than
    /// `limit`. `None` if nothing is left, or if a point is not admitted.
    ///
    /// # Complexity
    /// That of [`ConstrainedDelaunay::from_points`].
    pub(super) fn new(points: &[[f64; 3]], limit: Option<f64>) -> Option<Self> {
        let (triangulation, _) =
            ConstrainedDelaunay::from_points(Terrain::default(), points).ok()?;
        if triangulation.dimension() < 2 {
            return None;
        }
        let mut inside = finite_faces(&triangulation);
        peel(&triangulation, &mut inside, RimRule::longest(limit));
        inside.contains(&true).then_some(PointRim {
            triangulation,
            inside,
        })
    }

    /// Returns the edges of the rim, from left to right, in the order of their ends.
    pub(super) fn edges(&self) -> Vec<[[f64; 2]; 2]> {
        let tds = self.triangulation.tds();
        let is_inside = |cell: CellId| self.inside[cell.index()];
        let at = |vertex: VertexId| {
            let [x, y, _] = *self.triangulation.point(vertex);
            [x, y]
        };
        let less = |p: &[f64; 2], q: &[f64; 2]| p.partial_cmp(q).is_some_and(|order| order.is_lt());
        let mut edges: Vec<[[f64; 2]; 2]> = Vec::new();
        for cell in tds.cells().filter(|&cell| is_inside(cell)) {
            for i in (0..3).filter(|&i| !is_inside(tds.neighbor(cell, i))) {
                let [a, b] = tds.edge_ends(cell, i).map(at);
                edges.push(if less(&b, &a) { [b, a] } else { [a, b] });
            }
        }
        edges.sort_unstable_by(|p, q| {
            p.as_flattened()
                .partial_cmp(q.as_flattened())
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        edges
    }

    /// Counts the triangles within bounds that points outside of a window may change.
    pub(super) fn uncertain(
        &self,
        bounds: &Bounds,
        window: &ReadWindow,
        limit: Option<f64>,
    ) -> usize {
        let rule = RimRule::longest(limit);
        uncertain(&self.triangulation, bounds, window, rule, &[])
    }
}

/// Returns those of some points that their rim may depend on, also if there are other points.
///
/// # Complexity
/// That of [`ConstrainedDelaunay::from_points`].
pub(crate) fn deciding(points: Vec<[f64; 3]>, limit: Option<f64>) -> Vec<[f64; 3]> {
    let geometry: Terrain = Terrain::default();
    let Ok((triangulation, _)) = ConstrainedDelaunay::from_points(geometry, &points) else {
        return points;
    };
    let tds = triangulation.tds();
    if triangulation.dimension() < 2 {
        return points;
    }
    let mut decides = vec![false; tds.vertex_slots()];
    for cell in tds.cells() {
        let corners = tds.corners(cell);
        let is_finite = !corners.contains(&VertexId::INFINITE);
        let is_narrow = is_finite
            && limit.is_none_or(|limit| {
                is_narrow(corners.map(|vertex| *triangulation.point(vertex)), limit)
            });
        if !is_narrow {
            corners
                .iter()
                .filter(|vertex| **vertex != VertexId::INFINITE)
                .for_each(|vertex| decides[vertex.index()] = true);
        }
    }
    tds.vertices()
        .filter(|vertex| decides[vertex.index()])
        .map(|vertex| *triangulation.point(vertex))
        .collect()
}

/// A part of a length that is more than all rounding errors of a product.
const ROUNDED: f64 = 16.0 * f64::EPSILON;

/// Returns true if the circumscribed disk of a triangle is certainly narrower than a length.
fn is_narrow([a, b, c]: [[f64; 3]; 3], limit: f64) -> bool {
    let side = |p: [f64; 3], q: [f64; 3]| [q[0] - p[0], q[1] - p[1]];
    let [u, v, w] = [side(a, b), side(a, c), side(b, c)];
    let [left, right] = [u[0] * v[1], u[1] * v[0]];
    let area = (left - right).abs() - ROUNDED * (left.abs() + right.abs());
    let length = |[x, y]: [f64; 2]| x.hypot(y);
    let sides = length(u) * length(v) * length(w);
    sides.is_normal() && sides * (1.0 + ROUNDED) < limit * area * (1.0 - ROUNDED)
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::random::Random;

    /// Points on a grid with gaps, in parts: what each part keeps has the rim of all.
    #[test]
    fn the_rim_of_those_that_decide_is_that_of_all() {
        let mut random = Random(71);
        let mut gaps = 0;
        for round in 0..300 {
            let side = 30;
            let holes: Vec<[f64; 2]> = (0..round % 5)
                .map(|_| [0, 1].map(|_| random.below(side) as f64))
                .collect();
            let is_measured = |p: &[f64; 3]| {
                holes
                    .iter()
                    .all(|hole| (p[0] - hole[0]).hypot(p[1] - hole[1]) > 6.0)
            };
            let points: Vec<[f64; 3]> = (0..300)
                .map(|_| [random.below(side) as f64, random.below(side) as f64, 0.0])
                .filter(is_measured)
                .collect();
            let limit = [None, Some(2.0), Some(4.0), Some(5.5)][round % 4];
            let parts = 1 + round % 7;
            let mut kept: Vec<[f64; 3]> = Vec::new();
            for part in 0..parts {
                let own = points.iter().skip(part).step_by(parts).copied().collect();
                kept.extend(deciding(own, limit));
            }
            let kept = deciding(kept, limit);
            let [whole, rim] = [&points, &kept].map(|points| {
                PointRim::new(points, limit)
                    .map(|rim| rim.edges())
                    .unwrap_or_default()
            });
            assert_eq!(rim, whole, "round {round}");
            gaps += usize::from(kept.len() < points.len() / 2 && !whole.is_empty());
        }
        assert!(gaps > 50, "{gaps}");
    }

    #[test]
    fn what_is_no_surface_has_no_rim() {
        let line = [[0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [2.0, 2.0, 1.0]];
        assert!(PointRim::new(&line, None).is_none());
        assert!(PointRim::new(&[], None).is_none());
        let far = [[0.0, 0.0, 1.0], [9.0, 0.0, 1.0], [0.0, 9.0, 1.0]];
        assert!(PointRim::new(&far, Some(5.0)).is_none());
        assert_eq!(PointRim::new(&far, None).unwrap().edges().len(), 3);
        assert!(PointRim::new(&[[f64::NAN; 3]; 3], None).is_none());
        assert_eq!(deciding(line.to_vec(), None), line);
    }
}
