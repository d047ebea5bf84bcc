//! Decodes stored bytes to values, one block at a time.
//!
//! The `tiff` crate does the decoding itself (compression, predictor, byte order). It receives each
//! block as a small TIFF file in memory, whose directory is written here from checked numbers. So
//! the decoder never sees what a damaged file says about counts, offsets or directories, tiles and
//! strips need no distinction, and blocks can be decoded on all cores.
//!
//! Only ZSTD is decompressed here: `tiff` asks for all of the crate `zstd`, with old formats and a
//! maker of dictionaries, which take 13 seconds to compile.

use std::io::Cursor;

use tiff::TiffError;
use tiff::decoder::{Decoder, DecodingResult, Limits};

use super::ifd::{ByteOrder, Bytes};
use super::layout::{BandLayout, Span, Stored};
use super::nodata::Nodata;
use super::tags;
use crate::data::Window;
use crate::error::{Error, Kind, Result};
use crate::io::bytes::contain::contain;

/// Limit for the cells whose values are passed on at once; as stored samples they take an eighth of
/// the memory.
const BAND_CELLS: usize = 1 << 20;

/// Passes on the values of the part of a span that lies in a window, in bands of whole rows; NaN is
/// nodata. For a block that is not in the file, nothing is passed on.
pub(super) fn values(
    layout: &BandLayout,
    nodata: &Nodata,
    bytes: &Bytes,
    span: &Span,
    part: Window,
    take: &mut dyn FnMut(Window, Vec<f64>),
) -> Result<()> {
    let Stored::At { offset, length } = span.stored else {
        return Ok(());
    };
    let in_block = |e: Error| {
        e.at(format!(
            "block {} (rows from {})",
            span.block, span.first_row
        ))
    };
    let mut file = header(layout, span, layout.compression, length);
    bytes.append(offset, length, &mut file).map_err(in_block)?;
    if layout.compression == tags::COMPRESSION_JPEG {
        let start = file.len() - length as usize;
        check_jpeg(&file[start..], layout, span).map_err(in_block)?;
    }
    // The decoders are well tested, but not proven: a panic in one of them means a damaged block
    // and must not end the program.
    let decode_and_pick = || {
        #[cfg(feature = "zstd")]
        if layout.compression == tags::COMPRESSION_ZSTD {
            let start = file.len() - length as usize;
            file = decompressed(&file[start..], layout, span)?;
        }
        let decoded = decode(file)?;
        let rows = (BAND_CELLS / part.width.max(1)).max(1);
        for row in (part.row..part.row + part.height).step_by(rows) {
            let band = Window {
                row,
                height: rows.min(part.row + part.height - row),
                ..part
            };
            take(band, pick(&decoded, layout, nodata, span, band));
        }
        Ok(())
    };
    contain(decode_and_pick)
        .unwrap_or_else(|| Err(Error::format("the decoder failed")))
        .map_err(|e| in_block(in_compression(e, layout.compression)))
}

fn in_compression(error: Error, compression: u16) -> Error {
    let name = tags::compression_name(compression);
    match error.kind() {
        Kind::Unsupported => Error::unsupported(format!("compression {name}: {error}")),
        Kind::Limit => error,
        _ => Error::format(format!("damaged data (compression {name}): {error}")),
    }
}

/// Returns a TIFF file of one strip, not compressed, from one that is compressed by ZSTD.
#[cfg(feature = "zstd")]
fn decompressed(data: &[u8], layout: &BandLayout, span: &Span) -> Result<Vec<u8>> {
    use std::io::Read;

    let row_bits =
        span.width as u64 * u64::from(layout.interleaved) * u64::from(layout.sample.bits);
    let length = row_bits.div_ceil(8) * span.rows as u64;
    let mut file = header(layout, span, tags::COMPRESSION_NONE, length);
    let damaged = |e| Error::caused_by(Kind::Format, e);
    let decoder = zstd::Decoder::with_buffer(data).map_err(damaged)?;
    let read = decoder
        .take(length)
        .read_to_end(&mut file)
        .map_err(damaged)?;
    if (read as u64) < length {
        return Err(Error::format(format!(
            "{read} bytes where {length} were expected"
        )));
    }
    Ok(file)
}

