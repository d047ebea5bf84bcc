use std::collections::BTreeSet;
use std::fs::File;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::georeference::ModelTags;
use super::ifd::{ByteOrder, Bytes, Directory};
use super::layout::{BandLayout, SampleType, Span, Stored};
use super::nodata::{Nodata, scale_and_offset};
use super::{MAX_CELLS, block, tags};
use crate::crs::{Crs, GeoKeys};
use crate::data::{BlockSource, Frame, Grid, Window};
use crate::error::{Error, Kind, Result, Wording};
use crate::io::bytes::watch::{Watch, unwatched};
use crate::io::codec::world_file;

/// What the header of a GeoTIFF states.
#[derive(Debug, Clone)]
pub struct GeoTiffInfo {
    /// Number of columns.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// Number of bands; the first one is read.
    pub bands: u16,
    /// Type of the stored samples.
    pub sample: SampleType,
    /// Compression: "none", "DEFLATE", "LZW", ...
    pub compression: &'static str,
    /// Predictor: 1 none, 2 differences, 3 differences of float bytes.
    pub predictor: u16,
    /// True if the raster is stored in tiles, false if in strips.
    pub is_tiled: bool,
    /// Columns and rows of a block (a tile or a strip).
    pub block: [usize; 2],
    /// Byte order of the file.
    pub byte_order: ByteOrder,
    /// True if offsets have 64 bits (BigTIFF).
    pub is_big_tiff: bool,
    /// The stored sample that means "no value", before scale and offset.
    pub nodata: Option<f64>,
    /// Scale: values are stored sample x scale + offset.
    pub scale: f64,
    /// Offset, see `scale`.
    pub offset: f64,
    /// True if the coordinates in the file are those of cell centers (PixelIsPoint); `transform`
    /// refers to corners all the same.
    pub is_point: bool,
    /// The transform from cell corners to coordinates, as in [`Frame`]; `None` without usable
    /// georeferencing.
    pub transform: Option<[f64; 6]>,
    /// Coordinate system, if the file states one.
    pub crs: Option<Crs>,
    /// What the file states as its coordinate system, if that is not understood.
    pub unread_crs: Option<String>,
    /// Columns and rows of the overviews: further images in the file with fewer cells.
    pub overviews: Vec<[u64; 2]>,
    /// Warnings for the user.
    pub warnings: Vec<Wording>,
}

impl GeoTiffInfo {
    /// Returns a description such as "GeoTIFF, float32, 1 band, DEFLATE, predictor 3, tiles of 256
    /// x 256".
    pub fn description(&self) -> String {
        let mut text = String::from(if self.is_big_tiff {
            "BigTIFF"
        } else {
            "GeoTIFF"
        });
        if self.byte_order == ByteOrder::Big {
            text += " (big-endian)";
        }
        let (bands, blocks) = (
            if self.bands == 1 { "band" } else { "bands" },
            if self.is_tiled { "tiles" } else { "strips" },
        );
        text += &format!(
            ", {}, {} {bands}, compression {}",
            self.sample, self.bands, self.compression
        );
        if self.predictor != 1 {
            text += &format!(", predictor {}", self.predictor);
        }
        text + &format!(", {blocks} of {} x {}", self.block[0], self.block[1])
    }
}

/// The smallest and largest value of a raster, and the number of values.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Extremes {
    /// Number of cells with a value.
    pub valid: u64,
    /// The smallest and largest value; `None` if there is none.
    pub range: Option<[f64; 2]>,
    /// The smallest and largest sample as stored, before scale and offset.
    pub stored_range: Option<[f64; 2]>,
}

/// A GeoTIFF whose header was read. Values are decoded on request, on all cores.
#[derive(Debug)]
pub struct GeoTiffReader {
    path: PathBuf,
    bytes: Bytes,
    layout: BandLayout,
    nodata: Nodata,
    info: GeoTiffInfo,
}

/// Opens a GeoTIFF and reads its header.
///
/// # Errors
/// If the file is not a TIFF, its header is damaged, or it uses an unsupported feature, which the
/// message names.
pub fn open(path: impl AsRef<Path>) -> Result<GeoTiffReader> {
    let path = path.as_ref();
    Bytes::open(path)
        .and_then(|bytes| read_header(bytes, path))
        .map_err(|e| with_file(e, path))
}

