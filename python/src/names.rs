//! How Python names what errors and notices mention.

use breakline::cli;
use breakline::error::{Command, Setting, Term};
use pyo3::prelude::*;

/// Returns a term as it is written in Python. What only the program has is named as there.
pub(crate) fn name(term: &Term) -> String {
    let written = match term {
        Term::Setting(setting) => parameter(*setting),
        Term::On(setting) => parameter(*setting).map(|parameter| format!("{parameter}=True")),
        Term::Text(setting, value) => {
            parameter(*setting).map(|parameter| format!("{parameter}=\"{value}\""))
        }
        Term::Number(setting, value) => {
            parameter(*setting).map(|parameter| format!("{parameter}={value}"))
        }
        Term::Command(command, file) => {
            return call(*command, file.as_deref()).unwrap_or_else(|| cli::name_of(term));
        }
        Term::Build(feature) => return format!("the feature `{}` of the crate", feature.name()),
    };
    written.unwrap_or_else(|| match term {
        Term::Setting(Setting::CrossingReport) | Term::Text(Setting::CrossingReport, _) => {
            "Tin.report[\"crossing_heights\"]".to_owned()
        }
        _ => format!("{} of the program", cli::name_of(term)),
    })
}

/// Returns the parameter for a setting; `None` if no function has one.
pub(crate) fn parameter(setting: Setting) -> Option<String> {
    let name = match setting {
        Setting::CrossingReport
        | Setting::Parse
        | Setting::Driver
        | Setting::CreationOptions
        | Setting::LayerOptions => return None,
        Setting::Class => "classes",
        Setting::Return => "returns",
        Setting::TargetCrs => "to_crs",
        Setting::TwoDimensions => "in_plane",
        other => other.name(),
    };
    Some(name.replace('-', "_"))
}

/// Returns the call that does what a command does; `None` if no function does.
fn call(command: Command, file: Option<&str>) -> Option<String> {
    let (function, arguments) = match command {
        Command::Info => ("info", ""),
        Command::Points => ("points", ""),
        Command::Ground => ("ground", ""),
        Command::Tin => ("tin", ""),
        Command::Triangulate => ("triangulate", ""),
        Command::TriangulateInSpace => ("triangulate", "in_space=True"),
        Command::Check => ("check", ""),
        Command::JobRun | Command::JobWork | Command::JobVerify | Command::JobClean => {
            let of = file.map_or_else(|| "folder".to_owned(), |file| format!("{file:?}"));
            let method = match command {
                Command::JobRun => "write",
                Command::JobWork => "work",
                Command::JobVerify => "verify",
                _ => "clean",
            };
            return Some(format!("breakline.Job({of}).{method}()"));
        }
    };
    let arguments = file.map_or_else(|| arguments.to_owned(), |file| format!("{file:?}"));
    Some(format!("breakline.{function}({arguments})"))
}

/// Returns all settings, each with its parameter, if there is one.
#[pyfunction]
pub(crate) fn settings() -> Vec<(&'static str, Option<String>)> {
    Setting::ALL
        .iter()
        .map(|setting| (setting.name(), parameter(*setting)))
        .collect()
}
