use super::header::{Element, Encoding, Scalar};
use crate::error::{Error, Result};
use crate::io::Watch;
use crate::io::bytes::watch::Meter;

/// The values of a file that have not been read yet.
pub(super) struct Body<'a> {
    rest: &'a [u8],
    encoding: Encoding,
    meter: Meter<'a>,
}

impl<'a> Body<'a> {
    pub(super) fn new(bytes: &'a [u8], encoding: Encoding, watch: Watch<'a>) -> Self {
        Body {
            rest: bytes,
            encoding,
            meter: Meter::new(watch, bytes.len()),
        }
    }

    /// Returns an error if a count exceeds what the remaining bytes can contain, so that it may be
    /// trusted for allocation.
    pub(super) fn check_room(&self, element: &Element) -> Result<()> {
        let least: usize = match self.encoding {
            // A digit and a separator each, except for the last.
            Encoding::Ascii => 2 * element.properties.len(),
            _ => element
                .properties
                .iter()
                .map(|p| p.length.unwrap_or(p.kind).size())
                .sum(),
        };
        let left = self.rest.len() + usize::from(self.encoding == Encoding::Ascii);
        if least
            .checked_mul(element.count)
            .is_none_or(|needed| needed > left)
        {
            let Element { name, count, .. } = element;
            return Err(Error::format(format!(
                "the header states {count} of '{name}', but there is room for {} in the {} bytes left",
                left / least.max(1),
                self.rest.len()
            ))
            .cure("the file is cut off, or its header is wrong"));
        }
        if least == 0 && element.count > 0 {
            return Err(Error::format(format!(
                "the element '{}' has no properties",
                element.name
            )));
        }
        Ok(())
    }

    /// Reads the rows of an element. `each` receives the index of the row and the values of each
    /// property: one value, or those of a list.
    pub(super) fn rows(
        &mut self,
        element: &Element,
        mut each: impl FnMut(usize, &[Vec<f64>]) -> Result<()>,
    ) -> Result<()> {
        let mut row = vec![Vec::new(); element.properties.len()];
        for number in 0..element.count {
            let in_row = |e: Error| e.at(format!("{} {number}", element.name));
            for (property, values) in element.properties.iter().zip(&mut row) {
                values.clear();
                let length = match property.length {
                    None => 1,
                    Some(kind) => self.list_length(kind, property.kind).map_err(in_row)?,
                };
                for _ in 0..length {
                    values.push(self.value(property.kind).map_err(in_row)?);
                }
            }
            each(number, &row).map_err(in_row)?;
            self.meter.left(self.rest.len())?;
        }
        Ok(())
    }

    /// Checks that nothing follows the last element, except for blanks.
    ///
    /// # Errors
    /// If more follows: then a count in the header is too small.
    pub(super) fn end(&self) -> Result<()> {
        match self.rest.trim_ascii_start().len() {
            0 => Ok(()),
            left => Err(Error::format(format!(
                "{left} bytes follow the last element that the header states"
            ))
            .cure("a count in the header is wrong: write the file again")),
        }
    }

    fn list_length(&mut self, length: Scalar, kind: Scalar) -> Result<usize> {
        let length = self.value(length)?;
        if length < 0.0 || length.fract() != 0.0 {
            return Err(Error::format(format!("a list of {length} values")));
        }
        let least = if self.encoding == Encoding::Ascii {
            1.0
        } else {
            kind.size() as f64
        };
        // Also refuses infinite lengths and NaN.
        if length * least <= self.rest.len() as f64 {
            return Ok(length as usize);
        }
        Err(Error::format(format!(
            "a list of {length} values, with {} bytes left",
            self.rest.len()
        )))
    }

    fn value(&mut self, kind: Scalar) -> Result<f64> {
        if self.encoding == Encoding::Ascii {
            return self.word();
        }
        Ok(match kind {
            Scalar::I8 => i8::from_le_bytes(self.bytes()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.bytes()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.bytes()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.bytes()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.bytes()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.bytes()?).into(),
            Scalar::F32 => f32::from_le_bytes(self.bytes()?).into(),
            Scalar::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }

    /// Returns the next bytes, the least significant first.
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N]> {
        let (bytes, rest) = self.rest.split_first_chunk::<N>().ok_or_else(cut_off)?;
        self.rest = rest;
        let mut bytes = *bytes;
        if self.encoding == Encoding::BigEndian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    fn word(&mut self) -> Result<f64> {
        let word = self.rest.trim_ascii_start();
        let end = word
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(word.len());
        let (word, rest) = word.split_at(end);
        self.rest = rest;
        if word.is_empty() {
            return Err(cut_off());
        }
        std::str::from_utf8(word)
            .ok()
            .and_then(|word| word.parse().ok())
            .ok_or_else(|| {
                let word: String = String::from_utf8_lossy(word).chars().take(40).collect();
                Error::format(format!("'{word}' is not a number"))
            })
    }
}

#[cold]
fn cut_off() -> Error {
    Error::format("the file ends before its last value")
        .cure("the file is cut off, or its header is wrong")
}
