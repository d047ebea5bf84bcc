//! Surfaces of fewer vertices, within a bound of all heights they are made from.
//!
//! Some of the given sites stay; neither they nor their heights are changed. In blocks, sites are
//! inserted where the error is largest until the bound holds (Garland and Heckbert 1995, "Fast
//! polygonal approximation of terrains and height fields"), then removed again, the cheapest first,
//! as long as it still holds. The blocks are joined by one triangulation of all that is left; what
//! is too far off there is inserted, and what the blocks needed only at their borders is removed.
//! At the end every site is measured against the finished surface, exactly where rounding could
//! decide.
//!
//! Each step is a function of the set of sites, so that neither their order nor the number of
//! threads shows in the result.

mod core;
mod edit;
mod error;
mod intake;
mod lattice;
mod lines;
mod mesh;
mod sites;
mod star;
#[cfg(test)]
mod tests;
mod verify;

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use rustc_hash::FxHashSet;

use self::core::{Refused, choose, choose_all};
use self::intake::Intake;
use self::lines::{EdgeRole, Lines};
use self::sites::Sites;
use super::Tin;
use super::lines::kinds::LineKinds;
use super::tin_report::TinReport;
use crate::crs::Crs;
use crate::data::{Grid, Surface};
use crate::error::{Error, Result, Setting, wording};
use crate::triangulation::geometry::Terrain;
use crate::triangulation::kernel::RANGE;
use crate::triangulation::tds::{CellId, ccw, cw};
use crate::triangulation::{ConstrainedDelaunay, InputError, LineId, OnCrossing};

/// How far a surface is simplified.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum SimplifyLimit {
    /// As few vertices as are found such that no given height is further from the surface than
    /// this, in units of height.
    MaxError(f64),
    /// At most so many vertices, with as small a bound as is found for them.
    Target(u64),
}

/// What is simplified to which limit.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SimplifyRule {
    /// The bound, or the number of vertices.
    pub limit: SimplifyLimit,
    /// How far, in plan and in its units, a vertex that is removed from a line may be from the line
    /// without it. `None` is the bound, or 0 in degrees.
    pub line_tolerance: Option<f64>,
}

/// What became of a surface that was simplified.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SimplifyReport {
    /// The number of heights that the surface was measured against: all that were given.
    pub sites: usize,
    /// The vertices of the surface.
    pub vertices: usize,
    /// The bound that holds for each of the heights, in units of height.
    pub bound: f64,
    /// The largest distance of a height from the surface, in units of height.
    pub largest: f64,
    /// The root of the mean square of the distances, in units of height.
    pub root_mean_square: f64,
    /// The vertices on lines that were given, and those of them that are left. The rim does not
    /// count.
    pub line_vertices: [usize; 2],
}

/// How many bounds are tried at most for a number of vertices.
const TRIES: usize = 24;

/// How near to a number of vertices is near enough, as a share of it.
const NEAR: f64 = 0.01;

/// Simplifies a surface of triangles. Its lines and its rim stay, with fewer vertices.
///
/// A vertex of a line is removed only if it is within the tolerance of what is left of the line,
/// and no point changes sides. A vertex of the rim is removed only if it is exactly on what is left
/// of the rim.
/// The bound holds at all vertices of the surface.
///
/// # Errors
/// If the bound is not positive, a coordinate is not in [`RANGE`], two vertices in one position
/// have different heights, lines cross without a vertex, or the run is canceled.
///
/// # Complexity
/// O(n log n) in practice; the blocks on all threads. About 150 bytes for each vertex.
pub fn simplify(
    surface: &dyn Surface,
    rule: &SimplifyRule,
    cancel: &AtomicBool,
) -> Result<(Tin, SimplifyReport)> {
    rule.check()?;
    let crs = surface.crs().cloned();
    simplified(&intake::of_triangles(surface)?, crs, rule, cancel)
}

/// Like [`simplify`], for the cells of a raster: each cell is a height at its center. The rim runs
/// around the cells with heights, as in contours of a raster.
///
/// # Errors
/// Those of [`simplify`], and if the raster is rotated, has no cells or is too large.
///
/// # Complexity
/// O(n log n) for n cells in practice; the blocks on all threads.
pub fn simplify_cells(
    grid: &Grid,
    rule: &SimplifyRule,
    cancel: &AtomicBool,
) -> Result<(Tin, SimplifyReport)> {
    rule.check()?;
    simplified(&intake::of_cells(grid)?, grid.crs.clone(), rule, cancel)
}

