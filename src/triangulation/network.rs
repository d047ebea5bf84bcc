//! Points and lines, triangulated at once.
//!
//! 1. Points on one site become one vertex; vertices are numbered along a space filling curve.
//! 2. The lines' segments, each once, are [arranged](crate::arrangement): crossings of the originals are rounded, once,
//!    and segments led through the sites of their pixels.
//! 3. All sites are triangulated in bulk, and the pieces of the segments forced in. They do not cross, on the grid.
//!
//! Every step depends on the set of points and segments only.

use crate::arrangement::{Arrangement, through_site};
use crate::geometry::{Coordinates, Crossing};
use crate::num::Sign;
use crate::tds::VertexId;

use super::bulk::{Grain, Sites};
use super::lines::undirected;
use super::{ConstrainedDelaunay, Refused, spatial_order};

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
pub struct Rounding {
    /// The unit of the grid, on each axis: the last place of the largest coordinate of a line's vertex.
    pub unit: [f64; 2],
    /// Whether all vertices of lines lie on the grid, and all points on lines that cross others. Then no line is displaced by more than half a unit on
    /// each axis, proven.
    pub on_grid: bool,
}

/// Lines as vertices in a row each.
pub(crate) type VertexLines = Vec<Box<[VertexId]>>;

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
    /// O(n log n), on all threads, and for each segment the square of the triangles that it crosses.
    pub fn from_lines<L: AsRef<[u32]>>(
        geometry: G,
        points: &[G::Point],
        lines: &[L],
        on_crossing: OnCrossing,
    ) -> Result<(Self, Vec<VertexId>), Refused> {
        for (line, indexes) in lines.iter().enumerate() {
            if let Some(&index) = indexes.as_ref().iter().find(|&&i| i as usize >= points.len()) {
                return Err(Refused::Index { line, index });
            }
        }
        let (sites, mut vertices) = Sites::of(&geometry, points, Grain::default())?;
        if lines.is_empty() {
            return Ok((Self::from_sites(geometry, sites), vertices));
        }
        let named = |line: &L| line.as_ref().iter().map(|&i| vertices[i as usize]).collect();
        let lines = lines.iter().map(named).collect();
        let (triangulation, renumbered) = Self::from_sorted_lines(geometry, sites, lines, on_crossing)?;
        if let Some(renumbered) = renumbered {
            vertices.iter_mut().for_each(|v| *v = renumbered[v.index()]);
        }
        Ok((triangulation, vertices))
    }

    /// Triangulates points that are all different and in spatial order, and lines through them. Where vertices had to
    /// be added, the new number of each point is returned.
    pub(crate) fn from_sorted_lines(
        geometry: G,
        mut sites: Sites<G::Point>,
        mut lines: VertexLines,
        on_crossing: OnCrossing,
    ) -> Result<(Self, Option<Vec<VertexId>>), Refused> {
        let segments = segments_of(&lines);
        let arrangement = Arrangement::new(sites.points.len(), |i| geometry.plan(&sites.points[i as usize]), &segments);
        if on_crossing == OnCrossing::Reject {
            reject(&geometry, &sites.points, &lines, &arrangement, &segments)?;
        }
        let (renumbered, added) = add_sites(&geometry, &mut sites, &arrangement, &segments)?;
        let vertex = |site: u32| match &renumbered {
            Some(renumbered) => renumbered[site as usize],
            None => VertexId::new(site as usize),
        };
        if let Some(renumbered) = &renumbered {
            lines.iter_mut().flatten().for_each(|v| *v = renumbered[v.index()]);
        }

        let mut triangulation = Self::from_sites(geometry, sites);
        let mut pieces = Vec::with_capacity(segments.len());
        for (i, &[a, b]) in segments.iter().enumerate() {
            let between = arrangement.chain(i as u32);
            let mut at = a;
            for &site in between.iter().chain([&b]) {
                pieces.push(undirected(vertex(at), vertex(site)));
                at = site;
            }
            if arrangement.is_led(i as u32) {
                let [a, b] = [a, b].map(vertex);
                let mut sites: Box<[VertexId]> = between.iter().map(|&site| vertex(site)).collect();
                if a > b {
                    sites.reverse();
                }
                triangulation.lines.led.insert(undirected(a, b), sites);
            }
        }
        triangulation.lines.given = lines.into_iter().map(Some).collect();
        triangulation.crossings = added;
        if !arrangement.crossings().is_empty() {
            triangulation.rounding = Some(Rounding { unit: arrangement.unit(), on_grid: arrangement.is_on_grid() });
        }
        drop(arrangement);
        pieces.sort_unstable();
        pieces.dedup();
        for [a, b] in pieces {
            triangulation.insert_piece(a, b);
        }
        if triangulation.tangled {
            triangulation.rearrange();
        }
        Ok((triangulation, renumbered))
    }

    /// How the crossings of lines were rounded; `None` if none cross.
    pub fn rounding(&self) -> Option<Rounding> {
        self.rounding
    }
}

