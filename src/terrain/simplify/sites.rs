//! The sites that a surface is simplified from.

use rayon::prelude::*;

use super::lattice::Lattice;
use crate::data::{AT_ONCE, Bounds};
use crate::triangulation::{InputError, spatial_order};

/// The sites that a surface is to be close to.
pub(super) enum Sites {
    Scattered {
        /// From west to east, and from south to north where x is equal; each position once.
        positions: Vec<[f64; 3]>,
        /// All of them in an order in which each is near to the one before.
        order: Vec<u32>,
    },
    /// The cells of a raster.
    Lattice {
        lattice: Lattice,
        /// The position in plan of a column and a row.
        frame: LatticeFrame,
    },
}

/// Where the columns and rows of a lattice are.
#[derive(Debug, Clone)]
pub(super) struct LatticeFrame {
    /// The x of each column, increasing.
    pub(super) x: Vec<f64>,
    /// The y of each row, increasing.
    pub(super) y: Vec<f64>,
}

impl Sites {
    /// Sites that are sorted by x, then y; each position once.
    ///
    /// # Errors
    /// If there are too many.
    pub(super) fn scattered(positions: Vec<[f64; 3]>) -> Result<Self, InputError> {
        let plan = |site: usize| {
            let [x, y, _] = positions[site];
            [x, y]
        };
        let order = spatial_order(positions.len(), plan)?;
        Ok(Sites::Scattered { positions, order })
    }

    pub(super) fn count(&self) -> usize {
        match self {
            Sites::Scattered { positions, .. } => positions.len(),
            Sites::Lattice { lattice, .. } => lattice.heights.len(),
        }
    }

    #[inline(always)]
    pub(super) fn position(&self, site: u32) -> [f64; 3] {
        let [x, y] = self.plan(site);
        let z = match self {
            Sites::Scattered { positions, .. } => positions[site as usize][2],
            Sites::Lattice { lattice, .. } => lattice.heights[site as usize],
        };
        [x, y, z]
    }

    #[inline(always)]
    pub(super) fn plan(&self, site: u32) -> [f64; 2] {
        match self {
            Sites::Scattered { positions, .. } => {
                let [x, y, _] = positions[site as usize];
                [x, y]
            }
            Sites::Lattice { lattice, frame } => {
                let [column, row] = lattice.position(site);
                [frame.x[column as usize], frame.y[row as usize]]
            }
        }
    }

    /// The number of sites that have heights.
    pub(super) fn count_of_heights(&self) -> usize {
        match self {
            Sites::Scattered { positions, .. } => positions.len(),
            Sites::Lattice { lattice, .. } => {
                let heights = lattice.heights.par_iter().with_min_len(AT_ONCE);
                heights.filter(|z| !z.is_nan()).count()
            }
        }
    }

    /// The difference between the highest and the lowest height.
    pub(super) fn range_of_heights(&self) -> f64 {
        let [low, high] = match self {
            Sites::Scattered { positions, .. } => {
                let Bounds { min, max } = Bounds::around(positions);
                [min[2], max[2]]
            }
            Sites::Lattice { lattice, .. } => lattice.range(),
        };
        if low <= high { high - low } else { 0.0 }
    }

    /// Some of these sites, numbered by their places in a list; of a lattice, a rectangle of it
    /// with so many rows.
    pub(super) fn part(&self, part: &[u32], rows: Option<u32>) -> Self {
        match self {
            Sites::Scattered { positions, .. } => Sites::Scattered {
                positions: part.iter().map(|&site| positions[site as usize]).collect(),
                order: (0..part.len() as u32).collect(),
            },
            Sites::Lattice { lattice, frame } => {
                let rows = rows.unwrap_or(lattice.rows);
                let heights = part.iter().map(|&site| lattice.heights[site as usize]);
                let [x, y] = lattice.position(part[0]).map(|k| k as usize);
                let frame = LatticeFrame {
                    x: frame.x[x..x + part.len() / rows as usize].to_vec(),
                    y: frame.y[y..y + rows as usize].to_vec(),
                };
                Sites::Lattice {
                    lattice: Lattice::new(rows, heights.collect()),
                    frame,
                }
            }
        }
    }

    /// Sites among which are all that may be corners of the convex hull.
    pub(super) fn may_be_at_hull(&self) -> Vec<u32> {
        match self {
            Sites::Scattered { positions, .. } => (0..positions.len() as u32).collect(),
            Sites::Lattice { lattice, .. } => lattice.ends_of_columns(),
        }
    }

    /// The sites that have heights.
    pub(super) fn with_heights(&self) -> impl Iterator<Item = u32> {
        (0..self.count() as u32).filter(|&site| !self.position(site)[2].is_nan())
    }
}
