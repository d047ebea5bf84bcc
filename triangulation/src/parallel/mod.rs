//! Work on many threads or on one: what the algorithms use of rayon, and a serial twin of it.
//!
//! With the feature `parallel` these are rayon's own items. Without it, `serial` has the same
//! names, so that the algorithms have one text. Results do not depend on the number of threads, so
//! both give the same bits.

#[cfg(feature = "parallel")]
pub(crate) use rayon::{current_num_threads, join, prelude::*};

#[cfg(not(feature = "parallel"))]
mod serial;
#[cfg(not(feature = "parallel"))]
pub(crate) use serial::*;

/// Runs a test's work on a number of threads, or on one where there are no others.
#[cfg(all(test, feature = "parallel"))]
pub(crate) fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads").install(work)
}
