//! What verbs make: surfaces, and what is computed from them; points; facts.

pub(crate) mod accuracy;
pub(crate) mod cells;
pub(crate) mod changed;
pub(crate) mod check;
pub(crate) mod compare;
pub(crate) mod contour;
mod contour_rows;
pub(crate) mod drape;
pub(crate) mod edge_limit;
pub(crate) mod elevation;
pub(crate) mod facts;
mod followed;
pub(crate) mod frame;
pub(crate) mod lattice;
pub(crate) mod overlaps;
pub(crate) mod points;
pub(crate) mod profile;
mod reach;
pub(crate) mod relief;
pub(crate) mod sample;
pub(super) mod simplified;
pub(crate) mod station_format;
pub(crate) mod surface;
mod thinned;
pub(crate) mod tin;
mod together;
pub(crate) mod volume;
