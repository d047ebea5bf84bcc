//! Points as text: XYZ, CSV and their relatives.
//!
//! One point in a line. Fields are separated by semicolons, tabs, commas or blanks; which, is told
//! by the first point. Without a header line the first three columns are x, y and z. With one,
//! columns are found by name, in any case and order:
//!
//! | column | names |
//! |---|---|
//! | x | `x`, `easting`, `east`, `e`, `lon`, `long`, `longitude` |
//! | y | `y`, `northing`, `north`, `n`, `lat`, `latitude` |
//! | z | `z`, `elevation`, `elev`, `height`, `h`, `altitude`, `alt` |
//! | class, if there is one | `class`, `classification` |
//!
//! A unit in brackets after a name is ignored: `Height (m)`. Comments begin with `#` or `//`; one
//! before the points may be the header. Fields may stand in double quotes. A decimal comma is
//! understood where fields are not separated by commas. A first line of one number is the count of
//! points that `.pts` files begin with. UTF-8 and its relatives, with or without a byte order
//! mark; any line ends. What is not a point is an error with its line: no line is dropped silently.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use crate::data::{PointBatch, PointInfo, PointSource};
use crate::error::{Error, Result};

/// Points in a batch.
const BATCH: usize = 1 << 16;

/// Bytes in a line; text for people has shorter ones, and a binary file may have none at all.
const LONGEST_LINE: u64 = 1 << 16;

const X_NAMES: &[&str] = &["x", "easting", "east", "e", "lon", "long", "longitude"];
const Y_NAMES: &[&str] = &["y", "northing", "north", "n", "lat", "latitude"];
const Z_NAMES: &[&str] = &["z", "elevation", "elev", "height", "h", "altitude", "alt"];
const CLASS_NAMES: &[&str] = &["class", "classification"];

/// Reads points from text; made by [`open`].
pub struct TextReader {
    lines: Lines,
    columns: Columns,
    info: PointInfo,
    /// The first point was read to find out about the columns, and waits here.
    first: Option<Point>,
    read: u64,
    is_done: bool,
    warnings: Vec<String>,
}

impl std::fmt::Debug for TextReader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TextReader").field("info", &self.info).field("read", &self.read).finish_non_exhaustive()
    }
}

/// Opens a file of points as text; `-` is the standard input.
///
/// # Errors
/// If the file cannot be read, or its first lines are neither a header nor a point.
pub fn open(path: impl AsRef<Path>) -> Result<TextReader> {
    let path = path.as_ref();
    if path.as_os_str() == "-" {
        return from_stream(io::stdin(), "standard input");
    }
    let file = File::open(path).map_err(|error| Error::from(error).in_file(path))?;
    from_stream(file, path)
}

