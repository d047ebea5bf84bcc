//! Assigns the fields of a line to columns, and reads points from them.

use super::separator::{Axes, Separator};
use crate::data::{Columns, PointBatch};
use crate::error::{Error, Result, Setting, Wording, wording};

const X_NAMES: &[&str] = &[
    "x",
    "easting",
    "east",
    "e",
    "lon",
    "long",
    "longitude",
    "point_x",
];
const Y_NAMES: &[&str] = &["y", "northing", "north", "n", "lat", "latitude", "point_y"];
const Z_NAMES: &[&str] = &[
    "z",
    "elevation",
    "elev",
    "height",
    "h",
    "altitude",
    "alt",
    "point_z",
];
const CLASS_NAMES: &[&str] = &["class", "classification"];

const CURE: &str = "correct the line, or make it a comment with # at its beginning";

/// How a line is divided into fields, and which of them are used.
#[derive(Debug, Clone, Copy)]
pub(super) struct ColumnLayout {
    pub(super) separator: Separator,
    pub(super) columns: Columns,
}

pub(super) struct Point {
    x: f64,
    y: f64,
    /// NaN if only x and y are read.
    z: f64,
    class: Option<u8>,
}

impl Point {
    pub(super) fn position(&self) -> [f64; 3] {
        [self.x, self.y, self.z]
    }

    pub(super) fn push(&self, batch: &mut PointBatch) {
        batch.x.push(self.x);
        batch.y.push(self.y);
        batch.z.push(self.z);
        batch.class.extend(self.class);
    }
}

impl ColumnLayout {
    /// Returns the layout without a header.
    pub(super) fn first(axes: Axes) -> Self {
        ColumnLayout {
            separator: Separator::Blanks,
            columns: Columns {
                x: 1,
                y: 2,
                z: match axes {
                    Axes::Plan => None,
                    Axes::Space => Some(3),
                },
                class: None,
            },
        }
    }

    /// Returns the layout of a header line, by the names of the columns.
    ///
    /// # Errors
    /// Says which column is missing, or which two have the same name or are both heights.
    pub(super) fn named(
        header: &[u8],
        separator: Separator,
        axes: Axes,
    ) -> std::result::Result<Self, NameFlaw> {
        let names: Vec<String> = separator.fields(header).map(bare_name).collect();
        let find = |known: &[&str]| known.iter().find_map(|known| numbers(&names, known));
        let need = |axis: &str, known: &[&str]| {
            find(known).ok_or_else(|| {
                let error = Error::format(format!(
                    "no column for {axis} in the header {}",
                    quote(header)
                ))
                .cure(wording![
                    format!(
                        "call it one of {}, or name the columns with ",
                        known.join(", ")
                    ),
                    Setting::Columns
                ]);
                NameFlaw::Missing(error)
            })
        };
        let one = |numbers: Vec<usize>| match numbers[..] {
            [number] => Ok(number),
            _ => Err(NameFlaw::Repeated(repeated(&numbers, &names, header))),
        };
        let (x, y) = (need("x", X_NAMES)?, need("y", Y_NAMES)?);
        let z = match axes {
            Axes::Plan => None,
            Axes::Space => match several_heights(&names) {
                Some(numbers) => {
                    return Err(NameFlaw::Repeated(of_heights(&numbers, &names, header)));
                }
                None => Some(need("z", Z_NAMES)?),
            },
        };
        let columns = Columns {
            x: one(x)?,
            y: one(y)?,
            z: z.map(one).transpose()?,
            class: find(CLASS_NAMES).map(one).transpose()?,
        };
        Ok(ColumnLayout { separator, columns })
    }

    pub(super) fn point(&self, line: &[u8]) -> Result<Point> {
        let mut found: [&[u8]; 4] = [b""; 4];
        let Columns { x, y, z, class } = self.columns;
        let wanted = [Some(x), Some(y), z, class];
        let last = wanted.into_iter().flatten().fold(0, usize::max);
        let mut count = 0;
        for (number, field) in (1..=last).zip(self.separator.fields(line)) {
            count = number;
            for (slot, _) in found
                .iter_mut()
                .zip(wanted)
                .filter(|(_, column)| *column == Some(number))
            {
                *slot = field;
            }
        }
        if count < last {
            return Err(Error::format(format!(
                "{count} {} separated by {}, expected at least {last}: {}",
                if count == 1 { "field" } else { "fields" },
                self.separator.name(),
                quote(line)
            ))
            .cure(CURE));
        }
        Ok(Point {
            x: self.coordinate("x", found[0], line)?,
            y: self.coordinate("y", found[1], line)?,
            z: match z {
                Some(_) => self.coordinate("z", found[2], line)?,
                None => f64::NAN,
            },
            class: class.map(|_| self.class_code(found[3], line)).transpose()?,
        })
    }

