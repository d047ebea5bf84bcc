//! One thread under rayon's names; only what this crate uses of them.
//!
//! The traits have one implementation each: they add rayon's methods to foreign types.

use std::cmp::Ordering;
use std::iter::Enumerate;
use std::slice;

/// Runs one after the other, and returns both results.
#[inline]
pub(crate) fn join<A, B>(first: impl FnOnce() -> A, second: impl FnOnce() -> B) -> (A, B) {
    (first(), second())
}

/// The number of threads.
pub(crate) fn current_num_threads() -> usize {
    1
}

/// Runs a test's work on the thread that there is.
#[cfg(test)]
pub(crate) fn on_threads<T>(_: usize, work: impl FnOnce() -> T) -> T {
    work()
}

/// An iterator whose methods have rayon's names and signatures.
///
/// Not an extension of [`Iterator`], because rayon's `reduce` has other arguments than the standard
/// one.
pub(crate) struct Serial<I>(I);

impl<I: Iterator> Serial<I> {
    /// For rayon a hint how to divide the work.
    pub(crate) fn with_min_len(self, _: usize) -> Self {
        self
    }

    pub(crate) fn enumerate(self) -> Serial<Enumerate<I>> {
        Serial(self.0.enumerate())
    }

    pub(crate) fn zip<J: Iterator>(
        self,
        other: Serial<J>,
    ) -> Serial<impl Iterator<Item = (I::Item, J::Item)>> {
        Serial(self.0.zip(other.0))
    }

    pub(crate) fn filter(
        self,
        is_wanted: impl Fn(&I::Item) -> bool,
    ) -> Serial<impl Iterator<Item = I::Item>> {
        Serial(self.0.filter(is_wanted))
    }

    pub(crate) fn map<T>(self, map: impl Fn(I::Item) -> T) -> Serial<impl Iterator<Item = T>> {
        Serial(self.0.map(map))
    }

    /// Lends one scratch value to all calls.
    pub(crate) fn map_init<S, T>(
        self,
        scratch: impl FnOnce() -> S,
        map: impl Fn(&mut S, I::Item) -> T,
    ) -> Serial<impl Iterator<Item = T>> {
        let mut scratch = scratch();
        Serial(self.0.map(move |item| map(&mut scratch, item)))
    }

    pub(crate) fn flat_map_iter<J: IntoIterator>(
        self,
        map: impl Fn(I::Item) -> J,
    ) -> Serial<impl Iterator<Item = J::Item>> {
        Serial(self.0.flat_map(map))
    }

    pub(crate) fn for_each(self, work: impl Fn(I::Item)) {
        self.0.for_each(work);
    }

    pub(crate) fn reduce(
        self,
        identity: impl FnOnce() -> I::Item,
        join: impl Fn(I::Item, I::Item) -> I::Item,
    ) -> I::Item {
        self.0.fold(identity(), join)
    }

    pub(crate) fn find_first(mut self, is_wanted: impl Fn(&I::Item) -> bool) -> Option<I::Item> {
        self.0.find(is_wanted)
    }

    pub(crate) fn collect<C: FromIterator<I::Item>>(self) -> C {
        self.0.collect()
    }
}

impl<T, I: Iterator<Item = Option<T>>> Serial<I> {
    /// Ends at the first `None`.
    pub(crate) fn try_reduce(
        mut self,
        identity: impl FnOnce() -> T,
        join: impl Fn(T, T) -> Option<T>,
    ) -> Option<T> {
        self.0.try_fold(identity(), |sum, item| join(sum, item?))
    }
}

pub(crate) trait IntoParallelIterator: IntoIterator + Sized {
    fn into_par_iter(self) -> Serial<Self::IntoIter> {
        Serial(self.into_iter())
    }
}

impl<I: IntoIterator> IntoParallelIterator for I {}

pub(crate) trait ParallelExtend<T> {
    fn par_extend<I: Iterator<Item = T>>(&mut self, items: Serial<I>);
}

impl<T> ParallelExtend<T> for Vec<T> {
    fn par_extend<I: Iterator<Item = T>>(&mut self, items: Serial<I>) {
        self.extend(items.0);
    }
}

pub(crate) trait ParallelSlice<T> {
    fn par_iter(&self) -> Serial<slice::Iter<'_, T>>;
    fn par_iter_mut(&mut self) -> Serial<slice::IterMut<'_, T>>;
    fn par_chunks(&self, length: usize) -> Serial<slice::Chunks<'_, T>>;
    fn par_chunks_mut(&mut self, length: usize) -> Serial<slice::ChunksMut<'_, T>>;
    fn par_windows(&self, length: usize) -> Serial<slice::Windows<'_, T>>;
    fn par_sort_unstable(&mut self)
    where
        T: Ord;
    fn par_sort_unstable_by(&mut self, compare: impl Fn(&T, &T) -> Ordering);
}

impl<T> ParallelSlice<T> for [T] {
    fn par_iter(&self) -> Serial<slice::Iter<'_, T>> {
        Serial(self.iter())
    }

    fn par_iter_mut(&mut self) -> Serial<slice::IterMut<'_, T>> {
        Serial(self.iter_mut())
    }

    fn par_chunks(&self, length: usize) -> Serial<slice::Chunks<'_, T>> {
        Serial(self.chunks(length))
    }

    fn par_chunks_mut(&mut self, length: usize) -> Serial<slice::ChunksMut<'_, T>> {
        Serial(self.chunks_mut(length))
    }

    fn par_windows(&self, length: usize) -> Serial<slice::Windows<'_, T>> {
        Serial(self.windows(length))
    }

    fn par_sort_unstable(&mut self)
    where
        T: Ord,
    {
        self.sort_unstable();
    }

    fn par_sort_unstable_by(&mut self, compare: impl Fn(&T, &T) -> Ordering) {
        self.sort_unstable_by(compare);
    }
}
