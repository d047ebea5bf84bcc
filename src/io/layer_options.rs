//! What is read of a vector layer.

/// The attributes to read of a vector layer. Names are compared as written, else in any case.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options<'a> {
    /// The attribute that contains the heights; without one, they come from the geometry.
    pub height_field: Option<&'a str>,
    /// The attributes whose numbers are returned as
    /// [`Layer::columns`](crate::data::Layer::columns), in this order. One that does not exist is
    /// an error, and so is a value that is not a number.
    pub columns: &'a [&'a str],
}
