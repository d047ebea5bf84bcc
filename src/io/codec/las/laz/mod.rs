//! Compressed points: the `laz` crate decodes, this module decides what it receives.
//!
//! The crate's own readers trust the chunk table, decode all fields, and end with an error or a
//! panic if bytes are missing. Here the table is checked against the file first, chunks are decoded
//! in memory by all threads, and only those layers of layered chunks (formats 6 to 10) are decoded
//! that the columns need.

mod ahead;
mod chunk;
mod compression;
mod octree;
mod stream;
mod table;

use std::collections::VecDeque;
use std::sync::Arc;

use self::ahead::Ahead;
use self::compression::{ChunkSize, Compression, Order};
use self::octree::Octree;
use self::stream::Stream;
use self::table::Chunk;
use super::header::Header;
use super::input::Input;
use super::record::RecordLayout;
use super::records::Payloads;
use crate::data::{Bounds, PartRead, PointBatch};
use crate::error::{Error, Result, Wording};
use crate::io::OnDamage;
use crate::io::options::las::ReadOptions;

/// Chunks decoded ahead, per thread.
const CHUNKS_PER_THREAD: usize = 2;

/// Points decoded ahead, per thread; at least one chunk is always decoded.
const POINTS_PER_THREAD: u64 = 1 << 18;

/// Limit for the points of a chunk that is decoded at once. LASzip writes 50 000; COPC some 100
/// 000.
pub(super) const MAX_CHUNK_POINTS: u64 = 1 << 23;

/// Limit for the points per byte. Real points take a byte or more each, points on a flat, regular
/// grid a few tenths of a byte.
const MAX_POINTS_PER_BYTE: u64 = 16;

/// This many points are accepted however few bytes they take, for example if all are at one
/// position.
const ALWAYS_ACCEPTED: u64 = 1 << 24;

/// Reads the points of a LAZ file.
#[derive(Debug)]
pub(super) enum Laz {
    /// Chunk by chunk, with several threads.
    Chunks(Chunks),
    /// As a stream, with one thread; used if chunks cannot be found or are too large.
    Stream(Stream),
}

impl Laz {
    pub(super) fn new(
        mut input: Input,
        header: &Header,
        payloads: Payloads,
        options: ReadOptions,
        warnings: &mut Vec<Wording>,
    ) -> Result<Self> {
        let compression = Compression::check(payloads.laszip.as_deref(), header)?;
        check_count(header)?;
        let is_streamed = match compression.chunks {
            ChunkSize::Whole => true,
            ChunkSize::Fixed(size) => {
                compression.order == Order::Pointwise && size > MAX_CHUNK_POINTS
            }
            ChunkSize::Variable => false,
        };
        if is_streamed {
            return Ok(Laz::Stream(Stream::new(
                input,
                compression,
                header,
                options,
            )?));
        }
        let chunks = match table::read(&mut input, &compression, header) {
            Ok(chunks) => chunks,
            _ if header.count == 0 => Vec::new(),
            Err(reason) if matches!(compression.order, Order::Layered(_)) => {
                let chunks = table::walk(&mut input, &compression, header)?;
                warnings
                    .push(format!("{reason}; the chunks are found by their own headers").into());
                chunks
            }
            Err(reason) if compression.chunks == ChunkSize::Variable => {
                return Err(Error::format(format!(
                    "{reason}, and chunks of different sizes cannot be found without it"
                ))
                .at(format!("byte {}", header.layout.points_start))
                .cure("copy or download the file again"));
            }
            Err(reason) => {
                warnings
                    .push(format!("{reason}; the points are decoded one after the other").into());
                return Ok(Laz::Stream(Stream::new(
                    input,
                    compression,
                    header,
                    options,
                )?));
            }
        };
        let found = chunks.last().map_or(0, |chunk| chunk.first + chunk.points);
        if found < header.count {
            let text = format!(
                "the header states {} points, but the file holds {found} in whole chunks: it was cut, or its header \
                 is wrong",
                header.count
            );
            options
                .cut
                .refuse_or_warn(text, &format!("byte {}", input.length), warnings)?;
        }
        if let Some(chunk) = chunks.iter().find(|chunk| chunk.points > MAX_CHUNK_POINTS) {
            return Err(Error::limit(format!(
                "a chunk of {} points; at most {MAX_CHUNK_POINTS} are supported",
                chunk.points
            ))
            .at(format!("byte {}", chunk.start))
            .cure("compress the file again with chunks of 50000 points"));
        }
        Ok(Laz::Chunks(Chunks {
            layout: RecordLayout::new(header, options.detail),
            input,
            compression: Arc::new(compression),
            index: payloads.copc.map_or(Index::None, Index::Unread),
            scale: header.scale,
            cut: options.cut,
            waiting: chunks.into(),
            decoding: VecDeque::new(),
            spare: Vec::new(),
        }))
    }

