use clap::Args;

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
}
