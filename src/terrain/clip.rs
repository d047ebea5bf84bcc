//! Clips a TIN to polygons and bounds, by a [cut](super::cut).

use crate::data::Bounds;
use crate::error::Result;
use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::kernel::RANGE;

use super::Tin;
use super::admitted::refused;
use super::cut::{Cut, DRAPED, cut, reach_of};
use super::regions::{Domain, Segment};

/// The number of the domain of the bounds, and that of the first polygon; holes follow the
/// polygons.
const BOUNDS: Domain = 0;
const POLYGONS: Domain = 1;

/// What a surface is cut along. It is kept where it is inside the box, inside any of the polygons
/// (without polygons, everywhere) and in no hole. Draped lines cut it, too, and leave all of it.
#[derive(Debug, Clone)]
pub(super) struct Clip {
    /// The rings of each polygon. The even-odd rule applies, so holes need not be marked.
    pub(super) polygons: Vec<Vec<Vec<[f64; 2]>>>,
    pub(super) bounds: Option<Bounds>,
    /// The rings of each hole, by the same rule.
    pub(super) holes: Vec<Vec<Vec<[f64; 2]>>>,
    pub(super) draped: Vec<Vec<[f64; 2]>>,
}

impl Clip {
    pub(super) fn is_everything(&self) -> bool {
        self.polygons.is_empty() && self.bounds.is_none() && self.holes.is_empty() && self.draped.is_empty()
    }

    /// The lines to cut along, each with the number of the domain that it bounds.
    fn curves(&self) -> Vec<(usize, Vec<[f64; 2]>)> {
        let polygons = self.polygons.iter().chain(&self.holes).enumerate();
        let mut rings: Vec<(usize, Vec<[f64; 2]>)> =
            polygons.flat_map(|(i, rings)| rings.iter().map(move |ring| (POLYGONS + i, ring.clone()))).collect();
        if let Some(Bounds { min, max }) = self.bounds {
            // A box beyond the range of the arithmetic is larger than any data.
            let within = |[x, y]: [f64; 2]| [x, y].map(|c| c.clamp(-RANGE.max, RANGE.max));
            let corners = [[min[0], min[1]], [max[0], min[1]], [max[0], max[1]], [min[0], max[1]]];
            rings.push((BOUNDS, corners.map(within).to_vec()));
        }
        let draped = self.draped.iter().map(|line| (DRAPED, line.clone()));
        rings.iter_mut().for_each(|(_, ring)| ring.extend(ring.first().copied()));
        rings.extend(draped);
        for (_, ring) in &mut rings {
            // Zero has one sign only, and coordinates below the range of the arithmetic count as
            // zero.
            let positive_zero = |c: f64| if c.abs() < RANGE.min && !RANGE.admits(c) { 0.0 } else { c };
            ring.iter_mut().flatten().for_each(|c| *c = positive_zero(*c));
        }
        rings
    }

    /// The straight parts of the lines to cut along, each with the number of the domain that it
    /// bounds.
    ///
    /// # Errors
    /// If a vertex of a line or a bound is outside of the range of the arithmetic.
    pub(super) fn segments(&self) -> Result<Vec<(Domain, Segment)>> {
        let rings = self.curves();
        let holes = POLYGONS + self.polygons.len();
        let geometry: Terrain = Terrain::default();
        for (domain, ring) in &rings {
            if let Some(&[x, y]) = ring.iter().find(|&&[x, y]| !geometry.admits(&[x, y, 0.0])) {
                let what = match *domain {
                    DRAPED => "draped line",
                    domain if domain >= holes => "hole",
                    _ => "boundary",
                };
                return Err(refused([x, y, 0.0]).at(what));
            }
        }
        let segments = |(domain, ring): &(Domain, Vec<[f64; 2]>)| {
            let domain = *domain;
            // Bounds that are one position have sides without length, which bound nothing.
            let bounds_something = move |pair: &&[[f64; 2]]| domain != BOUNDS || pair[0] != pair[1];
            ring.windows(2).filter(bounds_something).map(move |pair| (domain, [pair[0], pair[1]])).collect::<Vec<_>>()
        };
        Ok(rings.iter().flat_map(segments).collect())
    }

    /// Clips the surface. Returns the number of triangles that were removed, and of those that were
    /// cut to fragments.
    ///
    /// # Errors
    /// Those of [`segments`](Self::segments).
    pub(super) fn apply(&self, tin: &mut Tin) -> Result<(usize, usize)> {
        let reach = reach_of(&tin.triangulation);
        self.apply_to_part(tin, &self.segments()?, reach)
    }

    /// Clips a part of a surface: the triangles that the lines meet, and those around them. `reach`
    /// has the largest coordinates of the whole, without their signs.
    ///
    /// # Errors
    /// If there are more vertices than can be numbered.
    pub(super) fn apply_to_part(
        &self,
        tin: &mut Tin,
        segments: &[(Domain, Segment)],
        reach: [f64; 2],
    ) -> Result<(usize, usize)> {
        let holes = POLYGONS + self.polygons.len();
        let in_polygon = |within: &[Domain]| {
            self.polygons.is_empty() || within.iter().any(|domain| (POLYGONS..holes).contains(domain))
        };
        let in_hole = |within: &[Domain]| within.last().is_some_and(|&domain| domain >= holes);
        let in_bounds = |within: &[Domain]| self.bounds.is_none() || within.first() == Some(&BOUNDS);
        let whole = |tin: &Tin| tin.inside.iter().filter(|&&inside| inside).count();
        let before = whole(tin);
        let is_kept = |within: &[Domain]| in_polygon(within) && in_bounds(within) && !in_hole(within);
        tin.cut = cut(&tin.triangulation, &tin.kinds, &mut tin.inside, segments, reach, is_kept)?;
        let in_fragments = tin.cut.as_ref().map_or(0, Cut::cut_count);
        Ok((before - whole(tin) - in_fragments, in_fragments))
    }
}
