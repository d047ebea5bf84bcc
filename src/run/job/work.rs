//! Doing the tasks of a job together with other processes, on any number of hosts.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::lease::{HostLock, LEASE, Lease, Leases};
use super::lock::{JobLock, SharedLock, Taken};
use super::paths::tasks_in;
use super::pause::Pause;
use super::schedule::Outcome;
use super::{Job, awaited, folder};
use crate::error::{Command, Error, Kind, Result, Term, wording};
use crate::run::context::event::{Awaited, Event};
use crate::run::context::{Context, memory};

/// How a process works on a job together with others.
#[derive(Debug, Clone)]
pub struct WorkOptions {
    /// The memory to use, in bytes: as many tasks are done at a time as have room in it, but at
    /// least one, and at most as many as there are threads. What is free if it is `None`.
    pub memory: Option<u64>,
    /// A process that gives no sign of life for so long loses its tasks to others.
    pub lease: Duration,
}

impl Default for WorkOptions {
    fn default() -> Self {
        WorkOptions {
            memory: None,
            lease: LEASE,
        }
    }
}

/// The last task of a job, for a process that shares it: the output.
pub(crate) trait LastTask {
    /// What is returned of it.
    type Report;

    /// Returns the report of an output that is there as it was written of the tasks that are done.
    fn written(&self, context: &Context) -> Result<Option<Self::Report>>;

    /// Writes the output, in the one process that has the job then.
    fn write(&self, lock: &JobLock, context: &Context) -> Result<Self::Report>;
}

/// What becomes of a process that begins to work on a job.
enum Joined<R> {
    /// It does tasks together with others.
    Shares(SharedLock),
    /// The output was written while it waited.
    Late(R),
}

/// The steps in which a process waits for others that have the job.
#[derive(Default)]
struct Waiting {
    pause: Pause,
    reported: Option<Instant>,
    /// Since when the lock of the job cannot be had, although nobody else has a lease.
    locked_out: Option<Instant>,
}

impl Waiting {
    /// Waits a while, and says from time to time what for.
    fn step(&mut self, on: impl FnOnce() -> Vec<Awaited>, context: &Context) -> Result<()> {
        if Pause::is_time_to_say(&mut self.reported) {
            context.monitor.event(&Event::WaitsForJob { on: &on() });
        }
        let end = Instant::now() + self.pause.next();
        while Instant::now() < end {
            context.check()?;
            std::thread::sleep(Pause::SLICE);
        }
        Ok(())
    }

    /// Returns for how long no other process has had a lease although one has the lock, if that is
    /// longer than a lease lasts: that process gives no sign of life.
    fn locked_out(&mut self, leases: &Leases, lease: Duration) -> Result<Option<Duration>> {
        if leases.has_others()? {
            self.locked_out = None;
            return Ok(None);
        }
        let after = self.locked_out.get_or_insert_with(Instant::now).elapsed();
        Ok((after > lease).then_some(after))
    }
}

impl Job {
    /// Does tasks until all are done, here or by other processes that do the same; then the output
    /// is written by one of them.
    ///
    /// # Errors
    /// The first error of a task that this process does, or of the output; if the job was removed
    /// or replaced, or the run is canceled.
    pub(crate) fn work<L: LastTask>(
        &self,
        options: &WorkOptions,
        last: &L,
        context: &Context,
    ) -> Result<L::Report> {
        let tasks = tasks_in(&self.folder);
        // An interrupted removal may have taken it.
        std::fs::create_dir_all(&tasks).map_err(|e| Error::from(e).in_file(&tasks))?;
        let ended = match self.join(options.lease, last, context) {
            Ok(Joined::Shares(lock)) => self.work_with(lock, options, last, context),
            Ok(Joined::Late(report)) => Ok(report),
            Err(error) => Err(error),
        };
        ended.map_err(|error| self.with_cure(error, self.work_command()))
    }

