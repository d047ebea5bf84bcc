//! Output files that appear complete or not at all, alone, as a set, or as a folder.

mod driver;
mod file;
mod folder;
mod set;
mod target;
mod temporary;

pub use driver::DriverOptions;
pub(crate) use driver::OutputDriver;
pub(crate) use file::followed;
pub use file::{Output, is_standard_output, is_stream, probe, remove_abandoned, require_absent};
pub(crate) use folder::{FolderKind, OutputFolder};
#[cfg(feature = "gdal")]
pub(crate) use set::Deferred;
pub use set::{Destination, OutputSet};
pub(crate) use temporary::Temporary;
pub use temporary::{Abandoned, abandon_outputs};