fn simplified(
    Intake { sites, lines }: &Intake,
    crs: Option<Crs>,
    rule: &SimplifyRule,
    cancel: &AtomicBool,
) -> Result<(Tin, SimplifyReport)> {
    let run = Run {
        sites,
        lines,
        is_in_degrees: crs.as_ref().is_some_and(|crs| crs.length_unit().is_none()),
        crs,
        rule,
        cancel,
    };
    match rule.limit {
        SimplifyLimit::MaxError(bound) => run.within(bound),
        SimplifyLimit::Target(target) => run.of_vertices(target as usize),
    }
}

/// Chooses vertices among positions that are sorted by x, then y, each of which is there once:
/// those that `stay`, the corners of the hull, and as few others as are found such that no height
/// is further than the bound from the Delaunay triangulation of all that are chosen. Returns these
/// in their order.
///
/// # Errors
/// If there are too many positions, or the run is canceled.
pub(super) fn choose_around(
    positions: Vec<[f64; 3]>,
    stay: &[u32],
    bound: f64,
    cancel: &AtomicBool,
) -> Result<Vec<[f64; 3]>> {
    let sites = Sites::scattered(positions).map_err(|e| not_chosen(Refused::Input(e)))?;
    let chosen = choose_all(&sites, stay, bound, cancel).map_err(not_chosen)?;
    Ok(chosen.iter().map(|&site| sites.position(site)).collect())
}

impl SimplifyRule {
    /// Returns an error if the limit makes no sense, whatever the surface is.
    ///
    /// # Errors
    /// Names the setting.
    pub fn check(&self) -> Result<()> {
        let is_bound = |bound: f64| bound > 0.0 && RANGE.admits(bound);
        match self.limit {
            SimplifyLimit::MaxError(bound) if !is_bound(bound) => Err(Error::usage(format!(
                "{bound} is not a bound of errors: a height above 0 is needed"
            ))
            .cure(wording![
                "pass ",
                Setting::MaxError.number("HEIGHT"),
                "; the points themselves are the surface without an error"
            ])),
            SimplifyLimit::Target(target) if target < 3 => Err(Error::usage(format!(
                "a surface of {target} vertices does not exist"
            ))
            .cure(wording!["pass a ", Setting::Target, " of 3 or more"])),
            _ => match self.line_tolerance {
                Some(tolerance) if !(tolerance >= 0.0 && tolerance.is_finite()) => {
                    Err(Error::usage(format!(
                        "{tolerance} is not a tolerance of lines: 0 or a length is needed"
                    )))
                }
                _ => Ok(()),
            },
        }
    }
}

/// What stays the same where several bounds are tried.
struct Run<'a> {
    sites: &'a Sites,
    lines: &'a Lines,
    crs: Option<Crs>,
    is_in_degrees: bool,
    rule: &'a SimplifyRule,
    cancel: &'a AtomicBool,
}

/// The sites that stay for a bound, and the lines between them.
struct Chosen {
    bound: f64,
    sites: Vec<u32>,
    lines: Lines,
}

