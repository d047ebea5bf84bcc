//! What a surveyor says: TIN, breakline, contour, raster, hillshade.

mod builder;
pub mod contour;
mod grid_surface;
mod levels;
mod tin;

pub use builder::{DuplicateRule, TinBuilder, TinReport};
pub use contour::{Contours, contours};
pub use grid_surface::GridSurface;
pub use levels::{Levels, MAX_LEVELS};
pub use tin::Tin;
