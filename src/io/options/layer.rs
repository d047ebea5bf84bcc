//! What is read of a vector file.

use super::cut::OnDamage;
use crate::data::named;
use crate::error::{Error, Result};
use crate::io::bytes::field::no_such_field;

/// The layer and the attributes to read of a vector file. Names are compared as written, else in
/// any case.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options<'a> {
    /// The layer; `None` for the only one. Where a file is one layer, it has the name of the file
    /// without its extension; GeoJSON may state another.
    pub layer: Option<&'a str>,
    /// The attribute that contains the heights; without one, they come from the geometry.
    pub height_field: Option<&'a str>,
    /// The attributes whose numbers are returned in
    /// [`Layer::columns`](crate::data::Layer::columns), in this order. One that does not exist is
    /// an error, and so is a value that is not a number.
    pub columns: &'a [&'a str],
    /// Whether all attributes are returned in
    /// [`Layer::attributes`](crate::data::Layer::attributes), for a copy of the layer. The readers
    /// of shapefiles, GeoPackage and GeoJSON keep them.
    pub keeps_attributes: bool,
    /// What to do with files of which a part is missing or damaged.
    pub cut: OnDamage,
}

impl Options<'_> {
    /// Returns an error if a layer is requested that has none of the names of the file's only one.
    pub(crate) fn check_layer(&self, names: &[&str]) -> Result<()> {
        match self.layer {
            Some(layer) if !names.iter().any(|name| name.eq_ignore_ascii_case(layer)) => {
                let field = self.height_field.unwrap_or("FIELD");
                let cure = format!(
                    "its only layer is \"{}\": name that, or write FILE::{field}",
                    names.join("\" or \"")
                );
                Err(Error::usage(format!("there is no layer \"{layer}\"")).cure(cure))
            }
            _ => Ok(()),
        }
    }

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
