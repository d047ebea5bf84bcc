//! Points that are far below the terrain, or alone in the air.

use std::collections::HashMap;

use rustc_hash::FxBuildHasher;

/// Further below the terrain than this, in meters, and than twice the tolerance.
const DEPTH: f32 = 1.0;

/// The least side of the cubes in which points are counted, in meters.
const CUBE: f64 = 4.0;

/// The side of a cube, in spacings of the points.
const SPACINGS: f64 = 4.0;

/// A point has company if there are more points than this in its cube and the 26 around it.
const ALONE: u32 = 5;

/// Returns whether a point at a height above the terrain is below all that can be ground.
pub(super) fn is_low(above: f32, tolerance: f32) -> bool {
    above < -(DEPTH + 2.0 * tolerance)
}

type Cube = [i64; 3];

/// The numbers of points above the terrain, by cubes.
pub(super) struct Company {
    side: f64,
    counts: HashMap<Cube, u32, FxBuildHasher>,
}

impl Company {
    /// Counts points that are above the terrain.
    pub(super) fn of(points: impl Iterator<Item = [f64; 3]>, spacing: f64) -> Company {
        let mut company = Company {
            side: CUBE.max(SPACINGS * spacing),
            counts: HashMap::default(),
        };
        for point in points {
            *company.counts.entry(company.cube(point)).or_default() += 1;
        }
        company
    }

    /// Returns whether a point is alone in the air: more than two cubes above the terrain, with at
    /// most four others near it.
    pub(super) fn is_alone(&self, point: [f64; 3], above: f32) -> bool {
        if f64::from(above) <= 2.0 * self.side {
            return false;
        }
        let [x, y, z] = self.cube(point);
        let mut count = 0;
        for at in 0..27 {
            let around = [x + at % 3 - 1, y + at / 3 % 3 - 1, z + at / 9 - 1];
            count += self.counts.get(&around).copied().unwrap_or(0);
        }
        count <= ALONE
    }

    fn cube(&self, point: [f64; 3]) -> Cube {
        // Far from the limits of whole numbers, whatever the coordinates.
        point.map(|value| (value / self.side).floor().clamp(-1e15, 1e15) as i64)
    }
}
