//! What a surveyor says: TIN, breakline, contour, raster, hillshade.
//!
//! | I have | I want | |
//! |---|---|---|
//! | points of many classes | the ground | [`Selection`] |
//! | points and breaklines | a surface | [`TinBuilder`], which makes a [`Tin`] |
//! | a TIN | the height at a place | [`Tin::elevation`] |
//! | any surface | a DEM | [`Dem`] |
//! | any surface | contours | [`contours()`], at [`Levels`] |
//! | a DEM | contours | [`GridSurface`], which is a surface |
//! | a DEM | shaded relief | [`Hillshade`] |
//! | any surface | to know that it is sound | [`surface_flaws`], [`shape_flaws`]; of a TIN, [`Tin::check`] |
//!
//! A surface is whatever implements [`Surface`](crate::data::Surface): a [`Tin`], a
//! [`Mesh`](crate::data::Mesh) from a file, a [`GridSurface`]. What comes out is a source (of raster blocks, of
//! lines) that a writer in [`io`](crate::io) takes, so that a result need not fit into memory.
//!
//! # Conventions
//!
//! - Everything is seen in plan: x to the east, y to the north, one height for each place. Walls and
//!   overhangs cannot be held.
//! - Lengths and heights are in the units of the data. Heights are linear on each triangle.
//! - Results are functions of the set of points and lines: order and number of threads do not show.
//! - All questions take `&self`, and may be asked from many threads at once.
//!
//! # What it does not do
//!
//! Coordinates are not reprojected, ground is not told from vegetation (classes are taken as given), and
//! nothing is smoothed or thinned out.

mod builder;
mod clip;
pub mod contour;
mod crossings;
mod cut;
mod duplicates;
mod grid_surface;
mod hillshade;
mod inside;
mod levels;
mod rasterize;
mod selection;
mod soundness;
mod tin;
mod window;

pub use builder::{TinBuilder, TinReport};
pub use contour::{Contours, contours};
pub use crossings::{CrossingHeights, CrossingRule};
pub use duplicates::DuplicateRule;
pub use grid_surface::GridSurface;
pub use hillshade::{Hillshade, Light};
pub use inside::Inside;
pub use levels::{Levels, MAX_LEVELS};
pub use rasterize::Dem;
pub use selection::{Classes, Selection, SelectionReport};
pub use soundness::{SurfaceFlaw, shape_flaws, surface_flaws};
pub use tin::Tin;
pub use window::Window;
