//! The `.dbf` file: the names of the attributes, and the numbers in those that are requested.
//!
//! Real tables are sloppy: the field list has no terminator, row counts are wrong, the file ends
//! early. Whatever is unambiguous is read; anything else is an error here, and a warning for
//! readers that need no attribute.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use crate::data::{Value, named};
use crate::error::{Error, Result};
use crate::io::bytes::code_page::utf8_or_windows_1252;
use crate::io::bytes::decimal_mark::DecimalMark;
use crate::io::bytes::field::parse_number;

const END_OF_FIELDS: u8 = 0x0D;
const END_OF_FILE: u8 = 0x1A;
const DELETED: u8 = b'*';

/// The type of text, in which people write numbers as they like.
const TEXT: u8 = b'C';

/// A column.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Field {
    pub(super) name: String,
    /// The type letter.
    kind: u8,
    /// The decimals of numbers.
    decimals: u8,
    /// Offset in the row.
    at: usize,
    width: usize,
}

/// An open `.dbf`.
#[derive(Debug)]
pub(super) struct Table {
    file: BufReader<File>,
    /// The columns, in the order of the file.
    pub(super) fields: Vec<Field>,
    /// Length of a row in bytes, including its deletion flag.
    row: usize,
    /// Number of rows, as the header states it.
    pub(super) stated: u64,
    /// The text of the `.cpg` file.
    code_page: Option<String>,
}

/// The result of [`Table::rows`].
#[derive(Debug, Default, PartialEq)]
pub(super) struct Rows {
    /// For each row, true if it is marked as deleted.
    pub(super) deleted: Vec<bool>,
    /// The numbers of each field that was requested, in the order of the request.
    pub(super) numbers: Vec<Numbers>,
    /// For each row, the values of the fields that are kept as they are.
    pub(super) kept: Vec<Vec<Value>>,
}

/// The numbers of one field.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Numbers {
    /// The number in each row, NaN if there is none.
    pub(super) values: Vec<f64>,
    /// The texts that are not numbers, each with its row; in the order of the rows.
    pub(super) texts: Vec<(usize, String)>,
}

impl Numbers {
    /// Returns the text in a row, if it is not a number.
    pub(super) fn text(&self, row: usize) -> Option<&str> {
        let at = self
            .texts
            .binary_search_by_key(&row, |&(row, _)| row)
            .ok()?;
        Some(&self.texts.get(at)?.1)
    }
}

impl Table {
    /// Reads the header. `code_page` is the text of the `.cpg` file.
    ///
    /// # Errors
    /// If the rows cannot be separated.
    pub(super) fn open(path: &Path, code_page: Option<&str>) -> Result<Self> {
        let mut file = BufReader::new(File::open(path)?);
        let mut head = [0; 32];
        file.read_exact(&mut head)
            .map_err(|_| Error::format("shorter than the 32 bytes of a header"))?;
        let stated = u32::from_le_bytes([head[4], head[5], head[6], head[7]]);
        let header = usize::from(u16::from_le_bytes([head[8], head[9]]));
        let row = usize::from(u16::from_le_bytes([head[10], head[11]]));
        if head[0] & 7 == 4 {
            return Err(Error::unsupported("a table of dBase level 7"));
        }
        if header < 32 || row == 0 {
            return Err(Error::format(format!(
                "header of {header} bytes and rows of {row}"
            )));
        }
        let mut list = vec![0; header - 32];
        file.read_exact(&mut list)
            .map_err(|_| Error::format(format!("shorter than its header of {header} bytes")))?;
        let fields = fields(&list, row, code_page)?;
        Ok(Table {
            file,
            fields,
            row,
            stated: u64::from(stated),
            code_page: code_page.map(str::to_owned),
        })
    }

