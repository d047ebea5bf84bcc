//! What is made of a job whose tasks are all done: counts, a raster, contours.

use super::Job;
use super::contours::DrawnContours;
use super::notes::Found;
use super::raster::DrawnCells;
use super::task_file::TaskName;
use crate::crs::Crs;
use crate::data::{BlockSource, Bounds};
use crate::error::{Command, Error, Result, Setting, wording};
use crate::io::contours::ContourSummary;
use crate::io::{Destination, Temporary};
use crate::run::context::notice::Notice;
use crate::run::context::{Context, Journal};
use crate::run::products::contour::ContourOptions;
use crate::run::products::frame::{self, FrameOptions};
use crate::run::products::surface::{Model, SurfaceProduct};
use crate::run::sources::open;
use crate::run::sources::tin_parts::WrittenParts;
use crate::run::verbs::Tiles;
use crate::terrain::{CellValue, GradientSource};

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
    /// Points left out because of their return.
    pub other_return: u64,
    /// Points left out because of their class.
    pub other_class: u64,
    /// Points that water and walls replaced.
    pub points_replaced: u64,
    /// What the tasks found, and what follows from it. What was known before them came with the
    /// plan.
    pub notices: Vec<Notice>,
    /// Points merged into another point at the same site.
    pub duplicates: u64,
    /// Points replaced by a breakline's vertex at the same site.
    pub points_on_breaklines: u64,
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

impl Job {
    /// Returns counts of all tasks, which must be done, and reports what they found.
    ///
    /// # Errors
    /// If a task is not done, or layers of lines cannot be read again.
    pub fn report(&self, context: &Context) -> Result<JobReport> {
        let mut report = JobReport {
            crs: self.plan.crs.clone(),
            ..JobReport::default()
        };
        let mut found = Found::default();
        let mut tasks = 0..;
        report.sources = self.open_all(|file| {
            let facts = &file.facts;
            found.add(facts, tasks.next().and_then(|task| self.file_of(task)));
            if let Some(points) = facts.read() {
                report.read += points.read;
                report.used += points.used;
                report.withheld += points.withheld;
                report.other_return += points.other_return;
                report.other_class += points.other_class;
                report.points_replaced += points.replaced;
            }
            report.duplicates += facts.duplicates;
            report.points_on_breaklines += facts.points_on_breaklines;
            report.line_edges += facts.line_edges;
            report.triangles += facts.kept.triangles;
            report.beyond_max_edge += facts.removed;
            report.clipped += facts.kept.clipped;
            report.over_skipped += facts.over_skipped;
            report.waited += facts.waiting;
            report.handed_up += facts.handed_up;
            report.area += facts.kept.area.unwrap_or(0.0);
            facts.kept.extent.add_to(&mut report.extent);
        })?;
        let journal = Journal::new(context);
        report.skipped = found.skipped(&self.plan);
        found.note(self, context, &journal)?;
        report.notices = journal.take();
        Ok(report)
    }

    /// Returns what the tasks have kept, once all are done.
    pub fn tiles<'a>(&'a self, report: &'a JobReport) -> impl Tiles {
        KeptTiles { job: self, report }
    }

    pub(super) fn require_triangles(&self, report: &JobReport) -> Result<()> {
        if report.triangles > 0 {
            return Ok(());
        }
        let JobReport {
            read,
            used,
            withheld,
            other_return,
            other_class,
            beyond_max_edge,
            clipped,
            ..
        } = report;
        Err(match (used, beyond_max_edge) {
            _ if *clipped > 0 => Error::format(format!(
                "no triangle is left: {clipped} lie {}",
                self.request.what_is_clipped()
            ))
            .cure(wording![
                "check them, and the coordinate systems: ",
                Command::Info,
                " shows the extent of each file"
            ]),
            (0, _) => Error::usage(format!(
                "no point is left of {read} read: {withheld} withheld, {other_return} of other returns, \
                 {other_class} of other classes"
            ))
            .cure(wording![
                Command::Info,
                " counts the points of each class and return: choose with ",
                Setting::Class,
                " and ",
                Setting::Return
            ]),
            (_, 0) => Error::format(format!(
                "{used} points on one line, or fewer than three, do not span a surface"
            ))
            .cure(wording![
                "check the inputs and the classes (",
                Setting::Class,
                ")"
            ]),
            _ => Error::format(format!(
                "no triangle is left: {beyond_max_edge} are left out at the rim, with long edges or as flat ones"
            ))
            .cure(wording![
                "allow them with ",
                Setting::MaxEdge.number("LENGTH"),
                " or ",
                Setting::MaxEdge.text("none")
            ]),
        })
    }

    /// The files of all tasks that have triangles.
    fn step_files(&self) -> Vec<TaskName> {
        (self.first_step()..self.task_count())
            .map(|task| self.task_file(task))
            .collect()
    }
}

/// What the tasks of a job have kept.
struct KeptTiles<'a> {
    job: &'a Job,
    report: &'a JobReport,
}

impl KeptTiles<'_> {
    /// Returns what was drawn in cells.
    fn cells<V: CellValue>(
        &self,
        options: &FrameOptions,
        context: &Context,
    ) -> Result<DrawnCells<V>> {
        let KeptTiles { job, report } = self;
        job.require_triangles(report)?;
        let Some(drawn) = job.plan.frame else {
            return Err(Error::usage("the job makes no raster"));
        };
        let frame = frame::over_extent(
            options,
            report.extent,
            report.crs.as_ref(),
            &Journal::new(context),
        )?;
        frame::require_filled(options, &frame, &report.extent, || report.area)?;
        DrawnCells::open(
            job.step_files(),
            (drawn, job.plan.blocks_before),
            frame,
            report.crs.clone(),
        )
    }
}

impl Tiles for KeptTiles<'_> {
    fn heights(&self, options: &FrameOptions, context: &Context) -> Result<Box<dyn BlockSource>> {
        Ok(Box::new(self.cells::<f32>(options, context)?))
    }

    fn gradients(
        &self,
        options: &FrameOptions,
        context: &Context,
    ) -> Result<Box<dyn GradientSource>> {
        Ok(Box::new(self.cells::<[f64; 2]>(options, context)?))
    }

    fn write_contours(
        &self,
        contours: &ContourOptions,
        target: Destination,
        context: &Context,
    ) -> Result<ContourSummary> {
        let KeptTiles { job, report } = self;
        job.require_triangles(report)?;
        let drawn = DrawnContours::open(job.step_files(), &contours.to_levels()?)?;
        target.put_whole(|target| drawn.write(target, report.crs.as_ref(), context))
    }

    fn surface(&self, context: &Context) -> Result<SurfaceProduct> {
        let parent = self.job.folder();
        let folder = Temporary::folder_in(parent).map_err(|e| Error::from(e).in_file(parent))?;
        let index = folder.path().join("surface.tins");
        self.write_parts(Destination::from(&index), context)?
            .keep()?;
        let parts = open::owned_parts(&index, folder)?;
        Ok(Model::Parts(Box::new(parts)).into())
    }

    fn write_parts(&self, target: Destination, context: &Context) -> Result<WrittenParts> {
        self.job.write_surface(self.report, target, context)
    }
}
