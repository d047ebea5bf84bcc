//! Divides points among the nodes of an octree.
//!
//! A node with few points has all of them. Any other one has an even sample: of each cell of a grid
//! of 128 cells along each axis the point nearest to its center. The nodes below it divide the
//! rest. Where very few are left for a node and all below it, the node above has them, too, after
//! its sample.
//!
//! What a node has depends on its points and their order alone, not on threads or on where they
//! are held.

use std::fs::File;
use std::io;

use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};

use super::list::List;
use crate::data::{Bounds, Lattice};
use crate::error::{Error, Result};
use crate::io::bytes::little_endian::u32_at;
use crate::io::codec::las::node::Key;

/// Cells of a node along each axis, as a power of two.
const CELLS: u32 = 7;

/// Levels of the positions of points within the cube.
const FINEST: u32 = 31;

/// The deepest level that is written: its cells are those of the positions.
const DEEPEST: u32 = FINEST - CELLS;

/// Bits of the number of a point in a slot; those above are the square of its distance.
const NUMBER_BITS: u32 = 40;

/// Bits by which a distance on one axis is measured.
const FINE: u32 = 11;

/// How many points nodes have.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sizes {
    /// A node with at most so many points has none below it.
    pub(super) leaf: u64,
    /// A node that is not the root has at least so many points, with those of the nodes below it.
    pub(super) least: u64,
    /// The most points of a node.
    pub(super) most: u64,
    /// Bytes of records above which they are kept in files.
    pub(super) held: u64,
}

/// The cube of the octree.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cube {
    pub(super) center: [f64; 3],
    pub(super) half: f64,
    lattice: Lattice,
}

impl Cube {
    /// Returns a cube around all points that is a step larger. Its lowest corner is that of the
    /// bounds, where some programs expect it.
    ///
    /// # Errors
    /// If it is larger than numbers are.
    pub(super) fn around(bounds: &Bounds, lattice: Lattice) -> Result<Self> {
        let largest = |of: [f64; 3]| of.into_iter().fold(0.0, f64::max);
        let sides = [0, 1, 2].map(|k| bounds.max[k] - bounds.min[k]);
        let half = (largest(sides) + largest(lattice.scale.map(f64::abs))) / 2.0;
        let low = match bounds.is_empty() {
            true => [0.0; 3],
            false => bounds.min,
        };
        let center = low.map(|low| low + half);
        // Also the side, and what is beyond the cube by as much.
        match center
            .map(|c| c.abs() + 4.0 * half)
            .iter()
            .all(|c| c.is_finite())
        {
            true => Ok(Cube {
                center,
                half,
                lattice,
            }),
            false => Err(Error::limit("the coordinates are too large for an octree")
                .cure("write them as .laz")),
        }
    }

    /// Returns how far apart the points of the first level are, in units of the coordinates.
    pub(super) fn spacing(&self) -> f64 {
        2.0 * self.half / f64::from(1 << CELLS)
    }

    /// Returns where the point of a record is, in steps of 2^-31 of the side of the cube.
    fn site(&self, record: &[u8]) -> [u32; 3] {
        let steps = [0, 4, 8].map(|at| u32_at(record, at).cast_signed());
        let point = self.lattice.point(steps);
        [0, 1, 2].map(|k| {
            let low = self.center[k] - self.half;
            let share = (point[k] - low) / (2.0 * self.half);
            let last = (1_u64 << FINEST) - 1;
            // Numbers outside are the first and the last one.
            ((share * (last as f64 + 1.0)) as u64).min(last) as u32
        })
    }
}

/// A node and its records.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Node {
    pub(super) key: Key,
    pub(super) records: Vec<u8>,
}

/// Divides the records of a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Divider {
    pub(super) cube: Cube,
    pub(super) sizes: Sizes,
    pub(super) stride: usize,
}

impl Divider {
    /// Divides the records of a node, and calls a function with nodes in order, as many as are in
    /// memory together: a node before those below it. `scratch` returns an empty file.
    ///
    /// # Errors
    /// Those of the function, of files, and if more points than a node may have are at one
    /// position.
    pub(super) fn divide(
        &self,
        key: Key,
        list: List,
        scratch: &dyn Fn() -> Result<File>,
        write: &mut dyn FnMut(Vec<Node>) -> Result<()>,
    ) -> Result<()> {
        if list.bytes() <= self.sizes.held || self.is_leaf(key, &list) {
            self.require_few(key, &list)?;
            let held = List::held(self.stride, list.into_bytes()?);
            return write(self.divide_held(key, held)?);
        }
        let files = (0..8).map(|_| Ok(List::filed(self.stride, scratch()?)));
        let (own, below) = self.split(key, list, files.collect::<Result<_>>()?)?;
        write(vec![Node { key, records: own }])?;
        for (octant, list) in below.into_iter().enumerate() {
            if list.count() > 0 {
                self.divide(key.below(octant), list, scratch, write)?;
            }
        }
        Ok(())
    }

