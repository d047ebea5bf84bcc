//! NetCDF's classic format: the header, and the values of a variable.

use std::collections::HashMap;

use crate::error::{Error, Result};

/// Types of numbers.
pub(super) const CHAR: u32 = 2;
pub(super) const INT: u32 = 4;
pub(super) const DOUBLE: u32 = 6;

/// Lists of a header.
pub(super) const DIMENSIONS: u32 = 10;
pub(super) const VARIABLES: u32 = 11;
pub(super) const ATTRIBUTES: u32 = 12;

/// The values of attributes: texts, and the first of numbers.
pub(super) enum Attribute {
    Text(String),
    Number(f64),
}

type Attributes = HashMap<String, Attribute>;

pub(super) struct Variable {
    pub(super) name: String,
    /// The numbers of its dimensions.
    pub(super) dimensions: Vec<usize>,
    attributes: Attributes,
    kind: u32,
    begin: u64,
}

impl Variable {
    pub(super) fn text(&self, name: &str) -> Option<&str> {
        match self.attributes.get(name)? {
            Attribute::Text(text) => Some(text.trim_matches(['\0', ' '])),
            Attribute::Number(_) => None,
        }
    }

    pub(super) fn number(&self, name: &str) -> Option<f64> {
        match self.attributes.get(name)? {
            Attribute::Text(_) => None,
            Attribute::Number(number) => Some(*number),
        }
    }
}

/// A file whose header was read.
pub(super) struct Classic<'a> {
    bytes: &'a [u8],
    /// The sizes of the dimensions; 0 for that of records.
    pub(super) sizes: Vec<u64>,
    pub(super) variables: Vec<Variable>,
}

impl<'a> Classic<'a> {
    /// Reads the header.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self> {
        let offset = match bytes.get(..4) {
            Some(b"CDF\x01") => 4,
            Some(b"CDF\x02") => 8,
            Some(b"\x89HDF") => {
                return Err(Error::unsupported("NetCDF 4, which is HDF5")
                    .cure("convert it: nccopy -k nc6 IN OUT.nc"));
            }
            _ => {
                return Err(Error::format("the file does not begin as NetCDF does").at("byte 0"));
            }
        };
        let mut header = Header { bytes, at: 4 };
        // Records are not read, so their number does not count.
        header.number()?;
        let count = header.list(DIMENSIONS, 8)?;
        let mut sizes = Vec::with_capacity(count);
        for _ in 0..count {
            header.name()?;
            sizes.push(u64::from(header.number()?));
        }
        header.attributes()?;
        let count = header.list(VARIABLES, 24)?;
        let mut variables = Vec::with_capacity(count);
        for _ in 0..count {
            let name = header.name()?;
            let mut dimensions = Vec::new();
            for _ in 0..header.count(4)? {
                let number = header.number()? as usize;
                if number >= sizes.len() {
                    return Err(header.wrong(format!("{name} names dimension {number}")));
                }
                dimensions.push(number);
            }
            let attributes = header.attributes()?;
            let kind = header.number()?;
            header.number()?;
            let high = if offset == 8 { header.number()? } else { 0 };
            let begin = u64::from(high) << 32 | u64::from(header.number()?);
            variables.push(Variable {
                name,
                dimensions,
                attributes,
                kind,
                begin,
            });
        }
        Ok(Classic {
            bytes,
            sizes,
            variables,
        })
    }

    pub(super) fn variable(&self, name: &str) -> Result<&Variable> {
        let found = self.variables.iter().find(|variable| variable.name == name);
        found.ok_or_else(|| Error::format(format!("there is no variable '{name}'")).at("header"))
    }

    /// Returns all values of a variable as doubles.
    pub(super) fn values(&self, variable: &Variable) -> Result<Vec<f64>> {
        let wrong = |text: String| Error::format(text).at(format!("variable {}", variable.name));
        let size = size_of(variable.kind)
            .ok_or_else(|| wrong(format!("{} is not a type of numbers", variable.kind)))?;
        let sides = variable.dimensions.iter().map(|&number| self.sizes[number]);
        if sides.clone().any(|side| side == 0) {
            return Err(wrong(
                "its values are in records, which are not read".to_owned(),
            ));
        }
        let range = || {
            let mut length = size as u64;
            for side in sides {
                length = length.checked_mul(side)?;
            }
            let begin = usize::try_from(variable.begin).ok()?;
            let end = begin.checked_add(usize::try_from(length).ok()?)?;
            self.bytes.get(begin..end)
        };
        let bytes = range().ok_or_else(|| {
            wrong("its values are not within the file".to_owned()).cure("get the whole file")
        })?;
        Ok(bytes
            .chunks_exact(size)
            .map(|b| number(b, variable.kind))
            .collect())
    }
}

