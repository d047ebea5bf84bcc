use std::path::{Path, PathBuf};

use clap::Parser;
use serde_json::{Value, json};

use super::tiled;
use crate::cli::input::args::{Caller, Cli, JobAction, JobArgs, OutputArgs, SurfaceArgs, TileArgs, TinArgs, Verb};
use crate::cli::input::outputs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::{Exit, print};
use crate::error::{Error, Result};
use crate::run::{self, Job, Look, Source, TileOptions, TiledProduct};

/// Plans a run in tiles, or does its tasks.
pub(in crate::cli) fn run(args: &JobArgs, console: &Console) -> Result<Exit> {
    match &args.action {
        JobAction::Plan { job, headers_only, command } => {
            plan(job, if *headers_only { Look::Headers } else { Look::Points }, command, console)
        }
        JobAction::Run { job, task } => work(job, *task, console),
        JobAction::Status { job, json, verify } => {
            let (job, command, words) = stored(job, console)?;
            let open = command.stored(&job)?;
            if *verify {
                open.remove_damaged()?;
            }
            let printed = if *json { print_tasks(&open, &words, &command.output) } else { print_status(&open) };
            printed.map(|()| Exit::Done)
        }
        JobAction::Clean { job } => run::remove_job(job).map(|()| Exit::Done),
    }
}

/// A verb that works in tiles, and what it asks for.
struct Command {
    verb: Verb,
    plan: SurfacePlan,
    product: TiledProduct,
    output: PathBuf,
}

impl Command {
    /// Understands the words of a command; `planned` are the files that it was planned with.
    fn parse(words: &[String], planned: Option<Vec<PathBuf>>, console: &Console) -> Result<Self> {
        let name = ["breakline".to_owned()];
        let mut cli = Cli::try_parse_from(name.iter().chain(words)).map_err(|e| {
            let text = e.to_string();
            let first = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
            Error::usage(format!("the command of the job: {first}")).cure("`breakline dem --help` lists its options")
        })?;
        if let Some((surface, _)) = args_of(&mut cli.verb) {
            surface.planned = planned;
        }
        let (plan, product, output, tiles) = match &cli.verb {
            Verb::Dem(args) => {
                let (plan, options) = super::dem::requested(args, console)?;
                (plan, TiledProduct::Heights(options), &args.output, &args.tiles)
            }
            Verb::Contour(args) => {
                let (plan, options) = super::contour::requested(args, console)?;
                (plan, TiledProduct::Contours(options), &args.output, &args.tiles)
            }
            Verb::Hillshade(args) => {
                let (plan, options) = super::hillshade::requested(args, console)?;
                (plan, TiledProduct::Shades(options), &args.output, &args.tiles)
            }
            Verb::Tin(args) => {
                let plan = super::tin::requested(args, console)?;
                (plan, TiledProduct::Surface, &args.output, &args.tiles)
            }
            _ => {
                return Err(Error::usage("a job makes a DEM, contours, a hillshade or a TIN in parts")
                    .cure("begin the command with `dem`, `contour`, `hillshade` or `tin`"));
            }
        };
        let own = [(tiles.dry_run, "--dry-run"), (tiles.resume, "--resume"), (tiles.job.is_some(), "--job")];
        if let Some((_, option)) = own.iter().find(|(is_given, _)| *is_given) {
            return Err(Error::usage(format!("the command of a job has no {option}")).cure("leave it out"));
        }
        let output = output.output[0].clone();
        Ok(Command { verb: cli.verb, plan, product, output })
    }

    fn tiles(&self) -> Option<&TileArgs> {
        match &self.verb {
            Verb::Dem(args) => Some(&args.tiles),
            Verb::Contour(args) => Some(&args.tiles),
            Verb::Hillshade(args) => Some(&args.tiles),
            Verb::Tin(args) => Some(&args.tiles),
            _ => None,
        }
    }

