//! What was assumed, and what looks odd, as data.

use std::path::PathBuf;
use std::time::Duration;

use super::units::Quantity;
use crate::crs::Crs;

/// Something that was assumed, or that looks odd. The command line has a text for each; other callers can have others.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Notice {
    /// A file of points was opened; its format.
    Opened(PathBuf, String),
    /// A file among several has no classes: all of its points are used.
    WithoutClasses(PathBuf),
    /// A vector layer was read.
    LayerRead {
        /// The file.
        path: PathBuf,
        /// Its format.
        format: String,
        /// Its records.
        records: usize,
    },
    /// All points of a file were read; how many.
    PointsRead(PathBuf, u64),
    /// A reader has something to say about a file.
    Reader(PathBuf, String),
    /// All points may not fit into memory.
    LittleMemory {
        /// Bytes that they would take.
        need: u64,
        /// Bytes that are left.
        left: u64,
        /// What sets the limit: "on this machine".
        limit: &'static str,
    },
    /// No point of a file is used, among several; the classes that are used, if not all are.
    NoPointUsed(PathBuf, Option<Vec<u8>>),
    /// No point has this class, which was asked for.
    NoPointOfClass(u8),
    /// Ground points (class 2) were found and are used alone.
    GroundUsed,
    /// So many points from files without classes are used beside ground points.
    PointsWithoutClassUsed(u64),
    /// There are no ground points: all classes are used.
    AllClassesUsed,
    /// A file states another coordinate system than the one that was assigned.
    Reassigned {
        /// The file.
        path: PathBuf,
        /// What it states.
        stated: Box<Crs>,
        /// What is taken.
        assigned: Box<Crs>,
    },
    /// A file states no coordinate system: that of the others is taken.
    SystemOfOthers(PathBuf, Box<Crs>),
    /// No coordinate system is known: lengths are in the units of the data.
    NoSystem,
    /// Coordinates in the plane and heights have different units; their names.
    DifferentUnits(String, String),
    /// Points or lines are reprojected, from one system to the other.
    Reprojecting(Box<Crs>, Box<Crs>),
    /// A transform has something to say: the operation, how good it is.
    Transform(String),
    /// Two files have a gap between them that is far wider than any of them.
    FarApart(PathBuf, PathBuf, Quantity),
    /// The breaklines lie this far from all points.
    BreaklinesApart(Quantity),
    /// Breaklines reach this far beyond the points.
    BreaklinesBeyond(Quantity),
    /// Triangles at the rim with longer edges are left out.
    EdgeLimit(Quantity),
    /// No triangle at the rim is left out.
    NoEdgeLimit,
    /// How far outside of the bounds points are used; `None` where all points are used.
    BoundsBuffer(Option<Quantity>),
    /// Triangulated, in this time.
    Triangulated(Duration),
    /// So many triangles within the bounds may change with points further out than this.
    Uncertain(usize, Quantity),
    /// Crossings of breaklines were rounded.
    CrossingsRounded {
        /// The step of the grid that they were rounded to, in x and y.
        unit: [Quantity; 2],
        /// Whether all vertices lie on that grid, so that no line is moved by more than half a step on each axis.
        on_grid: bool,
    },
    /// Breaklines meet with different heights.
    CrossingHeights {
        /// At how many points.
        count: usize,
        /// The largest difference.
        largest: Quantity,
        /// Where that is.
        at: [f64; 2],
        /// The first of them, up to five.
        first: Vec<CrossingNote>,
    },
    /// The given extent of a raster does not touch the surface.
    ExtentApart,
    /// The default size of cells is taken.
    DefaultResolution(Quantity),
    /// The default distance of contours is taken.
    DefaultInterval(Quantity),
    /// Heights are multiplied by this, to match the units of the plane.
    HeightFactor(f64),
    /// The format cannot tell breaklines from other edges: the Delaunay law is not checked.
    DelaunayUnchecked(PathBuf),
    /// Largest areas of regions are in a file, and were not asked for.
    RegionAreasUnused(PathBuf),
    /// A hole or a region is not used.
    SeedUnused {
        /// The file.
        path: PathBuf,
        /// Its line in the file.
        line: usize,
        /// What it is.
        seed: Seed,
        /// Why it is not used.
        why: SeedFlaw,
    },
}

/// Two lines that meet with different heights.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossingNote {
    /// Where they meet.
    pub at: [f64; 2],
    /// The lowest height, and the line that has it.
    pub low: (f64, String),
    /// The highest height, and the line that has it.
    pub high: (f64, String),
    /// The height of the surface.
    pub chosen: f64,
}

/// A point of a `.poly` file that names an area.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seed {
    /// A hole.
    Hole,
    /// A region.
    Region,
}

/// Why a hole or a region is not used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SeedFlaw {
    /// It lies on a segment: which side is meant is not known.
    OnSegment,
    /// It lies outside of the convex hull.
    OutsideHull,
}

/// How much a notice matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// For those who want to know everything.
    Detail,
    /// A choice that was made, or something worth knowing.
    Note,
    /// Something that is probably not as it should be.
    Warning,
}

impl Notice {
    /// How much it matters.
    pub fn severity(&self) -> Severity {
        match self {
            Notice::Opened(..)
            | Notice::WithoutClasses(_)
            | Notice::LayerRead { .. }
            | Notice::PointsRead(..)
            | Notice::Triangulated(_)
            | Notice::Uncertain(..) => Severity::Detail,
            Notice::GroundUsed
            | Notice::PointsWithoutClassUsed(_)
            | Notice::Reassigned { .. }
            | Notice::SystemOfOthers(..)
            | Notice::NoSystem
            | Notice::DifferentUnits(..)
            | Notice::Reprojecting(..)
            | Notice::BreaklinesBeyond(_)
            | Notice::EdgeLimit(_)
            | Notice::NoEdgeLimit
            | Notice::BoundsBuffer(_)
            | Notice::CrossingsRounded { .. }
            | Notice::DefaultResolution(_)
            | Notice::DefaultInterval(_)
            | Notice::HeightFactor(_)
            | Notice::DelaunayUnchecked(_) => Severity::Note,
            Notice::Reader(..)
            | Notice::LittleMemory { .. }
            | Notice::NoPointUsed(..)
            | Notice::NoPointOfClass(_)
            | Notice::AllClassesUsed
            | Notice::Transform(_)
            | Notice::FarApart(..)
            | Notice::BreaklinesApart(_)
            | Notice::CrossingHeights { .. }
            | Notice::ExtentApart
            | Notice::RegionAreasUnused(_)
            | Notice::SeedUnused { .. } => Severity::Warning,
        }
    }
}
