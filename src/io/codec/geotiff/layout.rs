//! How the cells of the first image are arranged in the file: the typed layer on top of
//! [`ifd`](super::ifd).
//!
//! All assumptions of the decoding are checked here, once, so that the decoder only receives blocks
//! of a stated and bounded size.

use super::ifd::{ByteOrder, Bytes, Directory};
use super::{MAX_BLOCK_BYTES, MAX_BLOCKS, tags};
use crate::error::{Error, Result};

/// How the bits of a sample are interpreted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleKind {
    /// Unsigned integers.
    Unsigned,
    /// Integers in two's complement.
    Signed,
    /// IEEE 754 numbers.
    Float,
}

/// The type of the samples of a raster, displayed as `float32`, `int16`, `uint8`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SampleType {
    /// How the bits are interpreted.
    pub kind: SampleKind,
    /// Number of bits.
    pub bits: u16,
}

impl std::fmt::Display for SampleType {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let name = match self.kind {
            SampleKind::Unsigned => "uint",
            SampleKind::Signed => "int",
            SampleKind::Float => "float",
        };
        write!(f, "{name}{}", self.bits)
    }
}

/// Uncompressed strips may be as large as the raster; they are read in spans of about this many
/// bytes.
const SPAN_BYTES: u64 = 1 << 20;

/// A checked description of where the samples of band 1 are.
#[derive(Debug)]
pub(super) struct BandLayout {
    pub(super) order: ByteOrder,
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) bands: u16,
    pub(super) sample: SampleType,
    pub(super) compression: u16,
    pub(super) predictor: u16,
    pub(super) is_tiled: bool,
    /// Columns and rows of a tile, or the width and the rows of a strip.
    pub(super) block: [usize; 2],
    /// Rows that are decoded at once: all rows of a block, or fewer for an uncompressed strip.
    span_height: usize,
    /// Samples of a cell that are stored together: those of all bands, or 1 if each band has its
    /// own blocks.
    pub(super) interleaved: u16,
    across: usize,
    offsets: Vec<u64>,
    counts: Option<Vec<u64>>,
    pub(super) jpeg_tables: Option<Vec<u8>>,
}

/// A span of rows of one block, which are decoded at once.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    /// The block that contains the span, for messages.
    pub(super) block: usize,
    pub(super) first_column: usize,
    pub(super) first_row: usize,
    pub(super) width: usize,
    pub(super) rows: usize,
    pub(super) stored: Stored,
}

impl Span {
    /// Returns the number of cells.
    pub(super) fn cells(&self) -> u64 {
        self.width as u64 * self.rows as u64
    }
}

/// Where the bytes of a [`Span`] are.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stored {
    /// Nowhere: a sparse file leaves out this block.
    Nowhere,
    /// In the file, at these bytes.
    At { offset: u64, length: u64 },
}

fn cure(error: Error) -> Error {
    error.cure("build with the `gdal` feature, or convert with gdal_translate")
}

fn unsupported(message: String) -> Error {
    cure(Error::unsupported(message))
}

fn required(value: Option<u64>, tag: u16) -> Result<u64> {
    match value {
        Some(0) => Err(Error::format("is 0").at(tags::tag_name(tag))),
        Some(value) => Ok(value),
        None => Err(Error::format(format!("{} is missing", tags::tag_name(tag)))),
    }
}

/// Returns the number of bands.
fn band_count(bytes: &Bytes, directory: &Directory) -> Result<u16> {
    let bands = directory
        .number(bytes, tags::SAMPLES_PER_PIXEL)?
        .unwrap_or(1);
    u16::try_from(bands)
        .ok()
        .filter(|&bands| bands > 0)
        .ok_or_else(|| {
            Error::format(format!("{bands}, expected 1 to 65535"))
                .at(tags::tag_name(tags::SAMPLES_PER_PIXEL))
        })
}

/// Returns the number of samples of a cell that are stored together.
fn interleaved(bytes: &Bytes, directory: &Directory, bands: u16) -> Result<u16> {
    match directory
        .number(bytes, tags::PLANAR_CONFIGURATION)?
        .unwrap_or(1)
    {
        1 => Ok(bands),
        2 => Ok(1),
        other => {
            let tag = tags::tag_name(tags::PLANAR_CONFIGURATION);
            Err(Error::format(format!("{other}, expected 1 or 2")).at(tag))
        }
    }
}

