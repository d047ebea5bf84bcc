use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::parse::{LevelSteps, finite, positive};
use super::surface::SurfaceArgs;
use super::tiles::MemoryArgs;
use crate::run::VolumeUnit;

/// Cut and fill between two surfaces, or above a level, exact on the triangles
///
/// The first input is the surface, the second its base: `cut` is what is above the base, `fill`
/// what is missing below it. Each is a TIN (.tin, .ply, .obj), a DEM (a surface between the centers
/// of its cells) or points, of which a TIN is built by the options below; those of several files
/// are a quoted glob or `@list.txt`. Options of building apply to all inputs of points. Where only
/// one of both is, nothing is counted; that area is printed. Volumes are in m3, heights in other
/// units than x and y are converted; without a coordinate system, in cubes of the unit of the data.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline volume june.laz may.laz --within site.shp --name-by LOT -o volumes.csv
  breakline volume ground.tin --plane 104.5 --swell 1.25 --shrink 0.9
  breakline volume lake.tin --levels 100:120:0.5 --json
  breakline volume flight.laz --class all --base rim --within stockpiles.shp")]
pub(crate) struct VolumeArgs {
    /// A level plane as the base
    #[arg(long, value_name = "Z", value_parser = finite, allow_negative_numbers = true, conflicts_with_all = ["levels", "base"], help_heading = "Volume")]
    pub(crate) plane: Option<f64>,

    /// A table by levels: FROM:TO:STEP
    ///
    /// For each level, `fill` is the volume below it and above the surface, `fill area` the area
    /// that it covers: the storage of a reservoir by stage, exact at each level.
    #[arg(
        long,
        value_name = "FROM:TO:STEP",
        allow_hyphen_values = true,
        conflicts_with = "base",
        help_heading = "Volume"
    )]
    pub(crate) levels: Option<LevelSteps>,

    /// Another base
    #[arg(long, value_enum, value_name = "BASE", help_heading = "Volume")]
    pub(crate) base: Option<BaseArg>,

    /// Polygons, with a row of volumes for each
    ///
    /// Finished surfaces are clipped by them, too: --boundary is for building. Rows have the number
    /// of the record, counted from 1. Lines count as polygons where they close to rings; a ring
    /// within another is a hole. `FILE:LAYER` names the layer of a file with several.
    #[arg(long, value_name = "FILE[:LAYER]", help_heading = "Volume")]
    pub(crate) within: Option<PathBuf>,

    /// Attribute of the polygons that names them: rows have its value besides the record
    #[arg(
        long,
        value_name = "FIELD",
        requires = "within",
        help_heading = "Volume"
    )]
    pub(crate) name_by: Option<String>,

    /// Unit of volumes; areas are in its squares [default: m3]
    #[arg(long, value_enum, value_name = "UNIT", help_heading = "Volume")]
    pub(crate) unit: Option<UnitArg>,

    /// Volume of loose ground, as a multiple of that in place: 1.25 if it swells by a quarter
    ///
    /// With this or --shrink there are three more numbers: `loose cut`, what is hauled; `bank
    /// fill`, the ground that the fill takes, in place; `balance`, the ground that is left over, in
    /// place.
    #[arg(long, value_name = "FACTOR", value_parser = positive, allow_negative_numbers = true, help_heading = "Volume")]
    pub(crate) swell: Option<f64>,

    /// Volume of compacted ground, as a multiple of that in place: 0.9 if it shrinks by a tenth
    #[arg(long, value_name = "FACTOR", value_parser = positive, allow_negative_numbers = true, help_heading = "Volume")]
    pub(crate) shrink: Option<f64>,

    /// Print a JSON object with exact numbers
    #[arg(long, help_heading = "Volume")]
    pub(crate) json: bool,

    /// Table to write (.csv), with exact numbers
    #[arg(short, long, value_name = "OUT.csv", help_heading = "Volume")]
    pub(crate) output: Option<PathBuf>,

    /// Replace a table that exists
    #[arg(long, help_heading = "Volume")]
    pub(crate) overwrite: bool,

    #[command(flatten)]
    pub(crate) surface: SurfaceArgs,

    #[command(flatten)]
    pub(crate) memory: MemoryArgs,
}

/// What may be a base besides a surface and a level.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum BaseArg {
    /// In each polygon of --within, the triangulation of its vertices, at the heights of the
    /// surface there: the ground under a stockpile that is outlined at its foot
    Rim,
}

/// A unit of volumes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum UnitArg {
    /// Cubic meters
    M3,
    /// Cubic yards of 0.9144 meters
    Yd3,
    /// Cubic feet of 0.3048 meters
    Ft3,
    /// Acre-feet of 43 560 cubic feet; areas are in acres
    AcreFt,
}

impl From<UnitArg> for VolumeUnit {
    fn from(arg: UnitArg) -> Self {
        match arg {
            UnitArg::M3 => VolumeUnit::CubicMeters,
            UnitArg::Yd3 => VolumeUnit::CubicYards,
            UnitArg::Ft3 => VolumeUnit::CubicFeet,
            UnitArg::AcreFt => VolumeUnit::AcreFeet,
        }
    }
}