    /// Returns the field with this name: as written, else in any case.
    ///
    /// # Errors
    /// If there is none, or its type has no numbers; the message lists the fields.
    pub(super) fn find(&self, name: &str) -> Result<Field> {
        let names = self.fields.iter().map(|field| field.name.as_str());
        let field = named(names.clone(), name)
            .map(|at| &self.fields[at])
            .ok_or_else(|| crate::io::bytes::field::no_such_field(name, names))?;
        match (field.kind, field.width) {
            (b'N' | b'F' | b'C', _) | (b'I' | b'+', 4) | (b'B' | b'O' | b'Y', 8) => {
                Ok(field.clone())
            }
            (kind, width) => Err(Error::usage(format!(
                "field {} holds no numbers (its type is '{}', {width} bytes)",
                field.name,
                kind.escape_ascii()
            ))),
        }
    }

    /// Reads the existing rows, whatever their stated count, but at most `limit`: the numbers in
    /// these fields, and the values of those that are kept.
    ///
    /// # Errors
    /// If reading fails, or numbers of a field have different decimal marks.
    pub(super) fn rows(&mut self, fields: &[Field], kept: &[Field], limit: usize) -> Result<Rows> {
        let mut rows = Rows::default();
        rows.numbers.resize_with(fields.len(), Numbers::default);
        let mut marks: Vec<DecimalMark> = fields.iter().map(|_| DecimalMark::default()).collect();
        let needed = fields
            .iter()
            .map(|field| field.at + field.width)
            .min()
            .unwrap_or(1);
        let mut row = vec![0; self.row];
        while rows.deleted.len() < limit {
            let got = fill(&mut self.file, &mut row)?;
            // An incomplete last row still counts if it contains a field.
            let cut = got < row.len() && !matches!(row[0], b' ' | DELETED);
            if got < needed || cut || row[0] == END_OF_FILE {
                break;
            }
            rows.deleted.push(row[0] == DELETED);
            if !kept.is_empty() {
                let value = |field: &Field| {
                    let cell = row[..got].get(field.at..field.at + field.width);
                    value(field, cell.unwrap_or_default(), self.code_page.as_deref())
                };
                rows.kept.push(kept.iter().map(value).collect());
            }
            for ((field, numbers), mark) in fields.iter().zip(&mut rows.numbers).zip(&mut marks) {
                let cell = row[..got]
                    .get(field.at..field.at + field.width)
                    .unwrap_or_default();
                let location = || format!("row {}", numbers.values.len() + 1);
                let value = match number(field.kind, cell) {
                    Ok(value) => {
                        if field.kind == TEXT && !value.is_nan() && mark.concerns(cell) {
                            mark.add(cell.trim_ascii(), location)
                                .map_err(|e| e.within(format!("field {}", field.name)))?;
                        }
                        value
                    }
                    Err(text) => {
                        numbers.texts.push((numbers.values.len(), text));
                        f64::NAN
                    }
                };
                numbers.values.push(value);
            }
        }
        Ok(rows)
    }

    /// Returns the number of complete rows that the file has room for.
    pub(super) fn room(&mut self) -> Result<u64> {
        let here = self.file.stream_position()?;
        let end = self.file.seek(SeekFrom::End(0))?;
        self.file.seek(SeekFrom::Start(here))?;
        Ok(end.saturating_sub(here) / self.row as u64)
    }
}

