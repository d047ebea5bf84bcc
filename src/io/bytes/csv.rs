//! Fields of tables that are written as comma-separated values.

/// Returns a text as a field: in quotes if it has a comma, a quote or the end of a line.
pub(crate) fn csv_field(text: &str) -> String {
    match text.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}
