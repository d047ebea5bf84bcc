//! `--where`, which belongs to the layer before it.

use std::ffi::OsString;

use clap::CommandFactory;

use super::args::Cli;
use crate::error::{Error, Result};
use crate::io::{formats, layer};

const CURE: &str = "write it just after the layer whose records it chooses, as in --breaklines \
    edges.gpkg:lines --where \"kind = 'toe'\"; among several inputs, write \
    \"FILE where kind = 'toe'\" as one word";

/// Adds a condition to the layer before it among the words of a verb: the value of an option, or
/// the only input so far. The result is the one word `FILE where CONDITION`.
///
/// # Errors
/// If the word before it is not a layer, or the text is not a condition.
pub(super) fn add(
    name: &str,
    condition: &str,
    verb: &str,
    words: &mut Vec<OsString>,
) -> Result<()> {
    let misplaced = || Error::usage(format!("{name} is not after a layer")).cure(CURE);
    let last = words.last().ok_or_else(misplaced)?;
    let last = last.to_string_lossy();
    let before = words.iter().rev().nth(1).map(|word| word.to_string_lossy());
    let attached = last.split_once('=').filter(|_| last.starts_with("--"));
    let text = match attached {
        Some((option, text)) if takes_layer(verb, option) => text,
        None if !last.starts_with('-') && before.is_none_or(|word| takes_layer(verb, &word)) => {
            &*last
        }
        _ => return Err(misplaced()),
    };
    let file = layer::file_of(text);
    let format = formats::detect_file(file).ok().flatten();
    if let Some(format) = format.filter(|format| format.content != formats::Content::Layer) {
        let error = format!("{name} chooses records of a layer, not of {}", format.noun);
        return Err(Error::usage(error)
            .in_file(file)
            .cure("points are chosen by --class and --return"));
    }
    layer::Spec::parse(&layer::with_condition(text, condition))?;
    let whole = layer::with_condition(&last, condition);
    words.pop();
    words.push(whole.into());
    Ok(())
}

/// Returns true if an option of a verb names a layer.
fn takes_layer(verb: &str, option: &str) -> bool {
    let Some(long) = option.strip_prefix("--") else {
        return false;
    };
    let command = Cli::command();
    let arguments = command.find_subcommand(verb).into_iter();
    let mut arguments = arguments.flat_map(clap::Command::get_arguments);
    arguments.any(|argument| {
        let names = argument.get_long_and_visible_aliases().unwrap_or_default();
        let values = argument.get_value_names().unwrap_or_default();
        names.contains(&long) && values.iter().any(|value| value.starts_with("FILE[:"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn added(verb: &str, words: &[&str]) -> Result<Vec<String>> {
        let mut words: Vec<OsString> = words.iter().map(OsString::from).collect();
        add("--where", "kind = 'toe'", verb, &mut words)?;
        let text = |word: OsString| word.into_string().unwrap();
        Ok(words.into_iter().map(text).collect())
    }

    #[test]
    fn a_condition_belongs_to_the_layer_before_it() {
        for (verb, words) in [
            ("tin", &["a.laz", "--breaklines", "e.gpkg:lines"][..]),
            ("tin", &["--flat", "x.shp", "--breaklines=e.gpkg:lines"]),
            ("dem", &["--lakes", "e.shp"]),
            ("contour", &["e.gpkg:lines"]),
            ("profile", &["a.tin", "--along", "e.shp"]),
            ("drape", &["a.tin", "--lines", "e.shp"]),
            ("volume", &["a.tin", "--within", "e.shp"]),
            ("points", &["a.laz", "--boundary", "e.shp"]),
        ] {
            let found = added(verb, words).unwrap();
            let (last, rest) = found.split_last().unwrap();
            let (before, unchanged) = words.split_last().unwrap();
            assert_eq!(*last, format!("{before} where kind = 'toe'"));
            assert_eq!(rest, unchanged);
        }
    }

    #[test]
    fn a_condition_elsewhere_is_an_error() {
        for words in [
            &[][..],
            &["--overwrite"],
            &["a.shp", "b.shp"],
            &["--breaklines", "e.shp", "--overwrite"],
            &["--resolution", "5"],
            &["--resolution=5"],
        ] {
            let error = added("dem", words).unwrap_err();
            assert_eq!(
                error.to_string(),
                "--where is not after a layer",
                "{words:?}"
            );
        }
    }
}
