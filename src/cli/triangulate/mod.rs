//! The door for users of Triangle: its files in, its files out.

mod assemble;
mod build;
mod eaten;

use std::path::Path;

use self::build::{Built, Place};
use self::eaten::Outside;
use super::args::{KernelArg, OnCrossingArg, TriangulateArgs};
use super::outputs::{self, Format, Target};
use super::progress::Size;
use super::talk::Talk;
use super::{Exit, inputs, open};
use crate::data::Triangles;
use crate::error::{Error, Result};
use crate::io::triangle::{LineGraph, Triangulated};
use crate::io::{Destination, OutputSet, contain};
use crate::triangulation::kernel::{Adaptive, Exact, Fast, Kernel, Range, Wide};
use crate::triangulation::refine::{Domain, Quality, Region, Shortfall};
use crate::triangulation::{OnCrossing, Refused};

/// Whose format an output has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Family {
    Triangle,
    Mesh,
}

const MESHES: [Format<Family>; 3] = [
    Format { extension: "off", kind: Family::Mesh, companions: &[] },
    Format { extension: "obj", kind: Family::Mesh, companions: &[] },
    Format { extension: "ply", kind: Family::Mesh, companions: &[] },
];

/// What is written of a `.poly`: as Triangle does, an `.ele` comes with the segments.
const OF_POLY: &[Format<Family>] = &formats(&["node", "poly"]);
const OF_NODE: &[Format<Family>] = &formats(&["node"]);

const fn formats(beside_ele: &'static [&'static str]) -> [Format<Family>; 8] {
    let [off, obj, ply] = MESHES;
    let kind = Family::Triangle;
    [
        Format { extension: "node", kind, companions: &[] },
        Format { extension: "ele", kind, companions: beside_ele },
        Format { extension: "poly", kind, companions: &["node"] },
        Format { extension: "edge", kind, companions: &["node"] },
        Format { extension: "neigh", kind, companions: &[] },
        off,
        obj,
        ply,
    ]
}

/// Triangulates what a `.node` or `.poly` file holds.
pub(super) fn run(args: &TriangulateArgs, talk: &Talk) -> Result<Exit> {
    let path = &args.input;
    inputs::require([path])?;
    let is_poly = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("poly"));
    let formats = if is_poly { OF_POLY } else { OF_NODE };
    // A .poly may have its vertices beside it.
    let mut read = vec![path.clone()];
    read.extend(Some(path.with_extension("node")).filter(|node| is_poly && node.exists()));
    let outputs = outputs::resolve(&args.output, formats, &read)?;
    let reading = talk.progress("reading", Size::Uncounted);
    let graph = open::line_graph(path)?;
    drop(reading);
    graph.warnings.iter().for_each(|text| talk.warning(format_args!("{}: {text}", path.display())));
    if !args.region_areas
        && graph.regions.iter().any(|region| region.max_area.is_some_and(|area| area != region.attribute))
    {
        talk.warning(format_args!(
            "{}: largest areas of regions are not used: no vertex is added for them without -a",
            path.display()
        ));
    }

    let built = build(&graph, args, path, talk)?;
    if args.max_added.is_none() && built.shortfall.contains(&Shortfall::Limit) {
        return Err(unfinished(&built).in_file(path));
    }
    tell_places(&built, &graph, path, talk);
    let keeps_hull = args.convex || graph.segments.is_empty();
    // Refined, the hull is a constraint, beyond which there may be less than a rounding.
    let outside = if keeps_hull && quality(args, &graph).is_none() { Outside::Keep } else { Outside::Eat };
    let is_kept = eaten::kept(&built, &graph, outside);
    let attributes = eaten::attributes(&built, &graph, &is_kept);
    let triangulated = assemble::assemble(&graph, &built, &is_kept, &attributes);
    if triangulated.triangles.is_empty() && !built.faces.is_empty() {
        return Err(Error::format("no triangle is left: all can be reached from outside or from a hole")
            .in_file(path)
            .cure("close the outer boundary with segments, or add --convex to keep the hull"));
    }
    if built.faces.is_empty()
        && let Some(mesh) = outputs.targets.iter().find(|target| target.kind == Family::Mesh)
    {
        return Err(Error::format("all vertices are on one line or at one place: there is no triangle to write")
            .in_file(&mesh.path)
            .cure("add a vertex beside the line; .node, .poly and .ele hold vertices without triangles, too"));
    }
    let [meshes, files] = [Family::Mesh, Family::Triangle].map(|family| files(&outputs.targets, formats, family));
    write(&outputs.set, &meshes, &files, &triangulated, talk)?;
    tell(&graph, args, &built, &triangulated, talk);
    outputs.commit(talk)?;
    Ok(Exit::Done)
}

