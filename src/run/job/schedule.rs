//! Doing all tasks of a job on this machine.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::{Condvar, Mutex, PoisonError};

use super::Job;
use crate::error::{Error, Kind, Result};
use crate::run::context::{Context, Size, Stage};

/// The state of a task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// Waits for so many others.
    Waits(usize),
    Runs,
    Done,
}

struct Board {
    states: Vec<State>,
    /// The tasks that wait for each task.
    after: Vec<Vec<usize>>,
    left: usize,
    /// All tasks below this one run, are done, or wait for others.
    first: usize,
    failed: Option<Failure>,
}

/// Why no other task begins.
enum Failure {
    Error(Error),
    /// A panic, which goes on when all threads have ended.
    Panic(Box<dyn Any + Send>),
}

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
    /// The first error of a task, or that the run is canceled.
    pub fn run(&self, context: &Context) -> Result<()> {
        let board = Mutex::new(self.board(context)?);
        let changed = Condvar::new();
        let lock = || board.lock().unwrap_or_else(PoisonError::into_inner);
        let progress = context.start(Stage::RunningTasks, Size::Items(lock().left as u64))?;
        std::thread::scope(|scope| {
            for _ in 0..rayon::current_num_threads() {
                scope.spawn(|| {
                    // A task has one thread: other tasks have the others.
                    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
                    let mut now = lock();
                    let pool = match pool {
                        Ok(pool) => pool,
                        Err(error) => {
                            now.failed.get_or_insert(Failure::Error(Error::caused_by(
                                Kind::Limit,
                                error,
                            )));
                            changed.notify_all();
                            return;
                        }
                    };
                    loop {
                        if now.left == 0 || now.failed.is_some() {
                            break;
                        }
                        let Some(task) = now.next() else {
                            now = changed.wait(now).unwrap_or_else(PoisonError::into_inner);
                            continue;
                        };
                        drop(now);
                        let run = || {
                            pool.install(|| self.do_unless_current(task, context))
                                .and_then(|()| progress.add(1))
                        };
                        let done = catch_unwind(AssertUnwindSafe(run));
                        now = lock();
                        match done {
                            Ok(Ok(())) => now.finish(task),
                            Ok(Err(error)) => _ = now.failed.get_or_insert(Failure::Error(error)),
                            Err(panic) => _ = now.failed.get_or_insert(Failure::Panic(panic)),
                        }
                        changed.notify_all();
                    }
                });
            }
        });
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
            failed: None,
        })
    }
}

impl Board {
    /// Returns the first task that waits for nothing, which runs from now on.
    fn next(&mut self) -> Option<usize> {
        let task =
            (self.first..self.states.len()).find(|&task| self.states[task] == State::Waits(0))?;
        self.states[task] = State::Runs;
        self.first = task;
        Some(task)
    }

    fn finish(&mut self, task: usize) {
        self.states[task] = State::Done;
        self.left -= 1;
        for next in std::mem::take(&mut self.after[task]) {
            if let State::Waits(count) = &mut self.states[next] {
                *count -= 1;
                if *count == 0 {
                    self.first = self.first.min(next);
                }
            }
        }
    }
}
