//! Names of the classes of lidar points, from LAS 1.4.

const NAMES: [&str; 23] = [
    "never classified",
    "unclassified",
    "ground",
    "low vegetation",
    "medium vegetation",
    "high vegetation",
    "building",
    "low noise",
    "key point",
    "water",
    "rail",
    "road",
    "overlap",
    "wire guard",
    "wire conductor",
    "tower",
    "wire connector",
    "bridge deck",
    "high noise",
    "overhead structure",
    "ignored ground",
    "snow",
    "temporal exclusion",
];

/// Returns the name of a class.
pub fn name(class: usize) -> &'static str {
    NAMES.get(class).copied().unwrap_or(if class < 64 {
        "reserved"
    } else {
        "user-defined"
    })
}

/// Parses a class: `2`, `ground`, `low-vegetation`.
///
/// # Errors
/// If the text is neither a number up to 255 nor a name; the error says what is expected.
pub fn parse(text: &str) -> Result<u8, String> {
    let plain = text.trim().replace(['-', '_'], " ").to_ascii_lowercase();
    let by_name = || {
        NAMES
            .iter()
            .position(|name| *name == plain)
            .map(|class| class as u8)
    };
    plain.parse().ok().or_else(by_name).ok_or_else(|| {
        format!("`{text}` is not a class: expected 0 to 255, or a name such as `ground` or `low-vegetation`")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_have_numbers_and_names() {
        for (text, class) in [
            ("2", 2),
            (" ground", 2),
            ("Low-Vegetation", 3),
            ("low_noise", 7),
            ("255", 255),
        ] {
            assert_eq!(parse(text), Ok(class));
        }
        assert!(
            ["256", "-1", "gras", ""]
                .iter()
                .all(|text| parse(text).is_err())
        );
        assert_eq!(
            [name(2), name(40), name(200)],
            ["ground", "reserved", "user-defined"]
        );
    }
}
