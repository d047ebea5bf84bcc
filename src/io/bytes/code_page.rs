//! Texts of which no one says how they are encoded.

/// Returns a text in UTF-8, or in Windows-1252 if it is not valid UTF-8.
pub(crate) fn utf8_or_windows_1252(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&byte| windows_1252(byte)).collect(),
    }
}

fn windows_1252(byte: u8) -> char {
    // 0x80 to 0x9F; the five unused codes are decoded as in Latin-1.
    const HIGH: &str = "€\u{81}‚ƒ„…†‡ˆ‰Š‹Œ\u{8d}Ž\u{8f}\u{90}‘’“”•–—˜™š›œ\u{9d}žŸ";
    match byte {
        0x80..=0x9F => HIGH
            .chars()
            .nth(usize::from(byte) - 0x80)
            .unwrap_or(char::from(byte)),
        _ => char::from(byte),
    }
}
