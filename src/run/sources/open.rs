//! Opening files of any kind, by their first bytes and extension.

use std::borrow::Cow;
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

use super::raster_file::RasterFile;
use super::tin_parts::TinParts;
use crate::crs::Crs;
use crate::data::{
    BlockSource, Frame, Grid, Layer, LinkFlaw, Mesh, PointInfo, PointSource, Shape, Triangles,
};
use crate::error::{Error, Kind, Result};
use crate::io::Temporary;
use crate::io::ascii_grid::AsciiGrid;
pub(crate) use crate::io::formats::Content;
use crate::io::formats::{self, Format, Holding};
use crate::io::geotiff::GeoTiffReader;
use crate::io::las;
use crate::io::mapped::Mapped;
pub(crate) use crate::io::mesh::keeps_lines;
use crate::io::mesh::{self, Solid};
use crate::io::png::{self, Picture};
use crate::io::points::Options;
use crate::io::triangle::{self, LineGraph};
use crate::io::{OnDamage, Watch, gdal, layer, points, raster};
use crate::run::context::memory;
use crate::run::context::notice::Notice;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::request::input::{Input, MemoryPoints, MemorySource};
use crate::terrain::CompactTin;

/// Returns true if a file is LAS, LAZ or COPC.
pub(crate) fn is_lidar(path: &Path) -> bool {
    !gdal::is_name(path) && format(path).is_some_and(|format| format.can_hold(Holding::Attributes))
}

/// Returns the content that the first bytes and the extension indicate. If neither is known, it is
/// points: text can have any name.
pub(crate) fn content(path: &Path) -> Content {
    if gdal::is_name(path) {
        return content_for_gdal(path);
    }
    format(path).map_or(Content::Points, |format| format.content)
}

/// Returns the content of a data set that only GDAL can open.
fn content_for_gdal(name: &Path) -> Content {
    let text = name.to_string_lossy();
    let file = layer::file_of(&text);
    match formats::of_name(file).map(|format| format.content) {
        Some(content @ (Content::Layer | Content::Raster)) => content,
        _ if gdal::holds_layers(file) || gdal::open_raster(file).is_err() => Content::Layer,
        _ => Content::Raster,
    }
}

fn format(path: &Path) -> Option<&'static Format> {
    let text = path.to_string_lossy();
    let file = layer::file_of(&text);
    // A file that does not exist yet is known by its name.
    formats::detect_file(file).unwrap_or_else(|_| formats::of_name(file))
}

/// Opens points, in memory or in a file of any format.
pub(crate) fn points(
    input: &Input<MemoryPoints>,
    options: Options,
    context: &Context,
) -> Result<Box<dyn PointSource + Send>> {
    match input {
        Input::File(path) => points_of_file(path, options, context),
        Input::Memory(points) => Ok(Box::new(MemorySource::new(Arc::clone(points))?)),
    }
}

/// Opens points of any format; of a vector file, the layer and the attribute with the heights may
/// be named, see [`layer::Spec`].
pub(crate) fn points_of_file(
    path: &Path,
    options: Options,
    context: &Context,
) -> Result<Box<dyn PointSource + Send>> {
    let of_layer = || -> Result<Box<dyn PointSource + Send>> {
        Ok(Box::new(points::from_layer(layer(
            path,
            &[],
            options.cut,
            context,
        )?)?))
    };
    match content(path) {
        Content::Layer => of_layer(),
        Content::Points | Content::Raster | Content::Mesh | Content::Picture | Content::Plane => {
            points::open_with(path, options).or_else(|error| match gdal_may_help(&error) {
                // If GDAL does not know the file either, its error is less exact.
                true => of_layer().map_err(|e| if e.kind() == Kind::Canceled { e } else { error }),
                false => Err(error),
            })
        }
    }
}

/// Returns true if a file is a vector layer of lines alone. Such a file is read for that; if it
/// cannot be read, what uses it will say why.
pub fn is_of_lines(path: &Path) -> bool {
    let read = || layer(path, &[], OnDamage::Refuse, &Context::default());
    content(path) == Content::Layer
        && may_have_lines(path)
        && read().is_ok_and(|layer| {
            let mut shapes = layer
                .shapes
                .iter()
                .filter(|shape| !matches!(shape, Shape::Null))
                .peekable();
            shapes.peek().is_some() && shapes.all(|shape| matches!(shape, Shape::Lines(_)))
        })
}

