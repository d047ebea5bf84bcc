use super::asked::Asked;
use crate::cli::input::args::DemArgs;
use crate::cli::input::plan::{SurfacePlan, frame};
use crate::cli::report::console::Console;
use crate::error::Result;
use crate::run::{DemOptions, WriteRequest};

/// Returns what is asked for: the heights of a TIN as a raster.
pub(super) fn asked(args: &DemArgs, console: &Console) -> Result<Asked> {
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let options = DemOptions {
        frame: args.overviews.of(frame(&args.cells.frame)?),
        method: args.cells.method.into(),
    };
    let targets = plan.driven_targets(&args.output, &args.driver);
    Ok(Asked {
        request: WriteRequest::new(plan.request, options),
        targets,
        tiles: args.tiles.clone(),
    })
}