    fn is_leaf(&self, key: Key, list: &List) -> bool {
        list.count() <= self.sizes.leaf || key.level == DEEPEST
    }

    /// Returns an error if a node that is not divided has too many points.
    fn require_few(&self, key: Key, list: &List) -> Result<()> {
        if list.count() <= self.sizes.most || !self.is_leaf(key, list) {
            return Ok(());
        }
        Err(Error::limit(format!(
            "{} points are nearly at one position; at most {} can be in a node of COPC",
            list.count(),
            self.sizes.most
        ))
        .cure("write them as .laz"))
    }

    /// Returns the nodes of records in memory.
    fn divide_held(&self, key: Key, list: List) -> Result<Vec<Node>> {
        if self.is_leaf(key, &list) {
            self.require_few(key, &list)?;
            let records = list.into_bytes()?;
            return Ok(vec![Node { key, records }]);
        }
        let held = (0..8)
            .map(|_| List::held(self.stride, Vec::new()))
            .collect();
        let (own, below) = self.split(key, list, held)?;
        let below: Vec<Vec<Node>> = below
            .into_par_iter()
            .enumerate()
            .filter(|(_, list)| list.count() > 0)
            .map(|(octant, list)| self.divide_held(key.below(octant), list))
            .collect::<Result<_>>()?;
        let own = Node { key, records: own };
        Ok(std::iter::once(own)
            .chain(below.into_iter().flatten())
            .collect())
    }

    /// Returns the records that a node keeps, and those of the nodes below it in `below`, which are
    /// empty at first.
    fn split(
        &self,
        key: Key,
        mut list: List,
        mut below: Vec<List>,
    ) -> io::Result<(Vec<u8>, Vec<List>)> {
        let mut sample = Sample::of(key.level);
        list.each(|number, record| {
            sample.offer(number, self.cube.site(record));
            Ok(())
        })?;
        let mut own = Vec::new();
        let bit = FINEST - 1 - key.level;
        list.each(|number, record| {
            let site = self.cube.site(record);
            if sample.has(number, site) {
                own.extend_from_slice(record);
                return Ok(());
            }
            let octant = (0..3).fold(0, |all, k| all | (site[k] >> bit & 1) << k);
            below[octant as usize].push(record)
        })?;
        for list in &mut below {
            if list.count() < self.sizes.least {
                let few = std::mem::replace(list, List::held(self.stride, Vec::new()));
                own.extend(few.into_bytes()?);
            }
        }
        Ok((own, below))
    }
}

/// The point of each cell of a node that is nearest to its center.
struct Sample {
    level: u32,
    /// A slot for each cell: zero without a point, else the number of the point in the low
    /// `NUMBER_BITS`, and above them the square of its distance from the center plus one.
    cells: Vec<u64>,
}

impl Sample {
    fn of(level: u32) -> Self {
        Sample {
            level,
            cells: vec![0; 1 << (3 * CELLS)],
        }
    }

    fn cell(&self, site: [u32; 3]) -> usize {
        let shift = DEEPEST - self.level;
        let mask = (1 << CELLS) - 1;
        site.iter()
            .fold(0, |all, at| all << CELLS | (at >> shift & mask) as usize)
    }

    /// Takes a point, unless the one that its cell has is nearer or as near.
    fn offer(&mut self, number: u64, site: [u32; 3]) {
        let shift = DEEPEST - self.level;
        let distance = |at: u32| {
            let within = u64::from(at) & ((1 << shift) - 1);
            let fine = (within << FINE >> shift) as i64 - (1 << (FINE - 1));
            (fine * fine).cast_unsigned()
        };
        let slot = (site.into_iter().map(distance).sum::<u64>() + 1) << NUMBER_BITS | number;
        let cell = self.cell(site);
        let known = &mut self.cells[cell];
        // The numbers come in order.
        if *known == 0 || slot < *known {
            *known = slot;
        }
    }

    fn has(&self, number: u64, site: [u32; 3]) -> bool {
        self.cells[self.cell(site)] & ((1 << NUMBER_BITS) - 1) == number
    }
}