/// Returns false if a file is text whose beginning has no line. `PERF:` so points as GeoJSON are
/// read once.
fn may_have_lines(path: &Path) -> bool {
    const BEGINNING: u64 = 1 << 16;
    if gdal::is_name(path) {
        return true;
    }
    let name = path.to_string_lossy();
    let mut head = Vec::new();
    let read = File::open(layer::file_of(&name))
        .and_then(|file| file.take(BEGINNING).read_to_end(&mut head));
    let is_text = head.first() == Some(&b'{');
    let word = b"LineString";
    read.is_ok() && (!is_text || head.windows(word.len()).any(|bytes| bytes == word))
}

/// Returns what the header of a file of points states that cannot be opened; `None` if it has none
/// that can be read.
pub(crate) fn stated(path: &Path) -> Option<PointInfo> {
    if is_lidar(path) {
        las::stated(path).ok()
    } else {
        None
    }
}

/// Returns a vector layer, from memory or from a file, with these columns: [`Layer::column`] finds
/// each, and it has a number for each shape.
pub(crate) fn layer_of<'a>(
    input: &'a Input<Layer>,
    columns: &[&str],
    cut: OnDamage,
    context: &Context,
) -> Result<Cow<'a, Layer>> {
    match input {
        Input::File(path) => layer(path, columns, cut, context).map(Cow::Owned),
        Input::Memory(layer) => {
            columns
                .iter()
                .try_for_each(|name| check_column(layer, name))?;
            Ok(Cow::Borrowed(layer))
        }
    }
}

/// Returns an error unless a layer in memory has a number for each shape in this column.
fn check_column(layer: &Layer, name: &str) -> Result<()> {
    let shapes = layer.shapes.len();
    match layer.column(name).map(|column| column.values.len()) {
        Some(count) if count == shapes => Ok(()),
        Some(count) => Err(Error::usage(format!(
            "column {name} has {count} values for {shapes} records"
        ))),
        None => {
            let names: Vec<&str> = layer
                .columns
                .iter()
                .map(|column| column.name.as_str())
                .collect();
            Err(
                Error::usage(format!("there is no column {name}")).cure(match names[..] {
                    [] => "add it to the columns of the layer, which has none".to_owned(),
                    _ => format!(
                        "add it to the columns of the layer, which has {}",
                        names.join(", ")
                    ),
                }),
            )
        }
    }
}

/// Reads a vector layer, named as in [`layer::Spec`]. It has these columns, in this order.
pub(crate) fn layer(
    path: &Path,
    columns: &[&str],
    cut: OnDamage,
    context: &Context,
) -> Result<Layer> {
    let spec = spec(path)?;
    read_layer(&spec.path, &spec.options(columns, cut), context)
}

/// Reads a vector layer with all its attributes, as far as the reader keeps them.
pub(crate) fn whole_layer(path: &Path, cut: OnDamage, context: &Context) -> Result<Layer> {
    let spec = spec(path)?;
    let options = layer::Options {
        keeps_attributes: true,
        ..spec.options(&[], cut)
    };
    read_layer(&spec.path, &options, context)
}

fn spec(path: &Path) -> Result<layer::Spec> {
    match path.to_str() {
        Some(text) => layer::Spec::parse(text),
        None => Err(Error::unsupported("the name is not valid Unicode").in_file(path)),
    }
}

fn read_layer(path: &Path, options: &layer::Options, context: &Context) -> Result<Layer> {
    let work = context.start(Stage::ReadingLayer, size(path))?;
    let watch = |bytes| work.add(bytes);
    if gdal::is_name(path) {
        return gdal::read_layer_with(path, options, &watch);
    }
    layer::read_with(path, options, &watch).or_else(|error| match gdal_may_help(&error) {
        true => gdal::read_layer_with(path, options, &watch),
        false => Err(error),
    })
}

/// Returns the number of bytes of a file as the size of a stage.
fn size(path: &Path) -> Size {
    std::fs::metadata(path).map_or(Size::Unknown, |data| Size::Items(data.len()))
}

/// Returns true if GDAL may be able to read a file that this crate cannot.
fn gdal_may_help(error: &Error) -> bool {
    cfg!(feature = "gdal") && error.kind() == Kind::Unsupported
}

/// An open raster.
pub(crate) enum Raster {
    GeoTiff(Box<GeoTiffReader>),
    Text(Box<AsciiGrid>),
    Gdal(Box<gdal::Raster>),
}