    fn work_with<L: LastTask>(
        &self,
        lock: SharedLock,
        options: &WorkOptions,
        last: &L,
        context: &Context,
    ) -> Result<L::Report> {
        let leases = Leases::begin(&self.folder, options.lease, lock.of_host())?;
        self.work_on_tasks(options, &leases, &lock, context)?;
        drop(lock);
        self.end_together(&leases, options.lease, last, context)
    }

    /// Waits until no process has the whole job. One that has it may write the output, and then
    /// nothing is left to do. One that gives no sign of life is not waited for longer than a lease
    /// lasts.
    fn join<L: LastTask>(
        &self,
        lease: Duration,
        last: &L,
        context: &Context,
    ) -> Result<Joined<L::Report>> {
        let leases = Leases::begin(&self.folder, lease, HostLock::Lacking)?;
        let mut waiting = Waiting::default();
        loop {
            match self.require_there(SharedLock::try_take(&self.folder))? {
                Taken::Yes(lock) if lock.permits(&leases, self.task_count())? => {
                    return Ok(Joined::Shares(lock));
                }
                Taken::Locked(file) => {
                    if let Some(after) = waiting.locked_out(&leases, lease)?
                        // If the process that has the lock goes on, it sees that it has lost the
                        // lease of the output.
                        && leases.take(self.task_count())?.is_some()
                    {
                        self.note_going_on(after, context);
                        return Ok(Joined::Shares(SharedLock::without(file)));
                    }
                }
                Taken::Yes(_) | Taken::Leased => {}
            }
            if let Some(report) = last.written(context)? {
                return Ok(Joined::Late(report));
            }
            waiting.step(|| self.awaited(), context)?;
        }
    }

    /// Reports that this process goes on without the lock of the job.
    fn note_going_on(&self, after: Duration, context: &Context) {
        let on = &awaited::holders(&self.folder)[..];
        context.monitor.event(&Event::GoesOnWithout { on, after });
    }

    /// Returns which processes have the whole job, as far as that is known.
    fn awaited(&self) -> Vec<Awaited> {
        awaited::of_job(&self.folder, self.task_count())
    }

    fn work_on_tasks(
        &self,
        options: &WorkOptions,
        leases: &Leases,
        lock: &SharedLock,
        context: &Context,
    ) -> Result<()> {
        let done_here = AtomicUsize::new(0);
        let attempt = |task: usize| {
            let outcome = self.attempt(task, leases, lock, context)?;
            done_here.fetch_add(usize::from(outcome == Outcome::DoneHere), Ordering::Relaxed);
            Ok(outcome)
        };
        self.schedule(self.tasks_at_once(options), &attempt, context)?;
        context.monitor.event(&Event::TasksEnd {
            done_here: done_here.into_inner(),
            tasks: self.task_count(),
        });
        Ok(())
    }

    /// Returns how many tasks have room at a time.
    fn tasks_at_once(&self, options: &WorkOptions) -> usize {
        let memory = options.memory.unwrap_or_else(memory::free);
        let most = memory / self.plan.task_memory.max(1);
        rayon::current_num_threads().min(usize::try_from(most).unwrap_or(usize::MAX).max(1))
    }

    /// Does a task if no other process does it, and what it needs is there.
    fn attempt(
        &self,
        task: usize,
        leases: &Leases,
        lock: &SharedLock,
        context: &Context,
    ) -> Result<Outcome> {
        let done = self.do_if_free(task, leases, lock, context);
        match self.noting_damage(&self.needs(task), done) {
            Err(error) if error.kind() == Kind::NotYet => Ok(Outcome::Again),
            // Another process had this task as well, and was faster.
            Err(error)
                if error.kind() == Kind::Io && matches!(self.has_current_file(task), Ok(true)) =>
            {
                Ok(Outcome::Done)
            }
            done => done,
        }
    }

