//! What the parser of the command line refuses, in the words of a run file.

use std::error::Error as _;

use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::words::FILES;
use crate::error::Error;

/// Returns an error of the parser with the key that it is about, and the place of that key, if
/// it is among `locations`.
pub(crate) fn refusal(refused: &clap::Error, locations: &[(String, String)]) -> Error {
    let named: Vec<String> = texts(refused, ContextKind::InvalidArg)
        .iter()
        .map(|typed| key_of(typed))
        .collect();
    let keys: Vec<String> = named.iter().map(|key| format!("`{key}`")).collect();
    let keys = keys.join(", ");
    let message = match refused.kind() {
        ErrorKind::InvalidValue | ErrorKind::ValueValidation => {
            let value = texts(refused, ContextKind::InvalidValue).join(", ");
            let known = texts(refused, ContextKind::ValidValue);
            let why = match (refused.source(), known.is_empty()) {
                (Some(why), _) => why.to_string(),
                (None, false) => format!("expected one of {}", known.join(", ")),
                (None, true) => "not a value for it".to_owned(),
            };
            match why.contains(&value) {
                true => format!("{keys}: {why}"),
                false => format!("{keys}: `{value}`: {why}"),
            }
        }
        ErrorKind::MissingRequiredArgument => format!("{keys} is missing"),
        ErrorKind::ArgumentConflict => {
            let prior = texts(refused, ContextKind::PriorArg);
            let prior: Vec<String> = prior
                .iter()
                .map(|typed| format!("`{}`", key_of(typed)))
                .collect();
            match prior.join(", ") {
                other if other.is_empty() || other == keys => format!("{keys} is given twice"),
                other => format!("{keys} cannot be used with {other}"),
            }
        }
        _ => {
            let text = refused.to_string();
            let line = text.lines().next().unwrap_or_default();
            line.trim_start_matches("error: ").to_owned()
        }
    };
    let error = Error::usage(message);
    let is_named = |(key, _): &&(String, String)| named.contains(&key.replace('_', "-"));
    match locations.iter().find(is_named) {
        Some((_, location)) => error.at(location),
        None => error,
    }
}

/// Returns the texts that an error has about something.
fn texts(refused: &clap::Error, about: ContextKind) -> Vec<String> {
    match refused.get(about) {
        Some(ContextValue::String(text)) => vec![text.clone()],
        Some(ContextValue::Strings(texts)) => texts.clone(),
        _ => Vec::new(),
    }
}

/// Returns the key for an option as an error names it, such as `--resolution <LENGTH>`.
fn key_of(typed: &str) -> String {
    match typed.strip_prefix("--") {
        Some(long) => {
            let end = long.find([' ', '=', '[']).unwrap_or(long.len());
            long[..end].to_owned()
        }
        None if typed.starts_with('<') || typed.starts_with('[') => FILES.to_owned(),
        None => typed.to_owned(),
    }
}
