//! The one place where the command line meets readers, writers and verbs of the library.

use std::fmt::Display;
use std::io::Read;
use std::path::Path;

use crate::crs::{Crs, Transform};
use crate::data::{BlockSource, Frame, Grid, Layer, LinkFlaw, Mesh, PointSource, Surface, Triangles};
use crate::error::{Error, Kind, Result};
use crate::io::contours::{self, ContourSummary};
use crate::io::geotiff::{self, CellFormat, GeoTiffReader, RasterSummary, WriteOptions};
pub(super) use crate::io::mesh::Solid;
use crate::io::mesh::{self, MeshSummary};
use crate::io::png::Picture;
use crate::io::points::Options;
use crate::io::triangle::{self, LineGraph, Triangulated};
use crate::io::{Destination, gdal, layer, png, points, proj, raster};
use crate::terrain::{self, Dem, GridSurface, Levels, SurfaceFlaw};

use super::progress::{Size, Watched};
use super::talk::Talk;
use crate::run::memory;
use crate::run::overlaps::overlaps;

/// What a file holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Content {
    Points,
    Layer,
    Raster,
    Mesh,
    /// A picture: shades, but no heights.
    Picture,
    /// A file of Triangle's without triangles.
    Plane,
}

/// What LAS, LAZ and COPC begin with.
const LIDAR: &[u8] = b"LASF";

/// Whether a file is LAS, LAZ or COPC.
pub(super) fn is_lidar(path: &Path) -> bool {
    first_bytes(path).is_some_and(|head| head.starts_with(LIDAR))
}

/// What the first bytes and the extension say. What neither knows are points: text comes under any
/// name.
pub(super) fn content(path: &Path) -> Content {
    let head = first_bytes(path).unwrap_or_default();
    if head.starts_with(LIDAR) {
        return Content::Points;
    }
    if raster::is_tiff(&head) {
        return Content::Raster;
    }
    let file = layer::split(&path.to_string_lossy()).0;
    let extension = file.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    match extension.as_str() {
        "ply" | "obj" | "off" | "stl" | "ele" => Content::Mesh,
        "png" => Content::Picture,
        "node" | "poly" | "edge" | "neigh" => Content::Plane,
        "tif" | "tiff" | "vrt" | "img" | "hgt" | "dem" | "dt0" | "dt1" | "dt2" => Content::Raster,
        // Points as text, or a grid.
        "asc" if head.to_ascii_lowercase().starts_with(b"ncols") => Content::Raster,
        "shp" | "geojson" | "json" | "gpkg" | "fgb" | "kml" | "gml" | "dxf" => Content::Layer,
        _ => Content::Points,
    }
}

fn first_bytes(path: &Path) -> Option<Vec<u8>> {
    let file = std::fs::File::open(path).ok()?;
    // Reading from a pipe would take away what it holds.
    if !file.metadata().ok()?.is_file() {
        return None;
    }
    let mut head = Vec::new();
    file.take(16).read_to_end(&mut head).ok()?;
    Some(head)
}