fn size_of(kind: u32) -> Option<usize> {
    match kind {
        1 | CHAR => Some(1),
        3 => Some(2),
        INT | 5 => Some(4),
        DOUBLE => Some(8),
        _ => None,
    }
}

/// Returns the number in as many bytes as its type has.
fn number(bytes: &[u8], kind: u32) -> f64 {
    match (kind, bytes) {
        (3, &[a, b]) => f64::from(i16::from_be_bytes([a, b])),
        (INT, &[a, b, c, d]) => f64::from(i32::from_be_bytes([a, b, c, d])),
        (5, &[a, b, c, d]) => f64::from(f32::from_be_bytes([a, b, c, d])),
        (DOUBLE, &[a, b, c, d, e, f, g, h]) => f64::from_be_bytes([a, b, c, d, e, f, g, h]),
        (_, &[a, ..]) => f64::from(a as i8),
        _ => f64::NAN,
    }
}

struct Header<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Header<'a> {
    fn wrong(&self, text: String) -> Error {
        Error::format(text).at(format!("byte {}", self.at))
    }

    fn take(&mut self, length: usize) -> Result<&'a [u8]> {
        let end = self.at.checked_add(length);
        let found = end.and_then(|end| self.bytes.get(self.at..end));
        let found = found.ok_or_else(|| {
            self.wrong("the file ends within its header".to_owned())
                .cure("get the whole file")
        })?;
        self.at += length;
        Ok(found)
    }

    fn number(&mut self) -> Result<u32> {
        let bytes = self.take(4)?.first_chunk().copied();
        Ok(bytes.map_or(0, u32::from_be_bytes))
    }

    /// Reads the number of items that each have at least this many bytes.
    fn count(&mut self, least: usize) -> Result<usize> {
        let count = self.number()? as usize;
        match count > (self.bytes.len() - self.at) / least {
            true => Err(self.wrong(format!("{count} items do not fit into the file"))),
            false => Ok(count),
        }
    }

    /// Reads the beginning of a list, which may be absent.
    fn list(&mut self, tag: u32, least: usize) -> Result<usize> {
        let found = self.number()?;
        let count = self.count(least)?;
        match found == tag || found == 0 && count == 0 {
            true => Ok(count),
            false => Err(self.wrong(format!("a list of kind {found}, expected {tag}"))),
        }
    }

    /// Reads a text, padded to four bytes.
    fn name(&mut self) -> Result<String> {
        let length = self.count(1)?;
        let text = String::from_utf8_lossy(self.take(length)?).into_owned();
        self.take(length.next_multiple_of(4) - length)?;
        Ok(text)
    }

    fn attributes(&mut self) -> Result<Attributes> {
        let mut found = Attributes::new();
        for _ in 0..self.list(ATTRIBUTES, 12)? {
            let name = self.name()?;
            let kind = self.number()?;
            let value = match kind {
                CHAR => Attribute::Text(self.name()?),
                _ => {
                    let size = size_of(kind)
                        .ok_or_else(|| self.wrong(format!("{kind} is not a type of numbers")))?;
                    let length = self.count(size)? * size;
                    let bytes = self.take(length)?;
                    self.take(length.next_multiple_of(4) - length)?;
                    let first = bytes.get(..size).map(|bytes| number(bytes, kind));
                    Attribute::Number(first.unwrap_or(f64::NAN))
                }
            };
            found.insert(name, value);
        }
        Ok(found)
    }
}
