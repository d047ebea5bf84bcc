use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::parse::{ClassRange, ReturnRange};
use crate::run::memory_of;
use crate::terrain::ground::Bridges;

/// Classify the ground of lidar points, and keep every other byte of their files
///
/// Points on the terrain get class 2, others class 1. Only points of the classes 0, 1 and 2 are
/// classified, or those of --from-class; others keep their class, and so do points that are flagged
/// as withheld. The filter does not see them. Everything else stays as it is: the header with its
/// dates, all records, coordinates, flags, times, colors, extra bytes, waveforms, and the order of
/// the points. LAS stays LAS and LAZ stays LAZ, unless the extension of OUT says otherwise. COPC
/// becomes LAZ: its octree is left out.
///
/// Several files are one area: their points are filtered together, and each file is written for
/// itself. What needs more memory than --memory is filtered in tiles that overlap. Lengths are
/// meters, whatever the unit of the data; without a coordinate system, a unit is taken for a meter.
#[derive(Debug, Clone, Args)]
#[command(after_long_help = "\
Example:
  breakline ground raw.laz -o ground.laz
  breakline ground raw/*.laz -o classified --noise
  breakline ground delivered.laz --from-class 0-6 -o again.laz")]
pub(crate) struct GroundArgs {
    /// LAS, LAZ or COPC files, globs or `@list.txt`
    #[arg(required = true, value_name = "IN")]
    pub(crate) inputs: Vec<PathBuf>,

    /// File to write (.las, .laz), or a folder for a file for each input, of the same name
    ///
    /// A name without an extension is that of a folder, which is created if it does not exist. All
    /// files appear together at the end, or none.
    #[arg(short, long, required = true, value_name = "OUT")]
    pub(crate) output: PathBuf,

    /// Replace files that exist
    #[arg(long)]
    pub(crate) overwrite: bool,

    /// Classes to classify, such as `0-6` [default: 0,1,2]
    #[arg(
        long,
        value_name = "CLASS,..",
        value_delimiter = ',',
        help_heading = "Ground"
    )]
    pub(crate) from_class: Vec<ClassRange>,

    /// Returns that may be ground: `last`, `all`, or others as in `points` [default: all]
    ///
    /// Other returns get class 1, and the filter does not see them.
    #[arg(
        long = "return",
        alias = "returns",
        value_name = "RETURN,..",
        value_delimiter = ',',
        help_heading = "Ground"
    )]
    pub(crate) returns: Vec<ReturnRange>,

    /// Whether bridges are ground
    #[arg(
        long,
        value_enum,
        value_name = "ground|off",
        default_value_t,
        help_heading = "Ground"
    )]
    pub(crate) bridges: BridgesArg,

    /// Classify noise, too: far below the ground (class 7) and alone in the air (18)
    ///
    /// In point formats 0 to 5, which have no class 18, both get class 7.
    #[arg(long, help_heading = "Ground")]
    pub(crate) noise: bool,

    /// Memory for the points, such as `2GB` [default: half of what is free]
    ///
    /// The filter needs about 200 bytes for each point. What does not fit is filtered in tiles.
    /// Where two tiles do not agree, they are filtered again with more points around them. Files in
    /// TMPDIR (else in /var/tmp) then take 80 bytes for each point.
    #[arg(long, value_name = "SIZE", value_parser = memory_of, help_heading = "Ground")]
    pub(crate) memory: Option<u64>,

    /// Coordinate system of the points, whatever the files state
    ///
    /// For its units. It is not written.
    #[arg(long, value_name = "CRS", help_heading = "Coordinate system")]
    pub(crate) a_srs: Option<String>,

    /// Print a JSON object: points by class of each file, before and after, and seconds
    #[arg(long)]
    pub(crate) json: bool,
}

/// Whether bridges are ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum BridgesArg {
    /// No: the ground is the terrain below
    #[default]
    Off,
    /// Yes, those that join it at both ends
    Ground,
}

impl From<BridgesArg> for Bridges {
    fn from(arg: BridgesArg) -> Self {
        match arg {
            BridgesArg::Off => Bridges::OffGround,
            BridgesArg::Ground => Bridges::Ground,
        }
    }
}
