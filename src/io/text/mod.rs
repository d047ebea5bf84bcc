//! Points as text: XYZ, CSV and similar formats.
//!
//! Each line contains one point. Fields are separated by semicolons, tabs, commas or blanks; the
//! first point determines by which of them. The columns are those of [`Columns`] if given, else
//! those that a header line names, else the first three are x, y and z.
//!
//! If neither names the columns, the first one may be the number of the point. If it counts up by
//! one from line to line and three numbers follow, reading fails. If it only contains integers, and
//! the next two columns do not, there is a warning.
//!
//! Header names are matched in any case and order:
//!
//! | column | names |
//! |---|---|
//! | x | `x`, `easting`, `east`, `e`, `lon`, `long`, `longitude` |
//! | y | `y`, `northing`, `north`, `n`, `lat`, `latitude` |
//! | z | `z`, `elevation`, `elev`, `height`, `h`, `altitude`, `alt` |
//! | class, optional | `class`, `classification` |
//!
//! A unit in brackets after a name is ignored: `Height (m)`. Comments begin with `#` or `//`. A
//! comment before the points may be the header if it has no more names than a line has fields
//! (words up to a colon do not count). Fields may be in double quotes. A decimal comma is accepted
//! unless commas separate the fields. A first line with a single number is the count of points at
//! the start of `.pts` files. The text may be UTF-8 or a compatible encoding, with or without a
//! byte order mark and with any line ends. A line that is not a point leads to an error with its
//! number: no line is dropped silently.

mod columns;
mod numbering;
mod separator;
mod write;

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use self::columns::{Layout, Point};
use self::numbering::{Guess, Numbering};
use self::separator::Separator;
pub use self::write::{TextWriter, create};
use crate::data::{Columns, PointBatch, PointInfo, PointSource};
use crate::error::{Error, Result};

/// Points in a batch.
const BATCH: usize = 1 << 16;

/// Limit for the bytes of a line; text for people has shorter lines, and a binary file may have no
/// line ends.
const MAX_LINE_BYTES: u64 = 1 << 16;

/// A reader of points from text, made by [`open`].
pub struct TextReader {
    lines: Lines,
    layout: Layout,
    info: PointInfo,
    /// The first point, which was read to determine the columns and has not been returned yet.
    first: Option<Point>,
    /// Present while the first column may still be the number of the point.
    numbering: Option<Numbering>,
    read: u64,
    is_done: bool,
    warnings: Vec<String>,
}

impl std::fmt::Debug for TextReader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TextReader").field("info", &self.info).field("read", &self.read).finish_non_exhaustive()
    }
}

/// Opens a text file of points; `-` is the standard input. Without `columns`, a header or the first
/// three columns are used.
///
/// # Errors
/// If the file cannot be read, or its first lines are neither a header nor a point.
pub fn open(path: impl AsRef<Path>, columns: Option<Columns>) -> Result<TextReader> {
    let path = path.as_ref();
    if path.as_os_str() == "-" {
        return from_stream(io::stdin(), "standard input", columns);
    }
    let file = File::open(path).map_err(|error| Error::from(error).in_file(path))?;
    from_stream(file, path, columns)
}

/// Reads points from a stream; messages call it `name`.
///
/// # Errors
/// As [`open`].
pub fn from_stream(
    stream: impl Read + Send + 'static,
    name: impl AsRef<Path>,
    columns: Option<Columns>,
) -> Result<TextReader> {
    let mut lines = Lines {
        source: BufReader::with_capacity(1 << 17, Box::new(stream)),
        name: name.as_ref().to_path_buf(),
        line: Vec::new(),
        number: 0,
    };
    let start = start(&mut lines, columns).map_err(|error| lines.locate(error))?;
    let header = if start.has_header { ", with header" } else { "" };
    let info = PointInfo {
        format: format!("text, separated by {}{header}", start.layout.separator.name()),
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
        numbering: start.numbering,
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
                Ok(None) => self.finish(self.read + batch.len() as u64),
                Err(error) => {
                    self.is_done = true;
                    return Err(self.lines.locate(error));
                }
            }
        }
        // One batch is enough to distinguish numbers from coordinates.
        match self.numbering.take().map(Numbering::guess) {
            Some(Guess::Counted) => {
                self.is_done = true;
                batch.clear();
                return Err(numbering::refuse().in_file(&self.lines.name));
            }
            Some(Guess::Whole) => self.warnings.push(numbering::WHOLE.to_owned()),
            Some(Guess::Coordinates) | None => {}
        }
        self.read += batch.len() as u64;
        Ok(())
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