/// Returns the columns and rows of a tile.
fn tile_size(bytes: &Bytes, directory: &Directory) -> Result<[u64; 2]> {
    let number = |tag| required(directory.number(bytes, tag)?, tag);
    Ok([number(tags::TILE_WIDTH)?, number(tags::TILE_LENGTH)?])
}

/// Returns the rows of a strip; all of them are one strip if none is stated.
fn rows_per_strip(bytes: &Bytes, directory: &Directory, height: u64) -> Result<u64> {
    match directory.number(bytes, tags::ROWS_PER_STRIP)? {
        None => Ok(height),
        rows => Ok(required(rows, tags::ROWS_PER_STRIP)?.min(height)),
    }
}

/// Returns the values of a tag that has one for each block, if the file has it.
fn of_each_block(
    bytes: &Bytes,
    directory: &Directory,
    tag: u16,
    blocks: u64,
) -> Result<Option<Vec<u64>>> {
    match directory.unsigned(bytes, tag)? {
        Some(values) if (values.len() as u64) < blocks => {
            let message = format!("{} values for {blocks} blocks", values.len());
            Err(Error::format(message).at(tags::tag_name(tag)))
        }
        values => Ok(values),
    }
}

impl BandLayout {
    /// Reads how the cells of an image are arranged.
    ///
    /// # Errors
    /// If it is damaged, exceeds a limit, or cannot be decoded.
    pub(super) fn read(bytes: &Bytes, directory: &Directory) -> Result<Self> {
        let number = |tag| directory.number(bytes, tag);
        let width = required(number(tags::IMAGE_WIDTH)?, tags::IMAGE_WIDTH)?;
        let height = required(number(tags::IMAGE_LENGTH)?, tags::IMAGE_LENGTH)?;
        let bands = band_count(bytes, directory)?;
        let sample = sample_type(bytes, directory)?;
        let compression = number(tags::COMPRESSION)?.unwrap_or(1) as u16;
        let predictor = number(tags::PREDICTOR)?.unwrap_or(1) as u16;
        let interleaved = interleaved(bytes, directory, bands)?;
        let is_tiled = directory.has(tags::TILE_OFFSETS) || directory.has(tags::TILE_WIDTH);
        let [block_width, block_height] = match is_tiled {
            true => tile_size(bytes, directory)?,
            false => [width, rows_per_strip(bytes, directory, height)?],
        };
        let row_bytes = block_width
            .checked_mul(u64::from(interleaved) * u64::from(sample.bits))
            .map_or(u64::MAX, |bits| bits.div_ceil(8));
        let span_height = if !is_tiled && compression == tags::COMPRESSION_NONE {
            (SPAN_BYTES / row_bytes).clamp(1, block_height)
        } else {
            block_height
        };
        if row_bytes.saturating_mul(span_height) > MAX_BLOCK_BYTES {
            return Err(cure(Error::limit(format!(
                "a block of {block_width} x {span_height} cells of {interleaved} x {sample} exceeds the limit of \
                 {MAX_BLOCK_BYTES} bytes for one block"
            ))));
        }
        let across = width.div_ceil(block_width);
        let blocks = across.saturating_mul(height.div_ceil(block_height));
        if blocks > MAX_BLOCKS {
            return Err(cure(Error::limit(format!(
                "{blocks} blocks exceed the limit of {MAX_BLOCKS} blocks"
            ))));
        }
        let (offsets_tag, counts_tag) = if is_tiled {
            (tags::TILE_OFFSETS, tags::TILE_BYTE_COUNTS)
        } else {
            (tags::STRIP_OFFSETS, tags::STRIP_BYTE_COUNTS)
        };
        let offsets = of_each_block(bytes, directory, offsets_tag, blocks)?
            .ok_or_else(|| Error::format(format!("{} is missing", tags::tag_name(offsets_tag))))?;
        let counts = of_each_block(bytes, directory, counts_tag, blocks)?;
        let layout = BandLayout {
            order: directory.order,
            width: width as usize,
            height: height as usize,
            bands,
            sample,
            compression,
            predictor,
            is_tiled,
            block: [block_width as usize, block_height as usize],
            span_height: span_height as usize,
            interleaved,
            across: across as usize,
            offsets,
            counts,
            jpeg_tables: directory.bytes(bytes, tags::JPEG_TABLES)?,
        };
        layout.check_supported(bytes, directory)?;
        Ok(layout)
    }

