//! Formats: bytes to [`data`](crate::data) and back. Knows no triangulation.

pub mod mesh;
mod output;

pub use output::Output;
