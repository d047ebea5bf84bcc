//! The output of a job as it was written, so that it is not written twice.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use serde_json::{Value, json};

use super::folder::{self, StoredPlan, WRITTEN};
use super::lock::JobLock;
use super::surface::has_all_parts;
use super::{Job, JobReport};
use crate::error::{Error, Result};
use crate::io::{OutputSet, remove_abandoned};
use crate::run::context::Context;
use crate::run::sources::checksum::sum_of_file;
use crate::run::verbs::Keeps;

impl Job {
    /// Records the files that are about to appear. Afterwards
    /// [`has_written`](Self::has_written) recognizes them, also if this process ends between the
    /// two.
    ///
    /// # Errors
    /// If a file cannot be read, or the record cannot be written; or if another process has the
    /// job, because this one was stopped for too long.
    ///
    /// # Complexity
    /// Linear in the bytes of the files.
    pub fn record(&self, outputs: &OutputSet, report: &JobReport, lock: &JobLock) -> Result<()> {
        let mut files = Vec::new();
        outputs.read_back(&mut |path, file| {
            let (length, sum) = sum_of_file(file)?;
            files.push(json!([
                std::path::absolute(path)?.to_string_lossy(),
                length,
                sum
            ]));
            Ok(())
        })?;
        let record = json!({ "job": self.id, "sources": report.sources, "files": files });
        lock.confirm()?;
        folder::replace(&self.folder.join(WRITTEN), &record.to_string())
    }

    /// Returns true if an output is there as it was written from the tasks that are done.
    ///
    /// # Complexity
    /// Linear in the bytes of the output, which is read.
    ///
    /// # Errors
    /// If the run is canceled.
    pub fn has_written(&self, output: &Path, context: &Context) -> Result<bool> {
        let Some(record) = record_of(self.id, &self.folder, output, context)? else {
            return Ok(false);
        };
        let is_of_these = self
            .sources(context)?
            .is_some_and(|sum| record["sources"] == sum);
        let has_parts = || !matches!(self.verb.keeps(), Keeps::Triangles) || has_all_parts(output);
        Ok(is_of_these && has_parts())
    }

    /// Returns what the names of temporary files of outputs contain, for
    /// [`OutputSet::mark`](crate::io::OutputSet::mark): a process that goes on with the job can
    /// then remove those of one that was killed.
    pub fn mark(&self) -> String {
        folder::mark(self.id)
    }

    /// Removes the temporary files that a process left next to an output when it was killed.
    ///
    /// # Errors
    /// If one cannot be removed.
    pub fn remove_abandoned(&self, output: &Path, _lock: &JobLock) -> Result<()> {
        remove_abandoned(output, &self.mark()).map_err(|e: Error| e.in_file(output))
    }
}

/// Returns true if an output is there as the job in a folder has written it, of whatever its tasks
/// were then.
///
/// # Complexity
/// Linear in the bytes of the output, which is read.
///
/// # Errors
/// If the folder has a damaged job, or the run is canceled.
pub(crate) fn is_own_output(folder: &Path, output: &Path, context: &Context) -> Result<bool> {
    match StoredPlan::read(folder)? {
        Some(stored) => Ok(record_of(stored.id, folder, output, context)?.is_some()),
        None => Ok(false),
    }
}

/// Returns what a job has recorded about an output, if that and all files that it was written with
/// are there as they were written.
fn record_of(id: u64, folder: &Path, output: &Path, context: &Context) -> Result<Option<Value>> {
    let record = std::fs::read(folder.join(WRITTEN))
        .ok()
        .and_then(|text| serde_json::from_slice(&text).ok());
    let record: Value = record.unwrap_or_default();
    let files = record["files"]
        .as_array()
        .map(Vec::as_slice)
        .unwrap_or_default();
    let Ok(output) = std::path::absolute(output) else {
        return Ok(None);
    };
    let is_there = |file: &Value| {
        let path = Path::new(file[0].as_str().unwrap_or_default());
        let state = File::open(path).and_then(|file| sum_of_file(&mut Canceled { file, context }));
        state.is_ok_and(|(length, sum)| file[1] == length && file[2] == sum)
    };
    let is_written = record["job"] == id
        && files
            .iter()
            .any(|file| file[0] == output.to_string_lossy().as_ref())
        && files.iter().all(is_there);
    context.check()?;
    Ok(is_written.then_some(record))
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