/// Returns a TIFF header with one directory for one strip, whose bytes follow.
fn header(layout: &BandLayout, span: &Span, compression: u16, length: u64) -> Vec<u8> {
    let format = match layout.sample.kind {
        super::SampleKind::Unsigned => 1,
        super::SampleKind::Signed => 2,
        super::SampleKind::Float => 3,
    };
    let tables = layout
        .jpeg_tables
        .as_deref()
        .filter(|_| layout.compression == tags::COMPRESSION_JPEG)
        .unwrap_or(&[]);
    let (short, long, undefined) = (3, 4, 7);
    let count = if tables.is_empty() { 11 } else { 12 };
    let tables_at = 8 + 2 + 12 * count + 4;
    let data_at = tables_at + tables.len() as u32;
    let mut entries = vec![
        (tags::IMAGE_WIDTH, long, 1, span.width as u32),
        (tags::IMAGE_LENGTH, long, 1, span.rows as u32),
        (
            tags::BITS_PER_SAMPLE,
            short,
            1,
            u32::from(layout.sample.bits),
        ),
        (tags::COMPRESSION, short, 1, u32::from(compression)),
        // BlackIsZero: samples are decoded as they are stored.
        (tags::PHOTOMETRIC, short, 1, 1),
        (tags::STRIP_OFFSETS, long, 1, data_at),
        (
            tags::SAMPLES_PER_PIXEL,
            short,
            1,
            u32::from(layout.interleaved),
        ),
        (tags::ROWS_PER_STRIP, long, 1, span.rows as u32),
        (tags::STRIP_BYTE_COUNTS, long, 1, length as u32),
        (tags::PREDICTOR, short, 1, u32::from(layout.predictor)),
        (tags::SAMPLE_FORMAT, short, 1, format),
    ];
    if !tables.is_empty() {
        entries.push((tags::JPEG_TABLES, undefined, tables.len() as u32, tables_at));
    }
    let mut out = Vec::with_capacity(data_at as usize + length as usize);
    let order = layout.order;
    out.extend_from_slice(if order == ByteOrder::Little {
        b"II"
    } else {
        b"MM"
    });
    put16(&mut out, order, 42);
    put32(&mut out, order, 8);
    put16(&mut out, order, count as u16);
    for (tag, kind, values, value) in entries {
        put16(&mut out, order, tag);
        put16(&mut out, order, kind);
        put32(&mut out, order, values);
        if kind == short {
            put16(&mut out, order, value as u16);
            put16(&mut out, order, 0);
        } else {
            put32(&mut out, order, value);
        }
    }
    put32(&mut out, order, 0);
    out.extend_from_slice(tables);
    out
}

fn put16(out: &mut Vec<u8>, order: ByteOrder, value: u16) {
    out.extend_from_slice(&if order == ByteOrder::Little {
        value.to_le_bytes()
    } else {
        value.to_be_bytes()
    });
}

fn put32(out: &mut Vec<u8>, order: ByteOrder, value: u32) {
    out.extend_from_slice(&if order == ByteOrder::Little {
        value.to_le_bytes()
    } else {
        value.to_be_bytes()
    });
}

/// Returns an error unless the size that a JPEG states, which its decoder trusts, is that of the
/// block.
fn check_jpeg(data: &[u8], layout: &BandLayout, span: &Span) -> Result<()> {
    let short = || Error::format("the JPEG header is cut short");
    let mut at = 2;
    loop {
        let [0xff, marker, high, low] = *data.get(at..at + 4).ok_or_else(short)? else {
            return Err(Error::format("the JPEG header is damaged"));
        };
        // Start of frame of any kind; C4, C8 and CC have other meanings.
        if matches!(marker, 0xc0..=0xcf) && !matches!(marker, 0xc4 | 0xc8 | 0xcc) {
            let frame = data.get(at + 4..at + 10).ok_or_else(short)?;
            let rows = usize::from(u16::from_be_bytes([frame[1], frame[2]]));
            let columns = usize::from(u16::from_be_bytes([frame[3], frame[4]]));
            let fits = columns == span.width && (span.rows..=layout.block[1]).contains(&rows);
            if fits && u16::from(frame[5]) == layout.interleaved {
                return Ok(());
            }
            return Err(Error::format(format!(
                "a JPEG of {columns} x {rows} with {} bands in a block of {} x {} with {}",
                frame[5], span.width, span.rows, layout.interleaved
            )));
        }
        at += 2 + usize::from(u16::from_be_bytes([high, low])).max(2);
    }
}

fn decode(file: Vec<u8>) -> Result<DecodingResult> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = super::MAX_BLOCK_BYTES as usize;
    limits.intermediate_buffer_size = usize::MAX;
    let mut decoder = Decoder::new(Cursor::new(file))
        .map_err(from_tiff)?
        .with_limits(limits);
    decoder.read_chunk(0).map_err(from_tiff)
}

