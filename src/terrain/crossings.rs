//! Heights at the sites where breaklines meet, each with a height of its own.

use std::cmp::Ordering;
use std::collections::HashSet;

use crate::error::{Error, Result, Setting, wording};
use crate::triangulation::geometry::{Terrain, height_along};
use crate::triangulation::tds::VertexId;
use crate::triangulation::{ConstrainedDelaunay, LineId};

use super::DuplicateRule;
use super::lines::kinds::Precedence;

/// Which height a vertex gets where breaklines with different heights cross between their vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum CrossingRule {
    /// One of the heights, or their mean; first and last refer to the order in which the lines were
    /// added. The default is the lowest, which does not depend on the order: a ditch under a road's
    /// edge stays a ditch.
    Choose(DuplicateRule),
    /// No height: a difference larger than the tolerance is an error.
    Refuse,
}

impl Default for CrossingRule {
    fn default() -> Self {
        CrossingRule::Choose(DuplicateRule::Lowest)
    }
}

/// A site where breaklines with different heights meet.
///
/// They cross there, or one of them passes through or shares a vertex of the other.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossingHeights {
    /// The site, in plan.
    pub site: [f64; 2],
    /// Each line with its own height, in order of the lines.
    ///
    /// A line is named by its position among those that were added. A line that passes the site
    /// twice with two heights is listed twice.
    pub heights: Vec<(usize, f64)>,
    /// The height of the vertex in the surface.
    pub chosen: f64,
    /// True if the vertex was added, and has its height by the [`CrossingRule`]; a vertex that was
    /// given keeps its height by the [`DuplicateRule`].
    pub is_added: bool,
}

impl CrossingHeights {
    /// Returns the difference between the highest and the lowest height.
    pub fn difference(&self) -> f64 {
        let [(_, lowest), (_, highest)] = self.extremes();
        highest - lowest
    }

    /// Returns the lines with the lowest and with the highest height; among equals, the first.
    pub fn extremes(&self) -> [(usize, f64); 2] {
        let first = self.heights.first().copied().unwrap_or_default();
        self.heights
            .iter()
            .fold([first; 2], |[low, high], &(line, z)| {
                [
                    if z < low.1 { (line, z) } else { low },
                    if z > high.1 { (line, z) } else { high },
                ]
            })
    }
}

/// A line at a vertex, with its own height there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pass {
    pub(super) vertex: VertexId,
    pub(super) line: LineId,
    pub(super) height: f64,
    /// True if the line was given with the vertex; false if it passes between its vertices.
    pub(super) is_own: bool,
}

/// Sets the heights of the vertices that were added at crossings, by the rule. Returns the sites at
/// which heights differ by more than the tolerance, in lexicographic order.
///
/// Where lines of several kinds meet, only those of the kind that comes first count; this holds for
/// vertices that other lines were given with, too.
///
/// `disputed` contains the lines at vertices that were given with different heights.
pub(super) fn choose_heights(
    triangulation: &mut ConstrainedDelaunay<Terrain>,
    precedences: &[Precedence],
    disputed: Vec<Pass>,
    rule: CrossingRule,
    tolerance: f64,
) -> Vec<CrossingHeights> {
    let choice = match rule {
        CrossingRule::Choose(choice) => choice,
        CrossingRule::Refuse => DuplicateRule::Lowest,
    };
    let mut reported = Vec::new();
    for at_vertex in passes(triangulation, disputed).chunk_by(|p, q| p.vertex == q.vertex) {
        let vertex = at_vertex[0].vertex;
        let [x, y, mut chosen] = *triangulation.point(vertex);
        let is_added = triangulation.is_added(vertex);
        let precedence = |pass: &Pass| precedences[pass.line.index()];
        let first = at_vertex.iter().map(precedence).min();
        let own = at_vertex
            .iter()
            .filter(|pass| pass.is_own)
            .map(precedence)
            .min();
        let standing: Vec<&Pass> = at_vertex
            .iter()
            .filter(|pass| Some(precedence(pass)) == first)
            .collect();
        if is_added || own.is_some() && first < own {
            chosen = choice.choose(
                &mut standing
                    .iter()
                    .map(|pass| pass.height)
                    .collect::<Vec<f64>>(),
            );
            triangulation.replace_point(vertex, [x, y, chosen]);
        }
        let heights = standing
            .iter()
            .map(|pass| (pass.line.index(), pass.height))
            .collect();
        let crossing = CrossingHeights {
            site: [x, y],
            heights,
            chosen,
            is_added,
        };
        if crossing.difference() > tolerance {
            reported.push(crossing);
        }
    }
    reported.sort_by(by_site);
    reported
}

