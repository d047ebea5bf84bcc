//! Writing what a verb makes of a surface: the one entry for all callers.

mod report;

pub use self::report::{Origin, SurfaceReport, WriteReport, Written, WrittenOf};

use std::path::PathBuf;

use super::context::Context;
use super::event::Event;
use super::job::{Job, JobCommand, JobLock, NotInTiles, TileOptions, needs_tiles};
use super::point_files::BadFiles;
use super::targets::{self, Outputs, Targets};
use super::verbs::{Summary, TileUse, WriteRequest};
use crate::error::{Error, Result};

/// How a request is worked on.
#[derive(Debug, Clone)]
pub enum Execution {
    /// In one piece, or in tiles if it would need more memory.
    Auto {
        /// The memory to use, in bytes; half of the free memory if it is `None`.
        memory: Option<u64>,
    },
    /// In one piece.
    Whole,
    /// In tiles. A job must not be there.
    Tiles(TileOptions),
    /// In tiles, going on with the job in the folder, if there is one.
    Resume(TileOptions),
    /// Not at all: tiles are planned, and nothing is written.
    Plan(TileOptions),
}

impl Default for Execution {
    fn default() -> Self {
        Execution::Auto { memory: None }
    }
}

/// Writes what a verb makes of a surface. All outputs appear at the end, or none.
///
/// The result is the same, byte for byte, in one piece and in tiles.
///
/// # Errors
/// If the request cannot be read or worked on, an output cannot be written or may not be replaced,
/// or the run is canceled. What the tasks of a job have done is kept then.
///
/// ```
/// use breakline::run::{self, Context, DemOptions, Execution, Source, SurfaceRequest, Targets, WriteReport, WriteRequest};
///
/// # fn main() -> breakline::Result<()> {
/// # let folder = tempfile::tempdir()?;
/// # let target = folder.path().join("dem.tif");
/// let source = Source::of_files(&["fixtures/valley.laz".into()])?;
/// let surface = SurfaceRequest { source, ..SurfaceRequest::default() };
/// let request = WriteRequest::new(surface, DemOptions::default());
/// // 200 MB: in tiles, if there were more points.
/// let execution = Execution::Auto { memory: Some(200_000_000) };
/// let report = run::write(&request, &Targets::of(&target), &execution, &Context::default())?;
/// assert!(matches!(report, WriteReport::Written(_)) && target.exists());
/// # Ok(())
/// # }
/// ```
pub fn write(
    request: &WriteRequest,
    targets: &Targets,
    execution: &Execution,
    context: &Context,
) -> Result<WriteReport> {
    let mut prepared = Prepared::new(request, targets)?;
    match execution {
        Execution::Whole => prepared.whole(context),
        Execution::Auto { memory } => {
            if prepared.needs_tiles(*memory, context) {
                prepared.anew(&TileOptions { memory: *memory, ..TileOptions::default() }, context)
            } else {
                prepared.whole(context)
            }
        }
        Execution::Tiles(options) => prepared.anew(options, context),
        Execution::Resume(options) => prepared.go_on(options, context),
        Execution::Plan(options) => {
            let job = prepared.planned(options, context)?;
            Ok(WriteReport::Planned { size: job.size(), folder: job.folder().to_path_buf() })
        }
    }
}

/// Plans a job for a request, whose tasks can then be done one by one, once it is
/// [created](Job::create), by [`run_task`]. The outputs are checked now.
///
/// # Errors
/// Those of [`Job::plan`]; if an output cannot be written or may not be replaced, or the files of
/// the tasks cannot fit on the disk.
pub fn plan(request: &WriteRequest, targets: &Targets, options: &TileOptions, context: &Context) -> Result<Job> {
    Prepared::new(request, targets)?.planned(options, context)
}

