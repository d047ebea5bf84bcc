//! What callers ask of readers.

pub(crate) mod cut;
pub(crate) mod las;
pub(crate) mod layer;
#[cfg(any(feature = "gdal", feature = "gpkg"))]
pub(crate) mod layers;
pub(crate) mod map_sheet;
pub(crate) mod plot;
pub(crate) mod points;
