//! The command line: one file per verb.
//!
//! What is typed (`args`) and what it means (`plan`, `outputs`) are kept apart. A verb hands a request to
//! [`run`](crate::run), writes the product and says what came out. Data goes to files or stdout, talk (`talk`) to
//! stderr.

mod args;
mod check;
mod classes;
mod contour;
mod dem;
mod demo;
mod escape;
mod habits;
mod hillshade;
mod info;
mod inputs;
mod notices;
mod outputs;
mod plan;
mod points;
mod progress;
mod summary;
mod talk;
mod tin;
mod triangulate;

use std::ffi::OsString;
use std::io::{ErrorKind, Write};
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;

use self::args::{Cli, TalkArgs, Verb};
use self::talk::Talk;
use crate::error::{Kind, Result};

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// All is done.
    Done = 0,
    /// Something failed, or a check found flaws.
    Failed = 1,
    /// What was asked for makes no sense.
    Usage = 2,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit as u8)
    }
}

/// Runs the program with these arguments, the first of which is its name.
pub fn run(args: impl IntoIterator<Item = OsString>) -> Exit {
    let words = match habits::understood(args) {
        Ok(words) => words,
        Err(error) => {
            Talk::new(&TalkArgs::default()).error(&error);
            return Exit::Usage;
        }
    };
    let cli = match Cli::try_parse_from(words) {
        Ok(cli) => cli,
        Err(error) => {
            // Help goes to stdout and is no failure; a closed pipe is none either.
            let _ = error.print();
            return if error.use_stderr() { Exit::Usage } else { Exit::Done };
        }
    };
    let talk = Talk::new(&cli.talk);
    if let Some(threads) = cli.talk.threads {
        // Refused when there is a pool already: the demo runs several commands in one process.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(threads.get()).build_global();
    }
    let start = Instant::now();
    match dispatch(&cli.verb, &cli.talk, &talk) {
        Ok(exit) => {
            match cli.verb {
                Verb::Info(_) | Verb::Demo(_) => {}
                _ => summary::tell_cost(start, &talk),
            }
            exit
        }
        Err(error) => {
            talk.error(&error);
            match error.kind() {
                Kind::Usage => Exit::Usage,
                Kind::Format | Kind::Unsupported | Kind::Limit | Kind::Io | Kind::Canceled => Exit::Failed,
            }
        }
    }
}

fn dispatch(verb: &Verb, how: &TalkArgs, talk: &Talk) -> Result<Exit> {
    match verb {
        Verb::Info(args) => info::run(args, talk),
        Verb::Points(args) => points::run(args, talk),
        Verb::Tin(args) => tin::run(args, talk),
        Verb::Triangulate(args) => triangulate::run(args, talk),
        Verb::Dem(args) => dem::run(args, talk),
        Verb::Contour(args) => contour::run(args, talk),
        Verb::Hillshade(args) => hillshade::run(args, talk),
        Verb::Check(args) => check::run(args, talk),
        Verb::Demo(args) => demo::run(args, how, talk),
    }
}

/// Writes data to stdout. A reader that went away (`| head`) wants no more of it.
fn print(text: &str) -> Result<()> {
    match std::io::stdout().write_all(escape::lines(text).as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