/// The lines at each disputed vertex and at each vertex that a line passes between its own
/// vertices, sorted by vertex and line.
fn passes(triangulation: &ConstrainedDelaunay<Terrain>, disputed: Vec<Pass>) -> Vec<Pass> {
    let mut passes = Vec::new();
    for line in triangulation.lines() {
        for pair in triangulation
            .line_vertices(line)
            .windows(2)
            .filter(|pair| pair[0] != pair[1])
        {
            let [p, q] = [pair[0], pair[1]].map(|v| *triangulation.point(v));
            passes.extend(
                triangulation
                    .segment_chain(pair[0], pair[1])
                    .into_iter()
                    .map(|vertex| {
                        let [x, y, _] = *triangulation.point(vertex);
                        Pass {
                            vertex,
                            line,
                            height: height_along(p, q, [x, y]),
                            is_own: false,
                        }
                    }),
            );
        }
    }
    // A vertex that is passed may be one that other lines were given with. If these agree on its
    // height, they are not disputed, and have to be added.
    let mut passed: HashSet<VertexId> = passes
        .iter()
        .map(|pass| pass.vertex)
        .filter(|&vertex| !triangulation.is_added(vertex))
        .collect();
    for pass in &disputed {
        passed.remove(&pass.vertex);
    }
    if !passed.is_empty() {
        for line in triangulation.lines() {
            let own = triangulation
                .line_vertices(line)
                .iter()
                .filter(|vertex| passed.contains(vertex));
            passes.extend(own.map(|&vertex| Pass {
                vertex,
                line,
                height: triangulation.point(vertex)[2],
                is_own: true,
            }));
        }
    }
    passes.extend(disputed);
    // A line that passes twice with different heights is kept twice.
    passes.sort_by(|p, q| {
        p.vertex
            .cmp(&q.vertex)
            .then(p.line.cmp(&q.line))
            .then(p.height.total_cmp(&q.height))
    });
    passes.dedup();
    passes
}

fn by_site(p: &CrossingHeights, q: &CrossingHeights) -> Ordering {
    p.site[0]
        .total_cmp(&q.site[0])
        .then(p.site[1].total_cmp(&q.site[1]))
}

