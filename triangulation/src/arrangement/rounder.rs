//! The rounding of an arrangement, one query at a time: for code that keeps an arrangement and
//! changes parts of it.

use crate::kernel::{Adaptive, Kernel, Orientation2, RANGE};
use crate::num::Sign;

use super::builder::cross;
use super::pixel::{Grid, ulp};
use super::segment::{Segment, Site};

/// The grid to which the crossings of some segments are rounded.
///
/// Its answers are those that [`Arrangement`](super::Arrangement) computes itself.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rounder {
    grid: Grid,
}

impl Rounder {
    /// Returns the rounder for segments whose ends have these largest magnitudes on the axes.
    /// `is_even` must be true exactly if all sites that count are multiples of the unit. `None` for
    /// magnitudes outside the range of the fast kernels.
    pub(crate) fn new(largest: Site, step: f64, is_even: bool) -> Option<Self> {
        // Tiny numbers are arranged scaled.
        let is_in_range = largest.iter().all(|&x| x >= RANGE.min && RANGE.admits(x));
        is_in_range.then(|| Rounder {
            grid: Grid::through(largest, [step; 2], [&[], &[]]).with_steps(is_even),
        })
    }

    /// The largest of the steps between sites on each axis: a power of two.
    pub(crate) fn unit(&self) -> [f64; 2] {
        self.grid.unit
    }

    /// Returns true if all steps are equal.
    pub(crate) fn is_even(&self) -> bool {
        self.grid.is_even
    }

    /// Returns true if a site is a multiple of the unit on both axes.
    pub(crate) fn holds(&self, site: Site) -> bool {
        self.grid.holds(site)
    }

    /// Returns the site of the crossing of two segments; `None` unless they cross in their
    /// interiors.
    pub(crate) fn crossing(&self, ab: Segment, cd: Segment) -> Option<Site> {
        crosses(ab, cd).then(|| self.grid.crossing::<Adaptive>(ab, cd))
    }

    /// Returns true if a segment has a point in the pixel of a site.
    pub(crate) fn hits(&self, segment: Segment, site: Site) -> bool {
        self.grid.hits::<Adaptive>(segment, site)
    }

    /// Returns keys that sort the sites whose pixels a segment meets, from its lexicographically
    /// smaller end.
    pub(crate) fn along(&self, segment: Segment) -> impl Fn(Site) -> Site + use<> {
        self.grid.along(segment)
    }
}

/// Returns true if two segments cross in their interiors.
pub(crate) fn crosses(ab: Segment, cd: Segment) -> bool {
    cross::<Adaptive>(ab, cd)
}

/// Returns true if a site lies on the line through a segment.
pub(crate) fn is_aligned([a, b]: Segment, site: Site) -> bool {
    Adaptive::sign(&Orientation2([a, b, site])) == Sign::Zero
}

/// Returns the step between doubles of a magnitude: a number that grows with the unit of the grid.
pub(crate) fn step_at(x: f64) -> f64 {
    ulp(x)
}

/// Returns true if a site is in the range of the fast kernels.
pub(crate) fn is_ordinary(site: Site) -> bool {
    site.into_iter().all(|x| RANGE.admits(x))
}
