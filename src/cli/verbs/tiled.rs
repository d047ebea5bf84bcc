//! What verbs do if a surface is worked on in tiles.

use std::path::{Path, PathBuf};

use crate::cli::Exit;
use crate::cli::input::args::TileArgs;
use crate::cli::input::outputs::Outputs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::summary::print_extent;
use crate::error::{Error, Result};
use crate::run::units::bytes;
use crate::run::{self, BadFiles, Job, JobLock, JobReport, JobSize, Look, TileOptions, TiledProduct};

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
    /// True if the user named the folder of the job.
    is_kept: bool,
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
    let tables = [(&plan.crossing_report, "--crossing-report"), (&plan.replaced_report, "--flat-points")];
    let table = tables.iter().find(|(table, _)| table.is_some());
    let refused = table.map(|(_, option)| run::not_in_tiles(option));
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
                    console.note(format_args!("--memory has no effect: {error}"));
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
    let resumed = match (args.resume, args.last_task) {
        (true, Some(last)) => Job::open_for(&plan.request, product, &options, last)?,
        (true, None) => Job::open(&plan.request, product, &options)?,
        (false, _) => None,
    };
    let is_new = resumed.is_none();
    let mut job = match resumed {
        Some(job) => job,
        None => Job::plan(&plan.request, product, &options, &context)?,
    };
    let size = job.size();
    print_size(&size, console);
    if args.dry_run {
        console.line(format_args!("folder      {}", options.folder.display()));
        return Ok(Tiled::Planned);
    }
    let lock = if is_new { job.create(None)? } else { job.lock()? };
    outputs.set.mark(job.mark());
    if !is_new {
        let done = job.clear_up(&lock)?;
        outputs.targets.iter().try_for_each(|target| job.remove_abandoned(&target.path, &lock))?;
        console.line(format_args!("resumed     {done} of {} tasks are done", size.tasks));
    }
    job.run(&context).inspect_err(|_| {
        console.note(format_args!("finished tasks are kept in {}: go on with --resume", options.folder.display()));
    })?;
    let report = job.report()?;
    Ok(Tiled::Ran(Box::new(Ran { job, report, lock, is_kept: args.job.is_some() })))
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
        report.warnings.iter().for_each(|text| console.warning(text));
        report.skipped.iter().for_each(|text| console.warning(format_args!("skipped: {text}")));
        print_extent(report.extent, report.crs.as_ref(), console);
    }

    /// Makes the output appear, and removes the files of the tasks unless their folder was named.
    pub(super) fn commit<F>(self, outputs: Outputs<F>, console: &Console) -> Result<Exit> {
        if self.is_kept {
            self.job.record(&outputs.set, &self.report, &self.lock)?;
        }
        outputs.commit(console)?;
        if !self.is_kept {
            self.job.remove(&self.lock)?;
        }
        Ok(Exit::Done)
    }
}