impl TextReader {
    fn next_point(&mut self) -> Result<Option<Point>> {
        while self.lines.next()? {
            if let Line::Data(line) = Line::new(&self.lines.line) {
                let separator = self.layout.separator;
                self.numbering = self.numbering.take().and_then(|numbering| numbering.next(separator, line));
                return self.layout.point(line).map(Some);
            }
        }
        Ok(None)
    }

    fn finish(&mut self, total: u64) {
        self.is_done = true;
        if let Some(stated) = self.info.count.filter(|&stated| stated != total) {
            self.warnings.push(format!("the first line states {stated} points, but there are {total}"));
        }
    }
}

/// The result of reading the first lines.
struct Start {
    layout: Layout,
    has_header: bool,
    count: Option<u64>,
    first: Option<Point>,
    numbering: Option<Numbering>,
}

fn start(lines: &mut Lines, columns: Option<Columns>) -> Result<Start> {
    // The layout that a header or the caller gives.
    let asked = columns.map(|columns| Layout { columns, ..Layout::FIRST });
    let mut named: Option<Layout> = None;
    // The layout that a comment names, and its number of names.
    let mut commented: Option<(Layout, usize)> = None;
    let mut is_header_passed = false;
    let mut count = None;
    while lines.next()? {
        let line = match Line::new(&lines.line) {
            Line::Blank => continue,
            Line::Comment(text) => {
                let names = text.rsplit(|&byte| byte == b':').next().unwrap_or(text);
                let layout = Separator::guess(names).and_then(|separator| Layout::named(names, separator).ok());
                commented = layout.map(|layout| (layout, layout.separator.fields(names).count())).or(commented);
                continue;
            }
            Line::Data(line) => line,
        };
        if count.is_none() && is_count(line) {
            count = std::str::from_utf8(line).ok().and_then(|text| text.trim().parse().ok());
            continue;
        }
        let separator = Separator::guess(line).ok_or_else(|| not_a_point(line))?;
        if separator.fields(line).all(|field| separator.number(field).is_none()) {
            // The points may have another separator than the names.
            named = match asked {
                None => Some(Layout::named(line, separator)?),
                Some(_) if is_header_passed => return Err(not_a_point(line)),
                Some(_) => None,
            };
            is_header_passed = true;
            continue;
        }
        // A comment with more words than a line has fields is prose.
        let commented = commented.filter(|(_, names)| *names <= separator.fields(line).count());
        let named = named.or(commented.map(|(layout, _)| layout));
        let known = asked.or(named);
        let layout = Layout { separator, ..known.unwrap_or(Layout::FIRST) };
        let first = layout.point(line).map_err(|error| match known {
            Some(_) => error,
            None => error.cure(
                "correct the line, name the columns with --columns, or put a header before it that names them: x y z",
            ),
        })?;
        let numbering = if known.is_none() { Numbering::start(separator, line) } else { None };
        let has_header = is_header_passed || named.is_some();
        return Ok(Start { layout, has_header, count, first: Some(first), numbering });
    }
    let named = named.or(commented.map(|(layout, _)| layout));
    let has_header = is_header_passed || named.is_some();
    let layout = asked.or(named).unwrap_or(Layout::FIRST);
    Ok(Start { layout, has_header, count, first: None, numbering: None })
}

/// Returns true if the line is a single integer.
fn is_count(line: &[u8]) -> bool {
    let line = line.trim_ascii();
    !line.is_empty() && line.len() <= 18 && line.iter().all(u8::is_ascii_digit)
}

fn not_a_point(line: &[u8]) -> Error {
    let error = Error::format(format!("{} is neither a point nor a header", quote(line)));
    if line.trim_ascii_start().to_ascii_lowercase().starts_with(b"ncols") {
        return error.cure("an ESRI ASCII grid is a raster, not a list of points");
    }
    error.cure("expected x, y and z separated by semicolons, tabs, commas or blanks, or a header line that names them")
}

/// The lines of a file, read one by one.
struct Lines {
    source: BufReader<Box<dyn Read + Send>>,
    name: PathBuf,
    /// The current line, without its end.
    line: Vec<u8>,
    /// The number of the current line, from 1.
    number: u64,
}

impl Lines {
    /// Reads the next line; returns false at the end of the file.
    fn next(&mut self) -> Result<bool> {
        self.line.clear();
        self.number += 1;
        let length = (&mut self.source).take(MAX_LINE_BYTES).read_until(b'\n', &mut self.line)?;
        if length as u64 == MAX_LINE_BYTES && !self.line.ends_with(b"\n") {
            return Err(Error::format(format!(
                "a line of more than {MAX_LINE_BYTES} bytes, which begins {}",
                quote(&self.line)
            ))
            .cure("this may not be a text file"));
        }
        if self.number == 1 {
            if self.line.starts_with(b"\xff\xfe") || self.line.starts_with(b"\xfe\xff") {
                return Err(Error::unsupported("text in UTF-16").cure("save it as UTF-8"));
            }
            if self.line.starts_with(b"\xef\xbb\xbf") {
                self.line.drain(..3);
            }
        }
        while let Some(b'\n' | b'\r') = self.line.last() {
            self.line.pop();
        }
        Ok(length > 0)
    }

