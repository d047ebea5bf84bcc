//! Results that threads of the pool compute before somebody takes them.

use std::sync::{Arc, Condvar, Mutex, PoisonError};

use rayon::Yield;

/// A result that is being computed.
pub(super) struct Ahead<T>(Arc<Slot<T>>);

struct Slot<T> {
    result: Mutex<Option<T>>,
    is_there: Condvar,
}

impl<T: Send + 'static> Ahead<T> {
    /// Lets a thread of the pool compute a result. `compute` must not panic. If the pool has one
    /// thread, the caller computes the result at once: otherwise two threads would work.
    ///
    /// If the value is dropped before `compute` is called, it never is.
    pub(super) fn start(compute: impl FnOnce() -> T + Send + 'static) -> Self {
        if rayon::current_num_threads() == 1 {
            return Self::known(compute());
        }
        let ahead = Self::with(None);
        let slot = Arc::downgrade(&ahead.0);
        rayon::spawn(move || {
            if let Some(slot) = slot.upgrade() {
                let result = compute();
                *slot.result.lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
                slot.is_there.notify_one();
            }
        });
        ahead
    }

    /// Wraps a result that is known.
    pub(super) fn known(result: T) -> Self {
        Self::with(Some(result))
    }

    fn with(result: Option<T>) -> Self {
        Ahead(Arc::new(Slot {
            result: Mutex::new(result),
            is_there: Condvar::new(),
        }))
    }

    /// Waits for the result and returns it. Meanwhile, if the caller is a thread of the pool, it
    /// does other work that waits for the pool.
    pub(super) fn take(self) -> T {
        let Slot { result, is_there } = &*self.0;
        let lock = || result.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            if let Some(result) = lock().take() {
                return result;
            }
            if rayon::yield_now() == Some(Yield::Executed) {
                continue;
            }
            // No work waits for the pool. So another thread is computing the result, and it waits
            // for nobody.
            let mut result = lock();
            while result.is_none() {
                result = is_there
                    .wait(result)
                    .unwrap_or_else(PoisonError::into_inner);
            }
        }
    }
}

impl<T> std::fmt::Debug for Ahead<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Ahead").finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::VecDeque;

    use rayon::prelude::*;

    /// Takes numbers in order, a few of which are computed ahead.
    fn taken(count: u64) -> Vec<u64> {
        let mut ahead: VecDeque<Ahead<u64>> = VecDeque::new();
        let mut taken = Vec::new();
        for i in 0..count {
            ahead.push_back(Ahead::start(move || (0..i * 500).fold(i, |a, b| a ^ b)));
            if ahead.len() > 5 {
                taken.extend(ahead.pop_front().map(Ahead::take));
            }
        }
        // The last ones are dropped, begun or not.
        taken
    }

    #[test]
    fn results_come_in_order_inside_and_outside_of_pools_of_all_sizes() {
        let expected: Vec<u64> = (0..195u64)
            .map(|i| (0..i * 500).fold(i, |a, b| a ^ b))
            .collect();
        assert_eq!(taken(200), expected);
        for threads in 1..4 {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            // Also in tasks that wait for each other.
            let all = || (0..7).into_par_iter().map(|_| taken(200)).collect();
            let all: Vec<Vec<u64>> = pool.install(all);
            assert!(all.iter().all(|taken| *taken == expected));
        }
    }
}
