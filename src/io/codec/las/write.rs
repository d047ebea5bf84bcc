//! Writes points to LAS and LAZ with all attributes that their own files contain.
//!
//! Point records are copied from file to file as bytes; the `laz` crate compresses them. The header
//! is that of the first source, except for the fields that have to change, see [`create`].

use std::io::{Seek, SeekFrom, Write};

use laz::{LazVlr, LazVlrBuilder, ParLasZipCompressor};

use super::copc::{self, Gathered, Widening};
use super::merge::{self, LatticeStep, Rounding};
use super::packed::{compressing, ended, failed, items, laszip_record};
use crate::data::{Bounds, LasHead, Lattice, PointBatch, PointInfo, PointSink, PointSummary};
use crate::error::{Error, Result};
use crate::io::bytes::little_endian::u32_at;
use crate::io::bytes::output::{Destination, Output};

/// Bytes of records that are compressed together, per thread: about two chunks of typical points.
pub(super) const BATCH_BYTES: usize = 1 << 22;

/// The compression of written points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Packing {
    /// Uncompressed (LAS).
    Plain,
    /// Compressed (LAZ), in chunks of 50 000 points.
    Compressed,
    /// Compressed, in chunks that are the nodes of an octree (COPC 1.0). The points are in the
    /// order of the nodes, and written when all are known. Until then they are in memory, or above
    /// 256 MB in files without names next to the output.
    Octree,
}

/// A writer for the points of LAS files, made by [`create`].
pub struct LasWriter<'a> {
    target: Destination<'a>,
    body: Body<'a>,
    head: LasHead,
    /// How records change before they are written.
    widening: Option<Widening>,
    lattice: Lattice,
    rounding: Rounding,
    /// Converts from the lattice of the current source to that of the file.
    step: LatticeStep,
    /// Records that are to be written together.
    waiting: Vec<u8>,
    batch: usize,
    points_start: u32,
    record_count: u32,
    count: u64,
    returns: [u64; 16],
    low: [i32; 3],
    high: [i32; 3],
}

enum Body<'a> {
    Plain(Output),
    Compressed(Box<ParLasZipCompressor<Output>>),
    Octree(Output, Box<Gathered<'a>>),
    /// All points were written.
    Done,
}

impl std::fmt::Debug for LasWriter<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("LasWriter")
            .field("target", &self.target)
            .field("count", &self.count)
            .finish_non_exhaustive()
    }
}

