//! Reading tables of FlatBuffers. Every offset is compared with the bytes that exist, and what is
//! read is counted: parts of a record that overlap could otherwise stand for any number of them.

use std::cell::Cell;

use crate::error::{Error, Result};
use crate::io::bytes::little_endian::{array_at, u16_at};

/// A buffer, and how much of it may still be read.
pub(super) struct Buffer<'a> {
    bytes: &'a [u8],
    left: Cell<usize>,
}

/// How often the bytes of a buffer may be read: a table shares its list of slots with others.
const READ_AT_MOST: usize = 4;

/// What each table and list counts beside its own bytes.
const OVERHEAD: usize = 16;

/// A table in a buffer.
#[derive(Clone, Copy)]
pub(super) struct Table<'a> {
    buffer: &'a Buffer<'a>,
    at: usize,
    slots: &'a [u8],
}

#[cold]
fn damaged(at: usize) -> Error {
    Error::format(format!(
        "byte {at} of the table refers to bytes that it does not have"
    ))
}

impl<'a> Buffer<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let left = Cell::new(bytes.len().saturating_mul(READ_AT_MOST) + OVERHEAD);
        Buffer { bytes, left }
    }

    fn array<const N: usize>(&self, at: usize) -> Result<[u8; N]> {
        array_at(self.bytes, at).ok_or_else(|| damaged(at))
    }

    fn word(&self, at: usize) -> Result<usize> {
        self.array(at)
            .map(|bytes| u32::from_le_bytes(bytes) as usize)
    }

    /// Returns the position that the offset at another refers to.
    fn target(&self, at: usize) -> Result<usize> {
        let target = at.checked_add(self.word(at)?);
        target.ok_or_else(|| damaged(at))
    }

    /// Counts bytes that are read.
    fn count(&self, bytes: usize) -> Result<()> {
        let left = self.left.get().checked_sub(bytes.saturating_add(OVERHEAD));
        self.left.set(left.ok_or_else(|| {
            Error::format("its parts overlap: they are larger than the table that they are in")
        })?);
        Ok(())
    }

    /// Returns the table that the buffer begins with.
    pub(super) fn root(&'a self) -> Result<Table<'a>> {
        self.table(self.target(0)?)
    }

    fn table(&'a self, at: usize) -> Result<Table<'a>> {
        self.count(0)?;
        let back = i64::from(i32::from_le_bytes(self.array(at)?));
        let slots = usize::try_from(at as i64 - back).map_err(|_| damaged(at))?;
        let size = usize::from(u16::from_le_bytes(self.array(slots)?));
        let slots = self.bytes.get(slots..slots + size);
        let slots = slots.and_then(|slots| slots.get(4..));
        Ok(Table {
            buffer: self,
            at,
            slots: slots.ok_or_else(|| damaged(at))?,
        })
    }
}

impl<'a> Table<'a> {
    /// Returns the position of a value; `None` if the table lacks it.
    fn slot(self, slot: usize) -> Option<usize> {
        // Slots behind the end of the list are zeros: values that the table lacks.
        match u16_at(self.slots, 2 * slot) {
            0 => None,
            offset => Some(self.at + usize::from(offset)),
        }
    }

    fn number<const N: usize>(self, slot: usize) -> Result<Option<[u8; N]>> {
        self.slot(slot).map(|at| self.buffer.array(at)).transpose()
    }

    pub(super) fn byte(self, slot: usize) -> Result<Option<u8>> {
        Ok(self.number(slot)?.map(u8::from_le_bytes))
    }

    pub(super) fn short(self, slot: usize) -> Result<Option<u16>> {
        Ok(self.number(slot)?.map(u16::from_le_bytes))
    }

    pub(super) fn int(self, slot: usize) -> Result<Option<i32>> {
        Ok(self.number(slot)?.map(i32::from_le_bytes))
    }

    pub(super) fn long(self, slot: usize) -> Result<Option<u64>> {
        Ok(self.number(slot)?.map(u64::from_le_bytes))
    }

    /// Returns the bytes of a list, whose items have this size; `None` if the table lacks it.
    pub(super) fn list(self, slot: usize, size: usize) -> Result<Option<&'a [u8]>> {
        Ok(self.positioned(slot, size)?.map(|(_, bytes)| bytes))
    }

    fn positioned(self, slot: usize, size: usize) -> Result<Option<(usize, &'a [u8])>> {
        let Some(at) = self.slot(slot) else {
            return Ok(None);
        };
        let start = self.buffer.target(at)?;
        let count = self.buffer.word(start)?;
        let length = count.checked_mul(size).ok_or_else(|| damaged(start))?;
        let items = self.buffer.bytes.get(start + 4..);
        let items = items.and_then(|items| items.get(..length));
        let items = items.ok_or_else(|| damaged(start))?;
        self.buffer.count(length)?;
        Ok(Some((start + 4, items)))
    }

    /// Returns a text, with signs in place of what is not UTF-8.
    pub(super) fn text(self, slot: usize) -> Result<Option<String>> {
        let bytes = self.list(slot, 1)?;
        Ok(bytes.map(|bytes| String::from_utf8_lossy(bytes).into_owned()))
    }

    pub(super) fn table(self, slot: usize) -> Result<Option<Table<'a>>> {
        let at = self
            .slot(slot)
            .map(|at| self.buffer.target(at))
            .transpose()?;
        at.map(|at| self.buffer.table(at)).transpose()
    }

    pub(super) fn tables(self, slot: usize) -> Result<Vec<Table<'a>>> {
        let Some((start, items)) = self.positioned(slot, 4)? else {
            return Ok(Vec::new());
        };
        let each = (0..items.len() / 4).map(|i| self.buffer.target(start + 4 * i));
        each.map(|at| self.buffer.table(at?)).collect()
    }
}
