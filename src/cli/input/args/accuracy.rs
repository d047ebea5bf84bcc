use std::path::PathBuf;

use clap::Args;

use super::surface::SurfaceArgs;
use super::tiles::MemoryArgs;
use super::verbs::MethodArg;
use crate::run::HeightMeasure;

/// Assess the vertical accuracy of a surface by checkpoints
///
/// In the terms of the ASPRS Positional Accuracy Standards for Digital Geospatial Data, edition 2
/// (2023): differences are the surface minus the checkpoint; the RMSE of the product contains that
/// of the checkpoints themselves (--checkpoint-error). Printed are n, mean, median, standard
/// deviation, RMSE, NMAD, the 95th percentile of the amounts, skew and a histogram. The surface is
/// a TIN (.tin, .ply, .obj), a DEM (between the centers of its cells) or points, of which a TIN is
/// built by the options below.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline accuracy ground.tin --checkpoints survey.csv
  breakline accuracy dem.tif --checkpoints survey.csv --checkpoint-error 2cm --accuracy-class 10cm
  breakline accuracy ground.tin --checkpoints survey.csv --group-by cover --vegetated forest,brush -o points.csv")]
pub(crate) struct AccuracyArgs {
    /// Points that are known better: text, a layer (FILE:FIELD takes heights from a field), or LAS
    ///
    /// Columns of text are those that a header names, or --columns, else the first three. `-` is
    /// text from stdin.
    #[arg(long, value_name = "FILE", help_heading = "Accuracy")]
    pub(crate) checkpoints: PathBuf,

    /// The RMSE of heights that the surface must not exceed, such as `10cm`
    ///
    /// With a unit (mm, cm, m, in, ft) or in the unit of the heights. The exit code is 1 if it is
    /// exceeded. With --vegetated, the other checkpoints decide.
    #[arg(
        long,
        value_name = "RMSE",
        allow_hyphen_values = true,
        help_heading = "Accuracy"
    )]
    pub(crate) accuracy_class: Option<HeightMeasure>,

    /// The RMSE of the checkpoints themselves, such as `2cm` [default: 0]
    #[arg(
        long,
        value_name = "RMSE",
        allow_hyphen_values = true,
        help_heading = "Accuracy"
    )]
    pub(crate) checkpoint_error: Option<HeightMeasure>,

    /// Statistics by a field of the checkpoints, such as land cover
    ///
    /// A column of text, an attribute of a layer, or `class` of LAS.
    #[arg(long, value_name = "FIELD", help_heading = "Accuracy")]
    pub(crate) group_by: Option<String>,

    /// Groups in vegetation: their accuracy is printed, and does not decide
    #[arg(
        long,
        value_name = "GROUP,..",
        value_delimiter = ',',
        requires = "group_by",
        help_heading = "Accuracy"
    )]
    pub(crate) vegetated: Vec<String>,

    /// How heights between the vertices are computed
    #[arg(
        long,
        value_enum,
        value_name = "METHOD",
        default_value_t,
        help_heading = "Accuracy"
    )]
    pub(crate) method: MethodArg,

    /// Print a JSON object with exact numbers
    #[arg(long, help_heading = "Accuracy")]
    pub(crate) json: bool,

    /// Table to write (.csv), with a row for each checkpoint
    #[arg(short, long, value_name = "OUT.csv", help_heading = "Accuracy")]
    pub(crate) output: Option<PathBuf>,

    /// Table to write (.csv), with the bins of the histogram
    #[arg(long, value_name = "OUT.csv", help_heading = "Accuracy")]
    pub(crate) histogram: Option<PathBuf>,

    /// Replace tables that exist
    #[arg(long, help_heading = "Accuracy")]
    pub(crate) overwrite: bool,

    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,

    #[command(flatten)]
    pub(crate) memory: MemoryArgs,
}