/// Does a task of a job; the last one writes the outputs, unless they are there as it was done
/// before. Returns what was written, for the last one.
///
/// The plan does not change, and no input is looked at but the one that the task reads.
///
/// # Errors
/// If a task that it needs is not done, if its input cannot be read, or another than planned; for
/// the last one, those of [`write`]; and if there is no task with this number.
pub fn run_task(job: &Job, task: usize, targets: &Targets, context: &Context) -> Result<Option<WriteReport>> {
    if task < job.task_count() {
        return job.run_task(task, context).map(|()| None);
    }
    job.require_done(task)?;
    // Like any task, the last one may be repeated: its process may have been killed after it.
    if let Some(output) = targets.files.first().filter(|output| job.has_written(output)) {
        return Ok(Some(WriteReport::Kept { output: output.clone(), has_holes: job.has_holes() }));
    }
    let request = job.request();
    let mut prepared = Prepared::new(&request, targets)?;
    prepared.folder(&TileOptions { folder: Some(job.folder().to_path_buf()), ..TileOptions::default() })?;
    require_room(job, context)?;
    let lock = job.lock()?;
    prepared.clear_up(job, &lock, context)?;
    prepared.run(job, &lock, Folder::Kept, context).map(Some)
}

/// A request whose outputs are checked.
struct Prepared<'a> {
    request: &'a WriteRequest,
    targets: &'a Targets,
    outputs: Outputs,
    use_of_tiles: TileUse,
}

impl<'a> Prepared<'a> {
    fn new(request: &'a WriteRequest, targets: &'a Targets) -> Result<Self> {
        let verb = request.verb.as_ref();
        verb.check()?;
        let mut read = targets.read_with(&request.surface);
        read.extend(verb.also_reads().cloned());
        let outputs = targets.resolve(verb.product(), &read)?;
        let use_of_tiles = verb.use_of_tiles(&outputs.targets)?;
        Ok(Prepared { request, targets, outputs, use_of_tiles })
    }

    /// Returns the error for what was asked for that tiles do not have.
    fn refused(&self) -> Option<Error> {
        let Targets { crossings, replaced, .. } = self.targets;
        let tables = [(crossings, NotInTiles::CrossingReport), (replaced, NotInTiles::ReplacedPoints)];
        tables.into_iter().find(|(table, _)| table.is_some()).map(|(_, what)| what.into())
    }

    /// Returns true if the request has to be worked on in tiles.
    fn needs_tiles(&self, memory: Option<u64>, context: &Context) -> bool {
        let unused = |error: &Error| {
            if memory.is_some() {
                context.monitor.event(&Event::MemoryUnused(error));
            }
            false
        };
        match (&self.use_of_tiles, self.refused()) {
            (TileUse::Always, _) => true,
            (TileUse::Never(error), _) => unused(error),
            (TileUse::Optional, Some(error)) => unused(&error),
            // Building in one piece reports what is wrong with files.
            (TileUse::Optional, None) => {
                needs_tiles(self.request, memory, context).unwrap_or_else(|error| unused(&error))
            }
        }
    }

    fn whole(self, context: &Context) -> Result<WriteReport> {
        let Prepared { request: WriteRequest { surface, verb }, targets, outputs, .. } = self;
        let product = verb.surface(surface, context)?;
        targets.write_tables(&product, &outputs.set)?;
        let summary = verb.write(&product, &outputs, context)?;
        let surface = WrittenOf::Whole(SurfaceReport::of(&product)?);
        // Its memory is not needed while the disk is waited for.
        drop(product);
        let files = outputs.set.commit()?;
        context.monitor.event(&Event::Written);
        Ok(WriteReport::Written(Box::new(Written { surface, summary, files })))
    }

    /// Returns the folder of a job, if tiles can be made.
    fn folder(&mut self, options: &TileOptions) -> Result<PathBuf> {
        if let TileUse::Never(error) = std::mem::replace(&mut self.use_of_tiles, TileUse::Always) {
            return Err(error);
        }
        self.refused().map_or(Ok(()), Err)?;
        let [target, ..] = &self.outputs.targets[..] else {
            return Err(Error::usage("no output is named"));
        };
        let folder = options.folder.clone().unwrap_or_else(|| {
            let mut name = target.path.as_os_str().to_owned();
            name.push(".job");
            PathBuf::from(name)
        });
        match folder == target.path {
            true => Err(Error::usage("the output and the folder of the job have the same name").in_file(&target.path)),
            false => Ok(folder),
        }
    }

