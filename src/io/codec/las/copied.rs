//! Copies a file with other classes of its points.
//!
//! What is not a class is copied as bytes: the header, all records, what lies between them, and
//! each point record. Compressed points are decompressed and compressed again as they were, chunk
//! by chunk. Of the header, only positions in the file change, and the bit for compression.

use std::io::{self, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::Path;

use laz::{LazVlr, ParLasZipCompressor};

use super::head::{self, Span, is_laszip, is_of_octree};
use super::header::Header;
use super::input::Input;
use super::laz::MAX_CHUNK_POINTS;
use super::packed::{compressing, ended, failed, items, laszip_record};
use super::raw::MAX_HEADER;
use super::reader::Points;
use super::records;
use super::write::{BATCH_BYTES, Packing};
use crate::data::PointBatch;
use crate::error::{Error, Result};
use crate::io::OnDamage;
use crate::io::bytes::little_endian::{u16_at, u64_at};
use crate::io::bytes::output::{Destination, Output};
use crate::io::options::las::{Detail, ReadOptions};

/// Bytes of a file that are copied at once.
const BLOCK: u64 = 1 << 22;

/// The most bytes of the points of a chunk, uncompressed: a compressor makes room for them.
const MOST_CHUNK_BYTES: u64 = 1 << 32;

/// Where fields of the header are.
const POINTS_START: usize = 96;
const RECORD_COUNT: usize = 100;
const FORMAT: usize = 104;
const WAVEFORM_START: usize = 227;
const LATE_START: usize = 235;
const LATE_COUNT: usize = 243;

/// The bit of the point format that says that points are compressed.
const COMPRESSED: u8 = 0x80;

/// Bits of a byte of formats 0 to 5 that are the class; the others are flags.
const CLASS_BITS: u8 = 0x1f;

/// Copies a LAS or LAZ file. `classify` gets all points in order, and may change their classes;
/// whatever else it changes is not written.
///
/// Every other byte of the header, the records and the points is that of the source: also the date,
/// the generating software, counts, extents, extra bytes, waveforms and flags. The points keep
/// their order and, if the source is compressed and the copy is, the sizes of their chunks. Only
/// these differ:
/// - positions in the file that the header states, and the number of its records;
/// - the octree of COPC is left out: it would have to be made again. The copy is LAZ;
/// - of compressed points, bytes that no field of the header points to, if they follow the points;
/// - the record of LASzip, where points become compressed or are no longer, or where the source is
///   compressed in one chunk or in chunks over 8 million points.
///
/// # Errors
/// If the file is damaged, as [`open`](super::open) defines it; the class of a point does not fit
/// its format (formats 0 to 5: above 31); `packing` is [`Packing::Octree`]; the target cannot be
/// written; those of `classify`.
pub fn copy_with_classes<'a>(
    source: &Path,
    target: impl Into<Destination<'a>>,
    packing: Packing,
    classify: &mut dyn FnMut(&mut PointBatch) -> Result<()>,
) -> Result<()> {
    let target = target.into();
    if packing == Packing::Octree {
        return Err(Error::unsupported("an octree is not copied").in_file(target.path()));
    }
    let mut source = Source::open(source).map_err(|error| error.in_file(source))?;
    let copied = source.copy(target, packing == Packing::Compressed, classify);
    copied.map_err(|error| match error.path() {
        Some(_) => error,
        None => error.in_file(&source.input.name),
    })
}

/// A file to be copied.
struct Source {
    /// For what is not a point.
    input: Input,
    header: Header,
    points: Points,
    /// How points are compressed.
    laszip: Option<LazVlr>,
}

/// Bytes of a copy.
#[derive(Debug, Clone)]
enum Slice {
    /// Those of the source at these positions.
    Of(Range<u64>),
    New(Vec<u8>),
}

impl Slice {
    fn length(&self) -> u64 {
        match self {
            Slice::Of(bytes) => bytes.end - bytes.start,
            Slice::New(bytes) => bytes.len() as u64,
        }
    }
}

/// What is around the points of a copy.
struct Around {
    header: Vec<u8>,
    /// From the header to the points.
    before: Vec<Slice>,
    /// Bytes of the source.
    after: Vec<Range<u64>>,
    /// How the points are to be compressed.
    laszip: Option<LazVlr>,
}

