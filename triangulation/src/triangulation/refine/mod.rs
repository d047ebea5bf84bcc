//! Quality meshes: vertices are added until constraints keep to the law of Delaunay, or triangles to an angle and an
//! area.
//!
//! | to | use |
//! |---|---|
//! | make a Delaunay triangulation of it by splitting | [`ConstrainedDelaunay::conformed`], [`Conformity::Delaunay`] |
//! | have nothing in the circle on a constraint as its diameter | the same, [`Conformity::Gabriel`] |
//! | have no angle below 20.7 degrees, and areas bounded | [`ConstrainedDelaunay::refined`] |
//!
//! What comes out, [`Refined`], is for reading: it is a triangulation with all questions of one, lines and their chains
//! included, but the places of added vertices follow from all that is there, so that a line could not be taken out
//! again as if it had never been. To edit, edit the triangulation and refine a copy.
//!
//! **Method.** Constrained edges that are encroached upon are split in the middle, at small angles on concentric
//! circles (Ruppert 1995). Then triangles, the one with the shortest edge first, get a vertex at the center of their
//! circle, or at the off-center if that is nearer (Üngör 2004), unless it encroaches upon a constrained edge: the first
//! that is met is split instead, and the triangle is left if that edge cannot be. What lies in the lens of a constrained
//! edge, as Chew (1993) and Shewchuk (2002) have it, encroaches upon it; vertices that were added before and lie in its
//! circle are taken out before it is split.
//!
//! **Ends.** Angles up to 20.7 degrees are proven to be reached, up to about 33 in practice; where constraints
//! themselves meet at less than 60 degrees, no better than they allow: triangles across a small angle are left (Miller,
//! Pav and Walkington 2003). A bound on the number of vertices and one on the smallest edge that coordinates can tell
//! make an end whatever was asked for. [`Refined::shortfall`] names every triangle that is not as it should be, and
//! why.
//!
//! Added vertices are rounded, and constraints go through the rounded places: by a last place beside the segments that
//! were given. All tests that decide who is whose neighbor are exact nevertheless.

mod draft;
mod improve;
mod queue;
mod regions;
mod shape;
mod shells;
mod walls;

use std::fmt;
use std::ops::Deref;

use crate::geometry::Crossing;
use crate::tds::{CellId, VertexId};

use super::ConstrainedDelaunay;
use draft::{Draft, Law, Origin};
use improve::Refiner;

/// Of a cell that is in no region, since it is not in the domain.
const OUTSIDE: u32 = u32::MAX;

/// Vertices that splitting constraints may add: that comes to an end, in memory that a machine has.
const MAX_SPLITS: usize = 10_000_000;

/// What constrained edges are to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Conformity {
    /// Edges of a Delaunay triangulation: no vertex lies inside of any triangle's circle, behind a constraint or not.
    Delaunay,
    /// Edges of the Gabriel graph: no vertex lies in or on the circle that has one as its diameter.
    Gabriel,
}

/// What is to be improved. Places are rounded to the [step](Crossing::step) of the geometry, if it has one.
#[derive(Debug, Clone, PartialEq)]
pub enum Domain {
    /// All triangles, but holes. The edges of the hull become constraints, which added vertices may bend by a rounding:
    /// what then lies beyond them, and still in the hull, is outside.
    Hull {
        /// As for [`Domain::Enclosed`].
        holes: Vec<[f64; 2]>,
    },
    /// What constraints close off from outside, but holes.
    Enclosed {
        /// A place in each hole; ones outside of the hull make no difference.
        holes: Vec<[f64; 2]>,
    },
    /// What an odd number of constraints closes off: polygons with holes and islands, as
    /// [`ConstrainedDelaunay::nesting`] counts.
    Nested,
    /// What constraints close off around some places.
    Seeded {
        /// The places; ones that are not closed off make no difference.
        seeds: Vec<[f64; 2]>,
    },
}

/// An area that constraints close off, with a bound of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Region {
    /// A place in it, rounded as those of a [`Domain`]; one outside of the domain makes no difference.
    pub seed: [f64; 2],
    /// For triangles, in the square of the unit of the coordinates.
    pub max_area: f64,
}

