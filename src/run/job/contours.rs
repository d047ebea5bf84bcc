//! The contours that all tasks have drawn, joined.

use std::cell::RefCell;

use super::bytes::{Reader, put_block, put_numbers};
use super::task_file::{Block, TaskFile, TaskName, TaskWriter};
use crate::crs::Crs;
use crate::data::ContourLine;
use crate::error::Result;
use crate::io::Destination;
use crate::io::contours::{self, ContourSummary};
use crate::run::context::{Context, Size, Stage};
use crate::run::contour::edge_count;
use crate::terrain::Levels;
use crate::terrain::contour::parts::{ContourParts, LevelParts, join_level};

/// The name of the section that has the heights of the triangles of a task, and where the parts of
/// each level are.
const LEVELS: &str = "levels";

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
    writer.put(&table)
}

/// Where the parts of each level are in the file of a task, by ascending levels.
type LevelTable = Vec<(f64, Block)>;

/// Returns the lowest and the highest height of the triangles of a task, and the table of its
/// levels; `None` if the bytes are not those of such a table.
fn to_table(bytes: &[u8]) -> Option<([f64; 2], LevelTable)> {
    let mut reader = Reader::new(bytes);
    let heights = [reader.f64()?, reader.f64()?];
    let mut table = Vec::new();
    while !reader.is_empty() {
        table.push((reader.f64()?, reader.block()?));
    }
    table.is_sorted_by(|a, b| a.0 < b.0).then_some((heights, table))
}

/// The parts of contours in the files of all tasks.
pub(super) struct DrawnContours {
    /// The files, with the positions of their parts.
    tasks: Vec<(TaskName, LevelTable)>,
    /// All levels within the heights of the surface.
    levels: Vec<f64>,
    /// The number of edges of all lines.
    edges: u64,
}

impl DrawnContours {
    /// Opens the parts in these files.
    ///
    /// # Errors
    /// If a file is missing or damaged, or there are too many levels (see [`Levels::within`]).
    pub(super) fn open(names: Vec<TaskName>, levels: &Levels) -> Result<Self> {
        let mut tasks = Vec::new();
        let mut edges = 0;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for name in names {
            let mut file = TaskFile::open_done(&name)?;
            edges += file.count("edges");
            let (heights, table) = to_table(&file.section(LEVELS)?).ok_or_else(|| file.damaged())?;
            (low, high) = (low.min(heights[0]), high.max(heights[1]));
            tasks.push((name, table));
        }
        Ok(DrawnContours { tasks, levels: levels.within(low, high)?, edges })
    }

    /// Joins the lines of all levels and writes them one after another.
    pub(super) fn write(&self, target: Destination, crs: Option<&Crs>, context: &Context) -> Result<ContourSummary> {
        contours::check_size(target, self.edges)?;
        let drawing = context.start(Stage::DrawingContours, Size::Items(self.edges))?;
        // The writer takes lines, so an error has to wait until it ends.
        let failed = RefCell::new(Ok(()));
        let lines_of = |&level: &f64| match self.lines(level) {
            Ok(lines) => lines,
            Err(error) => {
                *failed.borrow_mut() = Err(error);
                Vec::new()
            }
        };
        let is_wanted = |line: &ContourLine| failed.borrow().is_ok() && drawing.add(edge_count(line)).is_ok();
        let mut lines = self.levels.iter().flat_map(lines_of).take_while(is_wanted);
        let written = contours::write(target, &mut lines, crs);
        drop(lines);
        failed.into_inner()?;
        drawing.end()?;
        written
    }

    /// Returns the lines of a level, sorted by their points.
    fn lines(&self, level: f64) -> Result<Vec<ContourLine>> {
        let mut parts = Vec::new();
        let mut bytes = Vec::new();
        for (name, table) in &self.tasks {
            let Ok(at) = table.binary_search_by(|(own, _)| own.total_cmp(&level)) else { continue };
            TaskFile::open_done(name)?.read(table[at].1, &mut bytes)?;
            parts.push(LevelParts::read(level, &bytes).map_err(|e| e.in_file(&name.path))?);
        }
        join_level(level, parts)
    }
}
