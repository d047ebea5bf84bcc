//! ESRI ASCII grids (`.asc`): heights as text, row by row from the north.
//!
//! | key | meaning |
//! |---|---|
//! | `ncols`, `nrows` | columns, rows |
//! | `xllcorner`, `yllcorner` | the outer corner of the lower left cell |
//! | `xllcenter`, `yllcenter` | its center |
//! | `cellsize`, or `dx` and `dy` | the sides of a cell; the latter are GDAL's |
//! | `NODATA_value` | the value of cells without one; -9999 if it is not stated |
//!
//! The coordinate system is in a `.prj` next to the file.

use std::fs::File;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use super::cell_rows;
use super::geotiff::RasterSummary;
use super::prj::{self, Prj};
use crate::crs::Crs;
use crate::data::{BlockSource, Frame, Grid};
use crate::error::{Error, Result, Wording};
use crate::io::bytes::rows::{Row, Rows, shown};
use crate::io::bytes::watch::{bytes_of, unwatched};
use crate::io::options::cut::open_line;
use crate::io::{Destination, Watch};

/// The value of cells without one.
const NODATA: f64 = -9999.0;

/// Bytes within which the header ends.
const HEADER: u64 = 1 << 12;

/// An ASCII grid whose header was read.
#[derive(Debug)]
pub struct AsciiGrid {
    path: PathBuf,
    frame: Frame,
    crs: Option<Crs>,
    nodata: f64,
    /// The lines of the header.
    lines: usize,
    warnings: Vec<Wording>,
}

/// Opens an ASCII grid and reads its header, and the `.prj` next to it.
///
/// # Errors
/// If the file cannot be read, or its header lacks a key, has an unknown one or a value that is
/// impossible.
pub fn open(path: impl AsRef<Path>) -> Result<AsciiGrid> {
    let path = path.as_ref();
    let open = || {
        let mut head = Vec::new();
        File::open(path)?.take(HEADER).read_to_end(&mut head)?;
        let (frame, nodata, lines) = header(&head)?;
        let mut warnings = Vec::new();
        let crs = match prj::read_beside(path)? {
            Prj::Stated(crs) => crs,
            Prj::Unread(_, error) => {
                warnings.push(format!(".prj not used: {error}").into());
                None
            }
        };
        let path = path.to_path_buf();
        Ok(AsciiGrid {
            path,
            frame,
            crs,
            nodata,
            lines,
            warnings,
        })
    };
    open().map_err(|e: Error| e.in_input(path))
}

impl AsciiGrid {
    /// Returns the size and georeference.
    pub fn frame(&self) -> Frame {
        self.frame
    }

    /// Returns the coordinate system of the `.prj`, if it is understood.
    pub fn crs(&self) -> Option<&Crs> {
        self.crs.as_ref()
    }

    /// Returns the value of cells without one.
    pub fn nodata(&self) -> f64 {
        self.nodata
    }

    /// Returns the warnings of opening.
    pub fn warnings(&self) -> &[Wording] {
        &self.warnings
    }

    /// Reads all cells; the cells that were read are counted. Returns warnings of the text, too.
    ///
    /// # Errors
    /// If there are fewer or more values than cells, one is not a number, the memory does not
    /// suffice, or the file cannot be read; and that of the watch.
    ///
    /// # Complexity
    /// Linear; the text is in memory, too.
    pub fn read_grid_with(&self, watch: Watch) -> Result<(Grid, Vec<Wording>)> {
        let bytes = bytes_of(&self.path, &|_| watch(0))?;
        let values = self
            .values(&bytes, watch)
            .map_err(|e| e.in_input(&self.path))?;
        let grid = Grid {
            frame: self.frame,
            crs: self.crs.clone(),
            values,
        };
        Ok((grid, open_line(&bytes).into_iter().collect()))
    }

