//! Arguments of `contour`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::driver::DriverArgs;
use super::parse::{finite, not_negative, positive, smoothing};
use super::surface::SurfaceArgs;
use super::tiles::TileArgs;
use super::verbs::OutputArgs;
use crate::run::MapPreset;
use crate::terrain::LabelTops;

/// Draw contours of a TIN or of a DEM
///
/// Contours are drawn exactly on the triangles (of a DEM: between the centers of its cells), joined
/// to the longest possible lines, with higher ground on the right. The output is .shp (PolyLineZ
/// with field ELEV), .gpkg, .geojson or .dxf. Points may need more memory than there is: then the
/// work is done in tiles (--tiles, --memory).
///
/// For a map, lines are smoothed and simplified with a promise: none is off the surface by more
/// than the tolerance, none crosses another line or itself, and each breakline is crossed where the
/// heights along it say. Such lines have a field DEPRESSION.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline contour tile.laz --breaklines edges.shp --interval 0.5 -o contours.shp
  breakline contour dem.tif --levels 100,105.5,120 -o contours.geojson
  breakline contour tile.laz --preset cartographic --labels-output labels.shp -o contours.shp
  breakline contour dem.tif --interval 10 --bands -o bands.geojson")]
pub(crate) struct ContourArgs {
    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,
    #[command(flatten)]
    pub(crate) output: OutputArgs,

    /// Height between contours [default: 1]
    ///
    /// In the units of the heights.
    #[arg(long, value_name = "HEIGHT", value_parser = positive, allow_negative_numbers = true, help_heading = "Levels")]
    pub(crate) interval: Option<f64>,

    /// A height at which there is a contour; the others follow from the interval
    #[arg(long, value_name = "HEIGHT", value_parser = finite, default_value = "0", allow_hyphen_values = true, help_heading = "Levels")]
    pub(crate) base: f64,

    /// These heights instead of an interval, such as `100,105.5`
    #[arg(
        long,
        value_name = "HEIGHT,..",
        value_parser = finite,
        value_delimiter = ',',
        allow_hyphen_values = true,
        conflicts_with_all = ["interval", "base"],
        help_heading = "Levels"
    )]
    pub(crate) levels: Vec<f64>,

    #[command(flatten)]
    pub(crate) map: MapArgs,

    #[command(flatten)]
    pub(crate) tiles: TileArgs,
    #[command(flatten)]
    pub(crate) driver: DriverArgs,
}

/// How contours become those of a map.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Map")]
pub(crate) struct MapArgs {
    /// Rules that belong together
    ///
    /// `cartographic` is --smooth, --simplify with a twentieth of the interval, --min-area with 50
    /// times the square of the interval, and --index-every 5. Other options replace parts of it.
    #[arg(long, value_enum, value_name = "NAME")]
    pub(crate) preset: Option<PresetArg>,

    /// Smooth the lines, as far as they stay this near to the surface [default: half an interval]
    ///
    /// The largest difference in height along a line, in the units of the heights: at most half of
    /// the interval. Orienteering maps allow a quarter. Without a number, no file may follow.
    #[arg(long, value_name = "TOLERANCE", num_args = 0..=1, value_parser = smoothing, allow_negative_numbers = true)]
    pub(crate) smooth: Option<Option<f64>>,

    /// Leave out vertices that are this near to the line
    ///
    /// The heights along the line stay as near to the surface as --smooth says, or half of the
    /// interval.
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) simplify: Option<f64>,

    /// Leave out shorter lines, with what they enclose, unless a longer line is there
    #[arg(long, value_name = "LENGTH", value_parser = not_negative, allow_negative_numbers = true)]
    pub(crate) min_length: Option<f64>,

    /// Leave out lines that enclose less, or cut off less at the rim
    ///
    /// Also those that enclose a tenth of the interval in height at most, unless they enclose 20
    /// times the area. A line with a fifth of the area stays where the ground within rises or falls
    /// by an interval.
    #[arg(long, value_name = "AREA", value_parser = not_negative, allow_negative_numbers = true)]
    pub(crate) min_area: Option<f64>,

    /// Keep depressions, whatever area they have
    #[arg(long)]
    pub(crate) keep_depressions: bool,

    /// Mark every Nth level: field INDEX is 1 there, else 0
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) index_every: Option<u32>,

    /// Write the areas between the lines, as polygons with ELEV_MIN and ELEV_MAX
    ///
    /// Instead of the lines, which have no field INDEX then.
    #[arg(long)]
    pub(crate) bands: bool,

    /// Write lines and labels without heights, which the field ELEV has
    #[arg(long = "2d")]
    pub(crate) two_dimensions: bool,

    /// File for labels: points with ELEV and ROTATION
    ///
    /// On index lines, if any are marked, where they are straight; no label overlaps another one or
    /// another line. ROTATION is the direction of the text in degrees, counter-clockwise from east.
    /// The file may be that of the lines: a GeoPackage has a second layer then, a drawing texts.
    #[arg(long, value_name = "FILE")]
    pub(crate) labels_output: Option<PathBuf>,

    /// Where the tops of labels are
    #[arg(
        long,
        value_enum,
        value_name = "TOPS",
        default_value_t,
        requires = "labels_output"
    )]
    pub(crate) labels: LabelsArg,

    /// Height of labels on the ground [default: two intervals]
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true, requires = "labels_output")]
    pub(crate) label_height: Option<f64>,
}

/// Rules for contours that belong together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum PresetArg {
    /// Lines that can be printed
    Cartographic,
}

impl From<PresetArg> for MapPreset {
    fn from(arg: PresetArg) -> Self {
        match arg {
            PresetArg::Cartographic => MapPreset::Cartographic,
        }
    }
}

/// Where the tops of labels are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum LabelsArg {
    /// Up on the sheet: no label is upside down
    #[default]
    Readable,
    /// Uphill
    Uphill,
}

impl From<LabelsArg> for LabelTops {
    fn from(arg: LabelsArg) -> Self {
        match arg {
            LabelsArg::Readable => LabelTops::Readable,
            LabelsArg::Uphill => LabelTops::Uphill,
        }
    }
}