/// Starts a file for the points of these sources, which must have been opened with
/// [`Detail::Records`](super::Detail::Records).
///
/// Point records keep every byte, except for coordinates if the sources have different lattices.
/// The output then has the first of their lattices that contains all points, and only the integers
/// of the coordinates change. All sources must agree in point format, record length, description of
/// extra bytes and kind of GPS time.
///
/// The header and the variable length records are those of the first source, followed by records
/// that only other sources have. These fields change:
/// - the generating software;
/// - counts and bounds, which are those of the points written;
/// - project id, file source id and system, which are cleared (the system is `MERGE`) if the
///   sources differ;
/// - the date, which is the latest of the sources, so that the same sources give the same bytes;
/// - waveform bits and offset.
///
/// Records that are valid for the bytes of one file only, which are the indices of COPC and of
/// LAStools, are left out.
///
/// COPC is LAS 1.4 and has point formats 6 to 8 only. Formats 0 to 3 become 6 or 7: each field
/// keeps its value, but has other bytes. The coordinate system is then stated by WKT.
///
/// # Errors
/// If a source is not a LAS or LAZ file, has waveforms, or is incompatible with the others; if the
/// target cannot be written. As COPC, also if a source is of a version above LAS 1.4.
pub fn create<'a>(
    target: impl Into<Destination<'a>>,
    sources: &[&PointInfo],
    packing: Packing,
    rounding: Rounding,
) -> Result<LasWriter<'a>> {
    let target = target.into();
    let (mut head, lattice) = merge::heads(sources, rounding)?;
    let widening = match packing {
        Packing::Octree => copc::prepare(&mut head, sources)?,
        Packing::Plain | Packing::Compressed => None,
    };
    let items = match packing {
        Packing::Plain => None,
        Packing::Compressed => Some(LazVlr::from_laz_items(items(
            head.point_format,
            head.record_length,
        )?)),
        Packing::Octree => Some(
            LazVlrBuilder::new(items(head.point_format, head.record_length)?)
                .with_variable_chunk_size()
                .build(),
        ),
    };
    head.header[104] = head.point_format | if items.is_some() { 0x80 } else { 0 };
    let mut records = head.records.concat();
    let mut record_count = head.records.len() as u32;
    if let Some(items) = &items {
        records.extend(laszip_record(items)?);
        record_count += 1;
    }
    let points_start = u32::try_from(head.header.len() + records.len())
        .map_err(|_| Error::limit("the records before the points exceed 4 GB"))?;

    let mut output = target.create_seekable_beside(target.path())?;
    let write = |output: &mut Output| -> std::io::Result<()> {
        output.write_all(&head.header)?;
        output.write_all(&records)
    };
    write(&mut output).map_err(|e| Error::from(e).in_file(target.path()))?;
    let body = match (items, packing) {
        (None, _) => Body::Plain(output),
        (Some(items), Packing::Octree) => {
            let gathered = Gathered::new(target, items, head.record_length);
            Body::Octree(output, Box::new(gathered))
        }
        (Some(items), _) => Body::Compressed(Box::new(
            ParLasZipCompressor::new(output, items).map_err(failed)?,
        )),
    };
    Ok(LasWriter {
        target,
        body,
        head,
        widening,
        lattice,
        rounding,
        step: LatticeStep::Same,
        waiting: Vec::new(),
        batch: BATCH_BYTES * rayon::current_num_threads(),
        points_start,
        record_count,
        count: 0,
        returns: [0; 16],
        low: [i32::MAX; 3],
        high: [i32::MIN; 3],
    })
}

impl LasWriter<'_> {
    /// Writes the waiting records.
    fn flush(&mut self) -> Result<()> {
        let written = match &mut self.body {
            Body::Plain(output) => output.write_all(&self.waiting).map_err(Error::from),
            Body::Compressed(compressor) => compressing(|| compressor.compress_many(&self.waiting))
                .and_then(|written| Ok(written?)),
            Body::Octree(_, gathered) => gathered.push(&self.waiting),
            Body::Done => Ok(()),
        };
        self.waiting.clear();
        written.map_err(|e| e.in_file(self.target.path()))
    }

    /// Accepts a record that was added to the waiting ones: counts it, and converts it to the
    /// lattice of the file.
    fn take(&mut self, at: usize) -> Result<()> {
        let record = &mut self.waiting[at..];
        let found = [0, 4, 8].map(|at| u32_at(record, at).cast_signed());
        let steps = self.step.apply(found, &self.lattice)?;
        if steps != found {
            for (bytes, steps) in record.chunks_exact_mut(4).zip(steps) {
                bytes.copy_from_slice(&steps.to_le_bytes());
            }
        }
        for (axis, steps) in steps.into_iter().enumerate() {
            self.low[axis] = self.low[axis].min(steps);
            self.high[axis] = self.high[axis].max(steps);
        }
        let bits = if self.head.point_format < 6 {
            0x07
        } else {
            0x0f
        };
        self.returns[usize::from(record[14] & bits)] += 1;
        self.count += 1;
        Ok(())
    }

    fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::default();
        if self.count > 0 {
            bounds.add(self.lattice.point(self.low));
            bounds.add(self.lattice.point(self.high));
        }
        bounds
    }

    /// Returns the bounds that a header states: zeros without points.
    fn stated_bounds(&self) -> Bounds {
        if self.count > 0 {
            return self.bounds();
        }
        Bounds {
            min: [0.0; 3],
            max: [0.0; 3],
        }
    }

    /// Returns the header, once all points are known.
    fn header(&self, late_start: u64) -> Result<Vec<u8>> {
        let mut header = self.head.header.clone();
        let mut put = |at: usize, bytes: &[u8]| header[at..at + bytes.len()].copy_from_slice(bytes);
        let minor = self.head.header[25];
        put(96, &self.points_start.to_le_bytes());
        put(100, &self.record_count.to_le_bytes());
        // From 1.4 on, the 32-bit fields serve old readers; they are zero for formats that these do
        // not know.
        let old = u32::try_from(self.count)
            .ok()
            .filter(|_| minor < 4 || self.head.point_format < 6);
        if minor < 4 && old.is_none() {
            return Err(Error::limit(format!(
                "{} points; LAS 1.{minor} supports up to {}",
                self.count,
                u32::MAX
            ))
            .in_file(self.target.path())
            .cure("write several files"));
        }
        put(107, &old.unwrap_or(0).to_le_bytes());
        for (slot, count) in self.returns[1..6].iter().enumerate() {
            put(
                111 + 4 * slot,
                &(if old.is_some() { *count as u32 } else { 0 }).to_le_bytes(),
            );
        }
        let bounds = self.stated_bounds();
        for axis in 0..3 {
            put(131 + 8 * axis, &self.lattice.scale[axis].to_le_bytes());
            put(155 + 8 * axis, &self.lattice.offset[axis].to_le_bytes());
            put(179 + 16 * axis, &bounds.max[axis].to_le_bytes());
            put(187 + 16 * axis, &bounds.min[axis].to_le_bytes());
        }
        if minor >= 3 && self.head.header.len() >= 235 {
            put(227, &0_u64.to_le_bytes());
        }
        if minor >= 4 {
            let late = self.head.late_records.len() as u32;
            put(235, &(if late > 0 { late_start } else { 0 }).to_le_bytes());
            put(243, &late.to_le_bytes());
            put(247, &self.count.to_le_bytes());
            for (slot, count) in self.returns[1..].iter().enumerate() {
                put(255 + 8 * slot, &count.to_le_bytes());
            }
        }
        Ok(header)
    }
}

