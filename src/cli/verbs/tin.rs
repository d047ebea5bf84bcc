use std::path::Path;

use crate::cli::Exit;
use crate::cli::input::args::{TileArgs, TilesArg, TinArgs};
use crate::cli::input::outputs::{self, Outputs};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::summary::print_surface;
use crate::cli::verbs::tiled::{self, Ran, Tiled};
use crate::error::{Error, Result};
use crate::io::formats::{self, Product};
use crate::run::{self, Division, TiledProduct};

/// Builds a TIN and writes it as a mesh, or in parts.
pub(in crate::cli) fn run(args: &TinArgs, console: &Console) -> Result<Exit> {
    let plan = requested(args, console)?;
    let outputs = outputs_of(args, &plan)?;
    if is_in_parts(&args.output.output[0]) {
        return run_in_parts(args, &plan, outputs, console);
    }
    if args.tiles.memory.is_some() {
        console.note("--memory has no effect: name the output .tins for a TIN in parts");
    }
    let product = run::triangles(&plan.request, &console.context())?;
    outputs.add_report(&plan, &product)?;
    for target in &outputs.targets {
        let written = run::write_mesh(product.triangles()?, target.within(&outputs.set), &console.context())?;
        outputs::note_mesh(&target.path, &written, ".ply keeps them", console);
    }
    print_surface(&product, console);
    outputs.commit(console)?;
    Ok(Exit::Done)
}

/// Returns the files to write, which can be written.
pub(super) fn outputs_of(args: &TinArgs, plan: &SurfacePlan) -> Result<Outputs<()>> {
    let outputs = outputs::resolve_with_report(&args.output, &outputs::formats_of(Product::Surface, |_| ()), plan)?;
    let in_parts = args.output.output.iter().find(|path| is_in_parts(path));
    match (in_parts, &args.output.output[..]) {
        (Some(path), [_, _, ..]) => Err(Error::usage("a TIN in parts is written alone")
            .in_file(path)
            .cure("write the others from it afterwards")),
        (None, [path, ..]) if args.tiles.are_asked_for() => {
            Err(Error::usage("tiles make a TIN in parts").in_file(path).cure("name the output .tins"))
        }
        _ => Ok(outputs),
    }
}

/// Returns what the arguments ask for.
pub(super) fn requested(args: &TinArgs, console: &Console) -> Result<SurfacePlan> {
    SurfacePlan::resolve(&args.surface, console)
}

fn is_in_parts(path: &Path) -> bool {
    formats::of_name(path).is_some_and(|format| format.extensions.contains(&"tins"))
}

fn run_in_parts(args: &TinArgs, plan: &SurfacePlan, outputs: Outputs<()>, console: &Console) -> Result<Exit> {
    let target = &outputs.targets[0];
    // Parts are those of tiles, even if all would fit into memory.
    let tiles = TileArgs { tiles: Some(args.tiles.tiles.unwrap_or(TilesArg(Division::Auto))), ..args.tiles.clone() };
    let Tiled::Ran(ran) = tiled::run(&tiles, plan, &TiledProduct::Surface, &outputs, console)? else {
        return Ok(Exit::Done);
    };
    let Ran { job, report, .. } = ran.as_ref();
    let written = job.write_surface(report, target.within(&outputs.set), &console.context())?;
    ran.print(console);
    let (folder, count) = (&written.index.folder, written.index.parts.len());
    console.line(format_args!("parts       {count}, in {}", target.path.with_file_name(folder).display()));
    let exit = ran.commit(outputs, console)?;
    written.keep()?;
    Ok(exit)
}
