//! Triangulation of Triangle's files.

mod assemble;
mod between;
mod build;
mod carve;

use std::path::Path;

use self::build::{Built, OfAdded, SeedLocation};
use self::carve::Outside;
use crate::data::{EdgeKind, Mesh, Triangles};
use crate::error::{Error, Result, Setting, wording};
use crate::io::triangle::{self, LineGraph, Triangulated};
use crate::io::{Destination, contain};
use crate::run::context::notice::{Notice, Seed, SeedFlaw};
use crate::run::context::{Context, Journal, Size, Stage};
use crate::run::products::check;
use crate::run::sources::open;
use crate::triangulation::kernel::{Adaptive, Exact, Fast, Kernel, Range, Wide};
use crate::triangulation::refine::{Domain, Quality, RegionBound, Shortfall};
use crate::triangulation::{InputError, OnCrossing};

/// Options of triangulating points and segments of the plane. By default nothing is refined, and
/// triangles outside of the outer boundary or in a hole are left out.
#[derive(Debug, Clone, Default)]
pub struct TriangulateOptions {
    /// True if the whole convex hull is kept; holes are still left out.
    pub convex: bool,
    /// What to do where segments cross between their ends.
    pub on_crossing: OnCrossing,
    /// The smallest angle in degrees: vertices are added until no angle is smaller.
    pub min_angle: Option<f64>,
    /// The largest area: vertices are added until no triangle is larger.
    pub max_area: Option<f64>,
    /// True if the largest areas of regions apply to the triangles in them.
    pub region_areas: bool,
    /// The number of added vertices after which refinement stops. If it is `None`, refinement that
    /// needs more than 1 000 000 is an error.
    pub max_added: Option<usize>,
    /// The arithmetic of the predicates.
    pub arithmetic: Arithmetic,
}

impl TriangulateOptions {
    /// Returns true if vertices are to be added for angles or areas.
    fn refines(&self) -> bool {
        self.min_angle.is_some() || self.max_area.is_some() || self.region_areas
    }

    /// Returns true if triangles between the outer boundary and the convex hull are kept: without
    /// segments there is no outer boundary.
    fn keeps_hull(&self, graph: &LineGraph) -> bool {
        self.convex || graph.segments.is_empty()
    }
}

/// The arithmetic that decides on which side of a line a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Arithmetic {
    /// Exact, as fast as floating point where that is certain.
    #[default]
    Adaptive,
    /// Exact, with numbers of any length; slow.
    Exact,
    /// Plain floating point, for experiments: a wrong result is an error, and the run may not end.
    Fast,
}

/// A triangulation in the form of Triangle's files.
#[derive(Debug)]
#[non_exhaustive]
pub struct TriangulateProduct {
    /// Vertices, triangles, edges and segments.
    pub triangulated: Triangulated,
    /// Counts of the input and of the result.
    pub report: TriangulateReport,
    /// What was assumed and what looks wrong, in the order in which it was found.
    pub notices: Vec<Notice>,
}

/// Counts of a triangulation of points and segments.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct TriangulateReport {
    /// Vertices of the input.
    pub vertices_given: usize,
    /// Vertices added where segments cross.
    pub vertices_at_crossings: usize,
    /// Vertices added for angles and areas.
    pub vertices_for_quality: usize,
    /// Vertices at the position of an earlier one, which have no triangle.
    pub duplicates: usize,
    /// Segments of the input.
    pub segments_given: usize,
    /// Triangles, including those that were left out.
    pub triangles_built: usize,
    /// The reason for each triangle that is not as requested.
    pub shortfall: Vec<Shortfall>,
}

/// Triangulates the points and segments of a `.node` or `.poly` file.
///
/// # Errors
/// If the file cannot be read, segments cross and that is refused, the refinement does not end, no
/// triangle is left, or the run is canceled.
pub fn triangulate(
    path: &Path,
    options: &TriangulateOptions,
    context: &Context,
) -> Result<TriangulateProduct> {
    let journal = Journal::new(context);
    let graph = open::line_graph(path, context)?;
    journal.add_warnings(path, &graph.warnings);
    triangulate_journaled(&graph, path, options, context, journal)
}

/// Triangulates points and segments in memory. Errors and notices call them by a name, as if it
/// were that of their file.
///
/// # Errors
/// If segments cross and that is refused, the refinement does not end, no triangle is left, or the
/// run is canceled; if a segment names a vertex that does not exist.
pub fn triangulate_graph(
    graph: &LineGraph,
    name: &Path,
    options: &TriangulateOptions,
    context: &Context,
) -> Result<TriangulateProduct> {
    triangulate_journaled(graph, name, options, context, Journal::new(context))
}

