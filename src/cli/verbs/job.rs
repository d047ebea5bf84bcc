use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Parser;
use serde_json::{Value, json};

use super::asked::Asked;
use super::write;
use crate::cli::Exit;
use crate::cli::input::args::{Cli, JobAction, JobArgs};
use crate::cli::report::console::Console;
use crate::cli::report::stdout::print;
use crate::cli::report::written::Shown;
use crate::error::{Error, Result};
use crate::run::{
    self, Context, Job, JobCommand, JobTask, Look, StoredJob, TaskLease, TileOptions, WorkOptions,
};

/// Plans a run in tiles, or does its tasks.
pub(crate) fn run(args: &JobArgs, console: &Console) -> Result<Exit> {
    match &args.action {
        JobAction::Plan {
            job,
            headers_only,
            command,
        } => plan(
            job,
            if *headers_only {
                Look::Headers
            } else {
                Look::Points
            },
            command,
            console,
        ),
        JobAction::Run {
            job, update: true, ..
        } => update(job, console),
        JobAction::Run { job, task, .. } => run_tasks(job, *task, console),
        JobAction::Work { job, memory, lease } => {
            let options = WorkOptions {
                memory: *memory,
                lease: Duration::from_secs((*lease).into()),
            };
            work(job, &options, console)
        }
        JobAction::Status { job, json, verify } => {
            let context = console.context();
            let stored = StoredJob::read(job)?;
            let open = stored.job()?;
            if *verify {
                open.remove_damaged(&context)?;
            }
            let JobCommand { targets, words, .. } = &stored.command;
            let printed = match *json {
                true => print_tasks(&open, words, &targets.files, &context),
                false => print_status(&open, &context),
            };
            printed.map(|()| Exit::Done)
        }
        JobAction::Clean { job } => run::remove_job(job, &console.context()).map(|()| Exit::Done),
    }
}

/// Understands the words of a command.
fn parse(words: &[String], console: &Console) -> Result<Asked> {
    let name = ["breakline".to_owned()];
    let cli = Cli::try_parse_from(name.iter().chain(words)).map_err(|e| {
        let text = e.to_string();
        let first = text
            .lines()
            .next()
            .unwrap_or_default()
            .trim_start_matches("error: ")
            .to_owned();
        Error::usage(format!("the command of the job: {first}"))
            .cure("`breakline dem --help` lists its options")
    })?;
    let asked = write::asked(&cli.verb, console)?;
    let tiles = &asked.tiles;
    let own = [
        (tiles.dry_run, "--dry-run"),
        (tiles.resume, "--resume"),
        (tiles.update, "--update"),
        (tiles.job.is_some(), "--job"),
    ];
    match own.iter().find(|(is_given, _)| *is_given) {
        Some((_, option)) => {
            Err(Error::usage(format!("the command of a job has no {option}")).cure("leave it out"))
        }
        None => Ok(asked),
    }
}

fn plan(job: &Path, look: Look, words: &[String], console: &Console) -> Result<Exit> {
    let Asked {
        request,
        targets,
        tiles,
    } = parse(words, console)?;
    let tiles = TileOptions {
        look,
        ..write::options(&tiles)
    };
    let shown = Shown::new(console, Some(on_job("run", job)));
    let command = JobCommand {
        words: words.to_vec(),
        ..JobCommand::new(&request, &targets, &tiles)?
    };
    let planned = run::plan_job(&command, job, &shown.context())?.job()?;
    console.line(format_args!(
        "next        breakline job run {0}, or {0} --task 0 to {1}",
        job.display(),
        planned.task_count()
    ));
    Ok(Exit::Done)
}

/// Returns what the user types to go on with a job.
fn on_job(action: &str, job: &Path) -> String {
    format!("`breakline job {action} {}`", job.display())
}

/// Does tasks together with other processes.
fn work(job: &Path, options: &WorkOptions, console: &Console) -> Result<Exit> {
    let stored = StoredJob::read(job)?;
    let shown = Shown::new(console, Some(on_job("work", stored.folder())));
    let report = run::work_job(&stored, options, &shown.context())?;
    Ok(shown.print(&report))
}

/// Does again what changed inputs reach.
fn update(job: &Path, console: &Console) -> Result<Exit> {
    let stored = StoredJob::read(job)?;
    let shown = Shown::new(console, Some(on_job("run", stored.folder())));
    let report = run::update_job(&stored, &shown.context())?;
    Ok(shown.print(&report))
}

/// Does one task, or all that are left.
fn run_tasks(job: &Path, task: Option<usize>, console: &Console) -> Result<Exit> {
    let stored = StoredJob::read(job)?;
    let shown = Shown::new(console, Some(on_job("run", stored.folder())));
    let context = shown.context();
    let Some(task) = task else {
        return run::run_job(&stored, &context).map(|report| shown.print(&report));
    };
    let open = stored.job()?;
    match run::run_task(&open, task, &stored.command.targets, &context)? {
        Some(report) => Ok(shown.print(&report)),
        None => {
            console.line(format_args!(
                "task {task}      {} is done",
                open.task_name(task)
            ));
            Ok(Exit::Done)
        }
    }
}

/// Prints which tasks are done.
fn print_status(open: &Job, context: &Context) -> Result<()> {
    let count = open.task_count();
    let done = open.done(context)?;
    let finished = done.iter().filter(|is_done| **is_done).count();
    print(&format!("{finished} of {count} tasks are done\n"))?;
    for (
        task,
        TaskLease {
            worker,
            age,
            has_expired,
            ..
        },
    ) in open.leases(&done)?
    {
        let name = if task < count {
            open.task_name(task)
        } else {
            "output".to_owned()
        };
        let worker = worker.map_or_else(
            || "an unknown process".to_owned(),
            |worker| worker.to_string(),
        );
        let state = if has_expired { "lost by" } else { "done by" };
        print(&format!(
            "{task}: {name}, {state} {worker}, seen {} s ago\n",
            age.as_secs()
        ))?;
    }
    match done.iter().position(|is_done| !is_done) {
        Some(next) => print(&format!("next: {next}, {}\n", open.task_name(next))),
        None => Ok(()),
    }
}

/// Prints all tasks as a JSON object; the last one writes the output.
fn print_tasks(open: &Job, words: &[String], outputs: &[PathBuf], context: &Context) -> Result<()> {
    let of_task = |task: JobTask| {
        json!({
            "name": task.name, "stage": task.stage, "needs": task.needs, "input": task.input,
            "has_read": task.has_read.map(|state| [state.size, state.modified]), "done": task.is_done,
            "worker": task.lease.map(|lease| json!({
                "name": lease.worker.map(|worker| worker.to_string()), "age": lease.age.as_secs_f64(),
                "expired": lease.has_expired,
            })),
        })
    };
    let tasks: Vec<Value> = open
        .tasks(outputs, context)?
        .into_iter()
        .map(of_task)
        .collect();
    print(&format!(
        "{}\n",
        json!({ "command": words, "tasks": tasks, "holes": open.has_holes(context)? })
    ))
}