/// Reads the header of a file that has no name; `path` is for messages.
pub(super) fn of_file(file: File, path: &Path) -> Result<GeoTiffReader> {
    Bytes::of_file(file)
        .and_then(|bytes| read_header(bytes, path))
        .map_err(|e| with_file(e, path))
}

/// Adds the file to an error and, if the file is damaged, the cure.
#[cold]
fn with_file(error: Error, path: &Path) -> Error {
    let error = error.in_file(path);
    match (error.kind(), error.cure_text()) {
        (Kind::Format, None) => error.cure("the file is damaged: copy or download it again"),
        _ => error,
    }
}

fn read_header(bytes: Bytes, path: &Path) -> Result<GeoTiffReader> {
    let directory = Directory::first(&bytes)?;
    let layout = BandLayout::read(&bytes, &directory)?;
    let mut warnings = Vec::new();
    let Described {
        nodata,
        metadata,
        model,
        crs,
        unread_crs,
    } = Described::read(&bytes, &directory, &mut warnings);
    let nodata = nodata_of(nodata.as_deref(), layout.sample, &mut warnings);
    let (scale, offset) = metadata.as_deref().map_or((None, None), scale_and_offset);
    let transform = transform_of(&model, path, &mut warnings)?;
    let missing = layout.missing_blocks();
    if missing > 0 && nodata.value.is_none() {
        let all = layout.block_count();
        warnings.push(
            format!("{missing} of {all} blocks are not in the file: their cells are 0, as in GDAL")
                .into(),
        );
    }
    let overviews = further_images(&bytes, &directory, &mut warnings);
    let info = GeoTiffInfo {
        width: layout.width,
        height: layout.height,
        bands: layout.bands,
        sample: layout.sample,
        compression: tags::compression_name(layout.compression),
        predictor: layout.predictor,
        is_tiled: layout.is_tiled,
        block: layout.block,
        byte_order: layout.order,
        is_big_tiff: directory.is_big,
        nodata: nodata.value,
        scale: scale.unwrap_or(1.0),
        offset: offset.unwrap_or(0.0),
        is_point: model.is_point,
        transform,
        crs,
        unread_crs,
        overviews,
        warnings,
    };
    Ok(GeoTiffReader {
        path: path.to_path_buf(),
        bytes,
        layout,
        nodata,
        info,
    })
}

/// What the tags state that only describe the raster: a damaged one leads to a warning and is left
/// out.
struct Described {
    nodata: Option<String>,
    metadata: Option<String>,
    model: ModelTags,
    crs: Option<Crs>,
    /// What is stated as the coordinate system, if that is not understood.
    unread_crs: Option<String>,
}

impl Described {
    fn read(bytes: &Bytes, directory: &Directory, warnings: &mut Vec<Wording>) -> Self {
        let nodata = or_warning(directory.text(bytes, tags::GDAL_NODATA), warnings);
        let metadata = or_warning(directory.text(bytes, tags::GDAL_METADATA), warnings);
        let mut floats = |tag| or_warning(directory.floats(bytes, tag), warnings);
        let mut model = ModelTags {
            pixel_scale: floats(tags::MODEL_PIXEL_SCALE),
            tiepoints: floats(tags::MODEL_TIEPOINT),
            transformation: floats(tags::MODEL_TRANSFORMATION),
            is_point: false,
        };
        let keys = or_warning(geo_keys(bytes, directory), warnings);
        // The type of the raster is known even if the system is not.
        model.is_point = raster_type(&keys) == Some(2);
        let (crs, unread_crs) = match keys.crs() {
            Ok(crs) => (crs, None),
            Err(error) => {
                warnings.push(error.to_string().into());
                (None, Some(format!("{keys:?}")))
            }
        };
        Described {
            nodata,
            metadata,
            model,
            crs,
            unread_crs,
        }
    }
}

/// Returns what was found; if that is an error, nothing, and a warning.
fn or_warning<T: Default>(found: Result<T>, warnings: &mut Vec<Wording>) -> T {
    found.unwrap_or_else(|error| {
        warnings.push(error.to_string().into());
        T::default()
    })
}

/// Returns the value of nodata that a text states; warns if it is none of samples of this type.
fn nodata_of(text: Option<&str>, sample: SampleType, warnings: &mut Vec<Wording>) -> Nodata {
    let nodata = match text.map(|text| (text, Nodata::parse(text))) {
        Some((_, Some(nodata))) => nodata,
        Some((text, None)) if !text.trim().is_empty() => {
            warnings
                .push(format!("the nodata value {text:?} is not a number and is ignored").into());
            Nodata::default()
        }
        _ => Nodata::default(),
    };
    if nodata.is_out_of_range(sample) {
        let value = nodata.value.unwrap_or_default();
        warnings.push(format!("no {sample} sample can be the nodata value {value}").into());
    }
    nodata
}

