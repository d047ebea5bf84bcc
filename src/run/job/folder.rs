//! The folder of a job: which files in it are the job's own, and their removal.

use std::io::{ErrorKind, Read, Write};
use std::path::Path;

use serde_json::Value;

use super::lock::JobLock;
use super::paths::{LOCK, task_of, task_of_lease, tasks_in};
use super::task_file::{is_unfinished, looks_like_task, unfinished_in};
use crate::error::{Command, Error, Result, Setting, wording};
use crate::io::remove_abandoned;
use crate::run::context::Context;
use crate::run::sources::checksum::checksum;

/// The file of the plan in the folder of a job.
const PLAN: &str = "plan.json";

/// The file that has what the job was planned for, if that was kept; it is removed with the job.
pub(super) const COMMAND: &str = "command.json";

/// The file that has it once the inputs have changed, until the plan is there that goes with it.
pub(super) const NEXT_COMMAND: &str = "command.next.json";

/// The file that says which files were written as the output.
pub(super) const WRITTEN: &str = "output.json";

/// The plan of a job as it is in its folder.
#[derive(Debug)]
pub(super) struct StoredPlan {
    /// The checksum of the plan.
    pub(super) sum: u32,
    /// What the files of the tasks name the job by: it stays when the job is planned again because
    /// its inputs have changed, unless its tiles are chosen again.
    pub(super) id: u64,
    /// What the record of its outputs and temporary files name the job by: it stays as long as the
    /// job does.
    pub(super) name: u64,
    pub(super) plan: Value,
    /// The number of tasks.
    pub(super) tasks: u64,
    /// The numbers of all files of tasks are below this: an earlier plan may have had more, and an
    /// update that was interrupted has left files beyond the last.
    pub(super) numbers: u64,
    /// The checksum of the command that is kept with the job, if there is one.
    pub(super) command: Option<u64>,
}

impl StoredPlan {
    /// Reads the plan in a folder; `None` if there is none.
    ///
    /// # Errors
    /// If the file is not the plan of a job, or is damaged.
    pub(super) fn read(folder: &Path) -> Result<Option<Self>> {
        let path = folder.join(PLAN);
        let text = match std::fs::read(&path) {
            Ok(text) => text,
            Err(error)
                if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) =>
            {
                return Ok(None);
            }
            Err(error) => return Err(Error::from(error).in_file(path)),
        };
        // The folder may be that of somebody else: only what is certain to be a job may go.
        Self::parse(&text).map(Some).ok_or_else(|| {
            let by_hand = match has_tasks(folder) {
                true => {
                    "; what is left of an earlier job here, which an older version planned or whose plan was \
                     damaged, you have to delete by hand: plan.json and tasks/*.task"
                }
                false => "",
            };
            Error::format("this is not the plan of a job, or it is damaged").in_file(path).cure(wording![
                "name another folder (",
                Setting::Job,
                ")",
                by_hand
            ])
        })
    }

    /// Reads the plan that has this checksum.
    ///
    /// # Errors
    /// If it is not in the folder any more.
    pub(super) fn read_of(sum: u32, folder: &Path) -> Result<Self> {
        Self::read(folder)?
            .filter(|stored| stored.sum == sum)
            .ok_or_else(|| replaced(folder))
    }

    fn parse(text: &[u8]) -> Option<Self> {
        let (stated, plan) = std::str::from_utf8(text).ok()?.split_once('\n')?;
        let sum = checksum(plan.as_bytes());
        let value: Value = serde_json::from_str(plan)
            .ok()
            .filter(|_| stated == format!("{sum:08x}"))?;
        let is_plan = value["version"].is_string() && value["request"].is_object();
        let tasks = value["tasks"]
            .as_u64()
            .filter(|_| is_plan && value["layout"].is_array())?;
        // Plans of other versions can be removed, whatever they have.
        let id = value["id"].as_u64().unwrap_or(u64::from(sum));
        let command = value["command"].as_u64();
        Some(StoredPlan {
            sum,
            id,
            name: value["name"].as_u64().unwrap_or(id),
            tasks,
            numbers: value["numbers"].as_u64().unwrap_or(tasks),
            plan: value,
            command,
        })
    }
}

