//! Triangulation of points in space.

mod check;

use std::path::{Path, PathBuf};

pub use check::{SpaceCheck, SpaceFlaw, SpaceLaw, check_space};

use super::triangulate::Arithmetic;
use crate::crs::{Crs, CrsKind};
use crate::data::{Columns, EdgeKind, PointBatch, PointSource, Surface};
use crate::error::{Error, Result, Setting, wording};
use crate::io::points::Options;
use crate::io::tetgen::{self, FACETS, Tetrahedralized};
use crate::io::triangle::Nodes;
use crate::io::{Destination, Watch};
use crate::run::context::memory;
use crate::run::context::notice::Notice;
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::sources::open;
use crate::triangulation::geometry::{Geometry, Space, WeightedSpace};
use crate::triangulation::kernel::{Adaptive, Exact, Kernel, Orientation3, Predicate, Wide};
use crate::triangulation::tds::VertexId;
use crate::triangulation::{AlphaShapes, Delaunay, InputError, Regular, Triangulation};

/// Options of triangulating points in space. By default the triangulation is Delaunay, and no alpha
/// shape is computed.
#[derive(Debug, Clone, Default)]
pub struct SpaceOptions {
    /// True if points have weights, and the triangulation is regular: those of the `.weights` next
    /// to the file (one number a line), else the first attribute of a `.node`, or the column of a
    /// text after the coordinates. They become the first attribute of the vertices.
    pub weighted: bool,
    /// The alpha shape to compute, if any.
    pub alpha: Option<Alpha>,
    /// The arithmetic of the predicates; [`Fast`](Arithmetic::Fast) is refused.
    pub arithmetic: Arithmetic,
}

/// Which alpha shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Alpha {
    /// The alpha shape of this squared radius.
    Given(f64),
    /// The smallest that is one solid and contains all points that are in a tetrahedron.
    OneSolid,
}

/// A triangulation of points in space.
#[derive(Debug)]
#[non_exhaustive]
pub struct SpaceProduct {
    /// Vertices and tetrahedra.
    pub triangulated: Tetrahedralized,
    /// The alpha shape, if one was requested and there are tetrahedra.
    pub solid: Option<AlphaSolid>,
    /// Counts of the input and of the result.
    pub report: SpaceReport,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// Counts of a triangulation in space.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SpaceReport {
    /// Points of the input.
    pub points: usize,
    /// Points at the position of another one, which are in no tetrahedron.
    pub duplicates: usize,
    /// Points in no tetrahedron because of their weights.
    pub hidden: usize,
    /// The dimension of the points: -1 if there are none, 0 for one position, 1 on a line, 2 in a
    /// plane.
    pub dimension: i32,
    /// The volume of all tetrahedra: that of the convex hull.
    pub volume: f64,
    /// True if points have classes; all were used.
    pub has_classes: bool,
    /// True if two of the three coordinates are in degrees: then radii and volumes have no unit.
    pub is_in_degrees: bool,
}

/// The surface of an alpha shape, as a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct AlphaSolid {
    /// All points of the input.
    pub points: Vec<[f64; 3]>,
    /// The facets, counter-clockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The squared radius.
    pub alpha: f64,
    /// The number of parts that share no facet.
    pub parts: usize,
    /// The volume within the surface.
    pub volume: f64,
    /// Edges that more than two facets share.
    pub singular_edges: usize,
    /// Vertices at which parts of the surface touch that share no edge there.
    pub singular_vertices: usize,
}

impl AlphaSolid {
    /// Returns true if the surface is a closed manifold.
    pub fn is_manifold(&self) -> bool {
        self.singular_edges == 0 && self.singular_vertices == 0
    }
}

/// Without links between faces: they are not unique at singular edges, and no mesh format has them.
impl Surface for AlphaSolid {
    fn vertex_count(&self) -> usize {
        self.points.len()
    }

    fn position(&self, vertex: u32) -> [f64; 3] {
        self.points[vertex as usize]
    }

    fn face_count(&self) -> usize {
        self.triangles.len()
    }

    fn face(&self, face: u32) -> Option<[u32; 3]> {
        self.triangles.get(face as usize).copied()
    }

    fn neighbor(&self, _: u32, _: usize) -> Option<u32> {
        None
    }

    fn edge_kind(&self, _: u32, _: usize) -> EdgeKind {
        EdgeKind::Rim
    }

    fn has_lines(&self) -> bool {
        false
    }

    fn crs(&self) -> Option<&Crs> {
        None
    }
}