    fn do_if_free(
        &self,
        task: usize,
        leases: &Leases,
        lock: &SharedLock,
        context: &Context,
    ) -> Result<Outcome> {
        if self.has_current_file(task)? {
            return Ok(Outcome::Done);
        }
        let Some(lease) = leases.take(task)? else {
            return Ok(Outcome::Elsewhere);
        };
        // Where locks hold on one host only, another one may have the whole job since.
        if !lock.permits(leases, self.task_count())? {
            return Ok(Outcome::Elsewhere);
        }
        // Who had it before may have done the task since.
        if self.has_current_file(task)? {
            return Ok(Outcome::Done);
        }
        // Another host, which does not see the lock of this one, may have planned the job again.
        folder::require_plan(self.sum, &self.folder)?;
        self.note_expired(task, &lease, context);
        self.check_inputs_of([task], context)?;
        let confirm = || {
            lease.confirm()?;
            folder::require_plan(self.sum, &self.folder)
        };
        self.do_task(task, &confirm, context)?;
        Ok(Outcome::DoneHere)
    }

    pub(super) fn note_expired(&self, task: usize, lease: &Lease, context: &Context) {
        if let Some(from) = &lease.from {
            let worker = from.worker.as_ref().map(ToString::to_string);
            context.monitor.event(&Event::TakenOver {
                task,
                worker: worker.as_deref(),
                age: from.age,
            });
        }
    }

    /// Writes the output if no other process does; else waits until it is there. A process that has
    /// the job and gives no sign of life is not waited for longer than a lease lasts: when it goes
    /// on, it has lost its own, and so gives no file its name any more.
    fn end_together<L: LastTask>(
        &self,
        leases: &Leases,
        patience: Duration,
        last: &L,
        context: &Context,
    ) -> Result<L::Report> {
        let mut waiting = Waiting::default();
        loop {
            if leases.is_free(self.task_count())? {
                // Reads what was written, which others may do at the same time.
                if let Some(report) = last.written(context)? {
                    return Ok(report);
                }
                if let Some(lock) = self.take_output(leases, patience, &mut waiting, context)? {
                    if let Some(report) = last.written(context)? {
                        return Ok(report);
                    }
                    self.note_expired(self.task_count(), lock.lease(), context);
                    match last.write(&lock, context) {
                        // Another process writes it: this one was stopped.
                        Err(error) if error.kind() == Kind::NotYet && lock.confirm().is_err() => {}
                        ended => return ended,
                    }
                }
            }
            waiting.step(|| self.awaited(), context)?;
        }
    }

    /// Takes the output; `None` if another process has it or works on the job.
    fn take_output(
        &self,
        leases: &Leases,
        patience: Duration,
        waiting: &mut Waiting,
        context: &Context,
    ) -> Result<Option<JobLock>> {
        let Some(lease) = self.require_there(leases.take(self.task_count()))? else {
            return Ok(None);
        };
        let lease = match self.require_there(JobLock::of_output(lease, &self.folder))? {
            Ok(lock) => return Ok(Some(lock)),
            // Another process still does a task whose lease it has lost.
            Err(lease) => lease,
        };
        let Some(after) = waiting.locked_out(leases, patience)? else {
            return Ok(None);
        };
        // The next one says that this process has no lock: so it still counts for a process that
        // gets the lock.
        drop(lease);
        let unlocked = Leases::begin(&self.folder, patience, HostLock::Lacking)?;
        let Some(lease) = unlocked.take(self.task_count())? else {
            return Ok(None);
        };
        self.note_going_on(after, context);
        JobLock::without_lock(lease, &self.folder).map(Some)
    }

    /// Returns an error that says where the tasks are kept, and what goes on with them.
    pub(crate) fn with_cure(&self, error: Error, again: Term) -> Error {
        let folder = self.folder().display().to_string();
        let kept = wording![
            "finished tasks are kept in ",
            folder,
            ": go on with ",
            again
        ];
        let cure = error
            .cure_text()
            .map(|own| wording![own.clone(), "; ", kept.clone()]);
        error.cure(cure.unwrap_or(kept))
    }

    /// Returns the command that does what is left of the job together with others.
    fn work_command(&self) -> Term {
        Command::JobWork.on(self.folder().display().to_string())
    }

    /// Returns the command that does what is left of the job.
    pub(crate) fn run_command(&self) -> Term {
        Command::JobRun.on(self.folder().display().to_string())
    }
}
