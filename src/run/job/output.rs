//! What is made of a job whose tasks are all done: counts, a raster, contours.

use serde_json::Value;

use super::contours::DrawnContours;
use super::notes::Found;
use super::raster::DrawnCells;
use super::task_file::TaskName;
use super::{Job, TiledProduct};
use crate::crs::Crs;
use crate::data::Bounds;
use crate::error::{Command, Error, Result, Setting, wording};
use crate::io::Destination;
use crate::io::contours::ContourSummary;
use crate::run::cells::{CellProduct, HillshadeOptions};
use crate::run::context::{Context, Journal};
use crate::run::frame;
use crate::run::notice::Notice;

/// Counts of a job that is done.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct JobReport {
    /// Points read.
    pub read: u64,
    /// Points used.
    pub used: u64,
    /// Points left out because they are flagged as withheld.
    pub withheld: u64,
    /// Points left out because of their class.
    pub other_class: u64,
    /// What the tasks found, and what follows from it. What was known before them came with the
    /// plan.
    pub notices: Vec<Notice>,
    /// Points at the position of another.
    pub duplicates: u64,
    /// Edges on lines.
    pub line_edges: u64,
    /// Triangles of the surface.
    pub triangles: u64,
    /// Triangles that were left out at the rim.
    pub beyond_max_edge: u64,
    /// Triangles that no clip line comes near and that were left out.
    pub clipped: u64,
    /// Triangles that were left out because they reach into the extents of skipped files.
    pub over_skipped: u64,
    /// Triangles that waited for the decision about the rim.
    pub waited: u64,
    /// Vertices that were handed up in all.
    pub handed_up: u64,
    /// The box around the surface.
    pub extent: Bounds,
    /// Its area in plan, in square units of the data.
    pub area: f64,
    /// The checksum of the files of the tasks.
    pub(super) sources: u32,
    /// The number of files that were skipped: the result has holes.
    pub skipped: usize,
    /// The coordinate system.
    pub crs: Option<Crs>,
}

impl Job<'_> {
    /// Returns counts of all tasks, which must be done, and reports what they found.
    ///
    /// # Errors
    /// If a task is not done, or layers of lines cannot be read again.
    pub fn report(&self, context: &Context) -> Result<JobReport> {
        let mut report = JobReport { crs: self.plan.crs.clone(), ..JobReport::default() };
        let mut found = Found::default();
        let mut tasks = 0..;
        report.sources = self.open_all(|file| {
            found.add(&file, tasks.next().and_then(|task| self.file_of(task)));
            report.read += file.count("read");
            report.used += file.count("used");
            report.withheld += file.count("withheld");
            report.other_class += file.count("other_class");
            report.duplicates += file.count("duplicates");
            report.line_edges += file.count("line_edges");
            report.triangles += file.count("triangles");
            report.beyond_max_edge += file.count("removed");
            report.clipped += file.count("clipped");
            report.over_skipped += file.count("over_skipped");
            report.waited += file.count("waiting");
            report.handed_up += file.count("residual");
            report.area += file.facts.get("area").and_then(Value::as_f64).unwrap_or(0.0);
            for corner in file.facts.get("extent").and_then(Value::as_array).into_iter().flatten() {
                let coordinate = |k: usize| corner[k].as_f64().unwrap_or(f64::NAN);
                report.extent.add([coordinate(0), coordinate(1), coordinate(2)]);
            }
        })?;
        let journal = Journal::new(context);
        report.skipped = found.skipped(&self.plan);
        found.note(self, context, &journal)?;
        report.notices = journal.take();
        Ok(report)
    }

    /// Returns the cells of a raster, once all tasks are done.
    ///
    /// # Errors
    /// If a task is not done, if no triangle is left, or if the job makes no raster; and those of
    /// [`dem`](crate::run::dem).
    pub fn cells(&self, report: &JobReport, context: &Context) -> Result<CellProduct<'static>> {
        let journal = Journal::new(context);
        self.require_triangles(report)?;
        let (Some(options), Some(drawn)) = (self.product.frame(), self.plan.frame) else {
            return Err(Error::usage("the job makes no raster"));
        };
        let frame = frame::placed(options, report.extent, report.crs.as_ref(), &journal)?;
        frame::require_filled(options, &frame, &report.extent, || report.area)?;
        let drawn = DrawnCells::open(self.step_files(), drawn, frame, report.crs.clone())?;
        Ok(match self.product {
            TiledProduct::Shades(HillshadeOptions { light, .. }) => {
                CellProduct::shades_of(Box::new(drawn), light, report.crs.as_ref(), &journal)?
            }
            TiledProduct::Heights(_) | TiledProduct::Contours(_) | TiledProduct::Surface => {
                CellProduct::heights_of(Box::new(drawn), journal.take())
            }
        })
    }

    /// Writes the contours, once all tasks are done, in the format that the extension of `target`
    /// names. They are drawn level by level, and not kept.
    ///
    /// # Errors
    /// If a task is not done, if no triangle is left, or if the job makes no contours; and those of
    /// [`ContourProduct::write`](crate::run::ContourProduct::write).
    pub fn write_contours(&self, report: &JobReport, target: Destination, context: &Context) -> Result<ContourSummary> {
        self.require_triangles(report)?;
        let TiledProduct::Contours(options) = self.product else {
            return Err(Error::usage("the job makes no contours"));
        };
        let drawn = DrawnContours::open(self.step_files(), &options.to_levels()?)?;
        target.put_whole(|target| drawn.write(target, report.crs.as_ref(), context))
    }

    pub(super) fn require_triangles(&self, report: &JobReport) -> Result<()> {
        if report.triangles > 0 {
            return Ok(());
        }
        let JobReport { read, used, beyond_max_edge, clipped, .. } = report;
        Err(match (used, beyond_max_edge) {
            _ if *clipped > 0 => Error::format(format!(
                "no triangle is left: {clipped} lie outside of the boundary or the bounds"
            ))
            .cure(wording![
                "check them, and the coordinate systems: ",
                Command::Info,
                " shows the extent of each file"
            ]),
            (0, _) => Error::usage(format!("no point is left of {read} read")).cure(wording![
                Command::Info,
                " shows the classes of each file: choose with ",
                Setting::Class
            ]),
            (_, 0) => Error::format(format!("{used} points on one line, or fewer than three, do not span a surface"))
                .cure(wording!["check the inputs and the classes (", Setting::Class, ")"]),
            _ => Error::format(format!("no triangle is left: {beyond_max_edge} have edges over the limit at the rim"))
                .cure(wording![
                    "allow longer edges with ",
                    Setting::MaxEdge.number("LENGTH"),
                    " or ",
                    Setting::MaxEdge.text("none")
                ]),
        })
    }

    /// The files of all tasks that have triangles.
    fn step_files(&self) -> Vec<TaskName> {
        (self.first_step()..self.task_count()).map(|task| self.task_file(task)).collect()
    }
}
