use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::parse::{Corners, EdgeLength, not_negative};
use super::{OnCrossingArg, ReadArgs};
use crate::cli::classes;

/// What the surface is made of.
#[derive(Debug, Clone, Args)]
pub(in crate::cli) struct SurfaceArgs {
    /// Files, globs, `@list.txt` or `-` (stdin)
    ///
    /// Points from LAS, LAZ, COPC, text (x y z) and vector layers (`FILE:FIELD` takes the height from
    /// an attribute). Or one TIN: a .ply of this program, which comes with its breaklines and
    /// coordinate system, or an .obj. `@list.txt` names one file a line (`#` starts a comment),
    /// relative to the list.
    /// The order of the files makes no difference, except to `--duplicates first` and `last`.
    #[arg(required = true, value_name = "IN")]
    pub(in crate::cli) inputs: Vec<PathBuf>,

    #[command(flatten)]
    pub(in crate::cli) read: ReadArgs,

    /// Breaklines that hold in the surface (repeatable)
    ///
    /// Lines with heights; polygons give their rings. `FILE:FIELD` takes the height of each record
    /// from an attribute. Where a vertex and a point share a place, the breakline's height wins.
    /// Lines without heights are refused.
    #[arg(long, value_name = "FILE[:FIELD]", help_heading = "Surface")]
    pub(in crate::cli) breaklines: Vec<PathBuf>,

    /// Polygons that the surface is clipped to (repeatable)
    ///
    /// What is inside of any polygon stays, at the height that it has without the boundary: the finished surface is
    /// cut. Lines are taken for one polygon if they close to rings, end to end, and otherwise refused with the gap.
    #[arg(long, value_name = "FILE", help_heading = "Surface")]
    pub(in crate::cli) boundary: Vec<PathBuf>,

    /// Clip to a rectangle
    ///
    /// Points around it are used, too: first in a buffer as wide as the longest edge allowed (or 100 metres), then
    /// further out, until every triangle within is proven to be that of the whole data; then the surface is cut. The
    /// summary says how far that was. In the units of the coordinate system of the result; with commas or blanks
    /// between the values.
    #[arg(long, value_name = "XMIN,YMIN,XMAX,YMAX", allow_hyphen_values = true, help_heading = "Surface")]
    pub(in crate::cli) bounds: Option<Corners>,

    /// Longest edge at the rim, or `none` [default: 100 metres]
    ///
    /// Triangles that can be reached from outside over longer edges are left out: the convex hull
    /// of real data has long slivers that nothing was measured in. Breaklines stop it. In the units
    /// of the coordinate system (100 metres are 328.08 feet); without one, 100 units.
    #[arg(long, value_name = "LENGTH|none", allow_negative_numbers = true, help_heading = "Surface")]
    pub(in crate::cli) max_edge: Option<EdgeLength>,

    /// Classes to use, as `2,8` or `ground` [default: 2 if any point has it, else all]
    ///
    /// By number, or by name as LAS 1.4 has it: `ground,low-vegetation`. Points marked as withheld are never used, points of formats without classes always.
    #[arg(long, value_name = "CLASS,..", value_parser = classes::parse, value_delimiter = ',', help_heading = "Surface")]
    pub(in crate::cli) class: Vec<u8>,

    /// Which height stands where points share a place
    ///
    /// `first` and `last` mean the order of the input; all others do not depend on it.
    #[arg(long, value_enum, value_name = "RULE", default_value_t, help_heading = "Surface")]
    pub(in crate::cli) duplicates: DuplicatesArg,

    /// What to do where breaklines cross between their vertices
    ///
    /// `split` gives them a common vertex there; `reject` is an error that names both lines and the place.
    #[arg(long, value_enum, value_name = "split|reject", default_value_t, help_heading = "Surface")]
    pub(in crate::cli) on_crossing: OnCrossingArg,

    /// Which height stands where breaklines cross between their vertices
    ///
    /// Each line has a height of its own there. The default, `lowest`, does not depend on any order, nor do
    /// `highest` and `mean`; `first` and `last` mean the order of the lines in the input; `error` refuses heights
    /// that differ by more than `--crossing-tolerance`. Where a line meets a vertex of another, that
    /// vertex keeps its height (vertices that share a place follow `--duplicates`); places where the
    /// heights differ are told all the same.
    #[arg(long, value_enum, value_name = "RULE", default_value_t, help_heading = "Surface")]
    pub(in crate::cli) crossing_z: CrossingZArg,

    /// Heights of breaklines that meet may differ by this [default: 0.01 metres]
    ///
    /// Places where they differ by more are told. In the units of the heights (0.01 metres are 0.0328 feet);
    /// without any, 0.01 units.
    #[arg(long, value_name = "HEIGHT", value_parser = not_negative, allow_negative_numbers = true, help_heading = "Surface")]
    pub(in crate::cli) crossing_tolerance: Option<f64>,

    /// Table of all places where breaklines meet with different heights
    ///
    /// Comma separated: place, height that stands, both lines by file, feature id and part, with their
    /// heights. Written also when there is no such place.
    #[arg(long, value_name = "FILE.csv", help_heading = "Surface")]
    pub(in crate::cli) crossing_report: Option<PathBuf>,

    /// Coordinate system to assign to the input, as `EPSG:25832`
    ///
    /// Takes the place of what the files say. Nothing is reprojected. Without it, a file that names
    /// no system takes that of the others, and two different systems are an error.
    #[arg(long, value_name = "CRS", help_heading = "Coordinate system")]
    pub(in crate::cli) a_srs: Option<String>,

    /// Coordinate system to reproject points and lines to
    ///
    /// Needs a build with PROJ (`--features proj`).
    #[arg(long, value_name = "CRS", help_heading = "Coordinate system")]
    pub(in crate::cli) t_srs: Option<String>,

    /// Go on although the coordinates are in degrees
    ///
    /// A degree is not a length: triangles, slopes and edge lengths are then those of the numbers.
    #[arg(long, help_heading = "Coordinate system")]
    pub(in crate::cli) force_degrees: bool,
}

/// Which height stands where points share a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(in crate::cli) enum DuplicatesArg {
    /// The lowest
    #[default]
    Lowest,
    /// The highest
    Highest,
    /// The mean
    Mean,
    /// The first in the order of the input
    First,
    /// The last in the order of the input
    Last,
}

/// Which height stands where breaklines cross.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(in crate::cli) enum CrossingZArg {
    /// The lowest
    #[default]
    Lowest,
    /// The highest
    Highest,
    /// The mean
    Mean,
    /// That of the first line in the order of the input
    First,
    /// That of the last line in the order of the input
    Last,
    /// None: different heights are an error
    Error,
}
