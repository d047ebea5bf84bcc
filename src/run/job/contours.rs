//! The contours that all tasks have drawn, joined.

use std::cell::RefCell;
use std::path::PathBuf;

use super::task_file::TaskFile;
use crate::crs::Crs;
use crate::data::ContourLine;
use crate::error::Result;
use crate::io::Destination;
use crate::io::contours::{self, ContourSummary};
use crate::run::context::{Context, Size, Stage};
use crate::run::contour::edge_count;
use crate::terrain::Levels;
use crate::terrain::contour::parts::{LevelParts, PartsTable, join_level};

/// The name of the section of contours in the file of a task.
pub(super) const SECTION: &str = "contours";

/// The parts of contours in the files of all tasks.
pub(super) struct DrawnContours {
    /// The files, with the positions of their parts.
    tasks: Vec<(PathBuf, u64, PartsTable)>,
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
    pub(super) fn open(paths: Vec<PathBuf>, levels: &Levels) -> Result<Self> {
        let mut tasks = Vec::new();
        let mut edges = 0;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for path in paths {
            let mut file = TaskFile::open_done(&path)?;
            let (from, length) = file.range(SECTION);
            edges += file.count("edges");
            let table = PartsTable::read(&mut file.reader(from)?, length).map_err(|e| e.in_file(&path))?;
            (low, high) = (low.min(table.heights()[0]), high.max(table.heights()[1]));
            tasks.push((path, from, table));
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
        for (path, from, table) in &self.tasks {
            let Some(range) = table.range(level) else { continue };
            let mut file = TaskFile::open_done(path)?;
            let mut bytes = vec![0; (range.end - range.start) as usize];
            file.read(from + range.start, &mut bytes)?;
            parts.push(LevelParts::read(level, &bytes).map_err(|e| e.in_file(path))?);
        }
        join_level(level, parts)
    }
}
