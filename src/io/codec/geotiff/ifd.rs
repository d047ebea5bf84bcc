//! The raw layer: bytes of the file, and the entries of its first image directory.
//!
//! Follows the format (TIFF 6.0, 1992, and BigTIFF) and checks only one thing: a value that a
//! directory points to must be within the file. So no array here is larger than the file itself.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry as MapEntry;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use super::tags;
use crate::error::{Error, Result};

/// Byte order of a TIFF file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ByteOrder {
    /// "II": the least significant byte first.
    Little,
    /// "MM": the most significant byte first.
    Big,
}

impl ByteOrder {
    fn unsigned(self, bytes: &[u8]) -> u64 {
        let fold = |value: u64, byte: &u8| value << 8 | u64::from(*byte);
        match self {
            ByteOrder::Little => bytes.iter().rev().fold(0, fold),
            ByteOrder::Big => bytes.iter().fold(0, fold),
        }
    }
}

/// A file of known length that many threads can read at any offset.
#[derive(Debug)]
pub(super) struct Bytes {
    file: Mutex<File>,
    len: u64,
}

impl Bytes {
    pub(super) fn open(path: &Path) -> Result<Self> {
        Self::of_file(File::open(path)?)
    }

    pub(super) fn of_file(file: File) -> Result<Self> {
        let metadata = file.metadata()?;
        if metadata.is_dir() {
            return Err(Error::usage("is a folder, not a raster file"));
        }
        Ok(Bytes {
            file: Mutex::new(file),
            len: metadata.len(),
        })
    }

    pub(super) fn len(&self) -> u64 {
        self.len
    }

    /// Returns true if `length` bytes at `offset` are within the file.
    pub(super) fn holds(&self, offset: u64, length: u64) -> bool {
        offset
            .checked_add(length)
            .is_some_and(|end| end <= self.len)
    }

    /// Appends `length` bytes from `offset` to `out`.
    pub(super) fn append(&self, offset: u64, length: u64, out: &mut Vec<u8>) -> Result<()> {
        if !self.holds(offset, length) {
            return Err(Error::format(format!(
                "{length} bytes at byte {offset} are not in the file, which ends at byte {}",
                self.len
            )));
        }
        let start = out.len();
        out.resize(start + length as usize, 0);
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(offset))?;
        file.read_exact(&mut out[start..])?;
        Ok(())
    }

    fn read(&self, offset: u64, length: u64) -> Result<Vec<u8>> {
        let mut out = Vec::new();
        self.append(offset, length, &mut out)?;
        Ok(out)
    }
}

/// An entry of a directory: the type and the position of a tag's values.
#[derive(Debug, Clone, Copy)]
struct Entry {
    kind: u16,
    count: u64,
    offset: u64,
}

/// One image file directory.
#[derive(Debug)]
pub(super) struct Directory {
    pub(super) order: ByteOrder,
    pub(super) is_big: bool,
    entries: BTreeMap<u16, Entry>,
    next: u64,
}

/// Returns the bytes of one value of a field type; `None` for types that TIFF does not define.
fn size_of(kind: u16) -> Option<u64> {
    match kind {
        1 | 2 | 6 | 7 => Some(1),
        3 | 8 => Some(2),
        4 | 9 | 11 | 13 => Some(4),
        5 | 10 | 12 | 16 | 17 | 18 => Some(8),
        _ => None,
    }
}

impl Directory {
    /// Reads the header and the first directory.
    pub(super) fn first(bytes: &Bytes) -> Result<Self> {
        let head = bytes.read(0, bytes.len().min(16))?;
        let order = match head.get(..2) {
            Some(b"II") => ByteOrder::Little,
            Some(b"MM") => ByteOrder::Big,
            _ => {
                return Err(
                    Error::format("does not begin like a TIFF file (II or MM)").at("byte 0")
                );
            }
        };
        let field = |range: std::ops::Range<usize>| {
            head.get(range)
                .map(|b| order.unsigned(b))
                .ok_or_else(|| Error::format("the TIFF header is cut short"))
        };
        let (is_big, offset) = match field(2..4)? {
            42 => (false, field(4..8)?),
            43 if field(4..6)? == 8 => (true, field(8..16)?),
            43 => {
                return Err(Error::unsupported(format!(
                    "BigTIFF with offsets of {} bytes",
                    field(4..6)?
                )));
            }
            other => {
                return Err(Error::format(format!(
                    "TIFF version {other}, expected 42 or 43 (BigTIFF)"
                )));
            }
        };
        Self::read(bytes, order, is_big, offset)
    }

    /// Reads the directory after this one; `None` if there is none.
    pub(super) fn following(&self, bytes: &Bytes) -> Option<Result<Self>> {
        (self.next != 0).then(|| Self::read(bytes, self.order, self.is_big, self.next))
    }

    /// Returns the offset of the next directory; 0 if there is none.
    pub(super) fn next_offset(&self) -> u64 {
        self.next
    }

