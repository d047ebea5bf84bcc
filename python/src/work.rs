//! Calls without the interpreter's lock: long ones on threads of our own, canceled by Ctrl-C; short
//! ones on the calling thread.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread::{Builder, ThreadId, available_parallelism};
use std::time::Duration;

use breakline::run::{Context, Event, Monitor, Notice, Progress, Size, Stage};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::errors;
use crate::notices::Warnings;

/// How often a call that waits looks for signals, and reports progress.
pub(crate) const POLL: Duration = Duration::from_millis(50);

/// What every long call takes: the number of threads, all cores if it is `None`, and the function
/// that progress is reported to. In Python, a tuple of both, which `_call.py` has checked.
#[derive(FromPyObject)]
pub(crate) struct Call(Option<usize>, Option<Py<PyAny>>);

/// So many points are worked on by the calling thread: that ends before other threads would wake
/// up, and before anybody would press Ctrl-C.
const FEW: usize = 2000;

impl Call {
    /// A call of one thread, whose progress is not reported: for what reads a little.
    pub(crate) const BRIEF: Call = Call(Some(1), None);
}

/// The pools of this process, that used last at the end.
struct Pools {
    process: u32,
    kept: Vec<Pool>,
}

struct Pool {
    threads: usize,
    /// Calls have it, too.
    pool: Arc<ThreadPool>,
}

impl Pool {
    /// The number of calls that use it.
    fn calls(&self) -> usize {
        Arc::strong_count(&self.pool) - 1
    }
}

/// Locked only while the interpreter's lock is held, so that no other thread has it when the
/// process forks.
static POOLS: Mutex<Pools> = Mutex::new(Pools {
    process: 0,
    kept: Vec::new(),
});

impl Pools {
    /// Takes out the pool with this number of threads that has the fewest calls, if another one
    /// is not to be started: if it has none, or there are no cores for more threads.
    fn take(&mut self, threads: usize, cores: usize) -> Option<Pool> {
        let of_size = self
            .kept
            .iter()
            .enumerate()
            .filter(|(_, kept)| kept.threads == threads);
        let (known, calls) = of_size
            .map(|(i, kept)| (i, kept.calls()))
            .min_by_key(|&(_, calls)| calls)?;
        let busy: usize = self
            .kept
            .iter()
            .filter(|kept| kept.calls() > 0)
            .map(|kept| kept.threads)
            .sum();
        (calls == 0 || busy + threads > cores).then(|| self.kept.remove(known))
    }

    /// Ends pools without calls, those used longest ago first, until the others have at most so
    /// many threads.
    fn end_idle(&mut self, most: usize) {
        let mut idle: usize = self
            .kept
            .iter()
            .filter(|kept| kept.calls() == 0)
            .map(|kept| kept.threads)
            .sum();
        self.kept.retain(|kept| {
            let ends = kept.calls() == 0 && idle > most;
            idle -= if ends { kept.threads } else { 0 };
            !ends
        });
    }
}

/// Returns a pool with this number of threads, one per core if it is `None`.
///
/// Calls at the same time have pools of their own while there are cores for all their threads;
/// beyond that they share. Pools without calls are kept, up to two threads per core.
fn pool(_py: Python<'_>, threads: Option<usize>) -> PyResult<Arc<ThreadPool>> {
    let cores = cores();
    let threads = threads.unwrap_or(cores);
    let mut pools = locked(&POOLS);
    if pools.process != std::process::id() {
        // After a fork the threads are gone, and waiting for them would never end.
        std::mem::forget(std::mem::take(&mut pools.kept));
        pools.process = std::process::id();
    }
    let chosen = match pools.take(threads, cores) {
        Some(known) => known,
        None => started(threads)?,
    };
    pools.end_idle(2 * cores);
    let pool = Arc::clone(&chosen.pool);
    pools.kept.push(chosen);
    Ok(pool)
}

fn cores() -> usize {
    available_parallelism().map_or(1, usize::from)
}

