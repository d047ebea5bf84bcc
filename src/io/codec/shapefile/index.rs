//! The `.shx` file: the offset of each record, in the order of the attribute rows.

use std::path::Path;

use super::header::{FILE_CODE, HEADER};
use crate::error::{Error, Result};

/// Bytes before the first entry.
const FIRST_ENTRY: usize = HEADER as usize;

/// A complete index. [`Index::rows`] checks whether it fits its `.shp`.
#[derive(Debug)]
pub(super) struct Index {
    /// Offset and content length in bytes, in the order of the file.
    entries: Vec<(u64, u64)>,
    /// Offset and content length in bytes, sorted by offset.
    sorted: Vec<(u64, u64)>,
}

impl Index {
    /// Reads a `.shx`.
    ///
    /// # Errors
    /// If the file is not an index, or is cut short: half an index is worse than none.
    pub(super) fn read(path: &Path) -> Result<Self> {
        Self::parse(&std::fs::read(path)?)
    }

    fn parse(bytes: &[u8]) -> Result<Self> {
        let word = |at: usize| {
            bytes
                .get(at..at + 4)
                .and_then(|b| b.try_into().ok())
                .map(u32::from_be_bytes)
        };
        if word(0) != Some(FILE_CODE) || bytes.len() < FIRST_ENTRY {
            return Err(Error::format("it does not begin like an index"));
        }
        let stated = u64::from(word(24).unwrap_or_default()) * 2;
        if stated != bytes.len() as u64 {
            return Err(Error::format(format!(
                "its header states {stated} bytes, the file has {}",
                bytes.len()
            )));
        }
        let entries: Vec<_> = bytes[FIRST_ENTRY..]
            .as_chunks::<8>()
            .0
            .iter()
            .map(|&[a, b, c, d, e, f, g, h]| {
                let bytes_of = |words| u64::from(u32::from_be_bytes(words)) * 2;
                (bytes_of([a, b, c, d]), bytes_of([e, f, g, h]))
            })
            .collect();
        let mut sorted = entries.clone();
        sorted.sort_unstable();
        Ok(Index { entries, sorted })
    }

    /// Returns true if a record at `offset` or after it is listed.
    pub(super) fn lists_from(&self, offset: u64) -> bool {
        self.sorted.last().is_some_and(|last| last.0 >= offset)
    }

    /// Returns the first listed record after `offset`.
    pub(super) fn next_after(&self, offset: u64) -> Option<(u64, u64)> {
        self.sorted
            .get(self.sorted.partition_point(|entry| entry.0 <= offset))
            .copied()
    }

    /// Returns for every record found (by increasing offset) its position in the index; `None` if
    /// it is not listed.
    ///
    /// `end` is where reading of the `.shp` ended because of damage: entries after it may be
    /// unmatched.
    ///
    /// # Errors
    /// If an entry points to no record, or two entries point to the same.
    pub(super) fn rows(&self, starts: &[u64], end: Option<u64>) -> Result<Vec<Option<usize>>> {
        let mut rows = vec![None; starts.len()];
        for (row, &(offset, _)) in self.entries.iter().enumerate() {
            match starts.binary_search(&offset) {
                Ok(found) if rows[found].is_none() => rows[found] = Some(row),
                Ok(_) => return Err(Error::format(format!("two entries point to byte {offset}"))),
                Err(_) if end.is_some_and(|end| offset >= end) => {}
                Err(_) => {
                    return Err(Error::format(format!(
                        "entry {} points to byte {offset}, not a record",
                        row + 1
                    )));
                }
            }
        }
        Ok(rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn index(entries: &[(u32, u32)]) -> Vec<u8> {
        let mut bytes = vec![0; FIRST_ENTRY];
        bytes[..4].copy_from_slice(&FILE_CODE.to_be_bytes());
        bytes[24..28].copy_from_slice(&(50 + 4 * entries.len() as u32).to_be_bytes());
        entries.iter().for_each(|(a, b)| {
            bytes.extend((a / 2).to_be_bytes());
            bytes.extend((b / 2).to_be_bytes());
        });
        bytes
    }

    #[test]
    fn order_of_the_rows() {
        let index = Index::parse(&index(&[(200, 20), (100, 92)])).unwrap();
        assert_eq!(index.rows(&[100, 200], None).unwrap(), [Some(1), Some(0)]);
        assert_eq!(
            index.rows(&[100, 150, 200], None).unwrap(),
            [Some(1), None, Some(0)]
        );
        assert_eq!(index.next_after(100), Some((200, 20)));
        assert_eq!(index.next_after(200), None);
        // If a .shp is cut, entries after the cut are excused, but no others.
        assert_eq!(index.rows(&[100], Some(180)).unwrap(), [Some(1)]);
        assert!(index.rows(&[100], None).is_err());
        assert!(index.rows(&[101, 200], None).is_err());
    }

    #[test]
    fn damage_is_seen() {
        let good = index(&[(100, 20), (128, 20)]);
        assert!(Index::parse(&good).is_ok());
        for cut in 0..good.len() {
            assert!(Index::parse(&good[..cut]).is_err(), "cut at {cut}");
        }
        assert!(
            Index::parse(&index(&[(100, 20), (100, 20)]))
                .unwrap()
                .rows(&[100, 128], None)
                .is_err()
        );
    }
}
