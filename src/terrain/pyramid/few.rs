//! Few of the heights of a large tile: its vertices are chosen from them first.

use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::heights::Heights;
use super::rule::Level;
use crate::data::{TilePosition, Tiling};
use crate::error::Result;
use crate::terrain::admitted::searched;
use crate::terrain::in_order::by_coordinates;
use crate::terrain::simplify::choose_around;

type Few = Mutex<FxHashMap<TilePosition, Vec<[f64; 3]>>>;

impl Heights {
    /// For each tile with more heights than are looked at together, chooses few of them: those that
    /// remain when each of its four quarters is simplified within the bound of their level.
    ///
    /// The sum of the bounds of finer levels is not a bound: a tile that is made from these must be
    /// measured against all heights.
    ///
    /// # Errors
    /// If heights cannot be read, or the run is canceled.
    ///
    /// # Complexity
    /// O(n log n) for n heights, on all threads. 24 bytes for each that is chosen.
    pub(super) fn gather(&mut self, levels: &[Level], cancel: &AtomicBool) -> Result<()> {
        let few = Few::default();
        let roots = levels.iter().take(1).flat_map(|level| &level.tiles);
        for &at in roots {
            if !self.is_small(at) {
                self.gathered(at, levels, &few, cancel)?;
            }
        }
        self.few = few.into_inner().unwrap_or_else(PoisonError::into_inner);
        Ok(())
    }

    /// Returns true if all heights of a tile are looked at together. Those of one block are in
    /// memory together in any case.
    fn is_small(&self, at: TilePosition) -> bool {
        self.count_of(at) <= self.at_once || self.blocks_of(at).len() <= 1
    }

    fn gathered(
        &self,
        at: TilePosition,
        levels: &[Level],
        few: &Few,
        cancel: &AtomicBool,
    ) -> Result<Vec<[f64; 3]>> {
        if self.is_small(at) || at.level >= Tiling::MAX_LEVEL {
            return self.heights_of(at);
        }
        let quarters = at.quarters();
        let chosen = quarters.par_iter().with_max_len(1).map(|&quarter| {
            let heights = self.gathered(quarter, levels, few, cancel)?;
            chosen(heights, allowance(levels, quarter.level), cancel)
        });
        let chosen: Vec<[f64; 3]> = chosen.collect::<Result<Vec<_>>>()?.concat();
        if usize::from(at.level) < levels.len() {
            let mut few = few.lock().unwrap_or_else(PoisonError::into_inner);
            few.insert(at, chosen.clone());
        }
        Ok(chosen)
    }
}

/// What is left for heights at a level, also below the finest one.
fn allowance(levels: &[Level], level: u8) -> f64 {
    let finest = levels.len().saturating_sub(1);
    let below = usize::from(level).saturating_sub(finest) as i32;
    levels
        .get(usize::from(level).min(finest))
        .map_or(0.0, |level| level.allowance * 0.5_f64.powi(below))
}

/// Returns those of some heights that are needed to be near to all of them.
fn chosen(mut heights: Vec<[f64; 3]>, bound: f64, cancel: &AtomicBool) -> Result<Vec<[f64; 3]>> {
    for p in &mut heights {
        [p[0], p[1]] = searched([p[0], p[1]]);
    }
    heights.sort_unstable_by(by_coordinates);
    heights.dedup_by(|q, p| p[..2] == q[..2]);
    choose_around(heights, &[], bound, cancel)
}
