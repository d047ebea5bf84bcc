//! What is known of a format: how it is recognized, what it can contain, and its functions.

use std::io::Read;
use std::path::Path;

use crate::crs::Crs;
use crate::data::{
    BlockSource, Colors, ContourLine, Layer, PointInfo, PointSink, PointSource, Triangles,
};
use crate::error::{Result, Wording};
use crate::io::bytes::mapped::Mapped;
use crate::io::bytes::output::Destination;
use crate::io::bytes::watch::Watch;
use crate::io::codec::ascii_grid::AsciiGrid;
use crate::io::codec::contour_summary::ContourSummary;
use crate::io::codec::geotiff::{GeoTiffReader, RasterSummary};
use crate::io::codec::las::{Detail, Rounding};
use crate::io::codec::listing::{Listing, Remarks};
use crate::io::codec::stl::Solid;
use crate::io::codec::tetgen::Tetrahedralized;
use crate::io::codec::triangle::Triangulated;
use crate::io::options::layer as layer_options;
use crate::io::options::map_sheet::MapSheet;
use crate::io::options::points::Options;

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
    /// Lines with heights and attributes.
    Lines,
    /// Heights in cells.
    Heights,
    /// Shades in cells.
    Shades,
    /// The colors of heights in cells.
    Colors,
    /// Points and segments in the plane, and their triangulation.
    Plane,
    /// Points in space, and their triangulation.
    Space,
}

/// How the format of a file is recognized.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum KnownBy {
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
pub(super) enum Magic {
    /// These bytes, at this offset.
    At(usize, &'static [u8]),
    /// This word, in any case, also behind a mark of UTF-8.
    Word(&'static str),
}

impl Magic {
    fn matches(self, head: &[u8]) -> bool {
        match self {
            Magic::At(at, bytes) => head.get(at..).is_some_and(|rest| rest.starts_with(bytes)),
            Magic::Word(word) => head
                .strip_prefix(b"\xef\xbb\xbf")
                .unwrap_or(head)
                .get(..word.len())
                .is_some_and(|start| start.eq_ignore_ascii_case(word.as_bytes())),
        }
    }
}

type Points = Result<Box<dyn PointSource + Send>>;
type ReadLayer = fn(&Path, &layer_options::Options, Watch) -> Result<Layer>;

/// The function that reads a format.
#[derive(Debug, Clone, Copy)]
pub(crate) enum FormatReader {
    Points {
        file: fn(&Path, Options) -> Points,
        /// Reads input that can be read only once; messages show the path as its name.
        stream: fn(Box<dyn Read + Send>, &Path, Options) -> Points,
    },
    /// A file is one layer.
    Layer(ReadLayer),
    /// A file has any number of layers.
    Layers(ReadLayer),
    Raster(fn(&Path) -> Result<GeoTiffReader>),
    /// Heights as text.
    Grid(fn(&Path) -> Result<AsciiGrid>),
    Mesh(fn(&Path, Watch) -> Result<Triangles>),
    /// Triangles of one surface of several, by its name; `None` for the only one.
    Surfaces(fn(&Path, Option<&str>, Watch) -> Result<Triangles>),
    /// A TIN, which is not read, but used where its bytes are.
    Tin(fn(&Path) -> Result<Mapped>),
    /// The index of a surface in parts, each of which is a TIN.
    Parts(fn(&Path) -> Result<Vec<u8>>),
    /// Triangles without exact coordinates: counted, but not read.
    Solid(fn(&Path) -> Result<Solid>),
    /// Points and segments of the plane, see [`triangle::read`](crate::io::triangle::read).
    Own,
    /// Not read, but `info` describes it.
    InfoOnly,
    /// Read by GDAL, in a build with the feature `gdal`.
    Gdal,
    /// Not read at all.
    Unread,
}

impl FormatReader {
    /// Returns the function that reads a layer.
    pub(crate) fn layer(self) -> Option<ReadLayer> {
        match self {
            FormatReader::Layer(read) | FormatReader::Layers(read) => Some(read),
            _ => None,
        }
    }
}

pub(super) type WriteSurface = fn(Destination, &Listing, Option<&Crs>) -> Result<Remarks>;
pub(crate) type WriteHeights = fn(Destination, &dyn BlockSource) -> Result<RasterSummary>;
type WriteShades = fn(Destination, &dyn BlockSource) -> Result<()>;
type WriteColors = fn(Destination, &dyn BlockSource, &Colors) -> Result<()>;
type WriteSpace = fn(&[Destination], &Tetrahedralized) -> Result<()>;
type WritePlane = fn(&[Destination], &Triangulated) -> Result<()>;
pub(super) type WriteLines = fn(Destination, &Layer) -> Result<Vec<String>>;
pub(super) type WriteMap = fn(Destination, &MapSheet) -> Result<Vec<String>>;
pub(super) type WriteContours =
    fn(Destination, &mut dyn Iterator<Item = ContourLine>, Option<&Crs>) -> Result<ContourSummary>;

pub(super) type Sink<'a> = Result<Box<dyn PointSink + 'a>>;

/// The functions that write points.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PointWriter {
    /// The detail that must be read of the points to be written.
    pub(crate) detail: Detail,
    pub(crate) create: for<'a> fn(Destination<'a>, &[&PointInfo], Rounding) -> Sink<'a>,
}