/// Reads a stream; `name` is for messages.
///
/// # Errors
/// As [`open`].
pub fn from_stream(stream: impl Read + Send + 'static, name: impl AsRef<Path>) -> Result<TextReader> {
    let mut lines = Lines {
        source: BufReader::with_capacity(1 << 17, Box::new(stream)),
        name: name.as_ref().to_path_buf(),
        line: Vec::new(),
        number: 0,
    };
    let start = start(&mut lines).map_err(|error| lines.place(error))?;
    let header = if start.has_header { ", with header" } else { "" };
    let info = PointInfo {
        format: format!("text, separated by {}{header}", start.columns.separator.name()),
        count: start.count,
        has_classes: start.columns.class.is_some(),
        ..PointInfo::default()
    };
    Ok(TextReader {
        lines,
        columns: start.columns,
        info,
        first: start.first,
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
                    return Err(self.lines.place(error));
                }
            }
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
                return self.columns.point(line).map(Some);
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

/// What the first lines say.
struct Start {
    columns: Columns,
    has_header: bool,
    count: Option<u64>,
    first: Option<Point>,
}

fn start(lines: &mut Lines) -> Result<Start> {
    // Columns that a comment names.
    let mut named: Option<Columns> = None;
    let mut count = None;
    while lines.next()? {
        let line = match Line::new(&lines.line) {
            Line::Blank => continue,
            Line::Comment(text) => {
                let columns = Separator::guess(text).and_then(|separator| Columns::named(text, separator).ok());
                named = columns.or(named);
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
            // Its points may be separated by something else than its names.
            named = Some(Columns::named(line, separator)?);
            continue;
        }
        let has_header = named.is_some();
        let columns = Columns { separator, ..named.unwrap_or(Columns::FIRST) };
        let first = columns.point(line).map_err(|error| match has_header {
            true => error,
            false => error.cure("correct the line, or put a header before it that names the columns: x y z"),
        })?;
        return Ok(Start { columns, has_header, count, first: Some(first) });
    }
    let has_header = named.is_some();
    Ok(Start { columns: named.unwrap_or(Columns::FIRST), has_header, count, first: None })
}

/// Whether the line is one whole number.
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

/// The lines of the file, one after the other.
struct Lines {
    source: BufReader<Box<dyn Read + Send>>,
    name: PathBuf,
    /// Without its end.
    line: Vec<u8>,
    /// From 1 on.
    number: u64,
}

impl Lines {
    /// Whether there was one more line.
    fn next(&mut self) -> Result<bool> {
        self.line.clear();
        self.number += 1;
        let length = (&mut self.source).take(LONGEST_LINE).read_until(b'\n', &mut self.line)?;
        if length as u64 == LONGEST_LINE && !self.line.ends_with(b"\n") {
            return Err(Error::format(format!(
                "a line of more than {LONGEST_LINE} bytes, which begins {}",
                quote(&self.line)
            ))
            .cure("this is perhaps not a text file"));
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

    /// Says in which file and line it was.
    fn place(&self, error: Error) -> Error {
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

/// What stands between two fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Separator {
    Semicolon,
    Tab,
    Comma,
    Blanks,
}

impl Separator {
    /// The first one that makes three numbers of the line, or else three fields.
    fn guess(line: &[u8]) -> Option<Self> {
        let all = [Self::Semicolon, Self::Tab, Self::Comma, Self::Blanks];
        let has_numbers =
            |separator: &Self| separator.fields(line).filter_map(|field| separator.number(field)).take(3).count() == 3;
        let has_fields = |separator: &Self| separator.fields(line).take(3).count() == 3;
        all.into_iter().find(has_numbers).or_else(|| all.into_iter().find(has_fields))
    }

    fn name(self) -> &'static str {
        match self {
            Self::Semicolon => "semicolons",
            Self::Tab => "tabs",
            Self::Comma => "commas",
            Self::Blanks => "blanks",
        }
    }

    fn ends_field(self, byte: u8) -> bool {
        match self {
            Self::Semicolon => byte == b';',
            Self::Tab => byte == b'\t',
            Self::Comma => byte == b',',
            Self::Blanks => byte == b' ' || byte == b'\t',
        }
    }

    /// The fields of a line, without quotes and the blanks around them.
    fn fields(self, line: &[u8]) -> impl Iterator<Item = &[u8]> {
        let mut rest = Some(if self == Self::Blanks { line.trim_ascii() } else { line });
        std::iter::from_fn(move || {
            let line = rest?;
            let length = self.field_length(line);
            rest = line.get(length + 1..);
            if self == Self::Blanks {
                rest = rest.map(|rest| rest.trim_ascii_start());
            }
            let field = line[..length].trim_ascii();
            Some(field.strip_prefix(b"\"").and_then(|field| field.strip_suffix(b"\"")).unwrap_or(field).trim_ascii())
        })
    }

    /// Bytes before the next separator that is not in quotes.
    fn field_length(self, line: &[u8]) -> usize {
        let mut in_quotes = false;
        line.iter()
            .position(|&byte| {
                in_quotes ^= byte == b'"';
                !in_quotes && self.ends_field(byte)
            })
            .unwrap_or(line.len())
    }

    /// A number, with a decimal comma where the comma has no other use.
    fn number(self, field: &[u8]) -> Option<f64> {
        let text = std::str::from_utf8(field).ok()?;
        let value: f64 = match self {
            Self::Semicolon | Self::Tab | Self::Blanks if field.contains(&b',') && !field.contains(&b'.') => {
                text.replacen(',', ".", 1).parse().ok()?
            }
            _ => text.parse().ok()?,
        };
        value.is_finite().then_some(value)
    }
}

/// Which field is what, from 0 on.
#[derive(Debug, Clone, Copy)]
struct Columns {
    separator: Separator,
    x: usize,
    y: usize,
    z: usize,
    class: Option<usize>,
}

impl Columns {
    /// What there is without a header.
    const FIRST: Self = Columns { separator: Separator::Blanks, x: 0, y: 1, z: 2, class: None };

    /// Finds the columns by their names.
    fn named(header: &[u8], separator: Separator) -> Result<Self> {
        let names: Vec<String> = separator.fields(header).map(bare_name).collect();
        let find = |known: &[&str]| known.iter().find_map(|known| names.iter().position(|name| name == known));
        let need = |axis: &str, known: &[&str]| {
            find(known).ok_or_else(|| {
                Error::format(format!("no column for {axis} in the header {}", quote(header)))
                    .cure(format!("call it one of {}", known.join(", ")))
            })
        };
        Ok(Columns {
            separator,
            x: need("x", X_NAMES)?,
            y: need("y", Y_NAMES)?,
            z: need("z", Z_NAMES)?,
            class: find(CLASS_NAMES),
        })
    }

    fn point(&self, line: &[u8]) -> Result<Point> {
        let mut found: [&[u8]; 4] = [b""; 4];
        let wanted = [Some(self.x), Some(self.y), Some(self.z), self.class];
        let last = wanted.into_iter().flatten().fold(0, usize::max);
        let mut count = 0;
        for (i, field) in self.separator.fields(line).enumerate().take(last + 1) {
            count = i + 1;
            for (place, _) in found.iter_mut().zip(wanted).filter(|(_, column)| *column == Some(i)) {
                *place = field;
            }
        }
        if count <= last {
            return Err(Error::format(format!(
                "{count} {} separated by {}, expected at least {}: {}",
                if count == 1 { "field" } else { "fields" },
                self.separator.name(),
                last + 1,
                quote(line)
            ))
            .cure(CURE));
        }
        Ok(Point {
            x: self.coordinate("x", found[0], line)?,
            y: self.coordinate("y", found[1], line)?,
            z: self.coordinate("z", found[2], line)?,
            class: self.class.map(|_| self.class_code(found[3], line)).transpose()?,
        })
    }

    fn coordinate(&self, axis: &str, field: &[u8], line: &[u8]) -> Result<f64> {
        self.separator.number(field).ok_or_else(|| {
            Error::format(format!("{axis} is {}, expected a finite number: {}", quote(field), quote(line))).cure(CURE)
        })
    }

    fn class_code(&self, field: &[u8], line: &[u8]) -> Result<u8> {
        let code = self.separator.number(field).filter(|code| code.fract() == 0.0 && (0.0..=255.0).contains(code));
        code.map(|code| code as u8).ok_or_else(|| {
            Error::format(format!("class is {}, expected a whole number from 0 to 255: {}", quote(field), quote(line)))
                .cure(CURE)
        })
    }
}

const CURE: &str = "correct the line, or make it a comment with # at its beginning";

/// A name in lower case, without what stands in brackets.
fn bare_name(field: &[u8]) -> String {
    let text = String::from_utf8_lossy(field).to_lowercase();
    let end = text.find(['(', '[']).unwrap_or(text.len());
    text[..end].trim().to_owned()
}

/// Text for a message: on one line, and not too long.
fn quote(text: &[u8]) -> String {
    const MOST: usize = 60;
    let text = text.trim_ascii();
    let shown = &text[..text.len().min(MOST)];
    let dots = if text.len() > MOST { "..." } else { "" };
    format!("\"{}{dots}\"", String::from_utf8_lossy(shown).escape_debug())
}

struct Point {
    x: f64,
    y: f64,
    z: f64,
    class: Option<u8>,
}

impl Point {
    fn push(&self, batch: &mut PointBatch) {
        batch.x.push(self.x);
        batch.y.push(self.y);
        batch.z.push(self.z);
        batch.class.extend(self.class);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<(TextReader, PointBatch)> {
        let mut reader = from_stream(io::Cursor::new(text.as_bytes().to_vec()), "points.txt")?;
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
        let mut reader = from_stream(io::Cursor::new(text.into_bytes()), "points.txt").unwrap();
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
        let error = from_stream(io::repeat(b'1'), "endless").map(|_| ()).unwrap_err();
        assert!(error.to_string().contains("a line of more than 65536 bytes"), "{error}");
        let error = from_stream(io::Cursor::new(b"\xff\xfe1\0 \0".to_vec()), "wide").map(|_| ()).unwrap_err();
        assert!(error.to_string().contains("UTF-16"), "{error}");
    }
}