fn from_tiff(error: TiffError) -> Error {
    let kind = match &error {
        TiffError::UnsupportedError(_) | TiffError::UsageError(_) => Kind::Unsupported,
        TiffError::LimitsExceeded => Kind::Limit,
        // The input is in memory, so what cannot be read is damaged compressed data.
        TiffError::FormatError(_) | TiffError::IntSizeError | TiffError::IoError(_) => Kind::Format,
    };
    Error::caused_by(kind, error)
}

/// Returns band 1 of a part of a decoded span.
fn pick(
    decoded: &DecodingResult,
    layout: &BandLayout,
    nodata: &Nodata,
    span: &Span,
    part: Window,
) -> Vec<f64> {
    if layout.sample.bits < 8 {
        let DecodingResult::U8(packed) = decoded else {
            return vec![f64::NAN; part.width * part.height];
        };
        return pick_bits(packed, layout, nodata, span, part);
    }
    let step = usize::from(layout.interleaved);
    let all = Picker {
        step,
        row_length: span.width * step,
        span,
        part,
    };
    match decoded {
        DecodingResult::U8(v) => all.pick(v, f64::from, is(nodata.integer())),
        DecodingResult::U16(v) => all.pick(v, f64::from, is(nodata.integer())),
        DecodingResult::U32(v) => all.pick(v, f64::from, is(nodata.integer())),
        DecodingResult::U64(v) => all.pick(v, |x| x as f64, is(nodata.integer())),
        DecodingResult::I8(v) => all.pick(v, f64::from, is(nodata.integer())),
        DecodingResult::I16(v) => all.pick(v, f64::from, is(nodata.integer())),
        DecodingResult::I32(v) => all.pick(v, f64::from, is(nodata.integer())),
        DecodingResult::I64(v) => all.pick(v, |x| x as f64, is(nodata.integer())),
        DecodingResult::F16(v) => {
            all.pick(v, |x| finite(x.to_f64()), |x| nodata.is_half(x.to_f64()))
        }
        DecodingResult::F32(v) => all.pick(v, |x| finite(f64::from(x)), is(nodata.single())),
        DecodingResult::F64(v) => all.pick(v, finite, is(nodata.value)),
    }
}

fn is<T: PartialEq>(nodata: Option<T>) -> impl Fn(T) -> bool {
    move |sample| nodata.as_ref() == Some(&sample)
}

/// Returns NaN for infinite values, which are not heights.
fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { f64::NAN }
}

struct Picker<'a> {
    step: usize,
    row_length: usize,
    span: &'a Span,
    part: Window,
}

impl Picker<'_> {
    fn pick<T: Copy>(
        &self,
        samples: &[T],
        value: impl Fn(T) -> f64,
        is_nodata: impl Fn(T) -> bool,
    ) -> Vec<f64> {
        let Picker {
            step,
            row_length,
            span,
            part,
        } = *self;
        let mut out = Vec::with_capacity(part.width * part.height);
        for row in part.row..part.row + part.height {
            let start =
                (row - span.first_row) * row_length + (part.column - span.first_column) * step;
            let cells = samples[start..start + (part.width - 1) * step + 1]
                .iter()
                .step_by(step);
            out.extend(cells.map(|&sample| {
                if is_nodata(sample) {
                    f64::NAN
                } else {
                    value(sample)
                }
            }));
        }
        out
    }
}

/// Returns samples of 1, 2 or 4 bits: the first of a byte is in its highest bits, and each row
/// starts a new byte.
fn pick_bits(
    packed: &[u8],
    layout: &BandLayout,
    nodata: &Nodata,
    span: &Span,
    part: Window,
) -> Vec<f64> {
    let bits = usize::from(layout.sample.bits);
    let row_bytes = (span.width * bits).div_ceil(8);
    let mask = (1u16 << bits) as u8 - 1;
    let nodata = nodata.integer::<u8>();
    let mut out = Vec::with_capacity(part.width * part.height);
    for row in part.row..part.row + part.height {
        let line = &packed[(row - span.first_row) * row_bytes..][..row_bytes];
        for column in part.column - span.first_column..part.column - span.first_column + part.width
        {
            let at = column * bits;
            let sample = line[at / 8] >> (8 - bits - at % 8) & mask;
            out.push(if nodata == Some(sample) {
                f64::NAN
            } else {
                f64::from(sample)
            });
        }
    }
    out
}
