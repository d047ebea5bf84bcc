//! Locates the chunks of a LAZ file.

use std::io::Cursor;

use laz::laszip::ChunkTable;

use super::compression::{ChunkSize, Compression, Order};
use crate::io::bytes::contain::contain;
use crate::io::bytes::little_endian::{u32_at, u64_at};
use crate::io::codec::las::header::Header;
use crate::io::codec::las::input::Input;

/// Bytes before the first chunk: the position of the chunk table.
pub(super) const POINTER: u64 = 8;

/// A sequence of points that is compressed on its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Chunk {
    /// Its position in the file, from 1.
    pub(super) number: usize,
    pub(super) start: u64,
    pub(super) bytes: u64,
    /// Index of its first point in the file.
    pub(super) first: u64,
    pub(super) points: u64,
}

/// Reads the chunk table and checks every entry against the file.
///
/// # Errors
/// If the table is missing or damaged; the message says how.
pub(super) fn read(
    input: &mut Input,
    compression: &Compression,
    header: &Header,
) -> Result<Vec<Chunk>, String> {
    let points_start = header.layout.points_start;
    let table =
        find(input, points_start).ok_or("the position of the chunk table was never written")?;
    let damaged = |what: String| format!("the chunk table at byte {table} {what}");
    if table.saturating_add(8) > input.length {
        return Err(damaged(format!(
            "lies beyond the end of the file at byte {}",
            input.length
        )));
    }
    let mut start = points_start + POINTER;
    let room = table - start;
    let mut read = |count| {
        input
            .bytes(table, count)
            .map_err(|error| damaged(error.to_string()))
    };
    let count = u32_at(&read(8)?, 4);
    // Every chunk begins with an uncompressed point.
    if u64::from(count) > room / compression.stride as u64 + 1 {
        return Err(damaged(format!(
            "lists {count} chunks, more than {room} bytes can hold"
        )));
    }
    // An entry consists of two numbers of 32 bits, which the coder makes slightly larger at worst.
    let bytes = read(64 + 16 * count as usize)?;
    let variable = compression.chunks == ChunkSize::Variable;
    let entries = contain(|| ChunkTable::read(&mut Cursor::new(&bytes), variable))
        .and_then(Result::ok)
        .ok_or_else(|| damaged("cannot be decoded".into()))?;

    let mut chunks = Vec::with_capacity(entries.len());
    let mut first = 0;
    for entry in &entries {
        // The crate sign-extends numbers of 32 bits.
        let (bytes, stated) = (
            entry.byte_count & 0xffff_ffff,
            entry.point_count & 0xffff_ffff,
        );
        let points = match compression.chunks {
            ChunkSize::Fixed(size) => size.min(header.count - first),
            _ => stated.min(header.count - first),
        };
        let number = chunks.len() + 1;
        if bytes > table - start {
            return Err(damaged(format!(
                "states {bytes} bytes for chunk {number}, which would overlap the table"
            )));
        }
        if points == 0 {
            break;
        }
        // No coder makes points twice as large as they were.
        let is_last = first + points == header.count;
        let largest = 2 * points * compression.stride as u64 + 4096;
        if bytes < compression.stride as u64 || (bytes > largest && !is_last) {
            return Err(damaged(format!(
                "states {bytes} bytes for the {points} points of chunk {number}"
            )));
        }
        chunks.push(Chunk {
            number,
            start,
            bytes,
            first,
            points,
        });
        start += bytes;
        first += points;
    }
    Ok(chunks)
}

/// Returns the position of the table. It is written before the first chunk or, by writers that
/// cannot go back, in the last bytes of the file.
fn find(input: &mut Input, points_start: u64) -> Option<u64> {
    let last = input.length.checked_sub(8);
    let mut offset_at = |start| {
        let bytes = input
            .bytes(start, 8)
            .ok()
            .filter(|bytes| bytes.len() == 8)?;
        let offset = u64_at(&bytes, 0);
        (offset >= points_start + POINTER && offset <= i64::MAX as u64).then_some(offset)
    };
    offset_at(points_start).or_else(|| offset_at(last?))
}

/// Finds layered chunks without a table: each states the number of its points and the sizes of its
/// layers. Returns the complete chunks.
pub(super) fn walk(
    input: &mut Input,
    compression: &Compression,
    header: &Header,
) -> std::io::Result<Vec<Chunk>> {
    let Order::Layered(layers) = compression.order else {
        return Ok(Vec::new());
    };
    let mut chunks = Vec::new();
    let (mut start, mut first) = (header.layout.points_start + POINTER, 0);
    while first < header.count {
        let head = compression.stride + 4 + 4 * layers;
        let bytes = input.bytes(start, head)?;
        if bytes.len() < head {
            break;
        }
        let points = u64::from(u32_at(&bytes, compression.stride));
        let sizes = layer_sizes(&bytes[compression.stride + 4..]);
        let bytes = head as u64 + sizes.sum::<u64>();
        let is_sound =
            points > 0 && !matches!(compression.chunks, ChunkSize::Fixed(most) if points > most);
        if !is_sound || bytes > header.layout.points_end.saturating_sub(start) {
            break;
        }
        let points = points.min(header.count - first);
        chunks.push(Chunk {
            number: chunks.len() + 1,
            start,
            bytes,
            first,
            points,
        });
        start += bytes;
        first += points;
    }
    Ok(chunks)
}

/// Returns the sizes of layers, 32 bits each.
pub(super) fn layer_sizes(bytes: &[u8]) -> impl Iterator<Item = u64> + '_ {
    bytes.chunks_exact(4).map(|size| u64::from(u32_at(size, 0)))
}