    /// Plans a job, and makes sure that it has room.
    fn planned(&mut self, options: &TileOptions, context: &Context) -> Result<Job> {
        let folder = self.folder(options)?;
        let job = Job::plan(self.request, &folder, options, context)?;
        require_room(&job, context)?;
        Ok(job)
    }

    /// Plans a job and does it.
    fn anew(mut self, options: &TileOptions, context: &Context) -> Result<WriteReport> {
        let mut job = self.planned(options, context)?;
        let lock = job.create(None)?;
        self.outputs.set.mark(job.mark());
        self.run(&job, &lock, is_named(options), context)
    }

    /// Goes on with a job, if there is one.
    fn go_on(mut self, options: &TileOptions, context: &Context) -> Result<WriteReport> {
        let folder = self.folder(options)?;
        let Some(mut job) = Job::open(self.request, &folder, options)? else {
            return self.anew(options, context);
        };
        require_room(&job, context)?;
        let mut lock = job.lock()?;
        match job.outgrown_by(context)? {
            Some(path) => {
                context.monitor.event(&Event::PlannedAgain(path));
                // That of a job whose tasks are done one by one; others have none.
                let command = JobCommand::read(&folder).ok().flatten();
                let options = TileOptions { bad: BadFiles::Skip, ..options.clone() };
                let anew = Job::plan(self.request, &folder, &options, context)?;
                job.remove(&lock)?;
                drop(lock);
                job = anew;
                lock = job.create(command.as_ref())?;
                self.outputs.set.mark(job.mark());
            }
            None => self.clear_up(&job, &lock, context)?,
        }
        self.run(&job, &lock, is_named(options), context)
    }

    /// Removes what a run has left when it was killed.
    fn clear_up(&self, job: &Job, lock: &JobLock, context: &Context) -> Result<()> {
        self.outputs.set.mark(job.mark());
        let done = job.clear_up(lock)?;
        self.outputs.targets.iter().try_for_each(|target| job.remove_abandoned(&target.path, lock))?;
        context.monitor.event(&Event::Resumed { done, tasks: job.task_count() });
        Ok(())
    }

    /// Does the tasks that are left, and writes the outputs.
    fn run(self, job: &Job, lock: &JobLock, keep: Folder, context: &Context) -> Result<WriteReport> {
        let Prepared { request, outputs, .. } = self;
        let folder = job.folder().to_path_buf();
        context.monitor.event(&Event::TasksBegin(&folder));
        job.run(context).inspect_err(|_| context.monitor.event(&Event::TasksFailed(&folder)))?;
        let report = job.report(context)?;
        let mut summary = request.verb.write_tiles(&job.tiles(&report), &outputs, context)?;
        let is_kept = keep == Folder::Kept || report.skipped > 0;
        if is_kept {
            job.record(&outputs.set, &report, lock)?;
        }
        let files = outputs.set.commit()?;
        if let Summary::Parts(parts) = &mut summary {
            parts.keep()?;
        }
        context.monitor.event(&Event::Written);
        if !is_kept {
            job.remove(lock)?;
        }
        let surface = WrittenOf::Tiles { report: Box::new(report), folder };
        Ok(WriteReport::Written(Box::new(Written { surface, summary, files })))
    }
}

/// What becomes of the folder of a job once the outputs are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Folder {
    /// The caller has named it: it stays.
    Kept,
    /// It goes, unless files were skipped.
    Removed,
}

fn is_named(options: &TileOptions) -> Folder {
    if options.folder.is_some() { Folder::Kept } else { Folder::Removed }
}

/// Reports what a plan consists of, and makes sure that the files of its tasks have room.
fn require_room(job: &Job, context: &Context) -> Result<()> {
    let size = job.size();
    context.monitor.event(&Event::Planned(&size));
    targets::require_room(size.disk, job.bytes_there(), job.folder(), context)
}