/// Returns true if a file is a `.node` of dimension 3, or an `.ele` next to one. A `.node` that
/// does not begin with a count is not.
pub fn is_of_space(path: &Path) -> bool {
    let has = |extension: &str| {
        path.extension()
            .is_some_and(|e| e.eq_ignore_ascii_case(extension))
    };
    let nodes = match (has("node"), has("ele")) {
        (true, _) => path.to_path_buf(),
        (_, true) => path.with_extension("node"),
        _ => return false,
    };
    nodes.is_file() && tetgen::dimension(&nodes).is_ok_and(|dimension| dimension == 3)
}

/// Triangulates the points of a file in space: a `.node` of dimension 3, points of any format, or
/// the vertices of a mesh.
///
/// # Errors
/// If the file cannot be read, weights are missing, there is not enough memory, or the run is
/// canceled.
pub fn triangulate_space(
    path: &Path,
    options: &SpaceOptions,
    context: &Context,
) -> Result<SpaceProduct> {
    if options.arithmetic == Arithmetic::Fast {
        return Err(Error::usage("plain floating point is for the plane only")
            .cure(wording!["leave out ", Setting::Kernel.text("fast")]));
    }
    let journal = Journal::new(context);
    let Cloud {
        mut nodes,
        has_classes,
        is_in_degrees,
        weight_column,
    } = read(path, &journal)?;
    let weights = match (options.weighted, weight_column) {
        (false, _) => None,
        (true, Some(columns)) if !weights_beside(path).exists() => {
            Some(column_of_weights(path, columns, &journal)?)
        }
        (true, _) => Some(weights(path, &nodes, &journal)?),
    };
    memory::require_for_space(nodes.points.len()).map_err(|e| e.in_file(path))?;
    let triangulating = context.start(Stage::Triangulating, Size::Uncounted)?;
    let built = build(&nodes.points, weights.as_deref(), options)
        .map_err(|e| explained(&e, &nodes, path))?;
    triangulating.end()?;
    let Built {
        tetrahedra,
        neighbors,
        solid,
        duplicates,
        hidden,
        dimension,
    } = built;
    let mut triangulated = Tetrahedralized {
        nodes: Nodes::default(),
        tetrahedra,
        neighbors,
    };
    let hull: Vec<[u32; 3]> = triangulated.hull().collect();
    for vertex in hull.into_iter().flatten() {
        let marker = &mut nodes.markers[vertex as usize];
        *marker = if *marker == 0 { 1 } else { *marker };
    }
    if let Some(weights) =
        weights.filter(|_| nodes.attribute_count == 0 || weights_beside(path).exists())
    {
        put_first(&mut nodes, &weights);
    }
    triangulated.nodes = nodes;
    let points = &triangulated.nodes.points;
    let six = triangulated.tetrahedra.iter().fold(0.0, |sum, corners| {
        sum + six_volumes(corners.map(|v| points[v as usize]))
    });
    let report = SpaceReport {
        points: points.len(),
        duplicates,
        hidden,
        dimension,
        volume: six / 6.0,
        has_classes,
        is_in_degrees,
    };
    Ok(SpaceProduct {
        triangulated,
        solid,
        report,
        notices: journal.take(),
    })
}

impl SpaceProduct {
    /// Writes files of the triangulation, each in the format of its extension.
    ///
    /// # Errors
    /// If one cannot be written, or the run is canceled.
    pub fn write(&self, targets: &[Destination], context: &Context) -> Result<()> {
        let writing = context.start(Stage::Writing, Size::Uncounted)?;
        tetgen::write(targets, &self.triangulated)?;
        writing.end()
    }
}

/// Returns six times the volume of a tetrahedron.
fn six_volumes(corners: [[f64; 3]; 4]) -> f64 {
    Orientation3(corners).value(|x, y| x - y)
}

/// Points that were read.
#[derive(Default)]
struct Cloud {
    nodes: Nodes<3>,
    has_classes: bool,
    is_in_degrees: bool,
    /// The columns of a text file; as z, the one after the coordinates, which may hold weights.
    weight_column: Option<Columns>,
}

impl Cloud {
    fn of(points: Vec<[f64; 3]>) -> Self {
        Cloud {
            nodes: Nodes {
                markers: vec![0; points.len()],
                points,
                ..Nodes::default()
            },
            ..Cloud::default()
        }
    }
}

