//! The `breakline` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    breakline::cli::run(std::env::args_os()).into()
}
