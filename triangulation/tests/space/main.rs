//! Triangulations in space.

mod alpha;
mod bulk;
mod bulk_regular;
mod facts;
mod queries;
mod regular;
mod removal;