impl PointSink for LasWriter<'_> {
    fn next_source(&mut self, info: &PointInfo) -> Result<()> {
        self.step = LatticeStep::between(info.lattice, &self.lattice, self.rounding)?;
        Ok(())
    }

    fn write(&mut self, batch: &PointBatch) -> Result<()> {
        let length = self.widening.map(|widening| widening.from_length);
        let stride = usize::from(length.unwrap_or(self.head.record_length));
        if batch.records.len() != batch.len() * stride {
            return Err(Error::usage(format!(
                "the points lack their records of {stride} bytes"
            )));
        }
        for record in batch.records.chunks_exact(stride) {
            let at = self.waiting.len();
            match self.widening {
                Some(widening) => widening.append(record, &mut self.waiting),
                None => self.waiting.extend_from_slice(record),
            }
            self.take(at)?;
        }
        if self.waiting.len() >= self.batch {
            self.flush()
        } else {
            Ok(())
        }
    }

    fn finish(mut self: Box<Self>) -> Result<PointSummary> {
        self.flush()?;
        let mut body = std::mem::replace(&mut self.body, Body::Done);
        if let Body::Octree(output, gathered) = &mut body {
            let hierarchy = gathered
                .write(output, &self.stated_bounds(), self.lattice)
                .map_err(|e| e.in_file(self.target.path()))?;
            self.head.late_records.insert(0, hierarchy);
        }
        let end = |mut output: Output| -> Result<(Output, u64)> {
            let late_start = output.seek(SeekFrom::End(0))?;
            self.head
                .late_records
                .iter()
                .try_for_each(|record| output.write_all(record))?;
            output.seek(SeekFrom::Start(0))?;
            Ok((output, late_start))
        };
        let (mut output, late_start) = match body {
            Body::Plain(output) | Body::Octree(output, _) => end(output),
            Body::Compressed(compressor) => ended(compressor).and_then(end),
            Body::Done => Err(Error::usage("the points have already been written")),
        }
        .map_err(|e| e.in_file(self.target.path()))?;
        let header = self.header(late_start)?;
        output
            .write_all(&header)
            .map_err(|e| Error::from(e).in_file(self.target.path()))?;
        self.target.put(output)?;
        Ok(PointSummary {
            count: self.count,
            bounds: self.bounds(),
        })
    }
}
