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
//! (words up to a colon do not count). Of several names for one axis, the first of the table
//! counts; a name that two columns have is an error. Fields may be in double quotes.
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
mod separator;
mod write;

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use self::columns::{Layout, NameFlaw, Point, quote};
use self::first_column::{FirstColumn, Guess};
use self::separator::Separator;
pub use self::write::{TextWriter, create};
use crate::data::{Columns, PointBatch, PointInfo, PointSource};
use crate::error::{Error, Result, Setting, Wording, wording};
use crate::io::bytes::decimal_mark::DecimalMark;
use crate::io::fronts::points::Options;
use crate::io::options::cut::{Cut, OPEN_LINE};

/// Points in a batch.
const BATCH: usize = 1 << 16;

/// Limit for the bytes of a line; text for people has shorter lines, and a binary file may have no
/// line ends.
const MAX_LINE_BYTES: usize = 1 << 16;

/// A reader of points from text, made by [`open`].
pub struct TextReader {
    lines: Lines,
    layout: Layout,
    info: PointInfo,
    /// The first point, which was read to determine the columns and has not been returned yet.
    first: Option<Point>,
    /// Present while the first column may still be the number of the point.
    first_column: Option<FirstColumn>,
    mark: DecimalMark,
    /// What to do if there are fewer points than the first line states.
    cut: Cut,
    read: u64,
    is_done: bool,
    warnings: Vec<Wording>,
}

impl std::fmt::Debug for TextReader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TextReader").field("info", &self.info).field("read", &self.read).finish_non_exhaustive()
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
pub fn from_stream(stream: impl Read + Send + 'static, name: impl AsRef<Path>, options: Options) -> Result<TextReader> {
    let mut lines = Lines {
        source: BufReader::with_capacity(1 << 17, Box::new(stream)),
        name: name.as_ref().to_path_buf(),
        line: Vec::new(),
        number: 0,
        is_after_return: false,
        is_open: false,
    };
    let start = start(&mut lines, options.columns).map_err(|error| lines.locate(error))?;
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
                    self.finish(self.read + batch.len() as u64)?;
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
                add_marks(&mut self.mark, separator, line, self.lines.number)?;
                self.first_column =
                    self.first_column.take().and_then(|first_column| first_column.next(separator, line));
                return self.layout.point(line).map(Some);
            }
        }
        Ok(None)
    }

    /// Reports what the end of the file shows.
    fn finish(&mut self, total: u64) -> Result<()> {
        if self.lines.is_open {
            self.warnings.push(OPEN_LINE.into());
        }
        let Some(stated) = self.info.count.filter(|&stated| stated != total) else { return Ok(()) };
        let text = format!("the first line states {stated} points, but there are {total}");
        // More points than stated are not a file that was cut.
        let cut = if total < stated { self.cut } else { Cut::Accept };
        cut.refuse_or_warn(text, "the end", &mut self.warnings).map_err(|e| e.in_file(&self.lines.name))
    }
}

/// The result of reading the first lines.
struct Start {
    layout: Layout,
    has_header: bool,
    count: Option<u64>,
    first: Option<Point>,
    first_column: Option<FirstColumn>,
    mark: DecimalMark,
}

fn start(lines: &mut Lines, columns: Option<Columns>) -> Result<Start> {
    // The layout that a header or the caller gives.
    let asked = columns.map(|columns| Layout { columns, ..Layout::FIRST });
    let mut named: Option<Layout> = None;
    // The layout that a comment names, and its number of names.
    let mut commented: Option<(std::result::Result<Layout, NameFlaw>, usize)> = None;
    let mut is_header_passed = false;
    let mut count = None;
    let mut mark = DecimalMark::default();
    while lines.next()? {
        let line = match Line::new(&lines.line) {
            Line::Blank => continue,
            Line::Comment(text) => {
                let names = text.rsplit(|&byte| byte == b':').next().unwrap_or(text);
                if let Some(separator) = Separator::guess(names)
                    && let layout @ (Ok(_) | Err(NameFlaw::Repeated(_))) = Layout::named(names, separator)
                {
                    commented = Some((layout, separator.fields(names).count()));
                }
                continue;
            }
            Line::Data(line) => line,
        };
        if count.is_none() && is_count(line) {
            count = std::str::from_utf8(line).ok().and_then(|text| text.trim().parse().ok());
            continue;
        }
        let separator = Separator::guess(line).ok_or_else(|| not_a_point(line))?;
        if separator.has_two_uses(line) {
            return Err(Error::format(format!("{}: commas separate numbers and stand before decimals", quote(line)))
                .cure("separate the numbers by semicolons, or write decimal points"));
        }
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
        let has_header = is_header_passed || named.is_some() || commented.is_some();
        let named = match commented {
            Some((layout, _)) if named.is_none() && asked.is_none() => Some(layout?),
            _ => named,
        };
        add_marks(&mut mark, separator, line, lines.number)?;
        let known = asked.or(named);
        let layout = Layout { separator, ..known.unwrap_or(Layout::FIRST) };
        let first = layout.point(line).map_err(|error| match known {
            Some(_) => error,
            None => error.cure(wording![
                "correct the line, name the columns with ",
                Setting::Columns,
                ", or put a header before it that names them: x y z"
            ]),
        })?;
        let first_column = if known.is_none() { FirstColumn::start(separator, line) } else { None };
        return Ok(Start { layout, has_header, count, first: Some(first), first_column, mark });
    }
    let named = named.or(commented.and_then(|(layout, _)| layout.ok()));
    let has_header = is_header_passed || named.is_some();
    let layout = asked.or(named).unwrap_or(Layout::FIRST);
    Ok(Start { layout, has_header, count, first: None, first_column: None, mark })
}

