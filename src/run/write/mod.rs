//! Writing what a verb makes of a surface: the one entry for all callers.

mod report;

pub use self::report::{Origin, SurfaceReport, WriteReport, Written, WrittenOf};

use std::path::{Path, PathBuf};

use super::job::{
    self, Job, JobCommand, JobLock, LastTask, NotInTiles, OwnFiles, StoredJob, TileOptions,
    WorkOptions, needs_tiles,
};
use super::verbs::{Summary, TileUse, WriteRequest};
use crate::error::{Error, Kind, Result, Setting, Term, Wording, wording};
use crate::run::context::Context;
use crate::run::context::event::Event;
use crate::run::context::notice::Notice;
use crate::run::sources::point_files::BadFiles;
use crate::run::verbs::targets::{self, Existing, Outputs, Targets};

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
    /// In tiles, with the job in the folder, which stays. Only the tasks are done that are
    /// affected by inputs which were changed, added or removed since. An output is replaced if it
    /// is still as that job wrote it. Without a job there, one is planned.
    Update(TileOptions),
    /// Not at all: tiles are planned as for [`Tiles`](Self::Tiles), and nothing is written.
    Plan(TileOptions),
    /// Not at all: what [`Resume`](Self::Resume) would go on with is planned, unless it is there.
    PlanResume(TileOptions),
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
    let prepared = || Prepared::new(request, targets);
    match execution {
        Execution::Update(options) => {
            update(request, targets, options, Caller::Update, |_| {}, context)
        }
        Execution::Whole => prepared()?.whole(context),
        Execution::Auto { memory } => {
            let prepared = prepared()?;
            if prepared.needs_tiles(*memory, context) {
                let options = TileOptions {
                    memory: *memory,
                    ..TileOptions::default()
                };
                prepared
                    .in_tiles()?
                    .anew(&options, Caller::Request, context)
            } else {
                prepared.whole(context)
            }
        }
        Execution::Tiles(options) => {
            prepared()?
                .in_tiles()?
                .anew(options, Caller::of(options), context)
        }
        Execution::Resume(options) => prepared()?.in_tiles()?.resume(options, context),
        Execution::Plan(options) => prepared()?.in_tiles()?.new_plan(options, context),
        Execution::PlanResume(options) => prepared()?.in_tiles()?.plan_or_job(options, context),
    }
}

/// Like [`write()`] in tiles, for files that are needed only as long as this process runs: nobody
/// goes on with the job, and its folder is that of the files.
pub(super) fn for_a_while(
    request: &WriteRequest,
    targets: &Targets,
    options: &TileOptions,
    context: &Context,
) -> Result<WriteReport> {
    Prepared::new(request, targets)?
        .in_tiles()?
        .anew(options, Caller::ForAWhile, context)
}

/// Returns true if a request would need more than `memory`, half of the free memory if it is
/// `None`, and can be worked on in tiles.
pub(super) fn is_larger(request: &WriteRequest, memory: Option<u64>, context: &Context) -> bool {
    // Building in one piece reports what is wrong with files.
    needs_tiles(request, memory, context)
        .unwrap_or_else(|error| without_tiles(memory, &error, context))
}

/// Returns false: what is worked on has no tiles. A notice says why, if memory was given.
pub(super) fn without_tiles(memory: Option<u64>, why: &Error, context: &Context) -> bool {
    if memory.is_some() {
        context.monitor.notice(&Notice::MemoryUnused(stated(why)));
    }
    false
}

/// Plans a job for a command and creates it in a folder. Its tasks can then be done one by one, by
/// [`run_task`], or all that are left, by [`run_job`]. The outputs are checked now.
///
/// # Errors
/// Those of [`Job::plan`] and [`Job::create`]; if an output cannot be written or may not be
/// replaced, or the files of the tasks cannot fit on the disk.
pub fn plan_job(command: &JobCommand, folder: &Path, context: &Context) -> Result<StoredJob> {
    let JobCommand {
        request,
        targets,
        tiles,
        ..
    } = command;
    let options = TileOptions {
        folder: Some(folder.to_path_buf()),
        ..tiles.clone()
    };
    let mut job = Prepared::new(request, targets)?
        .in_tiles()?
        .planned(&options, context)?;
    drop(job.create(Some(command), context)?);
    StoredJob::new(command.clone(), &job)
}

