//! The options of `color-relief`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::driver::DriverArgs;
use super::surface::SurfaceArgs;
use super::tiles::TileArgs;
use super::verbs::{CellArgs, OutputArgs};
use crate::data::ColorMatch;

/// Draw the heights of a TIN or a DEM in colors
///
/// By a ramp of colors that is built in, or from a file as gdaldem reads it. The output is a
/// GeoTIFF (.tif) or a .png with red, green, blue and opacity. Cells without a height are
/// transparent. The relief of a DEM has the cells of the DEM: `--resolution`, `--te`, `--align-to`
/// and `--method` are for TINs.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline color-relief ground.ply --resolution 0.5 -o colors.png
  breakline color-relief dem.tif --ramp ramp.txt --match nearest -o colors.tif")]
pub(crate) struct ColorReliefArgs {
    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,

    /// Colors: `elevation`, `gray`, `viridis`, or a file
    ///
    /// Each line of a file has a height, or a part of the range of all cells such as `25%`, or `nv`
    /// for cells without a height; then red, green and blue from 0 to 255, and opacity if there is
    /// any; or the name of a color. The ramps that are built in go from the lowest to the highest
    /// of all cells.
    #[arg(
        long,
        value_name = "RAMP",
        value_hint = clap::ValueHint::FilePath,
        default_value = "elevation",
        help_heading = "Colors"
    )]
    pub(crate) ramp: PathBuf,

    /// Colors of heights between those of the ramp
    #[arg(
        id = "match",
        long = "match",
        value_enum,
        value_name = "MATCH",
        default_value_t,
        help_heading = "Colors"
    )]
    pub(crate) matching: MatchArg,

    #[command(flatten)]
    pub(crate) cells: CellArgs,
    #[command(flatten)]
    pub(crate) tiles: TileArgs,
    #[command(flatten)]
    pub(crate) driver: DriverArgs,
}

/// The colors of heights between those of a ramp.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum MatchArg {
    /// In proportion between the colors below and above
    #[default]
    Linear,
    /// That of the nearest height of the ramp
    Nearest,
    /// None: other heights are transparent
    Exact,
}

impl From<MatchArg> for ColorMatch {
    fn from(arg: MatchArg) -> Self {
        match arg {
            MatchArg::Linear => ColorMatch::Linear,
            MatchArg::Nearest => ColorMatch::Nearest,
            MatchArg::Exact => ColorMatch::Exact,
        }
    }
}
