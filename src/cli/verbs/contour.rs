use crate::cli::Exit;
use crate::cli::input::args::ContourArgs;
use crate::cli::input::outputs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::summary::{counted, print_surface};
use crate::crs::Crs;
use crate::error::Result;
use crate::io::contours::ContourSummary;
use crate::io::formats::Product;
use crate::run::units::Units;
use crate::run::{self, ContourOptions};

/// Draws contours of a TIN or of a DEM.
pub(in crate::cli) fn run(args: &ContourArgs, console: &Console) -> Result<Exit> {
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let outputs = outputs::resolve_with_report(&args.output, &outputs::formats_of(Product::Contours, |_| ()), &plan)?;
    let options = ContourOptions { interval: args.interval, base: args.base, levels: args.levels.clone() };
    // Wrong levels are an error before anything is read.
    options.to_levels()?;
    let product = run::surface(&plan.request, &console.context())?;
    outputs.add_report(&plan, &product)?;
    let contours = run::contour(&product, &options, &console.context())?;
    let mut drawn = ContourSummary::default();
    for target in &outputs.targets {
        drawn = contours.write(target.within(&outputs.set), &console.context())?;
        drawn.warnings.iter().for_each(|text| console.warning(format_args!("{}: {text}", target.path.display())));
    }
    print_surface(&product, console);
    print_contours(&drawn, product.crs(), console);
    outputs.commit(console)?;
    Ok(Exit::Done)
}

fn print_contours(drawn: &ContourSummary, crs: Option<&Crs>, console: &Console) {
    if drawn.lines == 0 {
        return console.warning("no contour crosses the surface at these levels");
    }
    let units = Units::of(crs);
    let (low, high) = (units.height(drawn.bounds.min[2]), units.height(drawn.bounds.max[2]));
    let lines = counted(drawn.lines as u64, "line");
    console.line(format_args!("contours    {lines} ({} closed) from {low} to {high}", drawn.closed));
}