/// Returns the transform that the tags state, else that of a world file next to the raster; warns
/// if there is neither.
fn transform_of(
    model: &ModelTags,
    path: &Path,
    warnings: &mut Vec<Wording>,
) -> Result<Option<[f64; 6]>> {
    let (mut transform, warning) = model.transform();
    warnings.extend(warning);
    if transform.is_none()
        && let Some(beside) = world_file::read_beside(path)
    {
        transform = Some(beside?);
    }
    if transform.is_none() {
        warnings.push("no georeferencing: coordinates are columns and rows".into());
    }
    Ok(transform)
}

fn geo_keys(bytes: &Bytes, directory: &Directory) -> Result<GeoKeys> {
    let Some(values) = directory.unsigned(bytes, tags::GEO_KEY_DIRECTORY)? else {
        return Ok(GeoKeys::default());
    };
    Ok(GeoKeys {
        directory: values.iter().map(|&value| value as u16).collect(),
        doubles: directory
            .floats(bytes, tags::GEO_DOUBLE_PARAMS)?
            .unwrap_or_default(),
        ascii: directory
            .text(bytes, tags::GEO_ASCII_PARAMS)?
            .unwrap_or_default(),
    })
}

/// Returns PixelIsArea (1) or PixelIsPoint (2), if the keys state it.
fn raster_type(keys: &GeoKeys) -> Option<u16> {
    let entries = keys.directory.get(4..)?.chunks_exact(4);
    entries
        .filter(|key| key[0] == tags::RASTER_TYPE_KEY && key[1] == 0)
        .map(|key| key[3])
        .next()
}

/// Returns the sizes of the overviews. A mask leads to a warning, since it is not applied.
fn further_images(bytes: &Bytes, first: &Directory, warnings: &mut Vec<Wording>) -> Vec<[u64; 2]> {
    const MAX_IMAGES: usize = 100;
    let mut overviews = Vec::new();
    let mut seen = BTreeSet::new();
    let mut next = first.following(bytes);
    let mut offset = first.next_offset();
    while let Some(directory) = next {
        let Ok(directory) = directory else {
            warnings.push(
                format!("a further image at byte {offset} cannot be read and is ignored").into(),
            );
            break;
        };
        if !seen.insert(offset) || seen.len() > MAX_IMAGES {
            warnings.push("the list of images in the file is circular or unreasonably long".into());
            break;
        }
        let number = |tag| directory.number(bytes, tag).ok().flatten().unwrap_or(0);
        let kind = number(tags::NEW_SUBFILE_TYPE);
        if kind & 4 != 0 {
            warnings.push("a mask inside the file is not applied".into());
        } else if kind & 1 != 0 {
            overviews.push([number(tags::IMAGE_WIDTH), number(tags::IMAGE_LENGTH)]);
        }
        offset = directory.next_offset();
        next = directory.following(bytes);
    }
    overviews
}

impl GeoTiffReader {
    /// Returns what the header states.
    pub fn info(&self) -> &GeoTiffInfo {
        &self.info
    }

    /// Reads the values of band 1 in a window, row by row; NaN is nodata.
    ///
    /// # Errors
    /// If the window exceeds the raster or [`MAX_CELLS`], or a block in it is damaged or not in the
    /// file; the message names the block.
    pub fn read_window(&self, window: Window) -> Result<Vec<f64>> {
        let mut values = self.read_stored(window)?;
        self.scale(&mut values);
        Ok(values)
    }

    /// Like [`read_window`](Self::read_window), but before scale and offset.
    ///
    /// # Errors
    /// As [`read_window`](Self::read_window).
    pub fn read_stored(&self, window: Window) -> Result<Vec<f64>> {
        self.stored(window, &unwatched)
            .map_err(|e| with_file(e, &self.path))
    }

    /// Reads the whole raster.
    ///
    /// # Errors
    /// As [`read_window`](Self::read_window).
    pub fn read_grid(&self) -> Result<Grid> {
        self.read_grid_with(&unwatched)
    }

