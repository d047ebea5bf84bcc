use std::path::{Path, PathBuf};

use clap::Parser;
use serde_json::{Value, json};

use super::asked::Asked;
use super::write;
use crate::cli::input::args::{Cli, JobAction, JobArgs};
use crate::cli::report::console::Console;
use crate::cli::report::written::Shown;
use crate::cli::{Exit, print};
use crate::error::{Error, Result};
use crate::run::{self, Execution, Existing, Job, JobCommand, JobTask, Look, TileOptions, WriteReport};

/// Plans a run in tiles, or does its tasks.
pub(in crate::cli) fn run(args: &JobArgs, console: &Console) -> Result<Exit> {
    match &args.action {
        JobAction::Plan { job, headers_only, command } => {
            plan(job, if *headers_only { Look::Headers } else { Look::Points }, command, console)
        }
        JobAction::Run { job, task } => work(job, *task, console),
        JobAction::Status { job, json, verify } => {
            let (job, JobCommand { request, targets, tiles, words, .. }) = stored(job)?;
            let open = Job::stored(&request, &job, &tiles)?.ok_or_else(|| no_job(&job))?;
            if *verify {
                open.remove_damaged()?;
            }
            let printed = match &targets.files[..] {
                [output, ..] if *json => print_tasks(&open, &words, output),
                _ => print_status(&open),
            };
            printed.map(|()| Exit::Done)
        }
        JobAction::Clean { job } => run::remove_job(job).map(|()| Exit::Done),
    }
}

/// Understands the words of a command.
fn parse(words: &[String], console: &Console) -> Result<Asked> {
    let name = ["breakline".to_owned()];
    let cli = Cli::try_parse_from(name.iter().chain(words)).map_err(|e| {
        let text = e.to_string();
        let first = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
        Error::usage(format!("the command of the job: {first}")).cure("`breakline dem --help` lists its options")
    })?;
    let asked = write::asked(&cli.verb, console)?.ok_or_else(|| {
        Error::usage("a job makes a DEM, contours, a hillshade or a TIN in parts")
            .cure("begin the command with `dem`, `contour`, `hillshade` or `tin`")
    })?;
    let tiles = &asked.tiles;
    let own = [(tiles.dry_run, "--dry-run"), (tiles.resume, "--resume"), (tiles.job.is_some(), "--job")];
    match own.iter().find(|(is_given, _)| *is_given) {
        Some((_, option)) => Err(Error::usage(format!("the command of a job has no {option}")).cure("leave it out")),
        None => Ok(asked),
    }
}

fn plan(job: &Path, look: Look, words: &[String], console: &Console) -> Result<Exit> {
    let Asked { request, targets, tiles } = parse(words, console)?;
    let tiles = TileOptions { folder: Some(job.to_path_buf()), look, ..write::options(&tiles) };
    let shown = Shown::new(console, how_to_go_on(job));
    let mut planned = run::plan(&request, &targets, &tiles, &shown.context())?;
    let folder = std::env::current_dir()?;
    drop(planned.create(Some(&JobCommand { request, targets, tiles, folder, words: words.to_vec() }))?);
    console.line(format_args!(
        "next        breakline job run {0}, or {0} --task 0 to {1}",
        job.display(),
        planned.task_count()
    ));
    Ok(Exit::Done)
}

/// Returns what the user types to go on with a job.
fn how_to_go_on(job: &Path) -> String {
    format!("`breakline job run {}`", job.display())
}

/// Returns what a job was planned for, with its folder, and goes to where that was typed.
fn stored(job: &Path) -> Result<(PathBuf, JobCommand)> {
    let command = JobCommand::read(job)?.ok_or_else(|| no_job(job))?;
    let job = std::path::absolute(job)?;
    std::env::set_current_dir(&command.folder).map_err(|e| Error::from(e).in_file(&command.folder))?;
    Ok((job, command))
}

#[cold]
fn no_job(job: &Path) -> Error {
    Error::usage("there is no job in this folder").in_file(job).cure("`breakline job plan` creates one")
}

fn work(job: &Path, task: Option<usize>, console: &Console) -> Result<Exit> {
    let (job, JobCommand { request, mut targets, tiles, .. }) = stored(job)?;
    let shown = Shown::new(console, how_to_go_on(&job));
    let context = shown.context();
    let report = match task {
        Some(task) => {
            let open = Job::open_for(&request, &job, &tiles, task)?.ok_or_else(|| no_job(&job))?;
            match run::run_task(&open, task, &targets, &context)? {
                Some(report) => report,
                None => {
                    console.line(format_args!("task {task}      {} is done", open.task_name(task)));
                    return Ok(Exit::Done);
                }
            }
        }
        None => {
            let open = Job::open(&request, &job, &tiles)?.ok_or_else(|| no_job(&job))?;
            match targets.files.first().filter(|output| open.has_written(output)) {
                Some(output) if !open.has_holes() => WriteReport::Kept { output: output.clone(), has_holes: false },
                written => {
                    // What was skipped is tried again, and the output replaced.
                    if written.is_some() {
                        targets.existing = Existing::Replace;
                    }
                    drop(open);
                    let options = TileOptions { folder: Some(job), ..tiles };
                    run::write(&request, &targets, &Execution::Resume(options), &context)?
                }
            }
        }
    };
    Ok(shown.print(&report))
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
    let of_task = |task: JobTask| {
        json!({
            "name": task.name, "stage": task.stage, "needs": task.needs, "input": task.input,
            "has_read": task.has_read.map(|state| [state.size, state.modified]), "done": task.is_done,
        })
    };
    let tasks: Vec<Value> = open.tasks(output).into_iter().map(of_task).collect();
    print(&format!("{}\n", json!({ "command": words, "tasks": tasks, "holes": open.has_holes() })))
}
