//! Which tasks are done: by their own files, and by those that they were made from.

use std::cell::RefCell;
use std::collections::BTreeMap;

use flate2::Crc;
use rustc_hash::FxHashMap;

use super::folder::remove_unfinished;
use super::lock::JobLock;
use super::paths::tasks_in;
use super::task_file::{Found, TaskFile};
use super::{FileState, Job, lines};
use crate::error::{Error, Kind, Result};
use crate::run::context::Context;

/// The files of other tasks, for a task that reads them.
pub(super) struct Sources<'j> {
    job: &'j Job,
    /// The tile that the task triangulates, if it does.
    tile: Option<u32>,
    /// The checksums of what it takes from those that were opened, by the numbers of their tasks.
    sums: RefCell<BTreeMap<usize, u32>>,
}

impl<'j> Sources<'j> {
    /// The files of other tasks, for a task.
    pub(super) fn new(job: &'j Job, task: usize) -> Self {
        Sources {
            job,
            tile: job.tile_of(task),
            sums: RefCell::default(),
        }
    }

    /// Opens the file of a task that is done.
    ///
    /// # Errors
    /// If it is missing, damaged, or that of another job or task, or if it has changed since it was
    /// opened before.
    pub(super) fn open(&self, task: usize) -> Result<TaskFile> {
        let mut file = self.job.open_task(task)?;
        let sum = match self.tile {
            Some(tile) if self.job.lines_task() == Some(task) => {
                lines::sum_of_tile(&mut file, tile)?
            }
            _ => file.sum,
        };
        match self.sums.borrow_mut().insert(task, sum) {
            Some(before) if before != sum => Err(Error::not_yet(
                "the file of a task was made again while another one read it",
            )
            .in_file(self.job.task_file(task).path)
            .cure("do it again")),
            _ => Ok(file),
        }
    }

    /// Returns the checksum of what a task was made from that needs these tasks.
    pub(super) fn sum(&self, needed: Vec<usize>) -> Result<u32> {
        for task in needed {
            if !self.sums.borrow().contains_key(&task) {
                self.open(task)?;
            }
        }
        Ok(sum_of(self.sums.borrow().values().copied()))
    }
}

/// Returns the checksum of what a task was made from: checksums of what it takes from the files of
/// others, in the order of their tasks. The numbers of these tasks do not count, because they shift
/// once inputs come or go. The key of a task says which files it reads.
fn sum_of(sources: impl Iterator<Item = u32>) -> u32 {
    let mut all = Crc::new();
    for sum in sources {
        all.update(&sum.to_le_bytes());
    }
    all.sum()
}

/// The checksums of the files of tasks that are done, from the first on.
#[derive(Default)]
struct Sums {
    /// `None` for those that are not done.
    files: Vec<Option<u32>>,
    /// What lines give to tiles.
    of_lines: FxHashMap<u32, u32>,
}

impl Sums {
    /// Adds the file of the next task, and returns it, if it was made from those that were added
    /// before; else the task counts as not done.
    fn add(&mut self, job: &Job, mut file: Option<TaskFile>) -> Option<TaskFile> {
        let task = self.files.len();
        let sources = self.sources_of(job, task);
        file = file.filter(|file| sources == Some(file.sources));
        if job.lines_task() == Some(task) {
            match file.as_mut().map(lines::sums_of_tiles) {
                Some(Ok(of_lines)) => self.of_lines = of_lines,
                _ => file = None,
            }
        }
        self.files.push(file.as_ref().map(|file| file.sum));
        file
    }

    /// Returns the checksum of what a task would be made from now; `None` if something is missing.
    fn sources_of(&self, job: &Job, task: usize) -> Option<u32> {
        let tile = job.tile_of(task);
        let mut needed = job.needs(task);
        needed.sort_unstable();
        let sum = |&needed: &usize| {
            let of_file = self.files[needed]?;
            match tile {
                Some(tile) if job.lines_task() == Some(needed) => {
                    Some(self.of_lines.get(&tile).copied().unwrap_or_default())
                }
                _ => Some(of_file),
            }
        };
        let sources: Option<Vec<u32>> = needed.iter().map(sum).collect();
        sources.map(|sources| sum_of(sources.into_iter()))
    }
}

