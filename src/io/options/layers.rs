//! Which layer and which attributes are read of a file that may have several layers.

use super::layer::Options;
use crate::data::named;
use crate::error::{Error, Result};
use crate::io::bytes::field::no_such_field;

impl Options<'_> {
    /// Returns the position of the layer to read among the names of all, and the attribute of the
    /// heights. Names of layers may contain colons, which [`Spec`](crate::io::layer::Spec) takes
    /// for the begin of an attribute. `is_field` tells whether the only layer has an attribute.
    ///
    /// # Errors
    /// If there is no such layer; if there are several and none is named.
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
