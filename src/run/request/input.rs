//! Input from files or from memory.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::crs::Crs;
use crate::data::{PointBatch, PointInfo, PointSource};
use crate::error::{Error, Result};

/// The name that stands for the standard input.
pub const STDIN: &str = "-";

/// Points per batch.
const BATCH: usize = 1 << 16;

/// Input from a file, or from memory. Cheap to clone.
#[derive(Debug, Clone)]
pub enum Input<T> {
    /// A file of any readable format. `-` reads points from the standard input. The layer of a
    /// vector file, and the attribute with its heights, may be named after the file, see
    /// [`Spec::parse`](crate::io::layer::Spec::parse).
    File(PathBuf),
    /// Data in memory.
    Memory(Arc<T>),
}

/// Stored by the path of the file. What is in memory cannot be stored.
impl<T> Serialize for Input<T> {
    fn serialize<S: Serializer>(&self, to: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Input::File(path) => path.serialize(to),
            Input::Memory(_) => Err(S::Error::custom("an input is in memory")),
        }
    }
}

impl<'de, T> Deserialize<'de> for Input<T> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> std::result::Result<Self, D::Error> {
        PathBuf::deserialize(from).map(Input::File)
    }
}

impl<T> From<PathBuf> for Input<T> {
    fn from(path: PathBuf) -> Self {
        Input::File(path)
    }
}

impl<T> From<&Path> for Input<T> {
    fn from(path: &Path) -> Self {
        Input::File(path.to_path_buf())
    }
}

impl<T> From<&str> for Input<T> {
    fn from(path: &str) -> Self {
        Input::File(path.into())
    }
}

impl<T> Input<T> {
    /// Returns the path of the file; for memory, a name for messages.
    pub fn path(&self) -> &Path {
        match self {
            Input::File(path) => path,
            Input::Memory(_) => Path::new("(memory)"),
        }
    }

    /// Calls a function with the name of each file among inputs.
    pub(crate) fn each_file(inputs: &mut [Self], visit: &mut dyn FnMut(&mut PathBuf)) {
        for input in inputs {
            match input {
                Input::File(path) => visit(path),
                Input::Memory(_) => {}
            }
        }
    }

    /// Returns true if the input can be read only once.
    pub(crate) fn is_read_once(&self) -> bool {
        match self {
            Input::File(path) => is_read_once(path),
            Input::Memory(_) => false,
        }
    }
}

/// Names files for a sentence, after what they are; `None` if there is none.
pub(crate) fn named<'a>(
    what: &str,
    mut files: impl ExactSizeIterator<Item = &'a Path>,
) -> Option<String> {
    let first = files.next()?.display();
    Some(match files.len() {
        0 => format!("{what} {first}"),
        others => format!("{what} {first} and {others} more"),
    })
}

/// Returns true if a file can be read only once: the standard input, a pipe, a device.
pub(crate) fn is_read_once(path: &Path) -> bool {
    path.as_os_str() == STDIN
        || std::fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir())
}

/// Points in memory, and their coordinate system if it is known.
#[derive(Debug, Clone, Default)]
pub struct MemoryPoints {
    /// The points, in columns of equal length; classes and flags may be empty.
    pub points: PointBatch,
    /// Their coordinate system.
    pub crs: Option<Crs>,
}

impl Input<MemoryPoints> {
    /// An input of points in memory, without classes.
    pub fn of_points(points: &[[f64; 3]], crs: Option<Crs>) -> Self {
        let axis = |i: usize| points.iter().map(|p| p[i]).collect();
        let points = PointBatch {
            x: axis(0),
            y: axis(1),
            z: axis(2),
            ..PointBatch::default()
        };
        Input::Memory(Arc::new(MemoryPoints { points, crs }))
    }
}

/// A stream of points that are in memory.
pub(crate) struct MemorySource {
    points: Arc<MemoryPoints>,
    info: PointInfo,
    next: usize,
}

impl MemorySource {
    /// A stream of these points.
    ///
    /// # Errors
    /// If columns differ in length.
    pub(crate) fn new(points: Arc<MemoryPoints>) -> Result<Self> {
        let PointBatch {
            x,
            y,
            z,
            class,
            flags,
            return_number,
            return_count,
            records: _,
        } = &points.points;
        let is_column = |length: usize| length == 0 || length == x.len();
        if y.len() != x.len()
            || z.len() != x.len()
            || !is_column(class.len())
            || !is_column(flags.len())
            || !is_column(return_number.len())
            || !is_column(return_count.len())
        {
            return Err(Error::usage("columns of points differ in length"));
        }
        let info = PointInfo {
            format: "points in memory".to_owned(),
            count: Some(x.len() as u64),
            crs: points.crs.clone(),
            has_classes: !class.is_empty(),
            ..PointInfo::default()
        };
        Ok(MemorySource {
            points,
            info,
            next: 0,
        })
    }
}

impl PointSource for MemorySource {
    fn info(&self) -> &PointInfo {
        &self.info
    }

    fn read(&mut self, batch: &mut PointBatch) -> Result<()> {
        let PointBatch {
            x,
            y,
            z,
            class,
            flags,
            return_number,
            return_count,
            records: _,
        } = &self.points.points;
        let range = self.next..(self.next + BATCH).min(x.len());
        self.next = range.end;
        batch.clear();
        batch.x.extend_from_slice(&x[range.clone()]);
        batch.y.extend_from_slice(&y[range.clone()]);
        batch.z.extend_from_slice(&z[range.clone()]);
        batch
            .class
            .extend_from_slice(class.get(range.clone()).unwrap_or_default());
        batch
            .flags
            .extend_from_slice(flags.get(range.clone()).unwrap_or_default());
        batch
            .return_number
            .extend_from_slice(return_number.get(range.clone()).unwrap_or_default());
        batch
            .return_count
            .extend_from_slice(return_count.get(range).unwrap_or_default());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_in_memory_come_in_batches() {
        let points: Vec<[f64; 3]> = (0..BATCH + 5).map(|i| [i as f64, 1.0, 2.0]).collect();
        let Input::Memory(points) = Input::of_points(&points, None) else {
            unreachable!()
        };
        let mut source = MemorySource::new(points).unwrap();
        let (mut batch, mut sizes) = (PointBatch::default(), Vec::new());
        loop {
            source.read(&mut batch).unwrap();
            sizes.push(batch.len());
            if batch.is_empty() {
                break;
            }
        }
        assert_eq!(sizes, [BATCH, 5, 0]);
    }

    #[test]
    fn columns_of_different_lengths_are_refused() {
        let points = PointBatch {
            x: vec![1.0, 2.0],
            y: vec![1.0, 2.0],
            z: vec![1.0],
            ..PointBatch::default()
        };
        assert!(MemorySource::new(Arc::new(MemoryPoints { points, crs: None })).is_err());
    }
}
