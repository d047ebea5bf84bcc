//! Text of points as it is, with fields appended to each line.
//!
//! Every byte is kept: comments, quotes, blanks, the mark of the encoding, the ends of lines. A
//! line with a point gets the same number of fields more, the header their names.

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use super::columns::{ColumnLayout, quote};
use super::first_column::{self, FirstColumn, Guess};
use super::first_lines::Start;
use super::lines::{Line, Lines};
use super::separator::{Axes, Separator};
use crate::data::{Columns, named};
use crate::error::{Error, Result, Setting, Wording, wording};
use crate::io::bytes::decimal_mark::DecimalMark;
use crate::io::options::cut::OnDamage;
use crate::io::options::points::Options;

/// Points in a batch, at most.
const BATCH: usize = 1 << 16;

/// Bytes of lines after which a batch ends.
const BATCH_BYTES: usize = 4 << 20;

/// Limit for the bytes of lines up to the first point, which are in one batch.
const HEAD_BYTES: usize = 16 << 20;

/// A reader of text with points, made by [`open`], which keeps all that it reads.
pub struct TextTable {
    lines: Lines,
    layout: ColumnLayout,
    header: Option<Header>,
    mark: DecimalMark,
    /// The lines up to the first point, that one included.
    head: Option<TableBatch>,
    first_column: Option<FirstColumn>,
    /// How many fields the first point has.
    first_fields: usize,
    /// The count of points that the first line states.
    stated: Option<u64>,
    /// What to do if there are fewer.
    cut: OnDamage,
    read: u64,
    is_done: bool,
    warnings: Vec<Wording>,
}

/// A header.
#[derive(Debug)]
struct Header {
    names: Vec<String>,
    /// Points may have another one.
    separator: Separator,
}

impl Header {
    fn of(line: &[u8], axes: Axes, of_points: Separator) -> Self {
        let text = match Line::new(line) {
            Line::Comment(text) => text.rsplit(|&byte| byte == b':').next().unwrap_or(text),
            Line::Data(_) | Line::Blank => line,
        };
        let separator = Separator::guess(text, axes).unwrap_or(of_points);
        let name = |field: &[u8]| String::from_utf8_lossy(field).into_owned();
        Header {
            names: separator.fields(text).map(name).collect(),
            separator,
        }
    }
}

/// Lines of text, some of which have points.
#[derive(Debug, Default)]
pub struct TableBatch {
    /// x and y of each point.
    pub positions: Vec<[f64; 2]>,
    /// The height of each point; NaN with [`Axes::Plan`].
    pub heights: Vec<f64>,
    /// The number of the line of each point, from 1.
    pub numbers: Vec<u64>,
    /// All bytes of the lines. That of a line begins with the end of the one before.
    text: Vec<u8>,
    lines: Vec<TableLine>,
}

/// A line in a batch.
#[derive(Debug, Clone, Copy)]
struct TableLine {
    /// Where it ends in the text, without its own line end.
    end: usize,
    kind: LineKind,
}

/// What is appended to a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LineKind {
    /// The names of fields.
    Header,
    /// The fields of the next point.
    Point,
    /// Nothing.
    Other,
}

impl std::fmt::Debug for TextTable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TextTable")
            .field("layout", &self.layout)
            .field("header", &self.header)
            .finish_non_exhaustive()
    }
}

/// Opens a text file of points; `-` is the standard input. With [`Axes::Plan`], no column of
/// heights is needed.
///
/// # Errors
/// If the file cannot be read, or its first lines are neither a header nor a point.
pub fn open(path: impl AsRef<Path>, options: Options, axes: Axes) -> Result<TextTable> {
    let path = path.as_ref();
    if path.as_os_str() == "-" {
        return from_stream(io::stdin(), "standard input", options, axes);
    }
    let file = File::open(path).map_err(|error| Error::from(error).in_file(path))?;
    from_stream(file, path, options, axes)
}