impl Job {
    /// Opens the file of a task that is done.
    ///
    /// # Errors
    /// If it is missing, damaged, or that of another job or task.
    pub(super) fn open_task(&self, task: usize) -> Result<TaskFile> {
        TaskFile::open_done(&self.task_file(task))
    }

    /// Returns which tasks are done: the file of the task is there, and complete, and so are those
    /// that it was made from, which have not been made anew since.
    ///
    /// # Errors
    /// If the run is canceled.
    pub fn done(&self, context: &Context) -> Result<Vec<bool>> {
        Ok(self.sums(context)?.iter().map(Option::is_some).collect())
    }

    /// Returns the checksum of what an output would be made from now; `None` if a task is not done.
    pub(super) fn sources(&self, context: &Context) -> Result<Option<u32>> {
        let sums: Option<Vec<u32>> = self.sums(context)?.into_iter().collect();
        Ok(sums.map(|sums| sum_of(sums.into_iter())))
    }

    /// Opens the files of all tasks, for an output. Returns also the checksum of what it is made
    /// from.
    ///
    /// # Errors
    /// If a task is not done, or its file is damaged, or that of another job or task.
    pub(super) fn open_all(&self, mut take: impl FnMut(TaskFile)) -> Result<u32> {
        let mut sums = Sums::default();
        for task in 0..self.task_count() {
            let file = sums.add(self, Some(self.open_task(task)?));
            take(file.ok_or_else(|| self.why_not_done(task))?);
        }
        Ok(sum_of(sums.files.into_iter().flatten()))
    }

    /// Returns the checksum of the file of each task that is done.
    fn sums(&self, context: &Context) -> Result<Vec<Option<u32>>> {
        let mut sums = Sums::default();
        for task in 0..self.task_count() {
            context.check()?;
            sums.add(self, TaskFile::open(&self.task_file(task)).ok().flatten());
        }
        Ok(sums.files)
    }

    /// Returns the file of a task if it was made from the files that are there now. What is
    /// damaged, or belongs to another task, is replaced.
    fn current_file(&self, task: usize) -> Result<Option<TaskFile>> {
        let Ok(Some(file)) = TaskFile::open(&self.task_file(task)) else {
            return Ok(None);
        };
        let is_of_these = Sources::new(self, task).sum(self.needs(task))? == file.sources;
        Ok(Some(file).filter(|_| is_of_these))
    }

    /// Returns true if the file of a task is there, and was made from the files that are there now.
    /// It is not read to its begin: who needs it finds out whether it is damaged.
    pub(super) fn has_current_file(&self, task: usize) -> Result<bool> {
        Ok(self.current_file(task)?.is_some())
    }

    /// Like [`has_current_file`](Self::has_current_file), for a file that is read.
    fn is_current(&self, task: usize) -> Result<bool> {
        Ok(self
            .current_file(task)?
            .is_some_and(|mut file| file.verify().is_ok()))
    }

    /// Returns the state in which a task has read its file of points; `None` if it is not done, or
    /// reads none.
    pub(super) fn state_of_input(&self, task: usize) -> Option<FileState> {
        TaskFile::open(&self.task_file(task))
            .ok()??
            .state_of_input()
    }

    /// Returns an error unless all tasks are done; `last` is the number of the one that writes the
    /// output.
    ///
    /// # Errors
    /// Names a task that is not done, or a file of a task that is damaged or another's, or says
    /// that there is no task with this number.
    pub fn require_done(&self, last: usize, context: &Context) -> Result<()> {
        if last > self.task_count() {
            return Err(self.no_task(last));
        }
        match self.done(context)?.iter().position(|is_done| !is_done) {
            Some(task) => Err(self.why_not_done(task)),
            None => Ok(()),
        }
    }

    /// Returns why a task does not count as done.
    #[cold]
    pub(super) fn why_not_done(&self, task: usize) -> Error {
        let name = self.task_name(task);
        match TaskFile::open(&self.task_file(task)) {
            Err(error) => error,
            Ok(None) => {
                Error::not_yet(format!("task {task} ({name}) is not done")).cure("do it first")
            }
            Ok(Some(_)) => Error::not_yet(format!(
                "task {task} ({name}) is not done: what it was made from was made again"
            ))
            .cure("do it again"),
        }
    }

