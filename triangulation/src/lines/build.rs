//! Bulk construction from points and lines.
//!
//! 1. Points on one site become one vertex; vertices are numbered along a space filling curve.
//! 2. The segments of all lines, each once, are [arranged](crate::arrangement): crossings of the
//!    original segments are rounded, once, and segments bend to the sites whose pixels they meet.
//! 3. All sites are triangulated in bulk, and the parts of the segments are inserted as
//!    sub-constraints. On the grid they do not cross.
//!
//! If lines must not cross, step 2 is left out until some do: segments that do not cross are their
//! own arrangement.
//!
//! Every step depends on the set of points and segments only.

use std::sync::atomic::AtomicBool;

use rustc_hash::FxHashMap;

use crate::arrangement::Arrangement;
use crate::bulk::{Grain, Sites, Stop};
use crate::error::InputError;
use crate::geometry::{Coordinates, Crossing};
use crate::locate::Dice;
use crate::num::Sign;
use crate::tds::VertexId;

use super::chains::{LineVertices, segments_of, undirected};
use super::constrained_delaunay::ConstrainedDelaunay;
use super::on_crossing::{OnCrossing, Rounding};

/// How many triangles sub-constraints inserted in order may meet, for each vertex and each
/// sub-constraint. After that, the rest is inserted in random order: then all together meet O(n
/// log^2 n) triangles (Shewchuk and Brown 2015; Agarwal, Arge and Yi 2005). In order, each may meet
/// the triangles of all those next to it.
const PATIENCE: usize = 8;

impl<G: Crossing + Coordinates<3>> ConstrainedDelaunay<G> {
    /// Triangulates many points and lines; also returns the vertex of each point. A line is a list
    /// of points, named by their positions. It may touch itself and others, overlap, repeat, cross,
    /// close and double back. Points on one site share a vertex, which keeps the first of them. The
    /// ids of lines are their positions.
    ///
    /// The triangulation is a function of the set of points and the set of segments.
    ///
    /// # Errors
    /// If a point is refused, if a line names a point that does not exist, or, under
    /// [`OnCrossing::Reject`], if two segments cross. The error names the first of these by
    /// position.
    ///
    /// # Complexity
    /// O((n + k) log n) for k crossings, on all threads, and expected O(n log^2 n) for the
    /// segments, on one. Under [`OnCrossing::Reject`] crossings are only searched for if there are
    /// some.
    pub fn from_lines<L: AsRef<[u32]>>(
        geometry: G,
        points: &[G::Point],
        lines: &[L],
        on_crossing: OnCrossing,
    ) -> Result<(Self, Vec<VertexId>), InputError> {
        check_numbers(points.len(), lines)?;
        let (sites, mut vertices) = Sites::of(&geometry, points, Grain::default())?;
        if lines.is_empty() {
            return Ok((
                Self::from_sites(geometry, sites, Grain::default())?,
                vertices,
            ));
        }
        let named = |line: &L| LineVertices::of(line.as_ref(), |i| vertices[i as usize]);
        let lines = lines.iter().map(named).collect();
        let (triangulation, renumbered) =
            Self::from_sites_and_lines(geometry, sites, lines, on_crossing, Grain::default())?;
        if let Some(renumbered) = renumbered {
            vertices.iter_mut().for_each(|v| *v = renumbered[v.index()]);
        }
        Ok((triangulation, vertices))
    }

    /// Like [`from_lines`](Self::from_lines), but with payloads. `data` is called once for each
    /// vertex of a point, with the position of the first point at that vertex, in increasing order.
    /// Vertices of crossings have the default payload.
    ///
    /// # Errors
    /// See [`from_lines`](Self::from_lines).
    pub fn from_lines_with<L: AsRef<[u32]>, V: Default>(
        geometry: G,
        points: &[G::Point],
        lines: &[L],
        on_crossing: OnCrossing,
        data: impl FnMut(usize) -> V,
    ) -> Result<(ConstrainedDelaunay<G, V>, Vec<VertexId>), InputError> {
        let (ConstrainedDelaunay { inner, lines }, vertices) =
            Self::from_lines(geometry, points, lines, on_crossing)?;
        Ok((
            ConstrainedDelaunay {
                inner: inner.with_data_of_some(&vertices, data),
                lines,
            },
            vertices,
        ))
    }