/// Refuses crossings, but those at which there is a vertex on both segments already.
fn reject<G: Crossing>(
    geometry: &G,
    sites: &[G::Point],
    lines: &VertexLines,
    arrangement: &Arrangement,
    segments: &[[u32; 2]],
) -> Result<(), Refused> {
    for crossing in arrangement.crossings() {
        let ends = crossing.segments.map(|i| segments[i as usize]);
        let [ab, cd] = ends.map(|ends| ends.map(|site| &sites[site as usize]));
        let is_on = |[p, q]: [&G::Point; 2], x| geometry.orientation([p, q, x]) == Sign::Zero;
        let [chain, other] = crossing.segments.map(|i| arrangement.chain(i));
        let is_vertex = |site: &u32| {
            other.contains(site) && sites.get(*site as usize).is_some_and(|x| is_on(ab, x) && is_on(cd, x))
        };
        if !chain.iter().any(is_vertex) {
            let place = geometry.plan(&geometry.crossing(ab, cd));
            return Err(Refused::Crossing { segments: ends.map(|segment| find(lines, segment)), place });
        }
    }
    Ok(())
}

/// Each segment of the lines once, from the smaller number to the larger, in order.
fn segments_of(lines: &VertexLines) -> Vec<[u32; 2]> {
    let pairs = lines.iter().flat_map(|line| line.windows(2)).filter(|pair| pair[0] != pair[1]);
    let mut segments: Vec<[u32; 2]> =
        pairs.map(|pair| undirected(pair[0], pair[1]).map(|v| v.index() as u32)).collect();
    segments.sort_unstable();
    segments.dedup();
    segments
}

/// The first line with a segment, and its position in the line.
fn find(lines: &VertexLines, segment: [u32; 2]) -> (usize, usize) {
    let segment = segment.map(|site| VertexId::new(site as usize));
    let in_line = |line: &[VertexId]| line.windows(2).position(|pair| undirected(pair[0], pair[1]) == segment);
    let mut found = lines.iter().enumerate().filter_map(|(i, line)| Some((i, in_line(line)?)));
    found.next().unwrap_or_default()
}

/// Puts the added sites among the given ones, which come in spatial order, as points of the geometry. Returns the number
/// of every site then, if there were any to add; and the numbers of those that are new.
fn add_sites<G: Crossing + Coordinates<3>>(
    geometry: &G,
    sites: &mut Sites<G::Point>,
    arrangement: &Arrangement,
    segments: &[[u32; 2]],
) -> Result<(Option<Vec<VertexId>>, Vec<VertexId>), Refused> {
    if arrangement.added().is_empty() {
        return Ok((None, Vec::new()));
    }
    let mut all = std::mem::take(&mut sites.points);
    let given = all.len() as u32;
    let through = arrangement.through_added();
    let mut met = Vec::new();
    for (i, &place) in arrangement.added().iter().enumerate() {
        let here = through_site(&through, given + i as u32);
        met.clear();
        met.extend(here.iter().map(|&(_, segment)| segments[segment as usize].map(|end| all[end as usize])));
        let segments: Vec<[&G::Point; 2]> = met.iter().map(|ends| ends.each_ref()).collect();
        let p = geometry.meet(place, &segments);
        all.push(p);
    }
    let order = spatial_order(all.len(), |i| geometry.coordinates(&all[i]))?;
    let mut sorted: Vec<G::Point> = Vec::with_capacity(all.len());
    let mut renumbered = vec![VertexId::INFINITE; all.len()];
    let mut added = Vec::new();
    for index in order {
        // Equal places are in the order of their numbers: what was given stands.
        let p = all[index as usize];
        if sorted.last().is_none_or(|site| geometry.compare(site, &p).is_ne()) {
            added.extend((index >= given).then(|| VertexId::new(sorted.len())));
            sorted.push(p);
        }
        renumbered[index as usize] = VertexId::new(sorted.len() - 1);
    }
    *sites = Sites::sorted(geometry, sorted)?;
    Ok((Some(renumbered), added))
}
