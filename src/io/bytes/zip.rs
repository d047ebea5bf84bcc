//! ZIP archives: the list of their members, and their bytes. What the list states is compared with
//! the bytes that are there.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};

use flate2::read::DeflateDecoder;

use super::little_endian::{u16_at, u32_at};
use super::watch::Watch;
use crate::error::{Error, Result};

/// The longest end of an archive: its fixed part and a comment.
const LONGEST_END: u64 = 22 + 0xffff;

/// Limit for the bytes of the list of members.
const LARGEST_LIST: u64 = 1 << 26;

/// Deflate makes a byte of at least so many times fewer.
const LARGEST_RATIO: u64 = 1032;

/// Bytes that are unpacked between two calls of the watch.
const AT_ONCE: usize = 1 << 18;

/// A member of an archive.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Member {
    /// The name with its folders, between slashes.
    pub(crate) name: String,
    /// Its bytes when it is unpacked.
    pub(crate) size: u64,
    packed: u64,
    offset: u64,
    method: u16,
    flags: u16,
    checksum: u32,
}

/// An open archive.
pub(crate) struct Archive {
    file: File,
    pub(crate) members: Vec<Member>,
}

#[cold]
fn damaged(what: &str) -> Error {
    Error::format(format!("a ZIP archive {what}")).cure("copy or download the file again")
}

impl Archive {
    /// Reads the list of members at the end of an archive.
    ///
    /// # Errors
    /// If there is none, it is cut, or the archive is one of several files.
    pub(crate) fn open(mut file: File) -> Result<Self> {
        let length = file.seek(SeekFrom::End(0))?;
        let start = length.saturating_sub(LONGEST_END);
        let tail = bytes_at(&mut file, start, length - start)?;
        let is_end = |&at: &usize| {
            tail[at..].starts_with(b"PK\x05\x06")
                && at + 22 + usize::from(u16_at(&tail, at + 20)) == tail.len()
        };
        let end = (0..tail.len().saturating_sub(21)).rev().find(is_end);
        let end = end.ok_or_else(|| damaged("without the list at its end: it is cut"))?;
        let location = format!("byte {}", start + end as u64);
        let count = u16_at(&tail, end + 10);
        let (size, offset) = (u32_at(&tail, end + 12), u32_at(&tail, end + 16));
        if u16_at(&tail, end + 4) != 0 || u16_at(&tail, end + 8) != count {
            return Err(Error::unsupported("a ZIP archive of several files").at(location));
        }
        if offset == u32::MAX || count == u16::MAX {
            return Err(
                Error::unsupported("a ZIP archive with a list of 64 bits (ZIP64)")
                    .at(location)
                    .cure("unpack it"),
            );
        }
        let (size, offset) = (u64::from(size), u64::from(offset));
        if offset + size > start + end as u64 || size > LARGEST_LIST {
            return Err(damaged("whose list is beyond its end").at(location));
        }
        let list = bytes_at(&mut file, offset, size)?;
        let members = members(&list, usize::from(count))
            .map_err(|error| error.at(format!("list at byte {offset}")))?;
        Ok(Archive { file, members })
    }

    /// Writes the bytes of a member, watched.
    ///
    /// # Errors
    /// If the member is damaged, is encrypted or is packed by another method than Deflate; if the
    /// bytes cannot be written; that of the watch.
    pub(crate) fn unpack(
        &mut self,
        member: &Member,
        out: &mut impl Write,
        watch: Watch,
    ) -> Result<()> {
        let unpacked = self.unpack_to(member, out, watch);
        unpacked.map_err(|error| error.within(&member.name))
    }