/// Returns an error that names the first of the crossings, if there is one; `name` returns what the
/// user calls a line.
pub(super) fn refuse(
    crossings: &[CrossingHeights],
    tolerance: f64,
    name: &dyn Fn(usize) -> String,
) -> Result<()> {
    let Some(first) = crossings.first() else {
        return Ok(());
    };
    let [x, y] = first.site;
    let [(low, lowest), (high, highest)] = first.extremes();
    let more = match crossings.len() {
        1 => String::new(),
        count => format!(" ({count} such sites in total)"),
    };
    Err(Error::format(format!(
        "breaklines meet with different heights at {x} {y}: {lowest} of {}, {highest} of {}, expected within {tolerance}{more}",
        name(low),
        name(high)
    ))
    .cure(wording!["fix the lines, or choose a height with ", Setting::CrossingZ.text("lowest"), ", highest or mean (", Setting::CrossingReport, " lists all sites)"]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Surface;
    use crate::terrain::{Tin, TinBuilder};
    use std::sync::atomic::AtomicBool;

    type Line<'a> = &'a [[f64; 3]];

    /// Two lines that cross at the origin, at heights 1 and 4, and one that crosses them there at
    /// 2.5.
    const STAR: [Line; 3] = [
        &[[-4.0, 0.0, 0.0], [4.0, 0.0, 2.0]],
        &[[0.0, -4.0, 4.0], [0.0, 4.0, 4.0]],
        &[[-4.0, -4.0, 2.5], [4.0, 4.0, 2.5]],
    ];

    fn builder(lines: &[Line]) -> TinBuilder {
        let mut builder = TinBuilder::default();
        builder.add_points(&[-9.0, 9.0, 9.0, -9.0], &[-9.0, -9.0, 9.0, 9.0], &[0.0; 4]);
        lines.iter().for_each(|line| builder.add_breakline(line));
        builder
    }

    fn tin(lines: &[Line], rule: DuplicateRule) -> Tin {
        let mut builder = builder(lines);
        builder.crossing_heights = CrossingRule::Choose(rule);
        builder.build().unwrap()
    }

    fn vertices(tin: &Tin) -> Vec<[u64; 3]> {
        (0..tin.vertex_count() as u32)
            .map(|v| tin.position(v).map(f64::to_bits))
            .collect()
    }

    #[test]
    fn each_rule_has_its_height() {
        use DuplicateRule::{First, Highest, Last, Lowest, Mean};
        for (rule, expected) in [
            (Lowest, 1.0),
            (Highest, 4.0),
            (Mean, 2.5),
            (First, 1.0),
            (Last, 2.5),
        ] {
            let tin = tin(&STAR, rule);
            assert_eq!(tin.elevation(0.0, 0.0), Some(expected), "{rule:?}");
            let heights = vec![(0, 1.0), (1, 4.0), (2, 2.5)];
            let reported = CrossingHeights {
                site: [0.0; 2],
                heights,
                chosen: expected,
                is_added: true,
            };
            assert_eq!(
                (reported.difference(), reported.extremes()),
                (3.0, [(0, 1.0), (1, 4.0)])
            );
            assert_eq!(tin.report().crossing_heights, [reported]);
        }
    }

    #[test]
    fn only_first_and_last_know_an_order() {
        for order in [
            [0, 1, 2],
            [0, 2, 1],
            [1, 0, 2],
            [1, 2, 0],
            [2, 0, 1],
            [2, 1, 0],
        ] {
            let lines = order.map(|line| STAR[line]);
            for rule in [
                DuplicateRule::Lowest,
                DuplicateRule::Highest,
                DuplicateRule::Mean,
            ] {
                assert_eq!(
                    vertices(&tin(&lines, rule)),
                    vertices(&tin(&STAR, rule)),
                    "{order:?} {rule:?}"
                );
            }
            let own = [1.0, 4.0, 2.5];
            let [first, last] =
                [DuplicateRule::First, DuplicateRule::Last].map(|rule| tin(&lines, rule));
            assert_eq!(first.elevation(0.0, 0.0), Some(own[order[0]]));
            assert_eq!(last.elevation(0.0, 0.0), Some(own[order[2]]));
        }
    }

    #[test]
    fn what_differs_by_no_more_than_the_tolerance_is_passed_over() {
        for (tolerance, count) in [(0.0, 1), (2.5, 1), (3.0, 0), (9.0, 0)] {
            let mut builder = builder(&STAR);
            builder.crossing_tolerance = tolerance;
            let tin = builder.build().unwrap();
            assert_eq!(tin.report().crossing_heights.len(), count);
            assert_eq!(tin.elevation(0.0, 0.0), Some(1.0));
        }
    }

    #[test]
    fn the_refusal_names_both_lines_as_the_caller_does() {
        let refuse = |tolerance| {
            let mut builder = builder(&STAR);
            builder.crossing_heights = CrossingRule::Refuse;
            builder.crossing_tolerance = tolerance;
            builder.build_named(
                &|line| format!("road {}", ["A", "B", "C"][line]),
                &AtomicBool::new(false),
            )
        };
        let message = "breaklines meet with different heights at 0 0: 1 of road A, 4 of road B, expected within 0.5";
        assert_eq!(refuse(0.5).unwrap_err().to_string(), message);
        assert!(refuse(3.0).is_ok());
    }

    #[test]
    fn a_vertex_that_is_touched_keeps_its_height_and_is_reported() {
        // The second line ends on the first, the third shares that end, the fourth is elsewhere.
        let lines: [Line; 4] = [
            &[[-4.0, 0.0, 0.0], [4.0, 0.0, 2.0]],
            &[[2.0, 0.0, 7.0], [2.0, 4.0, 7.0]],
            &[[2.0, -4.0, 5.0], [2.0, 0.0, 5.0]],
            &[[-4.0, 6.0, 5.0], [4.0, 6.0, 5.0]],
        ];
        let reported = |lines: &[Line]| {
            let tin = tin(lines, DuplicateRule::Highest);
            assert_eq!(tin.report().crossings, 0);
            let heights: Vec<_> = tin
                .report()
                .crossing_heights
                .iter()
                .map(|c| c.heights.clone())
                .collect();
            assert!(
                tin.report()
                    .crossing_heights
                    .iter()
                    .all(|c| !c.is_added && c.site == [2.0, 0.0])
            );
            (tin.elevation(2.0, 0.0), heights)
        };
        assert_eq!(
            reported(&lines),
            (Some(5.0), vec![vec![(0, 1.5), (1, 7.0), (2, 5.0)]])
        );
        assert_eq!(
            reported(&lines[..2]),
            (Some(7.0), vec![vec![(0, 1.5), (1, 7.0)]])
        );
        assert_eq!(
            reported(&lines[1..]),
            (Some(5.0), vec![vec![(0, 7.0), (1, 5.0)]])
        );
        let level: Line = &[[2.0, 0.0, 1.5], [2.0, 4.0, 7.0]];
        assert_eq!(reported(&[lines[0], level]), (Some(1.5), vec![]));
    }

    #[test]
    fn a_point_on_a_breakline_is_no_crossing() {
        let mut builder = builder(&STAR[..1]);
        builder.add_points(&[1.0], &[0.0], &[8.0]);
        let tin = builder.build().unwrap();
        assert_eq!(
            (tin.elevation(1.0, 0.0), tin.report().crossing_heights.len()),
            (Some(8.0), 0)
        );
    }

    #[test]
    fn a_ring_that_ends_at_a_height_other_than_its_first_is_reported() {
        let ring: Line = &[
            [0.0, 0.0, 1.0],
            [4.0, 0.0, 1.0],
            [0.0, 4.0, 1.0],
            [0.0, 0.0, 3.0],
        ];
        let tin = tin(&[ring], DuplicateRule::Lowest);
        let [reported] = tin.report().crossing_heights.as_slice() else {
            panic!()
        };
        assert_eq!(
            (reported.heights.as_slice(), reported.chosen),
            ([(0, 1.0), (0, 3.0)].as_slice(), 1.0)
        );
    }
}
