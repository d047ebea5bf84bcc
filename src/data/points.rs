use super::{Bounds, Columns, LasHead, Lattice};
use crate::crs::Crs;
use crate::error::{Result, Wording};

/// The classification flags of a lidar point, as in LAS 1.4.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PointFlags(pub u8);

impl PointFlags {
    /// Created by other means than the sensor.
    pub const SYNTHETIC: u8 = 1;
    /// A model key point.
    pub const KEY_POINT: u8 = 2;
    /// Deleted: must not be used.
    pub const WITHHELD: u8 = 4;
    /// In the overlap of two flight lines.
    pub const OVERLAP: u8 = 8;

    /// Returns true if the point must not be used.
    pub fn is_withheld(self) -> bool {
        self.0 & Self::WITHHELD != 0
    }
}

/// A batch of points, as columns of equal length.
///
/// Columns that a format does not have, such as classes or return numbers, are empty.
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
    /// Numbers of returns of the pulses, or empty.
    pub return_count: Vec<u8>,
    /// The LAS records of the points, one after the other, all of the same length; empty unless
    /// they were requested from the source.
    pub records: Vec<u8>,
}

impl PointBatch {
    /// Returns the number of the return of point `i`, and how many its pulse has, if both are
    /// known.
    pub fn return_of(&self, i: usize) -> Option<(u8, u8)> {
        Some((*self.return_number.get(i)?, *self.return_count.get(i)?))
    }

    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Returns true if the batch contains no points.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Removes all points and keeps the allocated memory.
    pub fn clear(&mut self) {
        self.x.clear();
        self.y.clear();
        self.z.clear();
        self.class.clear();
        self.flags.clear();
        self.return_number.clear();
        self.return_count.clear();
        self.records.clear();
    }

    /// Keeps only the points whose entry in `keep` is true, in order.
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
        retain(&mut self.return_count, keep);
    }
}

/// Keeps the items whose entry in `keep` is true; an empty column stays empty.
fn retain<T: Copy>(column: &mut Vec<T>, keep: &[bool]) {
    let mut marks = keep.iter();
    column.retain(|_| marks.next().is_some_and(|keep| *keep));
}

/// What a file states about its points before they are read.
///
/// It may be wrong: memory must not be allocated by it.
#[derive(Debug, Clone, Default)]
pub struct PointInfo {
    /// The format, such as "LAS 1.4, point format 6, LAZ".
    pub format: String,
    /// The stated number of points.
    pub count: Option<u64>,
    /// The stated extent.
    pub bounds: Option<Bounds>,
    /// Coordinate system.
    pub crs: Option<Crs>,
    /// What the file states as its coordinate system, if that is not understood.
    pub unread_crs: Option<String>,
    /// True if the points have classes.
    pub has_classes: bool,
    /// The columns that are read, for text files.
    pub columns: Option<Columns>,
    /// The lattice of the coordinates, for formats that have one.
    pub lattice: Option<Lattice>,
    /// The head of a LAS file, if the records of its points were requested.
    pub head: Option<LasHead>,
    /// Warnings for the user: contradictions, guesses, ignored content.
    pub warnings: Vec<Wording>,
}

/// A stream of points, in batches of bounded size.
pub trait PointSource {
    /// What the header of the file states.
    fn info(&self) -> &PointInfo;

    /// Replaces the content of `batch` by the next points; an empty batch marks the end.
    ///
    /// # Errors
    /// If the data is damaged. Points returned before are valid.
    fn read(&mut self, batch: &mut PointBatch) -> Result<()>;

    /// Restricts reading to a sample, which shows where points are in a fraction of the time.
    ///
    /// The sample consists of runs of some 50 000 points that follow each other in the file. One
    /// run begins every `spacing` points. All points are equally likely to be in it. Returns false,
    /// and changes nothing, if the source cannot skip points.
    fn thin(&mut self, spacing: u64) -> bool {
        let _ = spacing;
        false
    }

    /// Restricts reading to the parts of the file that may have points in a window, in plan and
    /// with its border, by an index that the file has. Points outside of the window may still be
    /// returned; all points keep their order. Returns `None`, and changes nothing, without an
    /// index. To be called before the first batch is read, and before [`thin`](Self::thin).
    ///
    /// # Errors
    /// If the index is damaged.
    fn narrow(&mut self, window: &Bounds) -> Result<Option<PartRead>> {
        let _ = window;
        Ok(None)
    }

    /// Restricts reading to the coarse levels of the file: to the first one on which points are at
    /// most `spacing` apart, and those above it. The stated number of points is that of these
    /// levels then. Returns `None`, and changes nothing, if points have no levels. To be called
    /// when [`narrow`](Self::narrow) may.
    ///
    /// # Errors
    /// If the index is damaged.
    fn coarsen(&mut self, spacing: f64) -> Result<Option<PartRead>> {
        let _ = spacing;
        Ok(None)
    }

    /// Warnings from reading, such as a file that ends early; complete after the last batch.
    fn warnings(&self) -> &[Wording] {
        &[]
    }
}

/// How much of a file is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PartRead {
    /// The number of parts that are read, such as nodes of an octree.
    pub parts: usize,
    /// The number of parts that would have been read otherwise.
    pub of: usize,
    /// The number of points that are read.
    pub points: u64,
}

/// What a [`PointSink`] wrote.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PointSummary {
    /// The number of points.
    pub count: u64,
    /// The box around the points, with the coordinates that a reader gets.
    pub bounds: Bounds,
}

/// Writes points in batches. The file does not exist before [`finish`](Self::finish).
pub trait PointSink {
    /// Announces the source of the points that follow.
    ///
    /// # Errors
    /// If its points cannot be written together with those before.
    fn next_source(&mut self, info: &PointInfo) -> Result<()>;

    /// Writes a batch of points.
    ///
    /// # Errors
    /// If a point cannot be written without loss, or the system fails.
    fn write(&mut self, batch: &PointBatch) -> Result<()>;

    /// Writes the remaining points and creates the file at its final path.
    ///
    /// # Errors
    /// If the system fails; then no file is created.
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
        assert_eq!(
            (batch.x, batch.z, batch.class),
            (vec![1.0, 3.0], vec![7.0, 9.0], vec![1, 3])
        );
        assert_eq!((batch.records, batch.flags.len()), (b"aacc".to_vec(), 0));
    }
}
