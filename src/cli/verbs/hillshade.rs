use super::asked::Asked;
use crate::cli::input::args::HillshadeArgs;
use crate::cli::input::plan::{SurfacePlan, frame};
use crate::cli::report::console::Console;
use crate::error::Result;
use crate::run::{HillshadeOptions, LightOptions, WriteRequest};

/// Returns what is asked for: the shades of a TIN or a DEM.
pub(super) fn asked(args: &HillshadeArgs, console: &Console) -> Result<Asked> {
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let light = LightOptions {
        shading: args.shading.into(),
        azimuth: args.azimuth,
        altitude: args.altitude,
        z_factor: args.z_factor,
    };
    let options = HillshadeOptions {
        frame: args.overviews.of(frame(&args.cells.frame)?),
        method: args.cells.method.into(),
        light,
    };
    let targets = plan.driven_targets(&args.output, &args.driver);
    Ok(Asked {
        request: WriteRequest::new(plan.request, options),
        targets,
        tiles: args.tiles.clone(),
    })
}
