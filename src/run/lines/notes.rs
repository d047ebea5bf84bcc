//! What looks wrong about lines and areas, and how many edges they became.

use std::ops::Range;
use std::path::PathBuf;

use super::crossings::LineNames;
use crate::data::EdgeKind;
use crate::run::context::Journal;
use crate::run::context::notice::{LoweredRiver, Notice, WaterStep};
use crate::run::context::units::Units;
use crate::run::request::lines::{LineRequest, LineRole};
use crate::terrain::{Inside, RiverHeights, Tin, TinReport, WaterOverlap};
use crate::triangulation::LineId;

/// How many lines of an input were used.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LineInput {
    /// What they were used as.
    pub role: LineRole,
    /// The file.
    pub path: PathBuf,
    /// The lines, walls, lakes, rivers or areas; each part of a line counts.
    pub lines: usize,
    /// The distinct edges that they became, before the surface was clipped. Draped lines and areas
    /// to clip to are counted with the edges of the surface only.
    pub edges: usize,
    /// The numbers of the lines of the TIN.
    pub(crate) numbers: Range<usize>,
}

/// A closed line of one height, that may be a shore.
#[derive(Debug)]
pub(crate) struct LevelRing {
    pub(crate) line: usize,
    pub(crate) ring: Vec<[f64; 2]>,
    pub(crate) height: f64,
}

impl LevelRing {
    /// Returns the ring that a line of the builder is, if it is closed and its heights are within a
    /// tolerance of the first.
    pub(crate) fn of(points: &[[f64; 3]], line: usize, tolerance: f64) -> Option<Self> {
        let (first, last) = (points.first()?, points.last()?);
        let is_ring = points.len() > 3 && first[..2] == last[..2];
        if !is_ring || points.iter().any(|p| (p[2] - first[2]).abs() > tolerance) {
            return None;
        }
        Some(LevelRing {
            line,
            ring: points.iter().map(|p| [p[0], p[1]]).collect(),
            height: first[2],
        })
    }
}

/// Adds a notice about rivers that overlap themselves.
pub(crate) fn note_overlaps(overlaps: &[(String, [f64; 2])], journal: &Journal) {
    if let Some((name, at)) = overlaps.first() {
        journal.add(Notice::RiverOverlap {
            rivers: overlaps.len(),
            name: name.clone(),
            at: *at,
        });
    }
}

/// The number of steps, or of rivers, in a notice.
const LISTED: usize = 5;

/// Adds a notice about waters of different heights that overlap.
pub(crate) fn note_water_overlaps(
    report: &TinReport,
    names: &LineNames,
    units: &Units,
    journal: &Journal,
) {
    let step = |overlap: &WaterOverlap| {
        let [inner, outer] = overlap.lines.map(|line| names.name(line));
        WaterStep {
            inner,
            outer,
            step: units.height(overlap.step),
            at: overlap.at,
        }
    };
    let overlaps = &report.water_overlaps;
    if !overlaps.is_empty() {
        let first = overlaps.iter().take(LISTED).map(step).collect();
        journal.add(Notice::WaterOverlaps {
            count: overlaps.len(),
            first,
        });
    }
}

/// Adds a notice about walls along shores or in water.
pub(crate) fn note_walls_in_water(report: &TinReport, names: &LineNames, journal: &Journal) {
    if let Some((line, at)) = report.walls_in_water.first() {
        let (vertices, name) = (report.walls_in_water.len(), names.name(*line));
        journal.add(Notice::WallsInWater {
            vertices,
            name,
            at: *at,
        });
    }
}

/// Adds a notice about lakes that have the height of larger ones, with the one that was moved most.
pub(crate) fn note_lakes_joined(
    report: &TinReport,
    names: &LineNames,
    units: &Units,
    journal: &Journal,
) {
    let joined = &report.lakes_joined;
    if let Some(lake) = joined.iter().max_by(|p, q| p.by.total_cmp(&q.by)) {
        journal.add(Notice::LakesJoined {
            lakes: joined.len(),
            name: names.name(lake.line),
            to: names.name(lake.to),
            by: units.height(lake.by),
        });
    }
}

/// Adds a notice about waters that end at the rim of the points.
pub(crate) fn note_waters_ended(report: &TinReport, names: &LineNames, journal: &Journal) {
    if let Some(first) = report.waters_ended.first() {
        journal.add(Notice::WatersEnded {
            waters: report.waters_ended.len(),
            name: names.name(*first),
        });
    }
}

/// Flat triangles with a smaller share of the area are not reported.
const FLAT_SHARE: f64 = 1e-3;

/// Adds notices about vertices on ridges, and about triangles that are flat between lines.
pub(crate) fn note_flat_triangles(report: &TinReport, journal: &Journal) {
    if report.ridge_vertices > 0 {
        journal.add(Notice::RidgesAdded(report.ridge_vertices));
    }
    if report.flat_share > FLAT_SHARE {
        journal.add(Notice::FlatTriangles {
            count: report.flat_triangles,
            share: report.flat_share,
            has_ridges: report.ridge_vertices > 0,
        });
    }
}

