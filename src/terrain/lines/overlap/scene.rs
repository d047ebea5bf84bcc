//! Waters that overlap, prepared for queries.

use super::meetings::Meetings;
use super::sight::Sight;
use crate::terrain::inside::Inside;
use crate::terrain::lines::areas::{Water, WaterLevel};
use crate::terrain::lines::river::RiverWater;

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

/// Waters that overlap, prepared for queries.
pub(super) struct Scene<'a> {
    pub(super) waters: &'a [Water],
    /// Those that take part, and all lakes.
    pub(super) bodies: Vec<Option<Body>>,
    pub(super) meetings: Meetings,
    pub(super) sight: Sight,
    /// Heights that differ by no more are equal: less than that is rounding.
    pub(super) tolerance: f64,
    /// Positions that are no farther apart are the same but for rounding.
    pub(super) rounding: f64,
    pub(super) width: f64,
}

impl Scene<'_> {
    /// The heights of a water, on its border and next to it as well.
    pub(super) fn height(&self, water: usize, q: [f64; 2]) -> f64 {
        self.bodies[water]
            .as_ref()
            .map_or(f64::NAN, |body| body.height(q))
    }

    pub(super) fn contains(&self, water: usize, q: [f64; 2]) -> bool {
        self.bodies[water]
            .as_ref()
            .is_some_and(|body| body.contains(q))
    }

    /// Returns true if a step at the border of a water is in the surface at a position: within the
    /// bounds, and in no other lake.
    pub(super) fn is_seen(&self, q: [f64; 2], water: usize) -> bool {
        let is_covered = |lake: &usize| *lake != water && self.contains(*lake, q);
        self.sight.holds(q) && !self.sight.lakes_near(q).iter().any(is_covered)
    }
}

/// An area of water, prepared for queries.
pub(super) enum Body {
    Lake { height: f64, inside: Inside },
    River(RiverWater),
}

impl Body {
    pub(super) fn new(water: &Water) -> Self {
        match &water.level {
            WaterLevel::Flat(lake) => Body::Lake {
                height: lake.height,
                inside: Inside::new(&[water.level.rings()]),
            },
            WaterLevel::River(river) => Body::River(RiverWater::new(river)),
        }
    }

    pub(super) fn height(&self, q: [f64; 2]) -> f64 {
        match self {
            Body::Lake { height, .. } => *height,
            Body::River(water) => water.height(q),
        }
    }

    pub(super) fn contains(&self, q: [f64; 2]) -> bool {
        match self {
            Body::Lake { inside, .. } => inside.contains(q),
            Body::River(water) => water.height_within(q).is_some(),
        }
    }
}