    /// Triangulates sorted points and lines through them, for callers that have sorted and merged
    /// their points themselves. The points must be distinct and in
    /// [`spatial_order`](crate::spatial_order). Each line is a list of positions of points.
    ///
    /// Returns the vertex of each point if vertices had to be added where lines cross. Otherwise
    /// returns `None`, and the vertex of each point has the point's position as its number.
    ///
    /// The triangulation is that of [`from_lines`](Self::from_lines), which sorts and merges first.
    ///
    /// Set to true by any thread, `cancel` ends the work early.
    ///
    /// # Errors
    /// Those of [`from_lines`](Self::from_lines), [`InputError::Canceled`], and if a point does not
    /// come after the one before it. (For points that are one rounding apart this is not always
    /// detected; they must be distinct.)
    ///
    /// # Complexity
    /// That of [`from_lines`](Self::from_lines), without sorting: O((n + k) log n) for k crossings.
    pub fn from_sorted_lines<L: AsRef<[u32]>>(
        geometry: G,
        points: Vec<G::Point>,
        lines: &[L],
        on_crossing: OnCrossing,
        cancel: &AtomicBool,
    ) -> Result<(Self, Option<Vec<VertexId>>), InputError> {
        check_numbers(points.len(), lines)?;
        let sites = Sites::sorted(&geometry, points)?;
        let named = |line: &L| LineVertices::of(line.as_ref(), |i| VertexId::new(i as usize));
        let stop = Stop::new(cancel);
        let lines = lines.iter().map(named).collect();
        Self::from_sites_and_lines(geometry, sites, lines, on_crossing, Grain::until(&stop))
    }

    /// Triangulates sites and lines through them. If vertices had to be added, also returns the new
    /// number of each site.
    fn from_sites_and_lines(
        mut geometry: G,
        mut sites: Sites<G::Point>,
        mut lines: Vec<LineVertices>,
        on_crossing: OnCrossing,
        grain: Grain,
    ) -> Result<(Self, Option<Vec<VertexId>>), InputError> {
        if on_crossing == OnCrossing::Reject {
            let triangulation = Self::from_unarranged_lines(geometry, sites, lines, grain)?;
            if !triangulation.do_lines_cross() {
                return Ok((triangulation, None));
            }
            // The arrangement finds the first crossing, or that all are at vertices.
            let ConstrainedDelaunay {
                inner,
                lines: crossing,
            } = triangulation;
            lines = crossing.chains.given.into_iter().flatten().collect();
            geometry = inner.geometry;
            sites = Sites::sorted(&geometry, inner.points)?;
        }
        let index = |v: VertexId| v.index() as u32;
        let segments = segments_of(lines.iter().map(|line| &**line), index);
        let arrangement = {
            let position = |i: u32| geometry.plan(&sites.points[i as usize]);
            Arrangement::new(sites.points.len(), position, &segments, geometry.step())
        };
        if grain.stops() {
            return Err(InputError::Canceled);
        }
        if on_crossing == OnCrossing::Reject {
            reject(&geometry, &sites.points, &lines, &arrangement, &segments)?;
        }
        let (renumbered, added) = add_sites(&geometry, &mut sites, &arrangement, &segments)?;
        let vertex = |site: u32| match &renumbered {
            Some(renumbered) => renumbered[site as usize],
            None => VertexId::new(site as usize),
        };
        if let Some(renumbered) = &renumbered {
            lines
                .iter_mut()
                .flat_map(|line| line.iter_mut())
                .for_each(|v| *v = renumbered[v.index()]);
        }

        let mut triangulation = Self::from_sites(geometry, sites, grain)?;
        if grain.stops() {
            return Err(InputError::Canceled);
        }
        triangulation.lines.chains.given = lines.into_iter().map(Some).collect();
        triangulation.lines.added = added.into_iter().collect();
        let parts = triangulation
            .lines
            .chains
            .record(&arrangement, &segments, vertex);
        triangulation.lines.rounding = Rounding::of(&arrangement);
        let crossing = triangulation.constrain_all(parts, grain);
        if grain.is_stopped() {
            return Err(InputError::Canceled);
        }
        if !crossing.is_empty() {
            triangulation.rearrange();
            triangulation.lines.rearrangements = 0;
        }
        Ok((triangulation, renumbered))
    }

