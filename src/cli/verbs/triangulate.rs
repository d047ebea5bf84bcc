//! Triangulation of Triangle's files.

use super::triangulate_space;
use crate::cli::Exit;
use crate::cli::input::args::TriangulateArgs;
use crate::cli::input::inputs;
use crate::cli::input::outputs::{self, Format, Outputs, Target};
use crate::cli::report::console::Console;
use crate::cli::report::written::{commit, note_mesh};
use crate::error::{Error, Result};
use crate::io::Destination;
use crate::io::formats::Product;
use crate::run::{self, TriangulateOptions, TriangulateProduct};
use crate::triangulation::refine::Shortfall;

/// The family of formats that an output belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Family {
    Triangle,
    Mesh,
}

/// What is written beside an `.ele` whose input is a `.poly`: as with Triangle, also the segments.
const BESIDE_ELE_OF_POLY: &[&str] = &["node", "poly"];

/// Returns the formats of the outputs.
fn formats(is_poly: bool) -> Vec<Format<Family>> {
    let mut formats = outputs::formats_of(Product::Plane, |_| Family::Triangle);
    if let Some(ele) = formats
        .iter_mut()
        .find(|format| is_poly && format.extension == "ele")
    {
        ele.companions = BESIDE_ELE_OF_POLY;
    }
    formats.extend(outputs::formats_of(Product::Surface, |_| Family::Mesh));
    formats
}

/// Triangulates a `.node` or `.poly` file.
pub(crate) fn run(args: &TriangulateArgs, console: &Console) -> Result<Exit> {
    let path = &args.input;
    inputs::require([path])?;
    if args.space || run::is_of_space(path) {
        return triangulate_space::run(args, console);
    }
    if let Some(option) = args.option_of_space() {
        return Err(Error::usage(format!("{option} is for points in space"))
            .in_file(path)
            .cure("add --3d"));
    }
    let is_poly = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("poly"));
    let formats = formats(is_poly);
    let outputs = outputs::resolve(&args.output, &formats[..], std::slice::from_ref(path))?;
    let product = run::triangulate(path, &options(args), &console.context())?;
    if product.report.triangles_built == 0
        && let Some(mesh) = outputs
            .targets
            .iter()
            .find(|target| target.kind == Family::Mesh)
    {
        return Err(Error::format("all vertices are on one line or at one position: there is no triangle to write")
            .in_file(&mesh.path)
            .cure("add a vertex off the line; .node, .poly and .ele can also store vertices without triangles"));
    }
    write(&outputs, &product, console)?;
    print_report(&product, args.max_added, console);
    commit(outputs, console)?;
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
        arithmetic: args.kernel.into(),
    }
}

/// Writes meshes and Triangle's files, the latter with their companions, each once.
fn write(outputs: &Outputs<Family>, product: &TriangulateProduct, console: &Console) -> Result<()> {
    let (meshes, others): (Vec<_>, Vec<_>) = outputs
        .targets
        .iter()
        .partition(|target| target.kind == Family::Mesh);
    if !meshes.is_empty() {
        let mesh = product.to_mesh()?;
        for target in meshes {
            let written = run::write_mesh(&mesh, target.within(&outputs.set), &console.context())?;
            note_mesh(&target.path, &written, ".ply and .poly keep them", console);
        }
    }
    let mut files: Vec<Target<Family>> = Vec::new();
    for file in others.into_iter().flat_map(outputs::files_of) {
        if !files.contains(&file) {
            files.push(file);
        }
    }
    let files: Vec<Destination> = files.iter().map(|file| file.within(&outputs.set)).collect();
    product.write(&files, &console.context())
}

/// Prints the counts of the input and of the result.
fn print_report(product: &TriangulateProduct, max_added: Option<usize>, console: &Console) {
    let (report, triangulated) = (&product.report, &product.triangulated);
    let (given, between) = (report.vertices_given, report.vertices_for_quality);
    let refined = if between > 0 {
        format!(", {between} for angles and areas")
    } else {
        String::new()
    };
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
    let left_out = if kept < all {
        format!(" ({} outside or in holes removed)", all - kept)
    } else {
        String::new()
    };
    console.line(format_args!("triangles   {kept}{left_out}"));
    let limit = format!(
        "left when {} vertices had been added (--max-added)",
        max_added.unwrap_or_default()
    );
    for (why, text) in [
        (Shortfall::SmallAngle, "at small angles between segments"),
        (Shortfall::Limit, &limit),
        (
            Shortfall::Coordinates,
            "too small for the coordinates to resolve more vertices",
        ),
    ] {
        let count = report
            .shortfall
            .iter()
            .filter(|&&other| other == why)
            .count();
        if count > 0 {
            console.warning(format_args!(
                "{count} triangles are not as requested: {text}"
            ));
        }
    }
    if all == 0 {
        console.warning("all vertices are on one line or at one position: there is no triangle");
    }
}
