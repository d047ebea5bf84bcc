//! What is in a file: counts, bounds, classes, coordinate system.

use std::collections::BTreeMap;
use std::path::Path;

use crate::crs::Crs;
use crate::data::{
    BlockSource, Bounds, Frame, Grid, LinkFlaw, PointBatch, PointFlags, PointInfo, Shape,
    ShapeKind, Surface, SurfaceFacts,
};
use crate::error::{Error, Result, Wording};
use crate::io::mesh::Solid;
use crate::io::png::Picture;
use crate::io::prj::{self, Prj};
use crate::io::{OnDamage, points};
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::sources::open::{self, Content, Raster};
use crate::run::sources::systems::quoted;
use crate::run::sources::tin_parts::TinParts;
use crate::terrain::CompactTin;

/// The contents of a file, by its kind.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Facts {
    /// Points.
    Points(Box<PointFacts>),
    /// A vector layer.
    Layer(Box<LayerFacts>),
    /// A raster of heights.
    Raster(Box<RasterFacts>),
    /// A mesh of triangles.
    Mesh(Box<MeshFacts>),
    /// An STL file: triangles without exact coordinates.
    Solid(Box<Solid>),
    /// A picture: it has shades but no heights.
    Picture(Box<Picture>),
    /// A file of Triangle without triangles.
    Plane(Box<PlaneFacts>),
}

/// Counts over all points of a file.
#[derive(Debug, Clone)]
pub struct PointFacts {
    /// The information in the header.
    pub info: PointInfo,
    /// Points in the file.
    pub count: u64,
    /// The box around these points.
    pub bounds: Bounds,
    /// Points with a coordinate that is not finite.
    pub not_finite: u64,
    /// Points of each class.
    pub classes: [u64; 256],
    /// Points of each return number.
    pub returns: [u64; 256],
    /// Points with each of the flags [`PointFlags::SYNTHETIC`], `KEY_POINT`, `WITHHELD` and
    /// `OVERLAP`.
    pub flags: [u64; 4],
    /// Warnings of the reader.
    pub warnings: Vec<Wording>,
}

/// Counts over all records of a vector layer.
#[derive(Debug, Clone, Default)]
pub struct LayerFacts {
    /// The name of the format, as the reader gives it.
    pub format: String,
    /// Records.
    pub records: usize,
    /// Records of each kind.
    pub kinds: BTreeMap<ShapeKind, u64>,
    /// Parts of lines, and rings of polygons.
    pub parts: usize,
    /// Vertices.
    pub vertices: u64,
    /// Vertices without a height.
    pub without_height: u64,
    /// The box around all vertices.
    pub bounds: Bounds,
    /// The coordinate system, if the file states one.
    pub crs: Option<Crs>,
    /// Names of the attributes.
    pub fields: Vec<String>,
    /// Warnings of the reader.
    pub warnings: Vec<Wording>,
}

/// The header of a raster, and counts over its cells.
#[derive(Debug, Clone)]
pub struct RasterFacts {
    /// The format, as the reader describes it: "GeoTIFF, float32, 1 band, compression DEFLATE,
    /// tiles of 256 x 256".
    pub format: String,
    /// The type of a cell, such as "float32", unless it is part of the format.
    pub sample: Option<String>,
    /// Size and position.
    pub frame: Frame,
    /// The coordinate system, if the file states one.
    pub crs: Option<Crs>,
    /// The nodata value, before scale and offset.
    pub nodata: Option<f64>,
    /// The factor for stored values.
    pub scale: f64,
    /// The number that is added after multiplying by the scale.
    pub offset: f64,
    /// Cells with a value.
    pub valid: u64,
    /// The smallest and the largest value.
    pub range: Option<[f64; 2]>,
    /// Warnings of the reader.
    pub warnings: Vec<Wording>,
}

/// Counts over all triangles of a mesh, or those that the file of a TIN states.
#[derive(Debug, Clone)]
pub struct MeshFacts {
    /// Counts and extent.
    pub surface: SurfaceFacts,
    /// The coordinate system, if the file states one.
    pub crs: Option<Crs>,
    /// The first flaw of its links, if it is not a surface.
    pub flaw: Option<LinkFlaw>,
}

/// The contents of a file of Triangle that has no triangles.
#[derive(Debug, Clone)]
pub enum PlaneFacts {
    /// An `.edge` file, with the number of its edges.
    Edges(usize),
    /// A `.neigh` file, with the number of its triangles.
    Neighbors(usize),
    /// A `.node` or a `.poly` file.
    Graph {
        /// Vertices.
        vertices: usize,
        /// Attributes of each vertex.
        attributes: usize,
        /// The box around the vertices, without heights.
        bounds: Bounds,
        /// Segments.
        segments: usize,
        /// Holes.
        holes: usize,
        /// Regions.
        regions: usize,
        /// Warnings of the reader.
        warnings: Vec<Wording>,
    },
}

