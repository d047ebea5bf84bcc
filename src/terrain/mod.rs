//! What a surveyor says: TIN, breakline, contour, raster, hillshade.

mod builder;
mod clip;
pub mod contour;
mod duplicates;
mod grid_surface;
mod hillshade;
mod levels;
mod rasterize;
mod selection;
mod soundness;
mod tin;

pub use builder::{TinBuilder, TinReport};
pub use contour::{Contours, contours};
pub use duplicates::DuplicateRule;
pub use grid_surface::GridSurface;
pub use hillshade::{Hillshade, Light};
pub use levels::{Levels, MAX_LEVELS};
pub use rasterize::Dem;
pub use selection::{Classes, Selection, SelectionReport};
pub use soundness::{SurfaceFlaw, surface_flaws};
pub use tin::Tin;
