//! Points as text: XYZ, CSV and similar formats.
//!
//! Each line contains one point. Fields are separated by semicolons, tabs, commas or blanks; the
//! first point determines by which of them. The columns are those of
//! [`Columns`](crate::data::Columns) if given, else those that a header line names, else the first
//! three are x, y and z.
//!
//! If neither names the columns, the first one may be the number of the point. If it counts up by
//! one from line to line and three numbers follow, reading fails. If it only contains integers, and
//! the next two columns do not, there is a warning.
//!
//! Header names are matched in any case and order:
//!
//! | column | names |
//! |---|---|
//! | x | `x`, `easting`, `east`, `e`, `lon`, `long`, `longitude`, `POINT_X` |
//! | y | `y`, `northing`, `north`, `n`, `lat`, `latitude`, `POINT_Y` |
//! | z | `z`, `elevation`, `elev`, `height`, `h`, `altitude`, `alt`, `POINT_Z` |
//! | class, optional | `class`, `classification` |
//!
//! A unit in brackets after a name is ignored: `Height (m)`. Comments begin with `#` or `//`. A
//! comment before the points may be the header if it has no more names than a line has fields
//! (words up to a colon do not count). Of several names for one axis, the first of the table
//! counts; a name that two columns have is an error, as are several heights if none of them is
//! `z`. Fields may be in double quotes.
//!
//! A decimal comma is accepted unless commas separate the fields; numbers with a comma and numbers
//! with a point in one file are an error, since one of the marks groups digits. A first line with a
//! single number is the count of points at the start of `.pts` files. The text may be UTF-8 or a
//! compatible encoding, with or without a byte order mark. Lines end with LF, CR LF or CR. A line
//! that is not a point leads to an error with its number: no line is dropped silently.
//!
//! Text has no end mark, so a file that was cut between two lines looks whole, unless its first
//! line is a count. If the last line has no line end, there is a warning: it may have been cut.

mod columns;
mod first_column;
mod first_lines;
mod lines;
mod separator;
pub mod table;
#[cfg(test)]
mod tests;
mod write;

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use self::columns::{ColumnLayout, Point};
use self::first_column::{FirstColumn, Guess};
use self::first_lines::Start;
use self::lines::{Line, Lines};
pub use self::separator::Axes;
pub use self::write::{TextWriter, create};
use crate::data::{PointBatch, PointInfo, PointSource};
use crate::error::{Error, Result, Wording};
use crate::io::bytes::decimal_mark::DecimalMark;
use crate::io::options::cut::OnDamage;
use crate::io::options::points::Options;

/// Points in a batch.
const BATCH: usize = 1 << 16;

/// A reader of points from text, made by [`open`].
pub struct TextReader {
    lines: Lines,
    layout: ColumnLayout,
    info: PointInfo,
    /// The first point, which was read to determine the columns and has not been returned yet.
    first: Option<Point>,
    /// Present while the first column may still be the number of the point.
    first_column: Option<FirstColumn>,
    mark: DecimalMark,
    /// What to do if there are fewer points than the first line states.
    cut: OnDamage,
    read: u64,
    is_done: bool,
    warnings: Vec<Wording>,
}

impl std::fmt::Debug for TextReader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TextReader")
            .field("info", &self.info)
            .field("read", &self.read)
            .finish_non_exhaustive()
    }
}

/// Opens a text file of points; `-` is the standard input. Unless the options name the columns, a
/// header or the first three columns are used.
///
/// # Errors
/// If the file cannot be read, or its first lines are neither a header nor a point.
pub fn open(path: impl AsRef<Path>, options: Options) -> Result<TextReader> {
    let path = path.as_ref();
    if path.as_os_str() == "-" {
        return from_stream(io::stdin(), "standard input", options);
    }
    let file = File::open(path).map_err(|error| Error::from(error).in_file(path))?;
    from_stream(file, path, options)
}

/// Reads points from a stream; messages call it `name`.
///
/// # Errors
/// As [`open`].
pub fn from_stream(
    stream: impl Read + Send + 'static,
    name: impl AsRef<Path>,
    options: Options,
) -> Result<TextReader> {
    let mut lines = Lines::new(stream, name.as_ref());
    let start = Start::read(&mut lines, options.columns, Axes::Space, &mut |_| Ok(()))
        .map_err(|error| lines.locate(error))?;
    let header = if start.header.is_some() {
        ", with header"
    } else {
        ""
    };
    let info = PointInfo {
        format: format!(
            "text, separated by {}{header}",
            start.layout.separator.name()
        ),
        count: start.count,
        columns: Some(start.layout.columns),
        has_classes: start.layout.columns.class.is_some(),
        ..PointInfo::default()
    };
    Ok(TextReader {
        lines,
        layout: start.layout,
        info,
        first: start.first,
        first_column: start.first_column,
        mark: start.mark,
        cut: options.cut,
        read: 0,
        is_done: false,
        warnings: Vec::new(),
    })
}

impl PointSource for TextReader {
    fn info(&self) -> &PointInfo {
        &self.info
    }

    fn read(&mut self, batch: &mut PointBatch) -> Result<()> {
        batch.clear();
        if let Some(first) = self.first.take() {
            first.push(batch);
        }
        while !self.is_done && batch.len() < BATCH {
            match self.next_point() {
                Ok(Some(point)) => point.push(batch),
                Ok(None) => {
                    self.is_done = true;
                    let total = self.read + batch.len() as u64;
                    let stated = self.info.count;
                    self.lines
                        .finish(stated, total, self.cut, &mut self.warnings)?;
                }
                Err(error) => {
                    self.is_done = true;
                    return Err(self.lines.locate(error));
                }
            }
        }
        // One batch is enough to distinguish numbers from coordinates.
        match self.first_column.take().map(FirstColumn::guess) {
            Some(Guess::Counted) => {
                self.is_done = true;
                batch.clear();
                return Err(first_column::refuse().in_file(&self.lines.name));
            }
            Some(Guess::Whole) => self.warnings.push(first_column::whole()),
            Some(Guess::Coordinates) | None => {}
        }
        self.read += batch.len() as u64;
        Ok(())
    }

    fn warnings(&self) -> &[Wording] {
        &self.warnings
    }
}

impl TextReader {
    fn next_point(&mut self) -> Result<Option<Point>> {
        while self.lines.next()? {
            if let Line::Data(line) = Line::new(&self.lines.line) {
                let separator = self.layout.separator;
                separator.add_marks(&mut self.mark, line, self.lines.number)?;
                self.first_column = self
                    .first_column
                    .take()
                    .and_then(|first_column| first_column.next(separator, line));
                return self.layout.point(line).map(Some);
            }
        }
        Ok(None)
    }
}