fn started(threads: usize) -> PyResult<Pool> {
    let name = |i: usize| format!("breakline-{i}");
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads)
        .thread_name(name)
        .build();
    let pool =
        pool.map_err(|e| errors::limit(&format!("{threads} threads cannot be started: {e}")))?;
    Ok(Pool {
        threads,
        pool: Arc::new(pool),
    })
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Does the work on the threads of a pool, without the interpreter's lock. Meanwhile the calling
/// thread handles signals and reports progress.
///
/// The work must not take a lock: see [`run_around`] and [`run_alone`].
///
/// # Errors
/// That of the work; the exception of a signal handler (`KeyboardInterrupt`) or of the function
/// that progress is reported to, which cancels the work; an `InternalError` if the work panics.
pub(crate) fn run<T: Send, E: Send + Into<PyErr>>(
    py: Python<'_>,
    call: &Call,
    work: impl FnOnce(&Context<'_>) -> Result<T, E> + Send,
) -> PyResult<T> {
    on_pool(py, &*pool(py, call.0)?, call, work)
}

/// Like [`run`], for work on so many points; `None` if nobody knows.
pub(crate) fn run_on<T: Send, E: Send + Into<PyErr>>(
    py: Python<'_>,
    call: &Call,
    points: Option<usize>,
    work: impl FnOnce(&Context<'_>) -> Result<T, E> + Send,
) -> PyResult<T> {
    match own_pool_for(points) {
        Some(pool) => here(py, call, |context| pool.install(|| work(context))),
        None => run(py, call, work),
    }
}

/// Does work on so many points on the calling thread; `None`, without having begun, if they are not
/// few, or the calling thread has no pool of its own. Errors are those of [`run`].
pub(crate) fn run_few<T: Send, E: Send + Into<PyErr>>(
    py: Python<'_>,
    call: &Call,
    points: usize,
    work: impl FnOnce(&Context<'_>) -> Result<T, E> + Send,
) -> PyResult<Option<T>> {
    let pool = own_pool_for(Some(points));
    pool.map(|pool| here(py, call, |context| pool.install(|| work(context))))
        .transpose()
}

/// Like [`run_around`], for work on so many points; `None` if nobody knows.
pub(crate) fn run_around_on<T: Send, E: Send + Into<PyErr>>(
    py: Python<'_>,
    call: &Call,
    points: Option<usize>,
    work: impl FnOnce(&ThreadPool, &Context<'_>) -> Result<T, E> + Send,
) -> PyResult<T> {
    match own_pool_for(points) {
        Some(pool) => here(py, call, |context| work(pool, context)),
        None => run_around(py, call, work),
    }
}

/// Returns the pool whose only thread is the calling one, if there are few points.
fn own_pool_for(points: Option<usize>) -> Option<&'static ThreadPool> {
    let are_few = points.is_some_and(|points| points < FEW);
    are_few.then(own_pool).flatten()
}

/// Returns the pool whose only thread is the calling one; `None` on all threads but the first that
/// asks, because such a pool is never freed.
fn own_pool() -> Option<&'static ThreadPool> {
    static OWN: OnceLock<(ThreadId, Option<ThreadPool>)> = OnceLock::new();
    let here = std::thread::current().id();
    let (thread, pool) = OWN.get_or_init(|| {
        let pool = ThreadPoolBuilder::new().num_threads(1).use_current_thread();
        (here, pool.build().ok())
    });
    pool.as_ref().filter(|_| *thread == here)
}

/// Does the work on the calling thread.
fn here<T: Send, E: Send + Into<PyErr>>(
    py: Python<'_>,
    call: &Call,
    work: impl FnOnce(&Context<'_>) -> Result<T, E> + Send,
) -> PyResult<T> {
    let running = Running::default();
    let outcome = py.detach(|| running.outcome(work));
    running.ended(py, call, Some(outcome), None)
}

/// Like [`run`], for work that takes a lock, and then uses the pool.
///
/// A thread of a pool that waits for another one takes up other calls; were it to hold a lock, and
/// such a call to ask for it, neither would ever end.
pub(crate) fn run_around<T: Send, E: Send + Into<PyErr>>(
    py: Python<'_>,
    call: &Call,
    work: impl FnOnce(&ThreadPool, &Context<'_>) -> Result<T, E> + Send,
) -> PyResult<T> {
    let pool = pool(py, call.0)?;
    on_thread(py, call, |context| work(&pool, context))
}

/// Like [`run`], for work that takes the lock of a job and keeps it: on threads that no other call
/// has.
///
/// On shared ones, a thread that waits for others could take up a second call on the same job,
/// which would wait for the lock that this thread has.
pub(crate) fn run_alone<T: Send, E: Send + Into<PyErr>>(
    py: Python<'_>,
    call: &Call,
    work: impl FnOnce(&Context<'_>) -> Result<T, E> + Send,
) -> PyResult<T> {
    let Pool { pool, .. } = started(call.0.unwrap_or_else(cores))?;
    on_pool(py, &pool, call, work)
}

/// Does the work on the threads of a pool.
fn on_pool<T: Send, E: Send + Into<PyErr>>(
    py: Python<'_>,
    pool: &ThreadPool,
    call: &Call,
    work: impl FnOnce(&Context<'_>) -> Result<T, E> + Send,
) -> PyResult<T> {
    let running = &Running::default();
    let (outcome, interruption) = py.detach(|| {
        // `install` would block the calling thread, which looks for signals. With a scope, no other
        // thread has to be started.
        pool.in_place_scope(|scope| {
            let (sender, receiver) = sync_channel(1);
            scope.spawn(move |_| {
                // The receiver waits for as long as this is in scope.
                let _ = sender.send(running.outcome(work));
            });
            running.wait(call, &receiver)
        })
    });
    running.ended(py, call, outcome, interruption)
}

/// Does the work on a thread of its own.
fn on_thread<T: Send, E: Send + Into<PyErr>>(
    py: Python<'_>,
    call: &Call,
    work: impl FnOnce(&Context<'_>) -> Result<T, E> + Send,
) -> PyResult<T> {
    let running = &Running::default();
    let waited = py.detach(|| {
        std::thread::scope(|scope| {
            let (sender, receiver) = sync_channel(1);
            let worker = move || {
                let _ = sender.send(running.outcome(work));
            };
            Builder::new()
                .name("breakline-call".to_owned())
                .spawn_scoped(scope, worker)?;
            Ok(running.wait(call, &receiver))
        })
    });
    let (outcome, interruption) = waited
        .map_err(|e: std::io::Error| errors::limit(&format!("a thread cannot be started: {e}")))?;
    running.ended(py, call, outcome, interruption)
}

/// The outcome of work, or its panic.
type Outcome<T, E> = std::thread::Result<Result<T, E>>;

/// A call in progress: what its work reports, and the flag that cancels it.
#[derive(Default)]
struct Running {
    watch: Watch,
    cancel: AtomicBool,
}

impl Running {
    /// Does the work.
    fn outcome<T, E>(&self, work: impl FnOnce(&Context<'_>) -> Result<T, E>) -> Outcome<T, E> {
        let context = Context {
            monitor: &self.watch,
            cancel: &self.cancel,
        };
        catch_unwind(AssertUnwindSafe(|| work(&context)))
    }

    /// Returns the outcome that another thread sends, if it sends one, and the exception that has
    /// canceled the work. Meanwhile handles signals and reports progress.
    fn wait<T, E>(
        &self,
        Call(_, progress): &Call,
        receiver: &Receiver<Outcome<T, E>>,
    ) -> (Option<Outcome<T, E>>, Option<PyErr>) {
        let mut interruption = None;
        loop {
            match receiver.recv_timeout(POLL) {
                Ok(outcome) => return (Some(outcome), interruption),
                Err(RecvTimeoutError::Timeout) if interruption.is_none() => {
                    let polled = Python::attach(|py| self.watch.poll(py, progress.as_ref()));
                    interruption = polled.err();
                    self.cancel.store(interruption.is_some(), Ordering::Relaxed);
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return (None, interruption),
            }
        }
    }

    /// Returns the result of work that has ended, after its last stage and its warnings; the
    /// exception that has canceled it.
    fn ended<T, E: Into<PyErr>>(
        &self,
        py: Python<'_>,
        Call(_, progress): &Call,
        outcome: Option<Outcome<T, E>>,
        interruption: Option<PyErr>,
    ) -> PyResult<T> {
        if let Some(interruption) = interruption {
            if let Some(Ok(Err(canceled))) = outcome {
                note_cure(py, &interruption, &canceled.into());
            }
            return Err(interruption);
        }
        match outcome {
            Some(Ok(Ok(done))) => {
                self.watch.report(py, progress.as_ref())?;
                locked(&self.watch.warnings).issue(py)?;
                Ok(done)
            }
            Some(Ok(Err(error))) => Err(error.into()),
            Some(Err(panic)) => Err(errors::internal(panic.as_ref())),
            None => Err(errors::internal(&"the work ended without a result")),
        }
    }
}

/// Adds how to go on, if the work said so when it was canceled, to the exception that has canceled
/// it.
fn note_cure(py: Python<'_>, interruption: &PyErr, canceled: &PyErr) {
    let cure = canceled
        .value(py)
        .getattr("cure")
        .and_then(|cure| cure.extract::<Option<String>>());
    if let Ok(Some(cure)) = cure {
        // Python before 3.11 has no notes.
        let _ = interruption.value(py).call_method1("add_note", (cure,));
    }
}

/// Does work of a microsecond on the calling thread, with the interpreter's lock: to release it and
/// to wait for it again would take as long.
///
/// # Errors
/// An `InternalError` if the work panics.
pub(crate) fn at_once<T>(work: impl FnOnce() -> T) -> PyResult<T> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| errors::internal(panic.as_ref()))
}

/// Does short work on the calling thread, without the interpreter's lock.
///
/// # Errors
/// That of the work; an `InternalError` if it panics.
pub(crate) fn short<T: Send, E: Send + Into<PyErr>>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, E> + Send,
) -> PyResult<T> {
    match py.detach(|| catch_unwind(AssertUnwindSafe(work))) {
        Ok(outcome) => outcome.map_err(Into::into),
        Err(panic) => Err(errors::internal(panic.as_ref())),
    }
}

/// A stage that has begun, and the items that are done of it.
struct Begun {
    stage: Stage,
    size: Size,
    done: Arc<AtomicU64>,
}

/// Keeps what a run reports, until the calling thread passes it on.
#[derive(Default)]
struct Watch {
    stage: Mutex<Option<Begun>>,
    warnings: Mutex<Warnings>,
}

/// Counts the items of a stage.
struct Count(Arc<AtomicU64>);

impl Progress for Count {
    fn add(&self, items: u64) {
        self.0.fetch_add(items, Ordering::Relaxed);
    }
}

impl Monitor for Watch {
    fn start(&self, stage: Stage, size: Size) -> Box<dyn Progress> {
        let done = Arc::default();
        *locked(&self.stage) = Some(Begun {
            stage,
            size,
            done: Arc::clone(&done),
        });
        Box::new(Count(done))
    }

    fn notice(&self, notice: &Notice) {
        locked(&self.warnings).notice(notice);
    }

    fn event(&self, event: &Event) {
        locked(&self.warnings).event(event);
    }
}

impl Watch {
    /// Handles signals and reports progress; the exception of either.
    fn poll(&self, py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        py.check_signals()?;
        self.report(py, progress)
    }

    fn report(&self, py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        let Some(progress) = progress else {
            return Ok(());
        };
        let begun = locked(&self.stage);
        let Some(Begun { stage, size, done }) = begun.as_ref() else {
            return Ok(());
        };
        let total = match size {
            Size::Items(count) => Some(*count),
            Size::Unknown | Size::Uncounted => None,
        };
        let arguments = (stage.title(), done.load(Ordering::Relaxed), total);
        drop(begun);
        progress.call1(py, arguments).map(drop)
    }
}