/// Does a task of a job; the last one writes the outputs, unless they are there because it was done
/// before. Returns what was written, for the last one.
///
/// The plan does not change. Of the points, only the file that the task reads is looked at; layers
/// of lines and a raster to align to are compared with the plan by every task.
///
/// # Errors
/// If no task has this number, if a task that it needs is not done, or if its input cannot be read
/// or has changed since it was planned. The last task also fails as [`write()`] does.
pub fn run_task(
    job: &Job,
    task: usize,
    targets: &Targets,
    context: &Context,
) -> Result<Option<WriteReport>> {
    job.check_inputs_of([task], context)?;
    if task < job.task_count() {
        return job.run_task(task, context).map(|()| None);
    }
    job.require_done(task, context)?;
    // Like any task, the last one may be repeated: its process may have been killed after it.
    if let Some(report) = already_written(job, targets, context)? {
        return Ok(Some(report));
    }
    require_room(job, context)?;
    let lock = job.lock(context)?;
    write_output(job, targets, &lock, Caller::Folder, context).map(Some)
}

/// Writes the outputs of a job, after what is left to do.
fn write_output(
    job: &Job,
    targets: &Targets,
    lock: &JobLock,
    caller: Caller,
    context: &Context,
) -> Result<WriteReport> {
    let request = job.request();
    let prepared = Prepared::of_job(&request, targets, job.folder(), context)?.in_tiles()?;
    prepared.clear_up(job, lock, context)?;
    prepared.run(job, lock, caller, context)
}

/// Does tasks of a job together with other processes that do the same, on any number of hosts,
/// until all are done; one of them writes the outputs. Nobody distributes the tasks: each process
/// takes what is free.
///
/// A task belongs to the process that has its lease, a file in the folder. A process that is killed
/// loses its leases when they expire, and others do its tasks. Files that were skipped are not
/// tried again; [`run_job`] does that.
///
/// # Errors
/// If an input has changed, or the job was removed or replaced; the first error of a task that this
/// process does, or of the outputs; and those of [`write()`]. A process that works on the whole job
/// is waited for; if it updates the job, `stored` is then the job as it is planned now.
pub fn work_job(
    stored: &StoredJob,
    options: &WorkOptions,
    context: &Context,
) -> Result<WriteReport> {
    let mut now = stored.clone();
    loop {
        let job = now.job()?;
        stored.follow(&job);
        let ended = work_on(&job, &now.command.targets, options, context);
        match &ended {
            Err(error) if error.kind() == Kind::OtherJob => {}
            _ => return ended,
        }
        match StoredJob::updated(&job) {
            // Another process has updated it.
            Ok(Some(next)) => now = next,
            _ => return ended,
        }
    }
}

/// Does tasks of a job as it is planned now.
fn work_on(
    job: &Job,
    targets: &Targets,
    options: &WorkOptions,
    context: &Context,
) -> Result<WriteReport> {
    let last = LastOutput { job, targets };
    // Before hours of work. Asked first: another process may be about to write the outputs.
    let request = job.request();
    let prepared =
        Prepared::of_job(&request, targets, job.folder(), context).and_then(Prepared::in_tiles);
    if let Some(report) = last.written(context)? {
        return Ok(report);
    }
    drop(prepared?);
    require_room(job, context)?;
    context.monitor.event(&Event::TasksBegin(job.folder()));
    job.work(options, &last, context)
}

/// The outputs of a job that several processes share.
struct LastOutput<'a> {
    job: &'a Job,
    targets: &'a Targets,
}

