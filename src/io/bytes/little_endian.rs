//! Numbers in bytes, the lowest byte first, at any position.
//!
//! Nothing is checked: a number beyond the end of the bytes reads as zero.

/// Returns the bytes that begin at a position; `None` if there are fewer.
pub(crate) fn array_at<const N: usize>(bytes: &[u8], start: usize) -> Option<[u8; N]> {
    bytes.get(start..)?.first_chunk().copied()
}

fn array_or_zeros<const N: usize>(bytes: &[u8], start: usize) -> [u8; N] {
    array_at(bytes, start).unwrap_or([0; N])
}

pub(crate) fn u8_at(bytes: &[u8], start: usize) -> u8 {
    u8::from_le_bytes(array_or_zeros(bytes, start))
}

pub(crate) fn u16_at(bytes: &[u8], start: usize) -> u16 {
    u16::from_le_bytes(array_or_zeros(bytes, start))
}

pub(crate) fn u32_at(bytes: &[u8], start: usize) -> u32 {
    u32::from_le_bytes(array_or_zeros(bytes, start))
}

pub(crate) fn u64_at(bytes: &[u8], start: usize) -> u64 {
    u64::from_le_bytes(array_or_zeros(bytes, start))
}

pub(crate) fn f32_at(bytes: &[u8], start: usize) -> f32 {
    f32::from_le_bytes(array_or_zeros(bytes, start))
}

pub(crate) fn f64_at(bytes: &[u8], start: usize) -> f64 {
    f64::from_le_bytes(array_or_zeros(bytes, start))
}
