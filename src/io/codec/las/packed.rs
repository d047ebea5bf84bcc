//! What writers of compressed points share.

use laz::LazItemRecordBuilder;

use super::merge;
use crate::data::LasHead;
use crate::error::{Error, Kind, Result};

/// Returns the items into which LASzip divides a record, for the point format and extra bytes.
///
/// # Errors
/// If it does not know the point format.
pub(super) fn items(head: &LasHead) -> Result<Vec<laz::LazItem>> {
    let extra = head.record_length - merge::usual_length(head.point_format);
    LazItemRecordBuilder::default_for_point_format_id(head.point_format, extra).map_err(failed)
}

/// Returns the error of a compressor.
#[cold]
pub(super) fn failed(error: laz::LasZipError) -> Error {
    match error {
        laz::LasZipError::IoError(error) => error.into(),
        other => Error::caused_by(Kind::Unsupported, other),
    }
}