impl LastTask for LastOutput<'_> {
    type Report = WriteReport;

    fn written(&self, context: &Context) -> Result<Option<WriteReport>> {
        already_written(self.job, self.targets, context)
    }

    fn write(&self, lock: &JobLock, context: &Context) -> Result<WriteReport> {
        write_output(self.job, self.targets, lock, Caller::Worker, context)
    }
}

/// Does all that is left of a job, which must be there, and writes the outputs; nothing if they are
/// there as they were written of the same tasks. Files that were skipped are tried again, and the
/// outputs replaced; if they do not fit the plan, the job is planned again, and `stored` is then
/// the new one.
///
/// # Errors
/// If an input has changed, or the job was removed or replaced; and those of [`write()`].
pub fn run_job(stored: &StoredJob, context: &Context) -> Result<WriteReport> {
    let JobCommand {
        request,
        targets,
        tiles,
        ..
    } = &stored.command;
    let job = stored.job()?;
    job.check_inputs(context)?;
    let mut targets = targets.clone();
    match already_written(&job, &targets, context)? {
        Some(WriteReport::Kept {
            has_holes: true, ..
        }) => targets.existing = Existing::Replace,
        Some(report) => return Ok(report),
        None => {}
    }
    Prepared::of_job(request, &targets, stored.folder(), context)?
        .in_tiles()?
        .go_on(
            job,
            tiles,
            Caller::Folder,
            |job| stored.follow(job),
            context,
        )
}

/// Does the tasks of a job again that are affected by inputs which have changed since it was
/// planned. Outputs are replaced if they are still as the job wrote them. `stored` is then the job
/// as it is planned now.
///
/// # Errors
/// Those of [`run_job`].
pub fn update_job(stored: &StoredJob, context: &Context) -> Result<WriteReport> {
    let JobCommand {
        request,
        targets,
        tiles,
        ..
    } = &stored.command;
    let options = TileOptions {
        folder: Some(stored.folder().to_path_buf()),
        ..tiles.clone()
    };
    let planned = |job: &Job| stored.follow(job);
    update(request, targets, &options, Caller::Folder, planned, context)
}

/// Plans a job again, does the tasks that changed inputs reach, and replaces the outputs.
fn update(
    request: &WriteRequest,
    targets: &Targets,
    options: &TileOptions,
    caller: Caller,
    planned: impl FnOnce(&Job),
    context: &Context,
) -> Result<WriteReport> {
    let prepared = match folder_of(options, targets) {
        Some(folder) => Prepared::of_job(request, targets, &folder, context),
        None => Prepared::new(request, targets),
    };
    prepared?
        .in_tiles()?
        .update(options, caller, planned, context)
}

/// Returns the folder of a job; `None` if neither it nor an output is named.
fn folder_of(options: &TileOptions, targets: &Targets) -> Option<PathBuf> {
    options.folder.clone().or_else(|| targets.job_folder())
}

/// Returns the report of outputs that are there as they were written of the tasks that are done.
fn already_written(job: &Job, targets: &Targets, context: &Context) -> Result<Option<WriteReport>> {
    let Some(output) = targets.files.first() else {
        return Ok(None);
    };
    match job.has_written(&targets.files, context)? {
        true => Ok(Some(WriteReport::Kept {
            output: output.clone(),
            has_holes: job.has_holes(context)?,
        })),
        false => Ok(None),
    }
}

/// Checks the outputs of a request. Files in `own` may be replaced.
pub(super) fn resolved(
    request: &WriteRequest,
    targets: &Targets,
    own: &OwnFiles,
) -> Result<Outputs> {
    let read = targets.with_lists(request.files());
    targets.resolve(request.verb.product(), &read, &|file| own.has(file))
}

/// Returns the error for targets that tiles do not have.
pub(super) fn refused(targets: &Targets) -> Option<Error> {
    let Targets {
        crossings,
        replaced,
        ..
    } = targets;
    let tables = [
        (crossings, NotInTiles::CrossingReport),
        (replaced, NotInTiles::ReplacedPoints),
    ];
    tables
        .into_iter()
        .find(|(table, _)| table.is_some())
        .map(|(_, what)| what.into())
}

