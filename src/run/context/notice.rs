//! Notices: what was assumed and what looks wrong, as data.

use std::path::PathBuf;
use std::time::Duration;

use super::units::{Quantity, Units};
use crate::crs::{Crs, Heights};
use crate::data::Bounds;
use crate::error::Wording;
use crate::run::request::lines::LineRole;

/// Something that was assumed or that looks wrong. Its text mentions settings as data, so that each
/// caller can name them in its own words.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Notice {
    /// A file of points was opened; with its format.
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
    /// All points of a file were read; with their number.
    PointsRead(PathBuf, u64),
    /// Only those nodes of an octree were read that may have points within the bounds.
    NodesRead {
        /// The file.
        path: PathBuf,
        /// How many were read.
        read: usize,
        /// How many there are.
        nodes: usize,
    },
    /// A warning of a reader or a writer about a file.
    Reader(PathBuf, Wording),
    /// What a task of a job found, as the file of the task keeps it.
    OfTask {
        /// How much it matters.
        severity: Severity,
        /// The text.
        text: Wording,
        /// The lines that explain it further.
        details: Vec<Wording>,
    },
    /// A file is skipped, because it cannot be read.
    Skipped {
        /// The file, and why it cannot be read.
        why: String,
        /// Its extent, in which the surface has a hole; `None` if that is not known.
        hole: Option<Bounds>,
        /// Other files that may have points there, which are not used.
        others: Vec<PathBuf>,
    },
    /// All points may not fit into memory.
    LittleMemory {
        /// Bytes that they would take.
        need: u64,
        /// Bytes that are free.
        left: u64,
        /// What sets the limit, such as "on this machine".
        limit: &'static str,
    },
    /// The memory that was given makes no difference, since tiles cannot be made; with the reason,
    /// and what to do.
    MemoryUnused(Wording),
    /// Points would need more memory than there is to use: their TIN is built in files first.
    BuiltInFiles {
        /// The memory to use, in bytes.
        memory: u64,
        /// The folder of the files, which is removed with the surface.
        folder: PathBuf,
    },
    /// The outputs may not fit on a disk.
    OutputMayNotFit {
        /// About how many bytes they take before they are compressed.
        need: u64,
        /// Bytes that are free.
        free: u64,
    },
    /// The files of the tasks of a job may not fit on a disk.
    TasksMayNotFit {
        /// About how many bytes they take.
        need: u64,
        /// Bytes that are free.
        free: u64,
    },
    /// One of several files has no point that is used; with the classes that are used, if not all.
    NoPointUsed(PathBuf, Option<Vec<u8>>),
    /// No point has these classes, which were requested.
    NoPointOfClass {
        /// The classes.
        classes: Vec<u8>,
        /// Files outside of the bounds, whose points may have them.
        unread: usize,
    },
    /// Ground points (class 2) were found and are used alone.
    GroundUsed,
    /// This many points from files without classes are used in addition to ground points.
    PointsWithoutClassUsed(u64),
    /// Points of all classes are used, except noise.
    NoiseUnused,
    /// Some returns are chosen, but so many points have none and are used, too.
    PointsWithoutReturnUsed(u64),
    /// The ground was searched, and is used alone.
    GroundFound {
        /// Points that are ground.
        ground: u64,
        /// Points that were searched.
        of: u64,
    },
    /// Tiles whose ground depends on points that memory has no room for.
    GroundInDoubt {
        /// The number of them.
        tiles: usize,
        /// The number of all tiles.
        of: usize,
        /// The middle of the first one.
        middle: [f64; 2],
    },
    /// A file is written without the octree of its source.
    OctreeLeftOut(PathBuf),
    /// There are no ground points: all classes are used.
    AllClassesUsed,
    /// A file states a coordinate system that differs from the assigned one.
    Reassigned {
        /// The file.
        path: PathBuf,
        /// The system that the file states.
        stated: Box<Crs>,
        /// The system that is used.
        assigned: Box<Crs>,
    },
    /// A raster has this many bands: the first one is used.
    FirstOfBands(PathBuf, u16),
    /// A file states no coordinate system: that of the other files is used.
    SystemOfOthers(PathBuf, Box<Crs>),
    /// The heights of a file are taken to be in the unit of other files, with its name, because its
    /// coordinate system states none.
    HeightsOfOthers(PathBuf, String),
    /// No coordinate system is known: lengths are in the units of the data.
    NoSystem,
    /// Coordinates in the plane and heights have different units; with the names of both.
    DifferentUnits(String, String),
    /// Points or lines are reprojected, from the first system to the second.
    Reprojecting(Box<Crs>, Box<Crs>),
    /// A message about a transform: the operation and its accuracy.
    Transform(String),
    /// In the polygons of these records of a file, the surface and its base have no area in
    /// common.
    PolygonsOutside(PathBuf, Vec<usize>),
    /// Faces of a mesh may overlap in plan; with the first position where they do.
    FacesOverlap(PathBuf, String),
    /// The rings of polygons of a layer overlap each other; with the records, counted from 1.
    RingsOverlap(PathBuf, Vec<usize>),
    /// Polygons of a layer are only in part where the surface and its base are.
    PolygonsPartlyOutside {
        /// The layer.
        path: PathBuf,
        /// The polygons.
        partly: Vec<PartlyCounted>,
        /// The unit of areas.
        unit: &'static str,
    },
    /// These lines of a file, such as "record 3", are not on the surface, which is named.
    LinesOff(PathBuf, String, Vec<String>),
    /// These lines of a file are on the surface, which is named, only in part.
    LinesPartlyOff(PathBuf, String, Vec<String>),
    /// These lines of a file, such as "record 3", have no length.
    LinesWithoutLength(PathBuf, Vec<String>),
    /// Cross-sections of the line of a record of a file cross.
    SectionsCross {
        /// The file.
        path: PathBuf,
        /// The record, counted from 1.
        record: usize,
        /// The stations of the first pairs.
        first: Vec<[String; 2]>,
        /// How many more pairs were found.
        more: usize,
        /// True if these are all; otherwise, the search has ended early.
        are_all: bool,
    },
    /// The attributes of a file are not kept, because its format is read without them.
    AttributesLeftOut(PathBuf),
    /// Some of the points of a file are not on the surface that they are compared with.
    PointsOutside {
        /// The file.
        path: PathBuf,
        /// How many are outside.
        outside: u64,
        /// How many there are.
        points: u64,
    },
    /// Some checkpoints are not on the surface.
    CheckpointsOutside {
        /// The file.
        path: PathBuf,
        /// What the numbers count, such as "line".
        counted_by: &'static str,
        /// The numbers of these checkpoints.
        numbers: Vec<u64>,
    },
    /// There are fewer checkpoints than an assessment needs; with their number.
    FewCheckpoints(usize),
    /// No unit of heights is known: they are taken to be in meters.
    HeightsInMeters,
    /// The gap between two files is far wider than any file.
    FarApart(PathBuf, PathBuf, Quantity),
    /// The breaklines are this far from all points.
    BreaklinesApart(Quantity),
    /// Breaklines reach this far beyond the points.
    BreaklinesBeyond(Quantity),
    /// Triangles between the lines of a surface of lines are flat.
    FlatTriangles {
        /// How many.
        count: usize,
        /// Their share of the area, from 0 to 1.
        share: f64,
        /// True if vertices on ridges were added: these remain.
        has_ridges: bool,
    },
    /// Vertices were added on ridges and valleys; with their number.
    RidgesAdded(usize),
    /// Heights are used as if they were above the ellipsoid; with what they are counted from, as
    /// far as that is stated.
    HeightsAboveEllipsoid(Heights),
    /// The surface is further from the triangles of a level of tiles than its bound.
    BeyondBound {
        /// The level.
        level: u8,
        /// How many heights the steps of the format are too large for; if none, the earth is curved
        /// within the triangles.
        count: usize,
        /// No height is further from the triangles than this, in meters.
        within: f64,
        /// The bound, in meters.
        bound: f64,
    },
    /// The surface was simplified, and measured against all heights that were given.
    Simplified {
        /// The vertices that are left.
        vertices: usize,
        /// The number of heights.
        heights: usize,
        /// No height is further from the surface than this.
        bound: Quantity,
        /// The largest distance of a height from the surface.
        largest: Quantity,
        /// The root of the mean square of these distances.
        root_mean_square: Quantity,
        /// The vertices on lines that were given, and how many of them are left.
        line_vertices: [usize; 2],
    },
    /// Lakes have the lowest heights of their shores, which differ.
    UnevenShores {
        /// How many.
        lakes: usize,
        /// The name of the one whose shore differs most.
        name: String,
        /// Its height.
        height: Quantity,
        /// How far its shore is above it, at most.
        largest: Quantity,
    },
    /// Lakes meet larger ones and have their height.
    LakesJoined {
        /// How many.
        lakes: usize,
        /// The name of the one that was moved most.
        name: String,
        /// The name of the larger one.
        to: String,
        /// How far it was moved.
        by: Quantity,
    },
    /// Waters reach beyond the points and the lines with heights, and end at their rim.
    WatersEnded {
        /// How many.
        waters: usize,
        /// The name of the first.
        name: String,
    },
    /// Triangles at the rim with longer edges are left out.
    EdgeLimit(Quantity),
    /// By default, triangles at the rim with longer edges are left out, and caps.
    StandardEdgeLimit(Quantity),
    /// No triangle at the rim is left out.
    NoEdgeLimit,
    /// Points are used up to this distance from the bounds; `None` if all points are used.
    BoundsBuffer(Option<Quantity>),
    /// Points far outside of the bounds are not used, and a method other than linear is.
    PartForLinear,
    /// Files were not read, because they state that all of their points lie outside of the bounds.
    FilesOutside {
        /// How many.
        left_out: usize,
        /// The number of all files.
        files: usize,
        /// True if they were read up to the first ground point, because no other file has one.
        are_searched: bool,
        /// The distance from the bounds that they are beyond, if not 0.
        buffer: Option<Quantity>,
    },
    /// The triangulation took this time.
    Triangulated(Duration),
    /// This many triangles within the bounds may depend on points further out than this distance.
    Uncertain(usize, Quantity),
    /// Crossings of breaklines were rounded.
    CrossingsRounded {
        /// The step of the grid that they were rounded to, in x and y.
        unit: [Quantity; 2],
        /// True if all vertices lie on that grid, so that no line moves by more than half a step on
        /// each axis.
        on_grid: bool,
    },
    /// Breaklines meet with different heights.
    CrossingHeights {
        /// The number of points where they do.
        count: usize,
        /// The largest difference.
        largest: Quantity,
        /// The point with the largest difference.
        at: [f64; 2],
        /// The first of these points, at most five.
        first: Vec<CrossingNote>,
    },
    /// The default longest edge at the rim is far from the mean distance between points.
    EdgeLimitUnusual {
        /// The longest edge.
        limit: Quantity,
        /// The mean distance.
        spacing: Quantity,
    },
    /// Much of the surface is left out at the rim with caps, which is the default.
    CapsLost {
        /// Their number.
        faces: u64,
        /// Their share of the area, from 0 to 1.
        share: f64,
        /// Points all of whose triangles are left out.
        points: u64,
    },
    /// Most of the convex hull was left out at the rim; with the share of its area, above 0.5.
    HullLost(f64),
    /// Points inside of closed breaklines of one height have other heights: the lines may be
    /// shores.
    LevelRings {
        /// The number of such lines.
        rings: usize,
        /// The number of such points.
        points: usize,
        /// The line with the largest difference.
        name: String,
        /// That difference.
        largest: Quantity,
    },
    /// The banks of a river contradict water: they rise downstream, or are not level across.
    RiverHeights {
        /// The number of such rivers; the rest is about the worst of them.
        rivers: usize,
        /// The river.
        name: String,
        /// The number of level lines at which the banks rise.
        rising: usize,
        /// How far they rise, at most.
        largest_rise: Quantity,
        /// Where they rise that far.
        rise_at: [f64; 2],
        /// The largest difference between the banks.
        largest_difference: Quantity,
        /// Where they differ that much.
        difference_at: [f64; 2],
    },
    /// Rivers are lowered to others that join them, so that the water does not rise downstream.
    RiversLowered {
        /// The number of such rivers.
        count: usize,
        /// Those that are lowered most, at most five.
        first: Vec<LoweredRiver>,
    },
    /// Rivers overlap themselves: what their banks enclose twice is not water.
    RiverOverlap {
        /// The number of such rivers; the rest is about the first of them.
        rivers: usize,
        /// The river.
        name: String,
        /// A position near which the banks meet.
        at: [f64; 2],
    },
    /// Waters of different heights overlap or touch: the lower one counts there.
    WaterOverlaps {
        /// The number of pairs that do.
        count: usize,
        /// The pairs with the largest steps, at most five.
        first: Vec<WaterStep>,
    },
    /// Vertices of walls do not have the heights of their walls, since water counts first.
    WallsInWater {
        /// The number of such vertices.
        vertices: usize,
        /// The wall of the first of them.
        name: String,
        /// The position of the first.
        at: [f64; 2],
    },
    /// No line or area of a kind touches the surface.
    LinesApart(LineRole),
    /// The given extent of a raster does not touch the surface.
    ExtentApart,
    /// The default size of cells is used.
    DefaultResolution(Quantity),
    /// The default interval of contours is used.
    DefaultInterval(Quantity),
    /// Coordinates are so large that rounding may break what is promised of contours for maps.
    CoarseCoordinates {
        /// The largest coordinate, without its sign.
        largest: f64,
        /// How far lines may be off the surface.
        tolerance: Quantity,
    },
    /// Contours for maps are farther off the surface than was asked for.
    BeyondTolerance {
        /// The largest difference in height along a line.
        deviation: Quantity,
        /// How far lines may be off the surface.
        tolerance: Quantity,
    },
    /// Heights are multiplied by this, to match the units of the plane.
    HeightFactor(f64),
    /// Coordinates are angles, and heights are multiplied by a number that makes slopes far too
    /// steep.
    SteepAngles {
        /// That factor.
        factor: f64,
        /// The factor with which slopes are true.
        usual: f64,
    },
    /// A degree of x and one of y are taken as lengths, in units of the heights: those in the
    /// middle of the raster.
    AnglesAsLengths([f64; 2]),
    /// The format does not store breaklines: the Delaunay law is not checked.
    DelaunayUnchecked(PathBuf),
    /// A file has largest areas of regions, but they were not requested.
    RegionAreasUnused(PathBuf),
    /// A hole or a region is not used.
    SeedUnused {
        /// The file.
        path: PathBuf,
        /// Its line in the file.
        line: usize,
        /// A hole or a region.
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

/// A river that is lowered to another one.
#[derive(Debug, Clone, PartialEq)]
pub struct LoweredRiver {
    /// The river.
    pub name: String,
    /// The other one.
    pub to: String,
    /// How far it is lowered, at most.
    pub by: Quantity,
    /// Where that is: from there on downstream.
    pub from: [f64; 2],
}

/// A step between two waters that overlap or touch.
#[derive(Debug, Clone, PartialEq)]
pub struct WaterStep {
    /// The water whose height counts.
    pub inner: String,
    /// The river that goes on at another height outside of the overlap.
    pub outer: String,
    /// The difference.
    pub step: Quantity,
    /// Where it is.
    pub at: [f64; 2],
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
    /// It lies on a segment, so that its side is ambiguous.
    OnSegment,
    /// It lies outside of the convex hull.
    OutsideHull,
}

/// A polygon that is only in part where the surface and its base are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartlyCounted {
    /// The number of its record, counted from 1.
    pub record: usize,
    /// Its area.
    pub area: f64,
    /// The area in which there is something to compute a volume of.
    pub counted: f64,
}

