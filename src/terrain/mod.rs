//! What a surveyor says: TIN, breakline, contour, raster, hillshade.

mod builder;
mod hillshade;
mod rasterize;
mod tin;

pub use builder::{DuplicateRule, TinBuilder, TinReport};
pub use hillshade::{Hillshade, Light};
pub use rasterize::Dem;
pub use tin::Tin;
