use clap::Args;

use crate::io::DriverOptions;

/// The driver of GDAL that writes the outputs.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "GDAL")]
pub(crate) struct DriverArgs {
    /// Driver of GDAL that writes the output (also `-of`), as `gdalinfo --formats` lists them
    ///
    /// Without it, the extension of the output selects a format of this program (see `--help`), or
    /// else a driver. A name of a format that this program writes, such as GTiff, means that one.
    /// Needs a build with the feature `gdal`.
    #[arg(long, value_name = "DRIVER")]
    pub(crate) of: Option<String>,

    /// Creation option of the driver (also `-co`; repeatable)
    ///
    /// `gdalinfo --format DRIVER` lists them. One that the driver does not have is an error.
    #[arg(long, value_name = "NAME=VALUE")]
    pub(crate) co: Vec<String>,

    /// Creation option of the layer that the driver writes (also `-lco`; repeatable)
    #[arg(long, value_name = "NAME=VALUE")]
    pub(crate) lco: Vec<String>,
}

impl DriverArgs {
    /// Returns the driver and its options.
    pub(crate) fn options(&self) -> DriverOptions {
        DriverOptions {
            name: self.of.clone(),
            creation: self.co.clone(),
            layer: self.lco.clone(),
        }
    }
}
