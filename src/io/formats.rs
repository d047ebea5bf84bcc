//! The file formats: how each is recognized, what it can contain, and which functions read and
//! write it.
//!
//! [`FORMATS`] is the only table of formats. The readers that accept any format, the verbs' lists
//! of outputs, the help of the program and the table in `docs/formats.md` are derived from it. To
//! add a format, add a row here and a file or folder next to this one; see
//! `docs/how-to-add-a-format.md`.

use std::fmt::Write;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::contour_summary::ContourSummary;
use super::geotiff::{CellFormat, GeoTiffReader, RasterSummary};
use super::las::{Detail, Packing, Rounding};
use super::listing::Listing;
use super::mapped::Mapped;
use super::output::Destination;
use super::point_options::Options;
use super::triangle::Triangulated;
use super::watch::{Watch, bytes_of};
use super::{geojson, geotiff, las, obj, off, ply, png, shapefile, stl, text, tin, triangle};
use crate::crs::Crs;
use crate::data::{BlockSource, ContourLine, Layer, PointInfo, PointSink, PointSource, Triangles};
use crate::error::{Error, Result};

/// The kind of data that a file is read as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Content {
    /// Points.
    Points,
    /// Lines, polygons and points of a vector layer.
    Layer,
    /// Heights in cells.
    Raster,
    /// Triangles.
    Mesh,
    /// Shades in cells, but no heights.
    Picture,
    /// Points and segments in the plane, or part of their triangulation.
    Plane,
}

/// The kinds of data that a format can store.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Holding {
    /// Points with heights.
    Points,
    /// Lines.
    Lines,
    /// Polygons.
    Polygons,
    /// Raster cells.
    Raster,
    /// Triangles.
    Mesh,
    /// Attributes of lidar points: classes, returns, times and so on.
    Attributes,
    /// Marks for the triangle edges that lie on breaklines.
    Edges,
    /// A coordinate system, in the file itself or in a file next to it.
    Crs,
    /// Compressed data.
    Compression,
}

/// The products that can be written to a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Product {
    /// Points; from LAS with all attributes that they have there.
    Points,
    /// A surface, as a mesh.
    Surface,
    /// Contours.
    Contours,
    /// Heights in cells.
    Heights,
    /// Shades in cells.
    Shades,
    /// Points and segments in the plane, and their triangulation.
    Plane,
}

/// How the format of a file is recognized.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum KnownBy {
    /// By its first bytes, whatever its name; by its extension if the first bytes differ.
    Bytes,
    /// By its extension; by its first bytes if no format has that extension.
    Name,
    /// By its extension. The first bytes only serve to name the format in messages, since other
    /// formats start with the same bytes.
    NameAlone,
    /// By its extension and first bytes together, since other formats share the extension.
    NameAndBytes,
    /// By neither: the format of files that match no other.
    Rest,
}

/// Magic bytes of a format.
#[derive(Debug, Clone, Copy)]
enum Magic {
    /// These bytes, at this offset.
    At(usize, &'static [u8]),
    /// This word, in any case.
    Word(&'static str),
}

impl Magic {
    fn matches(self, head: &[u8]) -> bool {
        match self {
            Magic::At(at, bytes) => head.get(at..).is_some_and(|rest| rest.starts_with(bytes)),
            Magic::Word(word) => {
                head.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word.as_bytes()))
            }
        }
    }
}

type Points = Result<Box<dyn PointSource + Send>>;

/// The function that reads a format.
#[derive(Debug, Clone, Copy)]
pub(super) enum Reader {
    Points {
        file: fn(&Path, Options) -> Points,
        /// Reads input that can be read only once; messages show the path as its name.
        stream: fn(Box<dyn Read + Send>, &Path, Options) -> Points,
    },
    Layer(fn(&Path, Option<&str>, Watch) -> Result<Layer>),
    Raster(fn(&Path) -> Result<GeoTiffReader>),
    Mesh(fn(&Path, Watch) -> Result<Triangles>),
    /// A TIN, which is not read, but used where its bytes are.
    Tin(fn(&Path) -> Result<Mapped>),
    /// Triangles without exact coordinates: counted, but not read.
    Solid(fn(&Path) -> Result<stl::Solid>),
    /// Points and segments of the plane, see [`triangle::read`].
    Own,
    /// Not read, but `info` describes it.
    InfoOnly,
    /// Read by GDAL, in a build with the feature `gdal`.
    Gdal,
    /// Not read at all.
    Unread,
}

