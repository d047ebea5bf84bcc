//! Points and lines, triangulated at once.
//!
//! 1. Points on one site become one vertex; vertices are numbered along a space filling curve.
//! 2. The lines' segments, each once, are [arranged](crate::arrangement): crossings of the originals are rounded, once,
//!    and segments led through the sites of their pixels.
//! 3. All sites are triangulated in bulk, and the pieces of the segments forced in. They do not cross, on the grid.
//!
//! Every step depends on the set of points and segments only.

use crate::arrangement::Arrangement;
use crate::geometry::{Coordinates, Crossing};
use crate::num::Sign;
use crate::tds::VertexId;

use super::super::bulk::{Grain, Sites};
use super::super::locate::Dice;
use super::super::{ConstrainedDelaunay, InputError};
use super::paths::{LineVertices, segments_of, undirected};

/// So many triangles may be met, for each vertex and each piece, by pieces that are joined in order; the rest is joined
/// in random order: then all of them meet O(n log^2 n) (Shewchuk and Brown 2015; Agarwal, Arge and Yi 2005), where in
/// order each may meet all of those beside it.
const PATIENCE: usize = 8;

/// What becomes of lines that cross between their vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OnCrossing {
    /// Nothing is triangulated; the first crossing is told.
    Reject,
    /// They get a common vertex, rounded to the grid.
    #[default]
    Split,
}

/// How the crossings of lines were rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Rounding {
    /// The unit of the grid, on each axis: the last place of the largest coordinate of a line's vertex.
    pub unit: [f64; 2],
    /// Whether all vertices of lines lie on the grid, and all points on lines that cross others. Then no line is
    /// displaced by more than half a unit on each axis, proven.
    pub on_grid: bool,
}

impl<G: Crossing + Coordinates<3>, V: Default> ConstrainedDelaunay<G, V> {
    /// Triangulates many points and lines. A line is a list of points, by their positions; it may touch itself and
    /// others, overlap, repeat, cross, close, double back. Returns the vertex of each point beside; points on one
    /// site share theirs (the first of them stands). The lines' ids are their positions.
    ///
    /// The triangulation is a function of the set of points and the set of segments.
    ///
    /// # Errors
    /// The first point that is refused, the first line that names no point, or, under
    /// [`OnCrossing::Reject`], two segments that cross; by their positions.
    ///
    /// # Complexity
    /// O((n + k) log n) for k crossings, on all threads, and expected O(n log^2 n) for the segments, on one.
    pub fn from_lines<L: AsRef<[u32]>>(
        geometry: G,
        points: &[G::Point],
        lines: &[L],
        on_crossing: OnCrossing,
    ) -> Result<(Self, Vec<VertexId>), InputError> {
        check_numbers(points.len(), lines)?;
        let (sites, mut vertices) = Sites::of(&geometry, points, Grain::default())?;
        if lines.is_empty() {
            return Ok((Self::from_sites(geometry, sites), vertices));
        }
        let named = |line: &L| LineVertices::of(line.as_ref(), |i| vertices[i as usize]);
        let lines = lines.iter().map(named).collect();
        let (triangulation, renumbered) = Self::from_sites_and_lines(geometry, sites, lines, on_crossing)?;
        if let Some(renumbered) = renumbered {
            vertices.iter_mut().for_each(|v| *v = renumbered[v.index()]);
        }
        Ok((triangulation, vertices))
    }

    /// Triangulates points that are all different and in [`spatial_order`](super::super::spatial_order) already, and lines
    /// through them, each the numbers of its points: for those who have sorted and merged their points themselves.
    ///
    /// Returns the vertex of each point, if vertices had to be added where lines cross; else `None`: the vertex of each
    /// point has the point's number.
    ///
    /// The triangulation is that of [`from_lines`](Self::from_lines), which sorts and merges first.
    ///
    /// # Errors
    /// Those of [`from_lines`](Self::from_lines); and the first point that does not come after the one before it. (Of
    /// points a rounding apart that does not always show: they have to be all different.)
    ///
    /// # Complexity
    /// That of [`from_lines`](Self::from_lines), without sorting: O((n + k) log n) for k crossings.
    pub fn from_sorted_lines<L: AsRef<[u32]>>(
        geometry: G,
        points: Vec<G::Point>,
        lines: &[L],
        on_crossing: OnCrossing,
    ) -> Result<(Self, Option<Vec<VertexId>>), InputError> {
        check_numbers(points.len(), lines)?;
        let sites = Sites::sorted(&geometry, points)?;
        let named = |line: &L| LineVertices::of(line.as_ref(), |i| VertexId::new(i as usize));
        Self::from_sites_and_lines(geometry, sites, lines.iter().map(named).collect(), on_crossing)
    }