impl Source {
    fn open(path: &Path) -> Result<Self> {
        // These warnings were reported when the points were read for the filter.
        let mut warnings = Vec::new();
        let mut input = Input::open(path)?;
        let bytes = input.bytes(0, MAX_HEADER)?;
        let mut header = Header::check(&bytes, input.length, &mut warnings)?;
        let payloads = records::read(&input, &mut header, &mut warnings)?;
        let laszip = payloads.laszip.as_deref();
        let laszip = laszip
            .filter(|_| header.is_compressed)
            .map(LazVlr::from_buffer);
        let laszip = laszip.and_then(std::result::Result::ok);
        let options = ReadOptions {
            cut: OnDamage::Refuse,
            detail: Detail::Records,
        };
        let for_points = Input::open(path)?;
        let points = Points::open(for_points, &header, payloads, options, &mut warnings)?;
        Ok(Source {
            input,
            header,
            points,
            laszip,
        })
    }

    fn copy(
        &mut self,
        target: Destination,
        is_compressed: bool,
        classify: &mut dyn FnMut(&mut PointBatch) -> Result<()>,
    ) -> Result<()> {
        let mut around = self.around(is_compressed)?;
        let mut output = target.create_seekable()?;
        let to_target = |error: io::Error| Error::from(error).in_file(target.path());
        output.write_all(&around.header).map_err(to_target)?;
        for slice in &around.before {
            match slice {
                Slice::Of(bytes) => self.copy_bytes(bytes, &mut output, target.path())?,
                Slice::New(bytes) => output.write_all(bytes).map_err(to_target)?,
            }
        }

        let mut body = Body::of(output, around.laszip.take())?;
        let mut batch = PointBatch::default();
        loop {
            self.points.read(&mut batch, &mut Vec::new())?;
            if batch.is_empty() {
                break;
            }
            classify(&mut batch)?;
            self.put_classes(&mut batch)?;
            let records = std::mem::take(&mut batch.records);
            body.write(records).map_err(|e| e.in_file(target.path()))?;
        }
        let mut output = body.end().map_err(|e| e.in_file(target.path()))?;

        let end = output.stream_position().map_err(to_target)?;
        for bytes in &around.after {
            self.copy_bytes(bytes, &mut output, target.path())?;
        }
        self.move_late(&mut around, end);
        output
            .rewind()
            .and_then(|()| output.write_all(&around.header))
            .map_err(to_target)?;
        target.put(output)
    }

    /// Returns what is written around the points.
    ///
    /// # Errors
    /// If records have to be read, and are damaged.
    fn around(&mut self, is_compressed: bool) -> Result<Around> {
        let layout = self.header.layout;
        let mut header = self.input.bytes(0, layout.vlr_start as usize)?;
        let kept = self
            .laszip
            .take()
            .filter(|laszip| self.can_compress(laszip));
        let (laszip, own) = match (is_compressed, kept) {
            (false, _) => (None, None),
            (true, Some(laszip)) => (Some(laszip), None),
            (true, None) => {
                let items = items(self.header.point_format, self.header.record_length)?;
                let laszip = LazVlr::from_laz_items(items);
                let record = laszip_record(&laszip)?;
                (Some(laszip), Some(record))
            }
        };
        let has_octree = self.header.is_copc();
        let is_repacked = is_compressed != self.header.is_compressed || own.is_some();
        let before = match has_octree || is_repacked {
            true => {
                self.require_late()?;
                let found = head::records(&mut self.input, &self.header)?;
                let keeps_laszip = is_compressed && own.is_none();
                let (before, count) = self.before(&found, own, keeps_laszip);
                header[RECORD_COUNT..][..4].copy_from_slice(&count.to_le_bytes());
                before
            }
            false => vec![Slice::Of(layout.vlr_start..layout.points_start)],
        };
        let points_start = header.len() as u64 + before.iter().map(Slice::length).sum::<u64>();
        let points_start = u32::try_from(points_start)
            .map_err(|_| Error::limit("the records before the points exceed 4 GB"))?;
        header[POINTS_START..][..4].copy_from_slice(&points_start.to_le_bytes());
        header[FORMAT] = match is_compressed {
            true => header[FORMAT] | COMPRESSED,
            false => header[FORMAT] & !COMPRESSED,
        };
        let after = self.after(self.tail(is_compressed, &header), has_octree)?;
        Ok(Around {
            header,
            before,
            after,
            laszip,
        })
    }

