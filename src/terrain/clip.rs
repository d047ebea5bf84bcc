//! Clips a TIN to polygons and bounds, by a [cut](super::cut).

use std::collections::VecDeque;

use crate::data::Bounds;
use crate::error::Result;
use crate::triangulation::geometry::{Geometry, Terrain};
use crate::triangulation::kernel::RANGE;
use crate::triangulation::num::Sign;

use super::Tin;
use super::admitted::refused;
use super::cut::{DRAPED, SurfaceCut, cut, reach_of};
use super::linear::turn;
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
    /// Takes the rings of polygons and holes, without what encloses [no area](enclosing): a polygon
    /// of which nothing is left has no inside.
    pub(super) fn new(
        mut polygons: Vec<Vec<Vec<[f64; 2]>>>,
        bounds: Option<Bounds>,
        mut holes: Vec<Vec<Vec<[f64; 2]>>>,
        mut draped: Vec<Vec<[f64; 2]>>,
    ) -> Self {
        draped.iter_mut().for_each(|line| *line = plain(line));
        for rings in polygons.iter_mut().chain(&mut holes) {
            rings
                .iter_mut()
                .for_each(|ring| *ring = enclosing(plain(ring)));
            rings.retain(|ring| !ring.is_empty());
        }
        Clip {
            polygons,
            bounds,
            holes,
            draped,
        }
    }

    pub(super) fn is_everything(&self) -> bool {
        self.polygons.is_empty()
            && self.bounds.is_none()
            && self.holes.is_empty()
            && self.draped.is_empty()
    }

    /// The lines to cut along, each with the number of the domain that it bounds.
    fn curves(&self) -> Vec<(usize, Vec<[f64; 2]>)> {
        let polygons = self.polygons.iter().chain(&self.holes).enumerate();
        let mut rings: Vec<(usize, Vec<[f64; 2]>)> = polygons
            .flat_map(|(i, rings)| rings.iter().map(move |ring| (POLYGONS + i, ring.clone())))
            .collect();
        if let Some(Bounds { min, max }) = self.bounds {
            // A box beyond the range of the arithmetic is larger than any data.
            let within = |[x, y]: [f64; 2]| [x, y].map(|c| c.clamp(-RANGE.max, RANGE.max));
            let corners = [
                [min[0], min[1]],
                [max[0], min[1]],
                [max[0], max[1]],
                [min[0], max[1]],
            ];
            rings.push((BOUNDS, enclosing(plain(&corners.map(within)))));
        }
        let draped = self.draped.iter().map(|line| (DRAPED, line.clone()));
        rings
            .iter_mut()
            .for_each(|(_, ring)| ring.extend(ring.first().copied()));
        rings.extend(draped);
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
            ring.windows(2)
                .map(move |pair| (domain, [pair[0], pair[1]]))
                .collect::<Vec<_>>()
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
            self.polygons.is_empty()
                || within
                    .iter()
                    .any(|domain| (POLYGONS..holes).contains(domain))
        };
        let in_hole = |within: &[Domain]| within.last().is_some_and(|&domain| domain >= holes);
        let in_bounds =
            |within: &[Domain]| self.bounds.is_none() || within.first() == Some(&BOUNDS);
        let whole = |tin: &Tin| tin.inside.iter().filter(|&&inside| inside).count();
        let before = whole(tin);
        let is_kept =
            |within: &[Domain]| in_polygon(within) && in_bounds(within) && !in_hole(within);
        tin.cut = cut(
            &tin.triangulation,
            &tin.kinds,
            &mut tin.inside,
            segments,
            reach,
            is_kept,
        )?;
        let in_fragments = tin.cut.as_ref().map_or(0, SurfaceCut::cut_count);
        Ok((before - whole(tin) - in_fragments, in_fragments))
    }
}

/// Returns a line with one kind of zero, and none of its vertices twice in a row: coordinates below
/// the range of the arithmetic count as zero.
fn plain(line: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let positive_zero = |c: f64| {
        if c == 0.0 || c.abs() < RANGE.min && !RANGE.admits(c) {
            0.0
        } else {
            c
        }
    };
    let mut plain: Vec<[f64; 2]> = line.iter().map(|p| p.map(positive_zero)).collect();
    plain.dedup();
    plain
}

