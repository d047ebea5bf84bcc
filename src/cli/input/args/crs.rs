use clap::Args;

use super::finite;
use super::systems::TransformArgs;

/// Show what a coordinate system is, or how one is transformed to another
///
/// With one system: its name, code, units, axes and heights, and its definition as WKT. With two:
/// all operations that PROJ knows from one to the other, the best first, with their accuracy, their
/// areas and the grids that they need, and which of them is used.
///
/// Coordinates are easting or longitude first, whatever the authority states.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline crs EPSG:25832+7837
  breakline crs site.prj
  breakline crs tile.laz EPSG:25832
  breakline crs EPSG:4979 EPSG:25832+7837 --at 9.5 48.5 620.4
  breakline crs EPSG:25832+ellipsoid EPSG:25832+7837 --require-grids")]
pub(crate) struct CrsArgs {
    /// System: `EPSG:25832`, `EPSG:25832+7837` (with heights), `EPSG:25832+ellipsoid`, WKT, or a
    /// file that states one
    #[arg(value_name = "FROM")]
    pub(crate) from: String,

    /// System that coordinates are transformed to; needs a build with PROJ (`--features proj`)
    #[arg(value_name = "TO")]
    pub(crate) to: Option<String>,

    /// Point to transform, with or without a height
    #[arg(
        long,
        value_names = ["X", "Y", "Z"],
        num_args = 2..=3,
        allow_negative_numbers = true,
        value_parser = finite,
        requires = "to"
    )]
    pub(crate) at: Option<Vec<f64>>,

    #[command(flatten)]
    pub(crate) transform: TransformArgs,

    /// Print a JSON object
    #[arg(long)]
    pub(crate) json: bool,
}
