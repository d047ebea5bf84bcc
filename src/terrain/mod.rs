//! What a surveyor says: TIN, breakline, contour, raster, hillshade.

mod builder;
mod selection;
mod tin;

pub use builder::{DuplicateRule, TinBuilder, TinReport};
pub use selection::{Classes, Columns, Selection, SelectionReport};
pub use tin::Tin;