    /// Adds the file and the line to an error.
    fn locate(&self, error: Error) -> Error {
        error.at(format!("line {}", self.number)).in_file(&self.name)
    }
}

enum Line<'a> {
    Blank,
    Comment(&'a [u8]),
    Data(&'a [u8]),
}

impl<'a> Line<'a> {
    fn new(line: &'a [u8]) -> Self {
        let text = line.trim_ascii();
        match text {
            [] => Line::Blank,
            [b'#', rest @ ..] | [b'/', b'/', rest @ ..] => Line::Comment(rest),
            // Not trimmed: a line may begin with an empty field.
            _ => Line::Data(line),
        }
    }
}

/// Returns text for a message: on one line, and shortened.
fn quote(text: &[u8]) -> String {
    const MAX_SHOWN: usize = 60;
    let text = text.trim_ascii();
    let shown = &text[..text.len().min(MAX_SHOWN)];
    let dots = if text.len() > MAX_SHOWN { "..." } else { "" };
    format!("\"{}{dots}\"", String::from_utf8_lossy(shown).escape_debug())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<(TextReader, PointBatch)> {
        let mut reader = from_stream(io::Cursor::new(text.as_bytes().to_vec()), "points.txt", None)?;
        let (mut all, mut batch) = (PointBatch::default(), PointBatch::default());
        loop {
            reader.read(&mut batch)?;
            if batch.is_empty() {
                return Ok((reader, all));
            }
            all.x.append(&mut batch.x);
            all.y.append(&mut batch.y);
            all.z.append(&mut batch.z);
            all.class.append(&mut batch.class);
        }
    }

    fn points(text: &str) -> Vec<[f64; 3]> {
        let (_, all) = read(text).unwrap_or_else(|error| panic!("{text:?}: {error}"));
        (0..all.len()).map(|i| [all.x[i], all.y[i], all.z[i]]).collect()
    }

    const TWO: [[f64; 3]; 2] = [[1.5, 2.25, -3.0], [4.0, 5.0, 6.5]];

    #[test]
    fn a_comment_of_more_words_than_fields_is_prose() {
        assert_eq!(points("# height is z of x and y\n1 2 3\n"), [[1.0, 2.0, 3.0]]);
        assert_eq!(points("# columns: y x z r\n1 2 3 0\n"), [[2.0, 1.0, 3.0]]);
        assert_eq!(points("# exported by Foo: id x y z\n7 1 2 3\n"), [[1.0, 2.0, 3.0]]);
        assert_eq!(points("# y x z\n1 2 3 0\n"), [[2.0, 1.0, 3.0]]);
    }

    #[test]
    fn numbers_with_gaps_are_a_warning() {
        let warned = |text: &str| !read(text).unwrap().0.warnings().is_empty();
        assert!(warned("101,5000.12,2000.5,33.1\n102,5001.5,2001,33.2\n104,5002,2002,33\n"));
        assert!(warned("10 5000.12 2000.5 33.1\n9 5001.5 2001 33.2\n"));
        assert!(!warned("101 5000 2000 33.1\n104 5001 2001 33.2\n"), "a grid");
        assert!(!warned("101.5 5000.12 2000.5 33.1\n104 5001.5 2001 33.2\n"));
        assert!(!warned("101 5000.12 33.1\n104 5001.5 33.2\n"), "three columns");
    }

    #[test]
    fn every_spelling_of_two_points() {
        for text in [
            "1.5 2.25 -3\n4 5 6.5\n",
            "1.5 2.25 -3\n4 5 6.5",
            "  1.5   2.25\t-3 7 8 \r\n\r\n 4 5 6.5\r\n",
            "\u{feff}1.5,2.25,-3\n4,5,6.5\n",
            "1.5, 2.25, -3, tree\n4, 5, 6.5, \"house, red\"\n",
            "1,5;2,25;-3\n4;5;6,5\n",
            "1,5\t2,25\t-3\n4\t5\t6,5\n",
            "1,5 2,25 -3,0\n4 5 6,5\n",
            "\"1.5\";\"2.25\";\"-3\"\n\"4\";\"5\";\"6.5\"\n",
            "# made by hand\n1.5 2.25 -3e0\n// a comment\n+4. 5 0.65e1\n",
            "x,y,z\n1.5,2.25,-3\n4,5,6.5\n",
            "id;Northing;Easting;Height [m]\nA;2,25;1,5;-3\nB;5;4;6,5\n",
            "LAT LON ELEVATION\n2.25 1.5 -3\n5 4 6.5\n",
            "//X Y Z R G B\n1.5 2.25 -3 0 0 0\n4 5 6.5 0 0 0\n",
            "# y x z\n# made by hand\n2.25,1.5,-3\n5,4,6.5\n",
            "x y z\n1.5,2.25,-3\n4,5,6.5\n",
            "2\n1.5 2.25 -3 100\n4 5 6.5 100\n",
            "z,name,\"x\",\"y\"\n-3,\"a,b\",1.5,2.25\n6.5,c,4,5\n",
            ",x,y,z\n,1.5,2.25,-3\n,4,5,6.5\n",
        ] {
            assert_eq!(points(text), TWO, "{text:?}");
        }
    }

    #[test]
    fn what_the_file_says_of_itself() {
        let (reader, all) = read("E,N,H,Classification\n1,2,3,2\n1,2,3,9\n").unwrap();
        assert_eq!(all.class, [2, 9]);
        assert!(reader.info().has_classes);
        assert_eq!(reader.info().format, "text, separated by commas, with header");
        let (reader, all) = read("3\n1 2 3\n4 5 6\n").unwrap();
        assert!(all.class.is_empty() && !reader.info().has_classes);
        assert_eq!(reader.info().count, Some(3));
        assert_eq!(reader.warnings(), ["the first line states 3 points, but there are 2"]);
        for empty in ["", "\n\n", "# nothing\n", "x y z\n"] {
            assert!(points(empty).is_empty());
        }
    }

    #[test]
    fn a_bad_line_is_named() {
        for (text, message) in [
            ("1 2 3\n4 5\n", "line 2: 2 fields separated by blanks, expected at least 3: \"4 5\""),
            ("1,2,3\n4,5,\n", "line 2: z is \"\", expected a finite number: \"4,5,\""),
            ("1;2;3\n\n4;x5;6\n", "line 3: y is \"x5\", expected a finite number: \"4;x5;6\""),
            ("1 2 3\n1 2 nan\n", "line 2: z is \"nan\", expected a finite number: \"1 2 nan\""),
            ("1 2 3\n1 inf 3\n", "line 2: y is \"inf\", expected a finite number: \"1 inf 3\""),
            ("P1 1 2 3\n", "line 1: x is \"P1\", expected a finite number: \"P1 1 2 3\""),
            ("east,north\n1,2\n", "line 1: \"east,north\" is neither a point nor a header"),
            ("a,b,c\n1,2,3\n", "line 1: no column for x in the header \"a,b,c\""),
            ("ncols 5\nnrows 4\n", "line 1: \"ncols 5\" is neither a point nor a header"),
            (
                "x,y,z,class\n1,2,3,2.5\n",
                "line 2: class is \"2.5\", expected a whole number from 0 to 255: \"1,2,3,2.5\"",
            ),
            ("\u{fffe}1 2 3", "line 1: x is"),
        ] {
            let error = read(text).map(|(_, all)| all.len()).expect_err(text);
            assert!(error.to_string().starts_with(&format!("points.txt: {message}")), "{error}");
            assert!(error.cure_text().is_some(), "{error}");
        }
    }

    #[test]
    fn points_before_a_bad_line_are_handed_out() {
        let mut text = "1 2 3\n".repeat(BATCH + 10);
        text.push_str("end\n");
        let mut reader = from_stream(io::Cursor::new(text.into_bytes()), "points.txt", None).unwrap();
        let mut batch = PointBatch::default();
        reader.read(&mut batch).unwrap();
        assert_eq!(batch.len(), BATCH);
        let error = reader.read(&mut batch).unwrap_err();
        assert!(error.to_string().contains(&format!("line {}", BATCH + 11)), "{error}");
        reader.read(&mut batch).unwrap();
        assert!(batch.is_empty());
    }

    #[test]
    fn a_file_without_lines_is_refused_early() {
        let error = from_stream(io::repeat(b'1'), "endless", None).map(|_| ()).unwrap_err();
        assert!(error.to_string().contains("a line of more than 65536 bytes"), "{error}");
        let error = from_stream(io::Cursor::new(b"\xff\xfe1\0 \0".to_vec()), "wide", None).map(|_| ()).unwrap_err();
        assert!(error.to_string().contains("UTF-16"), "{error}");
    }
}
