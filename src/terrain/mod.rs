//! What a surveyor says: TIN, breakline, contour, raster, hillshade.

mod builder;
mod clip;
mod duplicates;
mod soundness;
mod tin;

pub use builder::{TinBuilder, TinReport};
pub use duplicates::DuplicateRule;
pub use soundness::{SurfaceFlaw, surface_flaws};
mod hillshade;
mod rasterize;
mod tin;

pub use builder::{DuplicateRule, TinBuilder, TinReport};
pub use hillshade::{Hillshade, Light};
pub use rasterize::Dem;
pub mod contour;
mod grid_surface;
mod levels;
mod tin;

pub use builder::{DuplicateRule, TinBuilder, TinReport};
pub use contour::{Contours, contours};
pub use grid_surface::GridSurface;
pub use levels::{Levels, MAX_LEVELS};
mod selection;
mod tin;

pub use builder::{DuplicateRule, TinBuilder, TinReport};
pub use selection::{Classes, Columns, Selection, SelectionReport};
pub use tin::Tin;
