//! The surface that lines are followed over.

use super::follow::Follow;
use super::hints::Hints;
use super::rim::{RimEdge, on_rim};
use super::segment::Segment;
use super::step::{At, Steps};
use crate::data::Surface;
use crate::terrain::boxes::Boxes;

/// A surface, with what finds positions on it and where lines come onto it.
pub(super) struct Ground<'a> {
    pub(super) surface: &'a dyn Surface,
    pub(super) rim: Boxes<RimEdge>,
    hints: Hints,
}

impl<'a> Ground<'a> {
    /// Prepares a surface. `watched` is the same surface, read once to index it: by it, a caller
    /// can count the faces that are read.
    pub(super) fn new(surface: &'a dyn Surface, watched: &dyn Surface) -> Self {
        let (hints, rim) = Hints::new(watched);
        Ground {
            surface,
            rim,
            hints,
        }
    }

    /// Returns where a position is, by a walk from a face near to it.
    pub(super) fn locate(&self, q: [f64; 2], steps: &mut Steps<'_>) -> At {
        if !q.iter().all(|c| c.is_finite()) {
            return At::Off;
        }
        let hint = self.hints.near(q);
        let Some((face, corners)) = hint.and_then(|f| Some((f, self.surface.triangle(f)?))) else {
            return At::Off;
        };
        let start = At::Vertex { face, corner: 0 };
        let at = match Segment::new([corners[0][0], corners[0][1]], q) {
            None => start,
            Some(segment) => Follow::new(steps, segment, start, &mut |_| ()).go_to_end(
                steps,
                &self.rim,
                &mut |_| (),
            ),
        };
        match at {
            At::Off => on_rim(self.surface, &self.rim, q),
            at => at,
        }
    }
}
