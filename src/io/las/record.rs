//! Converts packed point records to columns.

use super::header::Header;
use super::options::Detail;
use super::raw::{u16_at, u32_at};
use crate::data::{PointBatch, PointFlags};

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
            kind: if header.point_format < 6 { RecordKind::Legacy } else { RecordKind::Extended },
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
            records().map(move |record| f64::from(u32_at(record, 4 * i).cast_signed()) * scale + offset)
        };
        batch.x.extend(axis(0));
        batch.y.extend(axis(1));
        batch.z.extend(axis(2));
        match self.kind {
            RecordKind::Legacy => {
                batch.class.extend(records().map(|record| record[15] & 0x1f));
                // Synthetic, key point, withheld: the order of PointFlags.
                batch.flags.extend(records().map(|record| PointFlags(record[15] >> 5)));
                batch.return_number.extend(records().map(|record| record[14] & 0x07));
            }
            RecordKind::Extended => {
                batch.class.extend(records().map(|record| record[16]));
                batch.flags.extend(records().map(|record| PointFlags(record[15] & 0x0f)));
                batch.return_number.extend(records().map(|record| record[14] & 0x0f));
            }
        }
    }
}

/// Splits bytes into little-endian 16-bit words.
pub(super) fn words(bytes: &[u8]) -> Vec<u16> {
    bytes.chunks_exact(2).map(|word| u16_at(word, 0)).collect()
}
