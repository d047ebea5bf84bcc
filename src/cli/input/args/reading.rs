//! Options of reading points, for what the files themselves leave open.

use clap::Args;

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