/// The functions that write each product; `None` if the format does not support it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Writers {
    pub(crate) points: Option<PointWriter>,
    pub(crate) surface: Option<WriteSurface>,
    pub(crate) contours: Option<WriteContours>,
    /// Writes lines with their attributes, and returns warnings.
    pub(crate) lines: Option<WriteLines>,
    /// Writes contours of a map with their labels, and returns warnings.
    pub(crate) map: Option<WriteMap>,
    /// Returns an error if contours with this many vertices are too large for the format.
    pub(crate) check_size: Option<fn(u64) -> Result<()>>,
    pub(crate) heights: Option<WriteHeights>,
    pub(crate) shades: Option<WriteShades>,
    pub(crate) colors: Option<WriteColors>,
    /// Writes several files together, see [`triangle::write`](crate::io::triangle::write).
    pub(crate) plane: Option<WritePlane>,
    /// Writes several files together, see [`tetgen::write`](crate::io::tetgen::write).
    pub(crate) space: Option<WriteSpace>,
}

/// The writers of a format that is only read.
pub(super) const NOT_WRITTEN: Writers = Writers {
    points: None,
    surface: None,
    contours: None,
    lines: None,
    map: None,
    check_size: None,
    heights: None,
    shades: None,
    colors: None,
    plane: None,
    space: None,
};

/// A file format; [`FORMATS`](super::FORMATS) lists them all.
#[derive(Debug)]
pub struct Format {
    /// The name of the format in lists: "GeoTIFF".
    pub name: &'static str,
    /// What a sentence calls a file of this format: "a TIFF file".
    pub noun: &'static str,
    /// Extensions in lower case without the dot, the most common one first.
    pub extensions: &'static [&'static str],
    pub(super) magic: &'static [Magic],
    pub(super) known_by: KnownBy,
    /// The kind of data that a file is read as.
    pub content: Content,
    /// The kinds of data that a file can contain.
    pub holds: &'static [Holding],
    /// Extensions of the files written along with it. If one starts with the format's own
    /// extension, the rest is appended to the whole file name.
    pub beside: &'static [&'static str],
    /// Extensions of files that belong to a file of this format, whichever program wrote them.
    pub parts: &'static [&'static str],
    /// Extensions of files that are read along with a file of this format, in any case. As in
    /// `beside`, one that starts with the format's own extension is appended to the file name.
    pub read_along: &'static [&'static str],
    /// GDAL's names for the format, if breakline or a driver of GDAL writes it.
    pub gdal_names: &'static [&'static str],
    /// Creation options of GDAL's drivers that say what breakline writes anyway.
    pub(crate) as_written: &'static [&'static str],
    pub(crate) reader: FormatReader,
    pub(crate) writers: Writers,
    /// What to do with such a file where points are expected.
    pub(crate) cure: fn() -> Wording,
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
            Product::Lines => self.writers.lines.is_some(),
            Product::Heights => self.writers.heights.is_some(),
            Product::Shades => self.writers.shades.is_some(),
            Product::Colors => self.writers.colors.is_some(),
            Product::Plane => self.writers.plane.is_some(),
            Product::Space => self.writers.space.is_some(),
        }
    }

    /// Returns true if the format is read without GDAL.
    pub fn is_read(&self) -> bool {
        !matches!(self.reader, FormatReader::Gdal | FormatReader::Unread)
    }

    pub(super) fn has_extension(&self, path: &Path) -> bool {
        let name = path.file_name().unwrap_or_default().as_encoded_bytes();
        // An extension may have two parts, as `copc.laz` does.
        let is_it = |known: &&str| {
            name.len().checked_sub(known.len()).is_some_and(|start| {
                let (before, end) = name.split_at(start);
                before.len() > 1
                    && before.ends_with(b".")
                    && end.eq_ignore_ascii_case(known.as_bytes())
            })
        };
        self.extensions.iter().any(is_it)
    }

    pub(super) fn begins_like(&self, head: &[u8]) -> bool {
        self.magic.iter().any(|magic| magic.matches(head))
    }
}
