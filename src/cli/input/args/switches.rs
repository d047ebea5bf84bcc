//! Triangle's switches as its users type them: several in one word, with numbers directly after the
//! letters.

use std::ffi::OsString;

use crate::error::{Error, Result};

/// Expands words such as `-pq30a0.5S9000` after `triangulate` into options of this program. The
/// switches `p`, `q`, `a`, `c`, `S`, `Q` and `V` of Triangle are known; `-p` is dropped, since the
/// name of the file says the same.
///
/// # Errors
/// If a word contains other switches.
pub(crate) fn expand_switches(words: impl IntoIterator<Item = OsString>) -> Result<Vec<OsString>> {
    let mut is_over = false;
    let mut expanded = Vec::new();
    for word in words {
        is_over |= word == "--";
        match word.to_str().filter(|text| !is_over && is_switches(text)) {
            Some(text) => {
                let options = options_of(&text[1..]).ok_or_else(|| {
                    Error::usage(format!("`{text}`: of Triangle's switches, p, q, a, c, S, Q and V are understood"))
                        .cure("-o NAME.edge writes edges, -o NAME.neigh neighbors; an option of this program has two dashes")
                })?;
                expanded.extend(options.into_iter().map(OsString::from));
            }
            None => expanded.push(word),
        }
    }
    Ok(expanded)
}

/// Returns true if a word begins with one dash and a letter, and is not one of this program's own
/// options `-o`, `-v` and `-h`.
fn is_switches(word: &str) -> bool {
    let first = word.strip_prefix('-').and_then(|rest| rest.chars().next());
    first.is_some_and(|first| first.is_ascii_alphabetic() && !matches!(first, 'o' | 'v' | 'h'))
}

/// Returns the options that the switches mean; `None` if one is not known.
fn options_of(mut rest: &str) -> Option<Vec<String>> {
    let mut options = Vec::new();
    while let Some(switch) = rest.chars().next() {
        let (number, after) = split_number(&rest[switch.len_utf8()..]);
        match (switch, number) {
            ('p', "") => {}
            ('c', "") => options.push("--convex".to_owned()),
            ('q', "") => options.push("--min-angle=20".to_owned()),
            ('a', "") => options.push("--region-areas".to_owned()),
            ('S', "") => options.push("--max-added=0".to_owned()),
            ('Q', "") => options.push("--quiet".to_owned()),
            ('V', "") => options.push("--verbose".to_owned()),
            ('S', number) => options.push(format!("--max-added={number}")),
            ('q', number) => options.push(format!("--min-angle={number}")),
            ('a', number) => options.push(format!("--max-area={number}")),
            _ => return None,
        }
        rest = after;
    }
    Some(options)
}

/// Splits off the number at the start of a text, including its exponent if any, from what follows.
fn split_number(text: &str) -> (&str, &str) {
    let digits = |text: &str| {
        text.find(|c: char| !c.is_ascii_digit() && c != '.')
            .unwrap_or(text.len())
    };
    let mut end = digits(text);
    if let Some(exponent) = text[end..].strip_prefix(['e', 'E']).filter(|_| end > 0) {
        let power = exponent.strip_prefix(['-', '+']).unwrap_or(exponent);
        let length = power
            .find(|c: char| !c.is_ascii_digit())
            .unwrap_or(power.len());
        if length > 0 {
            end = text.len() - power.len() + length;
        }
    }
    text.split_at(end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_switches_are_told_from_others() {
        let expand = |text: &str| {
            let words = expand_switches(text.split(' ').map(OsString::from))?;
            Ok::<_, Error>(
                words
                    .iter()
                    .map(|word| word.to_str().unwrap())
                    .collect::<Vec<_>>()
                    .join(" "),
            )
        };
        for (typed, meant) in [
            ("-pq30a0.5 x.poly", "--min-angle=30 --max-area=0.5 x.poly"),
            (
                "-q x.poly -c -a",
                "--min-angle=20 x.poly --convex --region-areas",
            ),
            ("-p x.poly -o a.ele", "x.poly -o a.ele"),
            (
                "-pq30S500 x.poly -S",
                "--min-angle=30 --max-added=500 x.poly --max-added=0",
            ),
            (
                "-a1e-7 -pa.5E+3q30 -a2e3",
                "--max-area=1e-7 --max-area=.5E+3 --min-angle=30 --max-area=2e3",
            ),
            (
                "-v -oa.ele --convex -q1. -QV",
                "-v -oa.ele --convex --min-angle=1. --quiet --verbose",
            ),
            ("- --max-area -3 -- -e", "- --max-area -3 -- -e"),
        ] {
            assert_eq!(expand(typed).unwrap(), meant);
        }
        for wrong in ["-s9", "-a1e", "-pe", "-tr", "-D"] {
            let error = expand(wrong).unwrap_err();
            assert!(
                error
                    .to_string()
                    .starts_with(&format!("`{wrong}`: of Triangle's switches")),
                "{error}"
            );
        }
    }
}
