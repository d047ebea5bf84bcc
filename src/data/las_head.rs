/// The content of a LAS file apart from its points, as bytes, so that points can be copied to
/// another file without loss.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LasHead {
    /// The header.
    pub header: Vec<u8>,
    /// Point format, 0 to 10.
    pub point_format: u8,
    /// Bytes of an uncompressed point record.
    pub record_length: u16,
    /// Variable length records between header and points, each with its own header of 54 bytes.
    pub records: Vec<Vec<u8>>,
    /// Extended variable length records, each with its own header of 60 bytes.
    pub late_records: Vec<Vec<u8>>,
}
