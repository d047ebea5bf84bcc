//! The levels of a surface, traced some at a time.

use std::ops::Range;

use super::find::{self, Found, LevelArcs, Overview};
use super::index::LevelIndex;
use super::narrow::{self, Narrowness};
use super::trace::{self, Traces};
use crate::data::Surface;
use crate::error::Result;
use crate::terrain::Levels;

/// The largest number of arcs of levels that are traced together.
const BAND: usize = 1 << 21;

/// The largest number of faces with arcs that are kept until all levels are traced: 64 MB.
const MOST_KEPT: usize = 1 << 22;

/// The levels within the heights of a surface, of which the next are traced on request.
pub(super) struct Bands<'a, S: ?Sized> {
    surface: &'a S,
    levels: Levels,
    heights: [f64; 2],
    index: LevelIndex,
    /// The number of arcs of each level.
    counts: Vec<usize>,
    /// All faces that have arcs, if they are few.
    found: Option<Found>,
    /// The faces that meet a level and are [narrow](Narrowness).
    narrow: Vec<u32>,
    next_level: usize,
}

impl<'a, S: Surface + ?Sized> Bands<'a, S> {
    /// Finds the levels, and how many arcs each of them has.
    ///
    /// # Errors
    /// Those of [`Levels::within`].
    pub(super) fn new(surface: &'a S, levels: &Levels) -> Result<Self> {
        let heights = find::height_range(surface);
        let [low, high] = heights;
        let index = LevelIndex::new(levels.within(low, high)?);
        let narrowness = Narrowness::on(levels, surface, heights);
        let is_narrow = |face| {
            narrowness.is_some_and(|narrowness| {
                let corners = surface.triangle(face);
                corners.is_some_and(|corners| narrowness.includes(corners))
            })
        };
        let Overview {
            counts,
            found,
            narrow,
        } = Overview::of(surface, &index, is_narrow, MOST_KEPT);
        Ok(Bands {
            surface,
            levels: levels.clone(),
            heights,
            index,
            counts,
            found,
            narrow,
            next_level: 0,
        })
    }

    pub(super) fn surface(&self) -> &'a S {
        self.surface
    }

    /// The lowest and the highest height; without faces, infinity and its negative.
    pub(super) fn heights(&self) -> [f64; 2] {
        self.heights
    }

    pub(super) fn index(&self) -> &LevelIndex {
        &self.index
    }

    /// The number of arcs of all levels.
    pub(super) fn arc_count(&self) -> usize {
        self.counts.iter().sum()
    }

    /// The sites at narrow faces, by the index of their level.
    pub(super) fn narrow_sites(&self) -> Vec<(usize, Vec<[f64; 2]>)> {
        let narrowness = Narrowness::of(&self.levels);
        let sites_of = |&face: &u32| narrowness.sites_of(self.surface, &self.index, face);
        narrow::by_level(self.narrow.iter().flat_map(sites_of).collect())
    }

    /// Traces the next levels and maps each by `finish`; `None` after the last.
    pub(super) fn next<T: Send>(
        &mut self,
        finish: impl Fn(f64, Traces) -> T + Sync,
    ) -> Option<Vec<T>> {
        if self.next_level == self.counts.len() {
            return None;
        }
        let band = self.band_from(self.next_level);
        self.next_level = band.end;
        Some(self.trace(band, finish))
    }

    /// The levels that are traced together: at least one, and no more than have [`BAND`] arcs.
    pub(super) fn band_from(&self, first: usize) -> Range<usize> {
        let mut sum = 0;
        let fits = |&&count: &&usize| {
            sum += count;
            sum == count || sum <= BAND
        };
        first..first + self.counts[first..].iter().take_while(fits).count()
    }

    /// Traces levels.
    pub(super) fn trace<T: Send>(
        &self,
        band: Range<usize>,
        finish: impl Fn(f64, Traces) -> T + Sync,
    ) -> Vec<T> {
        let crossed = match &self.found {
            Some(found) => found,
            None => &find::crossed(self.surface, &self.index, band.clone()),
        };
        let counts = &self.counts[band.clone()];
        let arcs = LevelArcs::new(self.surface, &self.index, crossed, band.clone(), counts);
        trace::each_level(self.surface, &self.index, band, &arcs, finish)
    }
}
