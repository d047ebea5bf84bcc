//! Checks and queries of triangulations of the plane.

mod check;
mod queries;