/// A request whose outputs are checked.
struct Prepared<'a> {
    request: &'a WriteRequest,
    targets: &'a Targets,
    outputs: Outputs,
    /// The files that the job has written, which may be replaced.
    own: OwnFiles,
    use_of_tiles: TileUse,
}

impl<'a> Prepared<'a> {
    fn new(request: &'a WriteRequest, targets: &'a Targets) -> Result<Self> {
        Self::replacing(request, targets, OwnFiles::default())
    }

    /// Like [`new`](Self::new), but outputs may be replaced that are as the job in a folder has
    /// written them.
    fn of_job(
        request: &'a WriteRequest,
        targets: &'a Targets,
        folder: &Path,
        context: &Context,
    ) -> Result<Self> {
        Self::replacing(request, targets, OwnFiles::of_job(folder, context)?)
    }

    fn replacing(request: &'a WriteRequest, targets: &'a Targets, own: OwnFiles) -> Result<Self> {
        let verb = request.verb.as_ref();
        verb.check()?;
        let outputs = resolved(request, targets, &own)?;
        let use_of_tiles = verb.use_of_tiles(&outputs.targets)?;
        Ok(Prepared {
            request,
            targets,
            outputs,
            own,
            use_of_tiles,
        })
    }

    /// Returns true if the request has to be worked on in tiles.
    fn needs_tiles(&self, memory: Option<u64>, context: &Context) -> bool {
        match (&self.use_of_tiles, refused(self.targets)) {
            (TileUse::Always, _) => true,
            (TileUse::Never(error), _) => {
                let cure = error.cure_text().map(|cure| wording![": ", cure.clone()]);
                let why = wording![stated(error), cure.unwrap_or_default()];
                without_tiles(memory, &Error::usage(why), context)
            }
            (TileUse::Optional, Some(error)) => without_tiles(memory, &error, context),
            (TileUse::Optional, None) => is_larger(self.request, memory, context),
        }
    }

    fn whole(self, context: &Context) -> Result<WriteReport> {
        let Prepared {
            request,
            targets,
            outputs,
            ..
        } = self;
        let mut product = request.open(context)?;
        targets.write_tables(&product, &outputs.set)?;
        let summary = request.verb.write(&product, &outputs, context)?;
        let surface = WrittenOf::Whole(Box::new(SurfaceReport::take(&mut product)?));
        // Its memory is not needed while the disk is waited for.
        drop(product);
        let files = outputs.set.commit()?;
        context.monitor.event(&Event::Written);
        Ok(WriteReport::Written(Box::new(Written {
            surface,
            summary,
            files,
        })))
    }

    /// Makes sure that tiles can be made.
    fn in_tiles(self) -> Result<Self> {
        match self.use_of_tiles {
            TileUse::Never(error) => Err(error),
            TileUse::Optional | TileUse::Always => refused(self.targets).map_or(Ok(self), Err),
        }
    }

    /// Returns the folder of a job.
    fn folder(&self, options: &TileOptions) -> Result<PathBuf> {
        let folder = folder_of(options, self.targets);
        let folder = folder.ok_or_else(|| Error::usage("no output is named"))?;
        match self
            .outputs
            .targets
            .iter()
            .find(|target| targets::is_same(&target.path, &folder))
        {
            Some(target) => Err(Error::usage(
                "the output and the folder of the job have the same name",
            )
            .in_file(&target.path)),
            None => Ok(folder),
        }
    }

    /// Plans a job, and makes sure that it has room.
    fn planned(&self, options: &TileOptions, context: &Context) -> Result<Job> {
        let folder = self.folder(options)?;
        let job = Job::plan(self.request, &folder, options, context)?;
        require_room(&job, context)?;
        Ok(job)
    }