impl Run<'_> {
    fn choose(&self, bound: f64) -> Result<Chosen> {
        let default = if self.is_in_degrees { 0.0 } else { bound };
        let tolerance = self.rule.line_tolerance.unwrap_or(default);
        let mut lines = self.lines.with_tolerance(tolerance);
        let sites = choose(self.sites, &mut lines, bound, self.cancel).map_err(not_chosen)?;
        Ok(Chosen {
            bound,
            sites,
            lines,
        })
    }

    fn within(&self, bound: f64) -> Result<(Tin, SimplifyReport)> {
        self.finish(self.choose(bound)?)
    }

    /// The smallest bound that is found for a number of vertices: by the slope of their logarithms,
    /// and by halves where that does not help.
    fn of_vertices(&self, target: usize) -> Result<(Tin, SimplifyReport)> {
        let range = self.sites.range_of_heights();
        // Bounds that were tried, with too many vertices and with few enough.
        let (mut low, mut high): (Option<(f64, f64)>, Option<Chosen>) = (None, None);
        // Below this, a bound is as good as none.
        let least = (range * 1e-12).max(RANGE.min.sqrt());
        let mut bound = (range / 100.0).max(least);
        // Few steps lead down to the least, where the target is near the number of sites.
        let mut step = 4.0;
        for _ in 0..TRIES {
            let chosen = self.choose(bound)?;
            let count = chosen.sites.len() as f64;
            if chosen.sites.len() > target {
                low = Some((bound, count));
            } else {
                high = Some(chosen);
            }
            let enough = high
                .as_ref()
                .map(|high| (high.bound, high.sites.len() as f64));
            bound = match (low, enough) {
                (Some((low, _)), None) => {
                    if low > 2.0 * range {
                        break;
                    }
                    low * 4.0
                }
                (None, Some((high, count))) => {
                    if count >= target as f64 * (1.0 - NEAR) || high <= least {
                        break;
                    }
                    let smaller = (high / step).max(least);
                    step *= step;
                    smaller
                }
                (Some((low, more)), Some((high, fewer))) => {
                    if fewer >= target as f64 * (1.0 - NEAR) || high <= low * (1.0 + NEAR / 10.0) {
                        break;
                    }
                    between(
                        [low, more],
                        [high, fewer],
                        target as f64 * (1.0 - NEAR / 2.0),
                    )
                }
                (None, None) => break,
            };
        }
        match high {
            Some(chosen) => self.finish(chosen),
            None => Err(Error::usage(format!(
                "no surface of {target} vertices was found: its lines and its rim need more, {} are left within {:.3}",
                low.map_or(0.0, |(_, count)| count),
                low.map_or(0.0, |(bound, _)| bound),
            ))
            .cure(wording!["pass a larger ", Setting::Target])),
        }
    }

    /// Builds the surface, and measures it. What was wrongly judged before is inserted: such are
    /// errors of the last bit between a raster and its positions.
    fn finish(&self, mut chosen: Chosen) -> Result<(Tin, SimplifyReport)> {
        loop {
            let (tin, site_of) = self.build(&chosen)?;
            edit::go_on(self.cancel).map_err(|canceled| not_chosen(canceled.into()))?;
            let distances = verify::measure(self.sites, &tin, &site_of, chosen.bound);
            let before = chosen.sites.len();
            chosen.sites.extend(distances.beyond);
            chosen.sites.sort_unstable();
            chosen.sites.dedup();
            if chosen.sites.len() == before {
                let report = SimplifyReport {
                    sites: self.sites.count_of_heights(),
                    vertices: tin.report.vertices,
                    bound: chosen.bound,
                    largest: distances.largest,
                    root_mean_square: distances.root_mean_square,
                    line_vertices: [self.lines, &chosen.lines].map(Lines::vertices_on_lines),
                };
                return Ok((tin, report));
            }
        }
    }

    /// The surface of chosen sites, and the site of each of its vertices.
    fn build(&self, chosen: &Chosen) -> Result<(Tin, Vec<u32>)> {
        let points: Vec<[f64; 3]> = chosen
            .sites
            .iter()
            .map(|&site| self.sites.position(site))
            .collect();
        let chains = chains(&chosen.lines);
        let position = |site: &u32| chosen.sites.partition_point(|other| other < site) as u32;
        let lines: Vec<Vec<u32>> = chains
            .iter()
            .map(|(_, chain)| chain.iter().map(position).collect())
            .collect();
        let (triangulation, vertices) = ConstrainedDelaunay::from_lines(
            Terrain::default(),
            &points,
            &lines,
            OnCrossing::Reject,
        )
        .map_err(|error| not_chosen(error.into()))?;
        if triangulation.dimension() < 2 {
            return Err(no_surface(self.sites.count_of_heights()));
        }
        let mut site_of = vec![u32::MAX; triangulation.tds().vertex_slots()];
        for (&site, vertex) in chosen.sites.iter().zip(&vertices) {
            site_of[vertex.index()] = site;
        }
        let kinds = chains.iter().map(|(role, _)| role.kind).collect();
        let inside = inside(&triangulation, &chains);
        let mut tin = Tin::new(triangulation, LineKinds::new(kinds), self.crs.clone());
        if let Some(inside) = inside {
            tin.inside = inside;
        }
        let breaklines = chains
            .iter()
            .filter(|(role, _)| role.kind.is_constrained())
            .count();
        let counted = tin.count();
        tin.report = TinReport {
            points: self.sites.count_of_heights(),
            breaklines,
            breakline_vertices: chosen.lines.vertices_on_lines(),
            vertices: counted.vertices,
            triangles: counted.faces,
            extent: counted.extent,
            ..TinReport::default()
        };
        if breaklines > 0 {
            tin.report.edges = tin.count_lines();
        }
        Ok((tin, site_of))
    }
}