impl Raster {
    pub(crate) fn open(path: &Path) -> Result<Self> {
        let by_gdal = || gdal::open_raster(path).map(|raster| Raster::Gdal(Box::new(raster)));
        if gdal::is_name(path) {
            return by_gdal();
        }
        if let Some(grid) = raster::open_grid(path) {
            return grid.map(|grid| Raster::Text(Box::new(grid)));
        }
        match raster::open(path) {
            Ok(reader) => Ok(Raster::GeoTiff(Box::new(reader))),
            Err(error) if gdal_may_help(&error) => by_gdal(),
            Err(error) => Err(error),
        }
    }

    /// Returns the number of cells.
    pub(crate) fn cells(&self) -> u64 {
        let Frame { width, height, .. } = match self {
            Raster::GeoTiff(reader) => reader.frame(),
            Raster::Text(grid) => grid.frame(),
            Raster::Gdal(raster) => raster.frame(),
        };
        width as u64 * height as u64
    }
}

/// A GeoTIFF with more cells stays in its file: 128 MB of heights.
const MOST_CELLS_IN_MEMORY: u64 = 1 << 24;

/// A raster that was read once.
pub(crate) enum OpenRaster {
    Memory(Box<Grid>),
    File(Box<RasterFile>),
}

/// Reads a raster, and reports the warnings of its reader.
pub(crate) fn raster(path: &Path, journal: &Journal) -> Result<OpenRaster> {
    let raster = Raster::open(path)?;
    let cells = raster.cells();
    if let Raster::GeoTiff(reader) = &raster
        && reader.info().bands > 1
    {
        journal.add(Notice::FirstOfBands(
            path.to_path_buf(),
            reader.info().bands,
        ));
    }
    let raster = match raster {
        Raster::GeoTiff(reader) if cells > MOST_CELLS_IN_MEMORY => {
            let warnings = reader.info().warnings.clone();
            let work = journal.start(Stage::ReadingCells, Size::Items(cells))?;
            let raster = RasterFile::new(*reader, &|cells| work.add(cells))?;
            journal.add_warnings(path, &warnings);
            return Ok(OpenRaster::File(Box::new(raster)));
        }
        raster => raster,
    };
    memory::require_for_cells(cells).map_err(|e| e.in_file(path))?;
    let work = journal.start(Stage::ReadingCells, Size::Items(cells))?;
    let watch = |cells| work.add(cells);
    let (grid, warnings) = match raster {
        Raster::GeoTiff(reader) => (
            reader.read_grid_with(&watch)?,
            reader.info().warnings.clone(),
        ),
        Raster::Text(grid) => {
            let (cells, of_text) = grid.read_grid_with(&watch)?;
            (cells, [grid.warnings(), &of_text].concat())
        }
        Raster::Gdal(raster) => (raster.read_grid_with(&watch)?, raster.warnings().to_vec()),
    };
    journal.add_warnings(path, &warnings);
    Ok(OpenRaster::Memory(Box::new(grid)))
}

/// The frame of a raster, and the coordinate system that it states.
pub(crate) struct RasterFrame {
    pub(crate) frame: Frame,
    pub(crate) crs: Option<Crs>,
    /// What is stated, if it is not understood.
    pub(crate) unread_crs: Option<String>,
}

/// Returns the frame of a raster and its coordinate system, without reading cells.
pub(crate) fn raster_frame(path: &Path) -> Result<RasterFrame> {
    Ok(match Raster::open(path)? {
        Raster::GeoTiff(reader) => {
            let (frame, info) = (reader.frame(), reader.info());
            RasterFrame {
                frame,
                crs: info.crs.clone(),
                unread_crs: info.unread_crs.clone(),
            }
        }
        Raster::Text(grid) => RasterFrame {
            frame: grid.frame(),
            crs: grid.crs().cloned(),
            unread_crs: None,
        },
        Raster::Gdal(raster) => RasterFrame {
            frame: raster.frame(),
            crs: raster.crs().cloned(),
            unread_crs: None,
        },
    })
}

/// Reads a mesh; an error if it is not a surface.
pub(crate) fn mesh(path: &Path, journal: &Journal) -> Result<Mesh> {
    memory::require_for_mesh(path)?;
    let triangles = mesh_triangles(path, journal)?;
    Mesh::of(triangles).map_err(|e| e.in_file(path))
}

/// Reads vertices, cells or their values under watch.
pub(crate) fn reading_stage<T>(
    path: &Path,
    context: &Context,
    read: impl FnOnce(Watch) -> Result<T>,
) -> Result<T> {
    reading(Stage::Reading, path, context, read)
}

