//! A shapefile as it is, with fields appended to its table.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use super::header::HEADER;
use super::sibling;
use crate::error::{Error, Result, Setting, wording};
use crate::io::bytes::output::{Destination, Output};

/// The type of numbers in text.
const NUMBER: u8 = b'N';

/// Bytes of a number: enough for all digits of a double, its sign and its exponent.
const WIDTH: usize = 24;

/// The decimals that a description states.
const DECIMALS: u8 = 15;

/// Bytes of a name, without the zero after it.
const NAME: usize = 10;

const END_OF_FIELDS: u8 = 0x0D;

/// Bytes of a header before its fields, and of the description of a field.
const BLOCK: usize = 32;

/// Writes a shapefile with numbers appended to each row of its table; NaN is an empty field. All
/// other bytes are copied: `.shp`, `.shx`, `.prj`, `.cpg`, and the rows of the `.dbf`.
///
/// `numbers` has those of all rows, as many for each as there are names.
///
/// # Errors
/// If the table is missing or has more or fewer rows than there are records, the index lists these
/// in another order, a name is taken or longer than 10 bytes, or a file cannot be read or written.
pub fn append_fields(
    path: &Path,
    records: usize,
    names: &[String],
    numbers: &[f64],
    target: Destination,
) -> Result<()> {
    let Some(table) = sibling(path, "dbf") else {
        return Err(Error::format("the shapefile has no .dbf")
            .in_file(path)
            .cure("copy all of its files"));
    };
    if let Some(index) = sibling(path, "shx") {
        check_order(&index).map_err(|e| e.in_file(&index))?;
    }
    let mut companions = Vec::new();
    let mut output = None;
    for extension in ["shx", "prj", "cpg", "shp"] {
        let source = match extension {
            "shp" => path.to_path_buf(),
            _ => match sibling(path, extension) {
                Some(source) => source,
                None => continue,
            },
        };
        let copied = copy(&source, &target.path().with_extension(extension), target)?;
        match extension {
            "shp" => output = Some(copied),
            _ => companions.push(copied),
        }
    }
    let mut written = target.create_beside(&target.path().with_extension("dbf"))?;
    append(&table, records, names, numbers, &mut written).map_err(|e| e.in_file(&table))?;
    companions.push(written);
    let Some(output) = output else {
        return Err(Error::usage("no shapefile").in_file(path));
    };
    // A file of the target that the source does not have would be wrong beside it.
    let is_stale = |extension: &&&str| sibling(path, extension).is_none();
    let stale: Vec<PathBuf> = ["prj", "cpg", "shx"]
        .iter()
        .filter(is_stale)
        .map(|extension| target.path().with_extension(extension))
        .collect();
    target.put_all(companions, output, stale)
}

/// Returns an error unless an index lists records in the order in which they are in the `.shp`:
/// rows are in the order of the index.
fn check_order(index: &Path) -> Result<()> {
    let bytes = std::fs::read(index)?;
    let entries = bytes
        .get(HEADER as usize..)
        .unwrap_or_default()
        .as_chunks::<8>()
        .0;
    let start = |entry: &[u8; 8]| u32::from_be_bytes([entry[0], entry[1], entry[2], entry[3]]);
    match entries.is_sorted_by(|one, next| start(one) < start(next)) {
        true => Ok(()),
        false => Err(
            Error::unsupported("the records are not in the order of the .shp")
                .cure("save the shapefile anew"),
        ),
    }
}

fn copy(source: &Path, path: &Path, target: Destination) -> Result<Output> {
    let mut file = File::open(source).map_err(|e| Error::from(e).in_file(source))?;
    let mut output = target.create_beside(path)?;
    std::io::copy(&mut file, &mut output).map_err(|e| Error::from(e).in_file(path))?;
    Ok(output)
}

