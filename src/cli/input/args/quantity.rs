//! The options of verbs that compute a quantity in cells.

use clap::{Args, ValueEnum};

use super::driver::DriverArgs;
use super::parse::positive;
use super::surface::SurfaceArgs;
use super::tiles::TileArgs;
use super::verbs::{CellArgs, OutputArgs, OverviewArgs};
use crate::terrain::{Gradient, Ruggedness};

/// What all of them have.
#[derive(Debug, Clone, Args)]
pub(crate) struct QuantityArgs {
    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
    #[command(flatten)]
    pub(crate) cells: CellArgs,
    #[command(flatten)]
    pub(crate) overviews: OverviewArgs,
    #[command(flatten)]
    pub(crate) tiles: TileArgs,
    #[command(flatten)]
    pub(crate) driver: DriverArgs,
}

/// The factor for heights.
#[derive(Debug, Clone, Args)]
pub(crate) struct ScaleArgs {
    /// Factor for heights [default: 1, or what converts them to the units of x and y]
    ///
    /// By default, heights in feet over coordinates in metres are multiplied by 0.3048, and degrees
    /// are taken as the lengths that they have in the middle of the raster, shorter in x than in y.
    #[arg(
        long,
        value_name = "FACTOR",
        value_parser = positive,
        allow_negative_numbers = true,
        help_heading = "Raster"
    )]
    pub(crate) z_factor: Option<f64>,
}

/// From which cells a gradient is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum GradientArg {
    /// All eight cells around, weighted: Horn (1981), for rough surfaces
    #[default]
    Horn,
    /// The four cells beside: Zevenbergen and Thorne (1987), for smooth surfaces
    #[value(alias = "ZevenbergenThorne")]
    ZevenbergenThorne,
    /// None: the triangle that has the center of the cell, of points, a TIN or a mesh
    Faces,
}

impl From<GradientArg> for Gradient {
    fn from(arg: GradientArg) -> Self {
        match arg {
            GradientArg::Horn => Gradient::Horn,
            GradientArg::ZevenbergenThorne => Gradient::ZevenbergenThorne,
            GradientArg::Faces => Gradient::Faces,
        }
    }
}

/// Compute the slope in cells, in degrees or percent
///
/// From the 3 x 3 cells around each cell, as gdaldem does. A TIN is drawn as a DEM first; a DEM
/// keeps its cells. At the edge of the data the surface is extended linearly. With --formula faces,
/// each cell has the slope of the triangle at its center.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline slope dem.tif -o slope.tif
  breakline slope tiles/*.laz --resolution 1 --percent -o slope.tif
  breakline slope design.tin --resolution 0.5 --formula faces -o slope.tif")]
pub(crate) struct SlopeArgs {
    #[command(flatten)]
    pub(crate) common: QuantityArgs,
    #[command(flatten)]
    pub(crate) scale: ScaleArgs,
    /// Percent instead of degrees: 100 is 45 degrees
    #[arg(long, help_heading = "Raster")]
    pub(crate) percent: bool,
    /// From which cells the gradient is computed
    #[arg(
        long,
        value_enum,
        value_name = "FORMULA",
        default_value_t,
        help_heading = "Raster"
    )]
    pub(crate) formula: GradientArg,
}

/// Compute the direction of fall in cells, in degrees clockwise from north
///
/// From the 3 x 3 cells around each cell, as gdaldem does. Level cells have no value.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline aspect dem.tif -o aspect.tif")]
pub(crate) struct AspectArgs {
    #[command(flatten)]
    pub(crate) common: QuantityArgs,
    #[command(flatten)]
    pub(crate) scale: ScaleArgs,
    /// From which cells the gradient is computed
    #[arg(
        long,
        value_enum,
        value_name = "FORMULA",
        default_value_t,
        help_heading = "Raster"
    )]
    pub(crate) formula: GradientArg,
}

/// Which curvature is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum CurvatureArg {
    /// Along the steepest slope: positive where it gets steeper on the way down
    #[default]
    Profile,
    /// Across the steepest slope: positive on spurs, negative in valleys
    Plan,
}

/// Compute the curvature in cells, per unit of length
///
/// From the 3 x 3 cells around each cell, by Zevenbergen and Thorne (1987). Level cells have 0.
/// (Some programs multiply by 100.)
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline curvature dem.tif --formula plan -o curvature.tif")]
pub(crate) struct CurvatureArgs {
    #[command(flatten)]
    pub(crate) common: QuantityArgs,
    #[command(flatten)]
    pub(crate) scale: ScaleArgs,
    /// Which curvature is computed
    #[arg(
        long,
        value_enum,
        value_name = "FORMULA",
        default_value_t,
        help_heading = "Raster"
    )]
    pub(crate) formula: CurvatureArg,
}

/// Compute the roughness in cells: the highest minus the lowest of 3 x 3 cells
///
/// In units of height.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline roughness dem.tif -o roughness.tif")]
pub(crate) struct RoughnessArgs {
    #[command(flatten)]
    pub(crate) common: QuantityArgs,
}

/// How ruggedness is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum RuggednessArg {
    /// Root of the sum of the squares of the eight differences: Riley and others (1999)
    #[default]
    Riley,
    /// Mean of the eight differences: Wilson and others (2007), for the sea floor
    Wilson,
}

impl From<RuggednessArg> for Ruggedness {
    fn from(arg: RuggednessArg) -> Self {
        match arg {
            RuggednessArg::Riley => Ruggedness::Riley,
            RuggednessArg::Wilson => Ruggedness::Wilson,
        }
    }
}

/// Compute the terrain ruggedness index in cells
///
/// From the differences of the eight cells around each cell and the one between, in units of
/// height.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline tri dem.tif -o tri.tif")]
pub(crate) struct TriArgs {
    #[command(flatten)]
    pub(crate) common: QuantityArgs,
    /// How it is computed
    #[arg(
        long,
        value_enum,
        value_name = "FORMULA",
        default_value_t,
        help_heading = "Raster"
    )]
    pub(crate) formula: RuggednessArg,
}

/// Compute the topographic position index in cells
///
/// The height of each cell above the mean of the eight cells around it, in units of height.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline tpi dem.tif -o tpi.tif")]
pub(crate) struct TpiArgs {
    #[command(flatten)]
    pub(crate) common: QuantityArgs,
}
