//! Convex hulls in the plane and in space, as scipy lists them. Only extreme points are corners,
//! which is decided exactly: none lies on the straight line or in the plane of others.

mod flat;
mod inner_box;
mod listed;
mod plane;
mod space;

use std::sync::atomic::AtomicBool;

use breakline::triangulation::InputError;
use breakline::triangulation::geometry::{Geometry, Plane, Space};
use rayon::prelude::*;

pub(super) use self::listed::Hull;
use super::lists::CHUNK;
use super::mesh::make_zeros_unsigned;

/// Returns the hull of points in the plane, the first `accepted` of which were checked before;
/// `None` if all are collinear.
///
/// # Errors
/// If one of the others is refused, or the work is canceled.
pub(super) fn of_plane(
    points: &mut [[f64; 2]],
    accepted: usize,
    cancel: &AtomicBool,
) -> Result<Option<Hull<2>>, InputError> {
    admit(Plane::new(), points, accepted)?;
    plane::hull(points, cancel)
}

/// Returns the hull of points in space, the first `accepted` of which were checked before; `None`
/// if all are coplanar.
///
/// # Errors
/// If one of the others is refused, or the work is canceled.
pub(super) fn of_space(
    points: &mut [[f64; 3]],
    accepted: usize,
    cancel: &AtomicBool,
) -> Result<Option<Hull<3>>, InputError> {
    admit(Space::new(), points, accepted)?;
    space::hull(points, cancel)
}

/// Makes negative zeros positive, and checks the points from number `accepted` on.
///
/// # Errors
/// If one that was not accepted before is not finite, or out of the range of exact arithmetic. Its
/// number is that among these.
fn admit<G: Geometry<N, Point = [f64; D]> + Sync, const N: usize, const D: usize>(
    geometry: G,
    points: &mut [[f64; D]],
    accepted: usize,
) -> Result<(), InputError> {
    make_zeros_unsigned(points);
    let new = points.get(accepted..).unwrap_or_default();
    let refused = new
        .par_iter()
        .with_min_len(CHUNK)
        .position_first(|p| !geometry.admits(p));
    match refused {
        None => Ok(()),
        Some(row) if geometry.is_finite(&new[row]) => Err(InputError::Coordinate(row)),
        Some(row) => Err(InputError::NotFinite(row)),
    }
}
