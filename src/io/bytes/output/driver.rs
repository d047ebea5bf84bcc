//! Which driver of GDAL writes an output.

#[cfg(feature = "gdal")]
use std::path::Path;
use std::path::PathBuf;

#[cfg(feature = "gdal")]
use super::require_absent;
#[cfg(feature = "gdal")]
use crate::error::{Error, Result};

/// The driver of GDAL that writes outputs, and what it is given. By default the extension of an
/// output selects its format.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct DriverOptions {
    /// The short name of the driver, as `gdalinfo --formats` lists it. That of a format which this
    /// crate writes itself, such as `GTiff`, selects that format.
    #[serde(default)]
    pub name: Option<String>,
    /// Creation options of the data set, each `NAME=VALUE`.
    #[serde(default)]
    pub creation: Vec<String>,
    /// Creation options of its layer, each `NAME=VALUE`.
    #[serde(default)]
    pub layer: Vec<String>,
}

impl DriverOptions {
    /// Returns true if nothing is chosen.
    pub fn is_default(&self) -> bool {
        *self == DriverOptions::default()
    }
}

/// A driver that was found for one output, and the files that it must not replace: which ones it
/// writes is known when it has written them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OutputDriver {
    /// The short name of the driver.
    pub(crate) name: String,
    /// Creation options of the data set.
    pub(crate) creation: Vec<String>,
    /// Creation options of the layer.
    pub(crate) layer: Vec<String>,
    /// True if files that exist may be replaced.
    pub(crate) replaces: bool,
    /// Files that are read, by their [canonical](std::path::Path::canonicalize) paths.
    pub(crate) read: Vec<PathBuf>,
}

#[cfg(feature = "gdal")]
impl OutputDriver {
    /// Returns an error if a file may not be written, because something that should stay is there.
    ///
    /// # Errors
    /// If it is read, or it exists and is not to be replaced.
    pub(crate) fn require_free(&self, file: &Path) -> Result<()> {
        if !self.replaces {
            return require_absent(file);
        }
        match file.canonicalize() {
            Ok(path) if self.read.contains(&path) => Err(Error::usage(
                "the driver writes this file, too, which is one of the inputs",
            )
            .in_file(file)
            .cure("give the output another name")),
            _ => Ok(()),
        }
    }
}