/// Triangulates with the arithmetic that was asked for.
fn build(graph: &LineGraph, args: &TriangulateArgs, path: &Path, talk: &Talk) -> Result<Built> {
    let triangulating = talk.progress("triangulating", Size::Uncounted);
    let built = match args.kernel {
        KernelArg::Adaptive if is_ordinary(graph) => build_with::<Adaptive>(graph, args),
        KernelArg::Adaptive => build_with::<Wide>(graph, args),
        KernelArg::Exact => build_with::<Exact>(graph, args),
        KernelArg::Fast => contain(|| build_with::<Fast>(graph, args)).ok_or_else(|| {
            Error::limit("plain floating point contradicts itself on these points")
                .in_file(path)
                .cure("leave out --kernel fast")
        })?,
    };
    let built = built.map_err(|refused| explained(refused, graph, path))?;
    drop(triangulating);
    if args.kernel == KernelArg::Fast {
        refuse_flaws(&built, talk).map_err(|e| e.in_file(path))?;
    }
    Ok(built)
}

/// Whether no coordinate is so large or small that the default arithmetic would need wider numbers.
fn is_ordinary(graph: &LineGraph) -> bool {
    graph.nodes.points.as_flattened().iter().all(|&x| Adaptive::RANGE.admits(x))
}

fn build_with<K: Kernel>(graph: &LineGraph, args: &TriangulateArgs) -> std::result::Result<Built, Refused> {
    let segments: Vec<[u32; 2]> = graph.segments.iter().map(|segment| segment.ends).collect();
    let holes = graph.holes.iter().map(|hole| hole.at);
    let places: Vec<[f64; 2]> = holes.chain(graph.regions.iter().map(|region| region.at)).collect();
    let on_crossing = match args.on_crossing {
        OnCrossingArg::Split => OnCrossing::Split,
        OnCrossingArg::Reject => OnCrossing::Reject,
    };
    build::build::<K>(&graph.nodes.points, &segments, &places, on_crossing, quality(args, graph).as_ref())
}

/// What triangles are to be, if anything is asked for.
fn quality(args: &TriangulateArgs, graph: &LineGraph) -> Option<Quality<'static>> {
    if args.min_angle.is_none() && args.max_area.is_none() && !args.region_areas {
        return None;
    }
    let holes = graph.holes.iter().map(|hole| hole.at).collect();
    let is_hull = args.convex || graph.segments.is_empty();
    let bounds = graph.regions.iter().filter(|_| args.region_areas);
    Some(Quality {
        min_angle: args.min_angle.unwrap_or(0.0),
        max_area: args.max_area.unwrap_or(f64::INFINITY),
        regions: bounds.filter_map(|region| Some(Region { seed: region.at, max_area: region.max_area? })).collect(),
        domain: if is_hull { Domain::Hull { holes } } else { Domain::Enclosed { holes } },
        max_added: args.max_added.unwrap_or(Quality::MAX_ADDED),
        ..Quality::default()
    })
}

/// Says how far a refinement came that nobody had bounded.
#[cold]
fn unfinished(built: &Built) -> Error {
    let (added, all, short) = (Quality::MAX_ADDED, built.faces.len(), built.shortfall.len());
    Error::limit(format!("{added} vertices were added, and {short} of {all} triangles are still not as asked for"))
        .cure(
            "ask for a smaller angle (33 degrees are nearly always reached) or a larger area, or set a limit with \
             --max-added and get what is there then",
        )
}

/// With the numbers and lines of the file.
#[cold]
fn explained(refused: Refused, graph: &LineGraph, path: &Path) -> Error {
    match refused {
        Refused::Coordinate(i) => {
            let ([x, y], Range { min, max }) = (graph.nodes.points[i], Fast::RANGE);
            let number = i + graph.nodes.first_number as usize;
            let expected = format!("expected coordinates of 0 or between {min:.0e} and {max:.0e}");
            Error::limit(format!("vertex {number} is at {x:?} {y:?}, {expected}"))
                .in_file(&graph.node_file)
                .at(format!("line {}", graph.node_lines[i]))
                .cure("leave out --kernel fast: the others take any finite coordinate")
        }
        Refused::Crossing { segments, place: [x, y] } => {
            let mut positions = segments.map(|(line, _)| line);
            positions.sort_unstable();
            let [one, other] = positions.map(|i| &graph.segments[i]);
            Error::format(format!("segments {} and {} cross at {x:?} {y:?}", one.number, other.number))
                .in_file(path)
                .at(format!("lines {} and {}", one.line, other.line))
                .cure("divide both at a vertex there, or use --on-crossing split")
        }
        _ => Error::limit(refused.to_string()).in_file(&graph.node_file),
    }
}

