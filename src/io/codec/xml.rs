//! Escapes of XML.

/// Characters and their escapes; `&` is replaced first when writing, last when reading.
const ESCAPES: [(&str, &str); 4] = [
    ("&", "&amp;"),
    ("<", "&lt;"),
    (">", "&gt;"),
    ("\"", "&quot;"),
];

/// Returns a text as the content of an element or of an attribute in double quotes.
pub(super) fn escaped(text: &str) -> String {
    ESCAPES
        .iter()
        .fold(text.to_owned(), |text, (character, escape)| {
            text.replace(character, escape)
        })
}

/// Returns the text that [`escaped`] was given.
#[cfg(feature = "png")]
pub(super) fn unescaped(text: &str) -> String {
    ESCAPES
        .iter()
        .rev()
        .fold(text.to_owned(), |text, (character, escape)| {
            text.replace(escape, character)
        })
}
