//! Triangulation of Triangle's files.

use crate::cli::Exit;
use crate::cli::input::args::{KernelArg, TriangulateArgs};
use crate::cli::input::inputs;
use crate::cli::input::outputs::{self, Format, Target};
use crate::cli::report::console::Console;
use crate::error::{Error, Result};
use crate::io::{Destination, OutputSet};
use crate::run::{self, Arithmetic, TriangulateOptions, TriangulateProduct};
use crate::triangulation::refine::Shortfall;

/// The family of formats that an output belongs to.
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

/// Formats for a `.poly`: as with Triangle, an `.ele` is written with the segments.
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

/// Triangulates a `.node` or `.poly` file.
pub(in crate::cli) fn run(args: &TriangulateArgs, console: &Console) -> Result<Exit> {
    let path = &args.input;
    inputs::require([path])?;
    let is_poly = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("poly"));
    let formats = if is_poly { OF_POLY } else { OF_NODE };
    // The vertices of a .poly may be in the .node next to it.
    let mut read = vec![path.clone()];
    read.extend(Some(path.with_extension("node")).filter(|node| is_poly && node.exists()));
    let outputs = outputs::resolve(&args.output, formats, &read)?;
    let product = run::triangulate(path, &options(args), &console.context())?;
    if product.report.triangles_built == 0
        && let Some(mesh) = outputs.targets.iter().find(|target| target.kind == Family::Mesh)
    {
        return Err(Error::format("all vertices are on one line or at one position: there is no triangle to write")
            .in_file(&mesh.path)
            .cure("add a vertex off the line; .node, .poly and .ele can also store vertices without triangles"));
    }
    let [meshes, files] = [Family::Mesh, Family::Triangle].map(|family| files(&outputs.targets, formats, family));
    write(&outputs.set, &meshes, &files, &product, console)?;
    print_report(&product, args.max_added, console);
    outputs.commit(console)?;
    Ok(Exit::Done)
}

fn options(args: &TriangulateArgs) -> TriangulateOptions {
    TriangulateOptions {
        convex: args.convex,
        on_crossing: args.on_crossing.into(),
        min_angle: args.min_angle,
        max_area: args.max_area,
        region_areas: args.region_areas,
        max_added: args.max_added,
        arithmetic: match args.kernel {
            KernelArg::Adaptive => Arithmetic::Adaptive,
            KernelArg::Exact => Arithmetic::Exact,
            KernelArg::Fast => Arithmetic::Fast,
        },
    }
}

/// Returns the files of a family that are written, with their companions, each once.
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

/// Writes the files of all families as outputs.
fn write(
    outputs: &OutputSet,
    meshes: &[Target<Family>],
    files: &[Target<Family>],
    product: &TriangulateProduct,
    console: &Console,
) -> Result<()> {
    if !meshes.is_empty() {
        let mesh = product.to_mesh()?;
        for target in meshes {
            let written = run::write_mesh(&mesh, target.within(outputs), &console.context())?;
            outputs::note_lost_edges(&target.path, written.lost_edges, ".ply and .poly keep them", console);
        }
    }
    let files: Vec<Destination> = files.iter().map(|file| file.within(outputs)).collect();
    product.write(&files, &console.context())
}

/// Prints the counts of the input and of the result.
fn print_report(product: &TriangulateProduct, max_added: Option<usize>, console: &Console) {
    let (report, triangulated) = (&product.report, &product.triangulated);
    let (given, between) = (report.vertices_given, report.vertices_for_quality);
    let refined = if between > 0 { format!(", {between} for angles and areas") } else { String::new() };
    console.line(format_args!(
        "vertices    {} ({given} in, {} added where segments cross{refined})",
        triangulated.nodes.points.len(),
        report.vertices_at_crossings
    ));
    if report.duplicates > 0 {
        console.line(format_args!(
            "            {} at the position of an earlier one, without a triangle",
            report.duplicates
        ));
    }
    let edges = triangulated.segments.len();
    console.line(format_args!(
        "segments    {} in, {edges} constrained edges out, including the boundary",
        report.segments_given
    ));
    let (all, kept) = (report.triangles_built, triangulated.triangles.len());
    let left_out = if kept < all { format!(" ({} outside or in holes removed)", all - kept) } else { String::new() };
    console.line(format_args!("triangles   {kept}{left_out}"));
    let limit = format!("left when {} vertices had been added (--max-added)", max_added.unwrap_or_default());
    for (why, text) in [
        (Shortfall::SmallAngle, "at small angles between segments"),
        (Shortfall::Limit, &limit),
        (Shortfall::Coordinates, "too small for the coordinates to resolve more vertices"),
    ] {
        let count = report.shortfall.iter().filter(|&&other| other == why).count();
        if count > 0 {
            console.warning(format_args!("{count} triangles are not as requested: {text}"));
        }
    }
    if all == 0 {
        console.warning("all vertices are on one line or at one position: there is no triangle");
    }
}
