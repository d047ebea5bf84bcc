use std::fmt;

use super::{Bounds, LasHead, Lattice};
use crate::crs::Crs;
use crate::error::Result;

/// What a lidar point says of itself, as in LAS 1.4.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PointFlags(pub u8);

impl PointFlags {
    /// Made by other means than the sensor.
    pub const SYNTHETIC: u8 = 1;
    /// A model key point.
    pub const KEY_POINT: u8 = 2;
    /// Deleted: not to be used.
    pub const WITHHELD: u8 = 4;
    /// In the overlap of two flight lines.
    pub const OVERLAP: u8 = 8;

    /// Whether the point is to be ignored.
    pub fn is_withheld(self) -> bool {
        self.0 & Self::WITHHELD != 0
    }
}

/// A run of points as columns of equal length.
///
/// Formats without classes or returns leave those columns empty.
#[derive(Debug, Clone, Default)]
pub struct PointBatch {
    /// Eastings, or longitudes.
    pub x: Vec<f64>,
    /// Northings, or latitudes.
    pub y: Vec<f64>,
    /// Heights.
    pub z: Vec<f64>,
    /// Classification codes (2 is ground), or empty.
    pub class: Vec<u8>,
    /// Flags, or empty.
    pub flags: Vec<PointFlags>,
    /// Return numbers, or empty.
    pub return_number: Vec<u8>,
    /// The records of the points as LAS has them, one after the other, all of one length; empty unless the source was
    /// asked for them.
    pub records: Vec<u8>,
}

impl PointBatch {
    /// Points in the batch.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether the batch holds no point.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Forgets the points and keeps the memory.
    pub fn clear(&mut self) {
        self.x.clear();
        self.y.clear();
        self.z.clear();
        self.class.clear();
        self.flags.clear();
        self.return_number.clear();
        self.records.clear();
    }

    /// Keeps the points that are marked, in order.
    ///
    /// # Complexity
    /// Linear.
    pub fn retain(&mut self, keep: &[bool]) {
        let stride = self.records.len().checked_div(self.len()).unwrap_or(0);
        if stride > 0 {
            let mut end = 0;
            for (i, _) in keep.iter().enumerate().filter(|(_, keep)| **keep) {
                self.records.copy_within(i * stride..(i + 1) * stride, end);
                end += stride;
            }
            self.records.truncate(end);
        }
        retain(&mut self.x, keep);
        retain(&mut self.y, keep);
        retain(&mut self.z, keep);
        retain(&mut self.class, keep);
        retain(&mut self.flags, keep);
        retain(&mut self.return_number, keep);
    }
}

/// Keeps the items that are marked; a column that is not there stays empty.
fn retain<T: Copy>(column: &mut Vec<T>, keep: &[bool]) {
    let mut marks = keep.iter();
    column.retain(|_| marks.next().is_some_and(|keep| *keep));
}

/// Which columns of a table are taken for the coordinates, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Columns {
    /// Eastings, or longitudes.
    pub x: usize,
    /// Northings, or latitudes.
    pub y: usize,
    /// Heights.
    pub z: usize,
    /// Classification codes, if there are any.
    pub class: Option<usize>,
}

/// As "x 3, y 2, z 4".
impl fmt::Display for Columns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "x {}, y {}, z {}", self.x, self.y, self.z)?;
        self.class.map_or(Ok(()), |class| write!(f, ", class {class}"))
    }
}

/// What a file says of its points before they are read. None of it is to be trusted for
/// allocation.
#[derive(Debug, Clone, Default)]
pub struct PointInfo {
    /// "LAS 1.4, point format 6, LAZ"
    pub format: String,
    /// The stated number of points.
    pub count: Option<u64>,
    /// The stated extent.
    pub bounds: Option<Bounds>,
    /// Coordinate system.
    pub crs: Option<Crs>,
    /// Whether the points carry classes.
    pub has_classes: bool,
    /// The columns that are taken, for text.
    pub columns: Option<Columns>,
    /// The lattice of the coordinates, for formats that have one.
    pub lattice: Option<Lattice>,
    /// The head of a LAS file, if the source was asked for the records of its points.
    pub head: Option<LasHead>,
    /// What a user should be told: a disagreement, a guess, something ignored.
    pub warnings: Vec<String>,
}

/// A stream of points, in batches of bounded size.
pub trait PointSource {
    /// What the header says.
    fn info(&self) -> &PointInfo;

    /// Replaces the content of `batch` with the next points; an empty batch is the end.
    ///
    /// # Errors
    /// When the data is damaged. Points already handed out are good.
    fn read(&mut self, batch: &mut PointBatch) -> Result<()>;

    /// What came up while reading (a file that ends early, say); complete after the last batch.
    fn warnings(&self) -> &[String] {
        &[]
    }
}

/// What was written: points, counted.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PointSummary {
    /// Points.
    pub count: u64,
    /// The box around them, as they read back.
    pub bounds: Bounds,
}

/// Takes points in batches and writes them; nothing is there before [`finish`](Self::finish).
pub trait PointSink {
    /// Says that the points that follow come from this source.
    ///
    /// # Errors
    /// If its points cannot be written with those before.
    fn next_source(&mut self, info: &PointInfo) -> Result<()>;

    /// Writes points.
    ///
    /// # Errors
    /// If a point cannot be written without a loss, or the system fails.
    fn write(&mut self, batch: &PointBatch) -> Result<()>;

    /// Writes what is left, and lets the file appear.
    ///
    /// # Errors
    /// If the system fails; then there is no file.
    fn finish(self: Box<Self>) -> Result<PointSummary>;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marked_points_stay_with_their_records() {
        let mut batch = PointBatch {
            x: vec![1.0, 2.0, 3.0],
            y: vec![4.0, 5.0, 6.0],
            z: vec![7.0, 8.0, 9.0],
            class: vec![1, 2, 3],
            records: b"aabbcc".to_vec(),
            ..PointBatch::default()
        };
        batch.retain(&[true, false, true]);
        assert_eq!((batch.x, batch.z, batch.class), (vec![1.0, 3.0], vec![7.0, 9.0], vec![1, 3]));
        assert_eq!((batch.records, batch.flags.len()), (b"aacc".to_vec(), 0));
    }
}
