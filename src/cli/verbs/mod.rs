//! The verbs, one file each: from arguments to a request, then the report.

pub(super) mod check;
pub(super) mod contour;
pub(super) mod dem;
pub(super) mod demo;
pub(super) mod describe;
pub(super) mod hillshade;
pub(super) mod info;
pub(super) mod job;
pub(super) mod points;
mod tiled;
pub(super) mod tin;
pub(super) mod triangulate;
mod triangulate_space;
