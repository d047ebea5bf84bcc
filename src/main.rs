//! The `breakline` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    breakline::cli::run()
}
