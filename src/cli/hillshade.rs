use super::args::{FrameArgs, HillshadeArgs};
use super::gather::Ground;
use super::open::{self, ShadeFormat};
use super::outputs::{self, Format, Outputs};
use super::plan::SurfacePlan;
use super::progress::Watched;
use super::raster;
use super::summary::tell_place;
use super::talk::Talk;
use super::{Exit, gather, inputs};
use crate::crs::Crs;
use crate::data::BlockSource;
use crate::error::{Error, Result};
use crate::run::units::number;
use crate::terrain::{Hillshade, Light};

pub(super) const FORMATS: &[Format<ShadeFormat>] = &[
    Format { extension: "tif", kind: ShadeFormat::GeoTiff, companions: &[] },
    Format { extension: "tiff", kind: ShadeFormat::GeoTiff, companions: &[] },
    Format { extension: "png", kind: ShadeFormat::Png, companions: &["pgw", "png.aux.xml"] },
];

/// Shades a TIN or a DEM.
pub(super) fn run(args: &HillshadeArgs, talk: &Talk) -> Result<Exit> {
    let mut plan = SurfacePlan::resolve(&args.surface, talk)?;
    inputs::require(&args.frame.align_to)?;
    plan.inputs.extend(args.frame.align_to.clone());
    let outputs = outputs::resolve_with_report(&args.output, FORMATS, &plan)?;
    match gather::ground(&mut plan, &outputs.set, talk)? {
        Ground::Surface(gathered) => {
            let surface = gathered.surface.as_ref();
            let frame = raster::frame(&args.frame, &gathered, talk)?;
            raster::announce(&outputs, cell_bytes, &frame, (surface.crs(), Some(surface)), talk)?;
            shade(open::dem(surface, frame)?.as_ref(), args, &outputs, talk)?;
            gathered.made.tell(surface, talk);
        }
        Ground::Raster(grid) => {
            refuse_frame(&args.frame)?;
            raster::announce(&outputs, cell_bytes, &grid.frame, (grid.crs.as_ref(), None), talk)?;
            shade(grid.as_ref(), args, &outputs, talk)?;
            tell_place(raster::extent_of(&grid), grid.crs.as_ref(), talk);
        }
    }
    outputs.commit(talk)?;
    Ok(Exit::Done)
}

/// What a cell takes before compression.
fn cell_bytes(format: &ShadeFormat) -> u64 {
    match format {
        ShadeFormat::GeoTiff => 1,
        // Gray and alpha.
        ShadeFormat::Png => 2,
    }
}

fn shade(heights: &dyn BlockSource, args: &HillshadeArgs, outputs: &Outputs<ShadeFormat>, talk: &Talk) -> Result<()> {
    let shade = Hillshade::new(heights, light(args, heights.crs(), talk))?;
    for target in &outputs.targets {
        let watched = Watched::cells(&shade, "shading cells", talk);
        open::write_shade(target.within(&outputs.set), target.kind, &watched)?;
    }
    Ok(())
}

fn light(args: &HillshadeArgs, crs: Option<&Crs>, talk: &Talk) -> Light {
    let z_factor = args.z_factor.unwrap_or_else(|| {
        let factor = Light::for_crs(crs).z_factor;
        if factor != 1.0 {
            talk.note(format_args!("heights are multiplied by {} to match the plan (--z-factor)", number(factor)));
        }
        factor
    });
    Light { azimuth: args.azimuth, altitude: args.altitude, z_factor }
}

fn refuse_frame(args: &FrameArgs) -> Result<()> {
    if args.resolution.is_none() && args.te.is_none() && args.align_to.is_none() {
        return Ok(());
    }
    Err(Error::usage("--resolution, --te and --align-to are for a TIN; a DEM keeps its own cells"))
}
