//! Commands as they are typed in a shell.

use std::ffi::OsString;

/// Returns the words of a command of this program as a line for a shell.
pub(crate) fn command_line(words: &[OsString]) -> String {
    let words = words.iter().map(|word| quoted(&word.to_string_lossy()));
    let words: Vec<String> = words.collect();
    format!("breakline {}", words.join(" "))
}

/// Quotes a word as a shell needs it.
pub(crate) fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./,:=+@".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}
