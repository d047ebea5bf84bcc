//! What writers of compressed points share.

use laz::{LazItem, LazItemRecordBuilder, LazVlr, ParLasZipCompressor};

use super::merge;
use crate::error::{Error, Kind, Result};
use crate::io::bytes::contain::contain;
use crate::io::bytes::output::Output;

/// Returns the items into which LASzip divides a record, for the point format and extra bytes.
///
/// # Errors
/// If it does not know the point format.
pub(super) fn items(point_format: u8, record_length: u16) -> Result<Vec<LazItem>> {
    let extra = record_length - merge::usual_length(point_format);
    LazItemRecordBuilder::default_for_point_format_id(point_format, extra).map_err(failed)
}

/// Returns the record by which points are decompressed, with its header.
///
/// # Errors
/// If it cannot be made.
pub(super) fn laszip_record(items: &LazVlr) -> Result<Vec<u8>> {
    let mut payload = Vec::new();
    items.write_to(&mut payload)?;
    let length = payload.len() as u16;
    let (user, id) = (LazVlr::USER_ID, LazVlr::RECORD_ID);
    let mut record = merge::record_header(user, id, length, LazVlr::DESCRIPTION);
    record.extend(payload);
    Ok(record)
}

/// Runs a compressor.
///
/// # Errors
/// If it panics.
pub(super) fn compressing<T>(compress: impl FnOnce() -> T) -> Result<T> {
    contain(compress).ok_or_else(|| Error::format("compressing the points failed"))
}

/// Ends the compressed points, and returns the output, anywhere in them.
///
/// # Errors
/// If the last points cannot be compressed or written.
pub(super) fn ended(mut compressor: Box<ParLasZipCompressor<Output>>) -> Result<Output> {
    compressing(|| compressor.done())?.map_err(failed)?;
    Ok(compressor.into_inner())
}

/// Returns the error of a compressor.
#[cold]
pub(super) fn failed(error: laz::LasZipError) -> Error {
    match error {
        laz::LasZipError::IoError(error) => error.into(),
        other => Error::caused_by(Kind::Unsupported, other),
    }
}
