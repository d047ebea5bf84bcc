use super::asked::Asked;
use crate::cli::input::args::TinArgs;
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::error::Result;
use crate::run::{SurfaceOptions, WriteRequest, WrittenEdges};

/// Returns what is asked for: a TIN as a mesh, or in parts.
pub(super) fn asked(args: &TinArgs, console: &Console) -> Result<Asked> {
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let targets = plan.targets(&args.output);
    let edges = if args.plain {
        WrittenEdges::Plain
    } else {
        WrittenEdges::WithLines
    };
    Ok(Asked {
        request: WriteRequest::new(plan.request, SurfaceOptions { edges }),
        targets,
        tiles: args.tiles.clone(),
    })
}
