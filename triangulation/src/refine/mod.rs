//! Quality meshes: adds vertices until constrained edges are Delaunay edges, or until triangles
//! satisfy bounds on angles and areas.
//!
//! | to | use |
//! |---|---|
//! | turn constraints into edges of a Delaunay triangulation, by splitting | [`ConstrainedDelaunay::conformed`], [`Conformity::Delaunay`] |
//! | keep the circle on each constraint as its diameter empty | [`ConstrainedDelaunay::conformed`], [`Conformity::Gabriel`] |
//! | have no angle below 20.7 degrees, and bounded areas | [`ConstrainedDelaunay::refined`] |
//!
//! The result, [`Refined`], is read-only. It answers every query of a triangulation, those of lines
//! and their chains included. But the positions of added vertices follow from everything that was
//! there, so that a line could not be removed as if it had never been. To edit, edit the
//! triangulation and refine a copy.
//!
//! **Method.** Constrained edges that are encroached upon are split in the middle, or on concentric
//! circles near small angles (Ruppert 1995). Then triangles, the one with the shortest edge first,
//! get a vertex at their circumcenter, or at the off-center if that is nearer (Üngör 2004). If that
//! vertex encroaches upon a constrained edge, the first such edge that is met is split instead; if
//! the edge cannot be split, the triangle remains. Whatever lies in the lens of a constrained edge,
//! as Chew (1993) and Shewchuk (2002) define it, encroaches upon it. Vertices that were added
//! before and lie in its circle are removed before it is split.
//!
//! **Termination.** Angles up to 20.7 degrees are proven to be reached, and angles up to about 33
//! are reached in practice. Where constraints themselves meet at less than 60 degrees, angles are
//! no better than these allow: triangles across a small angle remain (Miller, Pav and Walkington
//! 2003). A bound on the number of vertices, and one on the smallest edge that coordinates can
//! represent, end the refinement whatever was requested. [`Refined::shortfall`] names every
//! triangle that does not satisfy the bounds, and why.
//!
//! Added vertices are rounded, and constraints go through the rounded sites. These may be off the
//! original segments by a unit in the last place. Nevertheless all tests that decide which vertices
//! are neighbors are exact.

mod draft;
mod improve;
mod quality;
mod queue;
mod regions;
mod shape;
mod shells;
mod split;

pub use quality::{Conformity, Domain, Quality, RegionBound, Shortfall};

use std::ops::Deref;

use crate::geometry::Crossing;
use crate::lines::ConstrainedDelaunay;
use crate::tds::{CellId, VertexId};
use draft::{Draft, Encroachment, VertexOrigin};
use improve::Refiner;
use quality::OUTSIDE;

/// The limit of vertices that splitting constraints may add: it is reached in finite time and in
/// the memory of a machine.
const MAX_SPLITS: usize = 10_000_000;

/// A triangulation with added vertices, read-only.
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
    fn of(mut draft: Draft<G, V>, shortfall: Vec<(CellId, Shortfall)>) -> Self {
        // Edges of the hull are constraints here that belong to no line.
        draft.t.lines.drop_stray_splits();
        let added = draft
            .t
            .tds()
            .vertices()
            .filter(|&v| draft.origin(v) != VertexOrigin::Given)
            .collect();
        Refined {
            t: draft.t,
            regions: draft.regions,
            added,
            shortfall,
        }
    }

    /// Returns a triangulation without triangles as it is: there is nothing to refine.
    fn unchanged(t: ConstrainedDelaunay<G, V>) -> Self {
        Refined {
            t,
            regions: Vec::new(),
            added: Vec::new(),
            shortfall: Vec::new(),
        }
    }

    /// Returns the vertices that were added, in order of their numbers.
    pub fn added(&self) -> &[VertexId] {
        &self.added
    }

    /// Returns true if a cell is in the domain that was to be refined.
    pub fn is_inside(&self, cell: CellId) -> bool {
        self.regions
            .get(cell.index())
            .is_some_and(|&region| region != OUTSIDE)
            && self.tds().is_used(cell)
            && !self.tds().is_infinite(cell)
    }

    /// Returns the triangles of the domain, in order of their numbers.
    pub fn inside(&self) -> impl Iterator<Item = CellId> + '_ {
        self.finite_cells().filter(|&cell| self.is_inside(cell))
    }

    /// Returns the region that a cell is in, as an index into [`Quality::regions`].
    pub fn region(&self, cell: CellId) -> Option<usize> {
        if self.is_inside(cell) {
            (self.regions[cell.index()] as usize).checked_sub(1)
        } else {
            None
        }
    }

    /// Returns the triangles that do not satisfy the bounds, or have an edge that does not conform,
    /// each with the reason; in order of their numbers.
    pub fn shortfall(&self) -> &[(CellId, Shortfall)] {
        &self.shortfall
    }
}

