//! How the program ends.

use std::process::ExitCode;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exit {
    /// The work is done.
    Done = 0,
    /// Something failed, or a check found flaws.
    Failed = 1,
    /// The command line is wrong.
    Usage = 2,
    /// The work is done, but files were skipped (`--skip-bad`): the result has holes.
    Holes = 3,
    /// A task needs others that are not done.
    NotYet = 4,
}

impl Exit {
    /// What each exit code means, for the help.
    pub(super) const ALL: [(Exit, &str); 5] = [
        (Exit::Done, "done"),
        (Exit::Failed, "failed"),
        (Exit::Usage, "wrong usage"),
        (
            Exit::Holes,
            "done, with holes where files were skipped (--skip-bad)",
        ),
        (
            Exit::NotYet,
            "a task of a job needs others that are not done: later the same may work",
        ),
    ];
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit as u8)
    }
}
