//! Doing the tasks of a job together with other processes, on any number of hosts.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::Job;
use super::lease::{LEASE, Lease, Leases};
use super::lock::JobLock;
use super::paths::tasks_in;
use super::schedule::{Outcome, Pause};
use crate::error::{Command, Error, Kind, Result, Term, wording};
use crate::run::context::event::Event;
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
    fn write(self, lock: &JobLock, context: &Context) -> Result<Self::Report>;
}

impl Job {
    /// Does tasks until all are done, here or by other processes that do the same; then the output
    /// is written by one of them.
    ///
    /// # Errors
    /// The first error of a task that this process does, or of the output; if a process works on
    /// the whole job, or the run is canceled.
    pub(crate) fn work<L: LastTask>(
        &self,
        options: &WorkOptions,
        last: L,
        context: &Context,
    ) -> Result<L::Report> {
        let tasks = tasks_in(&self.folder);
        // An interrupted removal may have taken it.
        std::fs::create_dir_all(&tasks).map_err(|e| Error::from(e).in_file(&tasks))?;
        Leases::while_renewed(&self.folder, options.lease, |leases| {
            self.work_on_tasks(options, leases, context)
                .map_err(|error| self.with_cure(error, self.run_command()))?;
            self.end_together(leases, last, context)
        })
    }

    fn work_on_tasks(
        &self,
        options: &WorkOptions,
        leases: &Leases,
        context: &Context,
    ) -> Result<()> {
        let _lock = self.lock_shared(context)?;
        let done_here = AtomicUsize::new(0);
        let attempt = |task: usize| {
            let outcome = self.attempt(task, leases, context)?;
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
    fn attempt(&self, task: usize, leases: &Leases, context: &Context) -> Result<Outcome> {
        let done = self.do_if_free(task, leases, context);
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

    fn do_if_free(&self, task: usize, leases: &Leases, context: &Context) -> Result<Outcome> {
        if self.has_current_file(task)? {
            return Ok(Outcome::Done);
        }
        let Some(lease) = leases.take(task)? else {
            return Ok(Outcome::Elsewhere);
        };
        // Who had it before may have done the task since.
        if self.has_current_file(task)? {
            return Ok(Outcome::Done);
        }
        self.note_expired(task, &lease, context);
        self.check_inputs_of([task], context)?;
        self.do_task(task, context)?;
        Ok(Outcome::DoneHere)
    }

    fn note_expired(&self, task: usize, lease: &Lease, context: &Context) {
        if let Some(from) = &lease.from {
            let worker = from.worker.as_ref().map(ToString::to_string);
            context.monitor.event(&Event::TakenOver {
                task,
                worker: worker.as_deref(),
                age: from.age,
            });
        }
    }

    /// Writes the output if no other process does; else waits until it is there.
    fn end_together<L: LastTask>(
        &self,
        leases: &Leases,
        last: L,
        context: &Context,
    ) -> Result<L::Report> {
        let task = self.task_count();
        let mut pause = Pause::default();
        let mut has_reported = false;
        loop {
            if leases.is_free(task)? {
                // Reads what was written, which others may do at the same time.
                if let Some(report) = last.written(context)? {
                    return Ok(report);
                }
                if let Some(lease) = self.require_there(leases.take(task))?
                    // Another process may still do a task whose lease it has lost.
                    && let Some(lock) = self.try_lock()?
                {
                    if let Some(report) = last.written(context)? {
                        return Ok(report);
                    }
                    self.note_expired(task, &lease, context);
                    return last.write(&lock, context);
                }
            }
            if !has_reported {
                has_reported = true;
                context.monitor.event(&Event::Waits { tasks: 1 });
            }
            let end = Instant::now() + pause.next();
            while Instant::now() < end {
                context.check()?;
                std::thread::sleep(Pause::SLICE);
            }
        }
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

    /// Returns the command that does what is left of the job.
    pub(crate) fn run_command(&self) -> Term {
        Command::JobRun.on(self.folder().display().to_string())
    }
}
