use crate::cli::Exit;
use crate::cli::input::args::TinArgs;
use crate::cli::input::outputs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::summary::print_surface;
use crate::error::Result;
use crate::io::formats::Product;
use crate::run;

/// Builds a TIN and writes it as a mesh.
pub(in crate::cli) fn run(args: &TinArgs, console: &Console) -> Result<Exit> {
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let outputs = outputs::resolve_with_report(&args.output, &outputs::formats_of(Product::Surface, |_| ()), &plan)?;
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
