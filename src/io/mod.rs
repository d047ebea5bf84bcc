//! Formats: bytes to [`data`](crate::data) and back. Knows no triangulation.

pub mod las;
mod output;
pub mod points;
pub mod text;

pub use output::Output;
