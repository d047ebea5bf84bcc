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
mod shared;
mod sight;
mod strand;

use super::RiverWater;
use super::areas::{Level, Water, rounding_of};
use crate::data::Bounds;
use crate::terrain::boxes::{Boxed, Extent};
use crate::terrain::inside::Inside;
use meetings::Meetings;
use sight::Sight;
use strand::Strand;

/// Two waters that overlap or touch, and the step that is left at the border of the overlap, or
/// where they touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaterOverlap {
    /// The numbers of the first lines of both: of the one whose height counts at the border, and of
    /// the river that goes on outside.
    pub lines: [usize; 2],
    /// The largest step.
    pub step: f64,
    /// Where it is.
    pub at: [f64; 2],
}

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
    let is_needed = |number: usize| meetings.takes_part(number) || matches!(waters[number].level, Level::Flat(_));
    let bodies: Vec<Option<Body>> =
        (0..waters.len()).map(|number| is_needed(number).then(|| Body::new(&waters[number]))).collect();
    let mut strands: Vec<Strand> = Vec::new();
    for (number, water) in waters.iter().enumerate() {
        if meetings.takes_part(number) {
            let lines = water.lines.clone();
            strands.extend(lines.map(|of| Strand::given(number, of, line(of), water.rim.contains(&of))));
        }
    }
    let vertices = || strands.iter().flat_map(|strand| &strand.points).copied();
    let (tolerance, rounding) = (tolerance_of(vertices()), rounding_of(vertices()));
    let sight = Sight::new(waters, bounds);
    let scene = Scene { waters, bodies, meetings, sight, tolerance, rounding, width };
    shared::add(&scene, &mut strands);
    strands.iter_mut().for_each(|strand| strand.insert(&scene));
    strands.extend(scene.diagonals());
    let overlaps = band::add(&scene, &mut strands);
    strands.iter_mut().for_each(|strand| strand.insert(&scene));
    crease::add(&scene, &mut strands);
    strands.iter_mut().for_each(|strand| strand.insert(&scene));
    let pairs = scene.meetings.pairs.iter().copied().collect();
    let mut marks = Marks { overlaps, pairs, ..Marks::default() };
    for strand in strands {
        match strand.line {
            Some(of) if strand.is_changed => marks.replaced.push((of, strand.points)),
            Some(_) => {}
            None => marks.added.push((waters[strand.water].lines.start, strand.points)),
        }
    }
    marks
}

/// Waters that overlap, prepared for queries.
struct Scene<'a> {
    waters: &'a [Water],
    /// Those that take part, and all lakes.
    bodies: Vec<Option<Body>>,
    meetings: Meetings,
    sight: Sight,
    /// Heights that differ by no more are equal: less than that is rounding.
    tolerance: f64,
    /// Positions that are no farther apart are the same but for rounding.
    rounding: f64,
    width: f64,
}

impl Scene<'_> {
    /// The heights of a water, on its border and next to it as well.
    fn height(&self, water: usize, q: [f64; 2]) -> f64 {
        self.bodies[water].as_ref().map_or(f64::NAN, |body| body.height(q))
    }

    fn contains(&self, water: usize, q: [f64; 2]) -> bool {
        self.bodies[water].as_ref().is_some_and(|body| body.contains(q))
    }

    /// Returns true if a step at the border of a water is in the surface at a position: within the
    /// bounds, and in no other lake.
    fn is_seen(&self, q: [f64; 2], water: usize) -> bool {
        let is_covered = |lake: &usize| *lake != water && self.contains(*lake, q);
        self.sight.holds(q) && !self.sight.lakes_near(q).iter().any(is_covered)
    }

    /// The edges between the triangles of each stretch that takes part.
    fn diagonals(&self) -> Vec<Strand> {
        let mut diagonals = Vec::new();
        for &[water, stretch] in &self.meetings.stretches {
            if let Level::River(river) = &self.waters[water].level {
                diagonals.extend(river.diagonals(stretch).into_iter().map(|ends| Strand::new(water, ends)));
            }
        }
        diagonals
    }
}

/// An area of water, prepared for queries.
enum Body {
    Lake { height: f64, inside: Inside },
    River(RiverWater),
}

impl Body {
    fn new(water: &Water) -> Self {
        match &water.level {
            Level::Flat(lake) => Body::Lake { height: lake.height, inside: Inside::new(&[water.level.rings()]) },
            Level::River(river) => Body::River(RiverWater::new(river)),
        }
    }

    fn height(&self, q: [f64; 2]) -> f64 {
        match self {
            Body::Lake { height, .. } => *height,
            Body::River(water) => water.height(q),
        }
    }

    fn contains(&self, q: [f64; 2]) -> bool {
        match self {
            Body::Lake { inside, .. } => inside.contains(q),
            Body::River(water) => water.height_within(q).is_some(),
        }
    }
}

/// The box around something that overlaps something else.
#[derive(Debug, Clone, Copy)]
struct Zone(Extent);

impl Boxed for Zone {
    fn extent(&self) -> Extent {
        self.0
    }
}

/// How many units in the last place of the largest coordinate and height rounding may change the
/// difference of two heights.
const ROUNDING: f64 = 64.0;

fn tolerance_of(vertices: impl Iterator<Item = [f64; 3]>) -> f64 {
    let largest = vertices.flatten().fold(0.0_f64, |most, c| most.max(c.abs()));
    ROUNDING * (largest.next_up() - largest)
}

#[cfg(test)]
mod tests;