    /// Returns true if points can be compressed as they were.
    fn can_compress(&self, laszip: &LazVlr) -> bool {
        /// All points in one stream.
        const WHOLE: u16 = 1;
        let size = u64::from(laszip.chunk_size());
        let is_small = size <= MAX_CHUNK_POINTS && size * self.stride() as u64 <= MOST_CHUNK_BYTES;
        let mut payload = Vec::new();
        let is_written = laszip.write_to(&mut payload).is_ok();
        is_written
            && u16_at(&payload, 0) != WHOLE
            && (laszip.uses_variable_size_chunks() || is_small)
    }

    /// Returns what is between the header and the points, and the number of records in it. `own` is
    /// a new record of LASzip.
    fn before(
        &self,
        found: &[Span],
        mut own: Option<Vec<u8>>,
        keeps_laszip: bool,
    ) -> (Vec<Slice>, u32) {
        let layout = self.header.layout;
        let mut slices = Vec::new();
        for Span { record, bytes } in found {
            if is_laszip(record) {
                if let Some(own) = own.take() {
                    slices.push(Slice::New(own));
                } else if keeps_laszip {
                    slices.push(Slice::Of(bytes.clone()));
                }
            } else if !is_of_octree(record) {
                slices.push(Slice::Of(bytes.clone()));
            }
        }
        slices.extend(own.map(Slice::New));
        let count = slices.len() as u32;
        let end = found.last().map_or(layout.vlr_start, |last| last.bytes.end);
        slices.push(Slice::Of(end..layout.points_start));
        (slices, count)
    }

    /// Returns what follows the points.
    ///
    /// # Errors
    /// If the octree has to be left out, and extended records are damaged.
    fn after(&mut self, start: u64, has_octree: bool) -> Result<Vec<Range<u64>>> {
        let end = self.input.length;
        if !has_octree {
            return Ok(std::iter::once(start..end).collect());
        }
        let (mut ranges, mut position) = (Vec::new(), start);
        let found = head::late_records(&mut self.input, &self.header)?;
        for Span { bytes, .. } in found.iter().filter(|span| is_of_octree(&span.record)) {
            ranges.push(position..bytes.start.max(position));
            position = bytes.end.max(position);
        }
        ranges.push(position..end);
        Ok(ranges)
    }

    /// Returns where what follows the points begins. Of compressed points, the end is not stated.
    fn tail(&self, is_compressed: bool, header: &[u8]) -> u64 {
        let layout = self.header.layout;
        let end = match self.header.is_compressed {
            true => layout.points_start,
            false => layout.points_start + self.header.count * self.stride() as u64,
        };
        if !is_compressed && !self.header.is_compressed {
            return end;
        }
        let late = (layout.evlr_count > 0).then_some(layout.evlr_start);
        let starts = late.into_iter().chain(self.waveforms(header));
        let starts = starts.filter(|&start| start >= end);
        starts.fold(self.input.length, u64::min)
    }

    /// Returns where waveforms are in the file, as its header states it.
    fn waveforms(&self, header: &[u8]) -> Option<u64> {
        (self.header.version.1 >= 3).then(|| u64_at(header, WAVEFORM_START))
    }

    /// Returns an error if extended records lie before the points: they would move.
    fn require_late(&self) -> Result<()> {
        let layout = self.header.layout;
        if layout.evlr_count == 0 || layout.evlr_start >= layout.points_start {
            return Ok(());
        }
        Err(Error::format(format!(
            "the extended records are said to begin at byte {}, before the points: the file cannot be copied whole",
            layout.evlr_start
        ))
        .at(format!("byte {LATE_START}"))
        .cure("copy or download the file again"))
    }

    /// Corrects what the header states of things that follow the points, which begin at `end` in
    /// the copy.
    fn move_late(&self, around: &mut Around, end: u64) {
        let after = &around.after;
        let Some(first) = after.first() else {
            return;
        };
        // A position beyond the end of the source points to nothing, and is copied as it is.
        let is_there = |position: u64| (first.start..=self.input.length).contains(&position);
        // The position in the copy of what is at a position of the source, or would be there.
        let moved = |position: u64| {
            let mut at = end;
            for bytes in after {
                if position < bytes.end {
                    return at + position.saturating_sub(bytes.start);
                }
                at += bytes.end - bytes.start;
            }
            at
        };
        let waveforms = self.waveforms(&around.header);
        let header = &mut around.header;
        let mut put = |at: usize, bytes: &[u8]| {
            if let Some(field) = header.get_mut(at..at + bytes.len()) {
                field.copy_from_slice(bytes);
            }
        };
        if let Some(waveforms) = waveforms.filter(|&waveforms| is_there(waveforms)) {
            put(WAVEFORM_START, &moved(waveforms).to_le_bytes());
        }
        let (start, count) = (self.header.layout.evlr_start, self.header.layout.evlr_count);
        if count > 0 && is_there(start) {
            let octrees = after.len() as u64 - 1;
            let left = count - octrees.min(count);
            let start = if left > 0 { moved(start) } else { 0 };
            put(LATE_START, &start.to_le_bytes());
            put(LATE_COUNT, &(left as u32).to_le_bytes());
        }
    }