/// Reads a file to its end and counts what is in it.
///
/// # Errors
/// If the file cannot be read, or the run is canceled.
pub fn facts(path: &Path, read: points::Options, context: &Context) -> Result<Facts> {
    let facts = match open::content(path) {
        Content::Points => Facts::Points(Box::new(point_facts(path, read, context)?)),
        Content::Layer => Facts::Layer(Box::new(layer_facts(path, read.cut, context)?)),
        Content::Raster => Facts::Raster(Box::new(raster_facts(path, context)?)),
        Content::Mesh => match open::solid(path) {
            Some(solid) => Facts::Solid(Box::new(solid?)),
            None => Facts::Mesh(Box::new(if let Some(tin) = open::tin(path) {
                tin_facts(&tin?)
            } else if let Some(parts) = open::tin_parts(path) {
                parts_facts(&parts?)
            } else {
                mesh_facts(path, context)?
            })),
        },
        Content::Picture => Facts::Picture(Box::new(open::picture(path)?)),
        Content::Plane => Facts::Plane(Box::new(plane_facts(path, context)?)),
    };
    context.check()?;
    Ok(facts)
}

impl Facts {
    /// Returns the coordinate system that the file states.
    pub fn crs(&self) -> Option<&Crs> {
        match self {
            Facts::Points(facts) => facts.info.crs.as_ref(),
            Facts::Layer(facts) => facts.crs.as_ref(),
            Facts::Raster(facts) => facts.crs.as_ref(),
            Facts::Mesh(facts) => facts.crs.as_ref(),
            Facts::Solid(_) | Facts::Picture(_) | Facts::Plane(_) => None,
        }
    }
}

/// Returns the coordinate system of a file: of WKT (`.prj`, `.wkt`), or the one that a file of any
/// other kind states. Of points only the header is read.
///
/// # Errors
/// If the file cannot be read, or states no system that is understood.
pub fn crs_of_file(path: &Path, context: &Context) -> Result<Crs> {
    let is_wkt = path.extension().is_some_and(|extension| {
        ["prj", "wkt"]
            .iter()
            .any(|known| extension.eq_ignore_ascii_case(known))
    });
    let none = |unread: Option<String>| {
        let text = match unread {
            Some(text) => format!(
                "a coordinate system that is not understood: {}",
                quoted(&text)
            ),
            None => "the file states no coordinate system".to_owned(),
        };
        Error::unsupported(text).in_file(path)
    };
    let (crs, unread) = if is_wkt {
        match prj::read(path)? {
            Prj::Stated(crs) => (crs, None),
            Prj::Unread(_, error) => return Err(error.in_file(path)),
        }
    } else if let Content::Points = open::content(path) {
        let source = open::points_of_file(path, points::Options::default(), context)?;
        (source.info().crs.clone(), source.info().unread_crs.clone())
    } else {
        let facts = facts(path, points::Options::default(), context)?;
        (facts.crs().cloned(), None)
    };
    crs.ok_or_else(|| none(unread))
}

/// The flags that are counted, in order.
const FLAGS: [u8; 4] = [
    PointFlags::SYNTHETIC,
    PointFlags::KEY_POINT,
    PointFlags::WITHHELD,
    PointFlags::OVERLAP,
];

fn point_facts(path: &Path, read: points::Options, context: &Context) -> Result<PointFacts> {
    let mut source = open::points_of_file(path, read, context)?;
    let mut facts = PointFacts {
        info: source.info().clone(),
        count: 0,
        bounds: Bounds::default(),
        not_finite: 0,
        classes: [0; 256],
        returns: [0; 256],
        flags: [0; FLAGS.len()],
        warnings: Vec::new(),
    };
    let work = context.start(
        Stage::ReadingPoints,
        facts.info.count.map_or(Size::Unknown, Size::Items),
    )?;
    let mut batch = PointBatch::default();
    loop {
        source.read(&mut batch)?;
        if batch.is_empty() {
            break;
        }
        facts.add(&batch);
        work.add(batch.len() as u64)?;
    }
    facts.warnings = source.warnings().to_vec();
    Ok(facts)
}

impl PointFacts {
    fn add(&mut self, batch: &PointBatch) {
        self.count += batch.len() as u64;
        for ((&x, &y), &z) in batch.x.iter().zip(&batch.y).zip(&batch.z) {
            self.bounds.add([x, y, z]);
            self.not_finite += u64::from(!(x.is_finite() && y.is_finite() && z.is_finite()));
        }
        batch
            .class
            .iter()
            .for_each(|&class| self.classes[usize::from(class)] += 1);
        batch
            .return_number
            .iter()
            .for_each(|&number| self.returns[usize::from(number)] += 1);
        for flags in &batch.flags {
            for (count, bit) in self.flags.iter_mut().zip(FLAGS) {
                *count += u64::from(flags.0 & bit != 0);
            }
        }
    }
}