/// Returns the vertices of a ring, once each, without spikes: parts that run back over themselves,
/// and so enclose nothing. Nothing is left of a ring that has no area for this reason.
///
/// ```text
///     d---------c                    d---------c
///     |         |                    |         |
///     |         b----spike    ->     |         |
///     |         |                    |         |
///     e---------a                    e---------a
/// ```
///
/// Without area there is no inside, so what is kept must not depend on where such a part lies: it
/// may touch a vertex of the surface, which has triangles on all sides.
///
/// # Complexity
/// Linear.
fn enclosing(ring: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    // What is not a number is an error later.
    if !ring.as_flattened().iter().all(|c| c.is_finite()) {
        return ring;
    }
    let mut left: VecDeque<[f64; 2]> = VecDeque::with_capacity(ring.len());
    for p in ring {
        left.push_back(p);
        while let Some(at) = left
            .len()
            .checked_sub(2)
            .filter(|&at| is_spike(left.get(at.wrapping_sub(1)), left[at], p))
        {
            left.remove(at);
        }
    }
    // Where the ring closes.
    while left.len() > 1 {
        let last = left.len() - 1;
        if is_spike(Some(&left[last - 1]), left[last], left[0]) {
            left.pop_back();
        } else if is_spike(Some(&left[last]), left[0], left[1]) {
            left.pop_front();
        } else {
            break;
        }
    }
    if left.len() < 3 {
        Vec::new()
    } else {
        left.into()
    }
}

/// Returns true if a ring runs back over itself at `tip`, or stays there.
fn is_spike(before: Option<&[f64; 2]>, tip: [f64; 2], after: [f64; 2]) -> bool {
    let turns_back = |before: &[f64; 2]| {
        let is_beyond =
            |k: usize| before[k].max(after[k]) < tip[k] || tip[k] < before[k].min(after[k]);
        let is_straight = || turn(*before, tip, after) == Sign::Zero;
        (is_beyond(0) || is_beyond(1)) && is_straight()
    };
    tip == after || before.is_some_and(turns_back)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_encloses_nothing_is_left_out() {
        let of = |ring: &[[i32; 2]]| {
            let ring: Vec<[f64; 2]> = ring.iter().map(|p| p.map(f64::from)).collect();
            enclosing(plain(&ring))
                .iter()
                .map(|p| p.map(|c| c as i32))
                .collect::<Vec<_>>()
        };
        let [a, b, c, d] = [[0, 0], [4, 0], [4, 4], [0, 4]];
        let square = vec![a, b, c, d];
        assert_eq!(of(&square), square);
        assert_eq!(of(&[a, b, c, d, a]), square);
        assert_eq!(of(&[a, a, b, b, b, c, d, d, a, a]), square);
        // A spike between corners, in steps, with another one on it, and across the beginning.
        assert_eq!(of(&[a, b, c, [4, 9], [4, 6], c, d]), square);
        assert_eq!(of(&[a, b, [6, 2], [8, 4], [7, 3], b, c, d]), square);
        assert_eq!(of(&[a, b, [8, 0], [8, 3], [8, 0], b, c, d]), square);
        assert_eq!(of(&[[-3, -3], a, b, c, d, a]), square);
        assert_eq!(of(&[[-2, -2], a, b, c, d, a, [-1, -1], [-5, -5]]), square);
        // One that turns back on a side, and ends within it.
        assert_eq!(of(&[a, [9, 0], b, c, d]), square);
        assert_eq!(of(&[a, [3, 0], [1, 0], b, c, d]), [a, [1, 0], b, c, d]);
        // Straight sides keep their vertices.
        assert_eq!(of(&[a, [2, 0], b, c, d]), [a, [2, 0], b, c, d]);
        for none in [
            &[][..],
            &[a],
            &[a, a, a],
            &[a, b],
            &[a, b, a],
            &[a, [2, 2], c, [1, 1]],
            &[a, b, c, b],
            &[a, b, c, a, c, b],
        ] {
            assert!(of(none).is_empty(), "{none:?}");
        }
        assert_eq!(enclosing(vec![[f64::NAN, 0.0]; 2]).len(), 2);
    }
}
