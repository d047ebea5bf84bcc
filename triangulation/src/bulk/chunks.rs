//! Passes over many points on all threads, compiled once and not for each geometry: what depends on
//! the geometry is called once for a chunk of points, or, where that is seldom, for each point.

use std::ops::Range;

use crate::parallel::*;

/// Returns the result for all of a number of points, joined from those for ranges of them; one
/// thread reads `chunk` points at a time.
pub(super) fn reduced<T: Copy + Send + Sync>(
    count: usize,
    chunk: usize,
    of_range: &(dyn Fn(Range<usize>) -> T + Sync),
    nothing: T,
    join: fn(T, T) -> T,
) -> T {
    if count <= chunk {
        return of_range(0..count);
    }
    let chunks = (0..count.div_ceil(chunk)).into_par_iter();
    chunks
        .map(|c| of_range(c * chunk..count.min((c + 1) * chunk)))
        .reduce(|| nothing, join)
}

/// Like [`reduced`], but ends early if the result for a chunk, or a joined one, is `None`.
pub(super) fn try_reduced<T: Copy + Send + Sync>(
    count: usize,
    chunk: usize,
    of_range: &(dyn Fn(Range<usize>) -> Option<T> + Sync),
    nothing: T,
    join: fn(T, T) -> T,
) -> Option<T> {
    let chunks = (0..count.div_ceil(chunk)).into_par_iter();
    let of_chunks = chunks.map(|c| of_range(c * chunk..count.min((c + 1) * chunk)));
    of_chunks.try_reduce(|| nothing, |p, q| Some(join(p, q)))
}

/// Returns so many equal values, written by all threads.
pub(super) fn filled<T: Send>(count: usize, chunk: usize, value: impl Fn() -> T + Sync) -> Vec<T> {
    (0..count)
        .into_par_iter()
        .with_min_len(chunk)
        .map(|_| value())
        .collect()
}

/// Returns the least number that is found in a range of numbers, or in one of its chunks.
pub(super) fn first_of(
    range: Range<usize>,
    chunk: usize,
    is_it: &(dyn Fn(usize) -> bool + Sync),
) -> Option<usize> {
    range
        .into_par_iter()
        .with_min_len(chunk)
        .find_first(|&i| is_it(i))
}
