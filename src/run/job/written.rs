//! The output of a job as it was written, so that it is not written twice.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::folder::{self, StoredPlan, WRITTEN};
use super::lock::JobLock;
use super::surface::has_all_parts;
use super::{Job, JobReport};
use crate::error::{Error, Result};
use crate::io::formats::Product;
use crate::io::{OutputSet, remove_abandoned};
use crate::run::context::Context;
use crate::run::sources::checksum::sum_of_file;

/// What a job has recorded of its outputs.
#[derive(Debug, Serialize, Deserialize)]
struct Record {
    /// What names the job.
    job: u64,
    /// The checksum of what they were made from.
    sources: u32,
    files: Vec<WrittenFile>,
    /// The files that they replace: those are there until the outputs get their names.
    #[serde(default)]
    before: OwnFiles,
}

/// A file as it was written: its whole name, its length, and its checksum.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct WrittenFile(String, u64, u32);

impl WrittenFile {
    /// Returns true if the file is there as it was written.
    fn is_there(&self, context: &Context) -> bool {
        let WrittenFile(path, length, sum) = self;
        let state = File::open(path).and_then(|file| sum_of_file(&mut Canceled { file, context }));
        state.is_ok_and(|found| found == (*length, *sum))
    }
}

/// Files that are there as a job has written them, which it may replace.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct OwnFiles(Vec<WrittenFile>);

impl OwnFiles {
    /// Returns the files that the job in a folder has written, also by an earlier plan; none if
    /// there is no job.
    ///
    /// # Complexity
    /// Linear in the bytes of the files, which are read.
    ///
    /// # Errors
    /// If the folder has a damaged job, or the run is canceled.
    pub(crate) fn of_job(folder: &Path, context: &Context) -> Result<Self> {
        let stored = StoredPlan::read(folder)?;
        let record = stored.and_then(|stored| record_of(stored.name, folder));
        let Some(Record {
            mut files, before, ..
        }) = record
        else {
            return Ok(OwnFiles::default());
        };
        files.extend(before.0);
        OwnFiles(files).still_there(context)
    }

    /// Returns those that are still there as they were written.
    ///
    /// # Complexity
    /// Linear in the bytes of the files, which are read.
    ///
    /// # Errors
    /// If the run is canceled.
    pub(crate) fn still_there(mut self, context: &Context) -> Result<Self> {
        self.0.retain(|file| file.is_there(context));
        context.check()?;
        Ok(self)
    }

    /// Returns true if a file is one of them.
    pub(crate) fn has(&self, path: &Path) -> bool {
        has(&self.0, path)
    }
}

/// Returns true if a file is among others, which have whole names.
fn has(files: &[WrittenFile], path: &Path) -> bool {
    std::path::absolute(path).is_ok_and(|path| {
        let path = path.to_string_lossy();
        files.iter().any(|WrittenFile(own, ..)| *own == path)
    })
}

impl Job {
    /// Records the files that are about to appear, and those that they replace. Afterwards
    /// [`has_written`](Self::has_written) recognizes the former, also if this process ends between
    /// the two; and the latter stay the job's own.
    ///
    /// # Errors
    /// If a file cannot be read, or the record cannot be written; or if another process has the
    /// job, because this one was stopped for too long.
    ///
    /// # Complexity
    /// Linear in the bytes of the files.
    pub(crate) fn record(
        &self,
        outputs: &OutputSet,
        report: &JobReport,
        before: OwnFiles,
        lock: &JobLock,
    ) -> Result<()> {
        let mut files = Vec::new();
        outputs.read_back(&mut |path, file| {
            let (length, sum) = sum_of_file(file)?;
            let path = std::path::absolute(path)?;
            files.push(WrittenFile(path.to_string_lossy().into(), length, sum));
            Ok(())
        })?;
        let record = Record {
            job: self.name,
            sources: report.sources,
            files,
            before,
        };
        let text = serde_json::to_string(&record).map_err(std::io::Error::from)?;
        lock.confirm()?;
        folder::replace(&self.folder.join(WRITTEN), &text)
    }

    /// Returns true if outputs are there as they were written from the tasks that are done.
    ///
    /// # Complexity
    /// Linear in the bytes of the outputs, which are read.
    ///
    /// # Errors
    /// If the run is canceled.
    pub fn has_written(&self, outputs: &[PathBuf], context: &Context) -> Result<bool> {
        let Some(record) = record_of(self.name, &self.folder) else {
            return Ok(false);
        };
        // Before the outputs are read: of the files of tasks, only the ends are.
        let is_of_these = outputs.iter().all(|output| has(&record.files, output))
            && self.sources(context)? == Some(record.sources);
        if !is_of_these {
            return Ok(false);
        }
        let has_parts = || {
            self.verb.product() != Product::Surface
                || outputs.iter().all(|output| has_all_parts(output))
        };
        let is_written = record.files.iter().all(|file| file.is_there(context));
        context.check()?;
        Ok(is_written && has_parts())
    }

    /// Returns what the names of temporary files of outputs contain, for
    /// [`OutputSet::mark`](crate::io::OutputSet::mark): a process that goes on with the job can
    /// then remove those of one that was killed.
    pub fn mark(&self) -> String {
        folder::mark(self.name)
    }

    /// Removes the temporary files that a process left next to an output when it was killed.
    ///
    /// # Errors
    /// If one cannot be removed.
    pub fn remove_abandoned(&self, output: &Path, _lock: &JobLock) -> Result<()> {
        remove_abandoned(output, &self.mark()).map_err(|e: Error| e.in_file(output))
    }
}

/// Returns what the job of this name has recorded in its folder; `None` if nothing is there, or
/// what is there is that of another job.
fn record_of(job: u64, folder: &Path) -> Option<Record> {
    let text = std::fs::read(folder.join(WRITTEN)).ok()?;
    let record: Record = serde_json::from_slice(&text).ok()?;
    (record.job == job).then_some(record)
}

/// A file that cannot be read on once the run is canceled.
struct Canceled<'a> {
    file: File,
    context: &'a Context<'a>,
}

impl Read for Canceled<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        self.context.check().map_err(std::io::Error::other)?;
        self.file.read(bytes)
    }
}
