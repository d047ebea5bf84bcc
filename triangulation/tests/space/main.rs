//! Triangulations in space.

mod regular;
mod removal;