/// A local origin: what was subtracted from all coordinates, and the file that states it.
pub(super) type Origin = Option<([f64; 3], PathBuf)>;

type WriteSurface = fn(Destination, &Listing, Option<&Crs>) -> Result<Origin>;
type WriteHeights = fn(Destination, &dyn BlockSource) -> Result<RasterSummary>;
type WriteShades = fn(Destination, &dyn BlockSource) -> Result<()>;
type WritePlane = fn(&[Destination], &Triangulated) -> Result<()>;
type WriteContours = fn(Destination, &mut dyn Iterator<Item = ContourLine>, Option<&Crs>) -> Result<ContourSummary>;

type Sink<'a> = Result<Box<dyn PointSink + 'a>>;

/// The functions that write points.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointWriter {
    /// The detail that must be read of the points to be written.
    pub(super) detail: Detail,
    pub(super) create: for<'a> fn(Destination<'a>, &[&PointInfo], Rounding) -> Sink<'a>,
}

/// The functions that write each product; `None` if the format does not support it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Writers {
    pub(super) points: Option<PointWriter>,
    pub(super) surface: Option<WriteSurface>,
    pub(super) contours: Option<WriteContours>,
    /// Returns an error if contours with this many vertices are too large for the format.
    pub(super) check_size: Option<fn(u64) -> Result<()>>,
    pub(super) heights: Option<WriteHeights>,
    pub(super) shades: Option<WriteShades>,
    /// Writes several files together, see [`triangle::write`].
    pub(super) plane: Option<WritePlane>,
}

/// A file format; [`FORMATS`] lists them all.
#[derive(Debug)]
pub struct Format {
    /// The name of the format in lists: "GeoTIFF".
    pub name: &'static str,
    /// What a sentence calls a file of this format: "a TIFF file".
    pub noun: &'static str,
    /// Extensions in lower case without the dot, the most common one first.
    pub extensions: &'static [&'static str],
    magic: &'static [Magic],
    known_by: KnownBy,
    /// The kind of data that a file is read as.
    pub content: Content,
    /// The kinds of data that a file can contain.
    pub holds: &'static [Holding],
    /// Extensions of the files written along with it. If one starts with the format's own
    /// extension, the rest is appended to the whole file name.
    pub beside: &'static [&'static str],
    /// Extensions of files that belong to a file of this format, whichever program wrote them.
    pub parts: &'static [&'static str],
    /// GDAL's name for the format, if breakline writes it.
    pub gdal_name: Option<&'static str>,
    pub(super) reader: Reader,
    pub(super) writers: Writers,
    /// What to do with such a file where points are expected.
    pub(super) cure: &'static str,
    /// What is read or written in this format, in one line.
    pub help: &'static str,
}

impl Format {
    /// Returns true if a file of this format can contain `holding`.
    pub fn can_hold(&self, holding: Holding) -> bool {
        self.holds.contains(&holding)
    }

    /// Returns true if `product` can be written in this format.
    pub fn writes(&self, product: Product) -> bool {
        match product {
            Product::Points => self.writers.points.is_some(),
            Product::Surface => self.writers.surface.is_some(),
            Product::Contours => self.writers.contours.is_some(),
            Product::Heights => self.writers.heights.is_some(),
            Product::Shades => self.writers.shades.is_some(),
            Product::Plane => self.writers.plane.is_some(),
        }
    }

    /// Returns true if the format is read without GDAL.
    pub fn is_read(&self) -> bool {
        !matches!(self.reader, Reader::Gdal | Reader::Unread)
    }

    fn has_extension(&self, path: &Path) -> bool {
        let extension = path.extension().unwrap_or_default();
        self.extensions.iter().any(|known| extension.eq_ignore_ascii_case(known))
    }

    fn begins_like(&self, head: &[u8]) -> bool {
        self.magic.iter().any(|magic| magic.matches(head))
    }
}

/// Returns the format for writing a product, by the extension of the target.
pub fn for_output(path: &Path, product: Product) -> Option<&'static Format> {
    FORMATS.iter().find(|format| format.writes(product) && format.has_extension(path))
}

/// Number of bytes that suffice to recognize a file.
pub(super) const HEAD: usize = 1024;