/// Points of any format; of a vector layer, with the heights of an attribute where the name ends in
/// `:FIELD`.
pub(super) fn points(path: &Path, options: Options) -> Result<Box<dyn PointSource + Send>> {
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

/// Whether a file that is not read here may be one for GDAL.
fn gdal_may_help(error: &Error) -> bool {
    cfg!(feature = "gdal") && error.kind() == Kind::Unsupported
}

/// What a raster's header says, and its cells.
#[derive(Debug, Clone)]
pub(super) struct RasterFacts {
    /// "GeoTIFF, float32, 1 band, compression DEFLATE, tiles of 256 x 256"
    pub(super) format: String,
    /// "float32", unless the format says it
    pub(super) sample: Option<String>,
    pub(super) frame: Frame,
    pub(super) crs: Option<Crs>,
    /// Before scale and offset.
    pub(super) nodata: Option<f64>,
    pub(super) scale: f64,
    pub(super) offset: f64,
    pub(super) valid: u64,
    pub(super) range: Option<[f64; 2]>,
    pub(super) warnings: Vec<String>,
}

/// What a raster's header says, and what its cells say together; for GeoTIFF in bounded memory.
pub(super) fn raster_facts(path: &Path) -> Result<RasterFacts> {
    match Raster::open(path)? {
        Raster::GeoTiff(reader) => {
            let info = reader.info();
            let extremes = reader.extremes()?;
            Ok(RasterFacts {
                format: info.description(),
                sample: Some(info.sample.to_string()),
                frame: reader.frame(),
                crs: info.crs.clone(),
                nodata: info.nodata,
                scale: info.scale,
                offset: info.offset,
                valid: extremes.valid,
                range: extremes.range,
                warnings: info.warnings.clone(),
            })
        }
        Raster::Gdal(raster) => {
            let values = raster.read_grid()?.values;
            let valid = values.into_iter().filter(|value| !value.is_nan());
            let (count, range) = valid.fold((0, None), |(count, range): (u64, Option<[f64; 2]>), value| {
                let [low, high] = range.unwrap_or([value; 2]);
                (count + 1, Some([low.min(value), high.max(value)]))
            });
            Ok(RasterFacts {
                format: raster.description(),
                sample: None,
                frame: raster.frame(),
                crs: raster.crs().cloned(),
                nodata: None,
                scale: 1.0,
                offset: 0.0,
                valid: count,
                range,
                warnings: raster.warnings().to_vec(),
            })
        }
    }
}

/// A raster that is open.
enum Raster {
    GeoTiff(Box<GeoTiffReader>),
    Gdal(Box<gdal::Raster>),
}

impl Raster {
    fn open(path: &Path) -> Result<Self> {
        match raster::open(path) {
            Ok(reader) => Ok(Raster::GeoTiff(Box::new(reader))),
            Err(error) if gdal_may_help(&error) => gdal::open_raster(path).map(|raster| Raster::Gdal(Box::new(raster))),
            Err(error) => Err(error),
        }
    }
}

/// A raster, whole, and what is to be told about it.
pub(super) fn raster(path: &Path, talk: &Talk) -> Result<(Grid, Vec<String>)> {
    let _reading = talk.progress("reading cells", Size::Uncounted);
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

/// Where a raster is, without reading its cells.
pub(super) fn raster_place(path: &Path) -> Result<(Frame, Option<Crs>)> {
    match Raster::open(path)? {
        Raster::GeoTiff(reader) => Ok((reader.frame(), reader.info().crs.clone())),
        Raster::Gdal(raster) => Ok((raster.frame(), raster.crs().cloned())),
    }
}

/// A mesh that is a surface.
pub(super) fn mesh(path: &Path, talk: &Talk) -> Result<Mesh> {
    memory::require_for_mesh(path)?;
    let _reading = talk.progress("reading triangles", Size::Uncounted);
    mesh::read(path)
}

/// The triangles of a mesh, whether they are a surface or not, linked as far as they can be; and what is wrong with
/// them, one line each. Whether they are Delaunay is asked of formats that keep lines.
pub(super) fn mesh_with_flaws(path: &Path, talk: &Talk) -> Result<(Mesh, Vec<String>)> {
    let find = if keeps_lines(path) { terrain::surface_flaws } else { terrain::shape_flaws };
    let reading = talk.progress("reading triangles", Size::Uncounted);
    let triangles = mesh::read_triangles(path)?;
    drop(reading);
    flaws_by(find, triangles, talk).map_err(|e| e.in_file(path))
}

/// Whether a mesh of this name can tell which edges are constrained.
pub(super) fn keeps_lines(path: &Path) -> bool {
    mesh::Format::of(path).is_some_and(mesh::Format::keeps_lines)
}

/// The same, with only what is wrong with the links.
pub(super) fn linked_mesh(path: &Path) -> Result<(Mesh, Vec<LinkFlaw>)> {
    Mesh::link(mesh::read_triangles(path)?).map_err(|e| e.in_file(path))
}

/// The first that is wrong with triangles at hand.
pub(super) fn first_flaw(triangles: Triangles, talk: &Talk) -> Result<Option<String>> {
    Ok(flaws_by(terrain::surface_flaws, triangles, talk)?.1.into_iter().next())
}

fn flaws_by(
    find: fn(&dyn Surface) -> Vec<SurfaceFlaw>,
    triangles: Triangles,
    talk: &Talk,
) -> Result<(Mesh, Vec<String>)> {
    let (mesh, links) = Mesh::link(triangles)?;
    let mut texts: Vec<String> = links.iter().map(|flaw| located(flaw, &flaw.vertices(&mesh), &mesh)).collect();
    let watched = checked(&mesh, talk);
    texts.extend(flaws_beside(&links, &find(&watched), &watched));
    drop(watched);
    Ok((mesh, texts))
}

/// What an STL file holds; `None` if it is another mesh.
pub(super) fn solid(path: &Path) -> Option<Result<Solid>> {
    (mesh::Format::of(path) == Some(mesh::Format::Stl)).then(|| mesh::describe_stl(path))
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

/// Writes files of Triangle.
pub(super) fn write_triangulated(targets: &[Destination], triangulated: &Triangulated) -> Result<()> {
    triangle::write(targets, triangulated)
}

/// The triangles as a surface of height 0.
pub(super) fn flat_mesh(triangulated: &Triangulated) -> Result<Mesh> {
    let vertices = triangulated.nodes.points.iter().map(|&[x, y]| [x, y, 0.0]).collect();
    let edges: Vec<[u32; 2]> = triangulated.segments.iter().map(|edge| edge.ends).collect();
    let edges = if triangulated.triangles.is_empty() { &[] } else { edges.as_slice() };
    Mesh::new(vertices, triangulated.triangles.clone(), edges, None)
}

/// What takes coordinates from one system to the other; needs the feature `proj`.
pub(super) fn transform(from: &Crs, to: &Crs) -> Result<Box<dyn Transform>> {
    proj::transform(from, to)
}

/// Writes a mesh, format by extension.
pub(super) fn write_mesh(target: Destination, surface: &dyn Surface, talk: &Talk) -> Result<MeshSummary> {
    // Numbered, then listed.
    mesh::write(target, &Watched::faces(surface, 2, "writing faces", talk))
}

/// Heights of a surface at the centers of cells.
pub(super) fn dem<'a>(surface: &'a dyn Surface, frame: Frame) -> Result<Box<dyn BlockSource + 'a>> {
    Ok(Box::new(Dem::new(surface, frame)?))
}

/// What is wrong with a surface, one line each.
pub(super) fn flaws(surface: &dyn Surface, talk: &Talk) -> Vec<String> {
    let watched = checked(surface, talk);
    flaws_beside(&[], &terrain::surface_flaws(&watched), &watched)
}

/// The surface, for a check that asks for its faces once for each of five laws, and for overlaps.
fn checked<'a>(surface: &'a dyn Surface, talk: &Talk) -> Watched<'a, dyn Surface + 'a> {
    Watched::faces(surface, 6, "checking faces", talk)
}

