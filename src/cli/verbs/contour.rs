use crate::cli::Exit;
use crate::cli::input::args::ContourArgs;
use crate::cli::input::outputs::{self, Outputs};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::summary::{counted, print_surface};
use crate::cli::verbs::tiled::{self, Ran, Tiled};
use crate::crs::Crs;
use crate::error::Result;
use crate::io::Destination;
use crate::io::contours::ContourSummary;
use crate::io::formats::Product;
use crate::run::units::Units;
use crate::run::{self, ContourOptions, TiledProduct};

/// Draws contours of a TIN or of a DEM.
pub(in crate::cli) fn run(args: &ContourArgs, console: &Console) -> Result<Exit> {
    let (plan, options) = requested(args, console)?;
    let outputs = outputs_of(args, &plan)?;
    let tiled = TiledProduct::Contours(options.clone());
    match tiled::run(&args.tiles, &plan, &tiled, &outputs, console)? {
        Tiled::Whole => {}
        Tiled::Planned => return Ok(Exit::Done),
        Tiled::Ran(ran) => {
            let Ran { job, report, .. } = ran.as_ref();
            let drawn = write_all(&outputs, console, |target| job.write_contours(report, target, &console.context()))?;
            ran.print(console);
            print_contours(&drawn, report.crs.as_ref(), console);
            return ran.commit(outputs, console);
        }
    }
    let product = run::surface(&plan.request, &console.context())?;
    outputs.add_report(&plan, &product)?;
    let contours = run::contour(&product, &options, &console.context())?;
    let drawn = write_all(&outputs, console, |target| contours.write(target, &console.context()))?;
    print_surface(&product, console);
    print_contours(&drawn, product.crs(), console);
    outputs.commit(console)?;
    Ok(Exit::Done)
}

/// Returns the files to write, which can be written.
pub(super) fn outputs_of(args: &ContourArgs, plan: &SurfacePlan) -> Result<Outputs<()>> {
    outputs::resolve_with_report(&args.output, &outputs::formats_of(Product::Contours, |_| ()), plan)
}

/// Returns what the arguments ask for. Wrong levels are an error before anything is read.
pub(super) fn requested(args: &ContourArgs, console: &Console) -> Result<(SurfacePlan, ContourOptions)> {
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let options = ContourOptions { interval: args.interval, base: args.base, levels: args.levels.clone() };
    options.to_levels()?;
    Ok((plan, options))
}

fn write_all(
    outputs: &Outputs<()>,
    console: &Console,
    write: impl Fn(Destination) -> Result<ContourSummary>,
) -> Result<ContourSummary> {
    let mut drawn = ContourSummary::default();
    for target in &outputs.targets {
        drawn = write(target.within(&outputs.set))?;
        drawn.warnings.iter().for_each(|text| console.warning(format_args!("{}: {text}", target.path.display())));
    }
    Ok(drawn)
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
