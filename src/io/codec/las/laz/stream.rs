//! Decodes points in order, without knowing where chunks begin.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Seek, SeekFrom};

use laz::record::{RecordDecompressor, SequentialPointRecordDecompressor};

use super::chunk::BLOCK;
use super::compression::{ChunkSize, Compression};
use super::table::POINTER;
use crate::data::PointBatch;
use crate::error::{Error, Result, Wording};
use crate::io::OnDamage;
use crate::io::bytes::contain::contain;
use crate::io::codec::las::header::Header;
use crate::io::codec::las::input::Input;
use crate::io::codec::las::record::RecordLayout;
use crate::io::options::las::ReadOptions;

/// Number of blocks in a batch.
const BATCH: usize = 256;

/// A decoder for files in point order without chunks or with chunks of one size: each chunk begins
/// where the previous one ended.
pub(crate) struct Stream {
    decoder: SequentialPointRecordDecompressor<'static, BufReader<File>>,
    compression: Compression,
    layout: RecordLayout,
    chunk_size: u64,
    in_chunk: u64,
    done: u64,
    total: u64,
    cut: OnDamage,
    length: u64,
    block: Vec<u8>,
}

impl std::fmt::Debug for Stream {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Stream")
            .field("done", &self.done)
            .field("total", &self.total)
            .finish_non_exhaustive()
    }
}

/// Why decoding stopped.
enum Stop {
    /// The bytes ran out.
    End,
    Failed(std::io::Error),
}

impl Stream {
    pub(super) fn new(
        input: Input,
        compression: Compression,
        header: &Header,
        options: ReadOptions,
    ) -> Result<Self> {
        let length = input.length;
        let start = header.layout.points_start;
        let (start, chunk_size) = match compression.chunks {
            ChunkSize::Whole => (start, u64::MAX),
            ChunkSize::Fixed(size) => (start + POINTER, size),
            ChunkSize::Variable => (start + POINTER, 0),
        };
        let mut file = input.file;
        file.seek(SeekFrom::Start(start))?;
        let mut decoder =
            SequentialPointRecordDecompressor::new(BufReader::with_capacity(1 << 16, file));
        decoder
            .set_fields_from(&compression.items)
            .map_err(|error| Error::format(error.to_string()))?;
        let layout = RecordLayout::new(header, options.detail);
        let block = vec![0; BLOCK * layout.stride];
        Ok(Stream {
            decoder,
            compression,
            layout,
            chunk_size,
            in_chunk: 0,
            done: 0,
            total: header.count,
            cut: options.cut,
            length,
            block,
        })
    }

    pub(super) fn read(
        &mut self,
        batch: &mut PointBatch,
        warnings: &mut Vec<Wording>,
    ) -> Result<()> {
        for _ in 0..BATCH {
            let count = (self.total - self.done).min(BLOCK as u64) as usize;
            let mut whole = 0;
            let result = contain(|| self.decode_block(count, &mut whole));
            if result.is_some() {
                self.layout
                    .append(&self.block[..whole * self.layout.stride], batch);
                self.done += whole as u64;
            }
            match result {
                Some(Ok(())) => {}
                Some(Err(Stop::End)) => {
                    let total = std::mem::replace(&mut self.total, self.done);
                    let text = format!(
                        "the file ends within its compressed points: {} of {total} are read",
                        self.done
                    );
                    self.cut
                        .refuse_or_warn(text, &format!("byte {}", self.length), warnings)?;
                }
                Some(Err(Stop::Failed(error))) => {
                    return Err(Error::from(error).at(format!("point {}", self.done)));
                }
                None => {
                    return Err(Error::format(
                        "the compressed points are damaged: the decoder found an impossible value",
                    )
                    .at(format!("point {}", self.done))
                    .cure("copy or download the file again"));
                }
            }
            if self.done == self.total {
                break;
            }
        }
        Ok(())
    }

    /// Decodes `count` records into the block; `whole` counts the complete ones.
    fn decode_block(&mut self, count: usize, whole: &mut usize) -> std::result::Result<(), Stop> {
        for record in self.block.chunks_exact_mut(self.layout.stride).take(count) {
            if self.in_chunk == self.chunk_size {
                self.decoder.reset();
                let fields = self.decoder.set_fields_from(&self.compression.items);
                fields.map_err(|error| Stop::Failed(std::io::Error::other(error)))?;
                self.in_chunk = 0;
            }
            self.decoder
                .decompress_next(record)
                .map_err(|error| match error.kind() {
                    ErrorKind::UnexpectedEof => Stop::End,
                    _ => Stop::Failed(error),
                })?;
            self.in_chunk += 1;
            *whole += 1;
        }
        Ok(())
    }
}
