use super::Exit;
use super::args::DemArgs;
use super::outputs;
use super::plan::SurfacePlan;
use super::summary::tell_surface;
use super::talk::Talk;
use crate::error::Result;
use crate::io::formats::Product;
use crate::run;
use crate::run::units::Units;

/// Writes heights of a TIN as a raster.
pub(super) fn run(args: &DemArgs, talk: &Talk) -> Result<Exit> {
    let mut plan = SurfacePlan::resolve(&args.surface, talk)?;
    let frame = plan.add_frame(&args.frame)?;
    let outputs = outputs::resolve_with_report(&args.output, &outputs::formats_of(Product::Heights, |_| ()), &plan)?;
    let product = run::triangles(&plan.request, &talk.context())?;
    outputs.add_report(&plan, &product)?;
    let cells = run::dem(&product, &frame, &talk.context())?;
    outputs.announce(&cells, |()| 4, talk)?;
    let mut written = None;
    for target in &outputs.targets {
        written = Some(cells.write(target.within(&outputs.set), &talk.context())?);
    }
    tell_surface(&product, talk);
    if written.as_ref().is_some_and(|cells| cells.valid == 0) {
        talk.warning("no cell has a height");
    }
    if let Some(cells) = written.filter(|cells| cells.valid > 0) {
        let units = Units::of(product.crs());
        let (low, high) = (units.height(cells.min), units.height(cells.max));
        talk.line(format_args!("            {} with a height, from {low} to {high}", cells.valid));
    }
    outputs.commit(talk)?;
    Ok(Exit::Done)
}
