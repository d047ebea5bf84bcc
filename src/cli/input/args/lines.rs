use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, ValueEnum};

use super::parse::{finite, not_negative, positive};
use crate::run::{FlatRule, PerRecord};
use crate::terrain::HighSide;

/// Options for lines and areas other than breaklines and the boundary.
///
/// Where kinds of lines meet, the first of these counts: holes, flat, rivers, walls, breaklines,
/// soft lines.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Lines and areas")]
pub(crate) struct LineArgs {
    /// Lines that the surface follows, smooth across them (repeatable)
    ///
    /// Like breaklines, their edges are in the surface, with the heights of the lines. Smooth
    /// methods of interpolation (--method) pass over them. Where kinds of lines meet, the first of
    /// these counts: holes, lakes, rivers, walls, breaklines, soft lines.
    #[arg(long, value_name = "FILE[:NAME]")]
    pub(crate) soft_lines: Vec<PathBuf>,

    /// Lines without heights, draped over the surface (repeatable)
    ///
    /// They get their heights from the finished surface, and a vertex wherever they cross an edge.
    /// The surface itself does not change.
    #[arg(long, value_name = "FILE[:LAYER]")]
    pub(crate) draped_lines: Vec<PathBuf>,

    /// Walls, kerbs and quays: the upper edges of vertical faces (repeatable)
    ///
    /// Each becomes two breaklines next to each other: the upper edge is the line as it is, the
    /// lower one is 1 cm beside it, to the right of the line's direction. The lower height comes
    /// from --wall-bottom or --wall-drop; without them, each record must have two parts, the upper
    /// and the lower edge. Points between the edges are left out.
    #[arg(long, value_name = "FILE[:NAME]")]
    pub(crate) walls: Vec<PathBuf>,

    /// Height of the lower edge of walls, or the attribute that has it
    #[arg(
        long,
        requires = "walls",
        value_name = "HEIGHT|FIELD",
        allow_negative_numbers = true,
        conflicts_with = "wall_drop"
    )]
    pub(crate) wall_bottom: Option<Number>,

    /// How far the lower edge of walls is below the upper one, or the attribute that says it
    #[arg(
        long,
        requires = "walls",
        value_name = "HEIGHT|FIELD",
        allow_negative_numbers = true
    )]
    pub(crate) wall_drop: Option<Number>,

    /// Distance in plan between the edges of walls [default: 0.01 metres]
    #[arg(long, requires = "walls", value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) wall_width: Option<f64>,

    /// The side of a wall, in the direction of its line, on which the ground is higher
    #[arg(long, value_enum, value_name = "left|right", default_value_t)]
    pub(crate) wall_high: HighSideArg,

    /// Areas without data (repeatable)
    ///
    /// Polygons, or lines that close. They are cut out of the finished surface; a ring within a
    /// ring is an island.
    #[arg(long, value_name = "FILE[:LAYER]")]
    pub(crate) holes: Vec<PathBuf>,

    /// Lakes: level water within a shore (repeatable)
    ///
    /// Polygons or closed lines with heights. The shore and everything inside get one height, to
    /// the last bit; points inside are left out. A shore that is not level is an error unless
    /// --flat-height says which height to use. A ring within a ring is the shore of an island.
    #[arg(long, visible_alias = "lakes", value_name = "FILE[:NAME]")]
    pub(crate) flat: Vec<PathBuf>,

    /// Height of lakes [default: the lowest of their shore, which must be about level]
    ///
    /// The lowest or the mean height of the shore, a number, or the attribute that has the height
    /// of each lake. With a number or an attribute, the shore needs no heights.
    #[arg(
        long,
        requires = "flat",
        value_name = "lowest|mean|HEIGHT|FIELD",
        allow_negative_numbers = true
    )]
    pub(crate) flat_height: Option<FlatHeightArg>,

    /// Largest difference of heights of a shore [default: 0.3 metres]
    #[arg(long, requires = "flat", value_name = "HEIGHT", value_parser = not_negative, allow_negative_numbers = true)]
    pub(crate) flat_tolerance: Option<f64>,

    /// Leave out points up to this distance outside of a shore, too
    #[arg(long, value_name = "LENGTH", value_parser = not_negative, default_value_t = 0.0, allow_negative_numbers = true)]
    pub(crate) flat_buffer: f64,

    /// Table of the points that lakes, rivers and walls replaced
    ///
    /// Comma separated: x, y, z.
    #[arg(long, visible_alias = "replaced-points", value_name = "FILE.csv")]
    pub(crate) flat_points: Option<PathBuf>,

    /// Rivers: two banks with heights (repeatable)
    ///
    /// A record with two parts is one river; otherwise two consecutive records are. The water is
    /// level from bank to bank, at the lower of the two, and never rises downstream (as in
    /// hydro-flattening by the USGS Lidar Base Specification); the end with the lower water is
    /// downstream. Where the banks contradict that, a warning says how far. Where rivers overlap,
    /// the lower height counts; one that ends or begins at the bank of another is joined to it.
    /// Points inside are left out.
    #[arg(long, value_name = "FILE[:NAME]")]
    pub(crate) rivers: Vec<PathBuf>,

    /// Width of rivers, or the attribute that has it: their lines run along the middle
    #[arg(
        long,
        requires = "rivers",
        value_name = "LENGTH|FIELD",
        allow_negative_numbers = true
    )]
    pub(crate) river_width: Option<Number>,

    /// Largest distance between vertices of breaklines and soft lines: more are added
    #[arg(long, value_name = "LENGTH", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) densify: Option<f64>,

    /// Add vertices on ridges and valleys, where triangles between contours are flat
    ///
    /// Their heights follow from the contours around: between two of different heights, or, on a
    /// summit, from the slope around it.
    #[arg(long)]
    pub(crate) add_ridges: bool,
}

