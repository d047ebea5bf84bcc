//! Checks and queries of triangulations of space.

mod check;
mod queries;