fn triangulate_journaled(
    graph: &LineGraph,
    path: &Path,
    options: &TriangulateOptions,
    context: &Context,
    journal: Journal,
) -> Result<TriangulateProduct> {
    if !options.region_areas
        && graph
            .regions
            .iter()
            .any(|region| region.max_area.is_some_and(|area| area != region.attribute))
    {
        journal.add(Notice::RegionAreasUnused(path.to_path_buf()));
    }

    let built = build(graph, options, path, context)?;
    if options.max_added.is_none() && built.shortfall.contains(&Shortfall::Limit) {
        return Err(unfinished(&built).in_file(path));
    }
    note_seeds(&built, graph, path, &journal);
    // In a refined triangulation the hull is a constraint; triangles beyond it are only effects of
    // rounding.
    let outside = if options.keeps_hull(graph) && !options.refines() {
        Outside::Keep
    } else {
        Outside::Remove
    };
    let is_kept = carve::kept(&built, graph, outside);
    let attributes = carve::attributes(&built, graph, &is_kept);
    let triangulated = assemble::assemble(graph, &built, &is_kept, &attributes);
    if triangulated.triangles.is_empty() && !built.faces.is_empty() {
        return Err(Error::format(
            "no triangle is left: all can be reached from outside or from a hole",
        )
        .in_file(path)
        .cure(wording![
            "close the outer boundary with segments, or add ",
            Setting::Convex.on(),
            " to keep the hull"
        ]));
    }
    let given = graph.nodes.points.len();
    let added = triangulated.nodes.points.len() - given;
    let report = TriangulateReport {
        vertices_given: given,
        vertices_at_crossings: added.saturating_sub(built.added),
        vertices_for_quality: built.added,
        duplicates: given + added - built.vertices.len(),
        segments_given: graph.segments.len(),
        triangles_built: built.faces.len(),
        shortfall: built.shortfall,
    };
    Ok(TriangulateProduct {
        triangulated,
        report,
        notices: journal.take(),
    })
}

impl TriangulateProduct {
    /// Returns the triangles as a surface of height 0, which can be written as a mesh.
    ///
    /// # Errors
    /// If they are not a surface.
    pub fn to_mesh(&self) -> Result<Mesh> {
        let Triangulated {
            nodes,
            triangles,
            segments,
            ..
        } = &self.triangulated;
        let vertices = nodes.points.iter().map(|&[x, y]| [x, y, 0.0]).collect();
        let edges: Vec<[u32; 2]> = segments.iter().map(|edge| edge.ends).collect();
        let edges = if triangles.is_empty() {
            &[]
        } else {
            edges.as_slice()
        };
        Mesh::new(vertices, triangles.clone(), edges, None)
    }

    /// Writes Triangle's files, each in the format of its extension.
    ///
    /// # Errors
    /// If one cannot be written, or the run is canceled.
    pub fn write(&self, targets: &[Destination], context: &Context) -> Result<()> {
        let writing = context.start(Stage::Writing, Size::Uncounted)?;
        triangle::write(targets, &self.triangulated)?;
        writing.end()
    }
}

/// Triangulates with the selected arithmetic.
fn build(
    graph: &LineGraph,
    options: &TriangulateOptions,
    path: &Path,
    context: &Context,
) -> Result<Built> {
    let triangulating = context.start(Stage::Triangulating, Size::Uncounted)?;
    let built = match options.arithmetic {
        Arithmetic::Adaptive if is_ordinary(graph) => {
            build_with::<Adaptive>(graph, options, context)
        }
        Arithmetic::Adaptive => build_with::<Wide>(graph, options, context),
        Arithmetic::Exact => build_with::<Exact>(graph, options, context),
        Arithmetic::Fast => {
            contain(|| build_with::<Fast>(graph, options, context)).ok_or_else(|| {
                Error::limit("plain floating point contradicts itself on these points")
                    .in_file(path)
                    .cure(wording!["leave out ", Setting::Kernel.text("fast")])
            })?
        }
    };
    triangulating.end()?;
    let built = built.map_err(|error| explained(error, graph, path))?;
    if options.arithmetic == Arithmetic::Fast {
        refuse_flaws(&built, context).map_err(|e| e.in_file(path))?;
    }
    Ok(built)
}

/// Returns true if no coordinate is so large or small that the default arithmetic would need wider
/// numbers.
fn is_ordinary(graph: &LineGraph) -> bool {
    graph
        .nodes
        .points
        .as_flattened()
        .iter()
        .all(|&x| Adaptive::RANGE.admits(x))
}

fn build_with<K: Kernel>(
    graph: &LineGraph,
    options: &TriangulateOptions,
    context: &Context,
) -> std::result::Result<Built, InputError> {
    let segments: Vec<[u32; 2]> = graph.segments.iter().map(|segment| segment.ends).collect();
    let holes = graph.holes.iter().map(|hole| hole.at);
    let seeds: Vec<[f64; 2]> = holes
        .chain(graph.regions.iter().map(|region| region.at))
        .collect();
    let quality = quality(options, graph, context);
    let of_added = match graph.nodes.attribute_count {
        0 => OfAdded::Position,
        _ => OfAdded::Weights,
    };
    // Chains are for markers and attributes, and for the check of plain floating point.
    let has_attributes = graph.nodes.attribute_count > 0;
    let needs_all = has_attributes || options.arithmetic == Arithmetic::Fast;
    let is_traced = graph.segments.iter().map(|s| needs_all || s.marker != 0);
    build::build::<K>(
        &graph.nodes.points,
        &segments,
        &is_traced.collect::<Vec<bool>>(),
        &seeds,
        options.on_crossing,
        quality.as_ref().map(|quality| (quality, of_added)),
    )
}

