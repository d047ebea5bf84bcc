//! Fewer points of a cloud: one for each cell, a smallest distance, every n-th, a share.
//!
//! | rule | keeps | memory |
//! |---|---|---|
//! | [`Thinning::Grid`] | one point of each square cell in plan | the points that are kept |
//! | [`Thinning::Poisson`] | points with a smallest distance in plan | about four times those that are kept, at least some millions |
//! | [`Thinning::Nth`] | every n-th point | none |
//! | [`Thinning::Random`] | a share of the points | none |
//!
//! Points are never changed, and keep their order. All rules but the n-th choose by positions, so
//! that neither the order of the points nor their division into files shows in what is kept. Of
//! points with the same position and height the first is kept, or, by [`Thinning::Random`], all or
//! none.

mod cells;
mod held;
mod position;
mod rule;
mod spaced;
#[cfg(test)]
mod tests;

use self::cells::Cells;
use self::held::Held;
use self::position::{hash, point, unit};
pub use self::rule::{CellPoint, Thinning};
use self::spaced::Spaced;
use crate::data::PointBatch;
use crate::error::{Error, Result};

/// Candidates that are held at once, unless four times the points that are kept are more.
const CANDIDATES: usize = 1 << 21;

/// Whether points can be given a second time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passes {
    /// They are given once. Candidates are all held.
    One,
    /// They can be given again, in the same order. Candidates that would need much memory are left
    /// to a later pass.
    Several,
}

/// Chooses points that are given in batches.
///
/// ```
/// use breakline::data::PointBatch;
/// use breakline::terrain::{Passes, Thinner, Thinning};
///
/// let mut thinner = Thinner::new(Thinning::parse("grid:10").unwrap(), Passes::One)?;
/// let mut batch = PointBatch {
///     x: vec![1.0, 4.0, 12.0],
///     y: vec![1.0, 5.0, 5.0],
///     z: vec![7.0, 8.0, 9.0],
///     ..PointBatch::default()
/// };
/// thinner.choose(0, &mut batch)?;
/// assert!(batch.is_empty(), "a later point could be nearer to the center");
/// assert!(thinner.end_pass());
/// let kept: Vec<f64> = thinner.held().flat_map(|(_, batch)| batch.z).collect();
/// assert_eq!(kept, [8.0, 9.0]);
/// # Ok::<(), breakline::Error>(())
/// ```
#[derive(Debug)]
pub struct Thinner(Chooser);

#[derive(Debug)]
enum Chooser {
    Nth { step: u64, seen: u64 },
    Random { share: f64, seed: u64 },
    Cells(Cells),
    Spaced(Spaced),
}

impl Thinner {
    /// Creates a chooser for a rule.
    ///
    /// # Errors
    /// If the number of the rule is not in its range: a length that is not above zero and finite,
    /// every 0th point, or a share that is not above 0 and at most 1.
    pub fn new(thinning: Thinning, passes: Passes) -> Result<Self> {
        if let Some(flaw) = thinning.flaw() {
            return Err(Error::usage(flaw));
        }
        let limit = match passes {
            Passes::One => None,
            Passes::Several => Some(CANDIDATES),
        };
        Ok(Thinner(match thinning {
            Thinning::Grid { size, keep } => Chooser::Cells(Cells::new(size, keep)),
            Thinning::Poisson { distance, seed } => {
                Chooser::Spaced(Spaced::new(distance, seed, limit))
            }
            Thinning::Nth(step) => Chooser::Nth { step, seen: 0 },
            Thinning::Random { share, seed } => Chooser::Random { share, seed },
        }))
    }

    /// Takes the next points, of a source with a number. Those that are certainly kept stay in the
    /// batch; all others leave it, and some of them are [held](Self::held).
    ///
    /// # Errors
    /// If a point is too far from the origin for cells of this size, or records have different
    /// lengths.
    ///
    /// # Complexity
    /// Linear in the points; for [`Thinning::Poisson`] also in the points that are kept around
    /// each, and O(log n) for n candidates.
    pub fn choose(&mut self, source: usize, batch: &mut PointBatch) -> Result<()> {
        match &mut self.0 {
            Chooser::Nth { step, seen } => {
                let is_nth = |seen: &mut u64| {
                    let is_kept = *seen == 0;
                    *seen = if *seen + 1 == *step { 0 } else { *seen + 1 };
                    is_kept
                };
                let keep: Vec<bool> = (0..batch.len()).map(|_| is_nth(seen)).collect();
                batch.retain(&keep);
                Ok(())
            }
            Chooser::Random { share, seed } => {
                let is_in_share = |i| unit(hash(point(batch, i), *seed)) < *share;
                let keep: Vec<bool> = (0..batch.len()).map(is_in_share).collect();
                batch.retain(&keep);
                Ok(())
            }
            Chooser::Cells(cells) => cells.choose(source, batch).map(|()| batch.clear()),
            Chooser::Spaced(spaced) => spaced.choose(source, batch).map(|()| batch.clear()),
        }
    }

    /// Ends a pass over all points. Returns true if all are decided; otherwise all points must be
    /// given again. Always true for [`Passes::One`].
    ///
    /// # Complexity
    /// O(n log n) for n candidates of [`Thinning::Poisson`]; constant for all other rules.
    pub fn end_pass(&mut self) -> bool {
        match &mut self.0 {
            Chooser::Nth { .. } | Chooser::Random { .. } | Chooser::Cells(_) => true,
            Chooser::Spaced(spaced) => spaced.end_pass(),
        }
    }

    /// Returns the points that were held and are kept, in the order in which they were given: in
    /// batches, each with the number of its source.
    ///
    /// # Complexity
    /// O(n log n) for n points that were held.
    pub fn held(&mut self) -> impl Iterator<Item = (usize, PointBatch)> {
        let held = match &mut self.0 {
            Chooser::Nth { .. } | Chooser::Random { .. } => Held::default(),
            Chooser::Cells(cells) => cells.take(),
            Chooser::Spaced(spaced) => spaced.take(),
        };
        held.into_batches()
    }

    /// Returns about how many bytes of memory are used for points that are held.
    pub fn bytes(&self) -> usize {
        match &self.0 {
            Chooser::Nth { .. } | Chooser::Random { .. } => 0,
            Chooser::Cells(cells) => cells.bytes(),
            Chooser::Spaced(spaced) => spaced.bytes(),
        }
    }
}