    /// Returns the options of the tiles, with the folder of a job.
    fn tile_args(&self, job: &Path) -> TileArgs {
        let mut tiles = self.tiles().cloned().unwrap_or_default();
        tiles.job = Some(job.to_path_buf());
        tiles
    }

    /// Opens a job to do one task, or all that are left.
    fn open(&self, job: &Path, task: Option<usize>) -> Result<Job<'_>> {
        let options = self.options(job);
        let opened = match task {
            Some(task) => Job::open_for(&self.plan.request, &self.product, &options, task),
            None => Job::open(&self.plan.request, &self.product, &options),
        };
        opened?.ok_or_else(|| no_job(job))
    }

    /// Opens a job to see what is done.
    fn stored(&self, job: &Path) -> Result<Job<'_>> {
        Job::stored(&self.plan.request, &self.product, &self.options(job))?.ok_or_else(|| no_job(job))
    }

    fn options(&self, job: &Path) -> TileOptions {
        tiled::options(&self.tile_args(job), &self.output)
    }
}

/// Returns the options of the surface that a verb builds in tiles, and those of the tiles.
fn args_of(verb: &mut Verb) -> Option<(&mut SurfaceArgs, &mut TileArgs)> {
    match verb {
        Verb::Dem(args) => Some((&mut args.surface, &mut args.tiles)),
        Verb::Contour(args) => Some((&mut args.surface, &mut args.tiles)),
        Verb::Hillshade(args) => Some((&mut args.surface, &mut args.tiles)),
        Verb::Tin(args) => Some((&mut args.surface, &mut args.tiles)),
        _ => None,
    }
}

/// Returns the options of the output of a verb that works in tiles.
fn output_of(verb: &mut Verb) -> Option<&mut OutputArgs> {
    match verb {
        Verb::Dem(args) => Some(&mut args.output),
        Verb::Contour(args) => Some(&mut args.output),
        Verb::Hillshade(args) => Some(&mut args.output),
        Verb::Tin(args) => Some(&mut args.output),
        _ => None,
    }
}

fn plan(job: &Path, look: Look, words: &[String], console: &Console) -> Result<Exit> {
    let command = Command::parse(words, None, console)?;
    // What cannot be written is better known before all tasks are done.
    match &command.verb {
        Verb::Dem(args) => super::dem::outputs_of(args, &command.plan).map(drop)?,
        Verb::Contour(args) => super::contour::outputs_of(args, &command.plan).map(drop)?,
        Verb::Hillshade(args) => super::hillshade::outputs_of(args, &command.plan).map(drop)?,
        Verb::Tin(args) => {
            let args = TinArgs { tiles: command.tile_args(job), ..args.clone() };
            super::tin::outputs_of(&args, &command.plan).map(drop)?;
        }
        _ => {}
    }
    let options = TileOptions { look, ..command.options(job) };
    let mut planned = Job::plan(&command.plan.request, &command.product, &options, &console.context())?;
    outputs::require_room(planned.size().disk, 0, job, console)?;
    let folder = std::env::current_dir()?;
    let files = match &command.plan.request.source {
        Source::Points(request) => request.points.iter().map(|input| unicode(input.path())).collect::<Result<_>>()?,
        Source::Mesh(_) | Source::Raster(_) => Vec::new(),
    };
    let command_text = json!({ "command": words, "folder": unicode(&folder)?, "files": files }).to_string();
    drop(planned.create(Some(&command_text))?);
    tiled::print_size(&planned.size(), console);
    console.line(format_args!(
        "next        breakline job run {0}, or {0} --task 0 to {1}",
        job.display(),
        planned.task_count()
    ));
    Ok(Exit::Done)
}

/// Returns a name as it can be stored with a job.
fn unicode(path: &Path) -> Result<&str> {
    let named = || Error::unsupported("the name is not valid Unicode, which a job needs").in_file(path);
    path.to_str().ok_or_else(named)
}