    fn coordinate(&self, axis: &str, field: &[u8], line: &[u8]) -> Result<f64> {
        self.separator.number(field).ok_or_else(|| {
            Error::format(format!(
                "{axis} is {}, expected a finite number: {}",
                quote(field),
                quote(line)
            ))
            .cure(CURE)
        })
    }

    fn class_code(&self, field: &[u8], line: &[u8]) -> Result<u8> {
        let code = self
            .separator
            .number(field)
            .filter(|code| code.fract() == 0.0 && (0.0..=255.0).contains(code));
        code.map(|code| code as u8).ok_or_else(|| {
            Error::format(format!(
                "class is {}, expected a whole number from 0 to 255: {}",
                quote(field),
                quote(line)
            ))
            .cure(CURE)
        })
    }
}

/// Why a line does not name the columns of points.
#[derive(Debug)]
pub(super) enum NameFlaw {
    /// No column has a name for one of the coordinates.
    Missing(Error),
    /// Two columns have the same name, and it is one of those that are used, or both are heights.
    Repeated(Error),
}

impl From<NameFlaw> for Error {
    fn from(flaw: NameFlaw) -> Self {
        match flaw {
            NameFlaw::Missing(error) | NameFlaw::Repeated(error) => error,
        }
    }
}

/// Returns the numbers of the columns with a name, from 1; `None` if there are none.
fn numbers(names: &[String], wanted: &str) -> Option<Vec<usize>> {
    let found: Vec<usize> = (1..)
        .zip(names)
        .filter(|(_, name)| *name == wanted)
        .map(|(number, _)| number)
        .collect();
    (!found.is_empty()).then_some(found)
}

/// Returns the numbers of the columns that are heights by different names, none of which is `z`.
fn several_heights(names: &[String]) -> Option<Vec<usize>> {
    let mut found: Vec<usize> = Z_NAMES
        .iter()
        .filter_map(|known| numbers(names, known))
        .map(|numbers| numbers[0])
        .collect();
    found.sort_unstable();
    (found.len() > 1 && numbers(names, "z").is_none()).then_some(found)
}

#[cold]
fn of_heights(numbers: &[usize], names: &[String], header: &[u8]) -> Error {
    let named = |&number: &usize| format!("{number} (\"{}\")", names[number - 1]);
    let list: Vec<String> = numbers.iter().map(named).collect();
    Error::format(format!(
        "columns {} all have names of heights in the header {}",
        list.join(" and "),
        quote(header)
    ))
    .cure(rename_or_number())
}

fn rename_or_number() -> Wording {
    wording![
        "rename one of them, or say which columns to take: ",
        Setting::Columns.text("1,2,3"),
        " names those of x, y and z"
    ]
}

#[cold]
fn repeated(numbers: &[usize], names: &[String], header: &[u8]) -> Error {
    let name = numbers
        .first()
        .and_then(|first| names.get(first - 1))
        .map_or("", String::as_str);
    let list: Vec<String> = numbers.iter().map(usize::to_string).collect();
    let list = list.join(" and ");
    Error::format(format!(
        "columns {list} are both called \"{name}\" in the header {}",
        quote(header)
    ))
    .cure(rename_or_number())
}

/// Returns a name in lower case, without text in brackets.
fn bare_name(field: &[u8]) -> String {
    let text = String::from_utf8_lossy(field).to_lowercase();
    let end = text.find(['(', '[']).unwrap_or(text.len());
    text[..end].trim().to_owned()
}

/// Returns text for a message: on one line, and shortened.
pub(super) fn quote(text: &[u8]) -> String {
    const MAX_SHOWN: usize = 60;
    let text = text.trim_ascii();
    let shown = &text[..text.len().min(MAX_SHOWN)];
    let dots = if text.len() > MAX_SHOWN { "..." } else { "" };
    format!(
        "\"{}{dots}\"",
        String::from_utf8_lossy(shown).escape_debug()
    )
}
