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

/// Parses classes: `2`, `ground`, `low-vegetation`, a range such as `0-31`, or `all`.
///
/// # Errors
/// If the text is neither a number up to 255, nor a name, nor a range; the error says what is
/// expected.
pub fn parse(text: &str) -> Result<Vec<u8>, String> {
    let of_range = || {
        let (first, last) = text.split_once('-')?;
        let (first, last) = (first.trim().parse().ok()?, last.trim().parse().ok()?);
        (first <= last).then(|| (first..=last).collect())
    };
    if text.trim().eq_ignore_ascii_case("all") {
        return Ok((0..=u8::MAX).collect());
    }
    one(text).map(|class| vec![class]).or_else(of_range).ok_or_else(|| {
        format!("`{text}` is not a class: expected 0 to 255, a range such as `0-31`, `all`, or a name such as `ground` or `low-vegetation`")
    })
}

fn one(text: &str) -> Option<u8> {
    let plain = text.trim().replace(['-', '_'], " ").to_ascii_lowercase();
    let by_name = || {
        NAMES
            .iter()
            .position(|name| *name == plain)
            .map(|class| class as u8)
    };
    plain.parse().ok().or_else(by_name)
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
            assert_eq!(parse(text), Ok(vec![class]));
        }
        assert!(
            [
                "256",
                "-1",
                "gras",
                "",
                "3-2",
                "0-256",
                "2-",
                "ground-water"
            ]
            .iter()
            .all(|text| parse(text).is_err())
        );
        assert_eq!(parse("1-3"), Ok(vec![1, 2, 3]));
        let everything: Vec<u8> = (0..=255).collect();
        assert!(
            ["all", "All ", "0-255"]
                .iter()
                .all(|text| parse(text).as_ref() == Ok(&everything))
        );
        assert_eq!(
            [name(2), name(40), name(200)],
            ["ground", "reserved", "user-defined"]
        );
    }
}
