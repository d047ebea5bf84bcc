//! Formats: bytes to [`data`](crate::data) and back. Knows no triangulation.

mod output;

pub use output::Output;
