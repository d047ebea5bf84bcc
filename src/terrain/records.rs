//! Records in the order of their keys; memory need not have room for all of them.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::fs::File;
use std::io::{BufWriter, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use crate::error::{Error, Result};
use crate::terrain::in_order::by_coordinates;

/// The bytes of the records that are sorted in memory.
const RUN_BYTES: usize = 32 << 20;

/// The number of records that are read at a time of each run.
const AT_A_TIME: u64 = 1 << 12;

/// One of so many records has its key in memory.
const STRIDE: u64 = 1 << 8;

/// A key, and numbers.
pub(super) type Record<const N: usize> = (u64, [f64; N]);

/// The order of records: by their keys, then by their numbers.
fn order<const N: usize>((a, p): &Record<N>, (b, q): &Record<N>) -> Ordering {
    a.cmp(b).then_with(|| by_coordinates(p, q))
}

/// Records in a file without a name, which vanishes with it.
pub(super) struct RecordFile<const N: usize> {
    folder: PathBuf,
    file: Mutex<BufWriter<File>>,
    count: u64,
}

impl<const N: usize> RecordFile<N> {
    const BYTES: usize = 8 * (N + 1);

    /// Creates an empty file.
    ///
    /// # Errors
    /// If it cannot be created; the error names the folder.
    pub(super) fn create(folder: &Path) -> Result<Self> {
        let file = tempfile::tempfile_in(folder).map_err(|e| in_folder(e, folder))?;
        Ok(RecordFile {
            folder: folder.to_path_buf(),
            file: Mutex::new(BufWriter::with_capacity(1 << 17, file)),
            count: 0,
        })
    }

    /// The number of records.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// Adds a record at the end. None is added once records were read.
    ///
    /// # Errors
    /// If it cannot be written.
    pub(super) fn add(&mut self, (key, numbers): &Record<N>) -> Result<()> {
        let file = self.file.get_mut().unwrap_or_else(PoisonError::into_inner);
        let mut write = || {
            file.write_all(&key.to_le_bytes())?;
            let mut bytes = numbers.iter().map(|number| number.to_le_bytes());
            bytes.try_for_each(|bytes| file.write_all(&bytes))
        };
        write().map_err(|e| in_folder(e, &self.folder))?;
        self.count += 1;
        Ok(())
    }

    /// Replaces the records of a list by those at these positions.
    ///
    /// # Errors
    /// If they cannot be read.
    pub(super) fn read(&self, range: Range<u64>, records: &mut Vec<Record<N>>) -> Result<()> {
        records.clear();
        let length = range.end.saturating_sub(range.start) as usize;
        let mut bytes = vec![0; length * Self::BYTES];
        let mut read = || {
            let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            // Writes what is left first.
            file.seek(SeekFrom::Start(range.start * Self::BYTES as u64))?;
            file.get_mut().read_exact(&mut bytes)
        };
        read().map_err(|e| in_folder(e, &self.folder))?;
        records.extend(bytes.chunks_exact(Self::BYTES).map(|bytes| {
            let (words, _) = bytes.as_chunks();
            let numbers = std::array::from_fn(|k| f64::from_le_bytes(words[k + 1]));
            (u64::from_le_bytes(words[0]), numbers)
        }));
        Ok(())
    }
}

#[cold]
fn in_folder(error: std::io::Error, folder: &Path) -> Error {
    Error::from(error)
        .in_file(folder)
        .cure("make room there: it has what does not fit into memory")
}

/// Sorts records, in files if they are many.
pub(super) struct Sorter<const N: usize> {
    folder: PathBuf,
    /// Those that are in no run yet.
    open: Vec<Record<N>>,
    /// The sorted runs, one after the other, with the positions of each.
    written: Option<RecordFile<N>>,
    runs: Vec<Range<u64>>,
    run_length: usize,
}

impl<const N: usize> Sorter<N> {
    /// Creates one without records. Files without a name are created in `folder`.
    pub(super) fn new(folder: &Path) -> Self {
        Self::with_runs(folder, RUN_BYTES / RecordFile::<N>::BYTES)
    }

    /// Like [`new`](Self::new), with so many records in memory.
    pub(super) fn with_runs(folder: &Path, run_length: usize) -> Self {
        Sorter {
            folder: folder.to_path_buf(),
            open: Vec::new(),
            written: None,
            runs: Vec::new(),
            run_length,
        }
    }

    /// Adds records.
    ///
    /// # Errors
    /// If a run cannot be written.
    pub(super) fn extend(&mut self, records: impl IntoIterator<Item = Record<N>>) -> Result<()> {
        for record in records {
            self.open.push(record);
            if self.open.len() >= self.run_length {
                self.end_run()?;
            }
        }
        Ok(())
    }

    fn end_run(&mut self) -> Result<()> {
        self.open.par_sort_unstable_by(order);
        let written = match &mut self.written {
            Some(written) => written,
            None => self.written.insert(RecordFile::create(&self.folder)?),
        };
        let start = written.count();
        self.open
            .iter()
            .try_for_each(|record| written.add(record))?;
        self.runs.push(start..written.count());
        self.open.clear();
        Ok(())
    }

    /// Like [`finish`](Self::finish), but equal records are passed on once.
    ///
    /// # Errors
    /// Those of [`finish`](Self::finish).
    pub(super) fn finish_once(self, take: &mut dyn FnMut(Record<N>) -> Result<()>) -> Result<()> {
        let mut before = None;
        self.finish(&mut |record| match before.replace(record) == Some(record) {
            true => Ok(()),
            false => take(record),
        })
    }

    /// Passes on all records in their order.
    ///
    /// # Errors
    /// Those of `take`, and if a run cannot be read.
    ///
    /// # Complexity
    /// O(n log n). Memory: 4096 records for each run.
    pub(super) fn finish(mut self, take: &mut dyn FnMut(Record<N>) -> Result<()>) -> Result<()> {
        self.open.par_sort_unstable_by(order);
        let open = Run {
            next: 0,
            read: std::mem::take(&mut self.open),
            left: 0..0,
        };
        let Some(written) = &self.written else {
            return open.read.into_iter().try_for_each(take);
        };
        let of_file = |left: Range<u64>| Run {
            next: 0,
            read: Vec::new(),
            left,
        };
        let mut runs: Vec<Run<N>> = self.runs.into_iter().map(of_file).collect();
        runs.push(open);
        let mut heads = BinaryHeap::new();
        for (run, from) in runs.iter_mut().zip(0..) {
            heads.extend(run.take(written)?.map(|record| Head { record, from }));
        }
        while let Some(Head { record, from }) = heads.pop() {
            take(record)?;
            let next = runs[from].take(written)?;
            heads.extend(next.map(|record| Head { record, from }));
        }
        Ok(())
    }
}

/// A sorted run that is read in parts.
struct Run<const N: usize> {
    read: Vec<Record<N>>,
    /// The position of the next one that was read.
    next: usize,
    /// The positions of those that were not.
    left: Range<u64>,
}

impl<const N: usize> Run<N> {
    fn take(&mut self, file: &RecordFile<N>) -> Result<Option<Record<N>>> {
        if self.next == self.read.len() && !self.left.is_empty() {
            let end = self.left.end.min(self.left.start + AT_A_TIME);
            file.read(self.left.start..end, &mut self.read)?;
            (self.left.start, self.next) = (end, 0);
        }
        self.next += 1;
        Ok(self.read.get(self.next - 1).copied())
    }
}

/// The first record of a run that was not passed on.
struct Head<const N: usize> {
    record: Record<N>,
    from: usize,
}

/// The largest is the record that comes first.
impl<const N: usize> Ord for Head<N> {
    fn cmp(&self, other: &Self) -> Ordering {
        order(&other.record, &self.record)
    }
}

impl<const N: usize> PartialOrd for Head<N> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<const N: usize> PartialEq for Head<N> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<const N: usize> Eq for Head<N> {}

/// Sorted records that are found by their keys and their first numbers.
pub(super) struct SortedRecords<const N: usize> {
    file: RecordFile<N>,
    /// The key and the first number of each 256th record.
    index: Vec<(u64, f64)>,
}

impl<const N: usize> SortedRecords<N> {
    /// Sorts records into a file. Equal ones are kept once.
    ///
    /// # Errors
    /// Those of [`Sorter::finish`].
    pub(super) fn of(sorter: Sorter<N>) -> Result<Self> {
        let mut file = RecordFile::create(&sorter.folder)?;
        let mut index = Vec::new();
        sorter.finish_once(&mut |record| {
            if file.count().is_multiple_of(STRIDE) {
                index.push((record.0, record.1[0]));
            }
            file.add(&record)
        })?;
        Ok(SortedRecords { file, index })
    }

    /// Returns the records from the first key and number to the last, which are in it, too.
    ///
    /// # Errors
    /// If they cannot be read.
    ///
    /// # Complexity
    /// O(log n), and linear in what is returned.
    pub(super) fn between(&self, first: (u64, f64), last: (u64, f64)) -> Result<Vec<Record<N>>> {
        let is_before =
            |a: &(u64, f64), b: &(u64, f64)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).is_lt();
        let start = self.index.partition_point(|at| is_before(at, &first));
        let end = self.index.partition_point(|at| !is_before(&last, at));
        let start = (start as u64).saturating_sub(1) * STRIDE;
        let end = (end as u64 * STRIDE).min(self.file.count());
        let mut records = Vec::new();
        if start < end {
            self.file.read(start..end, &mut records)?;
        }
        let at = |record: &Record<N>| (record.0, record.1[0]);
        records.retain(|record| !is_before(&at(record), &first) && !is_before(&last, &at(record)));
        Ok(records)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::random::Random;

    #[test]
    fn records_are_sorted_in_files_as_in_memory() {
        let folder = tempfile::tempdir().unwrap();
        let mut random = Random(3);
        for (count, run) in [(0, 4), (3, 4), (4, 4), (5000, 7), (20_000, 9000)] {
            let mut all: Vec<Record<2>> = (0..count)
                .map(|_| {
                    let number = |random: &mut Random| random.below(9) as f64 - 4.0;
                    let numbers = [number(&mut random), number(&mut random)];
                    (random.below(50), numbers)
                })
                .collect();
            let mut sorter = Sorter::with_runs(folder.path(), run);
            sorter.extend(all.iter().copied()).unwrap();
            let mut sorted = Vec::new();
            sorter
                .finish(&mut |record| {
                    sorted.push(record);
                    Ok(())
                })
                .unwrap();
            all.sort_unstable_by(order);
            assert_eq!(sorted, all);

            let mut sorter = Sorter::with_runs(folder.path(), run);
            sorter.extend(all.iter().copied()).unwrap();
            let records = SortedRecords::of(sorter).unwrap();
            all.dedup();
            for _ in 0..50 {
                let mut end = || (random.below(52), random.below(11) as f64 - 5.0);
                let [first, last] = [end(), end()];
                let expected: Vec<Record<2>> = all
                    .iter()
                    .filter(|(key, [number, _])| {
                        (*key, *number) >= first && (*key, *number) <= last
                    })
                    .copied()
                    .collect();
                assert_eq!(records.between(first, last).unwrap(), expected);
            }
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