    fn unpack_to(&mut self, member: &Member, out: &mut impl Write, watch: Watch) -> Result<()> {
        if member.flags & 1 != 0 {
            return Err(Error::unsupported("it is encrypted").cure("unpack the archive"));
        }
        if member.size
            > member
                .packed
                .saturating_mul(LARGEST_RATIO)
                .saturating_add(AT_ONCE as u64)
        {
            return Err(damaged("that states more bytes than it can have").at(member.location()));
        }
        let head = bytes_at(&mut self.file, member.offset, 30)
            .map_err(|error| error.at(member.location()))?;
        if !head.starts_with(b"PK\x03\x04") {
            return Err(
                damaged("whose list names a byte where no member begins").at(member.location())
            );
        }
        let before = u64::from(u16_at(&head, 26)) + u64::from(u16_at(&head, 28));
        self.file
            .seek(SeekFrom::Start(member.offset + 30 + before))?;
        let packed = (&mut self.file).take(member.packed);
        match member.method {
            0 => copy(packed, member, out, watch),
            8 => copy(DeflateDecoder::new(packed), member, out, watch),
            method => Err(Error::unsupported(format!(
                "it is packed by method {method}, not Deflate"
            ))
            .cure("unpack the archive")),
        }
    }
}

impl Member {
    fn location(&self) -> String {
        format!("byte {}", self.offset)
    }
}

/// Returns bytes that must be there.
fn bytes_at(file: &mut File, start: u64, count: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.seek(SeekFrom::Start(start))?;
    file.take(count).read_to_end(&mut bytes)?;
    match bytes.len() as u64 == count {
        true => Ok(bytes),
        false => Err(damaged("that ends too early: it is cut")),
    }
}

/// Copies the bytes of a member, which are as many as it states and have its checksum.
fn copy(mut from: impl Read, member: &Member, out: &mut impl Write, watch: Watch) -> Result<()> {
    let broken = || damaged("with a damaged member").at(member.location());
    let mut checksum = flate2::Crc::new();
    let mut buffer = vec![0; AT_ONCE];
    let mut left = member.size;
    loop {
        watch(0)?;
        let count = from.read(&mut buffer).map_err(|_| broken())?;
        let bytes = &buffer[..count];
        if bytes.is_empty() {
            break;
        }
        left = left.checked_sub(count as u64).ok_or_else(broken)?;
        checksum.update(bytes);
        out.write_all(bytes)?;
    }
    match left == 0 && checksum.sum() == member.checksum {
        true => Ok(()),
        false => Err(broken()),
    }
}

/// Returns the members in a list.
fn members(mut list: &[u8], count: usize) -> Result<Vec<Member>> {
    let mut members = Vec::new();
    for number in 1..=count {
        let ends = || {
            damaged(&format!(
                "whose list of {count} ends within member {number}"
            ))
        };
        if !list.starts_with(b"PK\x01\x02") {
            return Err(ends());
        }
        let (head, rest) = list.split_at_checked(46).ok_or_else(ends)?;
        let [name, extra, comment] = [28, 30, 32].map(|at| usize::from(u16_at(head, at)));
        let (name, rest) = rest.split_at_checked(name).ok_or_else(ends)?;
        let (extra, rest) = rest.split_at_checked(extra).ok_or_else(ends)?;
        list = rest.get(comment..).ok_or_else(ends)?;
        let mut sizes = [24, 20, 42].map(|at| u64::from(u32_at(head, at)));
        long_sizes(&mut sizes, extra);
        let [size, packed, offset] = sizes;
        members.push(Member {
            // Windows writes backslashes at times.
            name: String::from_utf8_lossy(name).replace('\\', "/"),
            size,
            packed,
            offset,
            method: u16_at(head, 10),
            flags: u16_at(head, 8),
            checksum: u32_at(head, 16),
        });
    }
    Ok(members)
}

/// Replaces sizes of which the list says that they are in a field of 64 bits.
fn long_sizes(sizes: &mut [u64; 3], mut extra: &[u8]) {
    while extra.len() >= 4 {
        let (head, rest) = extra.split_at(4);
        let (field, behind) = rest.split_at(usize::from(u16_at(head, 2)).min(rest.len()));
        if u16_at(head, 0) == 1 {
            let mut numbers = field
                .as_chunks()
                .0
                .iter()
                .map(|bytes| u64::from_le_bytes(*bytes));
            let is_long = |size: &&mut u64| **size == u64::from(u32::MAX);
            for size in sizes.iter_mut().filter(is_long) {
                *size = numbers.next().unwrap_or(*size);
            }
        }
        extra = behind;
    }
}
