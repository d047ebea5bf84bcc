//! Heights where breaklines cross.

use std::cmp::Ordering;

use crate::error::{Error, Result};
use crate::geometry::{Terrain, height_along};
use crate::tds::VertexId;
use crate::triangulation::{ConstrainedDelaunay, LineId};

use super::DuplicateRule;

/// Which height stands where breaklines cross, each with one of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrossingRule {
    /// One of them, or their mean; first and last mean the order in which the lines were added. The default is
    /// the lowest, which does not depend on any order: a ditch under a road's edge stays a ditch.
    Choose(DuplicateRule),
    /// None: heights that differ by more than the tolerance are an error.
    Refuse,
}

impl Default for CrossingRule {
    fn default() -> Self {
        CrossingRule::Choose(DuplicateRule::Lowest)
    }
}

/// A place where breaklines with different heights meet.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossingHeights {
    /// In plan.
    pub place: [f64; 2],
    /// Each line, by its position among those that were added, and its own height there; in order of the lines.
    pub heights: Vec<(usize, f64)>,
    /// The height that stands.
    pub chosen: f64,
}

impl CrossingHeights {
    /// By how much the heights differ.
    pub fn difference(&self) -> f64 {
        let heights = || self.heights.iter().map(|&(_, z)| z);
        heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min)
    }
}

/// A line at a vertex between its own.
struct Pass {
    vertex: VertexId,
    line: LineId,
    height: f64,
}

/// Gives every vertex that was added where lines cross its height, by the rule. Returns, in lexicographic order of
/// their places, those at which the heights differ by more than the tolerance.
pub(super) fn settle_heights(
    triangulation: &mut ConstrainedDelaunay<Terrain>,
    rule: CrossingRule,
    tolerance: f64,
) -> Result<Vec<CrossingHeights>> {
    let passes = passes(triangulation);
    let mut reported = Vec::new();
    for at_vertex in passes.chunk_by(|p, q| p.vertex == q.vertex) {
        let vertex = at_vertex[0].vertex;
        let [x, y, _] = *triangulation.point(vertex);
        let mut heights: Vec<f64> = at_vertex.iter().map(|pass| pass.height).collect();
        let choice = match rule {
            CrossingRule::Choose(choice) => choice,
            CrossingRule::Refuse => DuplicateRule::Lowest,
        };
        let chosen = choice.choose(&mut heights);
        triangulation.replace_point(vertex, [x, y, chosen]);
        let heights = at_vertex.iter().map(|pass| (pass.line.index(), pass.height)).collect();
        let crossing = CrossingHeights { place: [x, y], heights, chosen };
        if crossing.difference() > tolerance {
            reported.push(crossing);
        }
    }
    reported.sort_by(|p, q| by_place(p, q));
    match (rule, reported.first()) {
        (CrossingRule::Refuse, Some(first)) => Err(refused(first, tolerance)),
        _ => Ok(reported),
    }
}

/// The passes of lines through added vertices, by vertex and line.
fn passes(triangulation: &ConstrainedDelaunay<Terrain>) -> Vec<Pass> {
    let mut passes = Vec::new();
    if triangulation.crossings().is_empty() {
        return passes;
    }
    for line in triangulation.lines() {
        for pair in triangulation.line_vertices(line).windows(2) {
            let [p, q] = [pair[0], pair[1]].map(|v| *triangulation.point(v));
            let between = triangulation.way(pair[0], pair[1]);
            for vertex in between.into_iter().filter(|&v| triangulation.is_added(v)) {
                let [x, y, _] = *triangulation.point(vertex);
                passes.push(Pass { vertex, line, height: height_along(p, q, [x, y]) });
            }
        }
    }
    // A line that passes twice keeps both of its heights; equal ones are one.
    passes.sort_by(|p, q| p.vertex.cmp(&q.vertex).then(p.line.cmp(&q.line)).then(p.height.total_cmp(&q.height)));
    passes.dedup_by(|p, q| p.vertex == q.vertex && p.line == q.line && p.height == q.height);
    passes
}

fn by_place(p: &CrossingHeights, q: &CrossingHeights) -> Ordering {
    p.place[0].total_cmp(&q.place[0]).then(p.place[1].total_cmp(&q.place[1]))
}

#[cold]
fn refused(crossing: &CrossingHeights, tolerance: f64) -> Error {
    let [x, y] = crossing.place;
    let told: Vec<String> =
        crossing.heights.iter().map(|(line, z)| format!("breakline {line} has height {z}")).collect();
    Error::format(format!("where breaklines cross at {x} {y}, {}, expected within {tolerance}", told.join(" and ")))
        .cure("mend the lines, or choose a height with --crossing-z lowest, highest or mean")
}
