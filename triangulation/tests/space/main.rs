//! Triangulations in space.

mod bulk;
mod queries;
mod regular;
mod removal;