fn read(path: &Path, journal: &Journal) -> Result<Cloud> {
    if path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("node"))
    {
        let (nodes, warnings) = open::reading_stage(path, &journal.context, |watch: Watch| {
            tetgen::read_nodes(path, watch)
        })?;
        journal.add_warnings(path, &warnings);
        return Ok(Cloud {
            nodes,
            ..Cloud::default()
        });
    }
    if open::content(path) == open::Content::Mesh {
        return open::mesh_vertices(path, journal).map(Cloud::of);
    }
    let source = open::points_of_file(path, Options::default(), &journal.context)?;
    let info = source.info();
    let is_in_degrees = info
        .crs
        .as_ref()
        .is_some_and(|crs| crs.kind == CrsKind::Geographic);
    let weight_column = info.columns.map(|columns| {
        let coordinates = [Some(columns.x), Some(columns.y), columns.z];
        let after = coordinates.into_iter().flatten().fold(0, usize::max) + 1;
        Columns {
            z: Some(after + usize::from(columns.class == Some(after))),
            class: None,
            ..columns
        }
    });
    let (points, has_classes) = read_all(path, source, journal)?;
    Ok(Cloud {
        has_classes,
        is_in_degrees,
        weight_column,
        ..Cloud::of(points)
    })
}

/// Reads all points of a source; true if they have classes.
fn read_all(
    path: &Path,
    mut source: Box<dyn PointSource + Send>,
    journal: &Journal,
) -> Result<(Vec<[f64; 3]>, bool)> {
    let count = source.info().count;
    journal.add_warnings(path, &source.info().warnings.clone());
    let work = journal.start(
        Stage::ReadingPoints,
        count.map_or(Size::Unknown, Size::Items),
    )?;
    let (mut points, mut has_classes) = (Vec::new(), false);
    let mut batch = PointBatch::default();
    loop {
        source.read(&mut batch).map_err(|e| e.in_file(path))?;
        if batch.is_empty() {
            break;
        }
        has_classes |= !batch.class.is_empty();
        let coordinates = batch.x.iter().zip(&batch.y).zip(&batch.z);
        points.extend(coordinates.map(|((&x, &y), &z)| [x, y, z]));
        work.add(batch.len() as u64)?;
    }
    journal.add_warnings(path, source.warnings());
    work.end()?;
    Ok((points, has_classes))
}

fn weights_beside(path: &Path) -> PathBuf {
    path.with_extension("weights")
}

/// Reads the weights of a text, which are in place of z among these columns.
fn column_of_weights(path: &Path, columns: Columns, journal: &Journal) -> Result<Vec<f64>> {
    let cure = format!(
        "give weights as the column after the coordinates, or put {} next to the file, one number a line",
        weights_beside(path).display()
    );
    let options = Options {
        columns: Some(columns),
        ..Options::default()
    };
    let read = open::points_of_file(path, options, &journal.context)
        .and_then(|source| read_all(path, source, journal));
    let (points, _) = read.map_err(|e| e.cure(cure))?;
    Ok(points.into_iter().map(|[_, _, weight]| weight).collect())
}

/// Makes numbers the first attribute of the vertices.
fn put_first(nodes: &mut Nodes<3>, numbers: &[f64]) {
    let rows = numbers.iter().enumerate();
    let attributes = rows.flat_map(|(i, &number)| {
        [number]
            .into_iter()
            .chain(nodes.attributes_of(i).iter().copied())
    });
    nodes.attributes = attributes.collect();
    nodes.attribute_count += 1;
}

/// Returns the weights of vertices: those next to the file, else their first attribute.
fn weights(path: &Path, nodes: &Nodes<3>, journal: &Journal) -> Result<Vec<f64>> {
    let beside = weights_beside(path);
    let count = nodes.points.len();
    if beside.exists() {
        let read = |watch: Watch| tetgen::read_weights(&beside, count, watch);
        let (weights, warnings) = open::reading_stage(&beside, &journal.context, read)?;
        journal.add_warnings(&beside, &warnings);
        return Ok(weights);
    }
    if nodes.attribute_count > 0 {
        return Ok((0..count).map(|i| nodes.attributes_of(i)[0]).collect());
    }
    Err(Error::format("the points have no weights")
        .in_file(path)
        .cure(format!(
            "put {} next to it, one number a line, or weights as the first attribute of a .node",
            beside.display()
        )))
}

/// A triangulation in the numbers of the points.
struct Built {
    tetrahedra: Vec<[u32; 4]>,
    neighbors: Vec<[Option<u32>; 4]>,
    solid: Option<AlphaSolid>,
    duplicates: usize,
    hidden: usize,
    dimension: i32,
}