/// Returns the format that a file's extension names, whether it can be read or not. Formats that
/// share their extension with another are not returned.
pub fn of_name(path: &Path) -> Option<&'static Format> {
    FORMATS
        .iter()
        .find(|format| !matches!(format.known_by, KnownBy::Rest | KnownBy::NameAndBytes) && format.has_extension(path))
}

/// Returns the format that a file is to be read as, by its first bytes (1024 are enough) and its
/// name.
///
/// Returns `None` for a binary file whose first bytes are unknown, and for a format whose first
/// bytes only serve to name it.
pub fn detect(head: &[u8], path: &Path) -> Option<&'static Format> {
    let find = |rule: KnownBy, matches: &dyn Fn(&Format) -> bool| {
        FORMATS.iter().find(|format| format.known_by == rule && matches(format))
    };
    find(KnownBy::Bytes, &|format| format.begins_like(head))
        .or_else(|| find(KnownBy::NameAndBytes, &|format| format.has_extension(path) && format.begins_like(head)))
        .or_else(|| of_name(path))
        .or_else(|| find(KnownBy::Name, &|format| format.begins_like(head)))
        .or_else(|| find(KnownBy::Rest, &|_| !is_binary(head) && of_bytes(head).is_none()))
}

/// Like [`detect`], but opens the file. Input that cannot be read twice (a pipe) is recognized by
/// its name only.
///
/// # Errors
/// If the file cannot be opened.
pub fn detect_file(path: &Path) -> Result<Option<&'static Format>> {
    let read = || -> std::io::Result<Vec<u8>> {
        let file = File::open(path)?;
        let mut head = Vec::new();
        if file.metadata()?.is_file() {
            file.take(HEAD as u64).read_to_end(&mut head)?;
        }
        Ok(head)
    };
    let head = read().map_err(|error| Error::from(error).in_file(path))?;
    Ok(detect(&head, path))
}

/// Returns the format that matches the first bytes, even if they alone do not decide.
pub(super) fn of_bytes(head: &[u8]) -> Option<&'static Format> {
    FORMATS.iter().find(|format| format.begins_like(head))
}

/// Returns the format that the first bytes or the name suggest, for use in a message.
pub(super) fn named(head: &[u8], path: &Path) -> Option<&'static Format> {
    of_bytes(head).or_else(|| of_name(path))
}

/// Returns the format of the layer that a file is only part of, and the extension that shows it,
/// such as `.dbf`.
pub(super) fn format_of_part(path: &Path) -> Option<(&'static Format, &'static str)> {
    let extension = path.extension()?;
    FORMATS.iter().filter(|format| matches!(format.reader, Reader::Layer(_))).find_map(|format| {
        let part = format.parts.iter().find(|part| extension.eq_ignore_ascii_case(part))?;
        Some((format, *part))
    })
}

/// Returns true if the bytes are not text. UTF-16 contains zeros too; the text reader refuses it by
/// name.
fn is_binary(head: &[u8]) -> bool {
    let is_utf16 = head.starts_with(b"\xff\xfe") || head.starts_with(b"\xfe\xff");
    head.contains(&0) && !is_utf16
}

/// Returns the extensions in which a product can be written.
pub fn extensions(product: Product) -> Vec<&'static str> {
    FORMATS.iter().filter(|format| format.writes(product)).flat_map(|format| format.extensions).copied().collect()
}

/// Returns the extensions in which a product can be written, for a sentence: ".shp, .geojson or
/// .json".
pub(super) fn extensions_or(product: Product) -> String {
    let all: Vec<String> = extensions(product).iter().map(|extension| format!(".{extension}")).collect();
    match &all[..] {
        [most @ .., last] if !most.is_empty() => format!("{} or {last}", most.join(", ")),
        _ => all.join(", "),
    }
}

impl Holding {
    const fn name(self) -> &'static str {
        match self {
            Holding::Points => "points",
            Holding::Lines => "lines",
            Holding::Polygons => "polygons",
            Holding::Raster => "cells",
            Holding::Mesh => "triangles",
            Holding::Attributes => "attributes",
            Holding::Edges => "edges on breaklines",
            Holding::Crs => "coordinate system",
            Holding::Compression => "compressed",
        }
    }
}

impl Product {
    const ALL: [Product; 6] =
        [Product::Points, Product::Surface, Product::Contours, Product::Heights, Product::Shades, Product::Plane];

