//! One vertex for each site of points and lines.

use std::ops::Range;

use rayon::prelude::*;

use super::TinBuilder;
use crate::data::AT_ONCE;
use crate::error::{Error, Result};
use crate::terrain::TinReport;
use crate::terrain::crossings::Pass;
use crate::triangulation::tds::VertexId;
use crate::triangulation::{LineId, spatial_order};

/// The number of sites that are merged between two looks at the flag that cancels the work.
const POLL: usize = 1 << 16;

/// The distinct sites of points and lines.
pub(super) struct Sites {
    /// In spatial order.
    pub(super) vertices: Vec<[f64; 3]>,
    /// For each vertex of a breakline, the index of its site.
    pub(super) line_vertices: Vec<u32>,
    /// The breaklines at sites where their vertices have different heights.
    pub(super) disputed: Vec<Pass>,
}

impl TinBuilder {
    /// Merges the points and vertices that share a site, by the rules. Leaves `self.points` empty.
    ///
    /// # Errors
    /// If there is not enough memory for the vertices, or if `go_on`, which is called now and then,
    /// returns an error.
    pub(super) fn merge(
        &mut self,
        report: &mut TinReport,
        go_on: &dyn Fn() -> Result<()>,
    ) -> Result<Sites> {
        let mut all = std::mem::take(&mut self.points);
        let lines_from = all.len();
        all.reserve_exact(self.line_points.len());
        all.append(&mut self.line_points);
        let order = spatial_order(all.len(), |i| [all[i][0], all[i][1]])
            .map_err(|e| Error::limit(e.to_string()))?;
        go_on()?;
        let mut vertices = Vec::new();
        if vertices.try_reserve_exact(all.len()).is_err() {
            return Err(Error::limit(format!(
                "not enough memory for {} vertices",
                all.len()
            )));
        }
        let point = |&i: &u32| all[i as usize];
        let in_order = order.par_iter().with_min_len(AT_ONCE);
        in_order.map(point).collect_into_vec(&mut vertices);
        let site = |at: usize| [vertices[at][0], vertices[at][1]];
        let is_same = |at: usize| at < order.len() && site(at) == site(at - 1);
        // Most sites have one point, and nothing to choose.
        let is_shared = |&at: &usize| {
            !(at > 0 && is_same(at)) && (order[at] as usize >= lines_from || is_same(at + 1))
        };
        let ats = (0..order.len()).into_par_iter().with_min_len(AT_ONCE);
        let shared: Vec<usize> = ats.filter(is_shared).collect();

        let mut merging = Merging {
            builder: self,
            all: &all,
            lines_from,
            line_vertices: vec![u32::MAX; all.len() - lines_from],
            disputed: Vec::new(),
            heights: Vec::new(),
            first_lines: Vec::new(),
        };
        // Vertices before `from` are merged; `end` of them are left.
        let (mut from, mut end) = (0, 0);
        for (number, &start) in shared.iter().enumerate() {
            if number % POLL == 0 {
                go_on()?;
            }
            let [x, y, _] = vertices[start];
            let is_here = |vertex: &&[f64; 3]| [vertex[0], vertex[1]] == [x, y];
            let others = vertices[start + 1..].iter().take_while(is_here);
            let group = &order[start..=start + others.count()];
            move_up(&mut vertices, from..start, end);
            end += start - from;
            from = start + group.len();
            vertices[end] = [x, y, merging.height(group, end, report)];
            end += 1;
        }
        let length = vertices.len();
        move_up(&mut vertices, from..length, end);
        vertices.truncate(end + length - from);
        Ok(Sites {
            vertices,
            line_vertices: merging.line_vertices,
            disputed: merging.disputed,
        })
    }
}

/// Moves a range of vertices to where `end` is before it, or leaves them there.
fn move_up(vertices: &mut [[f64; 3]], range: Range<usize>, end: usize) {
    if range.start > end {
        vertices.copy_within(range, end);
    }
}

/// Points and vertices of lines that become vertices of the triangulation.
struct Merging<'a> {
    builder: &'a TinBuilder,
    all: &'a [[f64; 3]],
    /// Where the vertices of lines begin.
    lines_from: usize,
    line_vertices: Vec<u32>,
    disputed: Vec<Pass>,
    heights: Vec<f64>,
    first_lines: Vec<u32>,
}

impl Merging<'_> {
    /// Returns the height of the vertex at the site of a group, and records which lines pass it.
    fn height(&mut self, group: &[u32], vertex: usize, report: &mut TinReport) -> f64 {
        let Merging {
            builder,
            all,
            lines_from,
            ..
        } = *self;
        // Within a site, indices are in the order of the input: points first, then lines.
        let first_of_lines = group.partition_point(|&i| (i as usize) < lines_from);
        let (points, lines) = group.split_at(first_of_lines);
        let line_of = |i: u32| {
            builder
                .line_ends
                .partition_point(|&end| end <= i as usize - lines_from)
        };
        let precedence = |i: u32| builder.precedences[line_of(i)];
        let standing = if lines.is_empty() {
            report.duplicates += points.len() - 1;
            points
        } else {
            report.points_on_breaklines += points.len();
            report.breakline_vertices += 1;
            // Those that count before all others.
            self.first_lines.clear();
            let first = lines.iter().map(|&i| precedence(i)).min();
            self.first_lines.extend(
                lines
                    .iter()
                    .copied()
                    .filter(|&i| lines.len() == 1 || Some(precedence(i)) == first),
            );
            &self.first_lines
        };
        let heights = &mut self.heights;
        heights.clear();
        heights.extend(standing.iter().map(|&i| all[i as usize][2]));
        for &i in lines {
            self.line_vertices[i as usize - lines_from] = vertex as u32;
        }
        if !lines.is_empty() && heights.iter().any(|&z| z != heights[0]) {
            self.disputed.extend(standing.iter().map(|&i| Pass {
                vertex: VertexId::new(vertex),
                line: LineId::new(line_of(i)),
                height: all[i as usize][2],
                is_own: true,
            }));
        }
        builder.duplicates.choose(heights)
    }
}