/// What triangles are to be. Of several bounds on an area the smallest counts.
#[derive(Clone)]
pub struct Quality<'a> {
    /// In degrees, between 0 and 60 (others are taken for these): up to 20.7 is proven to be reached, up to about 33 is
    /// in practice.
    pub min_angle: f64,
    /// In the square of the unit of the coordinates.
    pub max_area: f64,
    /// Areas with bounds of their own.
    pub regions: Vec<Region>,
    /// A bound that depends on the place of a triangle's center.
    pub area_at: Option<&'a dyn Fn([f64; 2]) -> f64>,
    /// Where.
    pub domain: Domain,
    /// Limit of the vertices that are put in; those taken out again count, too. An angle that cannot be reached takes as many
    /// as there may be, and about 350 bytes for each.
    pub max_added: usize,
}

impl Quality<'_> {
    /// The limit of vertices that are put in, if nothing else is said.
    pub const MAX_ADDED: usize = 1_000_000;
}

impl Default for Quality<'_> {
    /// 20.7 degrees in all that constraints close off, of any size; [`MAX_ADDED`](Self::MAX_ADDED) vertices at the most.
    fn default() -> Self {
        Quality {
            min_angle: 20.7,
            max_area: f64::INFINITY,
            regions: Vec::new(),
            area_at: None,
            domain: Domain::Enclosed { holes: Vec::new() },
            max_added: Self::MAX_ADDED,
        }
    }
}

impl fmt::Debug for Quality<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Quality { min_angle, max_area, regions, domain, max_added, area_at } = self;
        f.debug_struct("Quality")
            .field("min_angle", min_angle)
            .field("max_area", max_area)
            .field("regions", regions)
            .field("area_at", &area_at.is_some())
            .field("domain", domain)
            .field("max_added", max_added)
            .finish()
    }
}

impl Quality<'_> {
    /// In degrees, within what has a meaning.
    fn angle(&self) -> f64 {
        if self.min_angle.is_nan() { 0.0 } else { self.min_angle.clamp(0.0, 60.0) }
    }

    fn bounds_areas(&self) -> bool {
        let mut bounds = self.regions.iter().map(|region| region.max_area).chain([self.max_area]);
        self.area_at.is_some() || bounds.any(|bound| bound < f64::INFINITY)
    }
}

/// Why a triangle is not what was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shortfall {
    /// It spans a small angle between constraints, or the rest of one.
    SmallAngle,
    /// [`Quality::max_added`] was reached.
    Limit,
    /// The coordinates are too coarse for more vertices there.
    Coordinates,
}

/// A triangulation with vertices added, for reading.
#[derive(Debug, Clone)]
pub struct Refined<G: Crossing, V = ()> {
    t: ConstrainedDelaunay<G, V>,
    regions: Vec<u32>,
    added: Vec<VertexId>,
    shortfall: Vec<(CellId, Shortfall)>,
}

impl<G: Crossing, V> Deref for Refined<G, V> {
    type Target = ConstrainedDelaunay<G, V>;

    fn deref(&self) -> &Self::Target {
        &self.t
    }
}

impl<G: Crossing, V: Default> Refined<G, V> {
    fn of(draft: Draft<G, V>, shortfall: Vec<(CellId, Shortfall)>) -> Self {
        let added = draft.t.tds().vertices().filter(|&v| draft.origin(v) != Origin::Given).collect();
        Refined { t: draft.t, regions: draft.regions, added, shortfall }
    }

    /// Without triangles there is nothing to improve.
    fn unchanged(t: ConstrainedDelaunay<G, V>) -> Self {
        Refined { t, regions: Vec::new(), added: Vec::new(), shortfall: Vec::new() }
    }

    /// The vertices that were added, in order of their numbers.
    pub fn added(&self) -> &[VertexId] {
        &self.added
    }

    /// Whether a cell is in the domain that was to be improved.
    pub fn is_inside(&self, cell: CellId) -> bool {
        self.regions.get(cell.index()).is_some_and(|&region| region != OUTSIDE)
            && self.tds().is_used(cell)
            && !self.tds().is_infinite(cell)
    }