impl PartlyCounted {
    /// Returns true if more is missing than at the rim of a raster, where a surface ends at the
    /// centers of cells: a twentieth of the area.
    fn misses_much(&self) -> bool {
        self.counted < 0.95 * self.area
    }
}

/// How much a notice matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// A detail, for verbose output.
    Detail,
    /// A choice that was made for the user, or something worth knowing.
    Note,
    /// Something is probably not as intended.
    Warning,
}

impl Notice {
    /// Returns how much the notice matters.
    pub fn severity(&self) -> Severity {
        match self {
            Notice::OfTask { severity, .. } => *severity,
            Notice::PolygonsPartlyOutside { partly, .. } => {
                match partly.iter().any(|one| one.misses_much()) {
                    true => Severity::Warning,
                    false => Severity::Note,
                }
            }
            Notice::SystemOfOthers(_, crs) => match Units::of(Some(crs)).is_angular() {
                true => Severity::Warning,
                false => Severity::Note,
            },
            Notice::Opened(..)
            | Notice::WithoutClasses(_)
            | Notice::LayerRead { .. }
            | Notice::PointsRead(..)
            | Notice::NodesRead { .. }
            | Notice::Triangulated(_)
            | Notice::Uncertain(..) => Severity::Detail,
            Notice::GroundUsed
            | Notice::GroundFound { .. }
            | Notice::OctreeLeftOut(_)
            | Notice::FirstOfBands(..)
            | Notice::PointsWithoutClassUsed(_)
            | Notice::NoiseUnused
            | Notice::MemoryUnused(_)
            | Notice::BuiltInFiles { .. }
            | Notice::Reassigned { .. }
            | Notice::NoSystem
            | Notice::DifferentUnits(..)
            | Notice::Reprojecting(..)
            | Notice::RidgesAdded(_)
            | Notice::Simplified { .. }
            | Notice::UnevenShores { .. }
            | Notice::LakesJoined { .. }
            | Notice::WatersEnded { .. }
            | Notice::EdgeLimit(_)
            | Notice::StandardEdgeLimit(_)
            | Notice::NoEdgeLimit
            | Notice::BoundsBuffer(_)
            | Notice::FilesOutside { .. }
            | Notice::CrossingsRounded { .. }
            | Notice::DefaultResolution(_)
            | Notice::DefaultInterval(_)
            | Notice::HeightFactor(_)
            | Notice::HeightsInMeters
            | Notice::AnglesAsLengths(_)
            | Notice::DelaunayUnchecked(_) => Severity::Note,
            Notice::Reader(..)
            | Notice::Skipped { .. }
            | Notice::LittleMemory { .. }
            | Notice::OutputMayNotFit { .. }
            | Notice::TasksMayNotFit { .. }
            | Notice::NoPointUsed(..)
            | Notice::NoPointOfClass { .. }
            | Notice::PointsWithoutReturnUsed(_)
            | Notice::AllClassesUsed
            | Notice::HeightsOfOthers(..)
            | Notice::Transform(_)
            | Notice::HeightsAboveEllipsoid(_)
            | Notice::BeyondBound { .. }
            | Notice::PartForLinear
            | Notice::PolygonsOutside(..)
            | Notice::FacesOverlap(..)
            | Notice::RingsOverlap(..)
            | Notice::LinesOff(..)
            | Notice::LinesPartlyOff(..)
            | Notice::LinesWithoutLength(..)
            | Notice::SectionsCross { .. }
            | Notice::AttributesLeftOut(_)
            | Notice::PointsOutside { .. }
            | Notice::CheckpointsOutside { .. }
            | Notice::FewCheckpoints(_)
            | Notice::FarApart(..)
            | Notice::BreaklinesApart(_)
            | Notice::BreaklinesBeyond(_)
            | Notice::FlatTriangles { .. }
            | Notice::CrossingHeights { .. }
            | Notice::EdgeLimitUnusual { .. }
            | Notice::CapsLost { .. }
            | Notice::HullLost(_)
            | Notice::SteepAngles { .. }
            | Notice::CoarseCoordinates { .. }
            | Notice::BeyondTolerance { .. }
            | Notice::LevelRings { .. }
            | Notice::RiverHeights { .. }
            | Notice::RiversLowered { .. }
            | Notice::RiverOverlap { .. }
            | Notice::WaterOverlaps { .. }
            | Notice::WallsInWater { .. }
            | Notice::LinesApart(_)
            | Notice::ExtentApart
            | Notice::RegionAreasUnused(_)
            | Notice::GroundInDoubt { .. }
            | Notice::SeedUnused { .. } => Severity::Warning,
        }
    }
}
