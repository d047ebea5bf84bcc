//! Triangulations in space.

mod bulk;
mod bulk_regular;
mod queries;
mod regular;
mod removal;