    /// Like [`read_grid`](Self::read_grid), but watched: the cells of the blocks that were read are
    /// counted.
    ///
    /// # Errors
    /// Those of [`read_grid`](Self::read_grid), and that of the watch.
    pub fn read_grid_with(&self, watch: Watch) -> Result<Grid> {
        let frame = self.frame();
        let mut values = self
            .stored(frame.window(), watch)
            .map_err(|e| with_file(e, &self.path))?;
        self.scale(&mut values);
        Ok(Grid {
            frame,
            crs: self.info.crs.clone(),
            values,
        })
    }

    /// Reads all values once, in bounded memory, and returns their number and range.
    ///
    /// # Errors
    /// If a block is damaged or not in the file.
    pub fn extremes(&self) -> Result<Extremes> {
        self.extremes_with(&unwatched)
    }

    /// Like [`extremes`](Self::extremes), but watched: the cells of the blocks that were read are
    /// counted.
    ///
    /// # Errors
    /// Those of [`extremes`](Self::extremes), and that of the watch.
    pub fn extremes_with(&self, watch: Watch) -> Result<Extremes> {
        /// Cells read at a time, roughly; blocks of up to `BLOCK_CELLS` are read whole.
        const CELLS: usize = 1 << 24;
        const BLOCK_CELLS: usize = 1 << 26;
        let Frame { width, height, .. } = self.frame();
        // Whole blocks, so that none is decoded twice.
        let [block_width, block_height] = self.info.block;
        let block_height = block_height.min((BLOCK_CELLS / block_width).max(1));
        let columns = width.min(block_width * (CELLS / (block_width * block_height)).max(1));
        let rows = block_height * (CELLS / (columns * block_height)).max(1);
        let mut found = Extremes::default();
        for row in (0..height).step_by(rows) {
            for column in (0..width).step_by(columns) {
                let window = Window {
                    column,
                    row,
                    width: columns.min(width - column),
                    height: rows.min(height - row),
                };
                let values = self
                    .stored(window, watch)
                    .map_err(|e| with_file(e, &self.path))?;
                for value in values.into_iter().filter(|value| !value.is_nan()) {
                    found.valid += 1;
                    let [min, max] = found.stored_range.get_or_insert([value; 2]);
                    *min = min.min(value);
                    *max = max.max(value);
                }
            }
        }
        found.range = found.stored_range.map(|mut ends| {
            self.scale(&mut ends);
            [ends[0].min(ends[1]), ends[0].max(ends[1])]
        });
        Ok(found)
    }

    /// Replaces the coordinate system.
    pub fn set_crs(&mut self, crs: Option<Crs>) {
        self.info.crs = crs;
    }

    /// Returns how many rows to read at a time, so that they have about this many cells and few
    /// blocks are decoded twice.
    pub fn rows_at_once(&self, cells: usize) -> usize {
        let [_, block_height] = self.span_size();
        let most = (cells / self.info.width.max(1)).max(1);
        if block_height > 2 * most {
            most
        } else {
            (most / block_height).max(1) * block_height
        }
    }

    /// Returns the columns and rows that are decoded together, at most.
    pub(super) fn span_size(&self) -> [usize; 2] {
        self.layout.span_size()
    }

    /// Returns the value of cells of blocks that are not in the file.
    pub(super) fn missing_value(&self) -> f32 {
        let mut value = [self.nodata.of_missing_blocks()];
        self.scale(&mut value);
        value[0] as f32
    }

    /// Decodes the cells of a span that are in the raster.
    pub(super) fn decoded(&self, span: &Span) -> Result<Vec<f32>> {
        let part = overlap(span, self.frame().window());
        let mut cells = Vec::with_capacity(part.width * part.height);
        let mut take = |_, mut values: Vec<f64>| {
            self.scale(&mut values);
            cells.extend(values.into_iter().map(|value| value as f32));
        };
        block::values(
            &self.layout,
            &self.nodata,
            &self.bytes,
            span,
            part,
            &mut take,
        )
        .map_err(|e| with_file(e, &self.path))?;
        Ok(cells)
    }

    fn scale(&self, values: &mut [f64]) {
        let GeoTiffInfo { scale, offset, .. } = self.info;
        if scale != 1.0 || offset != 0.0 {
            for value in values {
                *value = *value * scale + offset;
            }
        }
    }

