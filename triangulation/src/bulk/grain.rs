//! How work is divided among threads, and what ends it early.

use std::sync::atomic::{AtomicBool, Ordering};

/// How much work one thread does at a time, in points; and the flag that ends it early.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Grain<'a> {
    /// Points per chunk of a pass over all points.
    pub(super) points: usize,
    /// Points per group of the sort: two arrays of records fit a core's cache.
    pub(super) group: usize,
    /// Larger ranges are divided between threads.
    pub(super) range: usize,
    /// `None` if nothing ends it.
    pub(super) stop: Option<&'a Stop<'a>>,
}

impl Default for Grain<'_> {
    fn default() -> Self {
        Grain {
            points: 1 << 14,
            group: 1 << 14,
            range: 1 << 14,
            stop: None,
        }
    }
}

impl<'a> Grain<'a> {
    /// The usual sizes; the work ends early once `stop` is asked for it.
    pub(crate) fn until(stop: &'a Stop<'a>) -> Self {
        Grain {
            stop: Some(stop),
            ..Grain::default()
        }
    }

    /// Returns true if the work should stop. Then [`is_stopped`](Self::is_stopped) is true, too.
    pub(crate) fn stops(&self) -> bool {
        self.stop.is_some_and(Stop::is_asked_for)
    }

    /// Returns true if a thread has ended its work early: what it should have built is not there.
    pub(crate) fn is_stopped(&self) -> bool {
        self.stop
            .is_some_and(|stop| stop.is_seen.load(Ordering::Relaxed))
    }
}

/// A flag that ends work early, and whether a thread has seen it: the flag alone may be cleared
/// again.
#[derive(Debug)]
pub(crate) struct Stop<'a> {
    flag: &'a AtomicBool,
    is_seen: AtomicBool,
}

impl<'a> Stop<'a> {
    pub(crate) fn new(flag: &'a AtomicBool) -> Self {
        Stop {
            flag,
            is_seen: AtomicBool::new(false),
        }
    }

    fn is_asked_for(&self) -> bool {
        if self.flag.load(Ordering::Relaxed) {
            self.is_seen.store(true, Ordering::Relaxed);
        }
        self.is_seen.load(Ordering::Relaxed)
    }
}