    const fn name(self) -> &'static str {
        match self {
            Product::Points => "points",
            Product::Surface => "surface",
            Product::Contours => "contours",
            Product::Heights => "heights",
            Product::Shades => "hillshade",
            Product::Plane => "triangulation",
        }
    }
}

impl Reader {
    const fn name(self) -> &'static str {
        match self {
            Reader::Points { .. } => "points",
            Reader::Layer(_) => "lines, polygons, points",
            Reader::Raster(_) => "heights",
            Reader::Mesh(_) | Reader::Tin(_) => "surface",
            Reader::Own => "points and segments",
            Reader::Solid(_) | Reader::InfoOnly => "by `info` only",
            Reader::Gdal => "with `gdal`",
            Reader::Unread => "",
        }
    }
}

/// Returns the formats that this crate reads or writes, one per line, for the help of the program.
pub fn help() -> String {
    let mut text = String::from("Formats, by extension (more are read with the feature `gdal`):\n");
    for format in FORMATS.iter().filter(|format| format.is_read()) {
        let extensions: Vec<String> = format.extensions.iter().map(|extension| format!(".{extension}")).collect();
        // Writing to a string does not fail.
        let _ = writeln!(text, "  {:<28} {}", extensions.join(" "), format.help);
    }
    text
}

/// Returns the table of formats in `docs/formats.md`, in Markdown.
pub fn markdown() -> String {
    let mut text = String::from("| format | extensions | read | written | can hold |\n|---|---|---|---|---|\n");
    for format in FORMATS.iter().filter(|format| !format.extensions.is_empty()) {
        let extensions: Vec<String> = format.extensions.iter().map(|extension| format!("`.{extension}`")).collect();
        let written: Vec<_> =
            Product::ALL.into_iter().filter(|&product| format.writes(product)).map(Product::name).collect();
        let holds: Vec<_> = format.holds.iter().map(|holding| holding.name()).collect();
        let cells = [format.name, &extensions.join(", "), format.reader.name(), &written.join(", "), &holds.join(", ")];
        let _ = writeln!(text, "| {} |", cells.join(" | ").replace("|  |", "| |"));
    }
    text
}

const NOT_WRITTEN: Writers =
    Writers { points: None, surface: None, contours: None, check_size: None, heights: None, shades: None, plane: None };

pub(super) const WITH_GDAL: &str = "build with the feature `gdal` to read it: cargo build --release --features gdal";
const AS_RASTER: &str = "this is a raster: points are expected here";
const AS_PLANE: &str = "`breakline triangulate` reads it and writes its triangulation, to .ele, .ply or .obj";
const AS_MESH: &str = "save its vertices as text or LAS";
const UNPACK: &str = "unpack it";

/// A format that only GDAL may read; rows of the table override what differs.
const ROW: Format = Format {
    name: "",
    noun: "",
    extensions: &[],
    magic: &[],
    known_by: KnownBy::NameAlone,
    content: Content::Points,
    holds: &[],
    beside: &[],
    parts: &[],
    gdal_name: None,
    reader: Reader::Gdal,
    writers: NOT_WRITTEN,
    cure: WITH_GDAL,
    help: "",
};

const LIDAR: Reader = Reader::Points {
    file: |path, options| Ok(Box::new(las::open_with(path, options.las())?)),
    stream: |stream, name, options| Ok(Box::new(las::from_stream_with(stream, name, options.las())?)),
};

const TEXT: Reader = Reader::Points {
    file: |path, options| Ok(Box::new(text::open(path, options.columns)?)),
    stream: |stream, name, options| Ok(Box::new(text::from_stream(stream, name, options.columns)?)),
};

const fn lidar_writer(create: for<'a> fn(Destination<'a>, &[&PointInfo], Rounding) -> Sink<'a>) -> Writers {
    Writers { points: Some(PointWriter { detail: Detail::Records, create }), ..NOT_WRITTEN }
}

const fn surface_writer(write: WriteSurface) -> Writers {
    Writers { surface: Some(write), ..NOT_WRITTEN }
}

const fn raster(
    name: &'static str,
    noun: &'static str,
    extensions: &'static [&'static str],
    magic: &'static [Magic],
) -> Format {
    Format {
        name,
        noun,
        extensions,
        magic,
        content: Content::Raster,
        holds: &[Holding::Raster],
        cure: AS_RASTER,
        ..ROW
    }
}