    fn stored(&self, window: Window, watch: Watch) -> Result<Vec<f64>> {
        let Window {
            column,
            row,
            width,
            height,
        } = window;
        let fits = |start: usize, length: usize, end| {
            start.checked_add(length).is_some_and(|stop| stop <= end)
        };
        if !fits(column, width, self.info.width) || !fits(row, height, self.info.height) {
            return Err(Error::usage(format!(
                "{width} x {height} cells from column {column}, row {row} exceed the raster of {} x {}",
                self.info.width, self.info.height
            )));
        }
        let cells = width.saturating_mul(height);
        if cells > MAX_CELLS {
            return Err(Error::limit(format!(
                "{width} x {height} cells exceed the limit of {MAX_CELLS} cells that are read at once"
            ))
            .cure("use a part of the raster (gdal_translate -projwin) or a coarser one (gdal_translate -tr)"));
        }
        if cells == 0 {
            return Ok(Vec::new());
        }
        // The position of every block is checked before memory for its values is allocated.
        let spans = self.spans(window)?;
        let mut out = Vec::new();
        out.try_reserve_exact(cells)
            .map_err(|_| Error::limit(format!("no memory for {width} x {height} cells")))?;
        out.resize(cells, self.nodata.of_missing_blocks());
        let mut copy = |part: Window, values: Vec<f64>| {
            for (line, source) in values.chunks_exact(part.width).enumerate() {
                let start = (part.row + line - row) * width + part.column - column;
                out[start..start + part.width].copy_from_slice(source);
            }
        };
        let values = |span: &Span, take: &mut dyn FnMut(Window, Vec<f64>)| {
            block::values(
                &self.layout,
                &self.nodata,
                &self.bytes,
                span,
                overlap(span, window),
                take,
            )
        };
        /// Limit for the bytes of values that wait to be copied.
        const MAX_WAITING_BYTES: u64 = 1 << 27;
        let span_bytes = self
            .layout
            .span_bytes()
            .max(8 * self.layout.span_cells())
            .max(1);
        let batch = (MAX_WAITING_BYTES / span_bytes).min(4 * rayon::current_num_threads() as u64);
        if batch < 2 {
            // Only one of such huge blocks is decoded at a time, and its values are copied at once.
            spans
                .iter()
                .try_for_each(|span| values(span, &mut copy).and_then(|()| watch(span.cells())))?;
            return Ok(out);
        }
        for batch in spans.chunks(batch as usize) {
            let decode = |span: &Span| {
                let mut bands = Vec::new();
                values(span, &mut |part, values| bands.push((part, values))).map(|()| bands)
            };
            let decoded: Vec<_> = batch.par_iter().map(decode).collect::<Result<_>>()?;
            decoded
                .into_iter()
                .flatten()
                .for_each(|(part, values)| copy(part, values));
            watch(batch.iter().map(Span::cells).sum())?;
        }
        Ok(out)
    }

    /// Returns the stored spans that a window touches.
    pub(super) fn spans(&self, window: Window) -> Result<Vec<Span>> {
        let block_width = self.layout.block[0];
        let columns =
            window.column / block_width..(window.column + window.width).div_ceil(block_width);
        debug_assert!(columns.end <= self.layout.across());
        let mut spans = Vec::new();
        let mut row = window.row;
        while row < window.row + window.height {
            let mut end = row + 1;
            for across in columns.clone() {
                let span = self
                    .layout
                    .span(across, row, &self.bytes)
                    .map_err(|e| with_file(e, &self.path))?;
                end = span.first_row + span.rows;
                if matches!(span.stored, Stored::At { .. }) {
                    spans.push(span);
                }
            }
            row = end;
        }
        Ok(spans)
    }
}

/// Returns the part of a span within a window, which must touch it.
pub(super) fn overlap(span: &Span, window: Window) -> Window {
    let column = span.first_column.max(window.column);
    let row = span.first_row.max(window.row);
    let width = (span.first_column + span.width).min(window.column + window.width) - column;
    let height = (span.first_row + span.rows).min(window.row + window.height) - row;
    Window {
        column,
        row,
        width,
        height,
    }
}

impl BlockSource for GeoTiffReader {
    /// Returns the frame; without georeferencing, the coordinates are those of cell corners.
    fn frame(&self) -> Frame {
        let transform = self
            .info
            .transform
            .unwrap_or([0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
        Frame {
            width: self.info.width,
            height: self.info.height,
            transform,
        }
    }

    fn crs(&self) -> Option<&Crs> {
        self.info.crs.as_ref()
    }

    fn fill(&self, window: Window, out: &mut [f32]) -> Result<()> {
        for (out, value) in out.iter_mut().zip(self.read_window(window)?) {
            *out = value as f32;
        }
        Ok(())
    }
}
