//! Triangulations in space.

mod queries;
mod regular;
mod removal;
