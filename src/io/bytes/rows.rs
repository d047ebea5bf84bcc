//! Tables of numbers in text: numbered lines of words, without comments.

use std::str::FromStr;

use super::watch::{Meter, Watch};
use crate::error::{Error, Result};

/// The lines of a text that contain more than a comment (`#` to the end of the line).
pub(crate) struct Rows<'a> {
    rest: &'a [u8],
    line: usize,
    meter: Meter<'a>,
}

/// A line of words, separated by blanks or commas. Words are taken from its start.
pub(crate) struct Row<'a> {
    rest: &'a [u8],
    /// Line number, from 1.
    pub(crate) line: usize,
    /// The expected pattern of the line.
    pattern: &'static str,
}

impl<'a> Rows<'a> {
    pub(crate) fn new(bytes: &'a [u8], watch: Watch<'a>) -> Self {
        let rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        Rows {
            rest,
            line: 0,
            meter: Meter::new(watch, rest.len()),
        }
    }

    /// Returns the number of bytes that are left of the text.
    pub(crate) fn bytes_left(&self) -> usize {
        self.rest.len()
    }

    /// Returns the next line, which should match `pattern`.
    ///
    /// # Errors
    /// If the text has ended; the message says what is missing. That of the watch.
    pub(crate) fn expect(
        &mut self,
        what: impl FnOnce() -> String,
        pattern: &'static str,
    ) -> Result<Row<'a>> {
        self.meter.left(self.rest.len())?;
        self.next(pattern).ok_or_else(|| {
            Error::format(format!("the file ends where {} is expected", what()))
                .at(format!("line {}", self.line.max(1)))
                .cure(format!(
                    "get the whole file, or correct the count; the line should be '{pattern}'"
                ))
        })
    }

    /// Like [`next`](Self::next), but watched.
    ///
    /// # Errors
    /// That of the watch.
    pub(crate) fn next_watched(&mut self, pattern: &'static str) -> Result<Option<Row<'a>>> {
        self.meter.left(self.rest.len())?;
        Ok(self.next(pattern))
    }

    /// Returns the next line, which should match `pattern`; `None` at the end.
    pub(crate) fn next(&mut self, pattern: &'static str) -> Option<Row<'a>> {
        while !self.rest.is_empty() {
            let end = self
                .rest
                .iter()
                .position(|&b| b == b'\n')
                .unwrap_or(self.rest.len());
            let line = &self.rest[..end];
            self.rest = self.rest.get(end + 1..).unwrap_or_default();
            self.line += 1;
            let mut row = Row {
                rest: line,
                line: self.line,
                pattern,
            };
            if let Some(comment) = line.iter().position(|&b| b == b'#') {
                row.rest = &line[..comment];
            }
            if row.clone_of_rest().word().is_some() {
                return Some(row);
            }
        }
        None
    }

    /// Checks that no lines are left.
    ///
    /// # Errors
    /// If there are more lines, which means that a count before them is wrong. `last` is what
    /// should have been the last.
    pub(crate) fn end(mut self, last: &str) -> Result<()> {
        match self.next("") {
            None => Ok(()),
            Some(mut row) => {
                let word = row.word().map(shown).unwrap_or_default();
                Err(Error::format(format!(
                    "'{word}' follows {last}, expected the end of the file"
                ))
                .at(format!("line {}", row.line))
                .cure("correct the count in the line before that list, or remove what follows it"))
            }
        }
    }
}

impl<'a> Row<'a> {
    fn clone_of_rest(&self) -> Row<'a> {
        Row { ..*self }
    }

    /// Returns the next word.
    pub(crate) fn word(&mut self) -> Option<&'a [u8]> {
        let is_blank = |b: u8| b.is_ascii_whitespace() || b == b',';
        let start = self.rest.iter().position(|&b| !is_blank(b))?;
        let length = self.rest[start..]
            .iter()
            .position(|&b| is_blank(b))
            .unwrap_or(self.rest.len() - start);
        let word = &self.rest[start..start + length];
        self.rest = &self.rest[start + length..];
        Some(word)
    }

    /// Returns an error if the line has a comma, for formats that separate words by blanks only: it
    /// may be a decimal comma.
    ///
    /// # Errors
    /// Names the word.
    pub(crate) fn refuse_commas(&self) -> Result<()> {
        let mut words = self.rest.split(u8::is_ascii_whitespace);
        match words.find(|word| word.contains(&b',')) {
            Some(word) => Err(self.wrong(format!(
                "'{}' has a comma, expected a decimal point",
                shown(word)
            ))),
            None => Ok(()),
        }
    }

    /// Returns true if there are words left.
    pub(crate) fn has_more(&self) -> bool {
        self.clone_of_rest().word().is_some()
    }

    /// Returns the next word as an integer; `1.0` and `1e0` are accepted as well.
    ///
    /// # Errors
    /// If there is none or it is something else.
    pub(crate) fn whole(&mut self, what: &str) -> Result<i64> {
        let word = self.some(what)?;
        if let Some(number) = parse(word) {
            return Ok(number);
        }
        let whole =
            parse::<f64>(word).filter(|number| number.fract() == 0.0 && number.abs() < 1e15);
        let number = whole.ok_or_else(|| {
            self.wrong(format!(
                "'{}' is not a whole number for the {what}",
                shown(word)
            ))
        })?;
        Ok(number as i64)
    }

    /// Like [`whole`](Self::whole), but within the range of a type; a count, for example, cannot be
    /// negative.
    ///
    /// # Errors
    /// As [`whole`](Self::whole).
    pub(crate) fn within<T: TryFrom<i64>>(&mut self, what: &str) -> Result<T> {
        let number = self.whole(what)?;
        T::try_from(number)
            .map_err(|_| self.wrong(format!("{number} is out of range for the {what}")))
    }

    /// Like [`within`](Self::within), but returns `default` at the end of the line.
    ///
    /// # Errors
    /// As [`whole`](Self::whole).
    pub(crate) fn within_or<T: TryFrom<i64>>(&mut self, what: &str, default: T) -> Result<T> {
        if self.has_more() {
            self.within(what)
        } else {
            Ok(default)
        }
    }

    /// Returns the next word as a finite number.
    ///
    /// # Errors
    /// If there is none or it is something else.
    pub(crate) fn finite(&mut self, what: &str) -> Result<f64> {
        let word = self.some(what)?;
        let number: f64 = parse(word).ok_or_else(|| {
            self.wrong(format!("'{}' is not a number for the {what}", shown(word)))
        })?;
        if !number.is_finite() {
            return Err(self.wrong(format!(
                "the {what} is {}, expected a finite number",
                shown(word)
            )));
        }
        Ok(number)
    }

    fn some(&mut self, what: &str) -> Result<&'a [u8]> {
        self.word()
            .ok_or_else(|| self.wrong(format!("there is no {what}")))
    }

    /// Returns an error in this line, with the expected pattern as the cure.
    #[cold]
    pub(crate) fn wrong(&self, message: String) -> Error {
        let cure = format!("correct the line; it should be '{}'", self.pattern);
        Error::format(message)
            .at(format!("line {}", self.line))
            .cure(cure)
    }
}

