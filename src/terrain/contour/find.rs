//! The search for the arcs of contours: all cores scan stretches of faces in parallel.

use super::cut::{ContourArc, LevelCut};
use super::index::LevelIndex;
use super::narrow::Narrowness;
use crate::data::Surface;
use rayon::prelude::*;
use std::cell::Cell;
use std::ops::Range;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering::Relaxed;

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
    /// All arcs, if they are few.
    pub(super) found: Option<Found>,
    /// The faces that meet a level and are [narrow](Narrowness).
    pub(super) narrow: Vec<u32>,
}

impl Overview {
    /// Passes over all faces; the arcs are few if there are at most so many.
    pub(super) fn of<S: Surface + ?Sized>(
        surface: &S,
        index: &LevelIndex,
        narrowness: Narrowness,
        most: usize,
    ) -> Self {
        if let Some((found, narrow)) = few_arcs(surface, index, narrowness, most) {
            return Overview {
                counts: counts_of(&found, 0..index.levels().len()),
                found: Some(found),
                narrow,
            };
        }
        let (counts, narrow) = count(surface, index, narrowness);
        Overview {
            counts,
            found: None,
            narrow,
        }
    }
}

/// Returns true if a face is narrow.
fn is_narrow<S: Surface + ?Sized>(surface: &S, face: u32, narrowness: Narrowness) -> bool {
    let corners = surface.face(face);
    corners.is_some_and(|corners| narrowness.includes(corners.map(|v| surface.position(v))))
}

/// Returns the number of arcs of each level, and the faces that meet a level and are narrow.
fn count<S: Surface + ?Sized>(
    surface: &S,
    index: &LevelIndex,
    narrowness: Narrowness,
) -> (Vec<usize>, Vec<u32>) {
    let mut counts = vec![0; index.levels().len()];
    let mut all_narrow = Vec::new();
    for waiting in stretches(surface).chunks(WAITING) {
        let of_stretch = |numbers: &Range<u32>| {
            let (mut crossed, mut narrow) = (Vec::new(), Vec::new());
            faces_at(
                surface,
                index,
                0..index.levels().len(),
                numbers.clone(),
                |face, heights, levels| {
                    let Crossed { across, along } = Crossed::of(heights, levels, index);
                    let has_shore = along
                        && LevelCut {
                            surface,
                            level: index.levels()[across.end],
                        }
                        .shore(face)
                        .is_some();
                    crossed.push(across.start..across.end + usize::from(has_shore));
                    narrow.extend(is_narrow(surface, face, narrowness).then_some(face));
                },
            );
            (crossed, narrow)
        };
        let of_stretches: Vec<(Vec<Range<usize>>, Vec<u32>)> =
            waiting.par_iter().map(of_stretch).collect();
        for (crossed, narrow) in of_stretches {
            for levels in crossed {
                counts[levels].iter_mut().for_each(|count| *count += 1);
            }
            all_narrow.extend(narrow);
        }
    }
    (counts, all_narrow)
}

/// The arcs of each stretch, with their levels, in the order of the faces.
pub(super) type Found = Vec<Vec<(usize, ContourArc)>>;

/// The arcs of some levels, sorted by level.
pub(super) struct LevelArcs {
    arcs: Vec<ContourArc>,
    /// Where the arcs of each level start, and the end.
    starts: Vec<usize>,
    first_level: usize,
}

impl LevelArcs {
    /// Sorts arcs of a band of levels, of which the numbers of arcs are known.
    pub(super) fn new(found: Found, first_level: usize, counts: &[usize]) -> Self {
        // A counting sort.
        let mut starts = vec![0];
        starts.extend(counts.iter().scan(0, |end, count| {
            *end += count;
            Some(*end)
        }));
        let mut arcs = vec![ContourArc::Across(0); starts[counts.len()]];
        let mut free = starts.clone();
        for (level, arc) in found.into_iter().flatten() {
            let slot = &mut free[level - first_level];
            arcs[*slot] = arc;
            *slot += 1;
        }
        LevelArcs {
            arcs,
            starts,
            first_level,
        }
    }

    /// The arcs of a level of the band.
    pub(super) fn of(&self, level: usize) -> &[ContourArc] {
        let at = level - self.first_level;
        &self.arcs[self.starts[at]..self.starts[at + 1]]
    }
}

/// Returns the number of arcs of each level of a band.
pub(super) fn counts_of(found: &Found, band: Range<usize>) -> Vec<usize> {
    let mut counts = vec![0; band.len()];
    found
        .iter()
        .flatten()
        .for_each(|&(level, _)| counts[level - band.start] += 1);
    counts
}

/// Returns the arcs of some levels.
pub(super) fn arcs<S: Surface + ?Sized>(
    surface: &S,
    index: &LevelIndex,
    band: Range<usize>,
) -> Found {
    let of_stretch =
        |numbers: Range<u32>| arcs_of_stretch(surface, index, band.clone(), numbers, |_, _| true);
    stretches(surface).into_par_iter().map(of_stretch).collect()
}

/// Returns the arcs of all levels, and the faces that meet a level and are narrow. `None` if there
/// may be more than `most` arcs.
fn few_arcs<S: Surface + ?Sized>(
    surface: &S,
    index: &LevelIndex,
    narrowness: Narrowness,
    most: usize,
) -> Option<(Found, Vec<u32>)> {
    let total = AtomicUsize::new(0);
    let of_stretch = |numbers: Range<u32>| {
        let mut narrow = Vec::new();
        let fits = |face: u32, more: usize| {
            narrow.extend(is_narrow(surface, face, narrowness).then_some(face));
            total.fetch_add(more, Relaxed) + more <= most
        };
        let arcs = arcs_of_stretch(surface, index, 0..index.levels().len(), numbers, fits);
        (arcs, narrow)
    };
    let (mut found, mut all_narrow) = (Found::new(), Vec::new());
    for some in stretches(surface).chunks(WAITING) {
        let of_stretches: Vec<_> = some.par_iter().cloned().map(of_stretch).collect();
        for (arcs, narrow) in of_stretches {
            found.push(arcs);
            all_narrow.extend(narrow);
        }
        if total.load(Relaxed) > most {
            return None;
        }
    }
    Some((found, all_narrow))
}

/// Returns the arcs of a stretch, without those of faces for which `fits` is false, given the
/// number of their arcs, or one more.
fn arcs_of_stretch<S: Surface + ?Sized>(
    surface: &S,
    index: &LevelIndex,
    band: Range<usize>,
    numbers: Range<u32>,
    mut fits: impl FnMut(u32, usize) -> bool,
) -> Vec<(usize, ContourArc)> {
    let mut arcs = Vec::new();
    faces_at(surface, index, band, numbers, |face, heights, levels| {
        let Crossed { across, along } = Crossed::of(heights, levels, index);
        if !fits(face, across.len() + usize::from(along)) {
            return;
        }
        let highest = across.end;
        arcs.extend(across.map(|level| (level, ContourArc::Across(face))));
        if along {
            let cut = LevelCut {
                surface,
                level: index.levels()[highest],
            };
            arcs.extend(cut.shore(face).map(|arc| (highest, arc)));
        }
    });
    arcs
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
        let [a, b, c] = heights;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
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
    for (face, [a, b, c]) in faces {
        let first = first_at(a.min(b).min(c));
        let high = a.max(b).max(c);
        let count = levels[first..band.end]
            .iter()
            .take_while(|&&level| level <= high)
            .count();
        found(face, [a, b, c], first..first + count);
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
