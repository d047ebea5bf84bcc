//! Reprojection with [PROJ](https://proj.org), behind the feature `proj`.
//!
//! Coordinates are always easting (or longitude) first. PROJ picks, point by point, the best
//! operation for which it has grids. None of the large grids are included, so it may fall back on
//! an operation with an accuracy of meters, or of unknown accuracy;
//! [`Transform::warnings`](crate::crs::Transform::warnings) lists the operations that were used,
//! their accuracy, and the grids of better ones.
//!
//! Heights are transformed between vertical systems and heights above the ellipsoid if both systems
//! state what their heights are and the grids are installed. If not, they are converted between
//! units only, and a warning says which grid is missing; [`TransformOptions::require_grids`] makes
//! that an error. Operations that leave heights as they are, which PROJ calls ballpark, are never
//! taken for transforms of heights.

mod facts;
mod listing;
mod options;

#[cfg(feature = "proj")]
mod candidates;
#[cfg(feature = "proj")]
mod library;
#[cfg(feature = "proj")]
mod operation;
#[cfg(feature = "proj")]
mod routes;

pub use facts::{GridState, OperationArea, OperationFacts, OperationGrid};
pub use listing::{Operations, TransformedPoint, operations};
pub use options::TransformOptions;

use crate::crs::{Crs, Transform};
use crate::error::Result;

/// Returns the operation that transforms coordinates from one system to another.
///
/// It may be used from many threads; each gets its own PROJ context. Only the source may be a
/// geocentric system: its X, Y and Z become a position in plan and a height above the ellipsoid.
///
/// # Errors
/// If PROJ does not know one of the systems or no operation between them, or a grid is missing that
/// is required; without the feature `proj`, always.
pub fn transform(from: &Crs, to: &Crs, options: &TransformOptions) -> Result<Box<dyn Transform>> {
    #[cfg(feature = "proj")]
    return operation::transform(from, to, options);
    #[cfg(not(feature = "proj"))]
    {
        let _ = options;
        Err(options::needs_proj(from, to))
    }
}
