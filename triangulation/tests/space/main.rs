//! Triangulations in space.

mod removal;
