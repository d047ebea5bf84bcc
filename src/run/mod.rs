//! The verbs as functions: from a request to a product, without a command line.
//!
//! The program, bindings for other languages and viewers call these functions. A request is a
//! struct of options, each with a documented default. A product is a value that the caller can
//! keep, query or write.
//!
//! | verb | request | function | product |
//! |---|---|---|---|
//! | build or read a surface | [`SurfaceRequest`] | [`surface()`], [`triangles`] | [`SurfaceProduct`] |
//! | the same, in files if it is larger than memory | [`SurfaceRequest`] | [`open_surface`] | [`SurfaceProduct`] |
//! | simplify it, also a raster | [`SimplifyRule`](crate::terrain::SimplifyRule) | [`simplify`] | [`SurfaceProduct`] |
//! | write it as a mesh | | [`write_mesh`] | |
//! | write what a verb makes of it, in one piece or in tiles | [`WriteRequest`] | [`write()`] | [`WriteReport`] |
//! | write several products of one surface | [`SharedSurfaces`], [`SharedProduct`] | [`SharedProduct::write`] | [`Summary`] |
//! | heights at the centers of cells | [`DemOptions`] | [`dem`] | [`CellProduct`] |
//! | heights at positions | positions | [`elevations`], [`Heights`] | a list |
//! | heights and slopes, added to points | [`SampleOptions`] | [`sample()`] | [`SampleReport`] |
//! | shaded relief | [`HillshadeOptions`] | [`hillshade`] | [`CellProduct`] |
//! | heights in colors | [`ColorReliefOptions`] | [`color_relief`] | [`CellProduct`] |
//! | slope, aspect, curvature, roughness | [`QuantityOptions`] | [`quantity`] | [`CellProduct`] |
//! | contours | [`ContourOptions`] | [`contour()`] | [`ContourProduct`] |
//! | contours for maps | [`ContourOptions`] | [`contour_map()`] | [`ContourMap`] |
//! | select, clip and merge points | [`PointsRequest`] | [`write_points`], [`write_point_tiles`], [`read_points`] | [`PointsReport`] |
//! | cut and fill above another surface or a level | [`VolumeOptions`] | [`volume()`] | [`VolumeProduct`] |
//! | lines with the heights of a surface | [`DrapeOptions`] | [`drape`] | [`DrapeProduct`] |
//! | heights along lines and across them | [`ProfileOptions`] | [`profile`] | [`ProfileProduct`] |
//! | levels of tiles for viewers of the earth | [`TerrainTilesOptions`] | [`write_terrain_tiles`] | [`TerrainTilesReport`] |
//! | vertical accuracy by checkpoints | [`AccuracyOptions`] | [`accuracy()`] | [`AccuracyProduct`] |
//! | find flaws | [`SurfaceRequest`] | [`check()`] | [`CheckProduct`] |
//! | count what is in a file | a path | [`facts()`] | [`Facts`] |
//! | triangulate points in space | [`SpaceOptions`] | [`triangulate_space`] | [`SpaceProduct`] |
//! | triangulate Triangle's files | [`TriangulateOptions`] | [`triangulate()`], [`triangulate_graph`] | [`TriangulateProduct`] |
//! | transform coordinates | two coordinate systems | [`proj::transform`] | a [`Transform`](crate::crs::Transform) |
//!
//! # A DEM of points in memory
//!
//! ```
//! use breakline::data::Bounds;
//! use breakline::run::{self, Context, DemOptions, FrameOptions, Input, Source, SurfaceRequest, TinRequest};
//!
//! let points = [[0.0, 0.0, 1.0], [10.0, 0.0, 1.0], [10.0, 10.0, 3.0], [0.0, 10.0, 3.0]];
//! let tin = TinRequest { points: vec![Input::of_points(&points, None)], ..TinRequest::default() };
//! let request = SurfaceRequest { source: Source::Points(Box::new(tin)), ..SurfaceRequest::default() };
//!
//! let context = Context::default(); // nothing is reported or canceled
//! let surface = run::triangles(&request, &context)?;
//! let frame = FrameOptions { resolution: Some(5.0), ..FrameOptions::default() };
//! let cells = run::dem(&surface, &DemOptions { frame, ..DemOptions::default() }, &context)?;
//! let grid = cells.collect(&context)?;
//! assert_eq!(grid.values, [2.5, 2.5, 1.5, 1.5]);
//! # Ok::<(), breakline::Error>(())
//! ```
//!
//! # A DEM of a file
//!
//! ```
//! use breakline::run::{self, Context, DemOptions, Notice, Source, SurfaceRequest};
//!
//! # fn main() -> breakline::Result<()> {
//! # let folder = tempfile::tempdir()?;
//! # let target = folder.path().join("dem.tif");
//! let source = Source::of_files(&["fixtures/valley.laz".into()])?;
//! let request = SurfaceRequest { source, ..SurfaceRequest::default() };
//! let context = Context::default();
//! let surface = run::triangles(&request, &context)?;
//! assert!(surface.notices.contains(&Notice::GroundUsed));
//!
//! let cells = run::dem(&surface, &DemOptions::default(), &context)?;
//! let written = cells.write(target.as_path().into(), &context)?;
//! assert!(written.valid > 0);
//! # Ok(())
//! # }
//! ```
//!
//! # Progress, notices, cancellation
//!
//! Every function takes a [`Context`]. It contains a [`Monitor`], which receives progress and a
//! typed [`Notice`] for everything that is assumed or looks wrong, and a flag that cancels the run.
//! A canceled run returns an error of the kind [`Canceled`](crate::error::Kind::Canceled), and
//! nothing is written.

