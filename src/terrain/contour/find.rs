//! The search for the arcs of contours: all cores scan stretches of faces in parallel.

use super::cut::{ContourArc, LevelCut};
use super::index::LevelIndex;
use crate::data::{Surface, lowest_and_highest};
use rayon::prelude::*;
use std::cell::Cell;
use std::ops::Range;

/// The number of faces of a stretch.
const STRETCH: u32 = 1 << 15;

/// The number of stretches whose results are kept until they are counted.
const WAITING: usize = 64;

/// Returns the lowest and the highest height of the faces; without faces, infinity and its
/// negative.
pub(super) fn height_range<S: Surface + ?Sized>(surface: &S) -> [f64; 2] {
    let of_stretch = |numbers: Range<u32>| {
        let range = Cell::new([f64::INFINITY, f64::NEG_INFINITY]);
        let widen = |low, high| {
            range.set(joined(range.get(), [low, high]));
            false
        };
        surface.heights_in(numbers, &widen, &mut Vec::new());
        range.get()
    };
    stretches(surface)
        .into_par_iter()
        .map(of_stretch)
        .reduce(|| [f64::INFINITY, f64::NEG_INFINITY], joined)
}

pub(super) fn joined(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// What is known of the arcs of all levels before any is drawn.
pub(super) struct Overview {
    /// The number of arcs of each level.
    pub(super) counts: Vec<usize>,
    /// All faces that have arcs, if they are few.
    pub(super) found: Option<Found>,
    /// The faces that meet a level and are narrow.
    pub(super) narrow: Vec<u32>,
}

impl Overview {
    /// Passes over all faces once. Those that have arcs are few if there are at most `most`.
    /// `is_narrow` is called for each face that meets a level.
    pub(super) fn of<S: Surface + ?Sized>(
        surface: &S,
        index: &LevelIndex,
        is_narrow: impl Fn(u32) -> bool + Sync,
        most: usize,
    ) -> Self {
        let all = 0..index.levels().len();
        let mut overview = Overview {
            counts: vec![0; all.len()],
            found: Some(Found::new()),
            narrow: Vec::new(),
        };
        let mut total = 0;
        for waiting in stretches(surface).chunks(WAITING) {
            let of_stretch = |numbers: &Range<u32>| {
                let mut narrow = Vec::new();
                let meets = |face| narrow.extend(is_narrow(face).then_some(face));
                let crossed = crossed_faces(surface, index, all.clone(), numbers.clone(), meets);
                (crossed, narrow)
            };
            let of_stretches: Vec<(Vec<CrossedFace>, Vec<u32>)> =
                waiting.par_iter().map(of_stretch).collect();
            for (crossed, narrow) in of_stretches {
                overview.narrow.extend(narrow);
                count(&crossed, all.start, &mut overview.counts);
                total += crossed.len();
                overview.found = overview.found.filter(|_| total <= most);
                if let Some(found) = &mut overview.found {
                    found.push(crossed);
                }
            }
        }
        overview
    }
}

/// A face that has arcs.
pub(super) struct CrossedFace {
    face: u32,
    /// The first of the levels of the arcs across the face, and the one after the last.
    across: [u32; 2],
    /// True if the next level has an arc along one of its edges.
    has_shore: bool,
}

/// The faces of each stretch that have arcs, in order.
pub(super) type Found = Vec<Vec<CrossedFace>>;

impl CrossedFace {
    /// The levels of its arcs, in a band of levels.
    fn levels(&self, band: &Range<usize>) -> Range<usize> {
        let [start, end] = self.across;
        let end = end as usize + usize::from(self.has_shore);
        (start as usize).max(band.start)..end.min(band.end)
    }

    /// The arc of one of its levels.
    fn arc<S: Surface + ?Sized>(
        &self,
        surface: &S,
        index: &LevelIndex,
        level: usize,
    ) -> Option<ContourArc> {
        if level < self.across[1] as usize {
            return Some(ContourArc::Across(self.face));
        }
        let level = index.levels()[level];
        LevelCut { surface, level }.shore(self.face)
    }
}

/// Adds the arcs of faces to the numbers of those of each level, from the first level on.
fn count(faces: &[CrossedFace], first_level: usize, counts: &mut [usize]) {
    let band = first_level..first_level + counts.len();
    for face in faces {
        for level in face.levels(&band) {
            counts[level - first_level] += 1;
        }
    }
}

/// Returns the number of arcs of each level of a band.
pub(super) fn counts_of(found: &Found, band: Range<usize>) -> Vec<usize> {
    let mut counts = vec![0; band.len()];
    found
        .iter()
        .for_each(|faces| count(faces, band.start, &mut counts));
    counts
}

/// The arcs of some levels, sorted by level.
pub(super) struct LevelArcs {
    arcs: Vec<ContourArc>,
    /// Where the arcs of each level start, and the end.
    starts: Vec<usize>,
    first_level: usize,
}

impl LevelArcs {
    /// Sorts the arcs of a band of levels, of which the numbers are known.
    pub(super) fn new<S: Surface + ?Sized>(
        surface: &S,
        index: &LevelIndex,
        found: &Found,
        band: Range<usize>,
        counts: &[usize],
    ) -> Self {
        // A counting sort.
        let mut starts = vec![0];
        starts.extend(counts.iter().scan(0, |end, count| {
            *end += count;
            Some(*end)
        }));
        let mut arcs = vec![ContourArc::Across(0); starts[counts.len()]];
        let mut free = starts.clone();
        for face in found.iter().flatten() {
            for level in face.levels(&band) {
                if let Some(arc) = face.arc(surface, index, level) {
                    let slot = &mut free[level - band.start];
                    arcs[*slot] = arc;
                    *slot += 1;
                }
            }
        }
        LevelArcs {
            arcs,
            starts,
            first_level: band.start,
        }
    }

    /// The arcs of a level of the band.
    pub(super) fn of(&self, level: usize) -> &[ContourArc] {
        let at = level - self.first_level;
        &self.arcs[self.starts[at]..self.starts[at + 1]]
    }
}

/// Returns the faces that have arcs of some levels.
pub(super) fn crossed<S: Surface + ?Sized>(
    surface: &S,
    index: &LevelIndex,
    band: Range<usize>,
) -> Found {
    let of_stretch = |numbers| crossed_faces(surface, index, band.clone(), numbers, |_| ());
    stretches(surface).into_par_iter().map(of_stretch).collect()
}

/// Returns the faces of a stretch that have arcs of some levels. Calls `meets` for each that meets
/// such a level.
fn crossed_faces<S: Surface + ?Sized>(
    surface: &S,
    index: &LevelIndex,
    band: Range<usize>,
    numbers: Range<u32>,
    mut meets: impl FnMut(u32),
) -> Vec<CrossedFace> {
    let mut crossed = Vec::new();
    faces_at(surface, index, band, numbers, |face, heights, levels| {
        meets(face);
        let Crossed { across, along } = Crossed::of(heights, levels, index);
        let has_shore = along && {
            let level = index.levels()[across.end];
            LevelCut { surface, level }.shore(face).is_some()
        };
        if !across.is_empty() || has_shore {
            crossed.push(CrossedFace {
                face,
                across: [across.start as u32, across.end as u32],
                has_shore,
            });
        }
    });
    crossed
}

/// The levels that have an arc at a face.
struct Crossed {
    /// The levels of arcs across the face.
    across: Range<usize>,
    /// True if the next level is that of an edge, with the rest of the face below it.
    along: bool,
}

impl Crossed {
    /// The levels of a face; `levels` are those from its lowest corner to its highest, inclusive.
    fn of(heights: [f64; 3], levels: Range<usize>, index: &LevelIndex) -> Self {
        let [low, high] = lowest_and_highest(heights);
        let all = &index.levels()[levels.clone()];
        let from = levels.start + usize::from(all.first() == Some(&low));
        let is_at_top = all.last() == Some(&high);
        let along = is_at_top && heights.into_iter().filter(|&h| h == high).count() == 2;
        Crossed {
            across: from..levels.end - usize::from(is_at_top),
            along,
        }
    }
}

/// Calls `found` for each face of a stretch that is not horizontal and meets a level of the band,
/// with the heights of its corners and the levels from the lowest to the highest of them.
fn faces_at<S: Surface + ?Sized>(
    surface: &S,
    index: &LevelIndex,
    band: Range<usize>,
    numbers: Range<u32>,
    mut found: impl FnMut(u32, [f64; 3], Range<usize>),
) {
    let levels = index.levels();
    let first_at = |low: f64| index.first_from(low).max(band.start);
    let is_wanted = |low: f64, high: f64| {
        low < high && {
            let first = first_at(low);
            first < band.end && levels[first] <= high
        }
    };
    let mut faces = Vec::new();
    surface.heights_in(numbers, &is_wanted, &mut faces);
    for (face, heights) in faces {
        let [low, high] = lowest_and_highest(heights);
        let first = first_at(low);
        let count = levels[first..band.end]
            .iter()
            .take_while(|&&level| level <= high)
            .count();
        found(face, heights, first..first + count);
    }
}

fn stretches<S: Surface + ?Sized>(surface: &S) -> Vec<Range<u32>> {
    // No more faces than there are numbers.
    let count = u32::try_from(surface.face_count()).unwrap_or(u32::MAX);
    let starts = (0..count).step_by(STRETCH as usize);
    starts
        .map(|start| start..start.saturating_add(STRETCH).min(count))
        .collect()
}
