//! Work on many threads or on one: what the algorithms use of rayon, and a serial twin of it.
//!
//! With the feature `parallel` these are rayon's own items. Without it, `serial` has the same
//! names, so that the algorithms have one text. Results do not depend on the number of threads, so
//! both give the same bits.

use std::panic::resume_unwind;
use std::sync::{Mutex, PoisonError};
use std::thread;

#[cfg(feature = "parallel")]
pub(crate) use rayon::{current_num_threads, join, prelude::*};

#[cfg(not(feature = "parallel"))]
mod serial;
#[cfg(not(feature = "parallel"))]
pub(crate) use serial::*;

/// The stack of a thread that goes on with a deep recursion, in bytes.
const STACK: usize = 8 << 20;

/// Runs work that is part of a deep recursion on a thread with a stack of its own; on this one if
/// the system refuses another.
pub(crate) fn on_new_stack<T: Send>(work: &mut (dyn FnMut() -> T + Send)) -> T {
    let work = Mutex::new(Some(work));
    let run = || {
        work.lock()
            .unwrap_or_else(PoisonError::into_inner)
            .take()
            .map(|work| work())
    };
    let done = thread::scope(|scope| {
        let started = thread::Builder::new()
            .stack_size(STACK)
            .spawn_scoped(scope, run);
        started
            .ok()
            .and_then(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)))
    });
    done.or_else(run)
        .expect("the work is there until it is run")
}

/// Runs a test's work on a number of threads, or on one where there are no others.
#[cfg(all(test, feature = "parallel"))]
pub(crate) fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads")
        .install(work)
}
