//! Contours of a map, for formats that take them with their labels in one file.

use crate::data::{Layer, Value};

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

/// Returns the values of an attribute of a layer, one for each shape.
pub(crate) fn values<'a>(layer: &'a Layer, name: &str) -> Option<Vec<&'a Value>> {
    let attributes = layer.attributes.as_ref()?;
    let number = attributes.names.iter().position(|own| own == name)?;
    Some(attributes.column(number).collect())
}
