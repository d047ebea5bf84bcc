use crate::cli::Exit;
use crate::cli::input::args::DemArgs;
use crate::cli::input::outputs::{self, Outputs};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::summary::print_surface;
use crate::cli::verbs::tiled::{self, Tiled};
use crate::crs::Crs;
use crate::error::Result;
use crate::io::formats::Product;
use crate::io::geotiff::{COPIES_ON_DISK, RasterSummary};
use crate::run::units::Units;
use crate::run::{self, CellProduct, DemOptions, TiledProduct};

/// Writes the heights of a TIN as a raster.
pub(in crate::cli) fn run(args: &DemArgs, console: &Console) -> Result<Exit> {
    let (plan, options) = requested(args, console)?;
    let outputs = outputs_of(args, &plan)?;
    let tiled = TiledProduct::Heights(options.clone());
    match tiled::run(&args.tiles, &plan, &tiled, &outputs, console)? {
        Tiled::Whole => {}
        Tiled::Planned => return Ok(Exit::Done),
        Tiled::Ran(ran) => {
            let written = write(&ran.job.cells(&ran.report, &console.context())?, &outputs, console)?;
            ran.print(console);
            print_heights(written, ran.report.crs.as_ref(), console);
            return ran.commit(outputs, console);
        }
    }
    let product = run::triangles(&plan.request, &console.context())?;
    outputs.add_report(&plan, &product)?;
    let cells = run::dem(&product, &options, &console.context())?;
    let written = write(&cells, &outputs, console)?;
    print_surface(&product, console);
    print_heights(written, product.crs(), console);
    outputs.commit(console)?;
    Ok(Exit::Done)
}

/// Returns the files to write, which can be written.
pub(super) fn outputs_of(args: &DemArgs, plan: &SurfacePlan) -> Result<Outputs<()>> {
    outputs::resolve_with_report(&args.output, &outputs::formats_of(Product::Heights, |_| ()), plan)
}

/// Returns what the arguments ask for.
pub(super) fn requested(args: &DemArgs, console: &Console) -> Result<(SurfacePlan, DemOptions)> {
    let mut plan = SurfacePlan::resolve(&args.surface, console)?;
    let frame = plan.add_frame(&args.frame)?;
    Ok((plan, DemOptions { frame, method: args.method.into() }))
}

fn write(cells: &CellProduct, outputs: &Outputs<()>, console: &Console) -> Result<Option<RasterSummary>> {
    outputs.announce(cells, |()| (4, COPIES_ON_DISK), console)?;
    let mut written = None;
    for target in &outputs.targets {
        written = Some(cells.write(target.within(&outputs.set), &console.context())?);
    }
    Ok(written)
}

fn print_heights(written: Option<RasterSummary>, crs: Option<&Crs>, console: &Console) {
    match written {
        Some(cells) if cells.valid > 0 => {
            let units = Units::of(crs);
            let (low, high) = (units.height(cells.min), units.height(cells.max));
            console.line(format_args!("            {} with a height, from {low} to {high}", cells.valid));
        }
        Some(_) => console.warning("no cell has a height"),
        None => {}
    }
}
