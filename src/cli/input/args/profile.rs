use std::path::PathBuf;

use clap::Args;

use super::parse::{finite, not_negative, positive, station};
use super::surface::SurfaceArgs;
use super::tiles::MemoryArgs;
use crate::run::StationFormat;

/// Heights of surfaces along lines, or cross-sections of them, as a table, a plot or a drawing
///
/// Each input is a surface of its own: a TIN (.tin, .ply, .obj), a DEM (a surface between the
/// centers of its cells) or points, of which a TIN is built by the options below; one of several
/// files is a quoted glob or `@list.txt`. A profile has a point at every edge of a triangle that
/// the line crosses, so that it is exact everywhere. Where the line is not on a surface, there is a
/// gap. With --interval or --stations, there are sections across each line instead.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline profile ground.tin design.tin --along axis.shp -o profile.svg -o profile.csv
  breakline profile dem.tif --along track.geojson --step 10 --json
  breakline profile ground.tin --along axis.shp --interval 20 --left 15 --right 15 -o sections.dxf")]
pub(crate) struct ProfileArgs {
    /// Lines to follow; of polygons, the rings are used
    ///
    /// `FILE:LAYER` names the layer of a file with several.
    #[arg(
        long,
        required = true,
        value_name = "FILE[:LAYER]",
        help_heading = "Profile"
    )]
    pub(crate) along: PathBuf,

    /// Distance of points along a line [default: one at each edge of a triangle]
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true, help_heading = "Profile")]
    pub(crate) step: Option<f64>,

    /// Cross-sections at all multiples of this distance along each line
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true, conflicts_with = "stations", help_heading = "Sections")]
    pub(crate) interval: Option<f64>,

    /// Cross-sections at these stations, such as 1+250 or 1250, which have to be on each line
    #[arg(
        long,
        value_name = "STATION,..",
        value_delimiter = ',',
        value_parser = station,
        allow_hyphen_values = true,
        help_heading = "Sections"
    )]
    pub(crate) stations: Vec<f64>,

    /// Station at which each line begins [default: 0]
    #[arg(long, value_name = "STATION", value_parser = station, allow_hyphen_values = true, help_heading = "Sections")]
    pub(crate) start: Option<f64>,

    /// Length of sections to the left of the line, seen along it
    #[arg(long, value_name = "LENGTH", value_parser = not_negative, allow_negative_numbers = true, help_heading = "Sections")]
    pub(crate) left: Option<f64>,

    /// Length of sections to the right of the line
    #[arg(long, value_name = "LENGTH", value_parser = not_negative, allow_negative_numbers = true, help_heading = "Sections")]
    pub(crate) right: Option<f64>,

    /// Angle in degrees from the direction of the line to the left half of a section [default: 90]
    ///
    /// 90 is square to the line. At a vertex of the line, its direction is halfway between those of
    /// both segments.
    #[arg(long, value_name = "DEGREES", value_parser = positive, allow_negative_numbers = true, help_heading = "Sections")]
    pub(crate) angle: Option<f64>,

    /// How stations are written, by an example of zeros [default: 0+000]
    ///
    /// `0+000` writes 1250 as 1+250, `0+00.0` as 12+50.0, `0.00` as 1250.00.
    #[arg(long, value_name = "EXAMPLE", help_heading = "Sections")]
    pub(crate) station_format: Option<StationFormat>,

    /// By how much plots draw heights larger than distances [default: so that they can be seen]
    #[arg(long, value_name = "FACTOR", value_parser = positive, allow_negative_numbers = true, help_heading = "Plot")]
    pub(crate) exaggeration: Option<f64>,

    /// Height at which plots begin [default: a round height below the lowest point]
    #[arg(long, value_name = "Z", value_parser = finite, allow_negative_numbers = true, help_heading = "Plot")]
    pub(crate) datum: Option<f64>,

    /// Title above plots
    #[arg(long, value_name = "TEXT", help_heading = "Plot")]
    pub(crate) title: Option<String>,

    /// Print a JSON object with all points and exact numbers
    #[arg(long, help_heading = "Profile")]
    pub(crate) json: bool,

    /// File to write: a table (.csv), a plot (.svg) or a drawing (.dxf) (repeatable)
    #[arg(short, long, value_name = "OUT", help_heading = "Profile")]
    pub(crate) output: Vec<PathBuf>,

    /// Replace files that exist
    #[arg(long, help_heading = "Profile")]
    pub(crate) overwrite: bool,

    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,

    #[command(flatten)]
    pub(crate) memory: MemoryArgs,
}
