//! Decodes one chunk in memory.

use std::io::{Cursor, ErrorKind};

use laz::DecompressionSelection;
use laz::record::{
    LayeredPointRecordDecompressor, RecordDecompressor, SequentialPointRecordDecompressor,
};

use super::compression::{Compression, Order, POINT14, POINT14_LAYERS};
use super::table::layer_sizes;
use crate::data::PointBatch;
use crate::io::bytes::contain::contain;
use crate::io::bytes::little_endian::u32_at;
use crate::io::codec::las::record::RecordLayout;
use crate::io::options::las::Detail;

/// Points decoded before they are split into columns: so few that their records stay in the nearest
/// cache.
pub(super) const BLOCK: usize = 256;

/// The number of layers that a [`PointBatch`] needs: x, y and returns; z; class; flags.
const LAYERS_USED: usize = 4;

/// Decodes a whole chunk and appends its points.
///
/// # Errors
/// If the chunk is damaged. As in LASzip, a chunk that does not end where it should is damaged:
/// this is the only sign, since an arithmetic decoder turns any bytes into points.
pub(super) fn decode(
    bytes: &[u8],
    points: u64,
    compression: &Compression,
    layout: RecordLayout,
    batch: &mut PointBatch,
) -> Result<(), String> {
    let decoded = contain(|| match compression.order {
        Order::Pointwise => decode_pointwise(bytes, points, compression, layout, batch),
        Order::Layered(layers) => decode_layered(bytes, points, layers, compression, layout, batch),
    });
    decoded.unwrap_or_else(|| Err("the decoder found an impossible value".into()))
}

fn decode_pointwise(
    bytes: &[u8],
    points: u64,
    compression: &Compression,
    layout: RecordLayout,
    batch: &mut PointBatch,
) -> Result<(), String> {
    let mut decoder = SequentialPointRecordDecompressor::new(bytes);
    decoder
        .set_fields_from(&compression.items)
        .map_err(|error| error.to_string())?;
    decode_records(&mut decoder, points, layout, batch)?;
    match decoder.get().len() {
        0 => Ok(()),
        rest => Err(format!(
            "{rest} of {} bytes are left after its last point",
            bytes.len()
        )),
    }
}

/// Decodes a layered chunk. For columns, only the layers that they need are decoded, and none of
/// the fields beyond those of format 6: the decoder receives the chunk as if it had no more.
fn decode_layered(
    bytes: &[u8],
    points: u64,
    layers: usize,
    compression: &Compression,
    layout: RecordLayout,
    batch: &mut PointBatch,
) -> Result<(), String> {
    let stride = compression.stride;
    let head = stride + 4 + 4 * layers;
    let (Some(first), Some(sizes)) = (bytes.get(..POINT14), bytes.get(stride + 4..head)) else {
        return Err(format!(
            "its {} bytes are fewer than its head of {head}",
            bytes.len()
        ));
    };
    let stated = u32_at(bytes, stride);
    if u64::from(stated) < points {
        return Err(format!("it states {stated} points, expected {points}"));
    }
    let total = head as u64 + layer_sizes(sizes).sum::<u64>();
    if total != bytes.len() as u64 {
        return Err(format!(
            "its layers take {total} bytes together, but it has {}",
            bytes.len()
        ));
    }
    if layout.detail == Detail::Records {
        let mut decoder = LayeredPointRecordDecompressor::new(Cursor::new(bytes));
        decoder
            .set_fields_from(&compression.items)
            .map_err(|error| error.to_string())?;
        return decode_records(&mut decoder, points, layout, batch);
    }
    let used: u64 = layer_sizes(sizes).take(LAYERS_USED).sum();
    let mut reduced = Vec::with_capacity(POINT14 + 4 + 4 * POINT14_LAYERS + used as usize);
    reduced.extend_from_slice(first);
    reduced.extend_from_slice(&stated.to_le_bytes());
    reduced.extend_from_slice(&sizes[..4 * LAYERS_USED]);
    reduced.resize(reduced.len() + 4 * (POINT14_LAYERS - LAYERS_USED), 0);
    reduced.extend_from_slice(&bytes[head..head + used as usize]);

    let mut decoder = LayeredPointRecordDecompressor::new(Cursor::new(reduced));
    decoder
        .set_fields_from(&compression.items[..1].to_vec())
        .map_err(|error| error.to_string())?;
    decoder.set_selection(
        DecompressionSelection::base()
            .decompress_z()
            .decompress_classification()
            .decompress_flags(),
    );
    decode_records(&mut decoder, points, layout.with_stride(POINT14), batch)
}

fn decode_records<R>(
    decoder: &mut impl RecordDecompressor<R>,
    points: u64,
    layout: RecordLayout,
    batch: &mut PointBatch,
) -> Result<(), String> {
    let mut block = vec![0; BLOCK * layout.stride];
    let mut left = points;
    while left > 0 {
        let count = left.min(BLOCK as u64) as usize;
        let records = &mut block[..count * layout.stride];
        for (i, record) in records.chunks_exact_mut(layout.stride).enumerate() {
            decoder
                .decompress_next(record)
                .map_err(|error| match error.kind() {
                    ErrorKind::UnexpectedEof => {
                        format!("it ends within point {}", points - left + i as u64)
                    }
                    _ => error.to_string(),
                })?;
        }
        layout.append(records, batch);
        left -= count as u64;
    }
    Ok(())
}