    fn read(bytes: &Bytes, order: ByteOrder, is_big: bool, offset: u64) -> Result<Self> {
        let (count_size, entry_size, offset_size) = if is_big { (8, 20, 8) } else { (2, 12, 4) };
        let whole = || -> Result<(u64, Vec<u8>)> {
            let count = order.unsigned(&bytes.read(offset, count_size)?);
            let length = count.saturating_mul(entry_size);
            Ok((count, bytes.read(offset + count_size, length)?))
        };
        let (count, table) = whole().map_err(|e| {
            Error::format(format!("the image directory is cut short: {e}"))
                .at(format!("byte {offset}"))
        })?;
        let mut entries = BTreeMap::new();
        for (i, raw) in table.chunks_exact(entry_size as usize).enumerate() {
            let tag = order.unsigned(&raw[..2]) as u16;
            let kind = order.unsigned(&raw[2..4]) as u16;
            let value_at = entry_size as usize - offset_size;
            let values = order.unsigned(&raw[4..value_at]);
            let Some(length) = size_of(kind).map(|size| size.saturating_mul(values)) else {
                continue;
            };
            let offset = if length <= offset_size as u64 {
                offset + count_size + i as u64 * entry_size + value_at as u64
            } else {
                order.unsigned(&raw[value_at..])
            };
            // If a tag occurs twice, the first counts, as in libtiff.
            if let MapEntry::Vacant(free) = entries.entry(tag) {
                free.insert(Entry {
                    kind,
                    count: values,
                    offset,
                });
            }
        }
        let next = bytes.read(offset + count_size + count * entry_size, offset_size as u64);
        Ok(Directory {
            order,
            is_big,
            entries,
            next: next.map_or(0, |raw| order.unsigned(&raw)),
        })
    }

    pub(super) fn has(&self, tag: u16) -> bool {
        self.entries.contains_key(&tag)
    }

    fn raw(&self, bytes: &Bytes, tag: u16) -> Result<Option<(Entry, Vec<u8>)>> {
        let Some(&entry) = self.entries.get(&tag) else {
            return Ok(None);
        };
        let length = size_of(entry.kind).unwrap_or(1).saturating_mul(entry.count);
        let raw = bytes.read(entry.offset, length).map_err(|_| {
            Error::format(format!(
                "{} values at byte {} are not in the file, which ends at byte {}",
                entry.count,
                entry.offset,
                bytes.len()
            ))
            .at(tags::tag_name(tag))
        })?;
        Ok(Some((entry, raw)))
    }

    /// Returns the values of a tag of one of the unsigned types.
    pub(super) fn unsigned(&self, bytes: &Bytes, tag: u16) -> Result<Option<Vec<u64>>> {
        let Some((entry, raw)) = self.raw(bytes, tag)? else {
            return Ok(None);
        };
        match entry.kind {
            1 | 3 | 4 | 7 | 13 | 16 | 18 => {
                let size = size_of(entry.kind).unwrap_or(1) as usize;
                Ok(Some(
                    raw.chunks_exact(size)
                        .map(|b| self.order.unsigned(b))
                        .collect(),
                ))
            }
            other => Err(
                Error::format(format!("field type {other}, expected an unsigned number"))
                    .at(tags::tag_name(tag)),
            ),
        }
    }

    /// Returns the first value of a tag of one of the unsigned types.
    pub(super) fn number(&self, bytes: &Bytes, tag: u16) -> Result<Option<u64>> {
        Ok(self
            .unsigned(bytes, tag)?
            .and_then(|values| values.first().copied()))
    }

    /// Returns the values of a tag of type DOUBLE or FLOAT.
    pub(super) fn floats(&self, bytes: &Bytes, tag: u16) -> Result<Option<Vec<f64>>> {
        let Some((entry, raw)) = self.raw(bytes, tag)? else {
            return Ok(None);
        };
        let values = match entry.kind {
            12 => raw
                .chunks_exact(8)
                .map(|b| f64::from_bits(self.order.unsigned(b)))
                .collect(),
            11 => raw
                .chunks_exact(4)
                .map(|b| f64::from(f32::from_bits(self.order.unsigned(b) as u32)))
                .collect(),
            other => {
                return Err(
                    Error::format(format!("field type {other}, expected DOUBLE"))
                        .at(tags::tag_name(tag)),
                );
            }
        };
        Ok(Some(values))
    }

    /// Returns the text of a tag, up to its first NUL.
    pub(super) fn text(&self, bytes: &Bytes, tag: u16) -> Result<Option<String>> {
        Ok(self.raw(bytes, tag)?.map(|(_, raw)| {
            let end = raw.iter().position(|&b| b == 0).unwrap_or(raw.len());
            String::from_utf8_lossy(&raw[..end]).into_owned()
        }))
    }

    /// Returns the bytes of a tag as stored.
    pub(super) fn bytes(&self, bytes: &Bytes, tag: u16) -> Result<Option<Vec<u8>>> {
        Ok(self.raw(bytes, tag)?.map(|(_, raw)| raw))
    }
}
