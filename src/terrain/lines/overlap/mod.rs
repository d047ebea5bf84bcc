//! Waters that overlap or touch: the lines that give each position of an overlap the lower height,
//! and let each river keep its own height outside.
//!
//! ```text
//!    across the lower river, along the higher one:
//!
//!    ---------------+                          +---------------  own height
//!                    \                        /
//!                     +----------------------+                   lower height
//!        parallel line|                      |
//!                     border of the overlap: the banks of the lower river
//! ```
//!
//! Within the overlap the lower of two heights has creases: at the edges of the triangles of both
//! rivers, and where both heights are equal. At its border there is a step if the river that goes
//! on outside is higher. It is as wide as a wall: a line parallel to the border has the heights of
//! that river again. A lake counts before a river, so its border is its shore, and the river may be
//! lower as well. Where two waters share a part of their borders or a vertex, and have different
//! heights there, the step is the same.

mod band;
mod crease;
mod meetings;
mod parallel;
mod scene;
mod shared;
mod sight;
mod strand;
mod zone;

use super::areas::{Water, WaterLevel, rounding_of};
use crate::data::Bounds;
use meetings::Meetings;
pub use scene::WaterOverlap;
use scene::{Body, Scene};
use sight::Sight;
use strand::Strand;
use zone::tolerance_of;

/// What waters that overlap or touch add to their lines.
#[derive(Debug, Clone, Default)]
pub(crate) struct Marks {
    /// Lines that have more vertices now, by their numbers.
    pub(crate) replaced: Vec<(usize, Vec<[f64; 3]>)>,
    /// New lines, each with the number of a line of the same water.
    pub(crate) added: Vec<(usize, Vec<[f64; 3]>)>,
    /// The pairs of a water and a river that overlap or touch, by their numbers.
    pub(crate) pairs: Vec<[usize; 2]>,
    /// The waters that meet with a step.
    pub(crate) overlaps: Vec<WaterOverlap>,
}

/// Finds what waters that overlap or touch need. `line` returns the vertices of a line, `width` is
/// the distance in which heights change at a step. Steps are reported within the bounds.
///
/// The result depends on the set of waters only.
///
/// # Complexity
/// O(n log n) for n level lines of waters that do not meet; where they do, about linear in the
/// parts of triangles that overlap.
pub(crate) fn mark(
    waters: &[Water],
    line: &dyn Fn(usize) -> Vec<[f64; 3]>,
    width: f64,
    bounds: Option<Bounds>,
) -> Marks {
    let meetings = Meetings::find(waters);
    if meetings.is_empty() {
        return Marks::default();
    }
    let is_needed = |number: usize| {
        meetings.takes_part(number) || matches!(waters[number].level, WaterLevel::Flat(_))
    };
    let bodies: Vec<Option<Body>> = (0..waters.len())
        .map(|number| is_needed(number).then(|| Body::new(&waters[number])))
        .collect();
    let mut strands: Vec<Strand> = Vec::new();
    for (number, water) in waters.iter().enumerate() {
        if meetings.takes_part(number) {
            let lines = water.lines.clone();
            strands.extend(
                lines.map(|of| Strand::given(number, of, line(of), water.rim.contains(&of))),
            );
        }
    }
    let vertices = || strands.iter().flat_map(|strand| &strand.points).copied();
    let (tolerance, rounding) = (tolerance_of(vertices()), rounding_of(vertices()));
    let sight = Sight::new(waters, bounds);
    let scene = Scene {
        waters,
        bodies,
        meetings,
        sight,
        tolerance,
        rounding,
        width,
    };
    shared::add(&scene, &mut strands);
    strands.iter_mut().for_each(|strand| strand.insert(&scene));
    strands.extend(scene.diagonals());
    let overlaps = band::add(&scene, &mut strands);
    strands.iter_mut().for_each(|strand| strand.insert(&scene));
    crease::add(&scene, &mut strands);
    strands.iter_mut().for_each(|strand| strand.insert(&scene));
    let pairs = scene.meetings.pairs.iter().copied().collect();
    let mut marks = Marks {
        overlaps,
        pairs,
        ..Marks::default()
    };
    for strand in strands {
        match strand.line {
            Some(of) if strand.is_changed => marks.replaced.push((of, strand.points)),
            Some(_) => {}
            None => marks
                .added
                .push((waters[strand.water].lines.start, strand.points)),
        }
    }
    marks
}

#[cfg(test)]
mod tests;
