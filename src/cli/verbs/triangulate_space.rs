//! Triangulation of points in space.

use crate::cli::Exit;
use crate::cli::input::args::TriangulateArgs;
use crate::cli::input::outputs::{self, Format, Target};
use crate::cli::report::console::Console;
use crate::cli::report::written::{commit, note_mesh};
use crate::error::{Error, Result};
use crate::io::Destination;
use crate::io::formats::Product;
use crate::run::{self, AlphaSolid, SpaceOptions, SpaceProduct};

/// What is written to an output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Family {
    Cells,
    Solid,
}

/// The formats of surfaces that also hold the surface of a solid; others have one height at each
/// position.
const OF_SOLIDS: [&str; 4] = ["ply", "obj", "off", "stl"];

/// Returns the formats of the outputs.
fn formats() -> Vec<Format<Family>> {
    let mut formats = outputs::formats_of(Product::Space, |_| Family::Cells);
    let surfaces = outputs::formats_of(Product::Surface, |_| Family::Solid);
    let of_solids = |format: &Format<Family>| OF_SOLIDS.contains(&format.extension);
    formats.extend(surfaces.into_iter().filter(of_solids));
    formats
}

/// Triangulates points in space.
pub(super) fn run(args: &TriangulateArgs, console: &Console) -> Result<Exit> {
    let path = &args.input;
    if let Some(option) = args.option_of_the_plane() {
        return Err(Error::usage(format!("{option} is for the plane only"))
            .in_file(path)
            .cure(format!("leave out {option}")));
    }
    let formats = formats();
    let weights = path.with_extension("weights");
    let read: Vec<_> = [Some(path.clone()), Some(weights).filter(|_| args.weighted)]
        .into_iter()
        .flatten()
        .collect();
    let outputs = outputs::resolve(&args.output, &formats[..], &read)?;
    let (solids, others): (Vec<_>, Vec<_>) = outputs
        .targets
        .iter()
        .partition(|target| target.kind == Family::Solid);
    match solids.first() {
        Some(target) if args.alpha.is_none() => {
            return Err(Error::usage(
                "this format has triangles only, and the result has tetrahedra",
            )
            .in_file(&target.path)
            .cure("add --alpha auto for the surface of a solid, or write .vtu, .mesh or .ele"));
        }
        None if args.alpha.is_some() => {
            return Err(Error::usage("no output is for the alpha shape")
                .cure("add -o NAME.ply, or leave out --alpha"));
        }
        _ => {}
    }
    let options = SpaceOptions {
        weighted: args.weighted,
        alpha: args.alpha,
        arithmetic: args.kernel.into(),
    };
    let product = run::triangulate_space(path, &options, &console.context())?;
    print_report(&product, console);
    for target in solids {
        let solid = product.solid.as_ref().ok_or_else(|| {
            Error::format(
                "all points are in one plane or fewer than four: there is no solid to write",
            )
            .in_file(&target.path)
            .cure("leave out --alpha")
        })?;
        let written = run::write_mesh(solid, target.within(&outputs.set), &console.context())?;
        note_mesh(&target.path, &written, "", console);
        if !solid.is_manifold() && target.extension == "stl" {
            console.warning(format_args!(
                "{}: not a closed manifold, as programs expect of STL",
                target.path.display()
            ));
        }
    }
    let mut files: Vec<Target<Family>> = Vec::new();
    for file in others.into_iter().flat_map(outputs::files_of) {
        if !files.contains(&file) {
            files.push(file);
        }
    }
    let files: Vec<Destination> = files.iter().map(|file| file.within(&outputs.set)).collect();
    product.write(&files, &console.context())?;
    commit(outputs, console)?;
    Ok(Exit::Done)
}

/// Prints the counts of the input and of the result.
fn print_report(product: &SpaceProduct, console: &Console) {
    let report = &product.report;
    console.line(format_args!("points      {}", report.points));
    if report.has_classes {
        console.note("points of all classes are used; `breakline points --class` selects some");
    }
    if report.is_in_degrees {
        console.warning("the points are in degrees, but not their heights: spheres, radii and volumes have no meaning");
    }
    if report.duplicates > 0 {
        console.line(format_args!(
            "            {} at the position of another one",
            report.duplicates
        ));
    }
    if report.hidden > 0 {
        console.line(format_args!(
            "            {} hidden by the weights of others",
            report.hidden
        ));
    }
    console.line(format_args!("dimension   {}", report.dimension));
    console.line(format_args!(
        "tetrahedra  {}",
        product.triangulated.tetrahedra.len()
    ));
    console.line(format_args!("volume      {}", report.volume));
    if let Some(solid) = &product.solid {
        print_solid(solid, console);
    } else if product.triangulated.tetrahedra.is_empty() {
        console.warning("all points are in one plane or fewer than four: there is no tetrahedron");
    }
}

fn print_solid(solid: &AlphaSolid, console: &Console) {
    let parts = if solid.parts == 1 { "part" } else { "parts" };
    console.line(format_args!(
        "alpha       {}: volume {}, {} {parts}, {} triangles",
        solid.alpha,
        solid.volume,
        solid.parts,
        solid.triangles.len()
    ));
    if !solid.is_manifold() {
        console.line(format_args!(
            "            touches itself at {} edges and {} vertices",
            solid.singular_edges, solid.singular_vertices
        ));
    }
}