    /// Triangulates sites and lines through them, without an arrangement. If lines
    /// [cross](Self::do_lines_cross), the result is not the triangulation of an arrangement.
    fn from_unarranged_lines(
        geometry: G,
        sites: Sites<G::Point>,
        lines: Vec<LineVertices>,
        grain: Grain,
    ) -> Result<Self, InputError> {
        let segments = segments_of(lines.iter().map(|line| &**line), |v| v);
        let mut triangulation = Self::from_sites(geometry, sites, grain)?;
        if grain.stops() {
            return Err(InputError::Canceled);
        }
        triangulation.lines.chains.given = lines.into_iter().map(Some).collect();
        triangulation.lines.missing = triangulation.constrain_all(segments, grain);
        if grain.is_stopped() {
            return Err(InputError::Canceled);
        }
        Ok(triangulation)
    }

    /// Returns true if segments that were not arranged cross, at a vertex or elsewhere.
    fn do_lines_cross(&self) -> bool {
        let mut split: FxHashMap<VertexId, [VertexId; 2]> = FxHashMap::default();
        let mut parts = self.lines.chains.splits.iter();
        let is_crossing = |(&part, &at): (&[VertexId; 2], &VertexId)| {
            let [a, b] = *split.entry(at).or_insert(part);
            self.inner.turn(a, b, part[0]) != Sign::Zero
        };
        !self.lines.missing.is_empty() || parts.any(is_crossing)
    }
}

/// The number of sub-constraints inserted between two checks of the flag that cancels the work.
const LOOK_EVERY: usize = 1 << 8;

/// Returns an error if a line names a point that does not exist.
fn check_numbers<L: AsRef<[u32]>>(points: usize, lines: &[L]) -> Result<(), InputError> {
    for (line, numbers) in lines.iter().enumerate() {
        if let Some(&index) = numbers.as_ref().iter().find(|&&i| i as usize >= points) {
            return Err(InputError::Index { line, index });
        }
    }
    Ok(())
}

impl<G: Crossing, V: Default, C: Copy + Default> ConstrainedDelaunay<G, V, C> {
    /// Inserts sub-constraints. Returns those that cross others; they are present up to the first
    /// crossing only. Ends early if the flag of `grain` is set.
    pub(crate) fn constrain_all(
        &mut self,
        mut parts: Vec<[VertexId; 2]>,
        grain: Grain,
    ) -> Vec<[VertexId; 2]> {
        if self.dimension() < 2 {
            self.lines.waiting = parts;
            // The vertices that split them, when there were triangles, may be removed.
            self.lines.chains.splits.clear();
            return Vec::new();
        }
        // Sub-constraints next to each other are inserted one after the other, until that has taken
        // too long.
        let enough = self.lines.buffers.met + PATIENCE * (self.vertex_count() + parts.len());
        let mut crossing = Vec::new();
        let mut dice = Dice::default();
        for next in 0..parts.len() {
            if next.is_multiple_of(LOOK_EVERY) && grain.stops() {
                break;
            }
            if self.lines.buffers.met > enough {
                let left = parts.len() - next;
                parts.swap(next, next + dice.below(left));
            }
            let [a, b] = parts[next];
            if !self.lines.constrain(&mut self.inner, a, b) {
                crossing.push([a, b]);
            }
        }
        crossing.sort_unstable();
        crossing
    }

