//! What a `.shp` and a `.shx` begin with.

/// The first four bytes of a `.shp` and a `.shx`, big-endian.
pub(super) const FILE_CODE: u32 = 9994;

/// Bytes before the first record.
pub(super) const HEADER: u64 = 100;
