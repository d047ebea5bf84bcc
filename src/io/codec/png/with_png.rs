//! Reads and writes pictures with the crate `png`.

use std::io::Write;
use std::path::Path;

use ::png::{BitDepth, ColorType, Compression, Decoder, Encoder};
use rayon::prelude::*;

use super::{Picture, auxiliary, world_file_of};
use crate::data::{BlockSource, Colors, Frame, Window};
use crate::error::{Error, Kind, Result};
use crate::io::bytes::output::Destination;
use crate::io::codec::world_file;

/// Rows that are computed and written together.
const BAND: usize = 256;

/// Columns that a core computes at a time.
const BLOCK: usize = 256;

/// Writes an 8-bit gray picture with transparency, its world file (see [`world_file_of`]) and, if
/// the coordinate system is known, its auxiliary file (`relief.png.aux.xml`).
///
/// Values are rounded and clamped to 0..255; NaN is transparent. All cores compute one band of rows
/// while the previous one is compressed, so memory is needed for 512 rows, 10 bytes per cell.
///
/// # Errors
/// If the raster has no cells or more than 2^31 - 1 in a row or column, the source fails, or a file
/// cannot be written.
pub fn write_gray<'a>(target: impl Into<Destination<'a>>, source: &dyn BlockSource) -> Result<()> {
    write(
        target.into(),
        source,
        ColorType::GrayscaleAlpha,
        |cell| match cell.is_nan() {
            true => [0, 0],
            false => [cell.round().clamp(0.0, 255.0) as u8, 255],
        },
    )
}

/// Like [`write_gray`], but writes the colors of heights, with 8 bits for each of red, green, blue
/// and opacity. Memory is needed for 512 rows, 12 bytes per cell.
///
/// # Errors
/// Those of [`write_gray`].
pub fn write_colors<'a>(
    target: impl Into<Destination<'a>>,
    source: &dyn BlockSource,
    colors: &Colors,
) -> Result<()> {
    write(target.into(), source, ColorType::Rgba, |cell| {
        colors.of(cell)
    })
}

/// Writes a picture, a pixel of `N` bytes for each cell.
fn write<const N: usize>(
    target: Destination,
    source: &dyn BlockSource,
    kind: ColorType,
    pixel: impl Fn(f32) -> [u8; N] + Sync,
) -> Result<()> {
    write_pixels(target, source, kind, &pixel).map_err(|e| e.in_file(target.path()))
}

fn write_pixels<const N: usize>(
    target: Destination,
    source: &dyn BlockSource,
    kind: ColorType,
    pixel: &(impl Fn(f32) -> [u8; N] + Sync),
) -> Result<()> {
    let frame = source.frame();
    let Frame { width, height, .. } = frame;
    let side = |cells: usize| {
        i32::try_from(cells)
            .ok()
            .filter(|&cells| cells > 0)
            .map(i32::unsigned_abs)
    };
    let (Some(columns), Some(rows)) = (side(width), side(height)) else {
        return Err(Error::usage(format!(
            "a picture of {width} x {height} cells, expected 1 to {} a side",
            i32::MAX
        )));
    };
    let mut out = target.create()?;
    let mut encoder = Encoder::new(&mut out, columns, rows);
    encoder.set_color(kind);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    let mut writer = encoder.write_header().map_err(from_png)?;
    let mut stream = writer.stream_writer().map_err(from_png)?;
    let mut ready = band(source, frame, 0, pixel)?;
    let mut row = BAND;
    while !ready.is_empty() {
        let (written, next) = rayon::join(
            || stream.write_all(&ready),
            || band(source, frame, row, pixel),
        );
        written?;
        ready = next?;
        row += BAND;
    }
    stream.finish().map_err(from_png)?;
    writer.finish().map_err(from_png)?;
    let mut beside = target.create_beside(&world_file_of(target.path()))?;
    beside.write_all(world_file::text(&frame).as_bytes())?;
    let auxiliary = auxiliary::path_of(target.path());
    let Some(crs) = source.crs() else {
        return target.put_all([beside], out, [auxiliary]);
    };
    let mut system = target.create_beside(&auxiliary)?;
    system.write_all(auxiliary::text(crs).as_bytes())?;
    target.put_all([beside, system], out, [])
}

fn from_png(error: ::png::EncodingError) -> Error {
    match error {
        ::png::EncodingError::IoError(error) => error.into(),
        other => Error::caused_by(Kind::Usage, other),
    }
}

/// Returns the pixels of a band of rows, which ends with the last row of the raster.
fn band<const N: usize>(
    source: &dyn BlockSource,
    frame: Frame,
    row: usize,
    pixel: &(impl Fn(f32) -> [u8; N] + Sync),
) -> Result<Vec<u8>> {
    let height = BAND.min(frame.height.saturating_sub(row));
    if height == 0 {
        return Ok(Vec::new());
    }
    let block = |column: usize| {
        let window = Window {
            column,
            row,
            width: BLOCK.min(frame.width - column),
            height,
        };
        let mut cells = vec![f32::NAN; window.width * height];
        source.fill(window, &mut cells).map(|()| (window, cells))
    };
    let columns: Vec<usize> = (0..frame.width).step_by(BLOCK).collect();
    let blocks: Vec<(Window, Vec<f32>)> =
        columns.into_par_iter().map(block).collect::<Result<_>>()?;
    let mut out = vec![0; N * frame.width * height];
    for (window, cells) in blocks {
        for (line, cells) in cells.chunks_exact(window.width).enumerate() {
            let start = N * (line * frame.width + window.column);
            for (bytes, cell) in out[start..].chunks_exact_mut(N).zip(cells) {
                bytes.copy_from_slice(&pixel(*cell));
            }
        }
    }
    Ok(out)
}

/// Describes a picture, which is read up to its last row, and its position.
///
/// # Errors
/// If the file is not a PNG or is damaged, or a file next to it is damaged.
pub fn describe(path: &Path) -> Result<Picture> {
    let read = || {
        let file = std::io::BufReader::new(std::fs::File::open(path)?);
        let mut reader = Decoder::new(file).read_info().map_err(from_png_decoding)?;
        let info = reader.info();
        let size = [info.width, info.height];
        let colors = match info.color_type {
            ColorType::Grayscale => "gray",
            ColorType::GrayscaleAlpha => "gray and alpha",
            ColorType::Rgb => "colors",
            ColorType::Rgba => "colors and alpha",
            ColorType::Indexed => "a palette",
        };
        let format = format!("PNG, {} bits, {colors}", info.bit_depth as u8);
        while reader.next_row().map_err(from_png_decoding)?.is_some() {}
        Ok((size, format))
    };
    let (size, format) = read().map_err(|e: Error| e.in_file(path))?;
    let transform = world_file::read_beside(path).transpose()?;
    Ok(Picture {
        size,
        format,
        transform,
        crs: auxiliary::read_beside(path)?,
    })
}

fn from_png_decoding(error: ::png::DecodingError) -> Error {
    match error {
        ::png::DecodingError::IoError(error) => error.into(),
        other => Error::caused_by(Kind::Format, other),
    }
}
