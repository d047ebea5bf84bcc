//! The lines up to the first point: what they state, and the columns that follow from it.

use super::columns::{ColumnLayout, NameFlaw, Point, quote};
use super::first_column::FirstColumn;
use super::lines::{Line, Lines};
use super::separator::{Axes, Separator};
use crate::data::Columns;
use crate::error::{Error, Result, Setting, wording};
use crate::io::bytes::decimal_mark::DecimalMark;

/// The result of reading the first lines.
pub(super) struct Start {
    pub(super) layout: ColumnLayout,
    /// The number of the line with the names of the columns, from 1.
    pub(super) header: Option<u64>,
    pub(super) count: Option<u64>,
    pub(super) first: Option<Point>,
    pub(super) first_column: Option<FirstColumn>,
    pub(super) mark: DecimalMark,
}

impl Start {
    /// Reads the lines up to the first point, which is then the current line. `see` is called with
    /// each of them.
    ///
    /// # Errors
    /// If a line is neither a header nor a point, and those of `see`.
    pub(super) fn read(
        lines: &mut Lines,
        columns: Option<Columns>,
        axes: Axes,
        see: &mut dyn FnMut(&Lines) -> Result<()>,
    ) -> Result<Self> {
        let asked = columns
            .map(|columns| layout_for(columns, axes))
            .transpose()?;
        let mut head = Head::new(asked, axes);
        while lines.next()? {
            see(lines)?;
            match Line::new(&lines.line) {
                Line::Blank => {}
                Line::Comment(text) => head.add_comment(text, lines.number),
                Line::Data(line) => {
                    if let Some(separator) = head.add_line(line, lines.number)? {
                        return head.with_point(separator, line, lines.number);
                    }
                }
            }
        }
        Ok(head.without_points())
    }
}

/// What is known before the first point.
struct Head {
    axes: Axes,
    /// The layout that the caller gives.
    asked: Option<ColumnLayout>,
    /// The layout that a header names.
    named: Option<ColumnLayout>,
    /// The layout that a comment names.
    commented: Option<Commented>,
    /// The number of the header.
    header: Option<u64>,
    /// The number of points that a line states.
    count: Option<u64>,
}

/// A comment that names columns.
struct Commented {
    layout: std::result::Result<ColumnLayout, NameFlaw>,
    /// How many names it has.
    names: usize,
    /// The number of the line.
    number: u64,
}

impl Head {
    fn new(asked: Option<ColumnLayout>, axes: Axes) -> Self {
        Head {
            axes,
            asked,
            named: None,
            commented: None,
            header: None,
            count: None,
        }
    }

    /// Adds a comment, which may name the columns.
    fn add_comment(&mut self, text: &[u8], number: u64) {
        let names = text.rsplit(|&byte| byte == b':').next().unwrap_or(text);
        if let Some(separator) = Separator::guess(names, self.axes)
            && let layout @ (Ok(_) | Err(NameFlaw::Repeated(_))) =
                ColumnLayout::named(names, separator, self.axes)
        {
            self.commented = Some(Commented {
                layout,
                names: separator.fields(names).count(),
                number,
            });
        }
    }

    /// Adds a line that is the count of points or a header. Returns the separator if it is a point.
    fn add_line(&mut self, line: &[u8], number: u64) -> Result<Option<Separator>> {
        if self.count.is_none() && is_count(line) {
            self.count = std::str::from_utf8(line)
                .ok()
                .and_then(|text| text.trim().parse().ok());
            return Ok(None);
        }
        let separator =
            Separator::guess(line, self.axes).ok_or_else(|| not_a_point(line, self.axes))?;
        if separator.has_two_uses(line, self.axes) {
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
            None => Some(ColumnLayout::named(line, separator, self.axes)?),
            Some(_) if self.header.is_some() => return Err(not_a_point(line, self.axes)),
            Some(_) => None,
        };
        self.header = Some(number);
        Ok(None)
    }

    /// Returns what follows from all lines before a point, and from its own.
    fn with_point(self, separator: Separator, line: &[u8], number: u64) -> Result<Start> {
        let Head {
            axes,
            asked,
            named,
            commented,
            header,
            count,
        } = self;
        // A comment with more words than a line has fields is prose.
        let commented = commented.filter(|comment| comment.names <= separator.fields(line).count());
        let header = header.or(commented.as_ref().map(|comment| comment.number));
        let named = match commented {
            Some(comment) if named.is_none() && asked.is_none() => Some(comment.layout?),
            _ => named,
        };
        let mut mark = DecimalMark::default();
        separator.add_marks(&mut mark, line, number)?;
        let known = asked.or(named);
        let layout = ColumnLayout {
            separator,
            ..known.unwrap_or(ColumnLayout::first(axes))
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
            header,
            count,
            first: Some(first),
            first_column,
            mark,
        })
    }

    /// Returns what follows from the lines of a file that ends before the first point.
    fn without_points(self) -> Start {
        let commented = self.commented;
        let of_comment = commented.and_then(|comment| Some((comment.layout.ok()?, comment.number)));
        let named = self.named.or(of_comment.map(|(layout, _)| layout));
        Start {
            layout: self
                .asked
                .or(named)
                .unwrap_or(ColumnLayout::first(self.axes)),
            header: self.header.or(of_comment.map(|(_, number)| number)),
            count: self.count,
            first: None,
            first_column: None,
            mark: DecimalMark::default(),
        }
    }
}

/// Returns the layout of columns that the caller gives.
///
/// # Errors
/// If heights are needed, and no column has them.
fn layout_for(columns: Columns, axes: Axes) -> Result<ColumnLayout> {
    let z = match axes {
        Axes::Plan => None,
        Axes::Space if columns.z.is_none() => {
            return Err(
                Error::usage(format!("no column has heights: {columns}")).cure(wording![
                    "name that of z, too, such as ",
                    Setting::Columns.text("1,2,3")
                ]),
            );
        }
        Axes::Space => columns.z,
    };
    Ok(ColumnLayout {
        columns: Columns { z, ..columns },
        ..ColumnLayout::first(axes)
    })
}

/// Returns true if the line is a single integer.
fn is_count(line: &[u8]) -> bool {
    let line = line.trim_ascii();
    !line.is_empty() && line.len() <= 18 && line.iter().all(u8::is_ascii_digit)
}

fn not_a_point(line: &[u8], axes: Axes) -> Error {
    let error = Error::format(format!("{} is neither a point nor a header", quote(line)));
    if line
        .trim_ascii_start()
        .to_ascii_lowercase()
        .starts_with(b"ncols")
    {
        return error.cure("an ESRI ASCII grid is a raster, not a list of points");
    }
    let needed = match axes {
        Axes::Plan => "x and y",
        Axes::Space => "x, y and z",
    };
    error.cure(format!(
        "expected {needed} separated by semicolons, tabs, commas or blanks, or a header line that names them"
    ))
}
