//! The one place where the command line meets readers, writers and verbs of the library.

use std::path::Path;

use crate::crs::{Crs, Transform};
use crate::data::{BlockSource, Bounds, ContourLine, Frame, Grid, Layer, Mesh, PointSource, Surface, Window};
use crate::error::{Error, Result};

/// What a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Content {
    Points,
    Layer,
    Raster,
    Mesh,
}

/// What the extension says. What it does not know are points: text comes under any name.
pub(super) fn content(path: &Path) -> Content {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    match extension.as_str() {
        "ply" => Content::Mesh,
        "tif" | "tiff" | "vrt" | "img" | "hgt" | "dem" | "dt0" | "dt1" | "dt2" | "asc" => Content::Raster,
        "shp" | "geojson" | "json" | "gpkg" | "fgb" | "kml" | "gml" | "dxf" => Content::Layer,
        _ => Content::Points,
    }
}

/// Points of any format.
pub(super) fn points(path: &Path) -> Result<Box<dyn PointSource + Send>> {
    Err(missing(path, "points"))
}

/// A vector layer, with the heights of an attribute where the name ends in `:FIELD`.
pub(super) fn layer(path: &Path) -> Result<Layer> {
    Err(missing(path, "vector layers"))
}

/// What a raster's header says.
#[derive(Debug, Clone)]
pub(super) struct RasterFacts {
    /// "GeoTIFF, tiles of 256 x 256, DEFLATE"
    pub(super) format: String,
    /// "Float32"
    pub(super) sample: String,
    pub(super) nodata: Option<f64>,
    pub(super) place: RasterPlace,
    pub(super) warnings: Vec<String>,
}

/// What a raster's header says, and its cells.
pub(super) fn raster_facts(path: &Path) -> Result<(RasterFacts, Grid)> {
    Err(missing(path, "rasters"))
}

/// A raster, whole.
pub(super) fn raster(path: &Path) -> Result<Grid> {
    Err(missing(path, "rasters"))
}

/// A mesh as this program writes it.
pub(super) fn mesh(path: &Path) -> Result<Mesh> {
    Err(missing(path, "meshes"))
}

/// What takes coordinates from one system to the other.
pub(super) fn transform(from: &Crs, to: &Crs) -> Result<Box<dyn Transform>> {
    Err(Error::unsupported(format!("reprojecting from {from} to {to}")))
}

/// The file formats of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MeshFormat {
    Ply,
    Obj,
    Stl,
}

/// Writes a mesh; returns what is to be told about it.
pub(super) fn write_mesh(target: &Path, _format: MeshFormat, _surface: &dyn Surface) -> Result<Vec<String>> {
    Err(missing(target, "meshes"))
}

/// Where a raster is.
#[derive(Debug, Clone)]
pub(super) struct RasterPlace {
    pub(super) frame: Frame,
    pub(super) crs: Option<Crs>,
}

/// Size and place of a raster, without reading its cells.
pub(super) fn raster_place(path: &Path) -> Result<RasterPlace> {
    Err(missing(path, "rasters"))
}

/// The frame around an extent with its corner at multiples of the resolution.
pub(super) fn snapped(_extent: Bounds, resolution: f64) -> Result<Frame> {
    Err(Error::unsupported(format!("a frame at {resolution}")))
}

/// Heights of a surface at the centers of cells.
pub(super) fn dem<'a>(surface: &'a dyn Surface, frame: Frame) -> Box<dyn BlockSource + 'a> {
    Box::new(Blank { frame, crs: surface.crs() })
}

/// Where the light comes from.
#[derive(Debug, Clone, Copy)]
pub(super) struct Light {
    pub(super) azimuth: f64,
    pub(super) altitude: f64,
    pub(super) z_factor: f64,
}

/// Brightness of a surface at the centers of cells.
pub(super) fn shade_of_surface<'a>(surface: &'a dyn Surface, frame: Frame, _light: Light) -> Box<dyn BlockSource + 'a> {
    Box::new(Blank { frame, crs: surface.crs() })
}

/// Brightness of the cells of a raster.
pub(super) fn shade_of_grid(grid: &Grid, _light: Light) -> Box<dyn BlockSource + '_> {
    Box::new(Blank { frame: grid.frame, crs: grid.crs.as_ref() })
}

struct Blank<'a> {
    frame: Frame,
    crs: Option<&'a Crs>,
}

impl BlockSource for Blank<'_> {
    fn frame(&self) -> Frame {
        self.frame
    }

    fn crs(&self) -> Option<&Crs> {
        self.crs
    }

    fn fill(&self, _window: Window, out: &mut [f32]) -> Result<()> {
        out.fill(f32::NAN);
        Ok(())
    }
}

/// The heights of contours.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Heights {
    Every { interval: f64, base: f64 },
    These(Vec<f64>),
}

/// Contours straight from triangles.
pub(super) fn contours_of_surface(_surface: &dyn Surface, heights: &Heights) -> Result<Vec<ContourLine>> {
    Err(Error::unsupported(format!("contours at {heights:?}")))
}

/// Contours between the centers of cells.
pub(super) fn contours_of_grid(_grid: &Grid, heights: &Heights) -> Result<Vec<ContourLine>> {
    Err(Error::unsupported(format!("contours at {heights:?}")))
}

/// What is wrong with a surface, one line each.
pub(super) fn flaws(_surface: &dyn Surface) -> Result<Vec<String>> {
    Err(Error::unsupported("checking"))
}

/// Writes heights as GeoTIFF.
pub(super) fn write_heights(target: &Path, _source: &dyn BlockSource) -> Result<()> {
    Err(missing(target, "rasters"))
}

/// The file formats of a hillshade.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ShadeFormat {
    GeoTiff,
    Png,
}

/// Writes brightness as a picture.
pub(super) fn write_shade(target: &Path, _format: ShadeFormat, _source: &dyn BlockSource) -> Result<()> {
    Err(missing(target, "pictures"))
}

/// Writes contours, format by extension.
pub(super) fn write_contours(target: &Path, _lines: &[ContourLine], _crs: Option<&Crs>) -> Result<()> {
    Err(missing(target, "contours"))
}

#[cold]
fn missing(path: &Path, what: &str) -> Error {
    Error::unsupported(format!("{what} are not supported by this build")).in_file(path)
}
