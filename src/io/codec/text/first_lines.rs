//! The lines up to the first point: what they state, and the columns that follow from it.

use super::columns::{ColumnLayout, NameFlaw, Point, quote};
use super::first_column::FirstColumn;
use super::lines::{Line, Lines};
use super::separator::Separator;
use crate::data::Columns;
use crate::error::{Error, Result, Setting, wording};
use crate::io::bytes::decimal_mark::DecimalMark;

/// The result of reading the first lines.
pub(super) struct Start {
    pub(super) layout: ColumnLayout,
    pub(super) has_header: bool,
    pub(super) count: Option<u64>,
    pub(super) first: Option<Point>,
    pub(super) first_column: Option<FirstColumn>,
    pub(super) mark: DecimalMark,
}

impl Start {
    /// Reads the lines up to the first point, which is then the current line.
    ///
    /// # Errors
    /// If a line is neither a header nor a point.
    pub(super) fn read(lines: &mut Lines, columns: Option<Columns>) -> Result<Self> {
        let asked = columns.map(|columns| ColumnLayout {
            columns,
            ..ColumnLayout::FIRST
        });
        let mut head = Head {
            asked,
            ..Head::default()
        };
        while lines.next()? {
            match Line::new(&lines.line) {
                Line::Blank => {}
                Line::Comment(text) => head.add_comment(text),
                Line::Data(line) => {
                    if let Some(separator) = head.add_line(line)? {
                        return head.with_point(separator, line, lines.number);
                    }
                }
            }
        }
        Ok(head.without_points())
    }
}

/// What is known before the first point.
#[derive(Default)]
struct Head {
    /// The layout that the caller gives.
    asked: Option<ColumnLayout>,
    /// The layout that a header names.
    named: Option<ColumnLayout>,
    /// The layout that a comment names, and its number of names.
    commented: Option<(std::result::Result<ColumnLayout, NameFlaw>, usize)>,
    is_header_passed: bool,
    /// The number of points that a line states.
    count: Option<u64>,
}

impl Head {
    /// Adds a comment, which may name the columns.
    fn add_comment(&mut self, text: &[u8]) {
        let names = text.rsplit(|&byte| byte == b':').next().unwrap_or(text);
        if let Some(separator) = Separator::guess(names)
            && let layout @ (Ok(_) | Err(NameFlaw::Repeated(_))) =
                ColumnLayout::named(names, separator)
        {
            self.commented = Some((layout, separator.fields(names).count()));
        }
    }

    /// Adds a line that is the count of points or a header. Returns the separator if it is a point.
    fn add_line(&mut self, line: &[u8]) -> Result<Option<Separator>> {
        if self.count.is_none() && is_count(line) {
            self.count = std::str::from_utf8(line)
                .ok()
                .and_then(|text| text.trim().parse().ok());
            return Ok(None);
        }
        let separator = Separator::guess(line).ok_or_else(|| not_a_point(line))?;
        if separator.has_two_uses(line) {
            return Err(Error::format(format!(
                "{}: commas separate numbers and stand before decimals",
                quote(line)
            ))
            .cure("separate the numbers by semicolons, or write decimal points"));
        }
        if separator
            .fields(line)
            .any(|field| separator.number(field).is_some())
        {
            return Ok(Some(separator));
        }
        // The points may have another separator than the names.
        self.named = match self.asked {
            None => Some(ColumnLayout::named(line, separator)?),
            Some(_) if self.is_header_passed => return Err(not_a_point(line)),
            Some(_) => None,
        };
        self.is_header_passed = true;
        Ok(None)
    }

    /// Returns what follows from all lines before a point, and from its own.
    fn with_point(self, separator: Separator, line: &[u8], number: u64) -> Result<Start> {
        let Head {
            asked,
            named,
            commented,
            is_header_passed,
            count,
        } = self;
        // A comment with more words than a line has fields is prose.
        let commented = commented.filter(|(_, names)| *names <= separator.fields(line).count());
        let has_header = is_header_passed || commented.is_some();
        let named = match commented {
            Some((layout, _)) if named.is_none() && asked.is_none() => Some(layout?),
            _ => named,
        };
        let mut mark = DecimalMark::default();
        separator.add_marks(&mut mark, line, number)?;
        let known = asked.or(named);
        let layout = ColumnLayout {
            separator,
            ..known.unwrap_or(ColumnLayout::FIRST)
        };
        let first = layout.point(line).map_err(|error| match known {
            Some(_) => error,
            None => error.cure(wording![
                "correct the line, name the columns with ",
                Setting::Columns,
                ", or put a header before it that names them: x y z"
            ]),
        })?;
        let first_column = if known.is_none() {
            FirstColumn::start(separator, line)
        } else {
            None
        };
        Ok(Start {
            layout,
            has_header,
            count,
            first: Some(first),
            first_column,
            mark,
        })
    }

    /// Returns what follows from the lines of a file that ends before the first point.
    fn without_points(self) -> Start {
        let named = self
            .named
            .or(self.commented.and_then(|(layout, _)| layout.ok()));
        Start {
            layout: self.asked.or(named).unwrap_or(ColumnLayout::FIRST),
            has_header: self.is_header_passed || named.is_some(),
            count: self.count,
            first: None,
            first_column: None,
            mark: DecimalMark::default(),
        }
    }
}

/// Returns true if the line is a single integer.
fn is_count(line: &[u8]) -> bool {
    let line = line.trim_ascii();
    !line.is_empty() && line.len() <= 18 && line.iter().all(u8::is_ascii_digit)
}

fn not_a_point(line: &[u8]) -> Error {
    let error = Error::format(format!("{} is neither a point nor a header", quote(line)));
    if line
        .trim_ascii_start()
        .to_ascii_lowercase()
        .starts_with(b"ncols")
    {
        return error.cure("an ESRI ASCII grid is a raster, not a list of points");
    }
    error.cure("expected x, y and z separated by semicolons, tabs, commas or blanks, or a header line that names them")
}
