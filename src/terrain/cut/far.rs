//! Division of lines that reach far beyond a triangulation.

use crate::triangulation::ConstrainedDelaunay;
use crate::triangulation::geometry::{Crossing, Geometry, Terrain};
use crate::triangulation::num::{Dyadic, unsigned_zero};
use crate::triangulation::tds::VertexId;

use crate::terrain::regions::{Domain, Segment};

/// How far a segment may reach from zero on each axis, relative to the triangulation.
const REACH: f64 = 2.0;

/// Divides segments where they leave the box that reaches [`REACH`] times as far from zero as the
/// surface, whose largest coordinates are `reach`.
///
/// The grid to which crossings are rounded is as coarse as the largest coordinate of a segment
/// requires. With a corner at 2^52, as a stand-in for "no limit", it would consist of whole
/// numbers, and the cut could be a meter off.
///
/// # Complexity
/// Linear.
pub(crate) fn divided(curves: &[(Domain, Segment)], reach: [f64; 2]) -> Vec<(Domain, Segment)> {
    let geometry: Terrain = Terrain::default();
    let limits = reach.map(|most| REACH * most);
    let mut divided = Vec::with_capacity(curves.len());
    for &(domain, [a, b]) in curves {
        let is_far = (0..2).any(|k| a[k].abs().max(b[k].abs()) > limits[k]);
        let mut ends = vec![a, b];
        if is_far {
            for (axis, limit) in [
                (0, -limits[0]),
                (0, limits[0]),
                (1, -limits[1]),
                (1, limits[1]),
            ] {
                let site = crossing([a, b], axis, limit).map(|site| geometry.on_step(site));
                let admitted = site.filter(|&[x, y]| geometry.admits(&[x, y, 0.0]));
                ends.extend(admitted.filter(|site| (0..2).all(|k| site[k].abs() <= limits[k])));
            }
        }
        let longer = usize::from((b[0] - a[0]).abs() < (b[1] - a[1]).abs());
        ends.sort_unstable_by(|p, q| p[longer].total_cmp(&q[longer]));
        if a[longer] > b[longer] {
            ends.reverse();
        }
        ends.dedup();
        divided.extend(ends.windows(2).map(|pair| (domain, [pair[0], pair[1]])));
    }
    divided
}

/// Returns the largest coordinates of a triangulation on both axes, without their signs.
pub(crate) fn reach_of(base: &ConstrainedDelaunay<Terrain>) -> [f64; 2] {
    let vertices = base
        .tds()
        .vertices()
        .filter(|&vertex| vertex != VertexId::INFINITE);
    vertices.fold([0.0, 0.0], |most, vertex| {
        let p = base.point(vertex);
        [0, 1].map(|k: usize| f64::max(most[k], p[k].abs()))
    })
}

/// The point at which a segment crosses a line perpendicular to an axis, strictly between its ends.
///
/// It is accurate to two units in the last place, however long the segment is, and exact if the
/// segment runs along the axis.
fn crossing([a, b]: Segment, axis: usize, limit: f64) -> Option<[f64; 2]> {
    let is_between = a[axis] < limit && limit < b[axis] || b[axis] < limit && limit < a[axis];
    if !is_between {
        return None;
    }
    let other = 1 - axis;
    let difference = |k: usize| Dyadic::difference(b[k], a[k]);
    let numerator = Dyadic::from(a[other]) * difference(axis)
        + Dyadic::difference(limit, a[axis]) * difference(other);
    let mut site = [limit; 2];
    let (low, high) = (a[other].min(b[other]), a[other].max(b[other]));
    site[other] = unsigned_zero(numerator.quotient(&difference(axis)).clamp(low, high));
    Some(site)
}