/// Returns the fields of the descriptors in `list`, which ends at its terminator or, in sloppy
/// files, without one.
fn fields(list: &[u8], row: usize, code_page: Option<&str>) -> Result<Vec<Field>> {
    let descriptors: Vec<&[u8; 32]> = list
        .as_chunks::<32>()
        .0
        .iter()
        .take_while(|bytes| bytes[0] != END_OF_FIELDS && bytes[0] != 0)
        .collect();
    let plain = |bytes: &[u8; 32]| usize::from(bytes[16]);
    // For long texts, Clipper stores the high byte of the width where numbers have their decimals.
    let long = |bytes: &[u8; 32]| {
        plain(bytes)
            + if bytes[11] == b'C' {
                usize::from(bytes[17]) << 8
            } else {
                0
            }
    };
    let sum = |width: &dyn Fn(&[u8; 32]) -> usize| {
        1 + descriptors.iter().map(|bytes| width(bytes)).sum::<usize>()
    };
    let width: &dyn Fn(&[u8; 32]) -> usize = match row {
        _ if sum(&plain) == row => &plain,
        _ if sum(&long) == row => &long,
        _ => {
            return Err(Error::format(format!(
                "its fields take {} bytes of a row, its rows have {row}",
                sum(&plain)
            )));
        }
    };
    let mut at = 1;
    Ok(descriptors
        .iter()
        .map(|bytes| {
            let name = bytes[..11].split(|&b| b == 0).next().unwrap_or_default();
            let field = Field {
                name: decode(name, code_page),
                kind: bytes[11],
                decimals: bytes[17],
                at,
                width: width(bytes),
            };
            at += field.width;
            field
        })
        .collect())
}

/// Decodes text in the encoding of the `.cpg` file; without one, as UTF-8 if valid, else as
/// Windows-1252.
fn decode(bytes: &[u8], code_page: Option<&str>) -> String {
    let utf8 = code_page.is_some_and(|page| {
        matches!(
            page.trim().to_ascii_uppercase().as_str(),
            "UTF-8" | "UTF8" | "65001"
        )
    });
    let text = match utf8 {
        true => String::from_utf8_lossy(bytes).into_owned(),
        false => utf8_or_windows_1252(bytes),
    };
    text.trim().to_owned()
}

/// Parses the number in a cell. It is NaN if the cell is empty or filled with stars (a number did
/// not fit). If the cell contains something else, the error is its text.
fn number(kind: u8, cell: &[u8]) -> std::result::Result<f64, String> {
    if let (b'I' | b'+', Ok(bytes)) = (kind, cell.try_into()) {
        return Ok(f64::from(i32::from_le_bytes(bytes)));
    }
    if let (b'B' | b'O' | b'Y', Ok(bytes)) = (kind, cell.try_into()) {
        return Ok(match kind {
            b'Y' => i64::from_le_bytes(bytes) as f64 / 10_000.0,
            _ => f64::from_le_bytes(bytes),
        });
    }
    let text = String::from_utf8_lossy(cell);
    parse_number(text.trim_matches(|c: char| c.is_whitespace() || c == '\0'))
}

/// Returns the value in a cell. Types that have no texts and no numbers (memos and pictures, which
/// are in another file) are missing.
fn value(field: &Field, cell: &[u8], code_page: Option<&str>) -> Value {
    let text = || decode(cell, code_page).trim_matches('\0').trim().to_owned();
    match field.kind {
        b'C' => match text() {
            text if text.is_empty() => Value::Missing,
            text => Value::Text(text),
        },
        b'D' => date(&text()),
        b'L' => match cell.first() {
            Some(b'T' | b't' | b'Y' | b'y') => Value::Truth(true),
            Some(b'F' | b'f' | b'N' | b'n') => Value::Truth(false),
            _ => Value::Missing,
        },
        b'N' | b'F' if field.decimals == 0 && text().parse::<i64>().is_ok() => {
            text().parse().map_or(Value::Missing, Value::Whole)
        }
        b'I' | b'+' => match number(field.kind, cell) {
            Ok(number) if number.is_finite() => Value::Whole(number as i64),
            _ => Value::Missing,
        },
        b'N' | b'F' | b'B' | b'O' | b'Y' => match number(field.kind, cell) {
            Ok(number) if number.is_finite() => Value::Number(number),
            Ok(_) => Value::Missing,
            Err(text) => Value::Text(text),
        },
        _ => Value::Missing,
    }
}

/// Returns a date of eight digits with hyphens.
fn date(text: &str) -> Value {
    match (text.get(..4), text.get(4..6), text.get(6..8)) {
        (Some(year), Some(month), Some(day)) if text.len() == 8 => {
            Value::Text(format!("{year}-{month}-{day}"))
        }
        _ if text.is_empty() => Value::Missing,
        _ => Value::Text(text.to_owned()),
    }
}

