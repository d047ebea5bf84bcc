//! How the command line names what errors and notices mention.

use crate::error::{Command, Setting, Term};

/// Returns a term as it is typed.
pub(crate) fn name(term: &Term) -> String {
    match term {
        Term::Setting(setting) | Term::On(setting) => option(*setting),
        Term::Text(setting, value) | Term::Number(setting, value) => {
            format!("{} {value}", option(*setting))
        }
        Term::Command(verb, None) => format!("`breakline {}`", command(*verb)),
        Term::Command(verb, Some(file)) => format!("`breakline {} {file}`", command(*verb)),
        Term::Build(feature) => format!("`cargo build --release --features {}`", feature.name()),
    }
}

/// Returns the option for a setting.
pub(crate) fn option(setting: Setting) -> String {
    let name = match setting {
        Setting::Crs => "a-srs",
        Setting::TargetCrs => "t-srs",
        Setting::Extent => "te",
        Setting::InSpace => "3d",
        Setting::Driver => "of",
        Setting::CreationOptions => "co",
        Setting::LayerOptions => "lco",
        other => other.name(),
    };
    format!("--{name}")
}

/// Returns the words that run a command.
fn command(command: Command) -> &'static str {
    match command {
        Command::Info => "info",
        Command::Points => "points",
        Command::Ground => "ground",
        Command::Tin => "tin",
        Command::Triangulate => "triangulate",
        Command::TriangulateInSpace => "triangulate --3d",
        Command::Check => "check",
        Command::JobRun => "job run",
        Command::JobWork => "job work",
        Command::JobVerify => "job status --verify",
        Command::JobClean => "job clean",
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use clap::CommandFactory;

    use super::*;
    use crate::cli::input::args::Cli;

    fn options(command: &clap::Command) -> BTreeSet<String> {
        let own = command
            .get_arguments()
            .filter_map(|arg| arg.get_long())
            .map(|name| format!("--{name}"));
        own.chain(command.get_subcommands().flat_map(options))
            .collect()
    }

    #[test]
    fn every_setting_is_an_option() {
        let known = options(&Cli::command());
        let unknown: Vec<&Setting> = Setting::ALL
            .iter()
            .filter(|setting| !known.contains(&option(**setting)))
            .collect();
        assert!(unknown.is_empty(), "{unknown:?}");
    }

    #[test]
    fn every_command_is_one() {
        for words in Command::ALL.iter().map(|known| command(*known)) {
            let mut here = Cli::command();
            for word in words.split(' ') {
                if word.starts_with("--") {
                    assert!(options(&here).contains(word), "{words}");
                } else {
                    here = here
                        .find_subcommand(word)
                        .unwrap_or_else(|| panic!("{words}"))
                        .clone();
                }
            }
        }
    }
}
