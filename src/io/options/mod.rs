//! What callers ask of readers.

pub(crate) mod choosing;
pub(crate) mod condition;
pub(crate) mod cut;
pub(crate) mod las;
pub(crate) mod layer;
pub(crate) mod layers;
pub(crate) mod map_sheet;
pub(crate) mod plot;
pub(crate) mod points;
