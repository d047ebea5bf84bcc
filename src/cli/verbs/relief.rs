use super::asked::Asked;
use crate::cli::input::args::ColorReliefArgs;
use crate::cli::input::plan::{SurfacePlan, frame};
use crate::cli::report::console::Console;
use crate::error::Result;
use crate::run::{ColorReliefOptions, WriteRequest, color_ramp};

/// Returns what is asked for: the heights of a TIN or a DEM in colors.
pub(super) fn asked(args: &ColorReliefArgs, console: &Console) -> Result<Asked> {
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let options = ColorReliefOptions {
        matching: args.matching.into(),
        frame: frame(&args.cells.frame)?,
        method: args.cells.method.into(),
        ..ColorReliefOptions::new(color_ramp(&args.ramp)?)
    };
    let mut targets = plan.driven_targets(&args.output, &args.driver);
    targets
        .also_read
        .extend(Some(&args.ramp).filter(|ramp| ramp.is_file()).cloned());
    Ok(Asked {
        request: WriteRequest::new(plan.request, options),
        targets,
        tiles: args.tiles.clone(),
    })
}
