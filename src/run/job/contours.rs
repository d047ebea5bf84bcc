//! The contours that all tasks have drawn, joined.

use std::cell::RefCell;

use super::bytes::{NumberReader, put_block, put_numbers};
use super::task_file::{Block, TaskFile, TaskName, TaskWriter};
use crate::crs::Crs;
use crate::data::ContourLine;
use crate::error::{Error, Result, Setting, wording};
use crate::io::Destination;
use crate::io::contours::{self, ContourSummary};
use crate::run::context::{Context, Size, Stage};
use crate::terrain::Levels;
use crate::terrain::contour::parts::{BendFinder, Bends, ContourParts, LevelParts, join_level};

/// The name of the section that has the heights of the triangles of a task, and where the parts of
/// each level are.
const LEVELS: &str = "levels";

/// The name of the section that has the levels whose arcs may bend.
const MAY_BEND: &str = "may bend";

/// Writes the parts of the contours of a task.
pub(super) fn write(parts: &ContourParts, writer: &mut TaskWriter) -> Result<()> {
    let mut table = Vec::new();
    put_numbers(&mut table, &parts.heights());
    writer.begin("contours");
    let mut bytes = Vec::new();
    for of_level in parts.levels() {
        bytes.clear();
        of_level.write(&mut bytes)?;
        put_numbers(&mut table, &[of_level.level()]);
        put_block(&mut table, writer.put_block(&bytes)?);
    }
    writer.begin(LEVELS);
    writer.put(&table)?;
    writer.begin(MAY_BEND);
    let may_bend = parts.levels().iter().filter(|level| level.may_bend());
    let mut bytes = Vec::new();
    may_bend.for_each(|level| put_numbers(&mut bytes, &[level.level()]));
    writer.put(&bytes)
}

/// Where the parts of each level are in the file of a task, by ascending levels.
type LevelTable = Vec<(f64, Block)>;

/// Returns the lowest and the highest height of the triangles of a task, and the table of its
/// levels; `None` if the bytes are not those of such a table.
fn to_table(bytes: &[u8]) -> Option<([f64; 2], LevelTable)> {
    let mut reader = NumberReader::new(bytes);
    let heights = [reader.f64()?, reader.f64()?];
    let mut table = Vec::new();
    while !reader.is_empty() {
        table.push((reader.f64()?, reader.block()?));
    }
    table
        .is_sorted_by(|a, b| a.0 < b.0)
        .then_some((heights, table))
}

/// Returns levels in bytes; `None` if the bytes are not those of numbers.
fn to_levels(bytes: &[u8]) -> Option<Vec<f64>> {
    let mut reader = NumberReader::new(bytes);
    let mut levels = Vec::new();
    while !reader.is_empty() {
        levels.push(reader.f64()?);
    }
    Some(levels)
}

/// The bytes of parts that are read at once, unless one level has more. The file of each task is
/// opened once for them.
const BAND: u64 = 32 << 20;

/// The parts of contours in the files of all tasks.
pub(super) struct DrawnContours {
    /// The files, with the positions of their parts.
    tasks: Vec<(TaskName, LevelTable)>,
    /// The levels that have parts, ascending, each with the number of their bytes.
    levels: Vec<(f64, u64)>,
    /// Those whose arcs may bend, ascending.
    may_bend: Vec<(f64, u64)>,
    /// The number of edges of all lines.
    edges: u64,
}

impl DrawnContours {
    /// Opens the parts in these files.
    ///
    /// # Errors
    /// If a file is missing or damaged, or there are too many levels (see [`Levels::within`]).
    ///
    /// # Complexity
    /// O(n log m) for n levels in the tables of all files, of which m differ. The tables stay in
    /// memory, 32 bytes for each level.
    pub(super) fn open(names: Vec<TaskName>, levels: &Levels) -> Result<Self> {
        let mut tasks = Vec::new();
        let (mut edges, mut bending) = (0, Vec::new());
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for name in names {
            let mut file = TaskFile::open_done(&name)?;
            edges += file.facts.kept.contour_edges;
            let (heights, table) =
                to_table(&file.section(LEVELS)?).ok_or_else(|| file.damaged())?;
            (low, high) = (low.min(heights[0]), high.max(heights[1]));
            let bytes = file.section(MAY_BEND)?;
            bending.extend(to_levels(&bytes).ok_or_else(|| file.damaged())?);
            tasks.push((name, table));
        }
        let mut levels: Vec<(f64, u64)> = levels
            .within(low, high)?
            .into_iter()
            .map(|level| (level, 0))
            .collect();
        for (name, table) in &tasks {
            for (level, block) in table {
                let at = position(&levels, *level)
                    .ok_or_else(|| no_level(*level).in_file(&name.path))?;
                levels[at].1 = levels[at].1.saturating_add(block.length);
            }
        }
        levels.retain(|(_, bytes)| *bytes > 0);
        bending.sort_by(f64::total_cmp);
        let is_bending = |level: &f64| bending.binary_search_by(|b| b.total_cmp(level)).is_ok();
        let may_bend = levels.iter().filter(|(level, _)| is_bending(level));
        Ok(DrawnContours {
            may_bend: may_bend.copied().collect(),
            tasks,
            levels,
            edges,
        })
    }

