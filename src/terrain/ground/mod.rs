//! The ground of raw lidar, by the shape of the point cloud alone.
//!
//! [`classify`] decides for each point whether it is on the terrain. One set of parameters, in
//! meters, serves all data; what depends on the density of the points is derived from it.
//!
//! # How it works
//!
//! 1. The lowest point of each cell makes a surface; empty cells are filled, and pits are left out.
//! 2. Openings by disks of growing radii remove what stands above its surroundings. How much a disk
//!    removes, compared with what a steep terrain would lose, is evidence that a cell is an object.
//!    (Pingel, Clarke and McBride 2013 decide by one such comparison.)
//! 3. A minimum cut (Boykov and Kolmogorov 2004) divides the cells into ground and objects. It is
//!    cheap to separate cells where a step is between them, so that a roof is cut out along its
//!    rim, and a hillock, which has none, stays with the ground.
//! 4. Where the terrain turns out to be steep, evidence counts less, and an even slope is no step;
//!    the cells are divided again. Roofs wider than the widest disk are found by their rim,
//!    bridges by their sides.
//! 5. The cells that are ground make the terrain. Points near it are ground, the nearer the flatter
//!    it is.
//!
//! Three grids of different cells are used, and their terrains averaged.
//!
//! # Complexity
//!
//! Linear in the number of points and of cells, apart from the cut, which is so in practice. Cells
//! are as large as the spacing of the points, but not smaller than a meter, so dense points cost
//! little more than reading them.
//!
//! # What it cannot see
//!
//! Roofs that are level with a slope, low plants (up to some 30 cm), and walled embankments, which
//! look like bridges. Under water without returns the terrain is interpolated.

mod bridges;
mod cut;
mod evidence;
mod fill;
mod filter;
mod graph;
mod islands;
mod layer;
mod lowest;
mod nearest;
mod nodes;
mod noise;
mod openings;
mod options;
mod parts;
mod pits;
mod planes;
mod raster;
pub(crate) mod recipe;
mod spacing;
mod surface;
#[cfg(test)]
mod tests;
mod tiles;

use std::sync::atomic::AtomicBool;

pub use self::options::{Bridges, GroundOptions, PointClass};
use self::spacing::is_finite;
pub use self::spacing::{GroundGrid, GroundGridFinder};
pub use self::tiles::{Doubt, GroundTiles, Take, TiledClasses, classify_in_tiles};
use super::cancel::go_on;
use crate::error::{Error, Result};

/// Points are numbered with 32 bits.
const LIMIT: usize = u32::MAX as usize - 1;

/// Returns the class of each point, in the order of the points.
///
/// Positions and heights are in meters: callers scale them. The result depends on the set of
/// points alone, not on their order or on the number of threads; points that are equal get the same
/// class. Points that are not finite are [`PointClass::Object`].
///
/// # Errors
/// - if the points are spread so far that the cells between them would not fit into memory
/// - if there are more points than 32 bits can number
/// - [`Error::canceled`], if `cancel` becomes true
///
/// # Examples
///
/// ```
/// use std::sync::atomic::AtomicBool;
///
/// use breakline::terrain::ground::{GroundOptions, PointClass, classify};
///
/// // A shed on a plane.
/// let points: Vec<[f64; 3]> = (0..900)
///     .map(|at| {
///         let (x, y) = (f64::from(at % 30), f64::from(at / 30));
///         let is_shed = (10.0..15.0).contains(&x) && (10.0..15.0).contains(&y);
///         [x, y, if is_shed { 3.0 } else { 0.0 }]
///     })
///     .collect();
/// let classes = classify(&points, &GroundOptions::default(), &AtomicBool::new(false))?;
/// let objects = classes.iter().filter(|class| **class == PointClass::Object);
/// assert_eq!(objects.count(), 25);
/// # Ok::<(), breakline::Error>(())
/// ```
pub fn classify(
    points: &[[f64; 3]],
    options: &GroundOptions,
    cancel: &AtomicBool,
) -> Result<Vec<PointClass>> {
    classify_by(points, options, &recipe::Recipe::default(), cancel)
}

/// Like [`classify`], but by other numbers.
pub(crate) fn classify_by(
    points: &[[f64; 3]],
    options: &GroundOptions,
    recipe: &recipe::Recipe,
    cancel: &AtomicBool,
) -> Result<Vec<PointClass>> {
    go_on(cancel)?;
    if !points.iter().all(is_finite) {
        let finite: Vec<[f64; 3]> = points.iter().copied().filter(is_finite).collect();
        let mut classes = classify_by(&finite, options, recipe, cancel)?.into_iter();
        let class = |point| match is_finite(point) {
            true => classes.next().unwrap_or(PointClass::Object),
            false => PointClass::Object,
        };
        return Ok(points.iter().map(class).collect());
    }
    if points.len() > LIMIT {
        return Err(Error::limit(format!(
            "{} points are more than the {LIMIT} that are filtered at once",
            points.len()
        ))
        .cure("filter parts of the area apart"));
    }
    let Some(grid) = options.grid.or_else(|| GroundGrid::of(points)) else {
        return Ok(Vec::new());
    };
    filter::classified(points, &grid, options, recipe, cancel)
}