/// The bound at which a number of vertices is expected between two that were tried.
fn between([low, more]: [f64; 2], [high, fewer]: [f64; 2], target: f64) -> f64 {
    let share = (more / target).ln() / (more / fewer).ln();
    // Never too near to an end: it would be tried again and again.
    low * (high / low).powf(share.clamp(0.1, 0.9))
}

#[cold]
fn no_surface(heights: usize) -> Error {
    Error::format(match heights {
        0 => "no heights, and no surface".to_owned(),
        count => format!("{count} heights on one line do not span a surface"),
    })
}

#[cold]
fn not_chosen(refused: Refused) -> Error {
    match refused {
        Refused::Canceled => Error::canceled(),
        Refused::Input(InputError::Crossing { at: [x, y], .. }) => Error::format(format!(
            "two lines of the surface cross at {x} {y} without a common vertex"
        )),
        Refused::Input(error) => Error::format(error.to_string()),
    }
}

/// For each cell number, true if the cell is part of the surface; `None` if all are. The surface is
/// left of the chains at its rim.
fn inside(
    triangulation: &ConstrainedDelaunay<Terrain>,
    chains: &[(EdgeRole, Vec<u32>)],
) -> Option<Vec<bool>> {
    let tds = triangulation.tds();
    let at_rim = |line: &usize| chains[*line].0.is_rim;
    let mut edges = FxHashSet::default();
    let mut open: Vec<CellId> = Vec::new();
    for line in (0..chains.len()).filter(at_rim) {
        for ends in triangulation.chain(LineId::new(line)).windows(2) {
            let [a, b] = [ends[0], ends[1]];
            edges.insert([a.min(b), a.max(b)]);
            if let Some((cell, i)) = tds.edge(a, b) {
                // Counter-clockwise around the cell that is left of the edge.
                let is_left = tds.vertex(cell, ccw(i)) == a;
                open.push(if is_left { cell } else { tds.neighbor(cell, i) });
            }
        }
    }
    if edges.is_empty() {
        return None;
    }
    let mut inside = vec![false; tds.cell_slots()];
    while let Some(cell) = open.pop() {
        if tds.is_infinite(cell) || std::mem::replace(&mut inside[cell.index()], true) {
            continue;
        }
        for i in 0..3 {
            let [a, b] = [tds.vertex(cell, ccw(i)), tds.vertex(cell, cw(i))];
            if !edges.contains(&[a.min(b), a.max(b)]) {
                open.push(tds.neighbor(cell, i));
            }
        }
    }
    Some(inside)
}

/// The edges joined to lines, which end where the role changes, where several meet, and where a
/// line ends. At the rim, the surface is left of them.
fn chains(lines: &Lines) -> Vec<(EdgeRole, Vec<u32>)> {
    let edges = lines.sorted();
    let mut around: BTreeMap<(EdgeRole, u32), Vec<u32>> = BTreeMap::new();
    for ([a, b], edge) in &edges {
        around.entry((edge.role, *a)).or_default().push(*b);
        around.entry((edge.role, *b)).or_default().push(*a);
    }
    let mut is_done: FxHashSet<[u32; 2]> = FxHashSet::default();
    let mut chains = Vec::new();
    let mut follow = |role: EdgeRole, from: u32, to: u32| {
        let mut chain = vec![from];
        let (mut last, mut at) = (from, to);
        while is_done.insert([last.min(at), last.max(at)]) {
            chain.push(at);
            match around.get(&(role, at)).map(Vec::as_slice) {
                Some(&[a, b]) => (last, at) = (at, if a == last { b } else { a }),
                _ => break,
            }
        }
        if chain.len() > 1 {
            if lines.is_surface_right_of([chain[0], chain[1]]) {
                chain.reverse();
            }
            chains.push((role, chain));
        }
    };
    let is_inner =
        |role: EdgeRole, site: u32| around.get(&(role, site)).is_some_and(|o| o.len() == 2);
    for ([a, b], edge) in &edges {
        for [from, to] in [[*a, *b], [*b, *a]] {
            if !is_inner(edge.role, from) {
                follow(edge.role, from, to);
            }
        }
    }
    for ([a, b], edge) in &edges {
        follow(edge.role, *a, *b);
    }
    chains
}
