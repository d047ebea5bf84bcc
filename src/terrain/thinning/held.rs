//! Points that wait until all others are known, with everything that is to be written of them.

use std::ops::Range;

use super::position::point;
use crate::data::{PointBatch, PointFlags};
use crate::error::{Error, Result};

/// Points per batch that is returned.
const BATCH: usize = 1 << 16;

/// A point with its columns. Columns that its source does not have are 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Row {
    pub(super) point: [f64; 3],
    /// The number of the point in the order in which points are given.
    pub(super) number: u64,
    source: usize,
    class: u8,
    flags: u8,
    return_number: u8,
    return_count: u8,
}

/// Which columns the points of a source have.
#[derive(Debug, Clone, Copy, Default)]
struct Present {
    class: bool,
    flags: bool,
    returns: bool,
}

/// Rows, and the LAS records of the same points, if there are any.
#[derive(Debug, Clone, Default)]
pub(super) struct Held {
    rows: Vec<Row>,
    records: Vec<u8>,
    /// Bytes per record.
    stride: usize,
    sources: Vec<Present>,
}

impl Held {
    pub(super) fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Returns where the record of a row, or of a point of a batch, is among all records.
    fn record(&self, at: usize) -> Range<usize> {
        at * self.stride..(at + 1) * self.stride
    }

    pub(super) fn bytes(&self) -> usize {
        self.rows.len() * size_of::<Row>() + self.records.len()
    }

    /// Notes which columns a batch of a source has, and how long its records are.
    ///
    /// # Errors
    /// If the records are not as long as those of the rows held.
    pub(super) fn announce(&mut self, source: usize, batch: &PointBatch) -> Result<()> {
        if batch.is_empty() {
            return Ok(());
        }
        if self.sources.len() <= source {
            self.sources.resize(source + 1, Present::default());
        }
        self.sources[source] = Present {
            class: !batch.class.is_empty(),
            flags: !batch.flags.is_empty(),
            returns: !batch.return_number.is_empty(),
        };
        let stride = batch.records.len() / batch.len();
        if self.rows.is_empty() {
            self.stride = stride;
        }
        if stride == self.stride {
            Ok(())
        } else {
            Err(Error::usage(format!(
                "the points have records of {} and of {stride} bytes, which cannot be thinned together",
                self.stride
            )))
        }
    }

    /// Adds point `i` of a batch that was announced.
    pub(super) fn push(&mut self, source: usize, batch: &PointBatch, i: usize, number: u64) {
        self.rows.push(row(source, batch, i, number));
        let record = self.record(i);
        self.records.extend_from_slice(&batch.records[record]);
    }

    /// Replaces a row by point `i` of a batch that was announced.
    pub(super) fn replace(
        &mut self,
        at: usize,
        source: usize,
        batch: &PointBatch,
        i: usize,
        number: u64,
    ) {
        self.rows[at] = row(source, batch, i, number);
        let [to, from] = [at, i].map(|k| self.record(k));
        self.records[to].copy_from_slice(&batch.records[from]);
    }

    /// Adds a row of others.
    pub(super) fn push_from(&mut self, others: &Held, at: usize) {
        if self.rows.is_empty() {
            self.stride = others.stride;
        }
        if self.sources.len() < others.sources.len() {
            self.sources.clone_from(&others.sources);
        }
        self.rows.push(others.rows[at]);
        let record = self.record(at);
        self.records.extend_from_slice(&others.records[record]);
    }

    /// Returns some of the rows, in this order.
    pub(super) fn only(&self, order: &[u32]) -> Held {
        let mut some = Held {
            rows: Vec::with_capacity(order.len()),
            records: Vec::with_capacity(order.len() * self.stride),
            stride: self.stride,
            sources: self.sources.clone(),
        };
        order
            .iter()
            .for_each(|&at| some.push_from(self, at as usize));
        some
    }

    /// Removes all rows, and keeps the memory.
    pub(super) fn clear(&mut self) {
        self.rows.clear();
        self.records.clear();
    }

    /// Returns the points in the order of their numbers, in batches of one source each.
    pub(super) fn into_batches(self) -> impl Iterator<Item = (usize, PointBatch)> {
        let mut order: Vec<usize> = (0..self.rows.len()).collect();
        order.sort_unstable_by_key(|&at| self.rows[at].number);
        let mut done = 0;
        std::iter::from_fn(move || {
            let rest = &order[done..];
            let source = self.rows[*rest.first()?].source;
            let of_source = |at: &&usize| self.rows[**at].source == source;
            let count = rest.iter().take(BATCH).take_while(of_source).count();
            done += count;
            Some((source, self.batch(source, &rest[..count])))
        })
    }

    fn batch(&self, source: usize, order: &[usize]) -> PointBatch {
        let has = self.sources.get(source).copied().unwrap_or_default();
        let mut batch = PointBatch::default();
        for &at in order {
            let row = &self.rows[at];
            let [x, y, z] = row.point;
            batch.x.push(x);
            batch.y.push(y);
            batch.z.push(z);
            if has.class {
                batch.class.push(row.class);
            }
            if has.flags {
                batch.flags.push(PointFlags(row.flags));
            }
            if has.returns {
                batch.return_number.push(row.return_number);
                batch.return_count.push(row.return_count);
            }
            batch
                .records
                .extend_from_slice(&self.records[self.record(at)]);
        }
        batch
    }
}

fn row(source: usize, batch: &PointBatch, i: usize, number: u64) -> Row {
    let byte = |column: &[u8]| column.get(i).copied().unwrap_or_default();
    Row {
        point: point(batch, i),
        number,
        source,
        class: byte(&batch.class),
        flags: batch.flags.get(i).copied().unwrap_or_default().0,
        return_number: byte(&batch.return_number),
        return_count: byte(&batch.return_count),
    }
}
