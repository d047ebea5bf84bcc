//! Doing the tasks of a job on the threads of this process.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use super::lock::JobLock;
use super::pause::Pause;
use super::{Job, awaited};
use crate::error::{Error, Kind, Result};
use crate::run::context::event::Event;
use crate::run::context::{Context, Size, Stage, Work};

/// What became of a task that a thread has taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outcome {
    /// It was done here.
    DoneHere,
    /// It is done, by another process or an earlier one.
    Done,
    /// Another process does it.
    Elsewhere,
    /// What it needs is not done any more.
    Again,
}

/// The state of a task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// Waits for so many others.
    Waits(usize),
    Runs,
    /// Another process does it.
    Elsewhere,
    Done,
}

struct Board {
    states: Vec<State>,
    /// The tasks that wait for each task.
    after: Vec<Vec<usize>>,
    left: usize,
    /// All tasks below this one run, are done, or wait for others.
    first: usize,
    running: usize,
    /// The tasks that other processes do.
    elsewhere: Vec<usize>,
    /// When is looked again what became of them.
    look_at: Instant,
    pause: Pause,
    /// When it was said last that nothing is left but tasks of others.
    reported: Option<Instant>,
    failed: Option<Failure>,
}

/// Why no other task begins.
enum Failure {
    Error(Error),
    /// A panic, which goes on when all threads have ended.
    Panic(Box<dyn Any + Send>),
}

/// Does a task, if it is not done and no other process does it.
pub(super) type Attempt<'a> = dyn Fn(usize) -> Result<Outcome> + Sync + 'a;

impl Job {
    /// Does all tasks that are not done, on as many threads as there are, and one thread each.
    ///
    /// Merges come soon after what they merge. After an error the tasks that run are finished, and
    /// no other one begins.
    ///
    /// Each task looks at the file of points that it reads. That layers of lines have not changed
    /// is checked by [`run_job`](crate::run::run_job) before.
    ///
    /// # Errors
    /// The first error of a task, or that the run is canceled; or that another process has the job,
    /// because this one was stopped for too long.
    pub fn run(&self, lock: &JobLock, context: &Context) -> Result<()> {
        let attempt = |task| {
            self.do_unless_current(task, &|| lock.confirm(), context)
                .map(|()| Outcome::DoneHere)
        };
        self.schedule(rayon::current_num_threads(), &attempt, context)
    }

    /// Attempts all tasks that are not done, so many at a time, until all are done.
    pub(super) fn schedule(
        &self,
        threads: usize,
        attempt: &Attempt,
        context: &Context,
    ) -> Result<()> {
        let board = self.board(context)?;
        let crew = Crew {
            job: self,
            progress: context.start(Stage::RunningTasks, Size::Items(board.left as u64))?,
            board: Mutex::new(board),
            changed: Condvar::new(),
            attempt,
            context,
        };
        std::thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| crew.work());
            }
        });
        let Crew {
            board, progress, ..
        } = crew;
        let mut board = board.into_inner().unwrap_or_else(PoisonError::into_inner);
        match board.failed.take() {
            Some(Failure::Error(error)) => Err(error),
            Some(Failure::Panic(panic)) => resume_unwind(panic),
            None => progress.end(),
        }
    }

    fn board(&self, context: &Context) -> Result<Board> {
        let count = self.task_count();
        let mut after = vec![Vec::new(); count];
        let mut states = vec![State::Done; count];
        let is_done = self.done(context)?;
        for task in (0..count).filter(|&task| !is_done[task]) {
            let needed: Vec<usize> = self
                .needs(task)
                .into_iter()
                .filter(|&before| !is_done[before])
                .collect();
            needed.iter().for_each(|&before| after[before].push(task));
            states[task] = State::Waits(needed.len());
        }
        let left = is_done.iter().filter(|is_done| !**is_done).count();
        Ok(Board {
            states,
            after,
            left,
            first: 0,
            running: 0,
            elsewhere: Vec::new(),
            look_at: Instant::now(),
            pause: Pause::default(),
            reported: None,
            failed: None,
        })
    }
}

/// The threads of a process that does tasks.
struct Crew<'a> {
    job: &'a Job,
    board: Mutex<Board>,
    changed: Condvar,
    progress: Work<'a>,
    attempt: &'a Attempt<'a>,
    context: &'a Context<'a>,
}

