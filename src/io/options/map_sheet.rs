//! Contours of a map, for formats that take them with their labels in one file.

use crate::data::Layer;

/// Contours, or the areas between them, with their labels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MapSheet<'a> {
    /// The lines, with the attributes `ELEV` and `DEPRESSION`, and `INDEX` if some are index
    /// contours; or the areas. `None` for a file of labels.
    pub(crate) shapes: Option<&'a Layer>,
    /// The labels: points with the attributes `ELEV` and `ROTATION`.
    pub(crate) labels: Option<&'a Layer>,
    /// The height of labels, in plan.
    pub(crate) text_height: f64,
}
