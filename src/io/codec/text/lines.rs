//! The lines of a file of points.

use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use super::columns::quote;
use crate::error::{Error, Result, Wording};
use crate::io::options::cut::{OPEN_LINE, OnDamage};

/// Limit for the bytes of a line; text for people has shorter lines, and a binary file may have no
/// line ends.
const MAX_LINE_BYTES: usize = 1 << 16;

/// The lines of a file, read one by one.
pub(super) struct Lines {
    source: BufReader<Box<dyn Read + Send>>,
    pub(super) name: PathBuf,
    /// The current line, without its end.
    pub(super) line: Vec<u8>,
    /// The number of the current line, from 1.
    pub(super) number: u64,
    /// The end of the line before the current one; after the last line, the end of that.
    pub(super) end_before: &'static [u8],
    /// The mark of the encoding before the current line.
    pub(super) mark: &'static [u8],
    /// The end of the current line: a carriage return may be followed by a line feed.
    end: &'static [u8],
    /// True if the last line has a point, but no end.
    pub(super) is_open: bool,
}

impl Lines {
    /// Returns the lines of a stream; messages call it `name`.
    pub(super) fn new(stream: impl Read + Send + 'static, name: &Path) -> Self {
        Lines {
            source: BufReader::with_capacity(1 << 17, Box::new(stream)),
            name: name.to_path_buf(),
            line: Vec::new(),
            number: 0,
            end_before: b"",
            mark: b"",
            end: b"",
            is_open: false,
        }
    }

    /// Reads the next line; returns false at the end of the file.
    pub(super) fn next(&mut self) -> Result<bool> {
        self.line.clear();
        self.number += 1;
        self.mark = b"";
        self.end_before = std::mem::take(&mut self.end);
        let mut is_ended = false;
        while !is_ended {
            let bytes = match self.source.fill_buf() {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                bytes => bytes?,
            };
            if self.line.is_empty() && self.end_before == b"\r" && bytes.first() == Some(&b'\n') {
                self.end_before = b"\r\n";
                self.source.consume(1);
                continue;
            }
            if bytes.is_empty() {
                break;
            }
            let end = bytes
                .iter()
                .position(|&byte| byte == b'\n' || byte == b'\r');
            self.line
                .extend_from_slice(&bytes[..end.unwrap_or(bytes.len())]);
            is_ended = end.is_some();
            self.end = match end.map(|end| bytes[end]) {
                Some(b'\r') => b"\r",
                Some(_) => b"\n",
                None => b"",
            };
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
                self.mark = b"\xef\xbb\xbf";
            }
        }
        self.is_open |= !is_ended && matches!(Line::new(&self.line), Line::Data(_));
        Ok(is_there)
    }

    /// Reports what the end of the file shows after `total` points, if its first line states a
    /// count of them.
    ///
    /// # Errors
    /// If there are fewer points than stated, and this is not accepted.
    pub(super) fn finish(
        &self,
        stated: Option<u64>,
        total: u64,
        cut: OnDamage,
        warnings: &mut Vec<Wording>,
    ) -> Result<()> {
        if self.is_open {
            warnings.push(OPEN_LINE.into());
        }
        let Some(stated) = stated.filter(|&stated| stated != total) else {
            return Ok(());
        };
        let text = format!("the first line states {stated} points, but there are {total}");
        // More points than stated are not a file that was cut.
        let cut = if total < stated {
            cut
        } else {
            OnDamage::Accept
        };
        cut.refuse_or_warn(text, "the end", warnings)
            .map_err(|e| e.in_file(&self.name))
    }

    /// Adds the file and the line to an error.
    pub(super) fn locate(&self, error: Error) -> Error {
        // Before the first line, the options are wrong.
        match self.number {
            0 => error,
            number => error.at(format!("line {number}")),
        }
        .in_file(&self.name)
    }
}

/// A line, by what it contains.
pub(super) enum Line<'a> {
    Blank,
    Comment(&'a [u8]),
    Data(&'a [u8]),
}

impl<'a> Line<'a> {
    pub(super) fn new(line: &'a [u8]) -> Self {
        let text = line.trim_ascii();
        match text {
            [] => Line::Blank,
            [b'#', rest @ ..] | [b'/', b'/', rest @ ..] => Line::Comment(rest),
            // Not trimmed: a line may begin with an empty field.
            _ => Line::Data(line),
        }
    }
}
