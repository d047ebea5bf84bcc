//! Lines and areas: from layers to what a TIN takes, and what looks wrong about them.

pub(crate) mod crossings;
pub(crate) mod inputs;
pub(crate) mod layers;
pub(crate) mod notes;
pub(crate) mod rings;
pub(crate) mod shapes;
