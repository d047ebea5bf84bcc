//! Triangulations of lines that may cross.

use crate::error::{Error, Result};
use crate::triangulation::geometry::Terrain;
use crate::triangulation::{ConstrainedDelaunay, OnCrossing};

/// Returns a triangulation of lines through points, with a vertex at each crossing.
///
/// # Errors
/// If a point is refused, or there are too many.
///
/// # Complexity
/// That of [`ConstrainedDelaunay::from_lines`].
pub(super) fn arranged<L: AsRef<[u32]>>(
    points: &[[f64; 3]],
    lines: &[L],
) -> Result<ConstrainedDelaunay<Terrain>> {
    ConstrainedDelaunay::from_lines(Terrain::default(), points, lines, OnCrossing::Split)
        .map(|(triangulation, _)| triangulation)
        .map_err(|e| Error::limit(e.to_string()))
}
