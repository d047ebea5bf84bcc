//! What a surveyor says: TIN, breakline, contour, raster, hillshade.

mod builder;
mod tin;

pub use builder::{DuplicateRule, TinBuilder, TinReport};
pub use tin::Tin;
