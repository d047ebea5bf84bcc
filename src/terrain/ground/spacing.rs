//! The grid of a job: where its cells start and how large they are, from all of its points.

use std::collections::HashSet;

use rustc_hash::FxBuildHasher;

/// Side of the squares by which the density is estimated, in meters.
const SQUARE: f64 = 4.0;

/// Heights beyond this, in meters, are outliers, and count as this in the mean.
const HIGHEST: f64 = 1e5;

/// The grid on which the ground is searched.
///
/// Tiles of a job that use the same one agree on the ground away from their borders.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct GroundGrid {
    /// The lowest coordinates, and a height near the mean, in meters.
    pub origin: [f64; 3],
    /// The spacing of the points, in meters, where there are any.
    pub spacing: f64,
}

impl GroundGrid {
    /// Returns the grid of these points, which are in meters; none if no point is finite.
    ///
    /// # Complexity
    /// Linear.
    pub fn of(points: &[[f64; 3]]) -> Option<GroundGrid> {
        let mut finder = GroundGridFinder::default();
        finder.add(points);
        finder.grid()
    }

    /// Returns how far from a tile points have an influence on it, in meters, apart from rare
    /// cases: the overlap of tiles.
    pub fn reach(&self) -> f64 {
        100.0f64.max(60.0 * self.spacing)
    }
}

/// Returns true if no coordinate is infinite or NaN.
pub(super) fn is_finite(point: &[f64; 3]) -> bool {
    point.iter().all(|value| value.is_finite())
}

/// Finds the grid of points that are given in batches, in any order.
///
/// In memory is one entry for each square of 4 m that has points.
#[derive(Debug, Clone, Default)]
pub struct GroundGridFinder {
    low: Option<[f64; 2]>,
    count: u64,
    /// The sum, in whole meters: sums of fractions would depend on the order.
    heights: i128,
    squares: HashSet<(i64, i64), FxBuildHasher>,
}

impl GroundGridFinder {
    /// Takes points, in meters. Those that are not finite are ignored.
    pub fn add(&mut self, points: &[[f64; 3]]) {
        let mut last = None;
        for &point in points {
            if !is_finite(&point) {
                continue;
            }
            self.lower([point[0], point[1]]);
            self.heights += point[2].clamp(-HIGHEST, HIGHEST) as i128;
            self.count += 1;
            let square = (
                (point[0] / SQUARE).floor() as i64,
                (point[1] / SQUARE).floor() as i64,
            );
            if last != Some(square) {
                self.squares.insert(square);
                last = Some(square);
            }
        }
    }

    /// Takes the points of another finder, too.
    pub fn merge(&mut self, other: &GroundGridFinder) {
        if let Some(theirs) = other.low {
            self.lower(theirs);
        }
        self.heights += other.heights;
        self.count += other.count;
        self.squares.extend(&other.squares);
    }

    /// Returns the grid of the points so far, or none if there are none.
    pub fn grid(&self) -> Option<GroundGrid> {
        let [x, y] = self.low?;
        let area = self.squares.len() as f64 * SQUARE * SQUARE;
        Some(GroundGrid {
            origin: [x, y, (self.heights / i128::from(self.count)) as f64],
            spacing: (area / self.count as f64).sqrt(),
        })
    }

    fn lower(&mut self, [x, y]: [f64; 2]) {
        let [low_x, low_y] = self.low.get_or_insert([x, y]);
        *low_x = low_x.min(x);
        *low_y = low_y.min(y);
    }
}
