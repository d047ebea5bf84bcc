//! Lists of numbered items, and numbers that refer to them.

use std::path::Path;

use crate::error::{Result, Wording, wording};
use crate::io::bytes::rows::{Row, Rows};
use crate::io::bytes::watch::{Watch, bytes_of};
use crate::io::options::cut::open_line;

pub(crate) fn extension(path: &Path) -> String {
    path.extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase()
}

/// Runs `read` on the lines of a file and returns its result; errors name the file. Adds a warning
/// if the last line has no end.
pub(crate) fn read_rows<T>(
    path: &Path,
    watch: Watch,
    warnings: &mut Vec<Wording>,
    read: impl FnOnce(Rows) -> Result<T>,
) -> Result<T> {
    let bytes = bytes_of(path, watch)?;
    warnings
        .extend(open_line(&bytes).map(|text| wording![format!(".{}: ", extension(path)), text]));
    read(Rows::new(&bytes, watch)).map_err(|e| e.in_file(path))
}

/// Returns the line that begins a list, and its count.
pub(crate) fn counted<'a>(
    rows: &mut Rows<'a>,
    items: &str,
    pattern: &'static str,
) -> Result<(Row<'a>, usize)> {
    let what = format!("number of {items}");
    let mut header = rows.expect(|| format!("the {what}"), pattern)?;
    let count = header.within(&what)?;
    Ok((header, count))
}

/// Reads the items of a list: calls `read` with each line and the number at its start.
pub(crate) fn listed<T>(
    rows: &mut Rows,
    count: usize,
    item: &str,
    pattern: &'static str,
    mut read: impl FnMut(&mut Row, i64) -> Result<T>,
) -> Result<Vec<T>> {
    let what = format!("{item} number");
    let mut items = Vec::with_capacity(room(count, rows));
    for i in 0..count {
        let mut row = rows.expect(|| format!("{item} {} of {count}", i + 1), pattern)?;
        let number = row.whole(&what)?;
        items.push(read(&mut row, number)?);
    }
    Ok(items)
}

/// Returns the capacity for a stated count, limited by the bytes that are left: an item takes at
/// least six.
pub(super) fn room(count: usize, rows: &Rows) -> usize {
    count.min(rows.bytes_left() / 6 + 1)
}

pub(super) fn site<const D: usize>(row: &mut Row) -> Result<[f64; D]> {
    let mut site = [0.0; D];
    for (coordinate, what) in site
        .iter_mut()
        .zip(["x coordinate", "y coordinate", "z coordinate"])
    {
        *coordinate = row.finite(what)?;
    }
    Ok(site)
}

/// Reads the boundary marker; 0 if the list has none.
pub(super) fn marker(row: &mut Row, marker_count: usize) -> Result<i32> {
    if marker_count > 0 {
        row.within("boundary marker")
    } else {
        Ok(0)
    }
}

/// The numbering of vertices.
#[derive(Clone, Copy)]
pub(crate) struct Numbering {
    pub(crate) first: u32,
    pub(crate) count: usize,
}

impl Numbering {
    /// Reads the number of a vertex and returns its index; messages call it `what`.
    pub(crate) fn vertex(self, row: &mut Row, what: &str) -> Result<u32> {
        let number = row.whole(what)?;
        self.index(number).ok_or_else(|| {
            let there = match self.count {
                0 => "there are no vertices".to_owned(),
                _ => format!(
                    "the vertices are numbered {} to {}",
                    self.first,
                    self.last()
                ),
            };
            row.wrong(format!("the {what} is vertex {number}, but {there}"))
        })
    }

    /// Reads the number of a neighbor and returns its index, or `None` for -1; messages call it
    /// `what`.
    pub(crate) fn neighbor(self, row: &mut Row, what: &str) -> Result<Option<u32>> {
        let number = row.whole("neighbor")?;
        if number == -1 {
            return Ok(None);
        }
        self.index(number).map(Some).ok_or_else(|| {
            let [first, last] = [i64::from(self.first), self.last()];
            row.wrong(format!(
                "the neighbor is {what} {number}, but they are numbered {first} to {last}"
            ))
        })
    }

    /// Returns the index of what has this number, if there is one.
    fn index(self, number: i64) -> Option<u32> {
        let index = u32::try_from(number.checked_sub(i64::from(self.first))?).ok()?;
        ((index as usize) < self.count).then_some(index)
    }

    fn last(self) -> i64 {
        self.count as i64 + i64::from(self.first) - 1
    }
}

/// Lines with more values than announced: the first of them, and their number.
#[derive(Default)]
pub(super) struct Surplus {
    first_line: Option<usize>,
    lines: usize,
}

impl Surplus {
    pub(super) fn look(&mut self, row: &Row) {
        if row.has_more() {
            self.first_line.get_or_insert(row.line);
            self.lines += 1;
        }
    }

    pub(super) fn warning(&self) -> Option<Wording> {
        let (first, lines) = (self.first_line?, self.lines);
        let text = format!(
            "line {first}: there are more values than announced; they are not read ({lines} such lines)"
        );
        Some(text.into())
    }
}
