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
pub use tin::Tin;
