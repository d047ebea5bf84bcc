//! What verbs do if a surface is worked on in tiles.

use std::path::{Path, PathBuf};

use crate::cli::Exit;
use crate::cli::input::args::{Caller, TileArgs};
use crate::cli::input::outputs::{self, Outputs};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::last_words::LastWords;
use crate::cli::report::names;
use crate::cli::report::summary::{counted, print_extent};
use crate::error::{Error, Result};
use crate::run::units::bytes;
use crate::run::{self, BadFiles, Job, JobLock, JobReport, JobSize, Look, NotInTiles, TileOptions, TiledProduct};

/// What becomes of a request.
pub(super) enum Tiled<'a> {
    /// It fits into memory.
    Whole,
    /// The plan was printed.
    Planned,
    /// All tasks are done.
    Ran(Box<Ran<'a>>),
}

/// A job whose tasks are done. No other process works on it until its output is written.
pub(super) struct Ran<'a> {
    pub(super) job: Job<'a>,
    pub(super) report: JobReport,
    lock: JobLock,
    /// Says how to go on if a signal ends the program.
    words: Option<LastWords>,
    /// True if the user named the folder of the job.
    is_kept: bool,
    folder: PathBuf,
    how_to_go_on: String,
}

/// Runs the tasks of a request, if tiles are asked for or memory would not suffice.
pub(super) fn run<'a, F>(
    args: &TileArgs,
    plan: &'a SurfacePlan,
    product: &'a TiledProduct,
    outputs: &Outputs<F>,
    console: &Console,
) -> Result<Tiled<'a>> {
    let target = &outputs.targets[0].path;
    let context = console.context();
    let tables =
        [(&plan.crossing_report, NotInTiles::CrossingReport), (&plan.replaced_report, NotInTiles::ReplacedPoints)];
    let table = tables.iter().find(|(table, _)| table.is_some());
    let refused = table.map(|(_, what)| Error::from(*what));
    if !args.are_asked_for() {
        let needed = match refused {
            Some(error) => Err(error),
            None => run::needs_tiles(&plan.request, product, args.memory, &context),
        };
        match needed {
            Ok(true) => {}
            Ok(false) => return Ok(Tiled::Whole),
            Err(error) => {
                // Building in one piece reports what is wrong with files.
                if args.memory.is_some() {
                    console.note(format_args!("--memory has no effect: {}", error.render(&names::name)));
                }
                return Ok(Tiled::Whole);
            }
        }
    } else if let Some(error) = refused {
        return Err(error);
    }
    let options = options(args, target);
    if options.folder == *target {
        return Err(Error::usage("the output and the folder of the job have the same name").in_file(target));
    }
    let resumed = match (args.resume, args.caller) {
        (true, Caller::LastTask(last)) => Job::open_for(&plan.request, product, &options, last)?,
        (true, Caller::Verb | Caller::Job) => Job::open(&plan.request, product, &options)?,
        (false, _) => None,
    };
    let is_new = resumed.is_none();
    let mut job = match resumed {
        Some(job) => job,
        None => Job::plan(&plan.request, product, &options, &context)?,
    };
    let size = job.size();
    print_size(&size, console);
    outputs::require_room(size.disk, job.bytes_there(), &options.folder, console)?;
    if args.dry_run {
        console.line(format_args!("folder      {}", options.folder.display()));
        return Ok(Tiled::Planned);
    }
    let mut lock = if is_new { job.create(None)? } else { job.lock()? };
    // A task of a batch queue must not change the plan.
    let may_plan = !is_new && matches!(args.caller, Caller::Verb | Caller::Job);
    let outgrown = if may_plan { job.outgrown_by(&context)?.map(Path::to_path_buf) } else { None };
    if let Some(path) = &outgrown {
        console.note(format_args!("{} was skipped, and can be read now: the job is planned again", path.display()));
        // That of `breakline job`; a verb has none.
        let command = run::job_command(&options.folder).ok().flatten();
        let options = TileOptions { bad: BadFiles::Skip, ..options.clone() };
        let anew = Job::plan(&plan.request, product, &options, &context)?;
        job.remove(&lock)?;
        drop(lock);
        job = anew;
        lock = job.create(command.as_deref())?;
    }
    outputs.set.mark(job.mark());
    if !is_new && outgrown.is_none() {
        let done = job.clear_up(&lock)?;
        outputs.targets.iter().try_for_each(|target| job.remove_abandoned(&target.path, &lock))?;
        console.line(format_args!("resumed     {done} of {} tasks are done", size.tasks));
    }
    let how_to_go_on = how_to_go_on(args);
    let kept = format!("finished tasks are kept in {}: go on with {how_to_go_on}", options.folder.display());
    let words = console.note_if_ended(&kept);
    job.run(&context).inspect_err(|_| console.note(&kept))?;
    let report = job.report(&context)?;
    let (folder, is_kept) = (options.folder, args.job.is_some());
    Ok(Tiled::Ran(Box::new(Ran { job, report, lock, words, is_kept, folder, how_to_go_on })))
}

