//! The command line, in three folders.
//!
//! `input` has the options as typed and their meaning, `verbs` one file per verb, `report` what is
//! printed. A verb passes a request to [`run`](crate::run), writes the product and prints a
//! summary. Data goes to files or stdout, messages go to stderr.

mod exit;
mod input;
mod report;
mod tables;
mod verbs;

use std::ffi::OsString;
use std::path::Path;
use std::time::Instant;

use clap::Parser;

pub use self::exit::Exit;
use self::input::args::{Cli, ConsoleArgs, Verb};
use self::input::habits;
use self::report::console::{Console, Verbosity};
use self::report::{names, summary};
pub use self::tables::{RunOptions, RunTables};
use crate::error::{Kind, Result, Term};
use crate::run::proj::TransformOptions;
use crate::run::{Context, Facts};

/// Runs the program with the given arguments and returns how it ended. The first argument is the
/// program's name.
pub fn run(args: impl IntoIterator<Item = OsString>) -> Exit {
    let words = match habits::understood(args) {
        Ok(words) => words,
        Err(error) => {
            Console::new(Verbosity::default()).error(&error);
            return Exit::Usage;
        }
    };
    let cli = match Cli::try_parse_from(words) {
        Ok(cli) => cli,
        Err(error) => {
            // Help goes to stdout and is not a failure; neither is a closed pipe.
            let _ = error.print();
            return if error.use_stderr() {
                Exit::Usage
            } else {
                Exit::Done
            };
        }
    };
    let console = Console::new(cli.console.level());
    if let Some(threads) = cli.console.threads {
        // Fails if a pool exists already: the demo runs several commands in one process.
        let _ = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.get())
            .build_global();
    }
    let start = Instant::now();
    match dispatch(&cli.verb, &cli.console, &console) {
        Ok(exit) => {
            match cli.verb {
                Verb::Info(_)
                | Verb::Crs(_)
                | Verb::Demo(_)
                | Verb::Describe(_)
                | Verb::Completions(_)
                | Verb::Man(_) => {}
                _ => summary::print_cost(start, &console),
            }
            exit
        }
        Err(error) => {
            console.error(&error);
            match error.kind() {
                Kind::Usage | Kind::OtherJob => Exit::Usage,
                Kind::NotYet => Exit::NotYet,
                Kind::Format | Kind::Unsupported | Kind::Limit | Kind::Io | Kind::Canceled => {
                    Exit::Failed
                }
            }
        }
    }
}

/// Prints how to go on with the run that a signal ends, if it is one that can go on. Called once,
/// by who handles signals.
pub fn print_last_words() {
    report::last_words::print();
}

/// Returns what an error or a notice mentions, as it is typed on the command line.
pub fn name_of(term: &Term) -> String {
    names::name(term)
}

/// Returns the description of the program that `describe --json` prints.
pub fn description() -> String {
    verbs::describe::describe().to_string()
}

/// Makes the products of a run file, or of the same tables as a JSON object, and returns their
/// report as JSON. All files appear at the end, or none. With `dry_run`, nothing is made, and the
/// report is what would be.
///
/// # Errors
/// If the tables are wrong, a product cannot be made, or the run is canceled.
pub fn run_products(
    tables: RunTables<'_>,
    options: &RunOptions,
    context: &Context,
) -> Result<String> {
    verbs::run::report_of(tables, options, context).map(|report| report.to_string())
}

/// Returns the contents of a file as the JSON object that `info --json` prints for it.
pub fn facts_as_json(path: &Path, facts: &Facts) -> String {
    verbs::info::as_json(path, facts).to_string()
}

/// Returns what a coordinate system is, or the operations from it to another, as the JSON object
/// that `crs --json` prints.
///
/// # Errors
/// Those of `run::proj::operations`, and if a text is not a system.
pub fn systems_as_json(
    from: &str,
    to: Option<&str>,
    at: Option<&[f64]>,
    options: &TransformOptions,
    context: &Context,
) -> Result<String> {
    verbs::crs::as_json(from, to, at, options, context).map(|found| found.to_string())
}

fn dispatch(verb: &Verb, how: &ConsoleArgs, console: &Console) -> Result<Exit> {
    match verb {
        Verb::Info(args) => verbs::info::run(args, console),
        Verb::Points(args) => verbs::points::run(args, console),
        Verb::Ground(args) => verbs::ground::run(args, console),
        Verb::Tin(_)
        | Verb::Simplify(_)
        | Verb::Dem(_)
        | Verb::Contour(_)
        | Verb::Hillshade(_)
        | Verb::ColorRelief(_)
        | Verb::Slope(_)
        | Verb::Aspect(_)
        | Verb::Curvature(_)
        | Verb::Roughness(_)
        | Verb::Tri(_)
        | Verb::Tpi(_) => verbs::write::run(verb, console),
        Verb::Triangulate(args) => verbs::triangulate::run(args, console),
        Verb::Check(args) => verbs::check::run(args, console),
        Verb::Volume(args) => verbs::volume::run(args, console),
        Verb::Compare(args) => verbs::compare::run(args, console),
        Verb::Profile(args) => verbs::profile::run(args, console),
        Verb::Drape(args) => verbs::drape::run(args, console),
        Verb::TerrainTiles(args) => verbs::terrain_tiles::run(args, console),
        Verb::Sample(args) => verbs::sample::run(args, console),
        Verb::Accuracy(args) => verbs::accuracy::run(args, console),
        Verb::Crs(args) => verbs::crs::run(args, console),
        Verb::Job(args) => verbs::job::run(args, console),
        Verb::Demo(args) => verbs::demo::run(args, how, console, &|words| run(words)),
        Verb::Run(args) => verbs::run::run(args, console),
        Verb::Describe(args) => verbs::describe::run(args),
        Verb::Completions(args) => verbs::shell::completions(args),
        Verb::Man(args) => verbs::shell::man(args, console),
    }
}