/// What was found, and overlaps, where these can be told: of faces that are linked and turn the right way.
fn flaws_beside(links: &[LinkFlaw], found: &[SurfaceFlaw], surface: &dyn Surface) -> Vec<String> {
    let mut texts: Vec<String> = found.iter().map(|flaw| located(flaw, &flaw.vertices(surface), surface)).collect();
    let is_folded = links.iter().any(|flaw| matches!(flaw, LinkFlaw::Folded { .. }));
    if !is_folded && found.iter().all(|flaw| matches!(flaw, SurfaceFlaw::NotDelaunay(..))) {
        texts.extend(overlaps(surface).iter().map(|flaw| located(flaw, &flaw.vertices(surface), surface)));
    }
    texts
}

/// A flaw, and where in plan the vertices are at which it shows.
fn located(flaw: &impl Display, vertices: &[u32], surface: &dyn Surface) -> String {
    let places = vertices.iter().filter(|&&v| (v as usize) < surface.vertex_count()).map(|&v| surface.position(v));
    let places: Vec<String> = places.map(|[x, y, _]| format!("({x} {y})")).collect();
    if places.is_empty() { flaw.to_string() } else { format!("{flaw}, at {}", places.join(" ")) }
}

/// Writes heights as GeoTIFF.
pub(super) fn write_heights(target: Destination, source: &dyn BlockSource) -> Result<RasterSummary> {
    geotiff::write(target, source, WriteOptions { cells: CellFormat::Heights, progress: None })
}

/// The file formats of a hillshade.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ShadeFormat {
    GeoTiff,
    Png,
}

/// Writes brightness as a picture.
pub(super) fn write_shade(target: Destination, format: ShadeFormat, source: &dyn BlockSource) -> Result<()> {
    match format {
        ShadeFormat::GeoTiff => {
            geotiff::write(target, source, WriteOptions { cells: CellFormat::Shades, progress: None }).map(drop)
        }
        ShadeFormat::Png => png::write_gray(target, source),
    }
}

/// Draws contours straight from triangles and writes them as they come, format by extension.
pub(super) fn contours_of_surface(
    target: Destination,
    surface: &dyn Surface,
    levels: &Levels,
    talk: &Talk,
) -> Result<ContourSummary> {
    write_contours(target, surface, levels, talk)
}

/// Draws contours between the centers of cells.
pub(super) fn contours_of_grid(
    target: Destination,
    grid: &Grid,
    levels: &Levels,
    talk: &Talk,
) -> Result<ContourSummary> {
    write_contours(target, &GridSurface::new(grid)?, levels, talk)
}

fn write_contours<S: Surface + ?Sized>(
    target: Destination,
    surface: &S,
    levels: &Levels,
    talk: &Talk,
) -> Result<ContourSummary> {
    let looking = talk.progress("looking for contours", Size::Uncounted);
    let lines = terrain::contours(surface, levels)?;
    drop(looking);
    let count = lines.piece_count() as u64;
    contours::foresee(target, count)?;
    let drawing = talk.progress("drawing pieces of contours", Size::Items(count));
    let mut lines = lines.inspect(|line| drawing.add(line.points.len().saturating_sub(1) as u64));
    contours::write(target, &mut lines, surface.crs())
}