impl<G: Crossing, V: Default> ConstrainedDelaunay<G, V> {
    /// Splits constrained edges until all of them conform. The domain is the whole triangulation.
    ///
    /// Where constraints cross or meet at less than 60 degrees, the edges of such a cluster are
    /// split at distances from the common vertex that are powers of two apart.
    ///
    /// # Complexity
    /// For each added vertex, proportional to the triangles that it replaces. The number of added
    /// vertices depends on lengths and angles.
    pub fn conformed(self, conformity: Conformity) -> Refined<G, V> {
        if self.dimension() < 2 {
            return Refined::unchanged(self);
        }
        let regions = vec![0; self.tds().cell_slots()];
        let encroachment = match conformity {
            Conformity::Delaunay => Encroachment::Delaunay,
            Conformity::Gabriel => Encroachment::Gabriel,
        };
        let mut draft = Draft::new(self, regions, encroachment, MAX_SPLITS);
        draft.split_encroached();
        let why = if draft.budget == 0 {
            Shortfall::Limit
        } else {
            Shortfall::Coordinates
        };
        let does_not_conform = |&cell: &CellId| (0..3).any(|i| draft.is_encroached(cell, i));
        let shortfall = draft
            .t
            .tds()
            .cells()
            .filter(does_not_conform)
            .map(|cell| (cell, why))
            .collect();
        Refined::of(draft, shortfall)
    }

    /// Adds vertices until the triangles of a domain have no smaller angles and no larger areas
    /// than requested.
    ///
    /// Where points have heights, added vertices lie on the surface as it was when they were added.
    ///
    /// ```
    /// use breakline_triangulation::geometry::Plane;
    /// use breakline_triangulation::refine::Quality;
    /// use breakline_triangulation::{ConstrainedDelaunay, OnCrossing};
    ///
    /// let sliver = [[0.0, 0.0], [9.0, 0.0], [9.0, 1.0], [0.0, 1.0]];
    /// let lines = [vec![0, 1, 2, 3, 0]];
    /// let (t, _) = ConstrainedDelaunay::from_lines(Plane::new(), &sliver, &lines, OnCrossing::Split)?;
    /// let mesh = t.refined(&Quality { min_angle: 25.0, max_area: 0.25, ..Quality::default() });
    /// assert!(mesh.shortfall().is_empty());
    /// assert!(mesh.inside().count() >= 36, "nine times four");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Complexity
    /// In practice, expected time proportional to the triangles of the result. Their number is
    /// within a constant factor of the least possible (Ruppert 1995).
    pub fn refined(mut self, quality: &Quality<'_>) -> Refined<G, V> {
        if self.dimension() < 2 {
            return Refined::unchanged(self);
        }
        let regions = regions::regions_of(&mut self, &quality.domain, &quality.regions);
        // Even if only areas are bounded, nothing may come within a rounding of a constraint: the
        // constraint could not be split then.
        let angle = if quality.bounds_areas() {
            quality.angle().max(1.0)
        } else {
            quality.angle()
        };
        let lens = if angle > 0.0 {
            (2.0 * angle.to_radians()).cos()
        } else {
            f64::INFINITY
        };
        let draft = Draft::new(self, regions, Encroachment::Lens(lens), quality.max_added);
        let mut refiner = Refiner::new(draft, quality);
        refiner.run();
        let shortfall = refiner.shortfall();
        Refined::of(refiner.draft, shortfall)
    }
}
