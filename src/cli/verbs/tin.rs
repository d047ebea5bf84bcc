use super::asked::Asked;
use crate::cli::input::args::{
    LimitArgs, OutputArgs, SimplifyArgs, SurfaceArgs, TileArgs, TinArgs,
};
use crate::cli::input::plan::SurfacePlan;
use crate::cli::report::console::Console;
use crate::error::Result;
use crate::run::{SurfaceOptions, WriteRequest, WrittenEdges};
use crate::terrain::{SimplifyLimit, SimplifyRule};

/// Returns what is asked for: a TIN as a mesh, or in parts.
pub(super) fn asked(args: &TinArgs, console: &Console) -> Result<Asked> {
    let options = options(args.plain, &args.limit);
    request(
        &args.surface,
        options,
        &args.output,
        args.tiles.clone(),
        console,
    )
}

/// Returns what is asked for: a simplified TIN.
pub(super) fn simplified(args: &SimplifyArgs, console: &Console) -> Result<Asked> {
    let options = options(args.plain, &args.limit);
    request(
        &args.surface,
        options,
        &args.output,
        TileArgs::default(),
        console,
    )
}

fn request(
    surface: &SurfaceArgs,
    options: SurfaceOptions,
    output: &OutputArgs,
    tiles: TileArgs,
    console: &Console,
) -> Result<Asked> {
    let plan = SurfacePlan::resolve(surface, console)?;
    let targets = plan.targets(output);
    Ok(Asked {
        request: WriteRequest::new(plan.request, options),
        targets,
        tiles,
    })
}

fn options(is_plain: bool, limit: &LimitArgs) -> SurfaceOptions {
    SurfaceOptions {
        edges: if is_plain {
            WrittenEdges::Plain
        } else {
            WrittenEdges::WithLines
        },
        simplify: rule(limit),
    }
}

/// Returns how far the surface is simplified, if it is.
fn rule(args: &LimitArgs) -> Option<SimplifyRule> {
    let limit = match (args.max_error, args.target) {
        (Some(bound), _) => SimplifyLimit::MaxError(bound),
        (None, Some(target)) => SimplifyLimit::Target(target),
        (None, None) => return None,
    };
    Some(SimplifyRule {
        limit,
        line_tolerance: args.line_tolerance,
    })
}
