//! Files of any kind, opened by their first bytes and extension.

use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

use super::context::{Journal, Size, Stage};
use super::input::{Input, MemoryPoints, MemorySource};
use super::memory;
use crate::crs::Crs;
use crate::data::{BlockSource, Frame, Grid, Layer, LinkFlaw, Mesh, PointSource, Triangles};
use crate::error::{Error, Kind, Result};
pub(super) use crate::io::formats::Content;
use crate::io::formats::{self, Format, Holding};
use crate::io::geotiff::GeoTiffReader;
pub(super) use crate::io::mesh::keeps_lines;
use crate::io::mesh::{self, Solid};
use crate::io::png::{self, Picture};
use crate::io::points::Options;
use crate::io::triangle::{self, LineGraph};
use crate::io::{gdal, layer, points, raster};

/// Returns true if a file is LAS, LAZ or COPC.
pub(super) fn is_lidar(path: &Path) -> bool {
    format(path).is_some_and(|format| format.can_hold(Holding::Attributes))
}

/// What the first bytes and the extension say. What neither knows are points: text comes under any
/// name.
pub(super) fn content(path: &Path) -> Content {
    format(path).map_or(Content::Points, |format| format.content)
}

fn format(path: &Path) -> Option<&'static Format> {
    let file = layer::split(&path.to_string_lossy()).0;
    // What is not there yet is known by its name.
    formats::detect_file(&file).unwrap_or_else(|_| formats::of_name(&file))
}

/// Points in memory, or of a file of any format.
pub(super) fn points(input: &Input<MemoryPoints>, options: Options) -> Result<Box<dyn PointSource + Send>> {
    match input {
        Input::File(path) => points_of_file(path, options),
        Input::Memory(points) => Ok(Box::new(MemorySource::new(Arc::clone(points))?)),
    }
}

/// Points of any format; of a vector layer, with the heights of an attribute where the name ends in
/// `:FIELD`.
pub(super) fn points_of_file(path: &Path, options: Options) -> Result<Box<dyn PointSource + Send>> {
    let of_layer = || -> Result<Box<dyn PointSource + Send>> { Ok(Box::new(points::from_layer(layer(path)?)?)) };
    match content(path) {
        Content::Layer => of_layer(),
        Content::Points | Content::Raster | Content::Mesh | Content::Picture | Content::Plane => {
            points::open_with(path, options).or_else(|error| match gdal_may_help(&error) {
                // What GDAL says of a file that it does not know either is less exact.
                true => of_layer().map_err(|_| error),
                false => Err(error),
            })
        }
    }
}

/// A vector layer, in memory or of a file.
pub(super) fn layer_of(input: &Input<Layer>) -> Result<Cow<'_, Layer>> {
    match input {
        Input::File(path) => layer(path).map(Cow::Owned),
        Input::Memory(layer) => Ok(Cow::Borrowed(layer)),
    }
}

/// A vector layer, with the heights of an attribute where the name ends in `:FIELD`; of formats that
/// GDAL reads, the layer of that name.
pub(super) fn layer(path: &Path) -> Result<Layer> {
    let Some(spec) = path.to_str() else {
        return Err(Error::unsupported("the name is not valid Unicode").in_file(path));
    };
    layer::read(spec).or_else(|error| {
        if !gdal_may_help(&error) {
            return Err(error);
        }
        let (file, name) = layer::split(spec);
        gdal::read_layer(&file, name)
    })
}

/// Returns true if a file that is not read here may be one for GDAL.
fn gdal_may_help(error: &Error) -> bool {
    cfg!(feature = "gdal") && error.kind() == Kind::Unsupported
}

/// A raster that is open.
pub(super) enum Raster {
    GeoTiff(Box<GeoTiffReader>),
    Gdal(Box<gdal::Raster>),
}

impl Raster {
    pub(super) fn open(path: &Path) -> Result<Self> {
        match raster::open(path) {
            Ok(reader) => Ok(Raster::GeoTiff(Box::new(reader))),
            Err(error) if gdal_may_help(&error) => gdal::open_raster(path).map(|raster| Raster::Gdal(Box::new(raster))),
            Err(error) => Err(error),
        }
    }
}

/// A raster, whole, and the warnings of its reader.
pub(super) fn raster(path: &Path, journal: &Journal) -> Result<(Grid, Vec<String>)> {
    let _reading = journal.start(Stage::ReadingCells, Size::Uncounted)?;
    match Raster::open(path)? {
        Raster::GeoTiff(reader) => {
            require_memory(reader.frame()).map_err(|e| e.in_file(path))?;
            Ok((reader.read_grid()?, reader.info().warnings.clone()))
        }
        Raster::Gdal(raster) => {
            require_memory(raster.frame()).map_err(|e| e.in_file(path))?;
            Ok((raster.read_grid()?, raster.warnings().to_vec()))
        }
    }
}

fn require_memory(frame: Frame) -> Result<()> {
    memory::require_for_cells(frame.width as u64 * frame.height as u64)
}

/// The frame of a raster and its coordinate system; no cell is read.
pub(super) fn raster_frame(path: &Path) -> Result<(Frame, Option<Crs>)> {
    match Raster::open(path)? {
        Raster::GeoTiff(reader) => Ok((reader.frame(), reader.info().crs.clone())),
        Raster::Gdal(raster) => Ok((raster.frame(), raster.crs().cloned())),
    }
}

/// A mesh that is a surface.
pub(super) fn mesh(path: &Path, journal: &Journal) -> Result<Mesh> {
    memory::require_for_mesh(path)?;
    let reading = journal.start(Stage::ReadingTriangles, Size::Uncounted)?;
    let mesh = mesh::read(path)?;
    reading.end()?;
    Ok(mesh)
}

/// The triangles of a mesh, whether they are a surface or not, linked as far as they can be; and the flaws of the links.
pub(super) fn linked_mesh(path: &Path) -> Result<(Mesh, Vec<LinkFlaw>)> {
    Mesh::link(mesh::read_triangles(path)?).map_err(|e| e.in_file(path))
}

/// What an STL file holds; `None` if it is another mesh.
pub(super) fn solid(path: &Path) -> Option<Result<Solid>> {
    mesh::describe_solid(path)
}

/// What a picture is, and where it lies.
pub(super) fn picture(path: &Path) -> Result<Picture> {
    png::describe(path)
}

/// How many edges or neighborhoods a file of Triangle's lists.
pub(super) fn listed(path: &Path) -> Result<usize> {
    triangle::count(path)
}

/// What a `.node` or a `.poly` file holds.
pub(super) fn line_graph(path: &Path) -> Result<LineGraph> {
    triangle::read(path)
}

/// The triangles of a mesh, as the file lists them.
pub(super) fn mesh_triangles(path: &Path, journal: &Journal) -> Result<Triangles> {
    let reading = journal.start(Stage::ReadingTriangles, Size::Uncounted)?;
    let triangles = mesh::read_triangles(path)?;
    reading.end()?;
    Ok(triangles)
}
