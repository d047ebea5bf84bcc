//! Detects a first column that may be the number of the point instead of its x.

use super::separator::Separator;
use crate::error::{Error, Setting, Wording, wording};

/// What is known of a first column of integers that is followed by three numbers in each line.
#[derive(Debug, Clone, Copy)]
pub(super) struct FirstColumn {
    last: f64,
    lines: u64,
    /// True if it has counted up by one so far.
    is_counted: bool,
    /// True if one of the next two columns has had a number that is not an integer.
    has_fraction: bool,
}

/// The likely content of the first column.
#[derive(Debug, Clone, Copy)]
pub(super) enum Guess {
    /// x, as far as the points show.
    Coordinates,
    /// The number of the point: it counts up by one.
    Counted,
    /// Perhaps the number of the point: it is an integer in each line, and the next two columns are
    /// not.
    Whole,
}

/// Returns the warning about a first column of whole numbers.
pub(super) fn whole() -> Wording {
    wording![
        "the first column, taken as x, holds whole numbers only, and the next two do not: if it is the number \
         of the point, say so with ",
        Setting::Columns.text("PNEZD"),
        " (or PENZD)"
    ]
}

impl FirstColumn {
    /// Returns what is known after the first point; `None` if its first column cannot be a number
    /// of the point.
    pub(super) fn start(separator: Separator, line: &[u8]) -> Option<Self> {
        let [last, x, y] = first_of_four(separator, line)?;
        let has_fraction = x.fract() != 0.0 || y.fract() != 0.0;
        (last.fract() == 0.0).then_some(FirstColumn {
            last,
            lines: 1,
            is_counted: true,
            has_fraction,
        })
    }

    /// Returns what is known after one more point; `None` if its first column cannot be a number of
    /// the point.
    pub(super) fn next(self, separator: Separator, line: &[u8]) -> Option<Self> {
        let here = FirstColumn::start(separator, line)?;
        Some(FirstColumn {
            lines: self.lines + 1,
            is_counted: self.is_counted && here.last == self.last + 1.0,
            has_fraction: self.has_fraction || here.has_fraction,
            ..here
        })
    }

    /// Returns what the first column is likely to be after all these points.
    pub(super) fn guess(self) -> Guess {
        match self {
            _ if self.lines < 2 => Guess::Coordinates,
            _ if self.is_counted => Guess::Counted,
            _ if self.has_fraction => Guess::Whole,
            _ => Guess::Coordinates,
        }
    }
}

/// Returns the first three numbers, if the first four fields are all numbers.
fn first_of_four(separator: Separator, line: &[u8]) -> Option<[f64; 3]> {
    let mut numbers = separator
        .fields(line)
        .map_while(|field| separator.number(field));
    let first = [numbers.next()?, numbers.next()?, numbers.next()?];
    numbers.next().map(|_| first)
}

#[cold]
pub(super) fn refuse() -> Error {
    Error::format(
        "the first column counts up by one in each line, and three numbers follow: it looks like the number of the \
         point, before northing, easting and height (PNEZD)",
    )
    .cure(wording![
        "say which columns to take: ",
        Setting::Columns.text("PNEZD"),
        ", or PENZD if the easting comes first, or XYZ if the first column is x after all"
    ])
}
