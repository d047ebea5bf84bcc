use crate::cli::Exit;
use crate::cli::input::args::HillshadeArgs;
use crate::cli::input::outputs::{self, Outputs};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::cli::report::summary::{print_extent, print_surface};
use crate::cli::verbs::tiled::{self, Tiled};
use crate::error::Result;
use crate::io::formats::{Content, Product};
use crate::io::geotiff::COPIES_ON_DISK;
use crate::run::{self, CellProduct, HillshadeOptions, LightOptions, Model, TiledProduct};

/// The file formats of a hillshade.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ShadeFormat {
    GeoTiff,
    Png,
}

/// Shades a TIN or a DEM.
pub(in crate::cli) fn run(args: &HillshadeArgs, console: &Console) -> Result<Exit> {
    let (plan, options) = requested(args, console)?;
    let outputs = outputs_of(args, &plan)?;
    let tiled = TiledProduct::Shades(options.clone());
    match tiled::run(&args.tiles, &plan, &tiled, &outputs, console)? {
        Tiled::Whole => {}
        Tiled::Planned => return Ok(Exit::Done),
        Tiled::Ran(ran) => {
            write(&ran.job.cells(&ran.report, &console.context())?, &outputs, console)?;
            ran.print(console);
            return ran.commit(outputs, console);
        }
    }
    let product = run::surface(&plan.request, &console.context())?;
    outputs.add_report(&plan, &product)?;
    let cells = run::hillshade(&product, &options, &console.context())?;
    write(&cells, &outputs, console)?;
    match &product.model {
        // The size of the raster is printed already.
        Model::Raster(grid) => print_extent(grid.extent(), grid.crs.as_ref(), console),
        Model::Tin(_) | Model::Mesh(_) | Model::Compact(_) | Model::Parts(_) => print_surface(&product, console),
    }
    outputs.commit(console)?;
    Ok(Exit::Done)
}

/// Returns the files to write, which can be written.
pub(super) fn outputs_of(args: &HillshadeArgs, plan: &SurfacePlan) -> Result<Outputs<ShadeFormat>> {
    let formats = outputs::formats_of(Product::Shades, |format| match format.content {
        Content::Picture => ShadeFormat::Png,
        _ => ShadeFormat::GeoTiff,
    });
    outputs::resolve_with_report(&args.output, &formats, plan)
}

/// Returns what the arguments ask for.
pub(super) fn requested(args: &HillshadeArgs, console: &Console) -> Result<(SurfacePlan, HillshadeOptions)> {
    let mut plan = SurfacePlan::resolve(&args.surface, console)?;
    let frame = plan.add_frame(&args.frame)?;
    let light = LightOptions { azimuth: args.azimuth, altitude: args.altitude, z_factor: args.z_factor };
    Ok((plan, HillshadeOptions { frame, method: args.method.into(), light }))
}

fn write(cells: &CellProduct, outputs: &Outputs<ShadeFormat>, console: &Console) -> Result<()> {
    outputs.announce(cells, cell_bytes, console)?;
    for target in &outputs.targets {
        let destination = target.within(&outputs.set);
        match target.kind {
            ShadeFormat::GeoTiff => cells.write(destination, &console.context()).map(drop)?,
            ShadeFormat::Png => cells.write_picture(destination, &console.context())?,
        }
    }
    Ok(())
}

/// Returns the bytes of a cell before compression, and how many times they are on the disk.
fn cell_bytes(format: &ShadeFormat) -> (u64, f64) {
    match format {
        ShadeFormat::GeoTiff => (1, COPIES_ON_DISK),
        // Gray and alpha.
        ShadeFormat::Png => (2, 1.0),
    }
}
