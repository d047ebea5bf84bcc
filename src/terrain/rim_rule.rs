//! The rule by which triangles are left out at the rim of a surface.

use super::linear::plan_distance;
use crate::triangulation::tds::{ccw, cw};

/// Which triangles are left out at the rim of a surface: those that can be reached from outside
/// over *open* edges. An edge on a line is never open. Others are open to what is behind them:
///
/// ```text
///     ____________________    outside        the edge is long: the triangle spans a bay, or
///     '-.__         __.-'                    ends far away
///          '--._.--'                         the triangle is a cap: the points are below it,
///       .    .    .   .       points         and its heights are those of its ends
/// ```
///
/// The order makes no difference, and neither do triangles elsewhere: a triangle has the same open
/// edges in any part of the triangulation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RimRule {
    /// Edges longer than this in plan, in the units of the data, are open. With `None`, length
    /// opens no edge.
    pub max_edge: Option<f64>,
    /// True if the longest edges of *caps* are open: triangles with an angle over 165 degrees.
    pub opens_caps: bool,
}

/// The square of the cosine of the least angle of a cap, 165 degrees: (2 + √3) / 4.
const CAP_COSINE_SQUARED: f64 = 0.933_012_701_892_219_3;

impl RimRule {
    /// Returns the rule without caps.
    pub fn longest(max_edge: Option<f64>) -> Self {
        RimRule {
            max_edge,
            opens_caps: false,
        }
    }

    /// Returns true if the edge opposite corner `i` of a triangle is open to the triangle, unless
    /// the edge is on a line. The result is the same if the triangle is numbered from another
    /// corner.
    #[inline]
    pub fn is_open(&self, corners: &[[f64; 3]; 3], i: usize) -> bool {
        let [p, q] = [corners[ccw(i)], corners[cw(i)]];
        self.max_edge.is_some_and(|limit| is_longer(p, q, limit))
            || self.opens_caps && is_cap(corners[i], [p, q])
    }
}

/// Returns true if the distance between two points in plan is more than a limit.
#[inline]
fn is_longer(p: [f64; 3], q: [f64; 3], limit: f64) -> bool {
    // PERF: `hypot` takes longer than the rest, and nearly all edges are short.
    (p[0] - q[0]).abs() + (p[1] - q[1]).abs() > limit && plan_distance(p, q) > limit
}

/// Returns true if the angle at a corner of a triangle is that of a cap; the other two corners are
/// interchangeable, to the bit.
#[inline]
fn is_cap(corner: [f64; 3], others: [[f64; 3]; 2]) -> bool {
    let [u, v] = others.map(|p| [p[0] - corner[0], p[1] - corner[1]]);
    let dot = u[0] * v[0] + u[1] * v[1];
    let square = |[x, y]: [f64; 2]| x * x + y * y;
    dot < 0.0 && dot * dot > CAP_COSINE_SQUARED * (square(u) * square(v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{EdgeKind, Surface, corners};
    use crate::terrain::{Tin, TinBuilder};
    use testkit::random::Random;

    #[test]
    fn caps_are_flat_and_seen_from_their_longest_edge() {
        let rule = RimRule {
            max_edge: None,
            opens_caps: true,
        };
        for (degrees, is_cap) in [
            (164.9_f64, false),
            (165.1, true),
            (179.0, true),
            (90.0, false),
        ] {
            let depth = 5.0 / (degrees / 2.0).to_radians().tan();
            for turn in 0..12 {
                let (sin, cos) = (f64::from(turn) * 0.6).sin_cos();
                let at = |x: f64, y: f64| [300.0 + x * cos - y * sin, x * sin + y * cos, 7.0];
                let corners = [at(0.0, depth), at(-5.0, 0.0), at(5.0, 0.0)];
                for first in 0..3 {
                    let turned = [0, 1, 2].map(|k| corners[(k + first) % 3]);
                    let open = (0..3).filter(|&i| rule.is_open(&turned, i));
                    let expected = is_cap.then_some((3 - first) % 3);
                    assert_eq!(
                        open.collect::<Vec<_>>(),
                        Vec::from_iter(expected),
                        "{degrees}"
                    );
                }
            }
        }
    }

    /// Points that are scattered over a square, as in a tile.
    #[test]
    fn no_cap_is_left_at_the_rim_and_no_vertex_is_lost() {
        let mut random = Random(3);
        let mut builder = TinBuilder::default();
        for _ in 0..4000 {
            let [x, y] = [0, 1].map(|_| random.below(100_000) as f64 / 1000.0);
            builder.add_points(&[x], &[y], &[(x / 9.0).sin()]);
        }
        let whole = builder.clone().build().unwrap();
        builder.leave_out_caps = true;
        let rule = builder.rim_rule();
        let tin = builder.build().unwrap();
        let faces = |tin: &Tin| -> Vec<[[f64; 3]; 3]> {
            let corners = corners(tin).map(|(_, face)| face.map(|v| tin.position(v)));
            corners.collect()
        };
        let at_rim = |tin: &Tin, (face, _): &(u32, [u32; 3]), i: usize| {
            tin.edge_kind(*face, i) == EdgeKind::Rim
        };
        let caps = |tin: &Tin| {
            let is_cap = |face: &(u32, [u32; 3])| {
                let corners = face.1.map(|v| tin.position(v));
                (0..3).any(|i| at_rim(tin, face, i) && rule.is_open(&corners, i))
            };
            corners(tin).filter(is_cap).count()
        };
        assert!(caps(&whole) > 10);
        assert_eq!(caps(&tin), 0);
        assert_eq!(tin.report().vertices, whole.report().vertices);
        // Others stay: what is left out is thin, and at the border of the square.
        for [a, b, c] in faces(&whole) {
            let middle = [0, 1].map(|k| (a[k] + b[k] + c[k]) / 3.0);
            let is_at_border = middle.iter().any(|c| !(4.0..96.0).contains(c));
            assert!(is_at_border || tin.elevation(middle[0], middle[1]).is_some());
        }
        let left = tin.report().triangles + tin.report().faces_beyond_max_edge;
        assert_eq!(left, whole.report().triangles);
    }

    #[test]
    fn edges_are_open_if_they_are_longer_than_the_limit() {
        let corners = [[0.0, 0.0, 1.0], [3.0, 0.0, 50.0], [0.0, 4.0, -50.0]];
        let open = |limit| {
            let rule = RimRule::longest(limit);
            [0, 1, 2].map(|i| rule.is_open(&corners, i))
        };
        assert_eq!(open(None), [false; 3]);
        assert_eq!(open(Some(3.0)), [true, true, false]);
        assert_eq!(open(Some(5.0)), [false; 3]);
    }
}
