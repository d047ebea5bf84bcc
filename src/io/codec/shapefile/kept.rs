//! Attributes that are kept: from their values to the fields of a table.

use std::collections::BTreeSet;

use super::number::{NUMBER_WIDTH, decimals, real};
use crate::data::{Attributes, Value};
use crate::error::{Error, Result};

/// The bytes of a name, at most.
const NAME: usize = 10;

/// The bytes of a text, at most.
const TEXT: usize = 254;

/// The digits of a whole number that other programs read, at most.
const DIGITS: usize = 18;

/// Up to this, all whole numbers are floating-point numbers.
const EXACT: u64 = 1 << 53;

/// The bytes of a row, at most.
const ROW: usize = u16::MAX as usize;

/// The fields of a table, at most: their descriptors are in a header of 65 535 bytes.
const FIELDS: usize = 2046;

/// An attribute as a field of a table.
#[derive(Debug)]
pub(super) struct KeptColumn {
    name: String,
    kind: u8,
    width: usize,
    decimals: u8,
}

/// Returns the fields for attributes. Adds a warning for each name and for the texts that are cut.
///
/// # Errors
/// If there are more attributes than a table has room for.
pub(super) fn columns(
    attributes: &Attributes,
    warnings: &mut Vec<String>,
) -> Result<Vec<KeptColumn>> {
    let mut taken = BTreeSet::new();
    let mut columns = Vec::new();
    for (number, name) in attributes.names.iter().enumerate() {
        let short = short_name(name, &taken);
        if short != *name {
            warnings.push(format!("attribute {name} is called {short}"));
        }
        taken.insert(short.to_ascii_uppercase());
        let (column, cut) = column(short, attributes, number);
        if cut > 0 {
            warnings.push(format!(
                "attribute {name}: {cut} texts are cut to {TEXT} bytes"
            ));
        }
        columns.push(column);
    }
    let row = 1 + columns.iter().map(|column| column.width).sum::<usize>();
    if columns.len() > FIELDS || row > ROW {
        return Err(Error::limit(format!(
            "{} attributes take {row} bytes of a row; a shapefile has at most {FIELDS}, in {ROW} bytes",
            columns.len()
        ))
        .cure("write GeoJSON"));
    }
    Ok(columns)
}

/// Returns a name of at most ten bytes that is not taken, in any case.
fn short_name(name: &str, taken: &BTreeSet<String>) -> String {
    let start = |bytes: usize| {
        let end = (0..=bytes.min(name.len()))
            .rev()
            .find(|&end| name.is_char_boundary(end));
        &name[..end.unwrap_or(0)]
    };
    let is_free =
        |short: &String| !short.is_empty() && !taken.contains(&short.to_ascii_uppercase());
    let numbered = (1..).map(|number| {
        let number = format!("_{number}");
        format!("{}{number}", start(NAME.saturating_sub(number.len())))
    });
    std::iter::once(start(NAME).to_owned())
        .chain(numbered)
        .find(is_free)
        .unwrap_or_default()
}

/// Returns the field for an attribute, and how many texts are cut.
fn column(name: String, attributes: &Attributes, number: usize) -> (KeptColumn, usize) {
    let of = |kind, width| KeptColumn {
        name: name.clone(),
        kind,
        width,
        decimals: 0,
    };
    let values = || {
        attributes
            .column(number)
            .filter(|value| **value != Value::Missing)
    };
    let all = |is: fn(&Value) -> bool| values().all(is);
    let has_values = values().next().is_some();
    let longest = || values().map(|value| value.text().len()).max().unwrap_or(0);
    if has_values && all(|value| matches!(value, Value::Truth(_))) {
        return (of(b'L', 1), 0);
    }
    let is_whole = has_values && all(|value| matches!(value, Value::Whole(_)));
    if is_whole && longest() <= DIGITS {
        return (of(b'N', longest()), 0);
    }
    // A field of floating-point numbers would change larger whole numbers silently.
    let is_number = |value: &Value| match value {
        Value::Whole(whole) => whole.unsigned_abs() <= EXACT,
        Value::Number(_) => true,
        _ => false,
    };
    if has_values && all(is_number) {
        let numbers = values().filter_map(|value| match value {
            Value::Number(number) => Some(*number),
            _ => None,
        });
        let field = KeptColumn {
            decimals: decimals(numbers),
            ..of(b'F', usize::from(NUMBER_WIDTH))
        };
        return (field, 0);
    }
    let cut = values().filter(|value| value.text().len() > TEXT).count();
    (of(b'C', longest().clamp(1, TEXT)), cut)
}

impl KeptColumn {
    /// Returns the field descriptor of the `.dbf`.
    pub(super) fn descriptor(&self) -> [u8; 32] {
        let mut bytes = [0; 32];
        bytes[..self.name.len()].copy_from_slice(self.name.as_bytes());
        bytes[11] = self.kind;
        bytes[16] = self.width as u8;
        bytes[17] = self.decimals;
        bytes
    }

    /// Returns a value in the full width of the field.
    pub(super) fn cell(&self, value: &Value) -> String {
        let width = self.width;
        match (self.kind, value) {
            (b'L', Value::Truth(truth)) => (if *truth { "T" } else { "F" }).to_owned(),
            (b'L', _) => "?".to_owned(),
            (b'F', Value::Whole(whole)) => real(*whole as f64),
            (b'F', Value::Number(number)) => real(*number),
            (b'N', Value::Whole(whole)) => format!("{whole:>width$}"),
            (b'C', value) => {
                let mut text = value.text();
                while text.len() > width {
                    text.pop();
                }
                // In bytes, which are more than characters.
                text.push_str(&" ".repeat(width - text.len()));
                text
            }
            _ => " ".repeat(width),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_stay_what_they_are() {
        let exact = (1 << 53) + 1;
        for (values, kind) in [
            (vec![Value::Whole(exact), Value::Missing], b'N'),
            (vec![Value::Whole(7), Value::Number(0.5)], b'F'),
            (vec![Value::Whole(-(1 << 53)), Value::Number(0.5)], b'F'),
            (vec![Value::Whole(exact), Value::Number(0.5)], b'C'),
            (vec![Value::Whole(-exact), Value::Number(0.5)], b'C'),
            (vec![Value::Whole(i64::MIN)], b'C'),
        ] {
            let attributes = Attributes {
                names: vec!["id".to_owned()],
                rows: values.iter().map(|value| vec![value.clone()]).collect(),
            };
            let columns = columns(&attributes, &mut Vec::new()).unwrap();
            assert_eq!(columns[0].kind, kind, "{values:?}");
            for value in values {
                if let Value::Whole(whole) = value {
                    let cell = columns[0].cell(&value);
                    let cell = cell.trim();
                    match kind {
                        b'F' => assert_eq!(cell.parse::<f64>().unwrap(), whole as f64),
                        _ => assert_eq!(cell, whole.to_string()),
                    }
                }
            }
        }
    }
}
