//! The header and the records of a file as bytes, to be written to another file.

use std::ops::Range;

use super::header::{FileLayout, Header};
use super::input::Input;
use super::raw::{EVLR_HEADER, RawRecordHeader, VLR_HEADER};
use crate::data::LasHead;
use crate::error::{Error, Result};

/// Limit for the bytes of all records together.
const MAX_BYTES: u64 = 1 << 26;

/// A record of a file, and where its bytes are, with those of its own header.
#[derive(Debug)]
pub(super) struct Span {
    pub(super) record: RawRecordHeader,
    pub(super) bytes: Range<u64>,
}

/// Returns the records between the header and the points, in order.
///
/// # Errors
/// If one is damaged.
pub(super) fn records(input: &mut Input, header: &Header) -> Result<Vec<Span>> {
    let layout = header.layout;
    let end = layout.points_start;
    spans(input, layout.vlr_start..end, layout.vlr_count, false)
}

/// Returns the extended records, in order.
///
/// # Errors
/// If one is damaged.
pub(super) fn late_records(input: &mut Input, header: &Header) -> Result<Vec<Span>> {
    match header.layout {
        FileLayout { evlr_count: 0, .. } => Ok(Vec::new()),
        FileLayout {
            evlr_start,
            evlr_count,
            ..
        } => {
            let end = input.length;
            spans(input, evlr_start..end, evlr_count, true)
        }
    }
}

fn spans(
    input: &mut Input,
    within: Range<u64>,
    count: u64,
    is_extended: bool,
) -> Result<Vec<Span>> {
    let size = if is_extended { EVLR_HEADER } else { VLR_HEADER };
    let mut position = within.start;
    let mut spans = Vec::new();
    for number in 1..=count {
        let damaged = |what: String| {
            Error::format(format!(
                "record {number} of {count} {what}: the file cannot be copied whole"
            ))
            .at(format!("byte {position}"))
            .cure("copy or download the file again")
        };
        let head = input.bytes(position, size)?;
        let record = match (head.first_chunk(), head.first_chunk()) {
            (_, Some(head)) if is_extended => RawRecordHeader::parse_extended(head),
            (Some(head), _) if !is_extended => RawRecordHeader::parse(head),
            _ => return Err(damaged("is not there".into())),
        };
        let payload = position + size as u64;
        let next = payload.checked_add(record.length);
        let Some(next) = next.filter(|&next| next <= within.end) else {
            return Err(damaged(format!(
                "states {} bytes, but {} are left",
                record.length,
                within.end.saturating_sub(payload)
            )));
        };
        spans.push(Span {
            record,
            bytes: position..next,
        });
        position = next;
    }
    Ok(spans)
}

/// Reads the header and the records of a file, except for records that describe how its points are
/// compressed or where they are found, see [`is_kept`].
///
/// # Errors
/// If records are damaged, or too large together.
pub(super) fn read(input: &mut Input, header: &Header) -> Result<LasHead> {
    let mut left = MAX_BYTES;
    let mut kept = |input: &mut Input, spans: Vec<Span>| -> Result<Vec<Vec<u8>>> {
        let kept = spans.into_iter().filter(|span| is_kept(&span.record));
        kept.map(|Span { record, bytes }| {
            left = left.checked_sub(record.length).ok_or_else(|| {
                Error::limit(format!(
                    "the records of the file exceed the limit of {MAX_BYTES} bytes together"
                ))
                .at(format!("byte {}", bytes.start))
            })?;
            Ok(input.bytes(bytes.start, (bytes.end - bytes.start) as usize)?)
        })
        .collect()
    };
    let spans = records(input, header)?;
    let records = kept(input, spans)?;
    let spans = late_records(input, header)?;
    let late_records = kept(input, spans)?;
    Ok(LasHead {
        header: input.bytes(0, header.layout.vlr_start as usize)?,
        point_format: header.point_format,
        record_length: header.record_length,
        records,
        late_records,
    })
}

/// Returns false for records that are valid for the bytes of one file only: the table of LASzip,
/// the indices of COPC and LAStools.
fn is_kept(record: &RawRecordHeader) -> bool {
    let is_index_of_lastools = record.user_id == "LAStools" && record.record_id == 30;
    !is_laszip(record) && !is_of_octree(record) && !is_index_of_lastools
}

/// Returns true for the record that states how points are compressed.
pub(super) fn is_laszip(record: &RawRecordHeader) -> bool {
    record.user_id == "laszip encoded" && record.record_id == 22204
}

/// Returns true for the records of COPC.
pub(super) fn is_of_octree(record: &RawRecordHeader) -> bool {
    record.user_id == "copc"
}