/// Returns the command of a job, and goes to the folder in which it was typed.
fn stored(job: &Path, console: &Console) -> Result<(PathBuf, Command, Vec<String>)> {
    let text = run::job_command(job)?.ok_or_else(|| no_job(job))?;
    let job = std::path::absolute(job)?;
    let value: Value = serde_json::from_str(&text).unwrap_or_default();
    let words = serde_json::from_value::<Vec<String>>(value["command"].clone());
    let folder = serde_json::from_value::<PathBuf>(value["folder"].clone());
    let files = serde_json::from_value::<Vec<PathBuf>>(value["files"].clone());
    let (Ok(words), Ok(folder), Ok(files)) = (words, folder, files) else {
        return Err(Error::format("the command of the job is damaged").in_file(job).cure("plan it again"));
    };
    std::env::set_current_dir(&folder).map_err(|e| Error::from(e).in_file(folder))?;
    let command = Command::parse(&words, Some(files), console)?;
    Ok((job, command, words))
}

#[cold]
fn no_job(job: &Path) -> Error {
    Error::usage("there is no job in this folder").in_file(job).cure("`breakline job plan` creates one")
}

fn work(job: &Path, task: Option<usize>, console: &Console) -> Result<Exit> {
    let (job, mut command, _) = stored(job, console)?;
    let open = command.open(&job, task)?;
    if let Some(task) = task {
        if task < open.task_count() {
            open.run_task(task, &console.context())?;
            console.line(format_args!("task {task}      {} is done", open.task_name(task)));
            return Ok(Exit::Done);
        }
        open.require_done(task)?;
    }
    let mut is_replaced = false;
    // Like any task, the last one may be repeated: its process may have been killed after it.
    if open.has_written(&command.output) {
        // What was skipped is tried again, and the output replaced.
        if !open.has_holes() || task.is_some() {
            console.line(format_args!("output      {} is written", command.output.display()));
            return Ok(if open.has_holes() { Exit::Holes } else { Exit::Done });
        }
        is_replaced = true;
    }
    drop(open);
    if let Some(output) = output_of(&mut command.verb) {
        output.overwrite |= is_replaced;
    }
    if let Some((_, tiles)) = args_of(&mut command.verb) {
        let caller = task.map_or(Caller::Job, Caller::LastTask);
        (tiles.job, tiles.resume, tiles.caller) = (Some(job.clone()), true, caller);
    }
    match &command.verb {
        Verb::Dem(args) => super::dem::run(args, console),
        Verb::Contour(args) => super::contour::run(args, console),
        Verb::Hillshade(args) => super::hillshade::run(args, console),
        Verb::Tin(args) => super::tin::run(args, console),
        _ => Err(no_job(&job)),
    }
}

/// Prints which tasks are done.
fn print_status(open: &Job) -> Result<()> {
    let count = open.task_count();
    let done = open.done();
    let finished = done.iter().filter(|is_done| **is_done).count();
    print(&format!("{finished} of {count} tasks are done\n"))?;
    match done.iter().position(|is_done| !is_done) {
        Some(next) => print(&format!("next: {next}, {}\n", open.task_name(next))),
        None => Ok(()),
    }
}

/// Prints all tasks as a JSON object; the last one writes the output.
fn print_tasks(open: &Job, words: &[String], output: &Path) -> Result<()> {
    let count = open.task_count();
    let (done, stages) = (open.done(), open.stages());
    let last_stage = stages.iter().max().map_or(0, |stage| stage + 1);
    let of_task = |task: usize| {
        json!({
            "name": open.task_name(task), "stage": stages[task], "needs": open.needs(task), "input": open.input(task),
            "has_read": open.state_of_input(task).map(|state| [state.size, state.modified]), "done": done[task],
        })
    };
    let mut tasks: Vec<Value> = (0..count).map(of_task).collect();
    tasks.push(json!({
        "name": "output", "stage": last_stage, "needs": open.last_needs(), "input": null,
        "has_read": null, "done": open.has_written(output),
    }));
    print(&format!("{}\n", json!({ "command": words, "tasks": tasks, "holes": open.has_holes() })))
}