fn layer_facts(path: &Path, cut: OnDamage, context: &Context) -> Result<LayerFacts> {
    let layer = open::layer(path, &[], cut, context)?;
    let mut facts = LayerFacts {
        records: layer.shapes.len(),
        ..LayerFacts::default()
    };
    for shape in &layer.shapes {
        *facts.kinds.entry(shape.kind()).or_default() += 1;
        facts.parts += match shape {
            Shape::Lines(parts) | Shape::Polygon(parts) => parts.len(),
            Shape::Null | Shape::Points(_) | Shape::Faces(_) => 0,
        };
        for &vertex in shape.vertices() {
            facts.vertices += 1;
            facts.without_height += u64::from(vertex[2].is_nan());
            facts.bounds.add(vertex);
        }
    }
    (facts.format, facts.crs, facts.fields, facts.warnings) =
        (layer.format, layer.crs, layer.fields, layer.warnings);
    Ok(facts)
}

/// For GeoTIFF in bounded memory.
fn raster_facts(path: &Path, context: &Context) -> Result<RasterFacts> {
    let raster = Raster::open(path)?;
    let work = context.start(Stage::ReadingCells, Size::Items(raster.cells()))?;
    let watch = |cells| work.add(cells);
    match raster {
        Raster::GeoTiff(reader) => {
            let info = reader.info();
            let extremes = reader.extremes_with(&watch)?;
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
        Raster::Text(grid) => {
            let (cells, of_text) = grid.read_grid_with(&watch)?;
            let (valid, range) = valid_of(&cells);
            Ok(RasterFacts {
                format: "ESRI ASCII grid".to_owned(),
                sample: None,
                frame: grid.frame(),
                crs: grid.crs().cloned(),
                nodata: Some(grid.nodata()),
                scale: 1.0,
                offset: 0.0,
                valid,
                range,
                warnings: [grid.warnings(), &of_text].concat(),
            })
        }
        Raster::Gdal(raster) => {
            let (valid, range) = valid_of(&raster.read_grid_with(&watch)?);
            Ok(RasterFacts {
                format: raster.description(),
                sample: None,
                frame: raster.frame(),
                crs: raster.crs().cloned(),
                nodata: None,
                scale: 1.0,
                offset: 0.0,
                valid,
                range,
                warnings: raster.warnings().to_vec(),
            })
        }
    }
}

/// Returns the number of cells with a value, and the lowest and the highest.
fn valid_of(grid: &Grid) -> (u64, Option<[f64; 2]>) {
    let valid = grid.values.iter().filter(|value| !value.is_nan());
    valid.fold(
        (0, None),
        |(count, range): (u64, Option<[f64; 2]>), &value| {
            let [low, high] = range.unwrap_or([value; 2]);
            (count + 1, Some([low.min(value), high.max(value)]))
        },
    )
}

fn mesh_facts(path: &Path, context: &Context) -> Result<MeshFacts> {
    let (mesh, flaws) = open::linked_mesh(path, &Journal::new(context))?;
    Ok(MeshFacts {
        surface: SurfaceFacts::of(&mesh),
        crs: mesh.crs().cloned(),
        flaw: flaws.first().copied(),
    })
}

fn tin_facts<S: AsRef<[u8]> + Sync>(tin: &CompactTin<S>) -> MeshFacts {
    MeshFacts {
        surface: tin.facts().clone(),
        crs: tin.crs().cloned(),
        flaw: None,
    }
}

fn parts_facts(parts: &TinParts) -> MeshFacts {
    MeshFacts {
        surface: parts.facts().clone(),
        crs: parts.crs().cloned(),
        flaw: None,
    }
}

fn plane_facts(path: &Path, context: &Context) -> Result<PlaneFacts> {
    let extension = path
        .extension()
        .unwrap_or_default()
        .to_string_lossy()
        .to_ascii_lowercase();
    Ok(match extension.as_str() {
        "edge" => PlaneFacts::Edges(open::listed(path)?),
        "neigh" => PlaneFacts::Neighbors(open::listed(path)?),
        _ => {
            let graph = open::line_graph(path, context)?;
            let mut bounds = Bounds::default();
            graph
                .nodes
                .points
                .iter()
                .for_each(|&[x, y]| bounds.add([x, y, f64::NAN]));
            PlaneFacts::Graph {
                vertices: graph.nodes.points.len(),
                attributes: graph.nodes.attribute_count,
                bounds,
                segments: graph.segments.len(),
                holes: graph.holes.len(),
                regions: graph.regions.len(),
                warnings: graph.warnings,
            }
        }
    })
}