const fn vector(
    name: &'static str,
    noun: &'static str,
    extensions: &'static [&'static str],
    magic: &'static [Magic],
) -> Format {
    Format {
        name,
        noun,
        extensions,
        magic,
        content: Content::Layer,
        holds: &[Holding::Points, Holding::Lines, Holding::Polygons],
        ..ROW
    }
}

/// Returns the row for one of Triangle's files.
const fn plane(
    name: &'static str,
    noun: &'static str,
    extensions: &'static [&'static str],
    help: &'static str,
) -> Format {
    Format {
        name,
        noun,
        extensions,
        content: Content::Plane,
        reader: Reader::Own,
        writers: Writers { plane: Some(triangle::write), ..NOT_WRITTEN },
        cure: AS_PLANE,
        help,
        ..ROW
    }
}

/// All formats, in the order in which lists show them.
pub static FORMATS: &[Format] = &[
    Format {
        name: "LAS",
        noun: "a LAS file",
        extensions: &["las"],
        magic: &[Magic::At(0, b"LASF")],
        known_by: KnownBy::Bytes,
        holds: &[Holding::Points, Holding::Attributes, Holding::Crs],
        reader: LIDAR,
        writers: lidar_writer(|target, sources, rounding| {
            Ok(Box::new(las::create(target, sources, Packing::Plain, rounding)?))
        }),
        help: "lidar points",
        ..ROW
    },
    Format {
        name: "LAZ, COPC",
        noun: "a LAZ file",
        extensions: &["laz"],
        magic: &[Magic::At(0, b"LASF")],
        known_by: KnownBy::Bytes,
        holds: &[Holding::Points, Holding::Attributes, Holding::Crs, Holding::Compression],
        reader: LIDAR,
        writers: lidar_writer(|target, sources, rounding| {
            Ok(Box::new(las::create(target, sources, Packing::Compressed, rounding)?))
        }),
        help: "lidar points, compressed",
        ..ROW
    },
    Format {
        name: "text",
        noun: "a text file",
        extensions: &["xyz", "txt", "csv"],
        known_by: KnownBy::Rest,
        holds: &[Holding::Points],
        reader: TEXT,
        writers: Writers {
            points: Some(PointWriter {
                detail: Detail::Columns,
                create: |target, sources, _| Ok(Box::new(text::create(target, sources)?)),
            }),
            ..NOT_WRITTEN
        },
        help: "points, one per line; also read under any other name",
        ..ROW
    },
    Format {
        name: "text, by others",
        noun: "a text file",
        extensions: &["asc", "pts"],
        known_by: KnownBy::Rest,
        holds: &[Holding::Points],
        reader: TEXT,
        help: "points, one a line",
        ..ROW
    },
    Format {
        name: "shapefile",
        noun: "a shapefile",
        extensions: &["shp"],
        // File code 9994, big endian.
        magic: &[Magic::At(0, &[0, 0, 0x27, 0x0a])],
        known_by: KnownBy::Name,
        content: Content::Layer,
        holds: &[Holding::Points, Holding::Lines, Holding::Polygons, Holding::Crs],
        beside: &["shx", "dbf", "prj", "cpg"],
        parts: &["shx", "dbf", "prj", "cpg", "qpj", "qix", "sbn", "sbx"],
        gdal_name: Some("ESRI Shapefile"),
        reader: Reader::Layer(shapefile::read_layer_with),
        writers: Writers {
            contours: Some(|target, lines, crs| shapefile::write_contours(target, lines, crs)),
            check_size: Some(shapefile::check_size),
            ..NOT_WRITTEN
        },
        help: "lines, polygons and points; contours",
        ..ROW
    },
    Format {
        name: "GeoJSON",
        noun: "a JSON file",
        extensions: &["geojson", "json"],
        magic: &[Magic::At(0, b"{")],
        content: Content::Layer,
        holds: &[Holding::Points, Holding::Lines, Holding::Polygons, Holding::Crs],
        gdal_name: Some("GeoJSON"),
        reader: Reader::Layer(geojson::read_layer_with),
        writers: Writers {
            contours: Some(|target, lines, crs| geojson::write_contours(target, lines, crs)),
            ..NOT_WRITTEN
        },
        help: "lines, polygons and points; contours",
        ..ROW
    },
    Format {
        name: "GeoTIFF",
        noun: "a TIFF file",
        extensions: &["tif", "tiff"],
        // TIFF and BigTIFF, in both byte orders.
        magic: &[Magic::At(0, b"II*\0"), Magic::At(0, b"MM\0*"), Magic::At(0, b"II+\0"), Magic::At(0, b"MM\0+")],
        known_by: KnownBy::Bytes,
        content: Content::Raster,
        holds: &[Holding::Raster, Holding::Crs, Holding::Compression],
        gdal_name: Some("GTiff"),
        reader: Reader::Raster(|path| geotiff::open(path)),
        writers: Writers {
            heights: Some(|target, source| geotiff::write(target, source, CellFormat::Heights.into())),
            shades: Some(|target, source| geotiff::write(target, source, CellFormat::Shades.into()).map(drop)),
            ..NOT_WRITTEN
        },
        cure: AS_RASTER,
        help: "heights in cells; hillshade",
        ..ROW
    },
    Format {
        name: "PNG",
        noun: "a PNG picture",
        extensions: &["png"],
        magic: &[Magic::At(0, b"\x89PNG")],
        content: Content::Picture,
        holds: &[Holding::Raster, Holding::Crs, Holding::Compression],
        beside: &["pgw", "png.aux.xml"],
        parts: &["pgw", "png.aux.xml"],
        gdal_name: Some("PNG"),
        reader: Reader::InfoOnly,
        writers: Writers { shades: Some(|target, source| png::write_gray(target, source)), ..NOT_WRITTEN },
        cure: AS_RASTER,
        help: "hillshade",
        ..ROW
    },
    Format {
        name: "PLY",
        noun: "a PLY mesh",
        extensions: &["ply"],
        magic: &[Magic::At(0, b"ply")],
        content: Content::Mesh,
        holds: &[Holding::Mesh, Holding::Edges, Holding::Crs],
        reader: Reader::Mesh(|path, watch| ply::read(&bytes_of(path, watch)?, watch)),
        writers: surface_writer(|target, mesh, crs| ply::write(target, mesh, crs).map(|()| None)),
        cure: AS_MESH,
        help: "triangles with breaklines and coordinate system",
        ..ROW
    },
    Format {
        name: "OBJ",
        noun: "an OBJ mesh",
        extensions: &["obj"],
        content: Content::Mesh,
        holds: &[Holding::Mesh, Holding::Crs],
        reader: Reader::Mesh(|path, watch| obj::read(&bytes_of(path, watch)?, watch)),
        writers: surface_writer(|target, mesh, crs| obj::write(target, mesh, crs).map(|()| None)),
        cure: AS_MESH,
        help: "triangles",
        ..ROW
    },
    Format {
        name: "OFF",
        noun: "an OFF mesh",
        extensions: &["off"],
        content: Content::Mesh,
        holds: &[Holding::Mesh, Holding::Crs],
        reader: Reader::Mesh(|path, watch| off::read(&bytes_of(path, watch)?, watch)),
        writers: surface_writer(|target, mesh, crs| off::write(target, mesh, crs).map(|()| None)),
        cure: AS_MESH,
        help: "triangles",
        ..ROW
    },
    Format {
        name: "STL",
        noun: "an STL mesh",
        extensions: &["stl"],
        content: Content::Mesh,
        holds: &[Holding::Mesh],
        beside: &["stl.origin.txt"],
        parts: &["stl.origin.txt"],
        reader: Reader::Solid(stl::describe),
        writers: surface_writer(|target, mesh, _| stl::write(target, mesh).map(Some)),
        cure: AS_MESH,
        help: "triangles in 32-bit floats from a local origin; written only",
        ..ROW
    },
    Format {
        name: "TIN",
        noun: "a TIN of breakline",
        extensions: &["tin"],
        magic: &[Magic::At(0, b"brkTIN\n\x1a")],
        known_by: KnownBy::Bytes,
        content: Content::Mesh,
        holds: &[Holding::Mesh, Holding::Edges, Holding::Crs],
        reader: Reader::Tin(tin::map),
        writers: surface_writer(|target, mesh, _| tin::write(target, mesh).map(|()| None)),
        cure: AS_MESH,
        help: "triangulation with breaklines and coordinate system, opened in milliseconds",
        ..ROW
    },
    Format {
        reader: Reader::Mesh(triangle::read_triangles_with),
        content: Content::Mesh,
        holds: &[Holding::Mesh, Holding::Edges],
        beside: &["node"],
        ..plane("Triangle .ele", "an .ele file of Triangle", &["ele"], "triangles in the plane (Triangle)")
    },
    Format {
        holds: &[Holding::Points],
        ..plane("Triangle .node", "a .node file of Triangle", &["node"], "points in the plane (Triangle)")
    },
    Format {
        holds: &[Holding::Points, Holding::Lines],
        beside: &["node"],
        ..plane("Triangle .poly", "a .poly file of Triangle", &["poly"], "points and segments in the plane (Triangle)")
    },
    Format {
        reader: Reader::InfoOnly,
        beside: &["node"],
        ..plane(
            "Triangle .edge",
            "an .edge file of Triangle",
            &["edge"],
            "edges of a triangulation in the plane (Triangle)",
        )
    },
    Format {
        reader: Reader::InfoOnly,
        ..plane(
            "Triangle .neigh",
            "a .neigh file of Triangle",
            &["neigh"],
            "neighbors in a triangulation in the plane (Triangle)",
        )
    },
    // Formats read by GDAL, or only named in messages.
    Format {
        known_by: KnownBy::NameAndBytes,
        ..raster("Esri ASCII grid", "an ESRI ASCII grid", &["asc"], &[Magic::Word("ncols"), Magic::Word("nrows")])
    },
    raster("GDAL virtual raster", "a GDAL virtual raster", &["vrt"], &[Magic::At(0, b"<VRTDataset")]),
    raster("Erdas Imagine", "an Erdas Imagine file", &["img"], &[Magic::At(0, b"EHFA_HEADER_TAG")]),
    raster("SRTM height file (HGT)", "an SRTM height file", &["hgt"], &[]),
    raster("USGS DEM", "a USGS DEM", &["dem"], &[]),
    raster(
        "DTED",
        "a DTED file",
        &["dt0", "dt1", "dt2"],
        &[Magic::At(0, b"UHL1"), Magic::At(0, b"HDR1"), Magic::At(80, b"UHL1")],
    ),
    raster("raw raster (BIL, FLT)", "a raw raster", &["bil", "flt"], &[]),
    raster("Surfer grid", "a Surfer grid", &[], &[Magic::At(0, b"DSAA"), Magic::At(0, b"DSBB"), Magic::At(0, b"DSRB")]),
    raster(
        "netCDF or HDF",
        "an HDF5 or netCDF file",
        &[],
        &[Magic::At(0, b"CDF\x01"), Magic::At(0, b"CDF\x02"), Magic::At(0, b"\x89HDF")],
    ),
    raster("GRIB", "a GRIB file", &[], &[Magic::At(0, b"GRIB")]),
    raster("JPEG", "a JPEG picture", &[], &[Magic::At(0, b"\xff\xd8\xff")]),
    raster("JPEG 2000", "a JPEG 2000 picture", &[], &[Magic::At(4, b"jP  "), Magic::At(0, b"\xff\x4f\xff\x51")]),
    vector(
        "GeoPackage (SQLite)",
        "a GeoPackage or another SQLite database",
        &["gpkg"],
        &[Magic::At(0, b"SQLite format 3\0")],
    ),
    vector("FlatGeobuf", "a FlatGeobuf file", &["fgb"], &[Magic::At(0, b"fgb\x03fgb")]),
    vector("XML (GML, KML)", "an XML file (GML, KML, LandXML)", &["kml", "gml"], &[Magic::At(0, b"<?xml")]),
    vector("DXF", "a DXF drawing", &["dxf"], &[]),
    vector("DWG", "a DWG drawing", &[], &[Magic::At(0, b"AC10")]),
    Format {
        name: "E57",
        noun: "an E57 scan",
        magic: &[Magic::At(0, b"ASTM-E57")],
        reader: Reader::Unread,
        cure: "save it as LAS or LAZ",
        ..ROW
    },
    Format {
        name: "ZIP",
        noun: "a ZIP archive",
        magic: &[Magic::At(0, b"PK\x03\x04")],
        reader: Reader::Unread,
        cure: UNPACK,
        ..ROW
    },
    Format {
        name: "gzip",
        noun: "a gzip archive",
        magic: &[Magic::At(0, b"\x1f\x8b")],
        reader: Reader::Unread,
        cure: UNPACK,
        ..ROW
    },
];
