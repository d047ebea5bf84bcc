//! One vertex for each site of points and lines.

use super::TinBuilder;
use crate::error::{Error, Result};
use crate::terrain::TinReport;
use crate::terrain::crossings::Pass;
use crate::triangulation::tds::VertexId;
use crate::triangulation::{LineId, spatial_order};

/// The number of vertices that are merged between two looks at the flag that cancels the work.
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
        let site = |i: u32| [all[i as usize][0], all[i as usize][1]];
        let mut vertices = Vec::new();
        if vertices.try_reserve_exact(all.len()).is_err() {
            return Err(Error::limit(format!(
                "not enough memory for {} vertices",
                all.len()
            )));
        }
        let mut line_vertices = vec![u32::MAX; all.len() - lines_from];
        let mut disputed = Vec::new();
        let (mut heights, mut first_lines) = (Vec::new(), Vec::new());
        for group in order.chunk_by(|&i, &j| site(i) == site(j)) {
            if vertices.len() % POLL == 0 {
                go_on()?;
            }
            if let &[only] = group
                && (only as usize) < lines_from
            {
                vertices.push(all[only as usize]); // the common case: nothing to choose
                continue;
            }
            // Within a site, indices are in the order of the input: points first, then lines.
            let first_of_lines = group.partition_point(|&i| (i as usize) < lines_from);
            let (points, lines) = group.split_at(first_of_lines);
            let line_of = |i: u32| {
                self.line_ends
                    .partition_point(|&end| end <= i as usize - lines_from)
            };
            let precedence = |i: u32| self.precedences[line_of(i)];
            let standing = if lines.is_empty() {
                report.duplicates += points.len() - 1;
                points
            } else {
                report.points_on_breaklines += points.len();
                report.breakline_vertices += 1;
                // Those that count before all others.
                first_lines.clear();
                let first = lines.iter().map(|&i| precedence(i)).min();
                first_lines.extend(
                    lines
                        .iter()
                        .copied()
                        .filter(|&i| lines.len() == 1 || Some(precedence(i)) == first),
                );
                &first_lines
            };
            heights.clear();
            heights.extend(standing.iter().map(|&i| all[i as usize][2]));
            let [x, y] = site(group[0]);
            for &i in lines {
                line_vertices[i as usize - lines_from] = vertices.len() as u32;
            }
            if !lines.is_empty() && heights.iter().any(|&z| z != heights[0]) {
                disputed.extend(standing.iter().map(|&i| Pass {
                    vertex: VertexId::new(vertices.len()),
                    line: LineId::new(line_of(i)),
                    height: all[i as usize][2],
                    is_own: true,
                }));
            }
            vertices.push([x, y, self.duplicates.choose(&mut heights)]);
        }
        Ok(Sites {
            vertices,
            line_vertices,
            disputed,
        })
    }
}
