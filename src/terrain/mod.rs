//! What a surveyor says: TIN, breakline, contour, raster, hillshade.

mod builder;
mod rasterize;
mod tin;

pub use builder::{DuplicateRule, TinBuilder, TinReport};
pub use rasterize::Dem;
pub use tin::Tin;