/// Adds the decimal marks of the numbers in a line.
fn add_marks(mark: &mut DecimalMark, separator: Separator, line: &[u8], number: u64) -> Result<()> {
    // A comma that separates is never before decimals.
    if separator == Separator::Comma || !mark.concerns(line) {
        return Ok(());
    }
    let mut numbers = separator.fields(line).filter(|field| separator.number(field).is_some());
    numbers.try_for_each(|text| mark.add(text, || format!("line {number}")))
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
    /// True after a carriage return, which a line feed may follow.
    is_after_return: bool,
    /// True if the last line has a point, but no end.
    is_open: bool,
}

impl Lines {
    /// Reads the next line; returns false at the end of the file.
    fn next(&mut self) -> Result<bool> {
        self.line.clear();
        self.number += 1;
        let mut is_ended = false;
        while !is_ended {
            let bytes = match self.source.fill_buf() {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                bytes => bytes?,
            };
            if std::mem::take(&mut self.is_after_return) && bytes.first() == Some(&b'\n') {
                self.source.consume(1);
                continue;
            }
            if bytes.is_empty() {
                break;
            }
            let end = bytes.iter().position(|&byte| byte == b'\n' || byte == b'\r');
            self.line.extend_from_slice(&bytes[..end.unwrap_or(bytes.len())]);
            is_ended = end.is_some();
            self.is_after_return = end.is_some_and(|end| bytes[end] == b'\r');
            let read = end.map_or(bytes.len(), |end| end + 1);
            self.source.consume(read);
            if self.line.len() > MAX_LINE_BYTES {
                return Err(Error::format(format!(
                    "a line of more than {MAX_LINE_BYTES} bytes, which begins {}",
                    quote(&self.line)
                ))
                .cure("this may not be a text file"));
            }
        }
        let is_there = is_ended || !self.line.is_empty();
        if self.number == 1 {
            if self.line.starts_with(b"\xff\xfe") || self.line.starts_with(b"\xfe\xff") {
                return Err(Error::unsupported("text in UTF-16").cure("save it as UTF-8"));
            }
            if self.line.starts_with(b"\xef\xbb\xbf") {
                self.line.drain(..3);
            }
        }
        self.is_open |= !is_ended && matches!(Line::new(&self.line), Line::Data(_));
        Ok(is_there)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<(TextReader, PointBatch)> {
        let mut reader = from_stream(io::Cursor::new(text.as_bytes().to_vec()), "points.txt", Options::default())?;
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
        let (reader, all) = read("2\n1 2 3\n4 5 6\n").unwrap();
        assert!(all.class.is_empty() && !reader.info().has_classes);
        assert_eq!(reader.info().count, Some(2));
        assert!(reader.warnings().is_empty());
        for empty in ["", "\n\n", "# nothing\n", "x y z\n"] {
            assert!(points(empty).is_empty());
        }
    }

    #[test]
    fn any_line_end_ends_a_line() {
        let lines = ["x y z", "1.5 2.25 -3", "", "4 5 6.5"];
        for end in ["\n", "\r\n", "\r"] {
            assert_eq!(points(&format!("{}{end}", lines.join(end))), TWO, "{end:?}");
            let error = read(&["1 2 3", "4 5 6", "7 8"].join(end)).map(|_| ()).unwrap_err();
            assert!(error.to_string().starts_with("points.txt: line 3: 2 fields"), "{error}");
        }
        assert_eq!(points("1.5 2.25 -3 a\r4 5 6.5 b\n"), TWO);
        // A pair that two parts of the file share.
        for length in [(1 << 17) - 12, (1 << 17) - 11, (1 << 17) - 10] {
            let comments = format!("#{}\n", "-".repeat(62)).repeat(length / 64);
            let comment = format!("#{}\n", "-".repeat(length - comments.len() - 2));
            let text = format!("{comments}{comment}1.5 2.25 -3\r\n4 5 6.5\r\nx");
            let error = read(&text).map(|_| ()).unwrap_err().to_string();
            assert!(error.contains(&format!("line {}:", length / 64 + 4)), "{error}");
        }
    }

    #[test]
    fn a_last_line_without_an_end_is_a_warning() {
        for (text, count) in
            [("1 2 3\n4 5 6\n", 0), ("1 2 3\n4 5 6\r", 0), ("1 2 3\n4 5 6", 1), ("1 2 3\n4 5 6\n# e", 0)]
        {
            assert_eq!(read(text).unwrap().0.warnings().len(), count, "{text:?}");
        }
    }

    #[test]
    fn numbers_with_a_comma_and_numbers_with_a_point_are_refused() {
        for (text, message) in [
            ("500,000;600,000;3.5\n", "line 1: 3.5 has a point and 500,000, in line 1, has a comma"),
            ("500,000;600,000;3\n1;2;3\n1;2.5;3\n", "line 3: 2.5 has a point and 500,000, in line 1, has a comma"),
            ("1 2.5 3\n1 2 3,5\n", "line 2: 3,5 has a comma and 2.5, in line 1, has a point"),
            ("x;y;z;i\n\n500,000;600,000;3;0.5\n", "line 3: 0.5 has a point and 500,000, in line 3, has a comma"),
            ("500.000\t600.000\t3,5\n", "line 1: 3,5 has a comma and 500.000, in line 1, has a point"),
            ("500,5, 600,5, 3,5\n", "line 1: \"500,5, 600,5, 3,5\": commas separate numbers and stand before decimals"),
        ] {
            let error = read(text).map(|_| ()).expect_err(text);
            assert!(error.to_string().starts_with(&format!("points.txt: {message}")), "{error}");
            assert!(error.cure_text().is_some(), "{error}");
        }
        assert_eq!(points("1,5;2,25;-3;v1.2;A.1;1.2.3\n4;5;6,5;;;\n"), TWO, "these are not numbers");
        assert_eq!(points("1.5,2.25,-3\n4,5,6.5\n"), TWO);
    }

    #[test]
    fn a_name_of_two_columns_is_refused() {
        for (text, message) in [
            ("x,y,z,z\n1,2,3,4\n", "line 1: columns 3 and 4 are both called \"z\" in the header \"x,y,z,z\""),
            ("Height (m);n;e;height [ft]\n1;2;3;4\n", "line 1: columns 1 and 4 are both called \"height\" in"),
            ("x y x z\n1 2 3 4\n", "line 1: columns 1 and 3 are both called \"x\""),
            ("x y z class class\n1 2 3 4 5\n", "line 1: columns 4 and 5 are both called \"class\""),
            ("# x y z z\n1 2 3 4\n", "line 2: columns 3 and 4 are both called \"z\""),
        ] {
            let error = read(text).map(|_| ()).expect_err(text);
            assert!(error.to_string().starts_with(&format!("points.txt: {message}")), "{error}");
            assert!(error.cure_text().unwrap().plain().contains("columns"));
        }
        let columns = "1,2,4".parse().ok();
        let named = Options { columns, ..Options::default() };
        let mut reader = from_stream(io::Cursor::new("x,y,z,z\n1,2,3,4\n"), "points.txt", named).unwrap();
        let mut batch = PointBatch::default();
        reader.read(&mut batch).unwrap();
        assert_eq!(batch.z, [4.0]);
        // Other columns may share a name; of two names for an axis the first of the table counts.
        assert_eq!(points("x y z r r\n1 2 3 4 5\n"), [[1.0, 2.0, 3.0]]);
        assert_eq!(points("lon lat x y z\n1 2 3 4 5\n"), [[3.0, 4.0, 5.0]]);
    }

    #[test]
    fn fewer_points_than_stated_are_an_error_unless_a_part_is_accepted() {
        let error = read("3\n1 2 3\n4 5 6\n").map(|_| ()).unwrap_err();
        assert_eq!(error.to_string(), "points.txt: the end: the first line states 3 points, but there are 2");
        assert!(error.cure_text().unwrap().plain().contains("partial"));
        let (reader, all) = read("1\n1 2 3\n4 5 6\n").unwrap();
        assert_eq!(
            (all.len(), reader.warnings()),
            (2, &["the first line states 1 points, but there are 2".into()][..])
        );
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
        let mut reader = from_stream(io::Cursor::new(text.into_bytes()), "points.txt", Options::default()).unwrap();
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
        let error = from_stream(io::repeat(b'1'), "endless", Options::default()).map(|_| ()).unwrap_err();
        assert!(error.to_string().contains("a line of more than 65536 bytes"), "{error}");
        let error = from_stream(io::Cursor::new(b"\xff\xfe1\0 \0".to_vec()), "wide", Options::default())
            .map(|_| ())
            .unwrap_err();
        assert!(error.to_string().contains("UTF-16"), "{error}");
    }
}
