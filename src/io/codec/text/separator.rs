//! The separator between the fields of a line.

use crate::error::Result;
use crate::io::bytes::decimal_mark::DecimalMark;

/// The separator between two fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Separator {
    Semicolon,
    Tab,
    Comma,
    Blanks,
}

/// Which coordinates of points are needed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axes {
    /// x and y.
    Plan,
    /// x, y and z.
    Space,
}

impl Axes {
    /// Returns how many there are.
    pub(super) fn count(self) -> usize {
        match self {
            Axes::Plan => 2,
            Axes::Space => 3,
        }
    }
}

impl Separator {
    /// Returns the first separator that divides the line into three numbers, or else into as many
    /// as there are axes, or else into as many fields.
    pub(super) fn guess(line: &[u8], axes: Axes) -> Option<Self> {
        let all = [Self::Semicolon, Self::Tab, Self::Comma, Self::Blanks];
        let has_numbers = |separator: &Self, needed: usize| {
            separator
                .fields(line)
                .filter_map(|field| separator.number(field))
                .take(needed)
                .count()
                == needed
        };
        let needed = axes.count();
        let has_fields = |separator: &Self| separator.fields(line).take(needed).count() == needed;
        let by_numbers = |needed| {
            all.into_iter()
                .find(|separator| has_numbers(separator, needed))
        };
        by_numbers(3)
            .or_else(|| by_numbers(needed))
            .or_else(|| all.into_iter().find(has_fields))
    }

    /// Returns true if commas do two things in a line of numbers: they separate them, and stand
    /// before their decimals, as in `1,5, 2,5, 3,5`.
    pub(super) fn has_two_uses(self, line: &[u8], axes: Axes) -> bool {
        let needed = axes.count();
        let words = line
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty());
        let is_decimal = |word: &[u8]| {
            let number = word.strip_suffix(b",").unwrap_or(word);
            number.contains(&b',') && Self::Blanks.number(number).is_some()
        };
        self == Self::Comma
            && words
                .map(is_decimal)
                .take(needed)
                .filter(|is_decimal| *is_decimal)
                .count()
                == needed
    }

    /// Returns the byte that separates fields.
    pub(super) fn byte(self) -> u8 {
        match self {
            Self::Semicolon => b';',
            Self::Tab => b'\t',
            Self::Comma => b',',
            Self::Blanks => b' ',
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Semicolon => "semicolons",
            Self::Tab => "tabs",
            Self::Comma => "commas",
            Self::Blanks => "blanks",
        }
    }

    /// Adds the decimal marks of the numbers in a line.
    pub(super) fn add_marks(self, mark: &mut DecimalMark, line: &[u8], number: u64) -> Result<()> {
        // A comma that separates is never before decimals.
        if self == Self::Comma || !mark.concerns(line) {
            return Ok(());
        }
        let mut numbers = self
            .fields(line)
            .filter(|field| self.number(field).is_some());
        numbers.try_for_each(|text| mark.add(text, || format!("line {number}")))
    }

    /// Returns true if a byte is between two fields.
    pub(super) fn ends_field(self, byte: u8) -> bool {
        match self {
            Self::Semicolon | Self::Tab | Self::Comma => byte == self.byte(),
            Self::Blanks => byte == b' ' || byte == b'\t',
        }
    }

    /// Returns the fields of a line, without quotes and surrounding blanks.
    pub(super) fn fields(self, line: &[u8]) -> impl Iterator<Item = &[u8]> {
        let mut rest = Some(if self == Self::Blanks {
            line.trim_ascii()
        } else {
            line
        });
        std::iter::from_fn(move || {
            let line = rest?;
            let length = self.field_length(line);
            rest = line.get(length + 1..);
            if self == Self::Blanks {
                rest = rest.map(|rest| rest.trim_ascii_start());
            }
            let field = line[..length].trim_ascii();
            Some(
                field
                    .strip_prefix(b"\"")
                    .and_then(|field| field.strip_suffix(b"\""))
                    .unwrap_or(field)
                    .trim_ascii(),
            )
        })
    }

    /// Returns the number of bytes before the next separator that is not in quotes.
    fn field_length(self, line: &[u8]) -> usize {
        let mut in_quotes = false;
        line.iter()
            .position(|&byte| {
                in_quotes ^= byte == b'"';
                !in_quotes && self.ends_field(byte)
            })
            .unwrap_or(line.len())
    }

    /// Parses a number; the comma may be a decimal comma if it is not the separator.
    pub(super) fn number(self, field: &[u8]) -> Option<f64> {
        let text = std::str::from_utf8(field).ok()?;
        let value: f64 = match self {
            Self::Semicolon | Self::Tab | Self::Blanks
                if field.contains(&b',') && !field.contains(&b'.') =>
            {
                text.replacen(',', ".", 1).parse().ok()?
            }
            _ => text.parse().ok()?,
        };
        value.is_finite().then_some(value)
    }
}
