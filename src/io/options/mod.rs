//! What callers ask of readers.

pub(crate) mod cut;
pub(crate) mod las;
pub(crate) mod layer;
pub(crate) mod plot;
pub(crate) mod points;
