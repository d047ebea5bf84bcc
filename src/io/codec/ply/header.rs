use crate::error::{Error, Result};
use crate::io::codec::listing::crs_text;

/// The encoding of the values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Result<Self> {
        Ok(match name {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
            "float" | "float32" => Scalar::F32,
            "double" | "float64" => Scalar::F64,
            _ => {
                return Err(Error::format(format!(
                    "'{name}' is not a type of a property"
                )));
            }
        })
    }

    /// Returns the size in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }
}

/// A property of an element: a named value or list of values in each row.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Scalar,
    /// For a list, the type of its length.
    pub(super) length: Option<Scalar>,
}

/// A table of vertices, faces, or anything else.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    /// Number of rows, as stated: not to be trusted before
    /// [`Body::check_room`](super::Body::check_room).
    pub(super) count: usize,
    pub(super) properties: Vec<Property>,
}

/// The header, which precedes the values.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// What comments state about the coordinate system, joined.
    pub(super) crs: String,
    /// Length of the header in bytes.
    pub(super) length: usize,
}

impl Header {
    pub(super) fn read(bytes: &[u8]) -> Result<Self> {
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        let mut crs = String::new();
        let mut at = 0;
        for number in 1.. {
            let at_line = |e: Error| e.at(format!("line {number}"));
            let (line, length) = line(&bytes[at..]).ok_or_else(|| {
                let message = if number == 1 {
                    "the file does not begin with 'ply'"
                } else {
                    "the header has no end"
                };
                Error::format(message)
            })?;
            at += length;
            if number == 1 {
                if line.trim_end() != "ply" {
                    return Err(Error::format("the file does not begin with 'ply'"));
                }
                continue;
            }
            let words: Vec<&str> = line.split_ascii_whitespace().collect();
            match words[..] {
                ["format", name, "1.0"] => encoding = Some(named_encoding(name).map_err(at_line)?),
                ["element", name, count] => {
                    let count = count
                        .parse()
                        .map_err(|_| at_line(Error::format(format!("'{count}' is not a count"))))?;
                    elements.push(Element {
                        name: name.into(),
                        count,
                        properties: Vec::new(),
                    });
                }
                ["property", ..] => {
                    let property = property(&words).map_err(at_line)?;
                    let element = elements.last_mut();
                    let element = element
                        .ok_or_else(|| at_line(Error::format("a property before any element")))?;
                    element.properties.push(property);
                }
                ["comment" | "obj_info", ..] => {
                    let comment = line.split_once(' ').map_or("", |(_, comment)| comment);
                    crs.push_str(crs_text::crs_comment(comment).unwrap_or_default());
                }
                [] => (),
                ["end_header"] => break,
                _ => {
                    let line: String = line.chars().take(80).collect();
                    return Err(at_line(Error::format(format!(
                        "'{line}' is not a line of a PLY 1.0 header"
                    ))));
                }
            }
        }
        let encoding = encoding.ok_or_else(|| Error::format("the header has no 'format' line"))?;
        Ok(Header {
            encoding,
            elements,
            crs,
            length: at,
        })
    }
}

/// Returns a line without its end, and its length in bytes including the end.
fn line(bytes: &[u8]) -> Option<(String, usize)> {
    /// A longer line cannot belong to a header.
    const MAX_BYTES: usize = 1 << 16;
    let length = bytes.iter().take(MAX_BYTES).position(|&b| b == b'\n')?;
    let line = String::from_utf8_lossy(&bytes[..length]);
    Some((
        line.strip_suffix('\r').unwrap_or(&line).to_owned(),
        length + 1,
    ))
}

fn named_encoding(name: &str) -> Result<Encoding> {
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::LittleEndian),
        "binary_big_endian" => Ok(Encoding::BigEndian),
        _ => Err(Error::format(format!("'{name}' is not a PLY encoding"))),
    }
}

fn property(words: &[&str]) -> Result<Property> {
    match *words {
        [_, "list", length, kind, name] => {
            let length = Scalar::named(length)?;
            Ok(Property {
                name: name.into(),
                kind: Scalar::named(kind)?,
                length: Some(length),
            })
        }
        [_, kind, name] => Ok(Property {
            name: name.into(),
            kind: Scalar::named(kind)?,
            length: None,
        }),
        _ => Err(Error::format(format!(
            "'{}' does not describe a property",
            words.join(" ")
        ))),
    }
}
