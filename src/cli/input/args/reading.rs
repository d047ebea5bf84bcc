//! Options of reading points, for what the files themselves leave open.

use clap::Args;

use super::parse::positive;
use crate::data::Columns;
use crate::io::OnDamage;
use crate::io::points::Options;

/// Options of reading points.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Points")]
pub(crate) struct ReadArgs {
    /// Columns of text files, such as `PNEZD`, `XYZ` or `2,1,3` [default: from the header, else the
    /// first three]
    ///
    /// Either one letter per column: E or X is the easting, N or Y the northing, Z the height; P
    /// (point number), D (description) and S (anything else) are skipped. Or the numbers of the
    /// columns of x, y and z, counted from 1. Points in plan need no z: `NE`, `2,1`. With this
    /// option a header line is skipped. `info` and the summary show which columns were used.
    #[arg(long, value_name = "PNEZD|XYZ|2,1,3", conflicts_with = "parse")]
    pub(crate) columns: Option<Columns>,

    /// Columns of text files in the letters of LAStools, such as `sxyz`
    ///
    /// x, y, z and c (class) are used; s and the letters of all other fields are skipped.
    #[arg(long, value_name = "sxyz", value_parser = Columns::of_las_tools)]
    pub(crate) parse: Option<Columns>,

    /// Use what is left of LAS, LAZ and shapefiles that are cut or damaged
    ///
    /// A warning says what is missing. Without this option it is an error if a file has fewer
    /// points than its header (of text: its first line) states, or a shapefile has a record that
    /// cannot be read.
    #[arg(long)]
    pub(crate) partial: bool,
}

/// Which levels of files with an octree are read.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Points")]
pub(crate) struct LevelArgs {
    /// Read only the coarse levels of COPC files, until points are at most so far apart
    ///
    /// A COPC file has an even sample of its points on each level. Levels are read to the first one
    /// on which points are at most LENGTH apart, as the file states. All inputs must be COPC.
    /// Lengths are in the units of the file's coordinates.
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) copc_resolution: Option<f64>,
}

impl LevelArgs {
    /// Returns options of reading with these levels.
    pub(crate) fn of(&self, options: Options) -> Options {
        Options {
            resolution: self.copc_resolution,
            ..options
        }
    }
}

impl ReadArgs {
    /// Returns the options for readers of points.
    pub(crate) fn options(&self) -> Options {
        let cut = if self.partial {
            OnDamage::Accept
        } else {
            OnDamage::Refuse
        };
        Options {
            columns: self.columns.or(self.parse),
            cut,
            ..Options::default()
        }
    }
}
