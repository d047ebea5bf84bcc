//! What is told of breaklines that cross.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::talk::Talk;
use crate::error::{Error, Result};
use crate::io::{Output, OutputSet};
use crate::run::lines::Drawn;
use crate::run::units::{Units, neat};
use crate::terrain::{CrossingHeights, TinReport};
use crate::triangulation::Rounding;

/// How many places are listed one by one.
const LISTED: usize = 5;

/// What the user calls each line of the surface: its file, feature id and part.
pub(super) struct LineNames<'a> {
    files: &'a [PathBuf],
    lines: Vec<LineName>,
}

/// Many lines may come of one, at the rim of a window.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct LineName {
    file: usize,
    fid: usize,
    part: Option<usize>,
}

impl<'a> LineNames<'a> {
    pub(super) fn new(files: &'a [PathBuf]) -> Self {
        LineNames { files, lines: Vec::new() }
    }

    /// Puts down where the next line of the surface comes from.
    pub(super) fn add(&mut self, file: usize, line: &Drawn) {
        self.lines.push(LineName { file, fid: line.fid, part: line.part });
    }

    /// "edges.shp fid 12, part 2"
    pub(super) fn tell(&self, line: usize) -> String {
        let LineName { file, fid, part } = self.lines[line];
        let part = part.map(|part| format!(", part {part}")).unwrap_or_default();
        format!("{} fid {fid}{part}", self.files[file].display())
    }

    /// `edges.shp,12,2`
    fn columns(&self, line: usize) -> String {
        let LineName { file, fid, part } = self.lines[line];
        format!("{},{fid},{}", quoted(&self.files[file]), part.unwrap_or(1))
    }
}

/// A name as a field of a table.
fn quoted(path: &Path) -> String {
    let text = path.to_string_lossy();
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.into_owned() }
}

/// Says how crossings were rounded, and where the heights of lines that meet differ.
pub(super) fn tell(report: &TinReport, names: &LineNames, units: &Units, talk: &Talk) {
    if let Some(rounding) = report.rounding {
        talk.note(rounded(rounding, units));
    }
    let differing = &report.crossing_heights;
    let by_difference = |p: &&CrossingHeights, q: &&CrossingHeights| p.difference().total_cmp(&q.difference());
    let Some(worst) = differing.iter().rev().max_by(by_difference) else { return };
    let places = if differing.len() == 1 { "1 place" } else { &format!("{} places", differing.len()) };
    let [x, y] = worst.place.map(neat);
    talk.warning(format_args!(
        "breaklines meet with different heights at {places}, by up to {} (at {x} {y})",
        units.height(worst.difference())
    ));
    for crossing in differing.iter().take(LISTED) {
        let [x, y] = crossing.place.map(neat);
        let [low, high] = crossing.extremes().map(|(line, z)| format!("{} of {}", neat(z), names.tell(line)));
        talk.line(format_args!("            {x} {y}: {low}, {high}; {} stands", neat(crossing.chosen)));
    }
    if differing.len() > LISTED {
        talk.line(format_args!("            and {} more (--crossing-report FILE.csv)", differing.len() - LISTED));
    }
}

fn rounded(Rounding { unit: [ux, uy], on_grid }: Rounding, units: &Units) -> String {
    let unit = match ux == uy {
        true => units.length(ux),
        false => format!("{} in x and {} in y", units.length(ux), units.length(uy)),
    };
    let bound = match on_grid {
        true => "no line is moved by more than half of that on each axis",
        false => "some vertices are finer, so that no bound is proven where lines cross close by them",
    };
    format!("crossings of breaklines are rounded to {unit}; {bound}")
}

/// Adds the places where the heights of lines differ to the outputs, as a table: of each place a row for every line above the lowest.
/// Numbers read back are the same doubles.
///
/// # Errors
/// If the file cannot be written.
pub(super) fn write(
    outputs: &OutputSet,
    target: &Path,
    crossings: &[CrossingHeights],
    names: &LineNames,
) -> Result<()> {
    let mut output = Output::create(target)?;
    write_rows(&mut output, crossings, names).map_err(|e| Error::from(e).in_file(target))?;
    outputs.add(output);
    Ok(())
}

fn write_rows(out: &mut impl Write, crossings: &[CrossingHeights], names: &LineNames) -> std::io::Result<()> {
    writeln!(out, "x,y,z,vertex,difference,low_file,low_fid,low_part,low_z,high_file,high_fid,high_part,high_z")?;
    for CrossingHeights { place: [x, y], heights, chosen, is_added } in crossings {
        let mut heights = heights.clone();
        heights.sort_by(|&(p, low), &(q, high)| low.total_cmp(&high).then(names.lines[p].cmp(&names.lines[q])));
        let vertex = if *is_added { "added" } else { "given" };
        let Some((&(low, lowest), above)) = heights.split_first() else { continue };
        for &(line, z) in above {
            let (low, high, difference) = (names.columns(low), names.columns(line), z - lowest);
            writeln!(out, "{x},{y},{chosen},{vertex},{difference},{low},{lowest},{high},{z}")?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_for_every_line_above_the_lowest() {
        let files = [PathBuf::from("a,b.shp"), PathBuf::from("c.shp")];
        let mut names = LineNames::new(&files);
        for (file, fid, part) in [(0, 7, None), (1, 0, Some(2)), (1, 3, None)] {
            names.add(file, &Drawn { fid, part, points: Vec::new() });
        }
        assert_eq!([0, 1].map(|line| names.tell(line)), ["a,b.shp fid 7", "c.shp fid 0, part 2"]);
        let heights = vec![(0, 2.5), (1, 1.0), (2, 2.0)];
        let crossing = CrossingHeights { place: [0.1, -2.0], heights, chosen: 1.0, is_added: true };
        let mut bytes = Vec::new();
        write_rows(&mut bytes, &[crossing], &names).unwrap();
        let rows: Vec<&str> = std::str::from_utf8(&bytes).unwrap().lines().skip(1).collect();
        assert_eq!(
            rows,
            ["0.1,-2,1,added,1,c.shp,0,2,1,c.shp,3,1,2", "0.1,-2,1,added,1.5,c.shp,0,2,1,\"a,b.shp\",7,1,2.5"]
        );
    }
}
