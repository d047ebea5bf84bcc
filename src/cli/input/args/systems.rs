use clap::Args;

use super::finite;
use crate::run::proj::TransformOptions;

/// Coordinate systems of the input and of the result.
#[derive(Debug, Clone, Args)]
pub(crate) struct SystemArgs {
    /// Coordinate system to assign to the input, such as `EPSG:25832`
    ///
    /// Overrides what the files state. Nothing is reprojected. Without this option, a file that
    /// states no system is taken to be in that of the others, and two different systems are an
    /// error.
    #[arg(long, value_name = "CRS", help_heading = "Coordinate system")]
    pub(crate) a_srs: Option<String>,

    /// Coordinate system to reproject points and lines to
    ///
    /// Needs a build with PROJ (`--features proj`).
    #[arg(long, value_name = "CRS", help_heading = "Coordinate system")]
    pub(crate) t_srs: Option<String>,
    #[command(flatten)]
    pub(crate) transform: TransformArgs,
}

/// How coordinates are reprojected.
#[derive(Debug, Clone, Args)]
pub(crate) struct TransformArgs {
    /// Stop if a grid is missing that the best operation needs
    ///
    /// Heights between vertical systems, and some datums, need grids that are installed separately.
    /// Without this option, a warning names the grid, and heights keep their datum.
    #[arg(long, help_heading = "Coordinate system")]
    pub(crate) require_grids: bool,

    /// Epoch of the coordinates, in years such as 2021.5
    ///
    /// For operations that depend on it, between coordinates that move with a plate and others.
    /// Without this option, that of the input is used if it states one.
    #[arg(long, value_name = "YEAR", value_parser = finite, help_heading = "Coordinate system")]
    pub(crate) epoch: Option<f64>,
}

impl From<&TransformArgs> for TransformOptions {
    fn from(args: &TransformArgs) -> Self {
        TransformOptions {
            require_grids: args.require_grids,
            epoch: args.epoch,
        }
    }
}
