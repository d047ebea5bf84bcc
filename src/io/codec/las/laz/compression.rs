//! How the points are compressed: the `laszip encoded` record, checked.

use laz::record::{
    LayeredPointRecordDecompressor, RecordDecompressor, SequentialPointRecordDecompressor,
};
use laz::{LasZipError, LazItem, LazItemType, LazVlr};

use crate::error::{Error, Result};
use crate::io::bytes::little_endian::{u16_at, u32_at};
use crate::io::codec::las::header::Header;

/// Bytes of a point of format 6, with which every layered chunk begins.
pub(super) const POINT14: usize = 30;

/// Layers of format 6; those of further fields follow.
pub(super) const POINT14_LAYERS: usize = 9;

/// What the decoder needs to know.
#[derive(Debug, Clone)]
pub(super) struct Compression {
    /// The fields of a point in order, each with the version of its compressor.
    pub(super) items: Vec<LazItem>,
    /// Bytes of an uncompressed point.
    pub(super) stride: usize,
    pub(super) order: Order,
    pub(super) chunks: ChunkSize,
}

/// The order of the data within a chunk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    /// Point after point, in one stream (formats 0 to 5).
    Pointwise,
    /// Field after field, in this many streams (formats 6 to 10).
    Layered(usize),
}

/// The number of points in a chunk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ChunkSize {
    /// There are no chunks and no chunk table (LASzip 1).
    Whole,
    /// All chunks but the last have this many points.
    Fixed(u64),
    /// The chunk table states the number (COPC).
    Variable,
}

impl Compression {
    pub(super) fn check(payload: Option<&[u8]>, header: &Header) -> Result<Self> {
        let payload = payload.ok_or_else(|| {
            Error::format(
                "the points are marked as compressed, but the record \"laszip encoded\" is missing",
            )
            .at("byte 104")
            .cure("copy or download the file again")
        })?;
        let in_record = |error: Error| {
            error
                .at("record \"laszip encoded\"")
                .cure("copy or download the file again")
        };
        Self::parse(payload, header).map_err(in_record)
    }

    fn parse(payload: &[u8], header: &Header) -> Result<Self> {
        let parsed = LazVlr::from_buffer(payload).map_err(explain)?;
        let items = parsed.items().clone();
        for item in &items {
            let (size, found) = (size_of(item.item_type()), item.size());
            if size != found {
                return Err(Error::format(format!(
                    "field {:?} of {found} bytes, expected {size}",
                    item.item_type()
                )));
            }
        }
        let stride: usize = items.iter().map(|item| usize::from(item.size())).sum();
        if stride != usize::from(header.record_length) {
            return Err(Error::format(format!(
                "compressed fields of {stride} bytes together, but the header states records of {} bytes",
                header.record_length
            )));
        }
        let expected = if header.point_format < 6 {
            LazItemType::Point10
        } else {
            LazItemType::Point14
        };
        let Some(first) = items.first().filter(|item| item.item_type() == expected) else {
            return Err(Error::format(format!(
                "no field {expected:?} at its beginning, which point format {} needs",
                header.point_format
            )));
        };

        let (compressor, chunk_size) = (u16_at(payload, 0), u32_at(payload, 12));
        let (order, check) = match (first.version(), compressor) {
            (1 | 2, 1 | 2) => (
                Order::Pointwise,
                SequentialPointRecordDecompressor::new(&[][..]).set_fields_from(&items),
            ),
            (3 | 4, 3) => {
                let mut decoder = LayeredPointRecordDecompressor::new(std::io::Cursor::new([]));
                (
                    Order::Layered(items.iter().map(layers_of).sum()),
                    decoder.set_fields_from(&items),
                )
            }
            (version, _) => {
                return Err(Error::unsupported(format!(
                    "compressor {compressor} with version {version} of {expected:?}; supported are 1 and 2 with \
                     versions 1 and 2, 3 with versions 3 and 4"
                )));
            }
        };
        check.map_err(explain)?;
        let chunks = match (compressor, chunk_size) {
            (1, _) => ChunkSize::Whole,
            (_, 0 | u32::MAX) => ChunkSize::Variable,
            (_, size) => ChunkSize::Fixed(size.into()),
        };
        Ok(Compression {
            items,
            stride,
            order,
            chunks,
        })
    }
}

fn size_of(item: LazItemType) -> u16 {
    match item {
        LazItemType::Byte(count) | LazItemType::Byte14(count) => count,
        LazItemType::Point10 => 20,
        LazItemType::GpsTime | LazItemType::RGBNIR14 => 8,
        LazItemType::RGB12 | LazItemType::RGB14 => 6,
        LazItemType::WavePacket13 | LazItemType::WavePacket14 => 29,
        LazItemType::Point14 => POINT14 as u16,
    }
}

fn layers_of(item: &LazItem) -> usize {
    match item.item_type() {
        LazItemType::Point14 => POINT14_LAYERS,
        LazItemType::RGBNIR14 => 2,
        LazItemType::Byte14(count) => count.into(),
        _ => 1,
    }
}

fn explain(error: LasZipError) -> Error {
    match error {
        LasZipError::UnknownLazItem(kind) => Error::format(format!("unknown kind {kind} of field")),
        LasZipError::UnsupportedLazItemVersion(kind, version) => {
            Error::unsupported(format!("version {version} of the compressor of {kind:?}"))
        }
        LasZipError::UnknownCompressorType(kind) => {
            Error::unsupported(format!("compressor {kind}"))
        }
        LasZipError::IoError(_) => Error::format("the record ends early"),
        other => Error::unsupported(other.to_string()),
    }
}