fn parse<T: FromStr>(word: &[u8]) -> Option<T> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// Returns a word as shown in messages.
pub(crate) fn shown(word: &[u8]) -> String {
    let printable = |c: char| {
        if c.is_control() {
            char::REPLACEMENT_CHARACTER
        } else {
            c
        }
    };
    String::from_utf8_lossy(word)
        .chars()
        .take(40)
        .map(printable)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::bytes::watch::unwatched;

    #[test]
    fn comments_and_blank_lines_are_not_rows() {
        let mut rows = Rows::new(
            b"\xef\xbb\xbf# title\r\n\n  \t\r\n 1, 2.5 # a comment\r\n,,\n3e0 x",
            &unwatched,
        );
        let mut row = rows.next("N X").unwrap();
        assert_eq!(
            (row.line, row.whole("n").unwrap(), row.finite("x").unwrap()),
            (4, 1, 2.5)
        );
        assert!(!row.has_more());
        assert_eq!(
            row.finite("y").unwrap_err().to_string(),
            "line 4: there is no y"
        );
        let mut row = rows.next("N X").unwrap();
        assert_eq!((row.line, row.within::<u32>("n").unwrap()), (6, 3));
        let error = row.finite("x").unwrap_err();
        assert_eq!(error.to_string(), "line 6: 'x' is not a number for the x");
        assert_eq!(
            *error.cure_text().unwrap(),
            "correct the line; it should be 'N X'"
        );
        assert_eq!(
            rows.expect(|| "vertex 2".into(), "N")
                .err()
                .unwrap()
                .to_string(),
            "line 6: the file ends where vertex 2 is expected"
        );
    }

    #[test]
    fn numbers_that_are_none_are_named() {
        let read = |text: &str| {
            let mut rows = Rows::new(text.as_bytes(), &unwatched);
            let mut row = rows.next("N").unwrap();
            let whole = row
                .clone_of_rest()
                .within::<u32>("n")
                .map_err(|e| e.to_string());
            (whole, row.finite("n").map_err(|e| e.to_string()))
        };
        assert_eq!(read("7"), (Ok(7), Ok(7.0)));
        assert_eq!(
            read("1.5").0,
            Err("line 1: '1.5' is not a whole number for the n".into())
        );
        assert_eq!(
            read("-1").0,
            Err("line 1: -1 is out of range for the n".into())
        );
        assert_eq!(
            read("4294967296").0,
            Err("line 1: 4294967296 is out of range for the n".into())
        );
        for odd in ["nan", "inf", "-Infinity", "1e999"] {
            assert_eq!(
                read(odd).1,
                Err(format!("line 1: the n is {odd}, expected a finite number"))
            );
            assert!(read(odd).0.is_err());
        }
    }
}