    /// Returns an error that names what cannot be decoded.
    fn check_supported(&self, bytes: &Bytes, directory: &Directory) -> Result<()> {
        let name = tags::compression_name(self.compression);
        match self.compression {
            tags::COMPRESSION_NONE
            | tags::COMPRESSION_LZW
            | tags::COMPRESSION_DEFLATE
            | tags::COMPRESSION_OLD_DEFLATE
            | tags::COMPRESSION_PACKBITS => {}
            tags::COMPRESSION_ZSTD if cfg!(feature = "zstd") => {}
            tags::COMPRESSION_ZSTD => {
                let message = format!("compression ZSTD ({})", self.compression);
                return Err(Error::unsupported(message).cure("build with the `zstd` feature"));
            }
            tags::COMPRESSION_JPEG => {
                if directory.number(bytes, tags::PHOTOMETRIC)? == Some(6) {
                    return Err(unsupported("compression JPEG with YCbCr colors".into()));
                }
                if self.sample
                    != (SampleType {
                        kind: SampleKind::Unsigned,
                        bits: 8,
                    })
                {
                    return Err(unsupported(format!(
                        "compression JPEG of {} samples",
                        self.sample
                    )));
                }
                if self
                    .jpeg_tables
                    .as_ref()
                    .is_some_and(|tables| tables.len() < 4)
                {
                    return Err(Error::format("is too short").at(tags::tag_name(tags::JPEG_TABLES)));
                }
            }
            code => return Err(unsupported(format!("compression {name} ({code})"))),
        }
        let SampleType { kind, bits } = self.sample;
        let known = match kind {
            SampleKind::Unsigned => matches!(bits, 1 | 2 | 4 | 8 | 16 | 32 | 64),
            SampleKind::Signed => matches!(bits, 8 | 16 | 32 | 64),
            SampleKind::Float => matches!(bits, 16 | 32 | 64),
        };
        if !known {
            return Err(unsupported(format!("{bits}-bit samples ({})", self.sample)));
        }
        if bits < 8 && self.interleaved > 1 {
            return Err(unsupported(format!(
                "{bits}-bit samples in {} interleaved bands",
                self.bands
            )));
        }
        match self.predictor {
            1 => {}
            2 if bits >= 8 => {}
            3 if kind == SampleKind::Float => {}
            2 | 3 => {
                return Err(unsupported(format!(
                    "predictor {} for {} samples",
                    self.predictor, self.sample
                )));
            }
            other => return Err(unsupported(format!("predictor {other}"))),
        }
        match directory.number(bytes, tags::FILL_ORDER)? {
            None | Some(1) => Ok(()),
            Some(other) => Err(unsupported(format!("fill order {other} (reversed bits)"))),
        }
    }

    /// Returns the bytes of a row of a block.
    fn row_bytes(&self) -> u64 {
        (self.block[0] as u64 * u64::from(self.interleaved) * u64::from(self.sample.bits))
            .div_ceil(8)
    }

    /// Returns the largest number of bytes that a decoded span can have.
    pub(super) fn span_bytes(&self) -> u64 {
        self.row_bytes() * self.span_height as u64
    }

    /// Returns the columns and rows of a span.
    pub(super) fn span_size(&self) -> [usize; 2] {
        [self.block[0], self.span_height]
    }

    /// Returns the number of cells of a span.
    pub(super) fn span_cells(&self) -> u64 {
        self.block[0] as u64 * self.span_height as u64
    }

    /// Returns the number of blocks in a row of blocks.
    pub(super) fn across(&self) -> usize {
        self.across
    }

    /// Returns the number of blocks that are not in the file.
    pub(super) fn missing_blocks(&self) -> usize {
        (0..self.block_count())
            .filter(|&block| self.is_missing(block))
            .count()
    }

    /// Returns the number of blocks of a complete file.
    pub(super) fn block_count(&self) -> usize {
        self.across * self.height.div_ceil(self.block[1])
    }

    fn is_missing(&self, block: usize) -> bool {
        match self.counts.as_ref().map(|counts| counts[block]) {
            Some(0) => self.offsets[block] == 0 || self.compression != tags::COMPRESSION_NONE,
            Some(_) => false,
            None => self.offsets[block] == 0,
        }
    }

