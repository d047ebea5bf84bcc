//! Writes profiles, as tables and plots.

use crate::data::Profiles;
use crate::error::{Error, Result};
use crate::io::bytes::output::Destination;
use crate::io::codec::profile;
pub use crate::io::options::plot::PlotOptions;

/// The extensions of the formats in which profiles are written: a table of exact numbers, a picture
/// and a drawing for CAD programs (DXF of release 12).
pub const EXTENSIONS: [&str; 3] = ["csv", "svg", "dxf"];

/// Writes profiles in the format that the extension of `target` names.
///
/// # Errors
/// If the extension is none of [`EXTENSIONS`], a file cannot be written, and for plots if the
/// datum is above a height, the exaggeration is not above zero or makes a plot much higher than it
/// is wide, or there are more than 1000 profiles or none.
pub fn write<'a>(
    target: impl Into<Destination<'a>>,
    profiles: &Profiles,
    options: &PlotOptions,
) -> Result<()> {
    let target = target.into();
    let path = target.format_path();
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    match extension.to_str() {
        Some("csv") => profile::write_csv(target, profiles),
        Some("svg") => profile::write_svg(target, profiles, options),
        Some("dxf") => profile::write_dxf(target, profiles, options),
        _ => Err(Error::usage("profiles are written as .csv, .svg or .dxf").in_file(target.path())),
    }
}