    fn values(&self, bytes: &[u8], watch: Watch) -> Result<Vec<f64>> {
        let Frame { width, height, .. } = self.frame;
        let start = after_lines(bytes, self.lines);
        let text = &bytes[start..];
        // Each value has a digit, and a blank behind it.
        let most = text.len().div_ceil(2);
        let cells = width.saturating_mul(height);
        if cells > most {
            return Err(Error::format(format!(
                "{width} x {height} cells need more text than the {} bytes behind the header",
                text.len()
            ))
            .at("header")
            .cure("get the whole file"));
        }
        let line_of = |at: usize| {
            let breaks = bytes[..start + at].iter().filter(|&&b| b == b'\n').count();
            format!("line {}", breaks + 1)
        };
        let mut values = Vec::with_capacity(cells);
        let mut at = 0;
        while let Some(blanks) = text[at..].iter().position(|b| !b.is_ascii_whitespace()) {
            at += blanks;
            let rest = &text[at..];
            let length = rest.iter().position(u8::is_ascii_whitespace);
            let word = &rest[..length.unwrap_or(rest.len())];
            if values.len() == cells {
                return Err(Error::format(format!(
                    "'{}' follows the last of {width} x {height} cells",
                    shown(word)
                ))
                .at(line_of(at))
                .cure("correct ncols and nrows"));
            }
            let value = std::str::from_utf8(word)
                .ok()
                .and_then(|word| word.parse::<f64>().ok())
                .filter(|value| !value.is_infinite())
                .ok_or_else(|| {
                    Error::format(format!("'{}' is not a height", shown(word))).at(line_of(at))
                })?;
            // Other programs write the least number of 32 bits with more or fewer digits.
            let is_nodata = value == self.nodata || value as f32 == self.nodata as f32;
            values.push(if is_nodata { f64::NAN } else { value });
            at += word.len();
            if values.len().is_multiple_of(width) {
                watch(width as u64)?;
            }
        }
        if values.len() < cells {
            return Err(Error::format(format!(
                "the file ends after {} of {width} x {height} cells",
                values.len()
            ))
            .at(line_of(text.len()))
            .cure("get the whole file"));
        }
        Ok(values)
    }
}

/// Returns the position behind a number of lines.
fn after_lines(bytes: &[u8], lines: usize) -> usize {
    let ends = bytes.iter().enumerate().filter(|(_, b)| **b == b'\n');
    match lines.checked_sub(1) {
        None => 0,
        Some(last) => ends.map(|(at, _)| at + 1).nth(last).unwrap_or(bytes.len()),
    }
}

/// A side of the lower left cell along an axis, as the header states it.
#[derive(Clone, Copy)]
enum Lower {
    Corner(f64),
    Center(f64),
}

/// Parses the header. Returns the frame, the nodata value and the lines of the header.
fn header(head: &[u8]) -> Result<(Frame, f64, usize)> {
    const PATTERN: &str = "KEY VALUE";
    let mut rows = Rows::new(head, &unwatched);
    let mut sides: [Option<usize>; 2] = [None; 2];
    let mut lower: [Option<Lower>; 2] = [None; 2];
    let mut cell: [Option<f64>; 2] = [None; 2];
    let mut nodata = NODATA;
    let mut lines = 0;
    while let Some(mut row) = rows.next(PATTERN) {
        let key = row.word().unwrap_or_default().to_ascii_lowercase();
        if !key.first().is_some_and(u8::is_ascii_alphabetic) || key == b"nan" {
            break;
        }
        row.refuse_commas()?;
        match &key[..] {
            b"ncols" => sides[0] = Some(row.within("number of columns")?),
            b"nrows" => sides[1] = Some(row.within("number of rows")?),
            b"xllcorner" => lower[0] = Some(Lower::Corner(row.finite("corner")?)),
            b"yllcorner" => lower[1] = Some(Lower::Corner(row.finite("corner")?)),
            b"xllcenter" => lower[0] = Some(Lower::Center(row.finite("center")?)),
            b"yllcenter" => lower[1] = Some(Lower::Center(row.finite("center")?)),
            b"cellsize" => cell = [Some(positive(&mut row)?); 2],
            b"dx" => cell[0] = Some(positive(&mut row)?),
            b"dy" => cell[1] = Some(positive(&mut row)?),
            b"nodata_value" => {
                let word = row.word().unwrap_or_default();
                let value = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
                nodata = value
                    .ok_or_else(|| row.wrong(format!("'{}' is not a nodata value", shown(word))))?;
            }
            _ => {
                return Err(row.wrong(format!("'{}' is not a key of an ASCII grid", shown(&key))));
            }
        }
        if row.has_more() {
            return Err(row.wrong(format!("more than one value for {}", shown(&key))));
        }
        lines = row.line;
    }
    let lacks = |key: &str| {
        Error::format(format!("the header does not state {key}"))
            .at("header")
            .cure("write ncols, nrows, xllcorner, yllcorner and cellsize, one on each line")
    };
    let [Some(width), Some(height)] = sides else {
        return Err(lacks("ncols and nrows"));
    };
    let [Some(dx), Some(dy)] = cell else {
        return Err(lacks("cellsize"));
    };
    let [Some(x), Some(y)] = lower else {
        return Err(lacks("xllcorner and yllcorner"));
    };
    let corner = |lower: Lower, side: f64| match lower {
        Lower::Corner(at) => at,
        Lower::Center(at) => at - side / 2.0,
    };
    let top = corner(y, dy) + height as f64 * dy;
    let frame = Frame {
        width,
        height,
        transform: [corner(x, dx), dx, 0.0, top, 0.0, -dy],
    };
    Ok((frame.checked().map_err(|e| e.at("header"))?, nodata, lines))
}

