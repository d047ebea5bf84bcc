//! Converts packed point records to columns.

use super::header::Header;
use super::merge::far;
use crate::data::{Lattice, PointBatch, PointFlags};
use crate::error::{Error, Result};
use crate::io::bytes::little_endian::{u16_at, u32_at};
use crate::io::options::las::Detail;

/// How point records are laid out in memory, and how their integers become coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct RecordLayout {
    /// Distance from one record to the next, in bytes.
    pub(super) stride: usize,
    /// How much is read of each record.
    pub(super) detail: Detail,
    kind: RecordKind,
    scale: [f64; 3],
    offset: [f64; 3],
}

/// The two families of point formats. Within a family, all fields used here have the same offsets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RecordKind {
    /// Formats 0 to 5: three bits for the return, five for the class, three for flags.
    Legacy,
    /// Formats 6 to 10: four bits for the return, four for flags, a byte for the class.
    Extended,
}

impl RecordLayout {
    pub(super) fn new(header: &Header, detail: Detail) -> Self {
        RecordLayout {
            stride: header.record_length.into(),
            detail,
            kind: if header.point_format < 6 {
                RecordKind::Legacy
            } else {
                RecordKind::Extended
            },
            scale: header.scale,
            offset: header.offset,
        }
    }

    /// Returns this layout for records of another length.
    pub(super) fn with_stride(self, stride: usize) -> Self {
        RecordLayout { stride, ..self }
    }

    /// Appends whole records to the columns. A coordinate is `X * scale + offset` in f64, rounded
    /// after each of the two operations.
    pub(super) fn append(&self, records: &[u8], batch: &mut PointBatch) {
        if self.detail == Detail::Records {
            batch.records.extend_from_slice(records);
        }
        let records = || records.chunks_exact(self.stride);
        let axis = |i: usize| {
            let (scale, offset) = (self.scale[i], self.offset[i]);
            records()
                .map(move |record| f64::from(u32_at(record, 4 * i).cast_signed()) * scale + offset)
        };
        batch.x.extend(axis(0));
        batch.y.extend(axis(1));
        batch.z.extend(axis(2));
        match self.kind {
            RecordKind::Legacy => {
                batch
                    .class
                    .extend(records().map(|record| record[15] & 0x1f));
                // Synthetic, key point, withheld: the order of PointFlags.
                batch
                    .flags
                    .extend(records().map(|record| PointFlags(record[15] >> 5)));
                batch
                    .return_number
                    .extend(records().map(|record| record[14] & 0x07));
                batch
                    .return_count
                    .extend(records().map(|record| record[14] >> 3 & 0x07));
            }
            RecordKind::Extended => {
                batch.class.extend(records().map(|record| record[16]));
                batch
                    .flags
                    .extend(records().map(|record| PointFlags(record[15] & 0x0f)));
                batch
                    .return_number
                    .extend(records().map(|record| record[14] & 0x0f));
                batch
                    .return_count
                    .extend(records().map(|record| record[14] >> 4));
            }
        }
    }
}

/// Writes the coordinates of points into their records, as the nearest points of a lattice. The
/// columns then have the coordinates that a reader of the records gets.
///
/// # Errors
/// If the points lack their records, or one of them is too far from the offset of the lattice.
pub fn put_coordinates(batch: &mut PointBatch, lattice: &Lattice) -> Result<()> {
    let stride = batch.records.len() / batch.len().max(1);
    if stride < 12 && !batch.is_empty() {
        return Err(Error::usage("the points lack their records"));
    }
    for (i, record) in batch.records.chunks_exact_mut(stride.max(1)).enumerate() {
        let point = [batch.x[i], batch.y[i], batch.z[i]];
        let steps = lattice.nearest(point).ok_or_else(|| far(point))?;
        for (bytes, steps) in record.chunks_exact_mut(4).zip(steps) {
            bytes.copy_from_slice(&steps.to_le_bytes());
        }
        [batch.x[i], batch.y[i], batch.z[i]] = lattice.point(steps);
    }
    Ok(())
}

/// Splits bytes into little-endian 16-bit words.
pub(super) fn words(bytes: &[u8]) -> Vec<u16> {
    bytes.chunks_exact(2).map(|word| u16_at(word, 0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_put_into_records() {
        let lattice = Lattice {
            scale: [0.01, 0.01, 0.5],
            offset: [100.0, -200.0, 0.0],
        };
        let mut batch = PointBatch {
            x: vec![101.004, 99.0],
            y: vec![-200.0, -199.996],
            z: vec![1.2, -7.0],
            records: [[9; 14], [8; 14]].concat(),
            ..PointBatch::default()
        };
        put_coordinates(&mut batch, &lattice).unwrap();
        let steps = |at: usize| u32_at(&batch.records, at).cast_signed();
        assert_eq!([0, 4, 8, 14, 18, 22].map(steps), [100, 0, 2, -100, 0, -14]);
        assert_eq!(
            (&batch.records[12..14], &batch.records[26..]),
            (&[9, 9][..], &[8, 8][..])
        );
        assert_eq!(
            (batch.x, batch.y, batch.z),
            (vec![101.0, 99.0], vec![-200.0; 2], vec![1.0, -7.0])
        );

        for (x, records) in [
            (1e9, vec![0; 14]),
            (f64::NAN, vec![0; 14]),
            (1.0, Vec::new()),
        ] {
            let mut batch = PointBatch {
                x: vec![x],
                y: vec![0.0],
                z: vec![0.0],
                records,
                ..PointBatch::default()
            };
            assert!(put_coordinates(&mut batch, &lattice).is_err(), "{x}");
        }
        put_coordinates(&mut PointBatch::default(), &lattice).unwrap();
    }
}
