//! Hostile points and lines from seeds, in families; all that holds for a constrained triangulation
//! is checked, and what fails is made small. `docs/fuzzing.md` tells how to use it for longer runs:
//!
//! ```text
//! cargo test --release --test fuzz -- --family bundles --seeds 0..1000000
//! cargo test --release --test fuzz -- --file failure.poly
//! ```
#![allow(clippy::print_stdout)]

mod families;
mod run;
mod shrink;
mod tally;

use std::ops::Range;
use std::process::ExitCode;

use families::FAMILIES;

/// What `cargo test` tries of each family.
const SHORT: Range<u64> = 0..300;

/// What was typed. Unknown options are those of other test programs, and are left to them.
#[derive(Default)]
struct Typed {
    family: Option<String>,
    seeds: Option<Range<u64>>,
    file: Option<String>,
    list: bool,
}

impl Typed {
    fn parse(mut words: impl Iterator<Item = String>) -> Result<Typed, String> {
        let mut typed = Typed::default();
        while let Some(word) = words.next() {
            match word.as_str() {
                "--family" => typed.family = Some(words.next().ok_or("--family needs a name")?),
                "--seeds" => typed.seeds = Some(seeds(&words.next().ok_or("--seeds needs A..B")?)?),
                "--file" => typed.file = Some(words.next().ok_or("--file needs a .poly file")?),
                "--list" => typed.list = true,
                _ if !word.starts_with('-') => typed.family = Some(word),
                _ => {}
            }
        }
        Ok(typed)
    }
}

fn seeds(text: &str) -> Result<Range<u64>, String> {
    let (from, to) = text
        .split_once("..")
        .ok_or_else(|| format!("--seeds {text}: A..B is expected"))?;
    let number = |n: &str| {
        n.parse()
            .map_err(|_| format!("--seeds {text}: {n:?} is no number"))
    };
    Ok(number(from)?..number(to)?)
}

fn main() -> ExitCode {
    let typed = match Typed::parse(std::env::args().skip(1)) {
        Ok(typed) => typed,
        Err(what) => {
            eprintln!("{what}");
            return ExitCode::from(2);
        }
    };
    if typed.list {
        return ExitCode::SUCCESS;
    }
    if let Some(file) = typed.file {
        return if run::run_file(file.as_ref()) {
            ExitCode::SUCCESS
        } else {
            ExitCode::FAILURE
        };
    }
    // Panics are caught, and told with the set that they come from.
    std::panic::set_hook(Box::new(|_| {}));
    let is_wanted = |name: &str| {
        typed
            .family
            .as_ref()
            .is_none_or(|family| name.contains(family.as_str()))
    };
    let mut sound = true;
    for family in FAMILIES.iter().filter(|family| is_wanted(family.name)) {
        sound &= run::run(family, typed.seeds.clone().unwrap_or(SHORT));
    }
    if sound {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
