//! What readers of files with several layers share: which layer and which attributes are read, and
//! what they accept and report.

use super::layer::Options;
use crate::data::{Attributes, Layer, Shape, named};
use crate::error::{Error, Result};
use crate::io::bytes::field::no_such_field;

impl Options<'_> {
    /// Returns the position of the layer to read among the names of all, and the attribute of the
    /// heights. Names of layers may contain colons, behind which
    /// [`Spec`](crate::io::layer::Spec) expects an attribute. `is_field` returns true if the only
    /// layer has an attribute of this name.
    ///
    /// # Errors
    /// If no layer has the requested name, or none is requested and there is not exactly one.
    pub(crate) fn choose(
        &self,
        layers: &[String],
        is_field: impl Fn(&str) -> bool,
    ) -> Result<(usize, Option<String>)> {
        let field = self.height_field.map(str::to_owned);
        let list = || {
            format!(
                "name one after a colon, as FILE:LAYER: {}",
                layers.join(", ")
            )
        };
        let Some(wanted) = self.layer else {
            return match layers.len() {
                0 => Err(Error::format("there is no layer in it")),
                1 => Ok((0, field)),
                several => {
                    Err(Error::usage(format!("there are {several} layers in it")).cure(list()))
                }
            };
        };
        if let Some(layer) = position(layers, wanted) {
            return Ok((layer, field));
        }
        let whole = field
            .as_ref()
            .map_or_else(|| wanted.to_owned(), |field| format!("{wanted}:{field}"));
        if let Some(layer) = position(layers, &whole) {
            return Ok((layer, None));
        }
        let mut parts = whole
            .match_indices(':')
            .map(|(at, _)| (&whole[..at], &whole[at + 1..]));
        let found =
            parts.find_map(|(layer, field)| Some((position(layers, layer)?, field.to_owned())));
        if let Some((layer, field)) = found {
            return Ok((layer, Some(field)));
        }
        let cure = match layers.len() == 1 && is_field(wanted) {
            true => format!(
                "{}; for heights of the attribute, write FILE::{wanted}",
                list()
            ),
            false => list(),
        };
        Err(Error::usage(format!("there is no layer \"{wanted}\"")).cure(cure))
    }

    /// Returns a layer without shapes that has attributes with these names.
    pub(crate) fn empty_layer(&self, fields: Vec<String>) -> Layer {
        Layer {
            columns: self.empty_columns(),
            attributes: self.keeps_attributes.then(|| Attributes {
                names: fields.clone(),
                rows: Vec::new(),
            }),
            fields,
            ..Layer::default()
        }
    }
}

/// Limit for the nesting of geometry collections.
const MAX_DEPTH: usize = 16;

/// Returns an error if geometry collections are nested too deep.
pub(crate) fn check_depth(depth: usize) -> Result<()> {
    match depth > MAX_DEPTH {
        true => Err(Error::limit(format!(
            "geometry collections nested more than {MAX_DEPTH} deep"
        ))),
        false => Ok(()),
    }
}

/// Adds a warning that counts the records without a height, if there are any.
pub(crate) fn warn_of_missing_heights(records: usize, layer: &mut Layer) {
    if records > 0 {
        let lacking = "records without a number in the field of the heights";
        layer.warnings.push(format!("{records} {lacking}").into());
    }
}

/// Adds a warning for each attribute whose values are bytes, if attributes are kept.
pub(crate) fn warn_of_bytes<'a>(fields: impl Iterator<Item = &'a str>, layer: &mut Layer) {
    if layer.attributes.is_some() {
        let lost = fields.map(|name| format!("attribute {name} has bytes, which are left out"));
        layer.warnings.extend(lost.map(Into::into));
    }
}

/// Sets the height of shapes to the number in an attribute. Returns true if there is none.
pub(crate) fn set_heights(shapes: &mut [Shape], height: f64) -> bool {
    shapes.iter_mut().for_each(|shape| shape.set_height(height));
    height.is_nan()
}

/// Returns the position of a name among several.
fn position(names: &[String], wanted: &str) -> Option<usize> {
    named(names.iter().map(String::as_str), wanted)
}

/// The positions of the requested attributes in a layer.
pub(crate) struct Fields {
    pub(crate) height: Option<usize>,
    pub(crate) columns: Vec<usize>,
}

impl Fields {
    /// Finds the attributes among the names of all.
    ///
    /// # Errors
    /// If one does not exist.
    pub(crate) fn of(names: &[String], height: Option<&str>, columns: &[&str]) -> Result<Self> {
        let find = |wanted: &str| {
            position(names, wanted)
                .ok_or_else(|| no_such_field(wanted, names.iter().map(String::as_str)))
        };
        Ok(Fields {
            height: height.map(find).transpose()?,
            columns: columns
                .iter()
                .map(|name| find(name))
                .collect::<Result<_>>()?,
        })
    }
}
