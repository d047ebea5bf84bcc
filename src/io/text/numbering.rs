//! Whether the first column may be the number of the point rather than its x.

use super::separator::Separator;
use crate::error::Error;

/// A first column that counted up by one so far, with three numbers behind it in each line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Numbering {
    last: f64,
    lines: u64,
}

impl Numbering {
    /// What the first point leaves open.
    pub(super) fn start(separator: Separator, line: &[u8]) -> Option<Self> {
        let last = first_of_four(separator, line)?;
        (last.fract() == 0.0).then_some(Numbering { last, lines: 1 })
    }

    /// What another point leaves open.
    pub(super) fn next(self, separator: Separator, line: &[u8]) -> Option<Self> {
        let next = self.last + 1.0;
        (first_of_four(separator, line) == Some(next)).then_some(Numbering { last: next, lines: self.lines + 1 })
    }

    /// Whether there are points enough to say so.
    pub(super) fn is_likely(self) -> bool {
        self.lines > 1
    }
}

/// The first number, if all of the first four fields are numbers.
fn first_of_four(separator: Separator, line: &[u8]) -> Option<f64> {
    let mut numbers = separator.fields(line).map_while(|field| separator.number(field));
    let first = numbers.next()?;
    (numbers.take(3).count() == 3).then_some(first)
}

#[cold]
pub(super) fn refuse() -> Error {
    Error::format(
        "the first column counts up by one in each line, and three numbers follow: it looks like the number of the \
         point, before northing, easting and height (PNEZD)",
    )
    .cure(
        "say which columns to take: --columns PNEZD, or PENZD if the easting comes first, \
         or XYZ if the first column is x after all",
    )
}