fn positive(row: &mut Row) -> Result<f64> {
    match row.finite("size of a cell")? {
        size if size > 0.0 => Ok(size),
        size => Err(row.wrong(format!("a cell of {size}, expected a positive size"))),
    }
}

/// Writes heights, with the fewest digits that read back as the same 32-bit floats, and a `.prj` if
/// the coordinate system is known.
///
/// # Errors
/// If the raster is not north up, the source fails, or a file cannot be written.
pub(crate) fn write(target: Destination, source: &dyn BlockSource) -> Result<RasterSummary> {
    let frame = source.frame();
    if !frame.is_north_up() {
        return Err(
            Error::unsupported("an ASCII grid is north up, and this raster is not")
                .in_file(target.path())
                .cure("write .tif"),
        );
    }
    let mut output = target.create()?;
    let [left, dx, _, top, _, dy] = frame.transform;
    let bottom = bottom(top, -dy, frame.height);
    let cell = match dx == -dy {
        true => format!("cellsize {dx}"),
        false => format!("dx {dx}\ndy {}", -dy),
    };
    writeln!(
        output,
        "ncols {}\nnrows {}\nxllcorner {left}\nyllcorner {bottom}\n{cell}\nNODATA_value {NODATA}",
        frame.width, frame.height
    )?;
    let summary = cell_rows::write(&mut output, source, |row, cells| {
        require_other_than_nodata(row, cells)?;
        Ok(line(cells).into_bytes())
    });
    let summary = summary.map_err(|e| e.in_file(target.path()))?;
    let beside = target.path().with_extension("prj");
    let text = source.crs().map(Crs::to_prj).unwrap_or_default();
    if text.is_empty() {
        // That of a previous grid would be used for this one.
        target.put_all([], output, [beside])?;
        return Ok(summary);
    }
    let mut prj = target.create_beside(&beside)?;
    prj.write_all(text.as_bytes())?;
    target.put_all([prj], output, [])?;
    Ok(summary)
}

/// Returns an error for a height that stands for none in the file: the header comes before all
/// heights, and cannot state another value when one is met.
fn require_other_than_nodata(row: usize, cells: &[f32]) -> Result<()> {
    let found = cells.iter().position(|&cell| f64::from(cell) == NODATA);
    match found {
        None => Ok(()),
        Some(column) => Err(Error::unsupported(format!(
            "the height {NODATA} stands for a cell without data in an ASCII grid"
        ))
        .at(format!("row {}, column {}", row + 1, column + 1))
        .cure("write .tif, which keeps it")),
    }
}

/// Returns the lower edge from which a reader finds the upper one again, if there is such a number.
fn bottom(top: f64, side: f64, rows: usize) -> f64 {
    let bottom = top - rows as f64 * side;
    let near = [bottom, bottom.next_up(), bottom.next_down()];
    let is_exact = |at: &f64| at + rows as f64 * side == top;
    near.into_iter().find(is_exact).unwrap_or(bottom)
}

/// Returns a row of cells as a line of text.
fn line(values: &[f32]) -> String {
    let mut text = String::with_capacity(values.len() * 8);
    for (column, value) in values.iter().enumerate() {
        if column > 0 {
            text.push(' ');
        }
        match value.is_nan() {
            true => text += &NODATA.to_string(),
            false => text += &value.to_string(),
        }
    }
    text.push('\n');
    text
}
