use super::asked::Asked;
use crate::cli::input::args::ContourArgs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::error::Result;
use crate::run::{ContourOptions, WriteRequest};

/// Returns what is asked for: the contours of a TIN or of a DEM.
pub(super) fn asked(args: &ContourArgs, console: &Console) -> Result<Asked> {
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let options = ContourOptions {
        interval: args.interval,
        base: args.base,
        levels: args.levels.clone(),
    };
    let targets = plan.targets(&args.output);
    Ok(Asked {
        request: WriteRequest::new(plan.request, options),
        targets,
        tiles: args.tiles.clone(),
    })
}
