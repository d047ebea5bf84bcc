use std::path::PathBuf;

use clap::Args;

use super::driver::DriverArgs;
use super::parse::positive;
use super::surface::SurfaceArgs;
use super::tiles::MemoryArgs;
use super::verbs::OutputArgs;

/// Give lines the heights of a surface, at every edge that they cross, or by a step
///
/// The surface is a TIN (.tin, .ply, .obj), a DEM (a surface between the centers of its cells) or
/// points, of which a TIN is built by the options below. Each line gets a vertex wherever it
/// crosses an edge of a triangle, so that it lies on the surface everywhere. Attributes are kept;
/// heights of the lines themselves are not used. A line that leaves the surface is written as the
/// parts that are on it, with a warning. Outputs are .shp, .gpkg, .geojson, .geojsonl and .dxf.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline drape ground.tin --lines roads.shp -o roads3d.shp
  breakline drape dem.tif --lines trails.geojson --step 10 -o trails3d.geojson")]
pub(crate) struct DrapeArgs {
    /// Lines to drape; of polygons, the rings are used
    ///
    /// `FILE:LAYER` names the layer of a file with several.
    #[arg(
        long,
        required = true,
        value_name = "FILE[:LAYER]",
        help_heading = "Lines"
    )]
    pub(crate) lines: PathBuf,

    /// Distance of heights along a line [default: one at each edge of a triangle]
    ///
    /// In the units of the coordinate system, from the start of each line; its vertices stay.
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true, help_heading = "Lines")]
    pub(crate) step: Option<f64>,

    /// Print a JSON object with counts
    #[arg(long, help_heading = "Lines")]
    pub(crate) json: bool,

    #[command(flatten)]
    pub(crate) output: OutputArgs,

    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,

    #[command(flatten)]
    pub(crate) memory: MemoryArgs,
    #[command(flatten)]
    pub(crate) driver: DriverArgs,
}