    /// See [`PointSource::narrow`](crate::data::PointSource::narrow).
    pub(super) fn narrow(
        &mut self,
        window: &Bounds,
        warnings: &mut Vec<Wording>,
    ) -> Result<Option<PartRead>> {
        match self {
            Laz::Chunks(chunks) => chunks.restrict(warnings, |octree| {
                Ok(|chunk: &Chunk| octree.meets(chunk, window))
            }),
            Laz::Stream(_) => Ok(None),
        }
    }

    /// See [`PointSource::coarsen`](crate::data::PointSource::coarsen).
    pub(super) fn coarsen(
        &mut self,
        spacing: f64,
        warnings: &mut Vec<Wording>,
    ) -> Result<Option<PartRead>> {
        match self {
            Laz::Chunks(chunks) => chunks.restrict(warnings, |octree| {
                let deepest = octree.level_of(spacing)?;
                Ok(move |chunk: &Chunk| octree.level(chunk) <= deepest)
            }),
            Laz::Stream(_) => Ok(None),
        }
    }

    pub(super) fn thin(&mut self, spacing: u64) -> bool {
        match self {
            Laz::Chunks(chunks) => {
                thin_out(&mut chunks.waiting, spacing);
                true
            }
            Laz::Stream(_) => false,
        }
    }

    pub(super) fn read(
        &mut self,
        batch: &mut PointBatch,
        warnings: &mut Vec<Wording>,
    ) -> Result<()> {
        match self {
            Laz::Chunks(chunks) => chunks.read(batch),
            Laz::Stream(stream) => stream.read(batch, warnings),
        }
    }
}

/// Returns an error if there are too many points for so few bytes: from zeros, for example, a
/// decoder makes a thousand points per byte.
fn check_count(header: &Header) -> Result<()> {
    let bytes = header.layout.points_end - header.layout.points_start;
    if header.count <= ALWAYS_ACCEPTED.max(bytes.saturating_mul(MAX_POINTS_PER_BYTE)) {
        return Ok(());
    }
    Err(Error::limit(format!(
        "{} points in {bytes} bytes; at most {MAX_POINTS_PER_BYTE} points in a byte are read",
        header.count
    ))
    .at(format!("byte {}", header.layout.points_start))
    .cure("the header is damaged, or the file was made to overload programs: get it again from its producer"))
}

/// Returns chunks one by one, while other threads decode the next ones.
#[derive(Debug)]
pub(super) struct Chunks {
    input: Input,
    compression: Arc<Compression>,
    layout: RecordLayout,
    index: Index,
    /// The step of coordinates.
    scale: [f64; 3],
    cut: OnDamage,
    waiting: VecDeque<Chunk>,
    /// The next chunks in order, each with the number of its points.
    decoding: VecDeque<(u64, Ahead<Result<PointBatch>>)>,
    /// Batches whose memory is reused.
    spare: Vec<PointBatch>,
}

/// Where the chunks of a file are in the plane.
#[derive(Debug)]
enum Index {
    /// It is not known.
    None,
    /// An octree is described by this record.
    Unread(Vec<u8>),
    Read(Arc<Octree>),
}

impl Chunks {
    /// Leaves out chunks by the octree, if there is one. It is read at the first call, which comes
    /// before a chunk is decoded or left out.
    fn restrict<'a, Keep: Fn(&Chunk) -> bool>(
        &'a mut self,
        warnings: &mut Vec<Wording>,
        keep: impl FnOnce(&'a Octree) -> Result<Keep>,
    ) -> Result<Option<PartRead>> {
        if let Index::Unread(info) = &self.index {
            let chunks = self.waiting.make_contiguous();
            self.index = match Octree::read(&mut self.input, info, self.scale, chunks) {
                Ok(octree) => Index::Read(Arc::new(octree)),
                Err(error) if self.cut == OnDamage::Accept => {
                    warnings.push(format!("{error}; all points are read").into());
                    Index::None
                }
                Err(error) => return Err(error),
            };
        }
        let Index::Read(octree) = &self.index else {
            return Ok(None);
        };
        let keep = keep(octree)?;
        let of = self.waiting.len();
        self.waiting.retain(keep);
        Ok(Some(PartRead {
            parts: self.waiting.len(),
            of,
            points: self.waiting.iter().map(|chunk| chunk.points).sum(),
        }))
    }

