//! Returns of lidar pulses, by number or by their position among the returns of a pulse.

/// Which returns of a pulse are meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum Return {
    /// Those with this number; 1 is the first.
    Number(u8),
    /// The last one of each pulse, also if it is the only one.
    Last,
    /// The only one of a pulse.
    Single,
}

impl Return {
    /// The first return of each pulse, also if it is the only one.
    pub const FIRST: Return = Return::Number(1);

    /// Returns true if the return with a number, of a pulse with so many, is meant.
    pub fn is(self, number: u8, count: u8) -> bool {
        match self {
            Return::Number(wanted) => number == wanted,
            Return::Last => number == count,
            Return::Single => number == 1 && count == 1,
        }
    }
}

/// Parses returns: `first`, `last`, `single` or `only`, a number, a range such as `2-15`, or `all`,
/// which restricts nothing.
///
/// # Errors
/// If the text is none of these; the error says what is expected.
pub fn parse(text: &str) -> Result<Vec<Return>, String> {
    let plain = text.trim().to_ascii_lowercase();
    let number = |text: &str| text.trim().parse::<u8>().ok();
    let of_range = || {
        let (first, last) = plain.split_once('-').unwrap_or((&plain, &plain));
        let (first, last) = (number(first)?, number(last)?);
        (first <= last).then(|| (first..=last).map(Return::Number).collect())
    };
    match plain.as_str() {
        "first" => Ok(vec![Return::FIRST]),
        "last" => Ok(vec![Return::Last]),
        "single" | "only" => Ok(vec![Return::Single]),
        "all" => Ok(Vec::new()),
        _ => of_range().ok_or_else(|| {
            format!("`{text}` is not a return: expected `first`, `last`, `single`, `all`, a number, or a range such as `2-15`")
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn returns_have_numbers_and_names() {
        for (text, returns) in [
            ("first", vec![Return::FIRST]),
            (" Last", vec![Return::Last]),
            ("single", vec![Return::Single]),
            ("only", vec![Return::Single]),
            ("all", vec![]),
            ("3", vec![Return::Number(3)]),
            (
                "2-4",
                vec![Return::Number(2), Return::Number(3), Return::Number(4)],
            ),
        ] {
            assert_eq!(parse(text), Ok(returns), "{text}");
        }
        for wrong in ["", "second", "256", "-1", "4-2", "1-", "first-last"] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
        let meant = |wanted: Return| {
            [(1, 1), (1, 3), (2, 3), (3, 3), (0, 0)].map(|(number, count)| wanted.is(number, count))
        };
        assert_eq!(meant(Return::FIRST), [true, true, false, false, false]);
        assert_eq!(meant(Return::Last), [true, false, false, true, true]);
        assert_eq!(meant(Return::Single), [true, false, false, false, false]);
    }
}