    fn stride(&self) -> usize {
        self.header.record_length.into()
    }

    /// Writes the classes of points into their records.
    ///
    /// # Errors
    /// If one does not fit.
    fn put_classes(&self, batch: &mut PointBatch) -> Result<()> {
        let records = batch.records.chunks_exact_mut(self.stride());
        let mut classes = batch.class.iter().zip(records);
        if self.header.point_format >= 6 {
            classes.for_each(|(class, record)| record[16] = *class);
            return Ok(());
        }
        classes.try_for_each(|(class, record)| {
            if *class > CLASS_BITS {
                return Err(Error::limit(format!(
                    "class {class} does not fit point format {}, which has classes up to {CLASS_BITS}",
                    self.header.point_format
                )));
            }
            record[15] = record[15] & !CLASS_BITS | class;
            Ok(())
        })
    }

    /// Copies bytes of the source. Errors of writing name the target.
    fn copy_bytes(&mut self, bytes: &Range<u64>, output: &mut Output, target: &Path) -> Result<()> {
        let mut at = bytes.start;
        while at < bytes.end {
            let block = self.input.bytes(at, (bytes.end - at).min(BLOCK) as usize)?;
            if block.is_empty() {
                return Err(Error::format("the file became shorter while it was read")
                    .at(format!("byte {at}")));
            }
            let written = output.write_all(&block);
            written.map_err(|error| Error::from(error).in_file(target))?;
            at += block.len() as u64;
        }
        Ok(())
    }
}

/// The points of a copy.
enum Body {
    Plain(Output),
    Compressed {
        compressor: Box<ParLasZipCompressor<Output>>,
        /// Batches of records that are compressed together; of a file with chunks of many sizes,
        /// each is a chunk.
        waiting: Vec<Vec<u8>>,
        bytes: usize,
        most: usize,
    },
}

impl Body {
    fn of(output: Output, laszip: Option<LazVlr>) -> Result<Self> {
        let Some(laszip) = laszip else {
            return Ok(Body::Plain(output));
        };
        Ok(Body::Compressed {
            compressor: Box::new(ParLasZipCompressor::new(output, laszip).map_err(failed)?),
            waiting: Vec::new(),
            bytes: 0,
            most: BATCH_BYTES * rayon::current_num_threads(),
        })
    }

    /// Takes the records of a batch.
    fn write(&mut self, records: Vec<u8>) -> Result<()> {
        match self {
            Body::Plain(output) => Ok(output.write_all(&records)?),
            Body::Compressed {
                waiting,
                bytes,
                most,
                ..
            } => {
                *bytes += records.len();
                waiting.push(records);
                match *bytes >= *most {
                    true => self.flush(),
                    false => Ok(()),
                }
            }
        }
    }

    fn flush(&mut self) -> Result<()> {
        let Body::Compressed {
            compressor,
            waiting,
            bytes,
            ..
        } = self
        else {
            return Ok(());
        };
        *bytes = 0;
        let records = std::mem::take(waiting);
        if records.is_empty() {
            return Ok(());
        }
        let compressed = compressing(|| match compressor.vlr().uses_variable_size_chunks() {
            true => compressor.compress_chunks(records),
            false => compressor.compress_many(&records.concat()),
        });
        Ok(compressed??)
    }

    /// Writes what waits, and returns the output behind the points.
    fn end(mut self) -> Result<Output> {
        self.flush()?;
        match self {
            Body::Plain(output) => Ok(output),
            Body::Compressed { compressor, .. } => {
                let mut output = ended(compressor)?;
                output.seek(SeekFrom::End(0))?;
                Ok(output)
            }
        }
    }
}