/// Adds notices about draped lines and holes, none of which lies on the surface. Nothing else may
/// clip it.
pub(crate) fn note_apart(inputs: &[LineInput], report: &TinReport, journal: &Journal) {
    let is_given = |role: LineRole| {
        inputs
            .iter()
            .any(|input| input.role == role && input.lines > 0)
    };
    if is_given(LineRole::Draped) && report.edges.of(EdgeKind::Draped) == 0 {
        journal.add(Notice::LinesApart(LineRole::Draped));
    }
    if is_given(LineRole::Holes) && report.faces_clipped + report.faces_cut == 0 {
        journal.add(Notice::LinesApart(LineRole::Holes));
    }
}

/// Adds a notice about lakes whose shores differ in height, with the one that differs most.
pub(crate) fn note_uneven_shores(uneven: &[(String, f64, f64)], units: &Units, journal: &Journal) {
    if let Some((name, height, spread)) = uneven.iter().max_by(|p, q| p.2.total_cmp(&q.2)) {
        journal.add(Notice::UnevenShores {
            lakes: uneven.len(),
            name: name.clone(),
            height: units.height(*height),
            largest: units.height(*spread),
        });
    }
}

/// Adds a notice about rivers whose banks contradict water, with the worst of them.
pub(crate) fn note_uneven(uneven: &[(String, RiverHeights)], units: &Units, journal: &Journal) {
    let worst = |(_, heights): &&(String, RiverHeights)| {
        heights.largest_rise.max(heights.largest_difference)
    };
    let Some((name, heights)) = uneven.iter().max_by(|p, q| worst(p).total_cmp(&worst(q))) else {
        return;
    };
    journal.add(Notice::RiverHeights {
        rivers: uneven.len(),
        name: name.clone(),
        rising: heights.rising,
        largest_rise: units.height(heights.largest_rise),
        rise_at: heights.rise_at,
        largest_difference: units.height(heights.largest_difference),
        difference_at: heights.difference_at,
    });
}

/// Adds a notice about rivers that are lowered to others, with those that are lowered most.
pub(crate) fn note_lowered(mut lowered: Vec<LoweredRiver>, journal: &Journal) {
    let count = lowered.len();
    if count > 0 {
        lowered.sort_by(|p, q| q.by.value.total_cmp(&p.by.value));
        lowered.truncate(LISTED);
        journal.add(Notice::RiversLowered {
            count,
            first: lowered,
        });
    }
}

/// Closed lines of one height, and the points inside that have other heights: the lines may be
/// shores that were meant to be level.
#[derive(Debug)]
pub(crate) struct LevelRings {
    rings: Vec<LevelRing>,
    inside: Inside,
    tolerance: f64,
}

/// The points inside a ring that have other heights: their number, and the largest difference.
pub(crate) type OtherHeights = (u64, f64);

impl LevelRings {
    /// Returns the rings among the lines of a request; `None` if there are none, or lakes are given
    /// as such. Heights count as others if they differ by more than `tolerance`.
    pub(crate) fn of(rings: Vec<LevelRing>, request: &LineRequest, tolerance: f64) -> Option<Self> {
        if rings.is_empty() || !request.flats.is_empty() {
            return None;
        }
        let polygons: Vec<Vec<Vec<[f64; 2]>>> =
            rings.iter().map(|ring| vec![ring.ring.clone()]).collect();
        Some(LevelRings {
            inside: Inside::new(&polygons),
            rings,
            tolerance,
        })
    }

    /// Returns what is found of each ring without points.
    pub(crate) fn none_found(&self) -> Vec<OtherHeights> {
        vec![(0, 0.0); self.rings.len()]
    }

    /// Adds what is found of each ring in some of the points.
    pub(crate) fn count(&self, points: &[[f64; 3]], found: &mut [OtherHeights]) {
        for [x, y, z] in points {
            let Some(at) = self.inside.first_around([*x, *y]) else {
                continue;
            };
            let difference = (z - self.rings[at].height).abs();
            if difference > self.tolerance {
                found[at] = (found[at].0 + 1, found[at].1.max(difference));
            }
        }
    }

    /// Returns the notice about what was found in all points, if anything was.
    pub(crate) fn notice(
        &self,
        found: &[OtherHeights],
        names: &LineNames,
        units: &Units,
    ) -> Option<Notice> {
        let differ = found
            .iter()
            .enumerate()
            .filter(|(_, (count, _))| *count > 0);
        let (at, (_, largest)) = differ.max_by(|p, q| p.1.1.total_cmp(&q.1.1))?;
        Some(Notice::LevelRings {
            rings: found.iter().filter(|(count, _)| *count > 0).count(),
            points: found.iter().map(|(count, _)| *count as usize).sum(),
            name: names.name(self.rings[at].line),
            largest: units.height(*largest),
        })
    }
}

/// Counts the distinct edges of the lines of each input.
pub(crate) fn count_edges(inputs: &mut [LineInput], tin: &Tin) {
    let triangulation = tin.triangulation();
    for input in inputs
        .iter_mut()
        .filter(|input| input.role.edges().is_some())
    {
        let mut edges: Vec<[u32; 2]> = Vec::new();
        // Level lines across rivers are not banks.
        for line in input
            .numbers
            .clone()
            .filter(|&line| tin.line_kind(line) == input.role.edges())
        {
            let chain = triangulation.chain(LineId::new(line));
            edges.extend(chain.windows(2).map(|pair| {
                let [a, b] = [pair[0], pair[1]].map(|vertex| vertex.index() as u32);
                [a.min(b), a.max(b)]
            }));
        }
        edges.sort_unstable();
        edges.dedup();
        input.edges = edges.len();
    }
}
