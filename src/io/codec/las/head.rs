//! The header and the records of a file as bytes, to be written to another file.

use super::header::Header;
use super::input::Input;
use super::raw::{EVLR_HEADER, RawRecordHeader, VLR_HEADER};
use crate::data::LasHead;
use crate::error::{Error, Result};

/// Limit for the bytes of all records together.
const MAX_BYTES: u64 = 1 << 26;

/// Reads the header and the records of a file, except for records that describe how its points are
/// compressed or where they are found, see [`is_kept`].
///
/// # Errors
/// If records are damaged, or too large together.
pub(super) fn read(input: &mut Input, header: &Header) -> Result<LasHead> {
    let layout = header.layout;
    let file_end = input.length;
    let mut left = MAX_BYTES;
    let mut run =
        |mut position: u64, end: u64, count: u64, is_extended: bool| -> Result<Vec<Vec<u8>>> {
            let size = if is_extended { EVLR_HEADER } else { VLR_HEADER };
            let mut records = Vec::new();
            for number in 1..=count {
                let damaged = |what: String| {
                    Error::format(format!(
                        "record {number} of {count} {what}: the file cannot be copied whole"
                    ))
                    .at(format!("byte {position}"))
                    .cure("copy or download the file again")
                };
                let head = input.bytes(position, size)?;
                let raw = match (head.first_chunk(), head.first_chunk()) {
                    (_, Some(head)) if is_extended => RawRecordHeader::parse_extended(head),
                    (Some(head), _) if !is_extended => RawRecordHeader::parse(head),
                    _ => return Err(damaged("is not there".into())),
                };
                let payload = position + size as u64;
                let Some(next) = payload.checked_add(raw.length).filter(|&next| next <= end) else {
                    return Err(damaged(format!(
                        "states {} bytes, but {} are left",
                        raw.length,
                        end.saturating_sub(payload)
                    )));
                };
                if is_kept(&raw) {
                    left = left.checked_sub(raw.length).ok_or_else(|| {
                        Error::limit(format!(
                            "the records of the file exceed the limit of {MAX_BYTES} bytes together"
                        ))
                        .at(format!("byte {position}"))
                    })?;
                    records.push([head, input.bytes(payload, raw.length as usize)?].concat());
                }
                position = next;
            }
            Ok(records)
        };
    let records = run(
        layout.vlr_start,
        layout.points_start,
        layout.vlr_count,
        false,
    )?;
    let late_records = match layout.evlr_count {
        0 => Vec::new(),
        count => run(layout.evlr_start, file_end, count, true)?,
    };
    Ok(LasHead {
        header: input.bytes(0, layout.vlr_start as usize)?,
        point_format: header.point_format,
        record_length: header.record_length,
        records,
        late_records,
    })
}

/// Returns false for records that are valid for the bytes of one file only: the table of LASzip,
/// the indices of COPC and LAStools.
fn is_kept(record: &RawRecordHeader) -> bool {
    !matches!(
        (record.user_id.as_str(), record.record_id),
        ("laszip encoded", 22204) | ("copc", _) | ("LAStools", 30)
    )
}
