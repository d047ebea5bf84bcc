//! What lines are while they are smoothed and simplified: strands between points that stay.

use std::cmp::Ordering;

use super::corridor::Spot;
use crate::terrain::in_order::in_order;
use crate::terrain::linear::sorted;
use crate::terrain::walk::At;

/// The part of a line between two points that stay where they are. Its other points lie inside of
/// one cell of the lattice.
#[derive(Debug, Clone)]
pub(super) struct Strand {
    /// The line, and the number of the strand along it.
    pub(super) line: u32,
    pub(super) number: u32,
    pub(super) points: Vec<[f64; 2]>,
    /// Where on the surface the points are: the first and the last one as seen from this strand.
    pub(super) at: Vec<At>,
}

impl Strand {
    pub(super) fn spot(&self, i: usize) -> Spot {
        Spot {
            point: self.points[i],
            at: self.at[i],
        }
    }

    /// Returns the ends in an order that does not depend on the direction.
    pub(super) fn ends(&self) -> [[f64; 2]; 2] {
        sorted([self.points[0], self.points[self.points.len() - 1]])
    }

    /// Compares strands by their points.
    pub(super) fn compare(&self, other: &Strand) -> Ordering {
        in_order(&self.points, &other.points)
    }
}

/// Returns true if a line turns back at the middle one of three points, by more than 168 degrees:
/// where rounding could hide that it runs over itself.
pub(super) fn turns_back([a, b, c]: [[f64; 2]; 3]) -> bool {
    let [u, v] = [[a, b], [b, c]].map(|[p, q]| [q[0] - p[0], q[1] - p[1]]);
    u[0] * v[0] + u[1] * v[1] < -0.98 * u[0].hypot(u[1]) * v[0].hypot(v[1])
}