    /// Plans a job, for which there must be a folder.
    fn new_plan(&self, options: &TileOptions, context: &Context) -> Result<WriteReport> {
        job::require_no_job(&self.folder(options)?)?;
        self.planned(options, context).map(|job| shown(&job))
    }

    /// Shows the job in the folder, or plans one if there is none; it has room.
    fn plan_or_job(&self, options: &TileOptions, context: &Context) -> Result<WriteReport> {
        match Job::stored(self.request, &self.folder(options)?, options)? {
            Some(job) => require_room(&job, context).map(|()| shown(&job)),
            None => self.planned(options, context).map(|job| shown(&job)),
        }
    }

    /// Plans a job and does it.
    fn anew(self, options: &TileOptions, caller: Caller, context: &Context) -> Result<WriteReport> {
        let mut job = self.planned(options, context)?;
        let lock = job.create(None, context)?;
        self.outputs.set.mark(job.mark());
        self.run(&job, &lock, caller, context)
    }

    /// Goes on with the job in the folder, or plans one if there is none.
    fn resume(self, options: &TileOptions, context: &Context) -> Result<WriteReport> {
        match Job::stored(self.request, &self.folder(options)?, options)? {
            Some(job) => {
                job.check_inputs(context)?;
                self.go_on(job, options, Caller::of(options), |_| {}, context)
            }
            None => self.anew(options, Caller::of(options), context),
        }
    }

    /// Plans the job in the folder again, if there is one, and does it. It stays.
    fn update(
        self,
        options: &TileOptions,
        caller: Caller,
        planned: impl FnOnce(&Job),
        context: &Context,
    ) -> Result<WriteReport> {
        let folder = self.folder(options)?;
        let Some(update) = Job::updated(self.request, &folder, options, context)? else {
            return self.anew(options, caller, context);
        };
        require_room(update.job(), context)?;
        if !update.keeps_tiles() {
            context.monitor.event(&Event::TilesChosenAgain);
        }
        let (job, lock) = update.put(context)?;
        planned(&job);
        match already_written(&job, self.targets, context)? {
            Some(WriteReport::Kept {
                has_holes: true, ..
            })
            | None => {}
            Some(report) => return Ok(report),
        }
        job.try_again(&lock)?;
        self.clear_up(&job, &lock, context)?;
        self.run(&job, &lock, caller, context)
    }

    /// Goes on with a job, whose inputs are checked. If it has to be planned again, `planned_again`
    /// is called with the job that takes its place.
    fn go_on(
        self,
        mut job: Job,
        options: &TileOptions,
        caller: Caller,
        planned_again: impl FnOnce(&Job),
        context: &Context,
    ) -> Result<WriteReport> {
        require_room(&job, context)?;
        let mut lock = job.lock(context)?;
        match job.outgrown_by(context)? {
            Some(path) => {
                context.monitor.event(&Event::PlannedAgain(path));
                // Others go on with the job as before, if they did.
                let command = job.command()?;
                let options = TileOptions {
                    bad: BadFiles::Skip,
                    ..options.clone()
                };
                let anew = Job::plan(&job.request(), job.folder(), &options, context)?;
                job.remove(&lock)?;
                drop(lock);
                job = anew;
                lock = job.create(command.as_ref(), context)?;
                planned_again(&job);
                self.outputs.set.mark(job.mark());
            }
            None => {
                job.try_again(&lock)?;
                self.clear_up(&job, &lock, context)?;
            }
        }
        self.run(&job, &lock, caller, context)
    }

    /// Removes what a run has left when it was killed.
    fn clear_up(&self, job: &Job, lock: &JobLock, context: &Context) -> Result<()> {
        self.outputs.set.mark(job.mark());
        let done = job.clear_up(lock, context)?;
        self.outputs
            .targets
            .iter()
            .try_for_each(|target| job.remove_abandoned(&target.path, lock))?;
        context.monitor.event(&Event::Resumed {
            done,
            tasks: job.task_count(),
        });
        Ok(())
    }

