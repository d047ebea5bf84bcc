use std::path::PathBuf;

use clap::Args;

use super::driver::DriverArgs;
use super::parse::{not_negative, positive};
use super::surface::SurfaceArgs;
use super::tiles::MemoryArgs;
use super::verbs::{FrameArgs, MethodArg, OverviewArgs};
use crate::run::CompareOptions;

/// Difference of two surfaces: in numbers, in cells, and where it is largest
///
/// Heights of the first input minus those of the second, in the cells of a raster: those of an
/// input that is a raster (of the first, if both are), or cells as for `dem`. Each input is a TIN
/// (.tin, .ply, .obj), a DEM, or points, of which a TIN is built by the options below; those of
/// several files are a quoted glob or `@list.txt`. Only cells on both surfaces count.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline compare june.laz may.laz --resolution 0.5 -o difference.tif
  breakline compare delivered.tif check.tin --worst 20 --json
  breakline compare new.tif old.tif --changed 0.25
  breakline compare june.tin may.tin --changed 0.25 --min-area 10 -o changed.shp
  breakline compare --classes filtered.laz delivered.laz")]
pub(crate) struct CompareArgs {
    /// Compare the classes of the same points in two files, in the same order
    ///
    /// Counts points by their classes in both files. The second file is the reference: type I is
    /// the share of its ground points (class 2) that are not ground in the first file, type II the
    /// share of its other points that are. Only --json can be added.
    #[arg(long, conflicts_with_all = ["changed", "min_area", "output"], help_heading = "Comparison")]
    pub(crate) classes: bool,

    /// How many of the places with the largest differences are listed
    ///
    /// They are at least 8 cells apart.
    #[arg(
        long,
        value_name = "N",
        default_value_t = CompareOptions::WORST,
        help_heading = "Comparison"
    )]
    pub(crate) worst: usize,

    /// Also count the cells that differ by more than a height, and their area
    ///
    /// With an output of polygons, also find the areas that differ by more, exact on the triangles
    /// of both inputs. Attributes of each are CHANGE (raised or lowered), AREA, VOLUME (between
    /// both), LARGEST (the largest difference), and where that is, LARGEST_X and LARGEST_Y.
    #[arg(long, value_name = "HEIGHT", value_parser = positive, allow_negative_numbers = true, help_heading = "Comparison")]
    pub(crate) changed: Option<f64>,

    /// Find the areas that differ, and leave out those that are smaller than this
    ///
    /// In m2 if units are known, else in squares of the unit of x and y.
    #[arg(long, value_name = "AREA", value_parser = not_negative, allow_negative_numbers = true, requires = "changed", help_heading = "Comparison")]
    pub(crate) min_area: Option<f64>,

    /// Print a JSON object with exact numbers
    #[arg(long, help_heading = "Comparison")]
    pub(crate) json: bool,

    /// File to write (repeatable): .tif has the difference in each cell; .shp, .gpkg,
    /// .geojson, .geojsonl and .dxf have the areas that differ, as polygons
    #[arg(short, long, value_name = "OUT", help_heading = "Comparison")]
    pub(crate) output: Vec<PathBuf>,

    /// Replace files that exist
    #[arg(long, help_heading = "Comparison")]
    pub(crate) overwrite: bool,

    /// How heights between the vertices are computed, as in `dem`
    #[arg(
        long,
        value_enum,
        value_name = "METHOD",
        default_value_t,
        help_heading = "Raster"
    )]
    pub(crate) method: MethodArg,

    #[command(flatten)]
    pub(crate) frame: FrameArgs,

    #[command(flatten)]
    pub(crate) overviews: OverviewArgs,

    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,

    #[command(flatten)]
    pub(crate) memory: MemoryArgs,

    #[command(flatten)]
    pub(crate) driver: DriverArgs,
}