/// Returns what the user types to go on with a job.
fn how_to_go_on(args: &TileArgs) -> String {
    match (args.caller, &args.job) {
        (Caller::Job | Caller::LastTask(_), Some(job)) => format!("`breakline job run {}`", job.display()),
        _ => "--resume".to_owned(),
    }
}

/// Prints what a plan consists of.
pub(super) fn print_size(size: &JobSize, console: &Console) {
    let files = if size.divides { format!("of {} files, divided first", size.files) } else { "the files".to_owned() };
    console.line(format_args!("tiles       {} ({files}), {} merges, {} tasks", size.tiles, size.merges, size.tasks));
    let disk = match size.disk {
        0 => String::new(),
        disk => format!(", about {} on the disk", bytes(disk)),
    };
    console.line(format_args!(
        "            {} points, {} of memory a task{disk}",
        size.points,
        bytes(size.task_memory)
    ));
}

/// Returns the options of a job.
pub(super) fn options(args: &TileArgs, target: &Path) -> TileOptions {
    TileOptions {
        division: args.tiles.map_or_else(Default::default, |tiles| tiles.0),
        memory: args.memory,
        folder: folder(args, target),
        bad: if args.skip_bad { BadFiles::Skip } else { BadFiles::Refuse },
        look: Look::default(),
    }
}

fn folder(args: &TileArgs, target: &Path) -> PathBuf {
    args.job.clone().unwrap_or_else(|| {
        let mut name = target.as_os_str().to_owned();
        name.push(".job");
        PathBuf::from(name)
    })
}

impl Ran<'_> {
    /// Prints what the surface was built of, and its size and extent.
    pub(super) fn print(&self, console: &Console) {
        let report = &self.report;
        let dropped = [(report.other_class, "of other classes"), (report.withheld, "withheld")];
        let dropped: Vec<String> =
            dropped.iter().filter(|(count, _)| *count > 0).map(|(count, why)| format!("{count} {why}")).collect();
        let dropped = if dropped.is_empty() { String::new() } else { format!("; dropped: {}", dropped.join(", ")) };
        console.line(format_args!("points      {} read, {} used{dropped}", report.read, report.used));
        if report.duplicates > 0 {
            console.line(format_args!("            {} at the position of another point", report.duplicates));
        }
        if report.line_edges > 0 {
            console.line(format_args!("lines       {} edges", report.line_edges));
        }
        let mut left_out = Vec::new();
        if report.beyond_max_edge > 0 {
            left_out.push(format!("{} left out at the rim; {} waited for that", report.beyond_max_edge, report.waited));
        }
        if report.over_skipped > 0 {
            left_out.push(format!("{} left out over skipped files", report.over_skipped));
        }
        if report.clipped > 0 {
            left_out.push(format!("{} clipped", report.clipped));
        }
        let left_out = if left_out.is_empty() { String::new() } else { format!(" ({})", left_out.join(", ")) };
        console.line(format_args!("triangles   {}{left_out}", report.triangles));
        console.line(format_args!("handed up   {} vertices", report.handed_up));
        print_extent(report.extent, report.crs.as_ref(), console);
    }

    /// Makes the output appear, and removes the files of the tasks unless their folder was named.
    pub(super) fn commit<F>(self, outputs: Outputs<F>, console: &Console) -> Result<Exit> {
        if self.is_kept || self.report.skipped > 0 {
            self.job.record(&outputs.set, &self.report, &self.lock)?;
        }
        outputs.commit(console)?;
        drop(self.words);
        if self.report.skipped > 0 {
            let files = counted(self.report.skipped as u64, "file");
            console.note(format_args!(
                "the result has holes: {files} skipped; finished tasks are kept in {}: repair what can be repaired, then go on with {}",
                self.folder.display(),
                self.how_to_go_on,
            ));
            return Ok(Exit::Holes);
        }
        if !self.is_kept {
            self.job.remove(&self.lock)?;
        }
        Ok(Exit::Done)
    }
}