/// Triangulates with the selected arithmetic.
fn build(
    points: &[[f64; 3]],
    weights: Option<&[f64]>,
    options: &SpaceOptions,
) -> std::result::Result<Built, InputError> {
    let ordinary = |numbers: &[f64]| numbers.iter().all(|&x| Adaptive::RANGE.admits(x));
    let is_ordinary = ordinary(points.as_flattened()) && weights.is_none_or(ordinary);
    match options.arithmetic {
        Arithmetic::Exact => build_with::<Exact>(points, weights, options.alpha),
        _ if is_ordinary => build_with::<Adaptive>(points, weights, options.alpha),
        _ => build_with::<Wide>(points, weights, options.alpha),
    }
}

fn build_with<K: Kernel>(
    points: &[[f64; 3]],
    weights: Option<&[f64]>,
    alpha: Option<Alpha>,
) -> std::result::Result<Built, InputError> {
    let Some(weights) = weights else {
        let (t, vertices) = Delaunay::<Space<K>, 4>::from_points(Space::default(), points)?;
        let mut built = listed(&t, &vertices);
        built.solid = alpha.and_then(|alpha| solid(&t.alpha_shapes(), alpha, points, &vertices));
        return Ok(built);
    };
    let weighted: Vec<[f64; 4]> = points
        .iter()
        .zip(weights)
        .map(|(&[x, y, z], &weight)| [x, y, z, weight])
        .collect();
    let (t, vertices) =
        Regular::<WeightedSpace<K>, 4>::from_points(WeightedSpace::default(), &weighted)?;
    let mut built = listed(&t, &vertices);
    built.hidden = t.hidden().len();
    built.solid = alpha.and_then(|alpha| solid(&t.alpha_shapes(), alpha, points, &vertices));
    Ok(built)
}

/// Returns the number of the first point of each vertex.
fn points_of(vertices: &[VertexId], slots: usize) -> Vec<u32> {
    let mut points = vec![u32::MAX; slots];
    for (point, vertex) in vertices.iter().enumerate().rev() {
        points[vertex.index()] = point as u32;
    }
    points
}

/// Lists tetrahedra in the numbers of the points.
fn listed<G: Geometry<4>>(t: &Triangulation<G, 4>, vertices: &[VertexId]) -> Built {
    let tds = t.tds();
    let point_of = points_of(vertices, tds.vertex_slots());
    let is_solid = t.dimension() == 3;
    let cells: Vec<_> = t.finite_cells().filter(|_| is_solid).collect();
    let mut number = vec![None; tds.cell_slots()];
    cells
        .iter()
        .zip(0..)
        .for_each(|(cell, i)| number[cell.index()] = Some(i));
    let tetrahedra = cells
        .iter()
        .map(|&cell| tds.corners(cell).map(|vertex| point_of[vertex.index()]))
        .collect();
    let neighbors = cells
        .iter()
        .map(|&cell| std::array::from_fn(|i| number[tds.neighbor(cell, i).index()]))
        .collect();
    Built {
        tetrahedra,
        neighbors,
        solid: None,
        duplicates: vertices.len() - point_of.iter().filter(|&&point| point != u32::MAX).count(),
        hidden: 0,
        dimension: t.dimension(),
    }
}

/// Returns an alpha shape as a mesh; `None` if there are no tetrahedra.
fn solid(
    shapes: &AlphaShapes<'_>,
    alpha: Alpha,
    points: &[[f64; 3]],
    vertices: &[VertexId],
) -> Option<AlphaSolid> {
    let shape = match alpha {
        Alpha::Given(alpha) => shapes.at(alpha),
        Alpha::OneSolid => shapes.with_components(1)?,
    };
    let slots = vertices
        .iter()
        .map(|vertex| vertex.index() + 1)
        .max()
        .unwrap_or(0);
    let point_of = points_of(vertices, slots);
    let boundary = shape.boundary();
    Some(AlphaSolid {
        points: points.to_vec(),
        triangles: boundary
            .triangles
            .iter()
            .map(|corners| corners.map(|v| point_of[v.index()]))
            .collect(),
        alpha: shape.alpha(),
        parts: shape.components(),
        volume: shape.volume(),
        singular_edges: boundary.singular_edges.len(),
        singular_vertices: boundary.singular_vertices.len(),
    })
}

/// Returns an error that names a point by its number in the file.
#[cold]
fn explained(error: &InputError, nodes: &Nodes<3>, path: &Path) -> Error {
    let InputError::NotFinite(i) = *error else {
        return Error::limit(error.to_string()).in_file(path);
    };
    let number = i + nodes.first_number as usize;
    let [x, y, z] = nodes.points[i];
    Error::limit(format!(
        "point {number} is at {x:?} {y:?} {z:?}, expected finite coordinates and weights"
    ))
    .in_file(path)
}
