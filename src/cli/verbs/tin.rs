use super::asked::Asked;
use crate::cli::input::args::TinArgs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::error::Result;
use crate::run::{SurfaceOptions, WriteRequest};

/// Returns what is asked for: a TIN as a mesh, or in parts.
pub(super) fn asked(args: &TinArgs, console: &Console) -> Result<Asked> {
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let targets = plan.targets(&args.output);
    Ok(Asked {
        request: WriteRequest::new(plan.request, SurfaceOptions),
        targets,
        tiles: args.tiles.clone(),
    })
}