    /// The triangles of the domain, in order of their numbers.
    pub fn inside(&self) -> impl Iterator<Item = CellId> + '_ {
        self.finite_cells().filter(|&cell| self.is_inside(cell))
    }

    /// The region of [`Quality::regions`] that a cell is in, by its position.
    pub fn region(&self, cell: CellId) -> Option<usize> {
        if self.is_inside(cell) { (self.regions[cell.index()] as usize).checked_sub(1) } else { None }
    }

    /// The triangles that are not what was asked for, or have an edge that is not, in order of their numbers, and why.
    pub fn shortfall(&self) -> &[(CellId, Shortfall)] {
        &self.shortfall
    }
}

impl<G: Crossing, V: Default> ConstrainedDelaunay<G, V> {
    /// Splits constrained edges until all of them conform. All is domain.
    ///
    /// Where constraints cross or meet at less than 60 degrees, around clusters of them, edges are split at distances
    /// from the common vertex that are powers of two apart.
    ///
    /// # Complexity
    /// For each vertex that is added, the triangles it replaces; how many are added depends on lengths and angles.
    pub fn conformed(self, conformity: Conformity) -> Refined<G, V> {
        if self.dimension() < 2 {
            return Refined::unchanged(self);
        }
        let regions = vec![0; self.tds().cell_slots()];
        let law = match conformity {
            Conformity::Delaunay => Law::Delaunay,
            Conformity::Gabriel => Law::Gabriel,
        };
        let mut draft = Draft::new(self, regions, law, MAX_SPLITS);
        draft.settle();
        let why = if draft.budget == 0 { Shortfall::Limit } else { Shortfall::Coordinates };
        let does_not_conform = |&cell: &CellId| (0..3).any(|i| draft.is_encroached(cell, i));
        let shortfall = draft.t.tds().cells().filter(does_not_conform).map(|cell| (cell, why)).collect();
        Refined::of(draft, shortfall)
    }

    /// Adds vertices until the triangles of a domain have no smaller angles and no larger areas than is asked for.
    ///
    /// Added vertices are on the surface as it was when they came, where points have heights.
    ///
    /// ```
    /// use breakline_triangulation::geometry::Plane;
    /// use breakline_triangulation::refine::Quality;
    /// use breakline_triangulation::{ConstrainedDelaunay, OnCrossing};
    ///
    /// let sliver = [[0.0, 0.0], [9.0, 0.0], [9.0, 1.0], [0.0, 1.0]];
    /// let geometry: Plane = Plane::default();
    /// let lines = [vec![0, 1, 2, 3, 0]];
    /// let (t, _) = ConstrainedDelaunay::<_, ()>::from_lines(geometry, &sliver, &lines, OnCrossing::Split)?;
    /// let mesh = t.refined(&Quality { min_angle: 25.0, max_area: 0.25, ..Quality::default() });
    /// assert!(mesh.shortfall().is_empty());
    /// assert!(mesh.inside().count() >= 36, "nine times four");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Complexity
    /// Expected time proportional to the triangles that come out, in practice; the number of these is within a constant
    /// of the least possible (Ruppert 1995).
    pub fn refined(mut self, quality: &Quality<'_>) -> Refined<G, V> {
        if self.dimension() < 2 {
            return Refined::unchanged(self);
        }
        let regions = regions::regions_of(&mut self, &quality.domain, &quality.regions);
        // Where areas only are asked for, too, nothing may come within a rounding of a constraint: it could not be split
        // then.
        let angle = if quality.bounds_areas() { quality.angle().max(1.0) } else { quality.angle() };
        let lens = if angle > 0.0 { (2.0 * angle.to_radians()).cos() } else { f64::INFINITY };
        let draft = Draft::new(self, regions, Law::Lens(lens), quality.max_added);
        let mut refiner = Refiner::new(draft, quality);
        refiner.run();
        let shortfall = refiner.shortfall();
        Refined::of(refiner.draft, shortfall)
    }
}