/// What is not exact may come out wrong.
fn refuse_flaws(built: &Built, talk: &Talk) -> Result<()> {
    let triangles = Triangles {
        vertices: built.vertices.iter().map(|&[x, y]| [x, y, 0.0]).collect(),
        faces: built.faces.iter().map(|face| face.corners).collect(),
        constrained_edges: built
            .chains
            .iter()
            .flat_map(|chain| chain.windows(2).map(|pair| [pair[0], pair[1]]))
            .collect(),
        ..Triangles::default()
    };
    match open::first_flaw(triangles, talk)? {
        None => Ok(()),
        Some(flaw) => Err(Error::limit(format!("plain floating point gave a wrong triangulation ({flaw})"))
            .cure("leave out --kernel fast")),
    }
}

/// Says which holes and regions cannot be told apart.
fn tell_places(built: &Built, graph: &LineGraph, path: &Path, talk: &Talk) {
    let holes = graph.holes.iter().map(|hole| ("hole", hole.line));
    let listed = holes.chain(graph.regions.iter().map(|region| ("region", region.line)));
    for ((what, line), place) in listed.zip(&built.places) {
        let why = match place {
            Place::Face(_) => continue,
            Place::Wall => "lies on a segment, and which side is meant cannot be told",
            Place::Outside => "lies outside of the convex hull",
        };
        talk.warning(format_args!("{}: line {line}: the {what} {why}; it is not used", path.display()));
    }
}

/// All files of a family that are written, with what comes with them; each once.
fn files(targets: &[Target<Family>], formats: &'static [Format<Family>], family: Family) -> Vec<Target<Family>> {
    let mut files: Vec<Target<Family>> = Vec::new();
    for target in targets.iter().filter(|target| target.kind == family) {
        for file in outputs::files_of(target, formats) {
            if !files.contains(&file) {
                files.push(file);
            }
        }
    }
    files
}

/// Adds all files to the outputs.
fn write(
    outputs: &OutputSet,
    meshes: &[Target<Family>],
    files: &[Target<Family>],
    triangulated: &Triangulated,
    talk: &Talk,
) -> Result<()> {
    if !meshes.is_empty() {
        let mesh = open::flat_mesh(triangulated)?;
        for target in meshes {
            let written = open::write_mesh(target.within(outputs), &mesh, talk)?;
            outputs::tell_lost(&target.path, written.lost_edges, ".ply and .poly keep them", talk);
        }
    }
    let files: Vec<Destination> = files.iter().map(|file| file.within(outputs)).collect();
    let _writing = talk.progress("writing", Size::Uncounted);
    open::write_triangulated(&files, triangulated)
}

/// Says what went in and what came out.
fn tell(graph: &LineGraph, args: &TriangulateArgs, built: &Built, triangulated: &Triangulated, talk: &Talk) {
    let given = graph.nodes.points.len();
    let added = triangulated.nodes.points.len() - given;
    let doubled = given + added - built.vertices.len();
    let between = built.between.len();
    let refined = if between > 0 { format!(", {between} for angles and areas") } else { String::new() };
    let crossings = added - between.min(added);
    talk.line(format_args!(
        "vertices    {} ({given} in, {crossings} added where segments cross{refined})",
        given + added
    ));
    if doubled > 0 {
        talk.line(format_args!("            {doubled} at the place of an earlier one, without a triangle"));
    }
    let walls = triangulated.segments.len();
    talk.line(format_args!(
        "segments    {} in, {walls} constrained edges out, the boundary among them",
        graph.segments.len()
    ));
    let (all, kept) = (built.faces.len(), triangulated.triangles.len());
    let eaten = if kept < all { format!(" ({} outside or in holes eaten away)", all - kept) } else { String::new() };
    talk.line(format_args!("triangles   {kept}{eaten}"));
    let limit = format!("left when {} vertices had been added (--max-added)", args.max_added.unwrap_or_default());
    for (why, text) in [
        (Shortfall::SmallAngle, "at small angles between segments"),
        (Shortfall::Limit, &limit),
        (Shortfall::Coordinates, "too small for the coordinates to tell more vertices"),
    ] {
        let count = built.shortfall.iter().filter(|&&other| other == why).count();
        if count > 0 {
            talk.warning(format_args!("{count} triangles are not as asked for: {text}"));
        }
    }
    if all == 0 {
        talk.warning("all vertices are on one line or at one place: there is no triangle");
    }
}