/// Reads until the buffer is full or the file ends; returns the number of bytes read.
fn fill(file: &mut impl Read, buffer: &mut [u8]) -> Result<usize> {
    let mut got = 0;
    while got < buffer.len() {
        match file.read(&mut buffer[got..]) {
            Ok(0) => break,
            Ok(n) => got += n,
            Err(e) if e.kind() == std::io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e.into()),
        }
    }
    Ok(got)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    fn table(
        fields: &[(&str, u8, u8)],
        terminator: &[u8],
        rows: &[&str],
        stated: u32,
    ) -> tempfile::NamedTempFile {
        let row: usize = 1 + fields.iter().map(|f| usize::from(f.2)).sum::<usize>();
        let mut bytes = vec![3, 70, 1, 1];
        bytes.extend(stated.to_le_bytes());
        bytes.extend(((32 + 32 * fields.len() + terminator.len()) as u16).to_le_bytes());
        bytes.extend((row as u16).to_le_bytes());
        bytes.resize(32, 0);
        for (name, kind, width) in fields {
            let from = bytes.len();
            bytes.extend(name.bytes());
            bytes.resize(from + 11, 0);
            bytes.push(*kind);
            bytes.resize(from + 16, 0);
            bytes.push(*width);
            bytes.resize(from + 32, 0);
        }
        bytes.extend(terminator);
        rows.iter().for_each(|row| bytes.extend(row.bytes()));
        let mut file = tempfile::NamedTempFile::new().unwrap();
        file.write_all(&bytes).unwrap();
        file
    }

    fn rows(file: &tempfile::NamedTempFile, names: &[&str]) -> Rows {
        let mut table = Table::open(file.path(), None).unwrap();
        let fields: Vec<Field> = names.iter().map(|name| table.find(name).unwrap()).collect();
        table.rows(&fields, &[], 100).unwrap()
    }

    fn values(file: &tempfile::NamedTempFile, name: &str) -> Vec<f64> {
        rows(file, &[name]).numbers.remove(0).values
    }

    #[test]
    fn numbers_in_all_dresses() {
        let lines = [
            "   12.5   ab",
            " -3,25  1e2 ",
            " ******     ",
            "*1      no  ",
            "        7\0\0\0",
        ];
        let file = table(&[("ELEV", b'N', 7), ("TEXT", b'C', 4)], b"\r", &lines, 5);
        let found = rows(&file, &["elev", "Text"]);
        assert_eq!(found.deleted, [false, false, false, true, false]);
        let [heights, texts] = &found.numbers[..] else {
            panic!("{found:?}")
        };
        assert_eq!(heights.values[..2], [12.5, -3.25]);
        assert!(heights.values[2].is_nan() && heights.values[4].is_nan());
        assert_eq!(texts.texts, [(0, "ab".to_owned()), (3, "no".to_owned())]);
        assert_eq!((texts.text(3), texts.text(1)), (Some("no"), None));
        assert_eq!((texts.values[1], texts.values[4]), (100.0, 7.0));
    }

    #[test]
    fn texts_with_different_decimal_marks_are_refused() {
        let file = table(
            &[("TEXT", b'C', 7)],
            b"\r",
            &[" 500,000", "        ", " 3.5    "],
            3,
        );
        let mut opened = Table::open(file.path(), None).unwrap();
        let field = opened.find("TEXT").unwrap();
        let error = opened.rows(&[field], &[], 100).unwrap_err().to_string();
        assert!(
            error.starts_with(
                "field TEXT, row 3: 3.5 has a point and 500,000, in row 1, has a comma"
            ),
            "{error}"
        );
    }

    #[test]
    fn sloppy_headers_and_counts() {
        for terminator in [&b"\r"[..], b"\n", b"", b"\r\0"] {
            for stated in [0, 2, 99] {
                let file = table(
                    &[("Z", b'N', 3)],
                    terminator,
                    &["   1", "   2", "\u{1a}"],
                    stated,
                );
                assert_eq!(values(&file, "z"), [1.0, 2.0], "{terminator:?} {stated}");
            }
        }
        // The last row is cut, after the field and within it.
        let file = table(
            &[("Z", b'N', 2), ("T", b'C', 3)],
            b"\r",
            &[" 10abc", " 20a"],
            2,
        );
        assert_eq!((values(&file, "Z").len(), values(&file, "T").len()), (2, 1));
        let both = rows(&file, &["T", "Z"]);
        assert_eq!(both.numbers[1].values, [10.0, 20.0]);
        assert!(both.numbers[0].values[1].is_nan() && both.numbers[0].text(1).is_none());
        assert_eq!(Table::open(file.path(), None).unwrap().room().unwrap(), 1);
    }

    #[test]
    fn rows_that_cannot_be_placed_are_refused() {
        let file = table(&[("Z", b'N', 3)], b"\r", &["   1"], 1);
        let mut bytes = std::fs::read(file.path()).unwrap();
        bytes[10] = 7;
        let mut bad = tempfile::NamedTempFile::new().unwrap();
        bad.write_all(&bytes).unwrap();
        let text = Table::open(bad.path(), None).unwrap_err().to_string();
        assert_eq!(text, "its fields take 4 bytes of a row, its rows have 7");
        for cut in 0..65 {
            let mut bad = tempfile::NamedTempFile::new().unwrap();
            bad.write_all(&bytes[..cut]).unwrap();
            assert!(Table::open(bad.path(), None).is_err(), "cut at {cut}");
        }
    }

    #[test]
    fn values_are_kept_by_the_type_of_their_field() {
        let fields = [
            ("WHOLE", b'N', 4),
            ("TEXT", b'C', 6),
            ("DAY", b'D', 8),
            ("OPEN", b'L', 1),
            ("MEMO", b'M', 4),
        ];
        let lines = [
            "   12Höhe 20240531T   1",
            "  1,5      2024    ?    ",
            " ****x                  ",
        ];
        let file = table(&fields, b"\r", &lines, 3);
        let mut table = Table::open(file.path(), Some("UTF-8")).unwrap();
        let kept = table.fields.clone();
        let found = table.rows(&[], &kept, 100).unwrap().kept;
        let text = |text: &str| Value::Text(text.to_owned());
        let day = text("2024-05-31");
        assert_eq!(
            found[0],
            [
                Value::Whole(12),
                text("Höhe"),
                day,
                Value::Truth(true),
                Value::Missing
            ]
        );
        assert_eq!(found[1][0], Value::Number(1.5));
        assert_eq!(
            found[1][1..],
            [Value::Missing, text("2024"), Value::Missing, Value::Missing]
        );
        assert_eq!(found[2][..2], [Value::Missing, text("x")]);
    }

    #[test]
    fn unknown_fields_and_types() {
        let file = table(&[("Z", b'N', 3), ("DAY", b'D', 8)], b"\r", &[], 0);
        let table = Table::open(file.path(), None).unwrap();
        let error = table.find("ELEV").unwrap_err();
        assert_eq!(error.to_string(), "there is no field ELEV");
        assert_eq!(*error.cure_text().unwrap(), "name one of Z, DAY");
        assert_eq!(
            table.find("day").unwrap_err().to_string(),
            "field DAY holds no numbers (its type is 'D', 8 bytes)"
        );
    }

    #[test]
    fn names_in_their_encoding() {
        assert_eq!(decode(b"H\xf6he", None), "Höhe");
        assert_eq!(decode("Höhe".as_bytes(), None), "Höhe");
        assert_eq!(decode(b"\x80", Some("1252")), "€");
        assert_eq!(decode(b"H\xf6he", Some("utf-8")), "H\u{fffd}he");
    }
}
