//! How long a process waits before it looks again what others do.

use std::time::{Duration, Instant};

/// The steps in which other processes are waited for: longer and longer.
#[derive(Debug)]
pub(super) struct Pause {
    next: Duration,
}

impl Default for Pause {
    fn default() -> Self {
        Pause { next: Self::SLICE }
    }
}

impl Pause {
    /// How long a thread sleeps before it looks whether the run is canceled.
    pub(super) const SLICE: Duration = Duration::from_millis(50);

    const LONGEST: Duration = Duration::from_secs(3);

    /// After this time, it is said again what is waited for.
    const SAID_AGAIN: Duration = Duration::from_secs(60);

    /// Returns true, and notes the time, if it is time to say what is waited for.
    pub(super) fn is_time_to_say(said: &mut Option<Instant>) -> bool {
        let is_time = said.is_none_or(|at| at.elapsed() > Self::SAID_AGAIN);
        if is_time {
            *said = Some(Instant::now());
        }
        is_time
    }

    /// Returns the next step.
    pub(super) fn next(&mut self) -> Duration {
        let step = self.next;
        self.next = (2 * step).min(Self::LONGEST);
        step
    }
}