impl LineArgs {
    /// Returns the options that name files of lines or areas, with what was typed.
    pub(crate) fn files(&self) -> [(&'static str, &[PathBuf]); 6] {
        [
            ("--soft-lines", &self.soft_lines),
            ("--draped-lines", &self.draped_lines),
            ("--walls", &self.walls),
            ("--holes", &self.holes),
            ("--flat", &self.flat),
            ("--rivers", &self.rivers),
        ]
    }
}

/// A number, or the name of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Number(pub(crate) PerRecord);

impl FromStr for Number {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse::<f64>() {
            Ok(_) => finite(text).map(|number| Number(PerRecord::Number(number))),
            Err(_) if text.trim().is_empty() => {
                Err("expected a number or the name of an attribute".to_owned())
            }
            Err(_) => Ok(Number(PerRecord::Field(text.to_owned()))),
        }
    }
}

/// Which height lakes have.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FlatHeightArg(pub(crate) FlatRule);

impl FromStr for FlatHeightArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(FlatHeightArg(match text {
            "lowest" => FlatRule::Lowest,
            "mean" => FlatRule::Mean,
            _ => FlatRule::Given(text.parse::<Number>()?.0),
        }))
    }
}

/// On which side of a wall the ground is higher.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(crate) enum HighSideArg {
    /// Left of the line's direction
    #[default]
    Left,
    /// Right of it
    Right,
}

impl From<HighSideArg> for HighSide {
    fn from(arg: HighSideArg) -> Self {
        match arg {
            HighSideArg::Left => HighSide::Left,
            HighSideArg::Right => HighSide::Right,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_or_an_attribute() {
        assert_eq!("-1.5".parse(), Ok(Number(PerRecord::Number(-1.5))));
        assert_eq!(
            "WSPIEGEL".parse(),
            Ok(Number(PerRecord::Field("WSPIEGEL".to_owned())))
        );
        for wrong in ["", " ", "nan", "inf"] {
            assert!(wrong.parse::<Number>().is_err(), "{wrong}");
        }
        assert_eq!("mean".parse(), Ok(FlatHeightArg(FlatRule::Mean)));
        assert_eq!(
            "2".parse(),
            Ok(FlatHeightArg(FlatRule::Given(PerRecord::Number(2.0))))
        );
    }
}