/// Returns an error unless the plan in a folder is the one with this checksum, which is all that is
/// read.
///
/// # Errors
/// If it is not in the folder any more.
pub(super) fn require_plan(sum: u32, folder: &Path) -> Result<()> {
    let path = folder.join(PLAN);
    let stated = format!("{sum:08x}\n");
    let mut begin = vec![0; stated.len()];
    let read = std::fs::File::open(&path).and_then(|mut file| file.read_exact(&mut begin));
    match read {
        Ok(()) if begin == stated.as_bytes() => Ok(()),
        Err(error)
            if !matches!(
                error.kind(),
                ErrorKind::NotFound | ErrorKind::NotADirectory | ErrorKind::UnexpectedEof
            ) =>
        {
            Err(Error::from(error).in_file(path))
        }
        _ => Err(replaced(folder)),
    }
}

/// Writes a plan into a folder that has none, and returns its checksum.
///
/// # Errors
/// If there is a plan already, or it cannot be written.
pub(super) fn write_plan(folder: &Path, plan: &str) -> Result<u32> {
    let path = folder.join(PLAN);
    let named = |e: std::io::Error| Error::from(e).in_file(&path);
    let sum = checksum(plan.as_bytes());
    let mut file = unfinished_in(folder).map_err(named)?;
    write!(file, "{sum:08x}\n{plan}").map_err(named)?;
    match file.persist_noclobber(&path) {
        Ok(_) => Ok(sum),
        Err(_) if path.exists() => Err(there_is_a_job(folder)),
        // Some shared file systems can only replace files. The job is locked, and there is no plan.
        Err(error) => error
            .file
            .persist(&path)
            .map(|_| sum)
            .map_err(|e| named(e.error)),
    }
}

/// Writes a plan in the place of another one, and returns its checksum.
///
/// # Errors
/// If it cannot be written.
pub(super) fn replace_plan(folder: &Path, plan: &str) -> Result<u32> {
    let sum = checksum(plan.as_bytes());
    replace(&folder.join(PLAN), &format!("{sum:08x}\n{plan}")).map(|()| sum)
}

/// Writes a file of the job, in the place of an older one.
///
/// # Errors
/// If it cannot be written.
pub(super) fn replace(path: &Path, text: &str) -> Result<()> {
    let named = |e: std::io::Error| Error::from(e).in_file(path);
    let mut file = unfinished_in(path.parent().unwrap_or(Path::new("."))).map_err(named)?;
    file.write_all(text.as_bytes()).map_err(named)?;
    file.persist(path).map(drop).map_err(|e| named(e.error))
}

#[cold]
fn there_is_a_job(folder: &Path) -> Error {
    Error::usage("there is a job in this folder already")
        .in_file(folder)
        .cure(wording![
            "go on with it (",
            Setting::Resume.on(),
            "), remove it (",
            Command::JobClean.on(folder.display().to_string()),
            "), or name another folder (",
            Setting::Job,
            ")"
        ])
}

/// Returns an error if the folder of a new job has a file that the job would replace.
///
/// # Errors
/// If there is a job, or the plan, the command or the output of something else.
pub(crate) fn require_no_job(folder: &Path) -> Result<()> {
    if StoredPlan::read(folder)?.is_some() {
        return Err(there_is_a_job(folder));
    }
    for name in [COMMAND, NEXT_COMMAND, WRITTEN] {
        let path = folder.join(name);
        if path.exists() && !is_note(&path) {
            return Err(Error::usage("this was not written by a job")
                .in_file(path)
                .cure(wording!["name another folder (", Setting::Job, ")"]));
        }
    }
    Ok(())
}

/// Returns true if a file has what a job was planned for, or the record of an output.
fn is_note(path: &Path) -> bool {
    let value: Option<Value> = std::fs::read(path)
        .ok()
        .and_then(|text| serde_json::from_slice(&text).ok());
    value.is_some_and(|value| {
        value["request"].is_object() && value["words"].is_array()
            || value["files"].is_array() && value["job"].is_u64()
    })
}

/// Returns true if a folder has a file that the task of a job has written, of whatever version.
fn has_tasks(folder: &Path) -> bool {
    let files = std::fs::read_dir(tasks_in(folder))
        .into_iter()
        .flatten()
        .flatten()
        .map(|entry| entry.path());
    files
        .filter(|path| task_of(path).is_some())
        .any(|path| looks_like_task(&path))
}

/// Returns what the names of temporary files contain that are written for the job with this name.
pub(super) fn mark(name: u64) -> String {
    format!("{name:016x}")
}

