//! The numbers of the schema: slots of tables, types of geometries and of columns.

/// The first bytes; the last of them is the patch level of the version.
pub(super) const MAGIC: &[u8; 8] = b"fgb\x03fgb\x01";

/// Bytes of the magic that are compared.
pub(super) const MAGIC_COMPARED: usize = 7;

/// Slots of the header.
pub(super) mod header {
    pub(in super::super) const NAME: usize = 0;
    pub(in super::super) const ENVELOPE: usize = 1;
    pub(in super::super) const KIND: usize = 2;
    pub(in super::super) const HAS_Z: usize = 3;
    pub(in super::super) const COLUMNS: usize = 7;
    pub(in super::super) const COUNT: usize = 8;
    pub(in super::super) const NODE_SIZE: usize = 9;
    pub(in super::super) const CRS: usize = 10;
}

/// Slots of a column.
pub(super) mod column {
    pub(in super::super) const NAME: usize = 0;
    pub(in super::super) const KIND: usize = 1;
}

/// Slots of a coordinate system.
pub(super) mod crs {
    pub(in super::super) const ORGANIZATION: usize = 0;
    pub(in super::super) const CODE: usize = 1;
    pub(in super::super) const NAME: usize = 2;
    pub(in super::super) const WKT: usize = 4;
}

/// Slots of a record.
pub(super) mod feature {
    pub(in super::super) const GEOMETRY: usize = 0;
    pub(in super::super) const PROPERTIES: usize = 1;
    pub(in super::super) const COLUMNS: usize = 2;
}

/// Slots of a geometry.
pub(super) mod geometry {
    pub(in super::super) const ENDS: usize = 0;
    pub(in super::super) const XY: usize = 1;
    pub(in super::super) const Z: usize = 2;
    pub(in super::super) const KIND: usize = 6;
    pub(in super::super) const PARTS: usize = 7;
}

/// Types of geometries.
pub(super) mod kind {
    pub(in super::super) const UNKNOWN: u8 = 0;
    pub(in super::super) const POINT: u8 = 1;
    pub(in super::super) const LINE: u8 = 2;
    pub(in super::super) const POLYGON: u8 = 3;
    pub(in super::super) const MULTI_POINT: u8 = 4;
    pub(in super::super) const MULTI_LINE: u8 = 5;
    pub(in super::super) const MULTI_POLYGON: u8 = 6;
    pub(in super::super) const COLLECTION: u8 = 7;
    pub(in super::super) const POLYHEDRAL_SURFACE: u8 = 15;
    pub(in super::super) const TIN: u8 = 16;
    pub(in super::super) const TRIANGLE: u8 = 17;
}

/// Types of columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ColumnType {
    Byte,
    UByte,
    Bool,
    Short,
    UShort,
    Int,
    UInt,
    Long,
    ULong,
    Float,
    Double,
    String,
    Json,
    DateTime,
    Binary,
}

impl ColumnType {
    /// All types by their numbers.
    pub(super) const ALL: [Self; 15] = [
        Self::Byte,
        Self::UByte,
        Self::Bool,
        Self::Short,
        Self::UShort,
        Self::Int,
        Self::UInt,
        Self::Long,
        Self::ULong,
        Self::Float,
        Self::Double,
        Self::String,
        Self::Json,
        Self::DateTime,
        Self::Binary,
    ];

    /// Returns the bytes of a value; `None` if its length comes before it.
    pub(super) fn size(self) -> Option<usize> {
        Some(match self {
            Self::Byte | Self::UByte | Self::Bool => 1,
            Self::Short | Self::UShort => 2,
            Self::Int | Self::UInt | Self::Float => 4,
            Self::Long | Self::ULong | Self::Double => 8,
            Self::String | Self::Json | Self::DateTime | Self::Binary => return None,
        })
    }
}
