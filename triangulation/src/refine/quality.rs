//! What a refinement is asked for.

use std::fmt;
use std::sync::atomic::AtomicBool;

/// The region of a cell outside of the domain.
pub(super) const OUTSIDE: u32 = u32::MAX;

/// The property that [`conformed`](crate::ConstrainedDelaunay::conformed) gives to constrained
/// edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Conformity {
    /// Edges of a Delaunay triangulation: no vertex lies inside of any triangle's circle, behind a
    /// constraint or not.
    Delaunay,
    /// Edges of the Gabriel graph: no vertex lies in or on the circle that has the edge as its
    /// diameter.
    Gabriel,
}

/// The part of a triangulation to refine. Points are rounded to the
/// [step](crate::geometry::Crossing::step) of the geometry, if it has one.
#[derive(Debug, Clone, PartialEq)]
pub enum Domain {
    /// All triangles except holes. The edges of the hull become constraints. Added vertices may
    /// bend these by a rounding; what then lies beyond them, but still in the hull, is outside.
    Hull {
        /// A point in each hole, as for [`Domain::Enclosed`].
        holes: Vec<[f64; 2]>,
    },
    /// What constraints enclose, except holes.
    Enclosed {
        /// A point in each hole; points outside of the hull have no effect.
        holes: Vec<[f64; 2]>,
    },
    /// What an odd number of constraints encloses: polygons with holes and islands, as counted by
    /// [`nesting`](crate::ConstrainedDelaunay::nesting).
    Nested,
    /// What constraints enclose around given points.
    Seeded {
        /// A point in each part; points that are not enclosed have no effect.
        seeds: Vec<[f64; 2]>,
    },
}

/// A bound on the triangles of one region: an area that constraints enclose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegionBound {
    /// A point in the region, rounded like those of a [`Domain`]; a point outside of the domain has
    /// no effect.
    pub seed: [f64; 2],
    /// The largest area of a triangle, in the square of the unit of the coordinates.
    pub max_area: f64,
}

/// The bounds that [`refined`](crate::ConstrainedDelaunay::refined) triangles satisfy. If several
/// bounds on an area apply, the smallest counts.
#[derive(Clone)]
pub struct Quality<'a> {
    /// The smallest angle, in degrees. Values are clamped to 0 to 60; up to 20.7 is proven to be
    /// reached, up to about 33 is reached in practice.
    pub min_angle: f64,
    /// The largest area of a triangle, in the square of the unit of the coordinates.
    pub max_area: f64,
    /// Regions with bounds of their own.
    pub regions: Vec<RegionBound>,
    /// A bound on the area of a triangle that depends on its centroid.
    pub area_at: Option<&'a dyn Fn([f64; 2]) -> f64>,
    /// The region to refine.
    pub domain: Domain,
    /// The largest number of vertices to insert; those that are removed again count, too. An angle
    /// that cannot be reached uses up the limit, and about 350 bytes for each vertex.
    pub max_added: usize,
    /// Set to true by any thread, it ends the refinement early, with what is there, like
    /// `max_added`.
    pub cancel: Option<&'a AtomicBool>,
}

impl Quality<'_> {
    /// The default limit of inserted vertices.
    pub const MAX_ADDED: usize = 1_000_000;
}

impl Default for Quality<'_> {
    /// 20.7 degrees in all that constraints enclose, areas unbounded; at most
    /// [`MAX_ADDED`](Self::MAX_ADDED) vertices.
    fn default() -> Self {
        Quality {
            min_angle: 20.7,
            max_area: f64::INFINITY,
            regions: Vec::new(),
            area_at: None,
            domain: Domain::Enclosed { holes: Vec::new() },
            max_added: Self::MAX_ADDED,
            cancel: None,
        }
    }
}

impl fmt::Debug for Quality<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Quality {
            min_angle,
            max_area,
            regions,
            domain,
            max_added,
            area_at,
            cancel,
        } = self;
        f.debug_struct("Quality")
            .field("min_angle", min_angle)
            .field("max_area", max_area)
            .field("regions", regions)
            .field("area_at", &area_at.is_some())
            .field("domain", domain)
            .field("max_added", max_added)
            .field("cancel", cancel)
            .finish()
    }
}

impl Quality<'_> {
    /// Returns the smallest angle in degrees, clamped to the useful range.
    pub(super) fn angle(&self) -> f64 {
        if self.min_angle.is_nan() {
            0.0
        } else {
            self.min_angle.clamp(0.0, 60.0)
        }
    }

    pub(super) fn bounds_areas(&self) -> bool {
        let mut bounds = self
            .regions
            .iter()
            .map(|region| region.max_area)
            .chain([self.max_area]);
        self.area_at.is_some() || bounds.any(|bound| bound < f64::INFINITY)
    }
}

/// The reason why a triangle does not satisfy the bounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shortfall {
    /// It spans a small angle between constraints, or what remains of one.
    SmallAngle,
    /// [`Quality::max_added`] was reached.
    Limit,
    /// The coordinates are too coarse for more vertices there.
    Coordinates,
}
