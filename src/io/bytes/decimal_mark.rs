//! The mark between the integer digits and the decimals of the numbers of a file.

use crate::error::{Error, Result};

/// The decimal mark of the numbers that were read so far: a comma or a point.
///
/// A program writes all its numbers with the same mark. If a file has both, one of them groups
/// digits, and 500,000 may be half a million.
#[derive(Debug, Default)]
pub(crate) struct DecimalMark(Option<First>);

/// The first number with a mark.
#[derive(Debug)]
struct First {
    mark: u8,
    text: String,
    location: String,
}

impl DecimalMark {
    /// Returns true if the mark is known to be a comma.
    pub(crate) fn is_comma(&self) -> bool {
        self.0.as_ref().is_some_and(|first| first.mark == b',')
    }

    /// Returns true if a text may contain a number with the other mark, or the first one with any.
    pub(crate) fn concerns(&self, text: &[u8]) -> bool {
        match &self.0 {
            Some(First { mark: b',', .. }) => text.contains(&b'.'),
            Some(_) => text.contains(&b','),
            None => text.contains(&b'.') || text.contains(&b','),
        }
    }

    /// Adds a number, written with at most one mark, at a location such as "line 3".
    ///
    /// # Errors
    /// If an earlier number has the other mark; names both, and where the other one is.
    pub(crate) fn add(&mut self, number: &[u8], location: impl Fn() -> String) -> Result<()> {
        let Some(mark) = number
            .iter()
            .copied()
            .find(|byte| matches!(byte, b',' | b'.'))
        else {
            return Ok(());
        };
        let text = || String::from_utf8_lossy(number).into_owned();
        let first = self.0.get_or_insert_with(|| First {
            mark,
            text: text(),
            location: location(),
        });
        if first.mark == mark {
            return Ok(());
        }
        let name = |mark| if mark == b',' { "a comma" } else { "a point" };
        Err(Error::format(format!(
            "{} has {} and {}, in {}, has {}: one of the two marks does not stand before decimals but between groups \
             of digits",
            text(),
            name(mark),
            first.text,
            first.location,
            name(first.mark)
        ))
        .at(location())
        .cure("write all numbers with the same decimal mark, and without marks between groups of digits"))
    }
}

#[cfg(test)]
mod tests {
    use super::DecimalMark;

    #[test]
    fn two_marks_in_a_file_are_refused_by_both_numbers() {
        let mut mark = DecimalMark::default();
        for (line, number) in ["12", "500,000", "-3", "7,5e3"].iter().enumerate() {
            assert!(mark.0.is_none() || !mark.concerns(b"12 13,5"));
            mark.add(number.as_bytes(), || format!("line {line}"))
                .unwrap();
        }
        assert!(mark.concerns(b"3.5"));
        let error = mark.add(b"3.5", || "line 9".to_owned()).unwrap_err();
        assert!(
            error
                .to_string()
                .starts_with("line 9: 3.5 has a point and 500,000, in line 1, has a comma"),
            "{error}"
        );
    }
}