/// Reads points from a stream; messages call it `name`.
///
/// # Errors
/// As [`open`].
pub fn from_stream(
    stream: impl Read + Send + 'static,
    name: impl AsRef<Path>,
    options: Options,
    axes: Axes,
) -> Result<TextTable> {
    let mut lines = Lines::new(stream, name.as_ref());
    let mut head = TableBatch::default();
    let start = Start::read(&mut lines, options.columns, axes, &mut |lines| {
        head.push(lines, LineKind::Other);
        match head.bytes() > HEAD_BYTES {
            true => Err(
                Error::limit("more than 16 MB of lines before the first point")
                    .cure("remove comments and blank lines before the points"),
            ),
            false => Ok(()),
        }
    })
    .map_err(|error| lines.locate(error))?;
    let mut header = None;
    if let Some(number) = start.header {
        let at = (number - 1) as usize;
        header = Some(Header::of(head.line(at), axes, start.layout.separator));
        if let Some(line) = head.lines.get_mut(at) {
            line.kind = LineKind::Header;
        }
    }
    let separator = start.layout.separator;
    let mut table = TextTable {
        first_fields: separator.fields(&lines.line).count(),
        stated: start.count,
        cut: options.cut,
        read: 0,
        warnings: Vec::new(),
        lines,
        layout: start.layout,
        header,
        mark: start.mark,
        head: None,
        first_column: start.first_column,
        is_done: start.first.is_none(),
    };
    match start.first {
        Some(first) => {
            if let Some(line) = head.lines.last_mut() {
                line.kind = LineKind::Point;
            }
            head.add_point(first.position(), table.lines.number);
        }
        // The end of the last line.
        None => head.end(&table.lines),
    }
    table.head = Some(head);
    Ok(table)
}

impl TextTable {
    /// Returns true if a line names the columns.
    pub fn has_header(&self) -> bool {
        self.header.is_some()
    }

    /// Returns the number of the column with a name, from 1: as written, else in any case.
    pub fn column(&self, name: &str) -> Option<usize> {
        let names = &self.header.as_ref()?.names;
        named(names.iter().map(String::as_str), name).map(|at| at + 1)
    }

    /// Returns the names of the columns; none without a header.
    pub fn names(&self) -> &[String] {
        self.header.as_ref().map_or(&[], |header| &header.names)
    }

    /// Returns the columns that were read.
    pub fn columns(&self) -> Columns {
        self.layout.columns
    }

    /// Reads some lines; the batch has none at the end.
    ///
    /// # Errors
    /// If a line is not a point, there are fewer points than the first line states, or the system
    /// fails.
    pub fn read(&mut self, batch: &mut TableBatch) -> Result<()> {
        batch.clear();
        let was_done = self.is_done && self.head.is_none();
        if let Some(head) = self.head.take() {
            *batch = head;
        }
        while !self.is_done && batch.positions.len() < BATCH && batch.bytes() < BATCH_BYTES {
            if let Err(error) = self.read_line(batch) {
                self.is_done = true;
                return Err(self.lines.locate(error));
            }
        }
        // One batch is enough to distinguish numbers from coordinates.
        if let Some(Guess::Counted) = self.first_column.take().map(FirstColumn::guess) {
            self.is_done = true;
            return Err(first_column::refuse().in_file(&self.lines.name));
        }
        self.read += batch.positions.len() as u64;
        if self.is_done && !was_done {
            self.lines
                .finish(self.stated, self.read, self.cut, &mut self.warnings)?;
        }
        Ok(())
    }

    /// Returns what looks wrong so far.
    pub fn warnings(&self) -> &[Wording] {
        &self.warnings
    }

    fn read_line(&mut self, batch: &mut TableBatch) -> Result<()> {
        if !self.lines.next()? {
            self.is_done = true;
            batch.end(&self.lines);
            return Ok(());
        }
        let Line::Data(line) = Line::new(&self.lines.line) else {
            batch.push(&self.lines, LineKind::Other);
            return Ok(());
        };
        let separator = self.layout.separator;
        separator.add_marks(&mut self.mark, line, self.lines.number)?;
        self.first_column = self
            .first_column
            .take()
            .and_then(|first_column| first_column.next(separator, line));
        let point = self.layout.point(line)?;
        batch.push(&self.lines, LineKind::Point);
        batch.add_point(point.position(), self.lines.number);
        Ok(())
    }

