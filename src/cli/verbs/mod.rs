//! The verbs, one file each: from arguments to a request, then the report.

pub(super) mod accuracy;
mod asked;
pub(super) mod check;
pub(super) mod compare;
mod contour;
pub(super) mod crs;
mod dem;
pub(super) mod demo;
pub(super) mod describe;
pub(super) mod drape;
mod hillshade;
pub(super) mod info;
pub(super) mod job;
mod pair;
pub(super) mod points;
mod product;
pub(super) mod profile;
mod quantity;
mod relief;
pub(super) mod run;
pub(super) mod sample;
pub(super) mod shell;
mod tin;
pub(super) mod triangulate;
mod triangulate_space;
pub(super) mod volume;
pub(super) mod write;