    /// Triangulates sites and lines through them. Where vertices had to be added, the new number of each site is
    /// returned.
    fn from_sites_and_lines(
        geometry: G,
        mut sites: Sites<G::Point>,
        mut lines: Vec<LineVertices>,
        on_crossing: OnCrossing,
    ) -> Result<(Self, Option<Vec<VertexId>>), InputError> {
        let index = |v: VertexId| v.index() as u32;
        let segments = segments_of(lines.iter().map(|line| &**line), index);
        let arrangement = {
            let position = |i: u32| geometry.plan(&sites.points[i as usize]);
            Arrangement::new(sites.points.len(), position, &segments, geometry.step())
        };
        if on_crossing == OnCrossing::Reject {
            reject(&geometry, &sites.points, &lines, &arrangement, &segments)?;
        }
        let (renumbered, added) = add_sites(&geometry, &mut sites, &arrangement, &segments)?;
        let vertex = |site: u32| match &renumbered {
            Some(renumbered) => renumbered[site as usize],
            None => VertexId::new(site as usize),
        };
        if let Some(renumbered) = &renumbered {
            lines.iter_mut().flat_map(|line| line.iter_mut()).for_each(|v| *v = renumbered[v.index()]);
        }

        let mut triangulation = Self::from_sites(geometry, sites);
        triangulation.lines.paths.given = lines.into_iter().map(Some).collect();
        triangulation.lines.added = added.into_iter().collect();
        let parts = triangulation.lines.paths.record(&arrangement, &segments, vertex);
        if !triangulation.constrain_all(parts, &arrangement).is_empty() {
            triangulation.rearrange();
            triangulation.lines.rearrangements = 0;
        }
        Ok((triangulation, renumbered))
    }
}

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
    /// Puts in the pieces of an arrangement. Returns those that cross others, which are there up to the first crossing
    /// only.
    pub(in super::super) fn constrain_all(
        &mut self,
        mut parts: Vec<[VertexId; 2]>,
        arrangement: &Arrangement,
    ) -> Vec<[VertexId; 2]> {
        self.lines.rounding = (!arrangement.crossings().is_empty())
            .then(|| Rounding { unit: arrangement.unit(), on_grid: arrangement.is_on_grid() });
        if self.dimension() < 2 {
            self.lines.waiting = parts;
            // What lay between their ends, when there were triangles, may go.
            self.lines.paths.splits.clear();
            return Vec::new();
        }
        // Pieces next to each other are joined one after the other, until that has taken its time.
        let enough = self.lines.scratch.met + PATIENCE * (self.vertex_count() + parts.len());
        let mut crossing = Vec::new();
        let mut dice = Dice::default();
        for next in 0..parts.len() {
            if self.lines.scratch.met > enough {
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

    /// How the crossings of lines were rounded; `None` if none cross.
    pub fn rounding(&self) -> Option<Rounding> {
        self.lines.rounding
    }
}

/// Refuses crossings, but those at which there is a vertex on both segments already.
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
            other.contains(site) && sites.get(*site as usize).is_some_and(|x| is_on(ab, x) && is_on(cd, x))
        };
        if !chain.iter().any(is_vertex) {
            let at = geometry.plan(&geometry.crossing(ab, cd));
            return Err(InputError::Crossing { segments: ends.map(|segment| find(lines, segment)), at });
        }
    }
    Ok(())
}

/// The first line with a segment, and its position in the line.
fn find(lines: &[LineVertices], segment: [u32; 2]) -> (usize, usize) {
    let segment = segment.map(|site| VertexId::new(site as usize));
    let in_line = |line: &[VertexId]| line.windows(2).position(|pair| undirected(pair[0], pair[1]) == segment);
    let mut found = lines.iter().enumerate().filter_map(|(i, line)| Some((i, in_line(line)?)));
    found.next().unwrap_or_default()
}

/// What the geometry makes of the sites that an arrangement has added, given the points at the others.
pub(in super::super) fn points_added<G: Crossing>(
    geometry: &G,
    arrangement: &Arrangement,
    segments: &[[u32; 2]],
    point: impl Fn(u32) -> G::Point,
) -> Vec<G::Point> {
    let through = arrangement.through_added();
    let mut rest = &through[..];
    let mut ends: Vec<[G::Point; 2]> = Vec::new();
    let meet = |(added, &position): (usize, &[f64; 2])| {
        let (here, others) = rest.split_at(rest.partition_point(|&(other, _)| other as usize <= added));
        rest = others;
        ends.clear();
        ends.extend(here.iter().map(|&(_, i)| segments[i as usize].map(&point)));
        match &ends[..] {
            [[a, b], [c, d]] => geometry.meet(position, &[[a, b], [c, d]]), // nearly always
            ends => geometry.meet(position, &ends.iter().map(|ends| ends.each_ref()).collect::<Vec<_>>()),
        }
    };
    arrangement.added().iter().enumerate().map(meet).collect()
}

/// Puts the added sites among the given ones, which come in spatial order, as points of the geometry. Returns the
/// number of every site then, if there were any to add; and the numbers of those that are new.
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
    // Where a given point is, an arrangement adds none: all are different.
    let (merged, renumbered) = Sites::of(geometry, &all, Grain::default())?;
    *sites = merged;
    let mut added = renumbered[given..].to_vec();
    added.sort_unstable();
    Ok((Some(renumbered), added))
}