    /// Returns a writer of fields, which are separated as those of this text.
    ///
    /// # Errors
    /// If the header has one of the names already, or a name is not one field.
    pub fn writer<'t>(&self, names: &'t [String]) -> Result<TableWriter<'t>> {
        if let Some(header) = &self.header {
            let is_there = |name: &&String| {
                let is_it = |other: &String| other.eq_ignore_ascii_case(name);
                header.names.iter().any(is_it)
            };
            if let Some(name) = names.iter().find(is_there) {
                return Err(Error::usage(format!("there is a column {name} already"))
                    .in_file(&self.lines.name)
                    .cure(wording![
                        "give the new columns other names with ",
                        Setting::Prefix.text("new_")
                    ]));
            }
        }
        let separator = self.layout.separator;
        let of_header = self.header.as_ref();
        let of_names = of_header.map_or(separator, |header| header.separator);
        let is_odd =
            |byte: u8| byte == b'"' || byte.is_ascii_control() || of_names.ends_field(byte);
        if let Some(name) = names.iter().find(|name| name.bytes().any(is_odd)) {
            return Err(Error::usage(format!(
                "the name {} is not one field between {}",
                quote(name.as_bytes()),
                of_names.name()
            ))
            .in_file(&self.lines.name)
            .cure(wording![
                "use letters and digits only for ",
                Setting::Prefix
            ]));
        }
        Ok(TableWriter {
            separator,
            of_names,
            names,
            file: self.lines.name.clone(),
            fields: of_header.map_or(self.first_fields, |header| header.names.len()),
            counted_in: match of_header {
                Some(_) => "the header",
                None => "the first point",
            },
        })
    }

    /// Returns true if the decimals of numbers follow a comma.
    pub fn has_decimal_commas(&self) -> bool {
        self.mark.is_comma()
    }

    /// Returns the fields of all points of a batch in a column, from 1.
    ///
    /// # Errors
    /// If a line has no such field, or it is not UTF-8.
    pub fn fields(&self, batch: &TableBatch, column: usize) -> Result<Vec<String>> {
        let points = (0..batch.lines.len()).filter(|&i| batch.lines[i].kind == LineKind::Point);
        let field = |(line, number): (usize, &u64)| {
            let line = batch.line(line);
            let field = self.layout.separator.fields(line).nth(column - 1);
            field
                .and_then(|field| std::str::from_utf8(field).ok())
                .map(str::to_owned)
                .ok_or_else(|| {
                    Error::format(format!("no text in column {column}: {}", quote(line)))
                        .at(format!("line {number}"))
                        .in_file(&self.lines.name)
                        .cure("complete the line, and write the file as UTF-8")
                })
        };
        points.zip(&batch.numbers).map(field).collect()
    }
}

impl TableBatch {
    /// Returns true if there is nothing left to write.
    pub fn is_empty(&self) -> bool {
        self.text.is_empty()
    }

    /// Returns the bytes of memory that the lines need.
    fn bytes(&self) -> usize {
        self.text.len() + self.lines.len() * size_of::<TableLine>()
    }

    fn clear(&mut self) {
        self.positions.clear();
        self.heights.clear();
        self.numbers.clear();
        self.text.clear();
        self.lines.clear();
    }

    /// Adds the current line.
    fn push(&mut self, lines: &Lines, kind: LineKind) {
        self.text.extend_from_slice(lines.end_before);
        self.text.extend_from_slice(lines.mark);
        self.text.extend_from_slice(&lines.line);
        self.lines.push(TableLine {
            end: self.text.len(),
            kind,
        });
    }

    /// Adds the end of the last line.
    fn end(&mut self, lines: &Lines) {
        self.text.extend_from_slice(lines.end_before);
    }

    fn add_point(&mut self, [x, y, z]: [f64; 3], number: u64) {
        self.positions.push([x, y]);
        self.heights.push(z);
        self.numbers.push(number);
    }

    /// Returns the text of a line, with the end of the one before trimmed off.
    fn line(&self, at: usize) -> &[u8] {
        let start = at.checked_sub(1).map_or(0, |before| self.lines[before].end);
        let line = self
            .lines
            .get(at)
            .map_or(&[][..], |line| &self.text[start..line.end]);
        let is_end = |byte: &u8| matches!(byte, b'\n' | b'\r');
        let begins = line
            .iter()
            .position(|byte| !is_end(byte))
            .unwrap_or(line.len());
        let line = &line[begins..];
        line.strip_prefix(b"\xef\xbb\xbf").unwrap_or(line)
    }
}

/// Writes batches with fields appended.
#[derive(Debug)]
pub struct TableWriter<'t> {
    separator: Separator,
    /// The separator of the header.
    of_names: Separator,
    names: &'t [String],
    /// What messages call the text.
    file: PathBuf,
    /// How many fields each point has before those that are appended.
    fields: usize,
    /// What has so many.
    counted_in: &'static str,
}