/// Reads a file under watch, as a stage that is counted in bytes.
fn reading<T>(
    stage: Stage,
    path: &Path,
    context: &Context,
    read: impl FnOnce(Watch) -> Result<T>,
) -> Result<T> {
    let work = context.start(stage, size(path))?;
    let found = read(&|bytes| work.add(bytes))?;
    work.end()?;
    Ok(found)
}

/// Returns true if a file is a TIN, or the index of one in parts.
pub(crate) fn is_tin(path: &Path) -> bool {
    mesh::is_tin(path)
}

/// Opens a TIN where its bytes are; `None` if the file has a different format.
pub(crate) fn tin(path: &Path) -> Option<Result<CompactTin<Mapped>>> {
    mesh::map_tin(path).map(|mapped| CompactTin::open(mapped?, path))
}

/// Opens a TIN in parts; `None` if the file is not the index of one.
pub(crate) fn tin_parts(path: &Path) -> Option<Result<TinParts>> {
    mesh::read_tin_index(path).map(|text| TinParts::open(path, &text?))
}

/// Opens a TIN in parts whose files are in a folder that is removed with it.
pub(crate) fn owned_parts(index: &Path, folder: Temporary) -> Result<TinParts> {
    let not_there =
        || Error::other_job("the surface was removed by another process").in_file(index);
    let mut parts = tin_parts(index).ok_or_else(not_there)??;
    parts.own(folder);
    Ok(parts)
}

/// Reads a mesh that may not be a surface: its triangles, linked where possible, and the flaws of
/// the links.
pub(crate) fn linked_mesh(path: &Path, journal: &Journal) -> Result<(Mesh, Vec<LinkFlaw>)> {
    Mesh::link(mesh_triangles(path, journal)?).map_err(|e| e.in_file(path))
}

/// Reads an STL file; `None` if the mesh has a different format.
pub(crate) fn solid(path: &Path) -> Option<Result<Solid>> {
    mesh::describe_solid(path)
}

/// Reads the format and the position of a picture.
pub(crate) fn picture(path: &Path) -> Result<Picture> {
    png::describe(path)
}

/// Returns the number of edges or of neighborhoods in a file of Triangle.
pub(crate) fn listed(path: &Path) -> Result<usize> {
    triangle::count(path)
}

/// Reads a `.node` or a `.poly` file.
pub(crate) fn line_graph(path: &Path, context: &Context) -> Result<LineGraph> {
    reading(Stage::Reading, path, context, |watch| {
        triangle::read_with(path, watch)
    })
}

/// Reads the vertices of a mesh, or of a cloud in the format of a mesh.
pub(crate) fn mesh_vertices(path: &Path, journal: &Journal) -> Result<Vec<[f64; 3]>> {
    let read = |watch: Watch| mesh::read_vertices(path, watch);
    let (vertices, warnings) = reading(Stage::ReadingTriangles, path, &journal.context, read)?;
    journal.add_warnings(path, &warnings);
    Ok(vertices)
}

/// Reads the triangles of a mesh, in the order of the file.
pub(crate) fn mesh_triangles(path: &Path, journal: &Journal) -> Result<Triangles> {
    let read = |watch: Watch| mesh::read_triangles_with(path, watch);
    let triangles = reading(Stage::ReadingTriangles, path, &journal.context, read)?;
    journal.add_warnings(path, &triangles.warnings);
    Ok(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Column, Shape};

    #[test]
    fn columns_of_a_layer_in_memory_are_checked() {
        let columns = vec![
            Column {
                name: "Width".to_owned(),
                values: vec![1.0, f64::NAN],
            },
            Column {
                name: "LEFT".to_owned(),
                values: vec![2.0],
            },
        ];
        let shapes = vec![Shape::Null, Shape::Null];
        let input = Input::Memory(Arc::new(Layer {
            shapes,
            columns,
            ..Layer::default()
        }));
        let open =
            |columns: &[&str]| layer_of(&input, columns, OnDamage::Refuse, &Context::default());
        assert_eq!(
            open(&["WIDTH"]).unwrap().column("WIDTH").unwrap().values[0],
            1.0
        );
        let error = open(&["Width", "right"]).unwrap_err();
        assert_eq!(error.to_string(), "there is no column right");
        assert!(
            error
                .cure_text()
                .unwrap()
                .plain()
                .ends_with("which has Width, LEFT")
        );
        assert_eq!(
            open(&["left"]).unwrap_err().to_string(),
            "column left has 1 values for 2 records"
        );
    }
}
