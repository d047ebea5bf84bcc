//! How coordinates are transformed, and the error of builds without PROJ.

#[cfg(not(feature = "proj"))]
use crate::crs::Crs;

/// How coordinates are transformed. The default uses the grids that are installed, and the epoch
/// that the source states.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
pub struct TransformOptions {
    /// Makes it an error if the best operation needs a grid that is missing, or if heights cannot
    /// be transformed. By default the next best operation is used, and a warning says so.
    pub require_grids: bool,
    /// The epoch of the coordinates, in years such as 2021.5, for operations that depend on it. By
    /// default the one that the source states, if any.
    pub epoch: Option<f64>,
}

/// Returns the error of a build without PROJ.
#[cfg(not(feature = "proj"))]
pub(super) fn needs_proj(from: &Crs, to: &Crs) -> crate::error::Error {
    crate::error::Error::unsupported(format!(
        "reprojecting from {from} to {to} needs PROJ, which this build does not have"
    ))
    .cure(crate::error::wording![
        "build with ",
        crate::error::Feature::Proj,
        " (needs g++, make, cmake, sqlite3)"
    ])
}
