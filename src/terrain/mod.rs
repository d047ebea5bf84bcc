//! Terrain models in a surveyor's terms: TIN, breakline, contour, raster, hillshade.
//!
//! | I have | I want | |
//! |---|---|---|
//! | points of many classes | the ground | [`Selection`] |
//! | points without classes | the ground | [`ground::classify`], [`ground::classify_in_tiles`] |
//! | points | fewer of them | [`Thinner`], by a [`Thinning`] |
//! | points and breaklines | a surface | [`TinBuilder`], which builds a [`Tin`] |
//! | a TIN | the height at a position | [`Tin::elevation`] |
//! | any surface | heights and gradients at many positions | [`Sampler`] |
//! | any surface | a DEM | [`Dem`] |
//! | any surface | smooth heights between its vertices | [`Interpolant`], by a [`Method`] |
//! | any surface | contours | [`contours()`], at [`Levels`] |
//! | a DEM | contours | [`GridSurface`], a surface over its cells |
//! | a DEM | shaded relief | [`Hillshade`] |
//! | a DEM | slope, aspect, curvature, roughness | [`QuantityMap`], of a [`Quantity`] |
//! | a surface, and points known better | how far they are apart | [`ErrorStatistics`], [`Histogram`] |
//! | two surfaces, or one and a level | cut and fill | [`volumes()`], in [`Zones`] |
//! | two surfaces | where they differ by more than a height | [`changed_areas`] |
//! | two rasters of the same cells | their difference | [`Difference`] |
//! | a surface and a line | the heights along it | [`Locator`] |
//! | an axis | the lines across it | [`sections()`] |
//! | a surface, or a DEM | one of fewer vertices, within a bound | [`simplify()`], [`simplify_cells`] |
//! | a TIN in a file | a surface, at once | [`CompactTin`] |
//! | more points than fit into memory | their triangles, from tiles | [`tiles`] |
//! | triangles from tiles | the contours of the whole | [`contour::parts`] |
//! | a surface in parts | a DEM of the whole | [`DemOfParts`] |
//! | a surface and a frame | slope or aspect of its faces, in cells | [`FaceSlopes`] of a [`GradientMap`] |
//! | a surface and a tiling of the earth | levels of tiles that fit together | [`Pyramid`] |
//! | any surface | a check that it is sound | [`surface_flaws`], [`shape_flaws`]; for a TIN also [`Tin::check`] |
//!
//! A surface is anything that implements [`Surface`](crate::data::Surface): a [`Tin`], a
//! [`CompactTin`], a [`Mesh`](crate::data::Mesh) from a file, a [`GridSurface`]. Results are
//! sources (of raster blocks, of lines), which the writers in [`io`](crate::io) accept. So a result
//! need not fit into memory.
//!
//! # Conventions
//!
//! - Surfaces are seen in plan: x to the east, y to the north, one height at each position.
//!   Vertical faces and overhangs cannot be represented.
//! - Lengths and heights are in the units of the data. Heights are linear on each triangle,
//!   unless another [`Method`] is chosen.
//! - Results depend on the set of points and lines alone, not on their order or on the number of
//!   threads.
//! - All queries take `&self`, and may be called from many threads at once.
//!
//! # What it does not do
//!
//! Coordinates are not reprojected, and points are not smoothed.

mod admitted;
mod arranged;
mod boxes;
mod builder;
mod cancel;
mod caps;
mod changes;
mod clip;
mod compact;
pub mod contour;
mod crossings;
mod cut;
mod difference;
mod duplicates;
mod face_gradient;
mod face_slopes;
mod focal;
mod grid_surface;
pub mod ground;
mod groups;
mod in_order;
mod inside;
mod interpolate;
mod levels;
mod linear;
mod lines;
mod near_lines;
mod nearest;
mod nesting;
mod overlay;
mod peel;
mod point_rim;
mod pyramid;
mod rasterize;
mod records;
mod regions;
mod ridges;
mod rim_rule;
mod sample;
mod sections;
mod selection;
mod simplify;
mod soundness;
mod statistics;
mod thin;
mod thinning;
pub mod tiles;
mod tin;
mod tin_report;
mod volume;
mod walk;
mod water;
mod window;

pub use builder::TinBuilder;
pub use caps::{LeftOutAtRim, LostAtRim, LostCaps};
pub use changes::{ChangedArea, changed_areas};
pub use compact::{CompactTin, PartCell, TinIndex, TinIndexPart};
pub use contour::{
    Band, ContourLabel, Contours, GoOn, LabelRules, LabelTops, MapContours, MapLine, MapRules,
    contour_bands, contour_labels, contours, map_contours, map_contours_while, map_of_contours,
    map_work,
};
pub use crossings::{CrossingHeights, CrossingRule};
pub use difference::{Difference, LargeDifference, largest_differences};
pub use duplicates::DuplicateRule;
pub(crate) use duplicates::one_per_site;
pub use face_slopes::FaceSlopes;
pub use focal::{Focal, Gradient, Hillshade, Light, Quantity, QuantityMap, Ruggedness, Shading};
pub use grid_surface::GridSurface;

pub use inside::Inside;
pub(crate) use interpolate::Prepared;
pub use interpolate::{CubicElement, Interpolant, Method};
pub use levels::{Levels, MAX_LEVELS};
pub use lines::{
    Flat, FlatHeight, HighSide, JoinedLake, River, RiverHeights, RiverLowering, Wall, WaterOverlap,
    densified,
};
pub(crate) use near_lines::NearLines;
pub(crate) use nesting::Nesting;
pub(crate) use point_rim::deciding;
pub(crate) use pyramid::is_height;
pub use pyramid::{Level, Pyramid, PyramidRule, SurfaceParts, TileReport, ToEarth};
pub use rasterize::{Canvas, CanvasBlock, CellValue, Dem, DemOfParts, GradientMap, GradientSource};
pub use rim_rule::RimRule;
pub(crate) use sample::along_curve;
pub use sample::{Sample, Sampler};
pub(crate) use sections::vertices_along;
pub use sections::{SectionWidths, crossing_pairs, sections};
pub use selection::{Classes, Selection, SelectionReport};
pub use simplify::{SimplifyLimit, SimplifyReport, SimplifyRule, simplify, simplify_cells};
pub use soundness::{SurfaceFlaw, shape_flaws, surface_flaws};
pub use statistics::{ErrorStatistics, Histogram};
pub use thinning::{CellPoint, Passes, Thinner, Thinning};
pub use tin::Tin;
pub use tin_report::TinReport;
pub use volume::{Volume, VolumeBase, Zones, volumes};
pub use walk::Locator;
pub(crate) use walk::stepped;
pub use water::{Water, water_triangles};
pub use window::ReadWindow;
