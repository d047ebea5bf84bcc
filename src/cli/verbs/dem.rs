use crate::cli::Exit;
use crate::cli::input::args::DemArgs;
use crate::cli::input::outputs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::summary::print_surface;
use crate::error::Result;
use crate::io::formats::Product;
use crate::run::units::Units;
use crate::run::{self, DemOptions};

/// Writes the heights of a TIN as a raster.
pub(in crate::cli) fn run(args: &DemArgs, console: &Console) -> Result<Exit> {
    let mut plan = SurfacePlan::resolve(&args.surface, console)?;
    let frame = plan.add_frame(&args.frame)?;
    let outputs = outputs::resolve_with_report(&args.output, &outputs::formats_of(Product::Heights, |_| ()), &plan)?;
    let product = run::triangles(&plan.request, &console.context())?;
    outputs.add_report(&plan, &product)?;
    let options = DemOptions { frame, method: args.method.into() };
    let cells = run::dem(&product, &options, &console.context())?;
    outputs.announce(&cells, |()| 4, console)?;
    let mut written = None;
    for target in &outputs.targets {
        written = Some(cells.write(target.within(&outputs.set), &console.context())?);
    }
    print_surface(&product, console);
    match written {
        Some(cells) if cells.valid > 0 => {
            let units = Units::of(product.crs());
            let (low, high) = (units.height(cells.min), units.height(cells.max));
            console.line(format_args!("            {} with a height, from {low} to {high}", cells.valid));
        }
        Some(_) => console.warning("no cell has a height"),
        None => {}
    }
    outputs.commit(console)?;
    Ok(Exit::Done)
}
