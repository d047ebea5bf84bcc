//! Writes COPC (COPC 1.0): a LAZ file whose chunks are the nodes of an octree.
//!
//! The specification: <https://copc.io>. The record that describes the octree comes first, the
//! hierarchy is the first of the extended records. `laz/octree.rs` reads what is written here.

mod divide;
mod hierarchy;
mod list;
#[cfg(test)]
mod tests;
mod widen;

use std::io::{Cursor, Seek, SeekFrom, Write};

use laz::laszip::{ChunkTable, ChunkTableEntry};
use laz::{LasZipCompressor, LazVlr};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use self::divide::{Cube, Divider, Node, Sizes};
use self::hierarchy::{Chunk, Hierarchy};
use self::list::List;
pub(super) use self::widen::Widening;
use super::merge::record_header;
use super::node::{INFO, Key};
use super::packed::{compressing, failed};
use super::raw::{EVLR_HEADER, MAX_HEADER, VLR_HEADER};
use super::system::{WKT_BIT, is_of_system, state_system};
use crate::data::{Bounds, LasHead, Lattice, PointInfo};
use crate::error::{Error, Result};
use crate::io::bytes::little_endian::{f64_at, u16_at};
use crate::io::bytes::output::{Destination, Output};

/// The user of the records.
const USER: &str = "copc";

/// Where the time of a point is in its record.
const TIME: usize = 22;

/// The record with the keys of GeoTIFF.
const KEYS: u16 = 34735;

/// Where the global encoding of a header is.
const ENCODING: usize = 6;

const SIZES: Sizes = Sizes {
    // A chunk of LASzip.
    leaf: 50_000,
    least: 256,
    most: 1 << 23,
    held: 1 << 28,
};

/// Returns the record that describes the octree, with zeros where numbers are known last.
pub(super) fn info_record() -> Vec<u8> {
    let mut record = record_header(USER, 1, INFO as u16, "COPC info");
    record.resize(VLR_HEADER + INFO, 0);
    record
}

/// Turns a head into that of a COPC file: LAS 1.4 with the record for the octree first, and the
/// coordinate system of the sources as WKT. Returns how records have to be changed, if they are of
/// a point format that LAS 1.4 has replaced.
///
/// # Errors
/// If the header has more fields than that of LAS 1.4, or a record or the definition of the
/// coordinate system would become too long.
pub(super) fn prepare(head: &mut LasHead, sources: &[&PointInfo]) -> Result<Option<Widening>> {
    let version = head.header.get(25).copied().unwrap_or_default();
    let length = head.header.len();
    if version > 4 || length > MAX_HEADER {
        return Err(Error::unsupported(format!(
            "COPC is LAS 1.4 with a header of {MAX_HEADER} bytes; the input is LAS 1.{version} with \
             {length}"
        ))
        .cure("write it as .laz"));
    }
    head.header.resize(MAX_HEADER, 0);
    head.header[25] = 4;
    head.header[94..96].copy_from_slice(&(MAX_HEADER as u16).to_le_bytes());
    let widening = Widening::of(head.point_format, head.record_length);
    if let Some(widening) = &widening {
        head.point_format = widening.format();
        head.record_length = widening.length()?;
        head.header[105..107].copy_from_slice(&head.record_length.to_le_bytes());
    }
    // Before LAS 1.4, the bit means nothing.
    let says_wkt = version >= 4 && head.header[ENCODING] & WKT_BIT != 0;
    if let Some(crs) = sources.iter().find_map(|info| info.crs.as_ref())
        && !says_wkt
    {
        state_system(head, crs)?;
    }
    // LAS 1.4 wants the bit without a system, too; keys that are not understood stay as keys.
    let is_key = |record: &Vec<u8>| is_of_system(record) && u16_at(record, 18) == KEYS;
    if !head.records.iter().any(is_key) {
        head.header[ENCODING] |= WKT_BIT;
    }
    head.records.insert(0, info_record());
    Ok(widening)
}

/// The records of a file, until all are known.
pub(super) struct Gathered<'a> {
    target: Destination<'a>,
    list: Option<List>,
    stride: usize,
    laz: LazVlr,
    times: [f64; 2],
}

