use super::asked::Asked;
use crate::cli::input::args::{
    AspectArgs, CurvatureArg, CurvatureArgs, QuantityArgs, RoughnessArgs, SlopeArgs, TpiArgs,
    TriArgs,
};
use crate::cli::input::plan::{SurfacePlan, frame};
use crate::cli::report::console::Console;
use crate::error::Result;
use crate::run::{QuantityOptions, WriteRequest};
use crate::terrain::Quantity;

/// Returns what `slope` asks for.
pub(super) fn slope(args: &SlopeArgs, console: &Console) -> Result<Asked> {
    let formula = args.formula.into();
    let quantity = match args.percent {
        true => Quantity::SlopePercent(formula),
        false => Quantity::SlopeDegrees(formula),
    };
    asked(&args.common, quantity, args.scale.z_factor, console)
}

/// Returns what `aspect` asks for.
pub(super) fn aspect(args: &AspectArgs, console: &Console) -> Result<Asked> {
    let quantity = Quantity::Aspect(args.formula.into());
    asked(&args.common, quantity, args.scale.z_factor, console)
}

/// Returns what `curvature` asks for.
pub(super) fn curvature(args: &CurvatureArgs, console: &Console) -> Result<Asked> {
    let quantity = match args.formula {
        CurvatureArg::Profile => Quantity::ProfileCurvature,
        CurvatureArg::Plan => Quantity::PlanCurvature,
    };
    asked(&args.common, quantity, args.scale.z_factor, console)
}

/// Returns what `roughness` asks for.
pub(super) fn roughness(args: &RoughnessArgs, console: &Console) -> Result<Asked> {
    asked(&args.common, Quantity::Roughness, None, console)
}

/// Returns what `tri` asks for.
pub(super) fn tri(args: &TriArgs, console: &Console) -> Result<Asked> {
    let quantity = Quantity::Ruggedness(args.formula.into());
    asked(&args.common, quantity, None, console)
}

/// Returns what `tpi` asks for.
pub(super) fn tpi(args: &TpiArgs, console: &Console) -> Result<Asked> {
    asked(&args.common, Quantity::Position, None, console)
}

fn asked(
    args: &QuantityArgs,
    quantity: Quantity,
    z_factor: Option<f64>,
    console: &Console,
) -> Result<Asked> {
    let plan = SurfacePlan::resolve(&args.surface, console)?;
    let options = QuantityOptions {
        quantity,
        frame: args.overviews.of(frame(&args.cells.frame)?),
        method: args.cells.method.into(),
        z_factor,
    };
    let targets = plan.driven_targets(&args.output, &args.driver);
    Ok(Asked {
        request: WriteRequest::new(plan.request, options),
        targets,
        tiles: args.tiles.clone(),
    })
}
