use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::lines::LineArgs;
use super::parse::{ClassRange, Corners, EdgeLength, ReturnRange, not_negative, positive};
use super::reading::ReadArgs;
use super::systems::SystemArgs;
use crate::terrain::{CrossingRule, DuplicateRule};
use crate::triangulation::OnCrossing;

/// Options of building or reading a surface.
#[derive(Debug, Clone, Args)]
pub(crate) struct SurfaceArgs {
    /// Files, globs, `@list.txt` or `-` (stdin)
    ///
    /// Points from LAS, LAZ, COPC, text (x y z) and vector layers (`FILE:FIELD` takes heights from
    /// an attribute; of a file with several layers, `FILE:LAYER` or `FILE:LAYER:FIELD`). A layer of
    /// lines, such as contours, is used like one of --breaklines; no points are needed then. Or one
    /// TIN: a .tin or a .ply of this program, with its breaklines and coordinate system, or an
    /// .obj. `@list.txt` contains one file name per line (`#` starts a comment), relative to the
    /// list. Within a surface, the order of the files makes no difference, except for `--duplicates
    /// first` and `last`.
    #[arg(
        required_unless_present_any = ["breaklines", "soft_lines", "walls", "flat", "rivers"],
        value_name = "IN"
    )]
    pub(crate) inputs: Vec<PathBuf>,

    #[command(flatten)]
    pub(crate) read: ReadArgs,

    /// Breaklines that the surface must follow (repeatable)
    ///
    /// Lines with heights; of polygons, the rings are used. `FILE:FIELD` takes the height of each
    /// record from an attribute; FILE may be a glob, as in `lines/*.shp:FIELD`. In formats with
    /// several layers per file, such as GeoPackage, `FILE:LAYER` names one, `FILE:LAYER:FIELD`
    /// both, and `FILE::FIELD` an attribute of the only layer. Just after any option that takes
    /// lines or areas, `--where "kind = 'toe' AND height > 2"` chooses records by their attributes
    /// (=, <>, <, <=, >, >=, IN, BETWEEN, LIKE, IS NULL, AND, OR, NOT). Where a vertex of a
    /// breakline and a point have the same position, the height of the breakline is used; a point
    /// that lies on a breakline between its vertices keeps its height. Lines without heights are
    /// refused (--draped-lines takes them).
    #[arg(long, value_name = "FILE[:NAME]", help_heading = "Surface")]
    pub(crate) breaklines: Vec<PathBuf>,

    /// Polygons that the surface is clipped to (repeatable)
    ///
    /// The finished surface is cut: what is inside any of the polygons is kept, at the same heights
    /// as without the boundary. Lines that close to rings, end to end, count as one polygon;
    /// otherwise they are refused, and the error names the gap. `FILE:LAYER` names the layer of a
    /// file with several.
    #[arg(long, value_name = "FILE[:LAYER]", help_heading = "Surface")]
    pub(crate) boundary: Vec<PathBuf>,

    /// Clip to a rectangle
    ///
    /// Points around the rectangle are used, too: first in a buffer as wide as the longest edge
    /// allowed (or 100 metres), then further out, until every triangle within the rectangle is
    /// proven to be the same as in the TIN of all data. Then the surface is cut. LAS and LAZ files
    /// that are further out by their headers are not read. The summary shows the final buffer, and
    /// how many files were left out. This takes at most about twice as long as the TIN of all data.
    /// With lakes, rivers, --add-ridges or a --method other than linear, all points are used. The
    /// values are in the units of the coordinate system of the result, separated by commas or
    /// blanks.
    #[arg(
        long,
        value_name = "XMIN,YMIN,XMAX,YMAX",
        allow_hyphen_values = true,
        help_heading = "Surface"
    )]
    pub(crate) bounds: Option<Corners>,

    /// Longest edge at the rim, `auto`, or `none` [default: 100 metres, without caps]
    ///
    /// Triangles that can be reached from outside across longer edges are left out: the convex hull
    /// of real data has long slivers where nothing was measured. By default, caps are left out
    /// there, too: triangles with an angle over 165 degrees, in which contours would run along the
    /// edge of the data. No breakline is crossed. In the units of the coordinate system (100 metres
    /// are 328.08 feet); without one, 100 units. `auto` is 100 times the mean distance between
    /// points, rounded to two digits. It follows from the numbers of points and the extents that
    /// the files state, and does not depend on --class and --bounds. The summary shows it.
    #[arg(
        long,
        value_name = "LENGTH|auto|none",
        allow_negative_numbers = true,
        help_heading = "Surface"
    )]
    pub(crate) max_edge: Option<EdgeLength>,

    /// Longest edge anywhere: triangles with longer ones leave a hole
    ///
    /// For gaps in the data. Breaklines do not count, and neither do triangles in water (--flat,
    /// --rivers).
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true, help_heading = "Surface")]
    pub(crate) max_edge_inside: Option<f64>,

    #[command(flatten)]
    pub(crate) lines: LineArgs,

    /// Classes to use, such as `2,8` or `ground` [default: 2 if any point has it, else all]
    ///
    /// By number, by name as in LAS 1.4 (`ground,low-vegetation`), as a range (`0-31`), or `all`.
    /// With --return or --ground, the default is all but noise (7 and 18). Points flagged as
    /// withheld are never used; points from formats without classes are always used.
    #[arg(
        long,
        value_name = "CLASS,..",
        value_delimiter = ',',
        help_heading = "Surface"
    )]
    pub(crate) class: Vec<ClassRange>,

    /// Returns to use: `first` (surface models), `last`, `single`, `all`, or numbers [default: all]
    ///
    /// `first` and `last` include pulses with a single return, as in LAStools. PDAL's `only` is
    /// `single`. Numbers and ranges: `1,2` or `2-15`. Points from formats without returns are
    /// always used. Where several points have the same position, --duplicates decides which height
    /// counts.
    #[arg(
        long = "return",
        value_name = "RETURN,..",
        value_delimiter = ',',
        help_heading = "Surface"
    )]
    pub(crate) returns: Vec<ReturnRange>,

    /// Use only points on the ground, which a filter finds
    ///
    /// For points without classes, or with bad ones. The filter sees the points of all classes but
    /// noise (7 and 18), or those of --class and --return, also with --bounds. Bridges, buildings,
    /// plants and vehicles are off the ground. All points are in memory, about 200 bytes for each.
    /// `breakline ground` writes what is found to files.
    #[arg(long, help_heading = "Surface")]
    pub(crate) ground: bool,

    /// Which height is used where points have the same position
    ///
    /// `first` and `last` depend on the order of the input; the others do not.
    #[arg(
        long,
        value_enum,
        value_name = "RULE",
        default_value_t,
        help_heading = "Surface"
    )]
    pub(crate) duplicates: DuplicatesArg,

    /// What to do where breaklines cross between their vertices
    ///
    /// `split` adds a common vertex; `reject` is an error that names both lines and the position.
    #[arg(
        long,
        value_enum,
        value_name = "split|reject",
        default_value_t,
        help_heading = "Surface"
    )]
    pub(crate) on_crossing: OnCrossingArg,

    /// Which height is used where breaklines cross between their vertices
    ///
    /// Each line has a height of its own there. `lowest` (the default), `highest` and `mean` do not
    /// depend on any order; `first` and `last` depend on the order of the lines in the input;
    /// `error` refuses heights that differ by more than `--crossing-tolerance`. Where a line meets
    /// a vertex of another, that vertex keeps its height (vertices at the same position follow
    /// `--duplicates`); different heights are still reported.
    #[arg(
        long,
        value_enum,
        value_name = "RULE",
        default_value_t,
        help_heading = "Surface"
    )]
    pub(crate) crossing_z: CrossingZArg,

    /// Largest allowed difference of heights where breaklines meet [default: 0.01 metres]
    ///
    /// Points with a larger difference are reported, and so are waters that overlap or touch with a
    /// larger step. In the units of the heights (0.01 metres are 0.0328 feet); without any, 0.01
    /// units.
    #[arg(long, value_name = "HEIGHT", value_parser = not_negative, allow_negative_numbers = true, help_heading = "Surface")]
    pub(crate) crossing_tolerance: Option<f64>,

    /// Table of all points where breaklines meet with different heights
    ///
    /// Comma separated: position, height used, and both lines by file, feature id and part, with
    /// their heights. If no heights differ, the file has only its header.
    #[arg(long, value_name = "FILE.csv", help_heading = "Surface")]
    pub(crate) crossing_report: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) systems: SystemArgs,

    /// Go on although the coordinates are in degrees
    ///
    /// A degree is not a length: triangles, slopes and edge lengths are then computed from the
    /// numbers as they are. Contours and the hillshade of a DEM need no leave.
    #[arg(long, help_heading = "Coordinate system")]
    pub(crate) force_degrees: bool,
}