impl<'a> Gathered<'a> {
    pub(super) fn new(target: Destination<'a>, laz: LazVlr, stride: u16) -> Self {
        let stride = usize::from(stride);
        Gathered {
            target,
            list: Some(List::held(stride, Vec::new())),
            stride,
            laz,
            times: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    /// Adds records.
    ///
    /// # Errors
    /// If they do not fit on the disk.
    pub(super) fn push(&mut self, records: &[u8]) -> Result<()> {
        for record in records.chunks_exact(self.stride) {
            let time = f64_at(record, TIME);
            self.times = [self.times[0].min(time), self.times[1].max(time)];
        }
        let mut list = self.list.take().ok_or_else(written)?;
        if list.is_held() && list.bytes() + records.len() as u64 > SIZES.held {
            list = list.file(self.target.scratch()?)?;
        }
        list.push(records)?;
        self.list = Some(list);
        Ok(())
    }

    /// Writes the points, and what describes where they are. Returns the extended record of the
    /// hierarchy, which has to be the first one, at the end of the file.
    ///
    /// # Errors
    /// If the output cannot be written.
    pub(super) fn write(
        &mut self,
        output: &mut Output,
        bounds: &Bounds,
        lattice: Lattice,
    ) -> Result<Vec<u8>> {
        let list = self.list.take().ok_or_else(written)?;
        let cube = Cube::around(bounds, lattice)?;
        let divider = Divider {
            cube,
            sizes: SIZES,
            stride: self.stride,
        };
        let scratch = || self.target.scratch();
        let pointer = output.stream_position()?;
        output.write_all(&[0; ChunkTable::OFFSET_SIZE])?;
        let mut end = pointer + ChunkTable::OFFSET_SIZE as u64;
        let (mut table, mut chunks) = (ChunkTable::default(), Vec::new());
        divider.divide(Key::ROOT, list, &scratch, &mut |nodes| {
            let compressed: Vec<Vec<u8>> = nodes
                .par_iter()
                .map(|node| compressed(node, &self.laz))
                .collect::<Result<_>>()?;
            for (node, bytes) in nodes.iter().zip(compressed) {
                let points = (node.records.len() / self.stride) as i32;
                // A root without points has no chunk.
                chunks.push(Chunk {
                    key: node.key,
                    start: if points > 0 { end } else { 0 },
                    bytes: size_of(&bytes)?,
                    points,
                });
                if points == 0 {
                    continue;
                }
                table.push(ChunkTableEntry {
                    point_count: points as u64,
                    byte_count: bytes.len() as u64,
                });
                output.write_all(&bytes)?;
                end += bytes.len() as u64;
            }
            Ok(())
        })?;
        table.write_to(&mut *output, &self.laz)?;
        let table_end = output.stream_position()?;
        output.seek(SeekFrom::Start(pointer))?;
        output.write_all(&end.to_le_bytes())?;
        let first_page = table_end + EVLR_HEADER as u64;
        let hierarchy = Hierarchy::of(&chunks, first_page);
        output.seek(SeekFrom::Start((MAX_HEADER + VLR_HEADER) as u64))?;
        output.write_all(&self.info(&cube, first_page, hierarchy.first))?;
        output.seek(SeekFrom::Start(table_end))?;
        Ok(extended(hierarchy.pages))
    }

    /// Returns the payload of the record that describes the octree.
    fn info(&self, cube: &Cube, first_page: u64, bytes: u64) -> Vec<u8> {
        let [x, y, z] = cube.center;
        let times = match self.times[0] <= self.times[1] {
            true => self.times,
            false => [0.0; 2],
        };
        let before = [x, y, z, cube.half, cube.spacing()].map(f64::to_bits);
        let numbers = before
            .into_iter()
            .chain([first_page, bytes])
            .chain(times.map(f64::to_bits));
        let mut info: Vec<u8> = numbers.flat_map(u64::to_le_bytes).collect();
        info.resize(INFO, 0);
        info
    }
}

/// Returns the extended record of the hierarchy.
fn extended(pages: Vec<u8>) -> Vec<u8> {
    let mut record = record_header(USER, 1000, 0, "EPT hierarchy");
    // Its length has eight bytes instead of two.
    record.splice(20..22, (pages.len() as u64).to_le_bytes());
    record.extend(pages);
    record
}

/// Returns the chunk of a node.
fn compressed(node: &Node, laz: &LazVlr) -> Result<Vec<u8>> {
    if node.records.is_empty() {
        return Ok(Vec::new());
    }
    let compress = || -> laz::Result<Vec<u8>> {
        let mut compressor = LasZipCompressor::new(Cursor::new(Vec::new()), laz.clone())?;
        compressor.compress_many(&node.records)?;
        compressor.finish_current_chunk()?;
        // The room for the position of the table comes before the chunk.
        let mut bytes = compressor.into_inner().into_inner();
        bytes.drain(..ChunkTable::OFFSET_SIZE.min(bytes.len()));
        Ok(bytes)
    };
    compressing(compress)?.map_err(failed)
}

fn size_of(bytes: &[u8]) -> Result<u32> {
    i32::try_from(bytes.len())
        .map(i32::cast_unsigned)
        .map_err(|_| Error::limit("the points of a node exceed 2 GB").cure("write them as .laz"))
}

#[cold]
fn written() -> Error {
    Error::usage("the points have already been written")
}
