//! What verbs do if a surface is worked on in tiles.

use std::path::{Path, PathBuf};

use crate::cli::input::args::TileArgs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::summary::print_extent;
use crate::error::{Error, Result};
use crate::run::units::bytes;
use crate::run::{self, BadFiles, Job, JobReport, JobSize, TileOptions, TiledProduct};

/// What becomes of a request.
pub(super) enum Tiled<'a> {
    /// It fits into memory.
    Whole,
    /// The plan was printed.
    Planned,
    /// All tasks are done.
    Ran(Box<(Job<'a>, JobReport)>),
}

/// Runs the tasks of a request, if tiles are asked for or memory would not suffice.
pub(super) fn run<'a>(
    args: &TileArgs,
    plan: &'a SurfacePlan,
    product: &'a TiledProduct,
    target: &Path,
    console: &Console,
) -> Result<Tiled<'a>> {
    let context = console.context();
    let tables = [(&plan.crossing_report, "--crossing-report"), (&plan.replaced_report, "--flat-points")];
    let table = tables.iter().find(|(table, _)| table.is_some());
    if !args.are_asked_for() && (table.is_some() || !run::needs_tiles(&plan.request, product, args.memory, &context)?) {
        return Ok(Tiled::Whole);
    }
    if let Some((_, option)) = table {
        return Err(Error::unsupported(format!("{option} does not work with tiles yet"))
            .cure("leave one of them out: without --tiles the whole surface is built in memory"));
    }
    let options = options(args, target);
    let resumed = if args.resume { Job::open(&plan.request, product, &options)? } else { None };
    let is_new = resumed.is_none();
    let job = match resumed {
        Some(job) => job,
        None => Job::plan(&plan.request, product, &options, &context)?,
    };
    let size = job.size();
    print_size(&size, console);
    if args.dry_run {
        console.line(format_args!("folder      {}", options.folder.display()));
        return Ok(Tiled::Planned);
    }
    if is_new {
        job.create()?;
    }
    let lock = job.lock()?;
    if !is_new {
        let done = job.clear_up(&lock)?;
        console.line(format_args!("resumed     {done} of {} tasks are done", size.tasks));
    }
    job.run(&context).inspect_err(|_| {
        console.note(format_args!("finished tasks are kept in {}: go on with --resume", options.folder.display()));
    })?;
    drop(lock);
    let report = job.report()?;
    Ok(Tiled::Ran(Box::new((job, report))))
}

/// Prints what a plan consists of.
pub(super) fn print_size(size: &JobSize, console: &Console) {
    let files = if size.divides { format!("of {} files, divided first", size.files) } else { "the files".to_owned() };
    console.line(format_args!("tiles       {} ({files}), {} merges, {} tasks", size.tiles, size.merges, size.tasks));
    console.line(format_args!(
        "            {} points, {} of memory a task, {} on the disk",
        size.points,
        bytes(size.task_memory),
        bytes(size.disk)
    ));
}

/// Returns the options of a job.
pub(super) fn options(args: &TileArgs, target: &Path) -> TileOptions {
    TileOptions {
        division: args.tiles.map_or_else(Default::default, |tiles| tiles.0),
        memory: args.memory,
        folder: folder(args, target),
        bad: if args.skip_bad { BadFiles::Skip } else { BadFiles::Refuse },
    }
}

fn folder(args: &TileArgs, target: &Path) -> PathBuf {
    args.job.clone().unwrap_or_else(|| {
        let mut name = target.as_os_str().to_owned();
        name.push(".job");
        PathBuf::from(name)
    })
}

/// Prints what the surface was built of, and its size and extent.
pub(super) fn print(report: &JobReport, console: &Console) {
    console.line(format_args!("points      {} of {} used", report.used, report.read));
    if report.duplicates > 0 {
        console.line(format_args!("            {} at the position of another point", report.duplicates));
    }
    if report.line_edges > 0 {
        console.line(format_args!("lines       {} edges", report.line_edges));
    }
    let rim = match report.beyond_max_edge {
        0 => String::new(),
        count => format!(" ({count} left out at the rim; {} waited for that)", report.waited),
    };
    console.line(format_args!("triangles   {}{rim}", report.triangles));
    console.line(format_args!("handed up   {} vertices", report.handed_up));
    report.skipped.iter().for_each(|text| console.warning(format_args!("skipped: {text}")));
    print_extent(report.extent, report.crs.as_ref(), console);
}

/// Removes the files of the tasks, unless their folder was named.
pub(super) fn clean(args: &TileArgs, job: &Job) -> Result<()> {
    if args.job.is_some() { Ok(()) } else { job.remove() }
}
