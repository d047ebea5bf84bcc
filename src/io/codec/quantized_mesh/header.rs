//! Where a tile is on the earth: what viewers need to know before they draw it.

use crate::crs::{SEMI_AXES, geocentric};
use crate::data::{TerrainTile, Tiling};

/// The point of a tile that spans so much of the earth that a part of it is always above the
/// horizon: a viewer that compares with it finds that it is not below.
const NEVER_BELOW: [f64; 3] = [f64::NAN; 3];

/// The least cosine for which there is a point.
const LEAST_SLOPE: f64 = 1.0e-6;

/// What the header of a tile says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Header {
    /// X, Y and Z of the center.
    pub(super) center: [f64; 3],
    /// The lowest height and the highest, in meters.
    pub(super) range: [f64; 2],
    /// The center and the radius of a sphere around all vertices.
    pub(super) sphere: ([f64; 3], f64),
    /// If this point is below the horizon, all of the tile is; in semi-axes of the earth.
    pub(super) horizon: [f64; 3],
}

impl Header {
    pub(super) fn of(tile: &TerrainTile, tiling: Tiling) -> Self {
        let on_earth = |steps: [u16; 3]| geocentric(tile.position(tiling, steps));
        let positions: Vec<[f64; 3]> = tile.vertices.iter().map(|&steps| on_earth(steps)).collect();
        let mut bounds = crate::data::Bounds::default();
        positions.iter().for_each(|&p| bounds.add(p));
        let middle = [0, 1, 2].map(|k| (bounds.min[k] + bounds.max[k]) / 2.0);
        let radius = positions
            .iter()
            .map(|p| length([0, 1, 2].map(|k| p[k] - middle[k])))
            .fold(0.0, f64::max);
        let half = TerrainTile::STEPS / 2;
        Header {
            center: on_earth([half; 3]),
            range: tile.range(),
            sphere: (middle, radius),
            horizon: horizon(middle, &positions),
        }
    }
}

fn length(p: [f64; 3]) -> f64 {
    p.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// The lowest point above a center from which each horizon is above all positions ("Horizon
/// culling", Cesium 2013): on a sphere of radius 1, a position is hidden by the tangent through it.
fn horizon(center: [f64; 3], positions: &[[f64; 3]]) -> [f64; 3] {
    let scaled = |p: [f64; 3]| [0, 1, 2].map(|k| p[k] / SEMI_AXES[k]);
    let unit = |p: [f64; 3]| {
        let length = length(p);
        (length > 0.0).then(|| p.map(|c| c / length))
    };
    let Some(up) = unit(scaled(center)) else {
        return NEVER_BELOW;
    };
    let slopes = positions.iter().map(|&p| {
        let p = scaled(p);
        let magnitude = length(p).max(1.0);
        let direction = unit(p).unwrap_or(up);
        let cos_alpha: f64 = (0..3).map(|k| direction[k] * up[k]).sum();
        let turn = |k: usize| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            direction[i] * up[j] - direction[j] * up[i]
        };
        let sin_alpha = length([0, 1, 2].map(turn));
        let cos_beta = 1.0 / magnitude;
        let sin_beta = (magnitude * magnitude - 1.0).sqrt() * cos_beta;
        cos_alpha * cos_beta - sin_alpha * sin_beta
    });
    let least = slopes.fold(1.0, f64::min);
    match least > LEAST_SLOPE {
        true => up.map(|c| c / least),
        false => NEVER_BELOW,
    }
}