/// Returns the requested quality of triangles, if any.
fn quality<'a>(
    options: &TriangulateOptions,
    graph: &LineGraph,
    context: &Context<'a>,
) -> Option<Quality<'a>> {
    if !options.refines() {
        return None;
    }
    let holes = graph.holes.iter().map(|hole| hole.at).collect();
    let bounds = graph.regions.iter().filter(|_| options.region_areas);
    Some(Quality {
        min_angle: options.min_angle.unwrap_or(0.0),
        max_area: options.max_area.unwrap_or(f64::INFINITY),
        regions: bounds
            .filter_map(|region| {
                Some(RegionBound {
                    seed: region.at,
                    max_area: region.max_area?,
                })
            })
            .collect(),
        domain: if options.keeps_hull(graph) {
            Domain::Hull { holes }
        } else {
            Domain::Enclosed { holes }
        },
        max_added: options.max_added.unwrap_or(Quality::MAX_ADDED),
        cancel: Some(context.cancel),
        ..Quality::default()
    })
}

/// Returns the error of a refinement that did not end within the default number of vertices.
#[cold]
fn unfinished(built: &Built) -> Error {
    let (added, all, short) = (Quality::MAX_ADDED, built.faces.len(), built.shortfall.len());
    Error::limit(format!("{added} vertices were added, and {short} of {all} triangles are still not as requested"))
        .cure(wording![
            "use a smaller angle (33 degrees are nearly always reached) or a larger area, or set a limit with ",
            Setting::MaxAdded,
            " and get the result at that point"
        ])
}

/// Returns an error that names vertices or segments by their numbers and lines in the file.
#[cold]
fn explained(error: InputError, graph: &LineGraph, path: &Path) -> Error {
    let at_vertex = |i: usize, expected: &str| {
        let ([x, y], number) = (graph.nodes.points[i], i + graph.nodes.first_number as usize);
        let line = graph.node_lines.get(i);
        Error::limit(format!("vertex {number} is at {x:?} {y:?}, {expected}"))
            .in_file(&graph.node_file)
            .at(line.map_or_else(|| format!("vertex {number}"), |line| format!("line {line}")))
    };
    match error {
        InputError::NotFinite(i) => at_vertex(i, "expected finite coordinates"),
        InputError::Coordinate(i) => {
            let Range { min, max } = Fast::RANGE;
            let expected = format!("expected coordinates of 0 or between {min:.0e} and {max:.0e}");
            at_vertex(i, &expected).cure(wording![
                "leave out ",
                Setting::Kernel.text("fast"),
                ": the others take any finite coordinate"
            ])
        }
        InputError::Crossing {
            segments,
            at: [x, y],
        } => {
            let mut positions = segments.map(|(line, _)| line);
            positions.sort_unstable();
            let [one, other] = positions.map(|i| &graph.segments[i]);
            Error::format(format!(
                "segments {} and {} cross at {x:?} {y:?}",
                one.number, other.number
            ))
            .in_file(path)
            .at(format!("lines {} and {}", one.line, other.line))
            .cure(wording![
                "divide both at a vertex there, or use ",
                Setting::OnCrossing.text("split")
            ])
        }
        _ => Error::limit(error.to_string()).in_file(&graph.node_file),
    }
}

/// Returns an error if an inexact triangulation has a flaw.
fn refuse_flaws(built: &Built, context: &Context) -> Result<()> {
    let triangles = Triangles {
        vertices: built.vertices.iter().map(|&[x, y]| [x, y, 0.0]).collect(),
        faces: built.faces.iter().map(|face| face.corners).collect(),
        lines: built
            .chains
            .iter()
            .flat_map(|chain| chain.windows(2).map(|pair| [pair[0], pair[1]]))
            .map(|edge| (edge, EdgeKind::Breakline))
            .collect(),
        ..Triangles::default()
    };
    match check::first_flaw(triangles, context)? {
        None => Ok(()),
        Some(flaw) => Err(Error::limit(format!(
            "plain floating point gave a wrong triangulation ({flaw})"
        ))
        .cure(wording!["leave out ", Setting::Kernel.text("fast")])),
    }
}

/// Adds notices about holes and regions that are not used.
fn note_seeds(built: &Built, graph: &LineGraph, path: &Path, journal: &Journal) {
    let holes = graph.holes.iter().map(|hole| (Seed::Hole, hole.line));
    let listed = holes.chain(
        graph
            .regions
            .iter()
            .map(|region| (Seed::Region, region.line)),
    );
    for ((seed, line), location) in listed.zip(&built.seeds) {
        let why = match location {
            SeedLocation::Face(_) => continue,
            SeedLocation::Constraint => SeedFlaw::OnSegment,
            SeedLocation::Outside => SeedFlaw::OutsideHull,
        };
        journal.add(Notice::SeedUnused {
            path: path.to_path_buf(),
            line,
            seed,
            why,
        });
    }
}