impl Crew<'_> {
    fn board(&self) -> MutexGuard<'_, Board> {
        self.board.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What each thread does: one task after the other.
    fn work(&self) {
        // A task has one thread: other tasks have the others.
        let pool = match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
            Ok(pool) => pool,
            Err(error) => {
                self.board().fail(Error::caused_by(Kind::Limit, error));
                return self.changed.notify_all();
            }
        };
        let mut now = self.board();
        while now.left > 0 && now.failed.is_none() {
            let Some(task) = now.next() else {
                now = self.wait(now);
                continue;
            };
            drop(now);
            let run = || {
                let outcome = pool.install(|| (self.attempt)(task))?;
                let is_done = matches!(outcome, Outcome::Done | Outcome::DoneHere);
                self.progress.add(u64::from(is_done))?;
                Ok(outcome)
            };
            let outcome = catch_unwind(AssertUnwindSafe(run));
            now = self.board();
            now.running -= 1;
            match outcome {
                Ok(Ok(Outcome::DoneHere | Outcome::Done)) => now.finish(task),
                Ok(Ok(Outcome::Elsewhere)) => now.leave(task),
                Ok(Ok(Outcome::Again)) => match self.job.board(self.context) {
                    Ok(fresh) => now.renew(task, fresh),
                    Err(error) => now.fail(error),
                },
                Ok(Err(error)) => now.fail(error),
                Err(panic) => _ = now.failed.get_or_insert(Failure::Panic(panic)),
            }
            self.changed.notify_all();
        }
    }

    /// Waits until a task may have become free.
    fn wait<'b>(&'b self, mut now: MutexGuard<'b, Board>) -> MutexGuard<'b, Board> {
        if now.elsewhere.is_empty() {
            return self
                .changed
                .wait(now)
                .unwrap_or_else(PoisonError::into_inner);
        }
        if now.running == 0 && Pause::is_time_to_say(&mut now.reported) {
            let tasks = &now.elsewhere;
            let is_meant = |task| tasks.contains(&task);
            let on = &awaited::of_tasks(&self.job.folder, self.job.task_count(), is_meant)[..];
            let tasks = tasks.len();
            self.context.monitor.event(&Event::Waits { tasks, on });
        }
        (now, _) = self
            .changed
            .wait_timeout(now, Pause::SLICE)
            .unwrap_or_else(PoisonError::into_inner);
        if let Err(error) = self.context.check() {
            now.fail(error);
            self.changed.notify_all();
        } else if now.look_at <= Instant::now() {
            now.look_again();
            self.changed.notify_all();
        }
        now
    }
}

impl Board {
    /// Returns the first task that waits for nothing, which runs from now on.
    fn next(&mut self) -> Option<usize> {
        let task =
            (self.first..self.states.len()).find(|&task| self.states[task] == State::Waits(0))?;
        self.states[task] = State::Runs;
        self.first = task;
        self.running += 1;
        Some(task)
    }

    fn finish(&mut self, task: usize) {
        self.states[task] = State::Done;
        self.left -= 1;
        self.pause = Pause::default();
        self.reported = None;
        for next in std::mem::take(&mut self.after[task]) {
            if let State::Waits(count) = &mut self.states[next] {
                *count -= 1;
                if *count == 0 {
                    self.first = self.first.min(next);
                }
            }
        }
    }

    /// Leaves a task to another process.
    fn leave(&mut self, task: usize) {
        if self.elsewhere.is_empty() {
            self.look_at = Instant::now() + self.pause.next();
        }
        self.states[task] = State::Elsewhere;
        self.elsewhere.push(task);
    }

    /// Has the tasks of other processes attempted again.
    fn look_again(&mut self) {
        for task in std::mem::take(&mut self.elsewhere) {
            self.states[task] = State::Waits(0);
            self.first = self.first.min(task);
        }
    }

    /// Goes on with a board on which more tasks are not done; `task` has to wait again.
    fn renew(&mut self, task: usize, fresh: Board) {
        let known = std::mem::replace(&mut self.states, fresh.states);
        self.after = fresh.after;
        self.left = fresh.left;
        self.first = 0;
        self.elsewhere.clear();
        for (other, state) in known.into_iter().enumerate() {
            if state == State::Runs && other != task {
                // Its thread has still to say that it is done.
                self.left += usize::from(self.states[other] == State::Done);
                self.states[other] = State::Runs;
            }
        }
    }

    fn fail(&mut self, error: Error) {
        self.failed.get_or_insert(Failure::Error(error));
    }
}
