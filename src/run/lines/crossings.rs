//! Notices and a table of breaklines that meet with different heights.

use std::io::Write;
use std::path::PathBuf;

use super::shapes::Drawn;
use crate::io::csv_field;
use crate::run::context::Journal;
use crate::run::context::notice::{CrossingNote, Notice};
use crate::run::context::units::Units;
use crate::terrain::{CrossingHeights, TinReport};
use crate::triangulation::Rounding;

/// The number of crossings in a notice.
const LISTED: usize = 5;

/// Names of the lines of a surface: file, feature id and part.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LineNames {
    files: Vec<PathBuf>,
    lines: Vec<LineName>,
}

/// The file, record and part that a line of the surface comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct LineName {
    file: usize,
    record: usize,
    part: Option<usize>,
}

impl LineNames {
    pub(crate) fn new(files: Vec<PathBuf>) -> Self {
        LineNames {
            files,
            lines: Vec::new(),
        }
    }

    /// Adds the name of the next line of the surface.
    pub(crate) fn add(&mut self, file: usize, line: &Drawn) {
        self.lines.push(LineName {
            file,
            record: line.record,
            part: line.part,
        });
    }

    /// Returns the name of a line, such as "edges.shp record 13, part 2", by its position among the
    /// breaklines; an empty string if there is no such line.
    pub fn name(&self, line: usize) -> String {
        let Some(LineName { file, record, part }) = self.lines.get(line) else {
            return String::new();
        };
        let part = part
            .map(|part| format!(", part {part}"))
            .unwrap_or_default();
        format!("{} record {record}{part}", self.files[*file].display())
    }

    /// Writes a comma separated table of the points where lines meet with different heights. Each
    /// point has one row for every line above the lowest. Numbers are written such that reading
    /// them gives the same doubles.
    ///
    /// # Errors
    /// If `out` cannot be written to.
    pub fn write_table(
        &self,
        crossings: &[CrossingHeights],
        out: &mut impl Write,
    ) -> std::io::Result<()> {
        writeln!(
            out,
            "x,y,z,vertex,difference,low_file,low_fid,low_part,low_z,high_file,high_fid,high_part,high_z"
        )?;
        for CrossingHeights {
            site: [x, y],
            heights,
            chosen,
            is_added,
        } in crossings
        {
            let mut heights = heights.clone();
            heights.sort_by(|&(p, low), &(q, high)| {
                low.total_cmp(&high)
                    .then(self.lines.get(p).cmp(&self.lines.get(q)))
            });
            let vertex = if *is_added { "added" } else { "given" };
            let Some((&(low, lowest), above)) = heights.split_first() else {
                continue;
            };
            for &(line, z) in above {
                let (low, high, difference) = (self.columns(low), self.columns(line), z - lowest);
                writeln!(
                    out,
                    "{x},{y},{chosen},{vertex},{difference},{low},{lowest},{high},{z}"
                )?;
            }
        }
        Ok(())
    }

    /// Formats a line as `edges.shp,12,2`, with the feature id of GIS, which counts from 0.
    fn columns(&self, line: usize) -> String {
        let Some(LineName { file, record, part }) = self.lines.get(line) else {
            return ",,".to_owned();
        };
        format!(
            "{},{},{}",
            csv_field(&self.files[*file].to_string_lossy()),
            record - 1,
            part.unwrap_or(1)
        )
    }
}

/// Adds notices about rounded crossings, and about lines that meet with different heights.
pub(crate) fn note(report: &TinReport, names: &LineNames, units: &Units, journal: &Journal) {
    if let Some(Rounding { unit, on_grid }) = report.rounding {
        journal.add(Notice::CrossingsRounded {
            unit: unit.map(|unit| units.length(unit)),
            on_grid,
        });
    }
    let differing = &report.crossing_heights;
    let by_difference =
        |p: &&CrossingHeights, q: &&CrossingHeights| p.difference().total_cmp(&q.difference());
    let Some(worst) = differing.iter().rev().max_by(by_difference) else {
        return;
    };
    let note = |crossing: &CrossingHeights| {
        let [low, high] = crossing.extremes().map(|(line, z)| (z, names.name(line)));
        CrossingNote {
            at: crossing.site,
            low,
            high,
            chosen: crossing.chosen,
        }
    };
    journal.add(Notice::CrossingHeights {
        count: differing.len(),
        largest: units.height(worst.difference()),
        at: worst.site,
        first: differing.iter().take(LISTED).map(note).collect(),
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_for_every_line_above_the_lowest() {
        let mut names = LineNames::new(vec!["a,b.shp".into(), "c.shp".into()]);
        for (file, at, part) in [(0, 7, None), (1, 0, Some(2)), (1, 3, None)] {
            names.add(
                file,
                &Drawn {
                    at,
                    record: at + 1,
                    part,
                    points: Vec::new(),
                },
            );
        }
        assert_eq!(
            [0, 1].map(|line| names.name(line)),
            ["a,b.shp record 8", "c.shp record 1, part 2"]
        );
        let heights = vec![(0, 2.5), (1, 1.0), (2, 2.0)];
        let crossing = CrossingHeights {
            site: [0.1, -2.0],
            heights,
            chosen: 1.0,
            is_added: true,
        };
        let mut bytes = Vec::new();
        names.write_table(&[crossing], &mut bytes).unwrap();
        let rows: Vec<&str> = std::str::from_utf8(&bytes)
            .unwrap()
            .lines()
            .skip(1)
            .collect();
        assert_eq!(
            rows,
            [
                "0.1,-2,1,added,1,c.shp,0,2,1,c.shp,3,1,2",
                "0.1,-2,1,added,1.5,c.shp,0,2,1,\"a,b.shp\",7,1,2.5"
            ]
        );
    }
}