    #[cold]
    pub(super) fn no_task(&self, task: usize) -> Error {
        Error::usage(format!(
            "there is no task {task}: the last is {}, which writes the output",
            self.task_count()
        ))
    }

    /// Removes files that a run left when it was killed, and files of tasks that are damaged.
    /// Returns the number of tasks whose files are whole. The job must be [locked](Self::lock).
    ///
    /// # Errors
    /// If a file cannot be removed, or the run is canceled.
    pub fn clear_up(&self, _lock: &JobLock, context: &Context) -> Result<usize> {
        let tasks = tasks_in(&self.folder);
        // An interrupted removal may have taken it.
        std::fs::create_dir_all(&tasks).map_err(|e| Error::from(e).in_file(&tasks))?;
        remove_unfinished(&self.folder)?;
        self.remove_damaged(context)
    }

    /// Removes the files of tasks that are damaged, by their checksums. Returns the number of tasks
    /// whose files are whole. A file of another job, or of another task, stays until the task is
    /// done.
    ///
    /// # Errors
    /// If a file cannot be read or removed, or the run is canceled.
    pub fn remove_damaged(&self, context: &Context) -> Result<usize> {
        let mut whole = 0;
        for task in 0..self.task_count() {
            context.check()?;
            whole += usize::from(self.task_file(task).remove_if_damaged()? == Found::Whole);
        }
        Ok(whole)
    }

    /// Does one task whose [input is checked](Self::check_inputs_of), unless its file is there,
    /// and whole. Needs the files of the tasks before it; those that turn out to be damaged are
    /// removed, so that their tasks count as not done.
    ///
    /// # Errors
    /// If the input cannot be read, if a task that it needs is not done, or if the run is canceled.
    pub(crate) fn run_task(&self, task: usize, context: &Context) -> Result<()> {
        if task >= self.task_count() {
            return Err(self.no_task(task));
        }
        let _lock = self.lock_shared(context)?;
        let is_there = |task: &usize| matches!(TaskFile::open(&self.task_file(*task)), Ok(Some(_)));
        let needed = self.needs(task);
        let done = match needed.iter().find(|needed| !is_there(needed)) {
            Some(&missing) => Err(self.why_not_done(missing)),
            // Its process has no lease: whoever does the task writes the same file.
            None => self.do_unless_current(task, &|| Ok(()), context),
        };
        self.noting_damage(&needed, done)
    }

    /// Returns what became of a task that needs these. If it failed because the file of one of them
    /// is damaged, that is removed, and the error says so.
    pub(super) fn noting_damage<T>(&self, needed: &[usize], done: Result<T>) -> Result<T> {
        match done {
            Err(error) if error.kind() == Kind::Format => {
                Err(self.remove_damaged_of(needed)?.unwrap_or(error))
            }
            done => done,
        }
    }

    /// Removes the files of these tasks that are damaged. Returns an error that says so, if any is.
    #[cold]
    fn remove_damaged_of(&self, tasks: &[usize]) -> Result<Option<Error>> {
        let mut removed = None;
        for &task in tasks {
            let file = self.task_file(task);
            if file.remove_if_damaged()? == Found::Damaged {
                removed.get_or_insert((task, file.path));
            }
        }
        Ok(removed.map(|(task, path)| {
            let name = self.task_name(task);
            Error::not_yet(format!(
                "task {task} ({name}) is not done: its file was damaged, and is removed now"
            ))
            .in_file(path)
            .cure("do it again")
        }))
    }

    /// Does a task that needs no other one any more, unless its file is there. Its file gets its
    /// name unless `confirm` fails.
    pub(super) fn do_unless_current(
        &self,
        task: usize,
        confirm: &dyn Fn() -> Result<()>,
        context: &Context,
    ) -> Result<()> {
        if self.is_current(task)? {
            Ok(())
        } else {
            self.do_task(task, confirm, context)
        }
    }
}
