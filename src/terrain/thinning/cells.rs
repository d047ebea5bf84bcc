//! One point of each square cell in plan.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use super::held::Held;
use super::position::{cell_of, point};
use super::rule::CellPoint;
use crate::data::PointBatch;
use crate::error::Result;
use crate::terrain::in_order::by_coordinates;

/// The best point of each cell so far.
#[derive(Debug)]
pub(super) struct Cells {
    size: f64,
    keep: CellPoint,
    held: Held,
    /// The row of each cell. Only queried: its order does not show.
    rows: HashMap<[i64; 2], usize>,
    seen: u64,
}

impl Cells {
    pub(super) fn new(size: f64, keep: CellPoint) -> Self {
        Cells {
            size,
            keep,
            held: Held::default(),
            rows: HashMap::new(),
            seen: 0,
        }
    }

    pub(super) fn choose(&mut self, source: usize, batch: &PointBatch) -> Result<()> {
        self.held.announce(source, batch)?;
        for i in 0..batch.len() {
            let found = point(batch, i);
            let cell = cell_of(found, self.size)?;
            match self.rows.entry(cell) {
                Entry::Vacant(empty) => {
                    empty.insert(self.held.rows().len());
                    self.held.push(source, batch, i, self.seen);
                }
                Entry::Occupied(taken) => {
                    let row = *taken.get();
                    let key = |point| key(point, cell, self.size, self.keep);
                    let (new, old) = (key(found), key(self.held.rows()[row].point));
                    if is_less(&new, &old) {
                        self.held.replace(row, source, batch, i, self.seen);
                    }
                }
            }
            self.seen += 1;
        }
        Ok(())
    }

    /// Returns the best points.
    pub(super) fn take(&mut self) -> Held {
        self.rows = HashMap::new();
        std::mem::take(&mut self.held)
    }

    pub(super) fn bytes(&self) -> usize {
        self.held.bytes() + self.rows.len() * size_of::<([i64; 2], usize)>()
    }
}

/// Returns the key of a point in its cell: the point with the least key is kept.
fn key(point: [f64; 3], cell: [i64; 2], size: f64, keep: CellPoint) -> [f64; 4] {
    let [x, y, z] = point;
    let first = match keep {
        CellPoint::Lowest => z,
        CellPoint::Highest => -z,
        CellPoint::Center => {
            let [dx, dy] = [0, 1].map(|k| point[k] - (cell[k] as f64 + 0.5) * size);
            dx * dx + dy * dy
        }
    };
    [first, x, y, z].map(|number| number + 0.0)
}

/// Returns true if a key is before another one: by the first numbers that differ, in their total
/// order, in which NaN has a place, too.
fn is_less(a: &[f64; 4], b: &[f64; 4]) -> bool {
    by_coordinates(a, b).is_lt()
}
