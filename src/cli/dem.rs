use super::args::DemArgs;
use super::outputs::{self, Format};
use super::plan::SurfacePlan;
use super::progress::Watched;
use super::raster;
use super::talk::Talk;
use super::{Exit, gather, inputs, open};
use crate::error::Result;
use crate::run::units::Units;

pub(super) const FORMATS: &[Format<()>] =
    &[Format { extension: "tif", kind: (), companions: &[] }, Format { extension: "tiff", kind: (), companions: &[] }];

/// Writes heights of a TIN as a raster.
pub(super) fn run(args: &DemArgs, talk: &Talk) -> Result<Exit> {
    let mut plan = SurfacePlan::resolve(&args.surface, talk)?;
    inputs::require(&args.frame.align_to)?;
    plan.inputs.extend(args.frame.align_to.clone());
    let outputs = outputs::resolve_with_report(&args.output, FORMATS, &plan)?;
    let gathered = gather::surface(&mut plan, &outputs.set, talk)?;
    let surface = gathered.surface.as_ref();
    let frame = raster::frame(&args.frame, &gathered, talk)?;
    raster::announce(&outputs, |()| 4, &frame, (surface.crs(), Some(surface)), talk)?;
    let dem = open::dem(surface, frame)?;
    let mut written = None;
    for target in &outputs.targets {
        let watched = Watched::cells(dem.as_ref(), "writing cells", talk);
        written = Some(open::write_heights(target.within(&outputs.set), &watched)?);
    }
    gathered.made.tell(surface, talk);
    if written.as_ref().is_some_and(|cells| cells.valid == 0) {
        talk.warning("no cell has a height");
    }
    if let Some(cells) = written.filter(|cells| cells.valid > 0) {
        let units = Units::of(surface.crs());
        let (low, high) = (units.height(cells.min), units.height(cells.max));
        talk.line(format_args!("            {} with a height, from {low} to {high}", cells.valid));
    }
    outputs.commit(talk)?;
    Ok(Exit::Done)
}