    /// Returns how the crossings of lines were rounded; `None` if none cross.
    pub fn rounding(&self) -> Option<Rounding> {
        self.lines.rounding
    }
}

/// Returns an error if two segments cross, except at a vertex that is already on both.
fn reject<G: Crossing>(
    geometry: &G,
    sites: &[G::Point],
    lines: &[LineVertices],
    arrangement: &Arrangement,
    segments: &[[u32; 2]],
) -> Result<(), InputError> {
    for crossing in arrangement.crossings() {
        let ends = crossing.segments.map(|i| segments[i as usize]);
        let [ab, cd] = ends.map(|ends| ends.map(|site| &sites[site as usize]));
        let is_on = |[p, q]: [&G::Point; 2], x| geometry.orientation([p, q, x]) == Sign::Zero;
        let [chain, other] = crossing.segments.map(|i| arrangement.chain(i));
        let is_vertex = |site: &u32| {
            other.contains(site)
                && sites
                    .get(*site as usize)
                    .is_some_and(|x| is_on(ab, x) && is_on(cd, x))
        };
        if !chain.iter().any(is_vertex) {
            let at = geometry.plan(&geometry.crossing(ab, cd));
            return Err(InputError::Crossing {
                segments: ends.map(|segment| find(lines, segment)),
                at,
            });
        }
    }
    Ok(())
}

/// Returns the first line that contains a segment, and the segment's position in it.
fn find(lines: &[LineVertices], segment: [u32; 2]) -> (usize, usize) {
    let segment = segment.map(|site| VertexId::new(site as usize));
    let in_line = |line: &[VertexId]| {
        line.windows(2)
            .position(|pair| undirected(pair[0], pair[1]) == segment)
    };
    let mut found = lines
        .iter()
        .enumerate()
        .filter_map(|(i, line)| Some((i, in_line(line)?)));
    found.next().unwrap_or_default()
}

/// Returns the points that the geometry makes of the sites added by an arrangement, given the
/// points of the others.
pub(crate) fn points_added<G: Crossing>(
    geometry: &G,
    arrangement: &Arrangement,
    segments: &[[u32; 2]],
    point: impl Fn(u32) -> G::Point,
) -> Vec<G::Point> {
    let through = arrangement.through_added();
    let mut rest = &through[..];
    let mut ends: Vec<[G::Point; 2]> = Vec::new();
    let meet = |(added, &position): (usize, &[f64; 2])| {
        let (here, others) =
            rest.split_at(rest.partition_point(|&(other, _)| other as usize <= added));
        rest = others;
        ends.clear();
        ends.extend(here.iter().map(|&(_, i)| segments[i as usize].map(&point)));
        match &ends[..] {
            [[a, b], [c, d]] => geometry.meet(position, &[[a, b], [c, d]]), // nearly always
            ends => geometry.meet(
                position,
                &ends.iter().map(|ends| ends.each_ref()).collect::<Vec<_>>(),
            ),
        }
    };
    arrangement.added().iter().enumerate().map(meet).collect()
}

/// Merges the sites added by an arrangement into the given ones, which are in spatial order, as
/// points of the geometry. Returns the new number of every site, if any were added, and the
/// vertices of the added ones.
fn add_sites<G: Crossing + Coordinates<3>>(
    geometry: &G,
    sites: &mut Sites<G::Point>,
    arrangement: &Arrangement,
    segments: &[[u32; 2]],
) -> Result<(Option<Vec<VertexId>>, Vec<VertexId>), InputError> {
    if arrangement.added().is_empty() {
        return Ok((None, Vec::new()));
    }
    let mut all = std::mem::take(&mut sites.points);
    let given = all.len();
    let added = points_added(geometry, arrangement, segments, |site| all[site as usize]);
    all.extend(added);
    // An arrangement adds no site where a given point is, so all of them are distinct.
    let (merged, renumbered) = Sites::of(geometry, &all, Grain::default())?;
    *sites = merged;
    let mut added = renumbered[given..].to_vec();
    added.sort_unstable();
    Ok((Some(renumbered), added))
}