    /// Returns the span that contains a row, in a column of blocks.
    ///
    /// # Errors
    /// If its bytes are not in the file, or too few for its cells.
    pub(super) fn span(&self, across: usize, row: usize, bytes: &Bytes) -> Result<Span> {
        let [block_width, block_height] = self.block;
        let (block_row, row_in_block) = (row / block_height, row % block_height);
        let skipped = row_in_block / self.span_height * self.span_height;
        let first_row = block_row * block_height + skipped;
        // Some writers leave out the rows of a tile below the raster.
        let rows = self
            .span_height
            .min(block_height - skipped)
            .min(self.height - first_row);
        let block = block_row * self.across + across;
        let stored = self
            .stored(block, skipped as u64, rows as u64, bytes)
            .map_err(|e| e.at(format!("block {block} (rows from {first_row})")))?;
        Ok(Span {
            block,
            first_column: across * block_width,
            first_row,
            width: block_width,
            rows,
            stored,
        })
    }

    fn stored(&self, block: usize, skipped: u64, rows: u64, bytes: &Bytes) -> Result<Stored> {
        if self.is_missing(block) {
            return Ok(Stored::Nowhere);
        }
        let offset = self.offsets[block];
        let stated = self.counts.as_ref().map(|counts| counts[block]);
        let raw = self.row_bytes() * rows;
        let (start, length) = if self.compression == tags::COMPRESSION_NONE {
            let before = self.row_bytes() * skipped;
            if let Some(stated) = stated
                && stated != 0
                && stated < before + raw
            {
                return Err(Error::format(format!(
                    "{stated} bytes, where {} are needed",
                    before + raw
                )));
            }
            (offset.saturating_add(before), raw)
        } else {
            (
                offset,
                stated.unwrap_or_else(|| bytes.len().saturating_sub(offset).min(2 * raw + 1024)),
            )
        };
        if !bytes.holds(start, length) {
            return Err(Error::format(format!(
                "its {length} bytes at byte {start} are not in the file, which ends at byte {}",
                bytes.len()
            )));
        }
        if raw > length.saturating_mul(max_bytes_from_one(self.compression)) {
            let name = tags::compression_name(self.compression);
            return Err(Error::format(format!(
                "{length} bytes of {name} cannot give {raw} bytes"
            )));
        }
        Ok(Stored::At {
            offset: start,
            length: length.min(4 * raw + (1 << 20)),
        })
    }
}

/// Returns how many bytes one compressed byte can yield at most, by the rules of the format.
fn max_bytes_from_one(compression: u16) -> u64 {
    match compression {
        tags::COMPRESSION_NONE => 1,
        // 128 bytes from 2.
        tags::COMPRESSION_PACKBITS => 64,
        // 258 bytes from two bits.
        tags::COMPRESSION_DEFLATE | tags::COMPRESSION_OLD_DEFLATE => 1032,
        // A code of 12 bits for the longest entry of the table.
        tags::COMPRESSION_LZW => 4096,
        // A block of 128 kB of one byte takes 4 bytes.
        tags::COMPRESSION_ZSTD => 1 << 15,
        // The JPEG header states the size, which is checked there.
        _ => u64::MAX,
    }
}

/// Returns the common type of all samples.
fn sample_type(bytes: &Bytes, directory: &Directory) -> Result<SampleType> {
    let all_equal = |tag, default| -> Result<u64> {
        let values = directory
            .unsigned(bytes, tag)?
            .filter(|values| !values.is_empty());
        let values = values.unwrap_or_else(|| vec![default]);
        match values.iter().find(|&&value| value != values[0]) {
            None => Ok(values[0]),
            Some(other) => Err(unsupported(format!(
                "bands of different types ({}: {} and {other})",
                tags::tag_name(tag),
                values[0]
            ))),
        }
    };
    let bits = all_equal(tags::BITS_PER_SAMPLE, 1)?;
    let kind = match all_equal(tags::SAMPLE_FORMAT, 1)? {
        // "Undefined" is read as unsigned, as libtiff does.
        1 | 4 => SampleKind::Unsigned,
        2 => SampleKind::Signed,
        3 => SampleKind::Float,
        5 => {
            return Err(unsupported(format!(
                "complex integer samples of {bits} bits"
            )));
        }
        6 => return Err(unsupported(format!("complex float samples of {bits} bits"))),
        other => return Err(unsupported(format!("sample format {other}"))),
    };
    let bits = u16::try_from(bits)
        .ok()
        .filter(|&bits| bits > 0)
        .ok_or_else(|| Error::format(bits.to_string()).at(tags::tag_name(tags::BITS_PER_SAMPLE)))?;
    Ok(SampleType { kind, bits })
}