impl TableWriter<'_> {
    /// Writes the lines of a batch. `fields` has those of all points, as many for each as there are
    /// names; what is empty is an empty field, or `nan` where blanks separate.
    ///
    /// # Errors
    /// If a line has more or fewer fields than the header, or without one the first point, or ends
    /// in a comment: what is appended would be in another column; and those of `out`.
    pub fn write(&self, batch: &TableBatch, fields: &Fields, out: &mut dyn Write) -> Result<()> {
        let mut written = 0;
        let mut next = 0;
        let mut numbers = batch.numbers.iter();
        for (at, line) in batch.lines.iter().enumerate() {
            if line.kind == LineKind::Point {
                self.check(batch.line(at), numbers.next())?;
            }
            out.write_all(&batch.text[written..line.end])?;
            written = line.end;
            match line.kind {
                LineKind::Header => {
                    for name in self.names {
                        out.write_all(&[self.of_names.byte()])?;
                        out.write_all(name.as_bytes())?;
                    }
                }
                LineKind::Point => {
                    for _ in self.names {
                        out.write_all(&[self.separator.byte()])?;
                        match fields.get(next) {
                            [] if self.separator == Separator::Blanks => out.write_all(b"nan")?,
                            field => out.write_all(field)?,
                        }
                        next += 1;
                    }
                }
                LineKind::Other => {}
            }
        }
        Ok(out.write_all(&batch.text[written..])?)
    }

    /// Returns an error unless what is appended to the line of a point is in the column of its
    /// name.
    fn check(&self, line: &[u8], number: Option<&u64>) -> Result<()> {
        let is_comment = |field: &[u8]| field.starts_with(b"#") || field.starts_with(b"//");
        let (mut count, mut has_comment) = (0, false);
        for field in self.separator.fields(line) {
            count += 1;
            has_comment |= self.separator == Separator::Blanks && is_comment(field);
        }
        if count == self.fields && !has_comment {
            return Ok(());
        }
        let shown = quote(line);
        let separator = self.separator.name();
        let Self {
            fields, counted_in, ..
        } = self;
        let s = if count == 1 { "" } else { "s" };
        let error = match has_comment {
            true => Error::format(format!(
                "a comment after a point, to which nothing can be appended: {shown}"
            ))
            .cure("move comments to lines of their own, or separate the fields by semicolons"),
            false => Error::format(format!(
                "{count} field{s} separated by {separator}, but {counted_in} has {fields}: {shown}"
            ))
            .cure(format!(
                "give all lines {fields} fields: put text that has {separator} in quotes, and \
                 complete short lines"
            )),
        };
        let number = number.copied().unwrap_or_default();
        Err(error.at(format!("line {number}")).in_file(&self.file))
    }
}

/// Fields of text, one after another.
#[derive(Debug, Default)]
pub struct Fields {
    text: Vec<u8>,
    ends: Vec<usize>,
    has_commas: bool,
}

impl Fields {
    /// Returns no fields yet, for numbers whose decimals follow a comma or a point.
    pub fn new(has_decimal_commas: bool) -> Self {
        Fields {
            has_commas: has_decimal_commas,
            ..Fields::default()
        }
    }

    /// Removes all fields.
    pub fn clear(&mut self) {
        self.text.clear();
        self.ends.clear();
    }

    /// Adds a number with all its digits; an empty field if it is NaN.
    pub fn push(&mut self, number: f64) {
        if !number.is_nan() {
            let start = self.text.len();
            // Writing to memory does not fail.
            let _ = write!(self.text, "{number}");
            if self.has_commas {
                let digits = self.text[start..].iter_mut();
                digits
                    .filter(|byte| **byte == b'.')
                    .for_each(|byte| *byte = b',');
            }
        }
        self.ends.push(self.text.len());
    }

