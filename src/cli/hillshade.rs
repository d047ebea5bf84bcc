use super::args::{FrameArgs, HillshadeArgs};
use super::gather::Ground;
use super::open::{self, Light, ShadeFormat};
use super::outputs::{self, Format};
use super::plan::SurfacePlan;
use super::raster::{self, Watched};
use super::summary::SurfaceFacts;
use super::talk::Talk;
use super::units::{Units, number};
use super::{Exit, gather};
use crate::crs::Crs;
use crate::data::BlockSource;
use crate::error::{Error, Result};

const FORMATS: &[Format<ShadeFormat>] = &[
    Format { extension: "tif", kind: ShadeFormat::GeoTiff, companions: &[] },
    Format { extension: "tiff", kind: ShadeFormat::GeoTiff, companions: &[] },
    Format { extension: "png", kind: ShadeFormat::Png, companions: &[] },
];

/// Shades a TIN or a DEM.
pub(super) fn run(args: &HillshadeArgs, talk: &Talk) -> Result<Exit> {
    let mut plan = SurfacePlan::resolve(&args.surface, talk)?;
    plan.inputs.extend(args.frame.align_to.clone());
    let targets = outputs::resolve(&args.output, FORMATS, &plan.inputs)?;
    match gather::ground(&mut plan, talk)? {
        Ground::Surface(gathered) => {
            let surface = gathered.surface.as_ref();
            let frame = raster::frame(&args.frame, SurfaceFacts::of(surface).extent, surface.crs(), talk)?;
            let shade = open::shade_of_surface(surface, frame, light(args, surface.crs(), talk));
            write(&targets, shade.as_ref(), talk)?;
            gathered.made.tell(surface, talk);
            talk.line(format_args!("raster      {}", raster::describe(&frame, surface.crs())));
        }
        Ground::Raster(grid) => {
            refuse_frame(&args.frame)?;
            let shade = open::shade_of_grid(&grid, light(args, grid.crs.as_ref(), talk));
            write(&targets, shade.as_ref(), talk)?;
            talk.line(format_args!("raster      {}", raster::describe(&grid.frame, grid.crs.as_ref())));
        }
    }
    outputs::tell(&targets, talk);
    Ok(Exit::Done)
}

fn write(targets: &[outputs::Target<ShadeFormat>], shade: &dyn BlockSource, talk: &Talk) -> Result<()> {
    for target in targets {
        let watched = Watched::new(shade, "shading cells", talk);
        open::write_shade(&target.path, target.kind, &watched).map_err(|e| e.in_file(&target.path))?;
    }
    Ok(())
}

fn light(args: &HillshadeArgs, crs: Option<&Crs>, talk: &Talk) -> Light {
    let z_factor = args.z_factor.unwrap_or_else(|| {
        let factor = Units::of(crs).height_in_plan();
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
