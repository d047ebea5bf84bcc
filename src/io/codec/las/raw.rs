//! The fixed blocks of a LAS file, field by field as in the specification (ASPRS, LAS 1.0 to 1.5).
//!
//! Nothing is checked here: a field beyond the end of the bytes reads as zero.
//! [`header`](super::header) checks the values.

use crate::io::bytes::little_endian::{f64_at, u8_at, u16_at, u32_at, u64_at};

/// Bytes of the header in every version.
pub(super) const MIN_HEADER: usize = 227;
/// Bytes of a LAS 1.4 header; the time offsets that 1.5 adds are not used.
pub(super) const MAX_HEADER: usize = 375;
/// Bytes before the payload of a variable length record.
pub(super) const VLR_HEADER: usize = 54;
/// Bytes before the payload of an extended variable length record.
pub(super) const EVLR_HEADER: usize = 60;

/// The public header block.
#[derive(Debug, Clone)]
pub(super) struct RawHeader {
    pub(super) global_encoding: u16,
    pub(super) version: (u8, u8),
    pub(super) system: String,
    pub(super) software: String,
    pub(super) day: u16,
    pub(super) year: u16,
    pub(super) header_size: u16,
    pub(super) points_start: u32,
    pub(super) vlr_count: u32,
    /// Point format, including the compression bits of LASzip.
    pub(super) format: u8,
    pub(super) record_length: u16,
    pub(super) legacy_count: u32,
    pub(super) legacy_returns: [u32; 5],
    pub(super) scale: [f64; 3],
    pub(super) offset: [f64; 3],
    pub(super) max: [f64; 3],
    pub(super) min: [f64; 3],
    /// Since LAS 1.3.
    pub(super) waveform_start: u64,
    /// Since LAS 1.4, as all fields below.
    pub(super) evlr_start: u64,
    pub(super) evlr_count: u32,
    pub(super) count: u64,
    pub(super) returns: [u64; 15],
}

impl RawHeader {
    pub(super) fn parse(bytes: &[u8]) -> Self {
        let triple = |at: usize, step: usize| [0, 1, 2].map(|i| f64_at(bytes, at + i * step));
        RawHeader {
            global_encoding: u16_at(bytes, 6),
            version: (u8_at(bytes, 24), u8_at(bytes, 25)),
            system: text_at(bytes, 26, 32),
            software: text_at(bytes, 58, 32),
            day: u16_at(bytes, 90),
            year: u16_at(bytes, 92),
            header_size: u16_at(bytes, 94),
            points_start: u32_at(bytes, 96),
            vlr_count: u32_at(bytes, 100),
            format: u8_at(bytes, 104),
            record_length: u16_at(bytes, 105),
            legacy_count: u32_at(bytes, 107),
            legacy_returns: std::array::from_fn(|i| u32_at(bytes, 111 + 4 * i)),
            scale: triple(131, 8),
            offset: triple(155, 8),
            // Maximum and minimum alternate, axis by axis.
            max: triple(179, 16),
            min: triple(187, 16),
            waveform_start: u64_at(bytes, 227),
            evlr_start: u64_at(bytes, 235),
            evlr_count: u32_at(bytes, 243),
            count: u64_at(bytes, 247),
            returns: std::array::from_fn(|i| u64_at(bytes, 255 + 8 * i)),
        }
    }
}

/// The header of a variable length record, ordinary or extended.
#[derive(Debug, Clone)]
pub(super) struct RawRecordHeader {
    pub(super) user_id: String,
    pub(super) record_id: u16,
    pub(super) length: u64,
    pub(super) description: String,
}

impl RawRecordHeader {
    pub(super) fn parse(bytes: &[u8; VLR_HEADER]) -> Self {
        RawRecordHeader {
            user_id: text_at(bytes, 2, 16),
            record_id: u16_at(bytes, 18),
            length: u16_at(bytes, 20).into(),
            description: text_at(bytes, 22, 32),
        }
    }

    pub(super) fn parse_extended(bytes: &[u8; EVLR_HEADER]) -> Self {
        RawRecordHeader {
            user_id: text_at(bytes, 2, 16),
            record_id: u16_at(bytes, 18),
            length: u64_at(bytes, 20),
            description: text_at(bytes, 28, 32),
        }
    }
}

/// Returns a field of characters without its padding of zeros.
fn text_at(bytes: &[u8], start: usize, length: usize) -> String {
    let field = bytes.get(start..start + length).unwrap_or_default();
    until_zero(field).trim().to_owned()
}

/// Returns the characters before the first zero byte.
pub(super) fn until_zero(bytes: &[u8]) -> std::borrow::Cow<'_, str> {
    let end = bytes
        .iter()
        .position(|&byte| byte == 0)
        .unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end])
}