    fn read(&mut self, batch: &mut PointBatch) -> Result<()> {
        self.decode_ahead();
        if let Some((_, decoded)) = self.decoding.pop_front() {
            self.spare.push(std::mem::replace(batch, decoded.take()?));
        }
        Ok(())
    }

    /// Starts to decode as many chunks as are decoded ahead.
    fn decode_ahead(&mut self) {
        let threads = rayon::current_num_threads();
        let mut points: u64 = self.decoding.iter().map(|(points, _)| points).sum();
        while let Some(&chunk) = self.waiting.front() {
            points += chunk.points;
            let is_full = self.decoding.len() == CHUNKS_PER_THREAD * threads
                || points > POINTS_PER_THREAD * threads as u64;
            if is_full && !self.decoding.is_empty() {
                break;
            }
            self.waiting.pop_front();
            let decoding = self.decode(chunk);
            self.decoding.push_back((chunk.points, decoding));
        }
    }

    /// Starts to decode a chunk.
    fn decode(&mut self, chunk: Chunk) -> Ahead<Result<PointBatch>> {
        let bytes = match self.input.bytes(chunk.start, chunk.bytes as usize) {
            Ok(bytes) => bytes,
            Err(error) => return Ahead::known(Err(error.into())),
        };
        let (compression, layout) = (Arc::clone(&self.compression), self.layout);
        let octree = match &self.index {
            Index::Read(octree) => Some(Arc::clone(octree)),
            Index::None | Index::Unread(_) => None,
        };
        let mut batch = self.spare.pop().unwrap_or_default();
        Ahead::start(move || {
            batch.clear();
            match chunk::decode(&bytes, chunk.points, &compression, layout, &mut batch) {
                Ok(()) => octree
                    .map_or(Ok(()), |octree| octree.check(&chunk, &batch))
                    .map(|()| batch),
                Err(reason) => Err(damaged(&chunk, &reason)),
            }
        })
    }
}

/// Keeps one chunk for every `spacing` points, on average. Chunks are counted, and not their
/// points, because those of COPC differ in size, and large ones must not be more likely.
fn thin_out(chunks: &mut VecDeque<Chunk>, spacing: u64) {
    let count = chunks.len() as u64;
    let average = (chunks.iter().map(|chunk| chunk.points).sum::<u64>() / count.max(1)).max(1);
    let every = (spacing.saturating_add(average / 2) / average).max(1);
    chunks.retain(|chunk| (chunk.number as u64 - 1).is_multiple_of(every));
}

fn damaged(chunk: &Chunk, reason: &str) -> Error {
    let Chunk {
        number,
        start,
        first,
        points,
        ..
    } = *chunk;
    Error::format(format!("the compressed points are damaged: {reason}"))
        .at(format!(
            "chunk {number} at byte {start} (points {first} to {})",
            first + points - 1
        ))
        .cure("copy or download the file again")
}

/// Returns the offsets of the chunks of a file.
#[cfg(test)]
pub(super) fn chunks_of(bytes: &[u8]) -> Vec<u64> {
    let mut input = Input::spool(bytes, std::path::Path::new("test")).unwrap();
    let mut header = Header::check(bytes, input.length, &mut Vec::new()).unwrap();
    let payloads = super::records::read(&input, &mut header, &mut Vec::new()).unwrap();
    let compression = Compression::check(payloads.laszip.as_deref(), &header).unwrap();
    let chunks = table::read(&mut input, &compression, &header).unwrap();
    if matches!(compression.order, Order::Layered(_)) {
        assert_eq!(
            table::walk(&mut input, &compression, &header).unwrap(),
            chunks
        );
    }
    chunks.iter().map(|chunk| chunk.start).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_chunks_are_as_likely_as_large_ones() {
        let sizes = (0..4_000).map(|i| if i < 40 { 50_000 } else { 1_000 });
        let chunks = (1..).zip(sizes).map(|(number, points)| Chunk {
            number,
            start: 0,
            bytes: 1,
            first: 0,
            points,
        });
        let all: VecDeque<Chunk> = chunks.collect();
        for spacing in [0, 1, 3_000, 15_000, 60_000, u64::MAX] {
            let mut kept = all.clone();
            thin_out(&mut kept, spacing);
            let share = |size: u64| {
                let count = |chunks: &VecDeque<Chunk>| {
                    chunks.iter().filter(|chunk| chunk.points == size).count() as f64
                };
                count(&kept) / count(&all)
            };
            assert!(
                !kept.is_empty() && (share(50_000) - share(1_000)).abs() < 0.026,
                "{spacing}"
            );
            assert!(spacing > 1 || kept.len() == all.len());
        }
    }
}
