//! Conditions on the attributes of records, in the words of SQL, with its three truths: a
//! comparison with a missing value is unknown, and only records for which the whole is true are
//! chosen. One evaluator for all formats, also for those that GDAL reads.

mod evaluate;
mod lex;
mod parse;
#[cfg(all(test, feature = "gpkg"))]
mod sqlite_tests;
#[cfg(test)]
mod tests;

use std::fmt;

use self::parse::Node;
use crate::data::{Value, named};
use crate::error::{Error, Result};
use crate::io::bytes::field::no_such_field;

/// Records whose condition is evaluated together, while a layer is read.
pub(crate) const RECORDS_AT_ONCE: usize = 1024;

/// A condition on the attributes of a record, such as `kind = 'toe' AND height > 2.5`.
///
/// | | |
/// |---|---|
/// | `=` `<>` `!=` `<` `<=` `>` `>=` | two values are compared |
/// | `x IN (a, b)`, `x BETWEEN a AND b` | `x = a OR x = b`, `x >= a AND x <= b` |
/// | `x LIKE 'a%'` | a text with any characters for `%` and one for `_`; `ILIKE` in any case |
/// | `x IS NULL`, `x IS NOT NULL` | nothing, or something |
/// | `NOT`, `AND`, `OR`, `( )` | from the tightest to the loosest |
///
/// Values are names of attributes, bare or in double quotes (as written, else in any case), texts
/// in single quotes, numbers, `TRUE` and `FALSE` (1 and 0), and `NULL`. Words may have any case.
/// Numbers are compared exactly, texts by their characters. Of a number and a text, the text is
/// taken as a number; one that is none is not equal to any number, and an error where an order is
/// asked for.
#[derive(Clone)]
pub struct Condition {
    text: String,
    root: Node<String>,
}

/// Conditions with the same text are equal.
impl PartialEq for Condition {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Eq for Condition {}

impl fmt::Debug for Condition {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        fmt::Debug::fmt(&self.text, f)
    }
}

impl Condition {
    /// Parses a condition.
    ///
    /// # Errors
    /// If the text is none; the error names the character, counted from 1, and what is expected
    /// there.
    ///
    /// # Complexity
    /// Linear.
    pub fn parse(text: &str) -> Result<Self> {
        Ok(Condition {
            text: text.trim().to_owned(),
            root: parse::parse(text.trim())?,
        })
    }

    /// Returns the condition as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Finds the attributes of the condition among those of a layer.
    ///
    /// # Errors
    /// If one does not exist; the error names the most similar one.
    pub fn bind(&self, names: &[String]) -> Result<BoundCondition<'_>> {
        let find = |wanted: &String| {
            let known = || names.iter().map(String::as_str);
            named(known(), wanted).ok_or_else(|| self.no_such(wanted, names))
        };
        Ok(BoundCondition {
            text: &self.text,
            root: self.root.map(&find)?,
        })
    }

    #[cold]
    fn no_such(&self, wanted: &str, names: &[String]) -> Error {
        let error = no_such_field(wanted, names.iter().map(String::as_str));
        let error = error.at(format!("condition `{}`", self.text));
        match nearest(wanted, names) {
            Some(name) => error.cure(format!(
                "is \"{name}\" meant? The fields are {}",
                names.join(", ")
            )),
            None if names.is_empty() => error.cure("the layer has no fields to choose records by"),
            None => error,
        }
    }
}

/// A condition on the attributes of one layer.
#[derive(Debug, Clone)]
pub struct BoundCondition<'a> {
    text: &'a str,
    root: Node<usize>,
}

impl BoundCondition<'_> {
    /// Returns true if the condition is true, and not false or unknown, for a record with these
    /// values; those beyond the end are missing.
    ///
    /// # Errors
    /// If the order of a number and a text is asked for that is no number.
    ///
    /// # Complexity
    /// Linear in the condition and in the texts; `LIKE` in the product of pattern and text.
    pub fn holds(&self, row: &[Value]) -> Result<bool> {
        let held = evaluate::holds(&self.root, row);
        held.map(|held| held == Some(true)).map_err(|mixed| {
            Error::format(format!(
                "condition `{}`: {mixed} has no order",
                self.text
            ))
            .cure("put the number into single quotes to compare texts, or exclude such records before, as in kind <> 'none' AND kind > 5")
        })
    }

    /// Returns the condition as it was written.
    pub(crate) fn text(&self) -> &str {
        self.text
    }
}

/// Returns the name that is most similar to what was typed, if it is similar at all.
fn nearest<'a>(typed: &str, names: &'a [String]) -> Option<&'a str> {
    /// Names are compared up to this length.
    const LONGEST: usize = 64;
    let letters = |text: &str| -> Vec<char> { text.to_lowercase().chars().take(LONGEST).collect() };
    let typed = letters(typed);
    let distances = names
        .iter()
        .map(|name| (edits(&typed, &letters(name)), name));
    let (distance, name) = distances.min_by_key(|&(distance, _)| distance)?;
    (distance <= typed.len().div_ceil(3)).then_some(name)
}

/// Returns how many letters have to be inserted, removed or replaced to make one word the other
/// (Levenshtein).
fn edits(a: &[char], b: &[char]) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.iter().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, to) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(from != to);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