    /// Joins the lines of all levels and writes them one after another.
    pub(super) fn write(
        &self,
        target: Destination,
        crs: Option<&Crs>,
        context: &Context,
    ) -> Result<ContourSummary> {
        contours::check_size(target, self.edges)?;
        let bends = self.bends(context)?;
        let drawing = context.start(Stage::DrawingContours, Size::Items(self.edges))?;
        // The writer takes lines, so an error has to wait until it ends.
        let failed = RefCell::new(Ok(()));
        let fail = |error: Error| *failed.borrow_mut() = Err(error);
        let read = |band| self.read(band).map_err(fail).unwrap_or_default();
        let join = |(level, parts)| {
            let lines = join_level(level, parts, &bends);
            lines.map_err(fail).unwrap_or_default()
        };
        let is_wanted =
            |line: &ContourLine| failed.borrow().is_ok() && drawing.add(line.edge_count()).is_ok();
        let mut lines = bands(&self.levels)
            .flat_map(read)
            .flat_map(join)
            .take_while(is_wanted);
        let written = contours::write(target, &mut lines, crs);
        drop(lines);
        failed.into_inner()?;
        drawing.end()?;
        written
    }

    /// Returns where arcs are bent, lest they cross those of other levels.
    fn bends(&self, context: &Context) -> Result<Bends> {
        let mut finder = BendFinder::default();
        for band in bands(&self.may_bend) {
            context.check()?;
            for (level, parts) in self.read(band)? {
                finder.add(level, parts)?;
            }
        }
        Ok(finder.finish())
    }

    /// Returns the parts of each level of a band.
    fn read(&self, band: &[(f64, u64)]) -> Result<Vec<(f64, Vec<LevelParts>)>> {
        let mut parts: Vec<(f64, Vec<LevelParts>)> =
            band.iter().map(|(level, _)| (*level, Vec::new())).collect();
        let Some((first, _)) = band.first() else {
            return Ok(parts);
        };
        let mut bytes = Vec::new();
        for (name, table) in &self.tasks {
            let from = table.partition_point(|(level, _)| level.total_cmp(first).is_lt());
            let stored = table[from..]
                .iter()
                .map_while(|(level, block)| Some((position(band, *level)?, block)));
            let mut file = None;
            for (at, &block) in stored {
                let file = match &mut file {
                    Some(file) => file,
                    None => file.insert(TaskFile::open_done(name)?),
                };
                file.read(block, &mut bytes)?;
                parts[at]
                    .1
                    .push(LevelParts::read(band[at].0, &bytes).map_err(|e| e.in_file(&name.path))?);
            }
        }
        Ok(parts)
    }
}

/// Divides levels into bands whose parts are read together: of [`BAND`] bytes, or of one level.
fn bands(levels: &[(f64, u64)]) -> impl Iterator<Item = &[(f64, u64)]> {
    let mut rest = levels;
    std::iter::from_fn(move || {
        let mut bytes = 0_u64;
        let fits = |(_, of_level): &&(f64, u64)| {
            bytes = bytes.saturating_add(*of_level);
            bytes <= BAND
        };
        let count = rest.iter().take_while(fits).count().max(1);
        let (band, others) = rest.split_at_checked(count)?;
        rest = others;
        Some(band)
    })
}

/// Returns where a level is among others, ascending.
fn position(levels: &[(f64, u64)], level: f64) -> Option<usize> {
    levels
        .binary_search_by(|(other, _)| other.total_cmp(&level))
        .ok()
}

#[cold]
fn no_level(level: f64) -> Error {
    Error::format(format!(
        "the file of a task has contours at {level}, which is none of the levels"
    ))
    .cure(wording![
        "remove it, and run the job again with ",
        Setting::Resume.on()
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each file is opened once a band: many levels with few bytes are one.
    #[test]
    fn levels_are_read_in_bands() {
        let of = |levels: &[(f64, u64)]| bands(levels).map(<[_]>::len).collect::<Vec<_>>();
        let levels = |bytes: &[u64]| {
            (0..)
                .map(f64::from)
                .zip(bytes.iter().copied())
                .collect::<Vec<_>>()
        };
        assert!(of(&[]).is_empty());
        assert_eq!(of(&levels(&[5000; 6000])), [6000]);
        assert_eq!(
            of(&levels(&[BAND / 2, BAND / 2, 1, BAND, 2 * BAND, 7, 7])),
            [2, 1, 1, 1, 2]
        );
    }
}