/// Which height is used where points have the same position.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum DuplicatesArg {
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

impl From<DuplicatesArg> for DuplicateRule {
    fn from(arg: DuplicatesArg) -> Self {
        match arg {
            DuplicatesArg::Lowest => DuplicateRule::Lowest,
            DuplicatesArg::Highest => DuplicateRule::Highest,
            DuplicatesArg::Mean => DuplicateRule::Mean,
            DuplicatesArg::First => DuplicateRule::First,
            DuplicatesArg::Last => DuplicateRule::Last,
        }
    }
}

/// What to do where two segments cross.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum OnCrossingArg {
    /// Add a vertex
    #[default]
    Split,
    /// End with an error that names both
    Reject,
}

impl From<OnCrossingArg> for OnCrossing {
    fn from(arg: OnCrossingArg) -> Self {
        match arg {
            OnCrossingArg::Split => OnCrossing::Split,
            OnCrossingArg::Reject => OnCrossing::Reject,
        }
    }
}

/// Which height is used where breaklines cross.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum CrossingZArg {
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

impl From<CrossingZArg> for CrossingRule {
    fn from(arg: CrossingZArg) -> Self {
        match arg {
            CrossingZArg::Lowest => CrossingRule::Choose(DuplicateRule::Lowest),
            CrossingZArg::Highest => CrossingRule::Choose(DuplicateRule::Highest),
            CrossingZArg::Mean => CrossingRule::Choose(DuplicateRule::Mean),
            CrossingZArg::First => CrossingRule::Choose(DuplicateRule::First),
            CrossingZArg::Last => CrossingRule::Choose(DuplicateRule::Last),
            CrossingZArg::Error => CrossingRule::Refuse,
        }
    }
}
