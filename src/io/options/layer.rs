//! What is read of a vector file.

use super::condition::Condition;
use super::cut::OnDamage;
use crate::data::{Column, Layer};
use crate::error::{Error, Result};

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
    /// Which records are returned; `None` for all. Evaluated of the attributes that
    /// [`keeps_attributes`](Self::keeps_attributes) would return: of GeoPackage and FlatGeobuf as
    /// they are read, so that others are not kept; of other formats when the layer has been read.
    pub condition: Option<&'a Condition>,
    /// What to do with files of which a part is missing or damaged.
    pub cut: OnDamage,
}

impl Options<'_> {
    /// Returns the requested columns, still without numbers.
    pub(crate) fn empty_columns(&self) -> Vec<Column> {
        let column = |&name: &&str| Column {
            name: name.to_owned(),
            ..Column::default()
        };
        self.columns.iter().map(column).collect()
    }

    /// Reads a layer, and removes the records for which the condition, if there is one, does not
    /// hold, unless the reader has done so as it read them.
    ///
    /// # Errors
    /// Those of `read`; if the layer lacks an attribute of the condition, or the format has none
    /// that are read.
    pub(crate) fn read_chosen(
        &self,
        read: impl FnOnce(&Options) -> Result<Layer>,
    ) -> Result<Layer> {
        if self.condition.is_none() {
            return read(self);
        }
        let mut layer = read(&Options {
            keeps_attributes: true,
            ..*self
        })?;
        if layer.chosen.is_none() {
            self.choosing(&layer)?.finish(&mut layer)?;
        }
        if !self.keeps_attributes {
            layer.attributes = None;
        }
        Ok(layer)
    }

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
}
