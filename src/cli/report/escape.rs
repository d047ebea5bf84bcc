//! Escaping of text for the terminal: text from files may contain control sequences.

use std::borrow::Cow;

/// Returns a line of text in which control characters, line ends and marks of the direction of
/// writing are written as `\u{1b}`.
pub(crate) fn line(text: &str) -> Cow<'_, str> {
    escaped(text, |c| c.escape_default().collect())
}

/// Like [`line`], for text of several lines.
pub(crate) fn lines(text: &str) -> String {
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

/// Escapes lines of JSON by JSON's own escapes, so that their values do not change.
pub(crate) fn json(text: &str) -> String {
    let json = |line| escaped(line, |c| format!("\\u{:04x}", u32::from(c)));
    text.split('\n').map(json).collect::<Vec<_>>().join("\n")
}

fn escaped(text: &str, escape: impl Fn(char) -> String) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_hidden(c) {
            shown += &escape(c);
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

/// Returns true for characters that are invisible or change how others appear: C0, DEL and C1, line
/// ends of any kind, marks and overrides of the direction, the byte order mark.
fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_hidden_is_shown_and_nothing_else_is_touched() {
        assert!(matches!(
            line("C:\\Gr\u{fc}\u{df}e \"\u{6d4b}\u{8bd5}\" \u{200d}"),
            Cow::Borrowed(_)
        ));
        assert_eq!(
            line("a\u{1b}]0;x\u{7}\r\nb\u{7f}\u{9b}2J"),
            r"a\u{1b}]0;x\u{7}\r\nb\u{7f}\u{9b}2J"
        );
        assert_eq!(
            line("\u{202e}fig\u{2066}\u{2028}\u{feff}"),
            r"\u{202e}fig\u{2066}\u{2028}\u{feff}"
        );
        assert_eq!(lines("a\u{1b}\nb\r\n"), "a\\u{1b}\nb\\r\n");
        assert_eq!(json("{\n\"\u{9b}\u{202e}\"\n}"), "{\n\"\\u009b\\u202e\"\n}");
    }
}
