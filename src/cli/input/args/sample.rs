use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::surface::SurfaceArgs;
use super::tiles::MemoryArgs;
use super::verbs::MethodArg;
use crate::run::SampledField;

/// Add heights, slopes and gradients of a surface to points
///
/// Each point of --at gets the height of the surface: as a new column of text, extra dimension of
/// LAS or LAZ, field of a shapefile or property of GeoJSON. All that the file has is kept byte by
/// byte. Heights are those that a DEM has in cells with their centers at the points. Points outside
/// of the surface are kept, with empty fields (NaN in LAS, null in GeoJSON). The surface is a TIN
/// (.tin, .ply, .obj), a DEM (between the centers of its cells) or points, of which a TIN is built
/// by the options below. Without -o, text goes to stdout.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline sample ground.tin --at trees.csv -o trees_with_heights.csv
  breakline sample dem.tif --at poles.txt --add height,slope,aspect -o poles_on_ground.txt
  breakline sample ground.tin --at flight.laz -o flight_with_ground.laz
  zcat huge.csv.gz | breakline sample ground.tin --at - > huge_with_heights.csv")]
pub(crate) struct SampleArgs {
    /// Points: text with x and y, LAS, LAZ, a shapefile or GeoJSON; `-` is text from stdin
    ///
    /// Columns of text are those that a header names, or --columns, else the first two.
    /// All lines need as many fields as the header.
    #[arg(long, value_name = "FILE", help_heading = "Sample")]
    pub(crate) at: PathBuf,

    /// What is added
    #[arg(
        long,
        value_enum,
        value_name = "FIELD,..",
        value_delimiter = ',',
        default_value = "height",
        help_heading = "Sample"
    )]
    pub(crate) add: Vec<FieldArg>,

    /// What the names of the new columns begin with
    #[arg(
        long,
        value_name = "TEXT",
        default_value = "",
        hide_default_value = true,
        help_heading = "Sample"
    )]
    pub(crate) prefix: String,

    /// How heights between the vertices are computed
    ///
    /// Slopes and gradients are those of the triangles, and need `linear`.
    #[arg(
        long,
        value_enum,
        value_name = "METHOD",
        default_value_t,
        help_heading = "Sample"
    )]
    pub(crate) method: MethodArg,

    /// Print a JSON object with the counts; the points go to a file
    #[arg(long, requires = "output", help_heading = "Sample")]
    pub(crate) json: bool,

    /// File to write, in the format of the points [default: stdout, for text and GeoJSON]
    #[arg(short, long, value_name = "OUT", help_heading = "Sample")]
    pub(crate) output: Option<PathBuf>,

    /// Replace a file that exists
    #[arg(long, help_heading = "Sample")]
    pub(crate) overwrite: bool,

    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,

    #[command(flatten)]
    pub(crate) memory: MemoryArgs,
}

/// What is added to a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum FieldArg {
    /// The height: `surface_z`
    Height,
    /// The slope in degrees: `slope`
    Slope,
    /// The slope in percent: `slope_pct`; 100 is 45 degrees
    SlopePercent,
    /// The direction of fall in degrees clockwise from north: `aspect`; empty where it is level
    Aspect,
    /// The rise per unit of x and of y: `gradient_x` and `gradient_y`
    Gradient,
    /// How far the point is above the surface: `HeightAboveGround`; for LAS and LAZ
    HeightAbove,
}

impl From<FieldArg> for SampledField {
    fn from(arg: FieldArg) -> Self {
        match arg {
            FieldArg::Height => SampledField::Height,
            FieldArg::Slope => SampledField::Slope,
            FieldArg::SlopePercent => SampledField::SlopePercent,
            FieldArg::Aspect => SampledField::Aspect,
            FieldArg::Gradient => SampledField::Gradient,
            FieldArg::HeightAbove => SampledField::Above,
        }
    }
}