    /// Returns a field; empty if there is none.
    fn get(&self, at: usize) -> &[u8] {
        let start = at.checked_sub(1).and_then(|before| self.ends.get(before));
        let end = self.ends.get(at);
        match end {
            Some(&end) => &self.text[start.map_or(0, |start| *start)..end],
            None => &[],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the text with `appended` to each point, and the positions.
    fn kept(text: &[u8], axes: Axes) -> Result<(Vec<u8>, Vec<[f64; 2]>)> {
        let text = std::io::Cursor::new(text.to_vec());
        let mut table = from_stream(text, "text", Options::default(), axes)?;
        let names = ["new".to_owned()];
        let writer = table.writer(&names)?;
        let (mut out, mut positions) = (Vec::new(), Vec::new());
        let mut batch = TableBatch::default();
        loop {
            table.read(&mut batch)?;
            if batch.is_empty() {
                return Ok((out, positions));
            }
            let mut fields = Fields::new(table.has_decimal_commas());
            batch.positions.iter().for_each(|_| fields.push(7.5));
            writer.write(&batch, &fields, &mut out)?;
            positions.extend(&batch.positions);
        }
    }

    #[test]
    fn without_what_is_appended_the_text_is_that_of_before() {
        let mut random = testkit::random::Random(91);
        let lines: [&[u8]; 10] = [
            b"1,2,3",
            b"4.5, -6 ,7,\"a,b\"",
            b"",
            b"# x",
            b"// note: 1 2",
            b"8,9,1,",
            b" ",
            b"x,y,z",
            b"\xff,1,2",
            b"2,3",
        ];
        let mut read = 0;
        for _ in 0..10_000 {
            let mut text: Vec<u8> = match random.index(4) {
                0 => b"\xef\xbb\xbfx,y,z\n".to_vec(),
                1 => b"x,y,z\r\n".to_vec(),
                _ => Vec::new(),
            };
            for _ in 0..random.index(6) {
                text.extend_from_slice(random.pick(&lines));
                text.extend_from_slice(random.pick(&[&b"\n"[..], b"\r\n", b"\r", b"\n\n"]));
            }
            if random.index(2) == 0 {
                text.extend_from_slice(random.pick(&lines));
            }
            for axes in [Axes::Plan, Axes::Space] {
                let Ok((out, positions)) = kept(&text, axes) else {
                    continue;
                };
                read += positions.len();
                let found = String::from_utf8_lossy(&out).matches(",7.5").count();
                assert_eq!(found, positions.len());
                let out = String::from_utf8_lossy(&out)
                    .replace(",7.5", "")
                    .replace(",new", "");
                assert_eq!(out, String::from_utf8_lossy(&text));
            }
        }
        assert!(read > 1000, "{read}");
    }

    #[test]
    fn what_is_appended_is_in_the_column_of_its_name() {
        for (text, is_kept) in [
            ("x,y,note\n1,1,a\n2,2,\"b, c\"\n", true),
            ("x,y,note\n1,1,a\n2,2\n", false),
            ("x,y,note\n1,1,a,b\n", false),
            ("x,y\n1,1,\n", false),
            ("x,y,\n1,1,\n", true),
            ("1,1\n2,2,\n", false),
            ("1 1 # a\n2 2 # b\n", false),
            ("1 1 //a\n", false),
            ("1,1,#5\n", true),
            ("x;y\n1 1\n2 2\n", true),
            ("x y\n1 1\n2 2 # well\n", false),
            ("# note: x y\n1 1\n 2  2 \n", true),
            ("# x y\n1 1 5\n", false),
        ] {
            assert_eq!(kept(text.as_bytes(), Axes::Plan).is_ok(), is_kept, "{text}");
        }
        let error = kept(b"x,y,note\n\n1,1,a\n2,2\n", Axes::Plan).unwrap_err();
        let shown = error.to_string();
        let expected = "text: line 4: 2 fields separated by commas, but the header has 3: \"2,2\"";
        assert!(shown.contains(expected), "{shown}");
    }

    #[test]
    fn memory_is_bounded_by_bytes() {
        let comment = [&b"# "[..], &[b'a'; 1 << 15], b"\n"].concat();
        let mut text = b"1,1\n".to_vec();
        (0..300).for_each(|_| text.extend(&comment));
        let text = std::io::Cursor::new([text, b"2,2\n".to_vec()].concat());
        let mut table = from_stream(text, "text", Options::default(), Axes::Plan).unwrap();
        let (mut batch, mut points) = (TableBatch::default(), 0);
        loop {
            table.read(&mut batch).unwrap();
            if batch.is_empty() {
                break;
            }
            assert!(batch.bytes() < BATCH_BYTES + (1 << 16));
            points += batch.positions.len();
        }
        assert_eq!(points, 2);
        let endless = std::io::repeat(b'\n');
        let error = from_stream(endless, "text", Options::default(), Axes::Plan).unwrap_err();
        assert!(error.to_string().contains("before the first point"));
    }

    #[test]
    fn a_text_that_was_cut_is_refused() {
        let read = |text: &str, cut| {
            let text = std::io::Cursor::new(text.as_bytes().to_vec());
            let options = Options {
                cut,
                ..Options::default()
            };
            let mut table = from_stream(text, "text", options, Axes::Plan)?;
            let mut batch = TableBatch::default();
            loop {
                table.read(&mut batch)?;
                if batch.is_empty() {
                    return Ok::<_, Error>(table.warnings().len());
                }
            }
        };
        for (text, warnings) in [
            ("2\n1 1\n2 2\n", Some(0)),
            ("1\n1 1\n2 2\n", Some(1)),
            ("2\n1 1\n2 2", Some(1)),
            ("3\n1 1\n2 2\n", None),
            ("3\n", None),
            ("", Some(0)),
        ] {
            assert_eq!(read(text, OnDamage::Refuse).ok(), warnings, "{text}");
            let accepted = read(text, OnDamage::Accept).unwrap();
            assert_eq!(accepted, warnings.unwrap_or(1), "{text}");
        }
    }
}
