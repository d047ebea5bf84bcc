use super::Exit;
use super::args::HillshadeArgs;
use super::outputs::{self, Format};
use super::plan::SurfacePlan;
use super::summary::{tell_place, tell_surface};
use super::talk::Talk;
use crate::error::Result;
use crate::run::{self, HillshadeOptions, LightOptions, Model};

/// The file formats of a hillshade.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ShadeFormat {
    GeoTiff,
    Png,
}

pub(super) const FORMATS: &[Format<ShadeFormat>] = &[
    Format { extension: "tif", kind: ShadeFormat::GeoTiff, companions: &[] },
    Format { extension: "tiff", kind: ShadeFormat::GeoTiff, companions: &[] },
    Format { extension: "png", kind: ShadeFormat::Png, companions: &["pgw", "png.aux.xml"] },
];

/// Shades a TIN or a DEM.
pub(super) fn run(args: &HillshadeArgs, talk: &Talk) -> Result<Exit> {
    let mut plan = SurfacePlan::resolve(&args.surface, talk)?;
    let frame = plan.add_frame(&args.frame)?;
    let light = LightOptions { azimuth: args.azimuth, altitude: args.altitude, z_factor: args.z_factor };
    let outputs = outputs::resolve_with_report(&args.output, FORMATS, &plan)?;
    let product = run::surface(&plan.request, &talk.context())?;
    outputs.add_report(&plan, &product)?;
    let cells = run::hillshade(&product, &HillshadeOptions { frame, light }, &talk.context())?;
    outputs.announce(&cells, cell_bytes, talk)?;
    for target in &outputs.targets {
        let destination = target.within(&outputs.set);
        match target.kind {
            ShadeFormat::GeoTiff => cells.write(destination, &talk.context()).map(drop)?,
            ShadeFormat::Png => cells.write_picture(destination, &talk.context())?,
        }
    }
    match &product.model {
        // Its cells were announced.
        Model::Raster(grid) => tell_place(grid.extent(), grid.crs.as_ref(), talk),
        Model::Tin(_) | Model::Mesh(_) => tell_surface(&product, talk),
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
