//! What a surface loses in formats that round its coordinates.

use super::Listing;
use crate::data::{Bounds, orientation};
use crate::triangulation::num::Sign;

/// What was lost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Loss {
    /// The largest difference of a coordinate.
    largest: f64,
    /// Triangles without an area in plan, or turned over.
    flat: usize,
}

impl Loss {
    /// Compares a surface with its rounded coordinates.
    ///
    /// # Complexity
    /// Linear.
    pub(crate) fn of(mesh: &Listing, rounded: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let difference = |p: [f64; 3]| {
            let axes = rounded(p).into_iter().zip(p);
            axes.fold(0.0, |largest: f64, (a, b)| largest.max((a - b).abs()))
        };
        let largest = mesh.vertices().map(difference).fold(0.0, f64::max);
        let is_flat =
            |corners: &[[f64; 3]; 3]| orientation(corners.map(&rounded)) != Sign::Positive;
        Loss {
            largest,
            flat: mesh.triangles().filter(is_flat).count(),
        }
    }

    /// Returns what a user should know: `kind` are the numbers of the format.
    pub(crate) fn notes(self, kind: &str, [x, y, z]: [f64; 3]) -> Vec<String> {
        let Loss { largest, flat } = self;
        let difference = match largest > 0.0 {
            true => format!("they differ by up to {largest:.1e}"),
            false => "none differs".to_owned(),
        };
        let mut notes = vec![format!(
            "coordinates are {kind} relative to {x} {y} {z}: {difference}"
        )];
        if flat > 0 {
            notes.push(format!(
                "{flat} triangles have no area in these coordinates"
            ));
        }
        notes
    }
}

/// Returns a local origin in the middle of a surface: whole numbers, or simple fractions for one
/// that is smaller than 16 units.
pub(crate) fn local_origin(bounds: &Bounds) -> [f64; 3] {
    if bounds.is_empty() {
        return [0.0; 3];
    }
    [0, 1, 2].map(|axis| {
        let (min, max) = (bounds.min[axis], bounds.max[axis]);
        let extent = (max - min) / 16.0;
        // A power of two, so that the result is exact.
        let step = match extent > 0.0 {
            true => extent.log2().floor().clamp(-60.0, 0.0).exp2(),
            false => 1.0,
        };
        let middle = min + (max - min) / 2.0;
        let origin = (middle / step).round() * step;
        if origin.is_finite() { origin } else { 0.0 }
    })
}
