//! Reads uncompressed points.

use std::io::{Read, Seek, SeekFrom};

use super::header::Header;
use super::input::Input;
use super::record::RecordLayout;
use crate::data::PointBatch;
use crate::error::{Result, Wording};
use crate::io::OnDamage;
use crate::io::options::las::ReadOptions;

/// Limit for the points in a batch, and for the bytes of their records.
const BATCH_POINTS: usize = 1 << 17;
const BATCH_BYTES: usize = 1 << 22;

/// Points that are read together when most are passed over, as many as LASzip has in a chunk.
const PART_POINTS: u64 = 50_000;

/// Reads records in order, as many as the file contains.
#[derive(Debug)]
pub(super) struct Plain {
    input: Input,
    layout: RecordLayout,
    left: u64,
    /// Points between two batches that are not read.
    passed_over: u64,
    /// The most points in a batch.
    most: u64,
    cut: OnDamage,
    buffer: Vec<u8>,
}

impl Plain {
    /// Determines how many records there are, whatever the header states.
    pub(super) fn new(
        mut input: Input,
        header: &Header,
        ReadOptions { cut, detail }: ReadOptions,
        warnings: &mut Vec<Wording>,
    ) -> Result<Self> {
        let layout = RecordLayout::new(header, detail);
        let start = header.layout.points_start;
        let bytes = header.layout.points_end - start;
        let room = bytes / layout.stride as u64;
        if room < header.count {
            let torn = match bytes % layout.stride as u64 {
                0 => String::new(),
                rest => format!(" and {rest} bytes of another"),
            };
            let text = format!(
                "the header states {} points, but the file holds {room}{torn}: it was cut, or its header is wrong",
                header.count
            );
            cut.refuse_or_warn(
                text,
                &format!("byte {}", header.layout.points_end),
                warnings,
            )?;
        } else if header.count == 0 && room > 0 {
            warnings.push(
                format!(
                    "the header states 0 points, but {bytes} bytes follow it, room for {room}: the file may be \
                 unfinished; nothing is read"
                )
                .into(),
            );
        } else if header.count < room {
            let more = room - header.count;
            warnings.push(
                format!(
                    "the header states {} points, but there is room for {more} more before the end: they are not read",
                    header.count
                )
                .into(),
            );
        }
        input.file.seek(SeekFrom::Start(start))?;
        let most = (BATCH_BYTES / layout.stride).clamp(1, BATCH_POINTS) as u64;
        Ok(Plain {
            input,
            layout,
            left: room.min(header.count),
            passed_over: 0,
            most,
            cut,
            buffer: Vec::new(),
        })
    }

    pub(super) fn thin(&mut self, spacing: u64) -> bool {
        self.most = self.most.min(PART_POINTS).min(spacing.max(1));
        self.passed_over = spacing.saturating_sub(self.most);
        true
    }

    pub(super) fn read(
        &mut self,
        batch: &mut PointBatch,
        warnings: &mut Vec<Wording>,
    ) -> Result<()> {
        let stride = self.layout.stride;
        let count = self.left.min(self.most) as usize;
        self.buffer.clear();
        (&self.input.file)
            .take((count * stride) as u64)
            .read_to_end(&mut self.buffer)?;
        let whole = self.buffer.len() / stride;
        self.layout.append(&self.buffer[..whole * stride], batch);
        self.left -= whole as u64;
        if whole < count {
            let missing = std::mem::take(&mut self.left);
            let text =
                format!("the file became shorter while it was read: {missing} points are missing");
            self.cut
                .refuse_or_warn(text, &format!("byte {}", self.input.length), warnings)?;
        }
        let passed_over = self.left.min(self.passed_over);
        if passed_over > 0 {
            self.input
                .file
                .seek_relative((passed_over * stride as u64) as i64)?;
            self.left -= passed_over;
        }
        Ok(())
    }
}
