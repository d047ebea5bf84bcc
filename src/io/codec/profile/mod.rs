//! Profiles: as a table, a picture and a drawing.

mod csv;
mod drawing;
mod layout;
mod svg;

use std::io::Write;

use self::layout::Layout;
use crate::data::Profiles;
use crate::error::Result;
use crate::io::bytes::output::Destination;
use crate::io::options::plot::PlotOptions;

/// Writes the points of profiles as a table (CSV) of exact numbers.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write_csv(target: Destination, profiles: &Profiles) -> Result<()> {
    target.write_with(|out| csv::write(out, profiles))
}

/// Draws profiles as a picture (SVG), one below the other.
///
/// # Errors
/// Those of the layout, see [`PlotOptions`], and if the file cannot be written.
pub(crate) fn write_svg(
    target: Destination,
    profiles: &Profiles,
    options: &PlotOptions,
) -> Result<()> {
    let layout = Layout::new(profiles, options).map_err(|e| e.in_file(target.path()))?;
    let drawing = svg::drawing(profiles, &layout, options.title.as_deref());
    target.write_with(|out| out.write_all(drawing.as_bytes()))
}

/// Draws profiles as a DXF drawing, one below the other: distances are x, heights y.
///
/// # Errors
/// Those of [`write_svg`].
pub(crate) fn write_dxf(
    target: Destination,
    profiles: &Profiles,
    options: &PlotOptions,
) -> Result<()> {
    let layout = Layout::new(profiles, options).map_err(|e| e.in_file(target.path()))?;
    target.write_with(|out| drawing::write(out, profiles, &layout, options.title.as_deref()))
}