/// Writes a table with numbers appended to each row.
fn append(
    table: &Path,
    records: usize,
    names: &[String],
    numbers: &[f64],
    out: &mut dyn Write,
) -> Result<()> {
    let mut file = BufReader::new(File::open(table)?);
    let mut head = vec![0; BLOCK];
    fill(&mut file, &mut head, || "its header".to_owned())?;
    let word = |at: usize| usize::from(u16::from_le_bytes([head[at], head[at + 1]]));
    let (length, row) = (word(8), word(10));
    let rows = u32::from_le_bytes([head[4], head[5], head[6], head[7]]) as usize;
    if length < BLOCK || row == 0 || rows != records {
        return Err(Error::format(format!(
            "a header of {length} bytes and {rows} rows of {row}, but {records} records in the .shp"
        ))
        .cure("save the shapefile anew: records and rows have to agree"));
    }
    let mut list = vec![0; length - BLOCK];
    fill(&mut file, &mut list, || "its list of fields".to_owned())?;
    let fields: Vec<&[u8; BLOCK]> = list
        .as_chunks::<BLOCK>()
        .0
        .iter()
        .take_while(|field| field[0] != END_OF_FIELDS)
        .collect();
    check_names(&fields, names)?;
    let end = fields.len() * BLOCK;
    let too_long = || {
        Error::limit("too many fields for a .dbf")
            .cure("add fewer columns, or write the points as text")
    };
    let length = u16::try_from(length + names.len() * BLOCK).map_err(|_| too_long())?;
    let new_row = u16::try_from(row + names.len() * WIDTH).map_err(|_| too_long())?;
    head[8..10].copy_from_slice(&length.to_le_bytes());
    head[10..12].copy_from_slice(&new_row.to_le_bytes());
    out.write_all(&head)?;
    out.write_all(&list[..end])?;
    for name in names {
        out.write_all(&described(name))?;
    }
    out.write_all(&list[end..])?;
    let mut bytes = vec![0; row];
    let count = names.len();
    for at in 0..records {
        fill(&mut file, &mut bytes, || {
            format!("row {} of {records}", at + 1)
        })?;
        out.write_all(&bytes)?;
        for number in numbers.iter().skip(at * count).take(count) {
            out.write_all(&shown(*number))?;
        }
    }
    std::io::copy(&mut file, out)?;
    Ok(())
}

/// Reads as many bytes as there is room for.
///
/// # Errors
/// If the table ends before, in the part that a function names.
fn fill(file: &mut impl Read, bytes: &mut [u8], part: impl FnOnce() -> String) -> Result<()> {
    file.read_exact(bytes).map_err(|error| match error.kind() {
        ErrorKind::UnexpectedEof => Error::format(format!("the table ends in {}", part()))
            .cure("copy all files of the shapefile again"),
        _ => error.into(),
    })
}

fn check_names(fields: &[&[u8; BLOCK]], names: &[String]) -> Result<()> {
    for name in names {
        if name.len() > NAME {
            return Err(Error::usage(format!(
                "the name {name} has more than the {NAME} bytes of a field of a .dbf"
            ))
            .cure(wording!["shorten ", Setting::Prefix]));
        }
        if has_field(fields, name) {
            let error = Error::usage(format!("there is a field {name} already"));
            return Err(error.cure(match free_prefix(fields, names) {
                Some(prefix) => wording![
                    "give the new ones other names with ",
                    Setting::Prefix.text(prefix),
                    ", or rename the field"
                ],
                None => wording![
                    "rename the field, or give the new ones names of 10 bytes at most with ",
                    Setting::Prefix
                ],
            }));
        }
    }
    Ok(())
}

fn has_field(fields: &[&[u8; BLOCK]], name: &str) -> bool {
    fields.iter().any(|field| {
        let end = field.iter().position(|&byte| byte == 0).unwrap_or(NAME);
        field[..end.min(NAME + 1)].eq_ignore_ascii_case(name.as_bytes())
    })
}

/// Returns a letter before which all names are short enough and new, if there is one.
fn free_prefix(fields: &[&[u8; BLOCK]], names: &[String]) -> Option<String> {
    let is_free = |prefix: &String| {
        names.iter().all(|name| {
            let name = format!("{prefix}{name}");
            name.len() <= NAME && !has_field(fields, &name)
        })
    };
    ('n'..='z').map(String::from).find(is_free)
}

/// Returns the description of a field of numbers.
fn described(name: &str) -> [u8; BLOCK] {
    let mut field = [0; BLOCK];
    field
        .iter_mut()
        .zip(name.bytes())
        .for_each(|(slot, byte)| *slot = byte);
    field[11] = NUMBER;
    field[16] = WIDTH as u8;
    field[17] = DECIMALS;
    field
}

/// Returns a number with all its digits, to the right; blanks if it is NaN.
fn shown(number: f64) -> [u8; WIDTH] {
    let mut text = match number.is_nan() {
        true => String::new(),
        false => number.to_string(),
    };
    if text.len() > WIDTH {
        text = format!("{number:e}");
    }
    let mut cell = [b' '; WIDTH];
    let start = WIDTH.saturating_sub(text.len());
    cell[start..]
        .iter_mut()
        .zip(text.bytes())
        .for_each(|(slot, byte)| *slot = byte);
    cell
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_all_their_digits() {
        for number in [
            0.1,
            -812.123_456_789_012_3,
            1e-300,
            -2.225_073_858_507_201_4e-308,
            f64::MAX,
            f64::MIN_POSITIVE,
            0.0,
        ] {
            let cell = shown(number);
            let text = std::str::from_utf8(&cell).unwrap();
            assert_eq!(
                text.trim().parse::<f64>().unwrap().to_bits(),
                number.to_bits()
            );
        }
        assert_eq!(shown(f64::NAN), [b' '; WIDTH]);
    }
}