    /// Does the tasks that are left, and writes the outputs; an error says how to go on.
    fn run(
        self,
        job: &Job,
        lock: &JobLock,
        caller: Caller,
        context: &Context,
    ) -> Result<WriteReport> {
        let ended = self.run_all(job, lock, caller, context);
        match caller.cure(job) {
            Some(cure) => ended.map_err(|error| job.with_cure(error, cure)),
            None => ended,
        }
    }

    fn run_all(
        self,
        job: &Job,
        lock: &JobLock,
        caller: Caller,
        context: &Context,
    ) -> Result<WriteReport> {
        let Prepared {
            request,
            targets,
            outputs,
            own,
            ..
        } = self;
        let folder = job.folder().to_path_buf();
        context.monitor.event(&Event::TasksBegin(&folder));
        job.run(lock, context)?;
        let report = job.report(context)?;
        let mut summary = request
            .verb
            .write_tiles(&job.tiles(&report), &outputs, context)?;
        let is_kept = !caller.ends_with_outputs() || report.skipped > 0;
        if is_kept {
            // Without the lock, the output that is found may be that of another process.
            lock.confirm()?;
            // Somebody may have written there since the tasks began.
            let own = own.still_there(context)?;
            drop(resolved(request, targets, &own)?);
            job.record(&outputs.set, &report, own, lock)?;
        }
        let files = outputs.set.commit_if(&|| lock.confirm())?;
        if let Summary::Parts(parts) = &mut summary {
            parts.keep()?;
        }
        context.monitor.event(&Event::Written);
        if !is_kept {
            job.remove(lock)?;
        }
        let surface = WrittenOf::Tiles {
            report: Box::new(report),
            folder,
        };
        Ok(WriteReport::Written(Box::new(Written {
            surface,
            summary,
            files,
        })))
    }
}

/// How a job is started, which decides whether its folder stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Caller {
    /// A request; the folder goes once the outputs are written, unless files were skipped.
    Request,
    /// A request for files that are gone when this process ends, and the folder with them.
    ForAWhile,
    /// A request that has named the folder: it stays.
    RequestInFolder,
    /// A request that comes again when inputs have changed. The folder stays.
    Update,
    /// One who knows the folder, and what is kept in it. It stays.
    Folder,
    /// One of several processes that share the job. The folder stays; [`Job::work`] says how to go
    /// on.
    Worker,
}

impl Caller {
    fn of(options: &TileOptions) -> Self {
        if options.folder.is_some() {
            Caller::RequestInFolder
        } else {
            Caller::Request
        }
    }

    /// Returns true if nothing of the job is needed once its outputs are written.
    fn ends_with_outputs(self) -> bool {
        matches!(self, Caller::Request | Caller::ForAWhile)
    }

    /// Returns what goes on with a job, and writes what this caller wants; `None` if that is said
    /// elsewhere, or nobody can go on.
    fn cure(self, job: &Job) -> Option<Term> {
        match self {
            Caller::Request | Caller::RequestInFolder => Some(Setting::Resume.on()),
            Caller::Update => Some(Setting::Update.on()),
            Caller::Folder => Some(job.run_command()),
            Caller::ForAWhile | Caller::Worker => None,
        }
    }
}

/// Returns the report of a plan.
fn shown(job: &Job) -> WriteReport {
    WriteReport::Planned {
        size: job.size(),
        folder: job.folder().to_path_buf(),
    }
}

/// Returns what an error says.
fn stated(error: &Error) -> Wording {
    let file = error.path().map(|path| format!("{}: ", path.display()));
    wording![file.unwrap_or_default(), error.message().clone()]
}

/// Reports what a plan consists of, and makes sure that the files of its tasks have room.
fn require_room(job: &Job, context: &Context) -> Result<()> {
    let size = job.size();
    context.monitor.event(&Event::Planned(&size));
    targets::require_room(size.bytes_on_disk, job.bytes_there(), job.folder(), context)
}
