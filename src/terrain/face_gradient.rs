//! The gradient of a face, and what follows from it.

use super::focal::direction;
use super::linear;
use crate::terrain::in_order::in_order;
use crate::triangulation::num::unsigned_zero;

/// Returns the rise per unit of x and of y on a triangle, whatever its first corner is; not finite
/// if it has no area.
pub(super) fn of_face(mut corners: [[f64; 3]; 3]) -> [f64; 2] {
    corners.sort_unstable_by(|p, q| in_order(&(p[0], p[1]), &(q[0], q[1])));
    // A level triangle has 0, not -0.0.
    linear::gradient(corners).map(unsigned_zero)
}

/// Returns the steeper of two gradients; of two that are equally steep, the smaller one. One that
/// is not finite, of a triangle too thin for its area, does not count.
pub(super) fn steeper(one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    let square = |[x, y]: [f64; 2]| x * x + y * y;
    let key = |gradient: [f64; 2]| {
        let steepness = Some(square(gradient)).filter(|square| square.is_finite());
        (-steepness.unwrap_or(-1.0), gradient[0], gradient[1])
    };
    if key(one) < key(other) { one } else { other }
}

/// Returns the slope, as the tangent of the angle above the horizon, and the direction in which a
/// surface with this gradient falls, in degrees clockwise from north and below 360; NaN if it is
/// level. `z_factor` are the units of y per unit of z, `x_scale` those per unit of x.
pub(super) fn slope_and_aspect([x, y]: [f64; 2], z_factor: f64, x_scale: f64) -> [f64; 2] {
    let rise = [x * z_factor / x_scale, y * z_factor];
    [rise[0].hypot(rise[1]), direction(rise)]
}