/// Removes the files that a process left when it was killed. Folders stay: they become outputs, of
/// this job or another.
///
/// # Errors
/// If one cannot be removed.
pub(super) fn remove_unfinished(folder: &Path) -> Result<()> {
    for folder in [folder, &tasks_in(folder)]
        .into_iter()
        .filter(|folder| folder.is_dir())
    {
        remove_where(folder, is_unfinished)?;
    }
    Ok(())
}

/// Removes those files in a folder whose paths are as is asked for.
fn remove_where(folder: &Path, is_meant: impl Fn(&Path) -> bool) -> Result<()> {
    let named = |e: std::io::Error| Error::from(e).in_file(folder);
    for entry in std::fs::read_dir(folder).map_err(named)? {
        let entry = entry.map_err(named)?;
        let path = entry.path();
        if is_meant(&path) && !entry.file_type().map_err(named)?.is_dir() {
            remove(&path)?;
        }
    }
    Ok(())
}

#[cold]
pub(super) fn no_job(folder: &Path) -> Error {
    Error::usage("there is no job in this folder").in_file(folder)
}

/// Returns the error for a folder that had another job before.
#[cold]
pub(super) fn replaced(folder: &Path) -> Error {
    Error::other_job("the job was removed or replaced by another process")
        .in_file(folder)
        .cure(wording![
            "begin again, or name another folder (",
            Setting::Job,
            ")"
        ])
}

/// Removes the files of a job and its folder, if nothing else is in it.
///
/// # Errors
/// If the folder has no job, or the job cannot be removed, or the run is canceled.
pub fn remove_job(folder: &Path, context: &Context) -> Result<()> {
    let found = StoredPlan::read(folder)?.ok_or_else(|| no_job(folder))?;
    let lock = JobLock::whole(folder, found.tasks as usize, context)?;
    let stored = StoredPlan::read(folder)?.ok_or_else(|| no_job(folder))?;
    remove_files(folder, &stored, &lock)
}

/// Like [`remove_job`], for the job whose plan has this checksum.
///
/// # Errors
/// Also if the folder has another job.
pub(super) fn remove_job_of(sum: u32, folder: &Path, context: &Context) -> Result<()> {
    let found = StoredPlan::read_of(sum, folder)?;
    let lock = JobLock::whole(folder, found.tasks as usize, context)?;
    remove_files(folder, &StoredPlan::read_of(sum, folder)?, &lock)
}

/// Removes the files of a job, by their names, and its folder, if nothing else is in it.
pub(super) fn remove_files(folder: &Path, stored: &StoredPlan, _lock: &JobLock) -> Result<()> {
    remove_unfinished(folder)?;
    let tasks = tasks_in(folder);
    if tasks.is_dir() {
        remove_where(&tasks, |path| {
            task_of(path).is_some_and(|task| (task as u64) < stored.numbers)
                || task_of_lease(path).is_some_and(|task| task as u64 <= stored.numbers)
        })?;
        remove_if_empty(&tasks)?;
    }
    // Of an output in the folder itself.
    remove_abandoned(&folder.join(PLAN), &mark(stored.name))?;
    let notes = [
        (COMMAND, stored.command.is_some()),
        (NEXT_COMMAND, false),
        (WRITTEN, false),
    ];
    for (name, is_own) in notes {
        let path = folder.join(name);
        // The plan says that there was a command, which may be damaged.
        if is_own || is_note(&path) {
            remove(&path)?;
        }
    }
    // Late, so that a removal that was interrupted can be repeated.
    remove(&folder.join(PLAN))?;
    let lock = folder.join(LOCK);
    if std::fs::metadata(&lock).is_ok_and(|about| about.is_file() && about.len() == 0) {
        remove(&lock)?;
    }
    remove_if_empty(folder)
}

/// Removes a file, which may be gone already.
fn remove(path: &Path) -> Result<()> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(Error::from(error).in_file(path)),
        _ => Ok(()),
    }
}

/// Removes a folder, unless something is in it.
fn remove_if_empty(folder: &Path) -> Result<()> {
    let named = |e: std::io::Error| Error::from(e).in_file(folder);
    let is_empty = std::fs::read_dir(folder).map_err(named)?.next().is_none();
    if is_empty {
        std::fs::remove_dir(folder).map_err(named)
    } else {
        Ok(())
    }
}