mod context;
mod job;
mod lines;
mod opened;
mod products;
mod request;
mod shared;
mod sources;
mod space;
mod triangulate;
mod verbs;
mod write;

#[cfg(feature = "cli")] // what is printed lists who is waited for
pub(crate) use context::event::listed;
pub use context::event::{Awaited, Event, JobSize};
pub use context::notice::{
    CrossingNote, LoweredRiver, Notice, PartlyCounted, Seed, SeedFlaw, Severity, WaterStep,
};
#[cfg(feature = "cli")] // what is printed has the units of notices
pub(crate) use context::units;
pub use context::units::Quantity;
pub use context::{Context, Monitor, Progress, Silent, Size, Stage};
pub use job::{
    Division, FileState, FoundJob, Job, JobCommand, JobLock, JobReport, JobTask, JobUpdate, Look,
    NotInTiles, StoredJob, TaskLease, TileOptions, WorkOptions, Worker, needs_tiles, remove_job,
};
pub use lines::crossings::LineNames;
pub use lines::notes::LineInput;
pub use opened::open_surface;
pub use products::accuracy::{
    AccuracyOptions, AccuracyProduct, CheckpointRow, CheckpointSet, ClassDecision, HeightMeasure,
    SetAccuracy, accuracy,
};
pub use products::cells::{
    CellProduct, DemOptions, HillshadeOptions, LightOptions, QuantityOptions, dem, hillshade,
    quantity,
};
pub use products::changed::{AreaOptions, ChangedAreas};
pub use products::check::{CheckProduct, FlawKind, LocatedFlaw, check, surface_flaws};
pub use products::class_comparison::{ClassComparison, GroundAgreement, compare_classes};
pub use products::compare::{CompareOptions, CompareProduct, compare};
pub use products::contour::{ContourOptions, ContourProduct, contour, write_contours};
pub use products::contour_map::{ContourMap, MapSummary, contour_map};
pub use products::drape::{DrapeOptions, DrapeProduct, drape};
pub use products::edge_limit::EdgeLimit;
pub use products::elevation::{Heights, elevations};
pub use products::facts::{
    Facts, LayerFacts, MeshFacts, PlaneFacts, PointFacts, RasterFacts, crs_of_file, facts,
};
pub use products::frame::FrameOptions;
pub use products::ground::{class_number, ground_classes};
pub use products::map_options::{MapOptions, MapPreset, Smoothing};
pub use products::overlaps::Overlap;
pub use products::points::{
    PointsProduct, PointsReport, PointsRequest, Withheld, read_points, write_points,
};
pub use products::profile::{
    ProfileOptions, ProfileProduct, SectionOptions, SectionStations, profile,
};
pub use products::relief::{ColorReliefOptions, color_ramp, color_relief};
pub use products::sample::{
    SampleOptions, SampleReport, SampleTarget, SampledField, sample, sample_positions,
};
pub use products::simplified::simplify;
pub use products::station_format::StationFormat;
pub use products::surface::{
    Model, Source, SurfaceProduct, SurfaceRequest, surface, surface_for, triangles, triangles_for,
    write_mesh,
};
pub use products::terrain_tiles::{
    LevelReport, TerrainFolder, TerrainFormat, TerrainTilesOptions, TerrainTilesReport,
    write_terrain_tiles,
};
pub use products::tin::{BuildReport, ReplacedPoints, TinRequest};
pub use products::volume::{
    Bulking, Earthwork, VolumeBase, VolumeOptions, VolumeProduct, VolumeRow, VolumeUnit, volume,
};
#[cfg(feature = "cli")]
pub(crate) use request::input::is_read_once;
pub use request::input::{Input, MemoryPoints, STDIN};
pub use request::lines::{
    FlatOptions, FlatRule, LineRequest, LineRole, LowerEdge, PerRecord, WallOptions,
};
pub use request::sizes::memory_of;
pub use shared::{SharedProduct, SharedSurfaces, SurfaceEstimate};
pub use sources::open::is_of_lines;
pub use sources::point_files::BadFiles;
pub use sources::proj;
pub use sources::raster_file::RasterFile;
pub use sources::systems::{Degrees, SystemOptions};
pub use sources::tin_parts::{TinParts, WrittenParts};
pub use space::{
    Alpha, AlphaSolid, SpaceCheck, SpaceFlaw, SpaceLaw, SpaceOptions, SpaceProduct, SpaceReport,
    check_space, is_of_space, triangulate_space,
};
pub use triangulate::{
    Arithmetic, TriangulateOptions, TriangulateProduct, TriangulateReport, triangulate,
    triangulate_graph,
};
pub use verbs::ground::{GroundFile, GroundReport, GroundRequest, write_ground};
pub use verbs::point_tiles::{PlanLength, PointTiles, write_point_tiles};
#[cfg(feature = "cli")] // whether two names are one file
pub(crate) use verbs::targets;
pub use verbs::targets::{Existing, Outputs, Target, Targets};
pub use verbs::{Keeps, Summary, SurfaceOptions, TileUse, Tiles, Verb, WriteRequest, WrittenEdges};
pub use write::{
    Execution, Origin, SurfaceReport, WriteReport, Written, WrittenOf, plan_job, run_job, run_task,
    update_job, work_job, write,
};
