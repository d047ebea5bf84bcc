//! Points with a smallest distance in plan.
//!
//! Points are taken in the order of the hashes of their positions. Each is kept unless it is too
//! close to one that was kept before. That is a function of the set of points.
//!
//! To decide on a point, all points of smaller hashes must be known, that is after all points were
//! given. If there are too many to be held, those of the largest hashes are dropped: a pass decides
//! on all points up to some hash. In the next one, points that are close to one that is kept are
//! dropped at once, and these are nearly all if many are kept already.

use std::collections::HashMap;

use super::held::{Held, Row};
use super::position::{cell_of, hash, point};
use crate::data::PointBatch;
use crate::error::Result;

/// A cell is a little larger than the distance: points that are not further apart are in the same
/// or in adjacent cells, although the position in a cell is rounded, by 2^-13 of its size at most.
const CELL: f64 = 1.0 + 1.0 / 1024.0;

/// Chooses points in the order of their hashes.
#[derive(Debug)]
pub(super) struct Spaced {
    distance: f64,
    seed: u64,
    /// Candidates that may be held, unless four times the points that are kept are more; `None` if
    /// all must be held.
    limit: Option<usize>,
    /// All points with hashes up to this are decided.
    decided: Option<u64>,
    /// In this pass, only points with hashes up to this are candidates.
    last: Option<u64>,
    candidates: Held,
    /// The hashes of the candidates.
    hashes: Vec<u64>,
    kept: Held,
    near: Near,
    /// Points given in this pass.
    seen: u64,
}

impl Spaced {
    pub(super) fn new(distance: f64, seed: u64, limit: Option<usize>) -> Self {
        Spaced {
            distance,
            seed,
            limit,
            decided: None,
            last: None,
            candidates: Held::default(),
            hashes: Vec::new(),
            kept: Held::default(),
            near: Near::default(),
            seen: 0,
        }
    }

    pub(super) fn choose(&mut self, source: usize, batch: &PointBatch) -> Result<()> {
        self.candidates.announce(source, batch)?;
        for i in 0..batch.len() {
            let number = self.seen;
            self.seen += 1;
            let found = point(batch, i);
            let hash = hash(found, self.seed);
            let is_decided = self.decided.is_some_and(|decided| hash <= decided);
            if is_decided || self.last.is_some_and(|last| hash > last) {
                continue;
            }
            let cell = cell_of(found, self.distance * CELL)?;
            if self.is_covered(found, cell) {
                continue;
            }
            self.candidates.push(source, batch, i, number);
            self.hashes.push(hash);
            if let Some(limit) = self.limit {
                let limit = limit.max(4 * self.kept.rows().len());
                if self.hashes.len() >= 2 * limit {
                    self.drop_beyond(limit);
                }
            }
        }
        Ok(())
    }

    /// Returns true if a point in this cell is too close to one that is kept.
    fn is_covered(&self, point: [f64; 3], cell: [i64; 2]) -> bool {
        let rows = self.kept.rows();
        self.near.covers(rows, point, cell, self.distance)
    }

    /// Returns the candidates in the order in which they are taken.
    fn order(&self) -> Vec<u32> {
        let rows = self.candidates.rows();
        let mut order: Vec<u32> = (0..rows.len() as u32).collect();
        order.sort_unstable_by_key(|&at| (self.hashes[at as usize], rows[at as usize].number));
        order
    }

    /// Drops candidates until at most this many are left, or all that are left have one hash.
    fn drop_beyond(&mut self, limit: usize) {
        let mut order = self.order();
        // Of several points of one position, only the first can be kept.
        let point = |at: u32| self.candidates.rows()[at as usize].point;
        order.dedup_by(|later, first| point(*later) == point(*first));
        let hash = |at: u32| self.hashes[at as usize];
        if order.len() > limit {
            let last = hash(order[limit - 1]);
            order.truncate(order.partition_point(|&at| hash(at) <= last));
            self.last = Some(last);
        }
        let hashes = order.iter().map(|&at| hash(at)).collect();
        self.candidates = self.candidates.only(&order);
        self.hashes = hashes;
    }

    /// Decides on all candidates. Returns true if there are no other points.
    pub(super) fn end_pass(&mut self) -> bool {
        for at in self.order() {
            let at = at as usize;
            let found = self.candidates.rows()[at].point;
            // The cell of a candidate is known: it was computed when it became one.
            let Ok(cell) = cell_of(found, self.distance * CELL) else {
                continue;
            };
            if !self.is_covered(found, cell) {
                self.near.add(cell);
                self.kept.push_from(&self.candidates, at);
            }
        }
        self.candidates.clear();
        self.hashes.clear();
        self.seen = 0;
        self.decided = self.last.take();
        self.decided.is_none()
    }

    /// Returns the points that are kept.
    pub(super) fn take(&mut self) -> Held {
        self.near = Near::default();
        std::mem::take(&mut self.kept)
    }

    pub(super) fn bytes(&self) -> usize {
        let of_candidates = self.candidates.bytes() + self.hashes.len() * size_of::<u64>();
        of_candidates + self.kept.bytes() + self.near.bytes()
    }
}

/// Finds points that are kept by their cells. Only queried: the order of the table does not show.
#[derive(Debug, Default)]
struct Near {
    /// The row of the last point of each cell, from 1.
    last: HashMap<[i64; 2], usize>,
    /// For each row, that of the point before it in its cell, from 1; 0 if it is the first.
    before: Vec<usize>,
}

impl Near {
    /// Adds the next row.
    fn add(&mut self, cell: [i64; 2]) {
        let number = self.before.len() + 1;
        let before = self.last.insert(cell, number).unwrap_or_default();
        self.before.push(before);
    }

    /// Returns true if a point is closer to one of the rows than a distance.
    fn covers(
        &self,
        rows: &[Row],
        point: [f64; 3],
        [column, row]: [i64; 2],
        distance: f64,
    ) -> bool {
        // Its own cell first, which decides most.
        const AROUND: [i64; 3] = [0, -1, 1];
        AROUND.iter().any(|up| {
            AROUND.iter().any(|right| {
                let mut next = self.last.get(&[column + right, row + up]).copied();
                while let Some(at) = next.and_then(|number| number.checked_sub(1)) {
                    if is_closer(rows[at].point, point, distance) {
                        return true;
                    }
                    next = self.before.get(at).copied();
                }
                false
            })
        })
    }

    fn bytes(&self) -> usize {
        self.last.len() * size_of::<([i64; 2], usize)>() + self.before.len() * size_of::<usize>()
    }
}

/// Returns true if two points are closer in plan than a distance, computed in doubles.
fn is_closer([x0, y0, _]: [f64; 3], [x1, y1, _]: [f64; 3], distance: f64) -> bool {
    let [x, y] = [x1 - x0, y1 - y0].map(|d| d / distance);
    x * x + y * y < 1.0
}
