//! The tables of a run file.

use std::path::{Path, PathBuf};

use super::nearest::nearest;
use super::product_words::ProductWords;
use super::tree::{self, Entry, Value, ends_of_lines};
use crate::error::{Error, Result};

/// A run file: what it says, not yet what that means.
#[derive(Debug)]
pub(crate) struct RunFile {
    /// Its name; `None` if the tables are those of a program.
    name: Option<PathBuf>,
    /// What its paths are relative to.
    pub(super) folder: PathBuf,
    pub(super) input: Vec<Entry>,
    pub(super) products: Vec<Product>,
}

/// The table of a product.
#[derive(Debug)]
pub(super) struct Product {
    /// Where it is, for errors.
    pub(super) location: String,
    pub(super) entries: Vec<Entry>,
}

impl RunFile {
    /// Reads a file.
    ///
    /// # Errors
    /// If it cannot be read, is not TOML or has other tables.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read(path).map_err(|e| Error::from(e).in_file(path))?;
        let text = String::from_utf8(text).map_err(|e| {
            let line = 1 + ends_of_lines(e.as_bytes(), e.utf8_error().valid_up_to());
            Error::format("the text is not UTF-8")
                .in_file(path)
                .at(format!("line {line}"))
        })?;
        let tables = tree::of_toml(&text).map_err(|e| e.in_file(path))?;
        let mut file = Self::of_tables(tables).map_err(|e| e.in_file(path))?;
        file.folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        file.name = Some(path.to_path_buf());
        Ok(file)
    }

    /// Reads the tables from a JSON object; paths are relative to the working directory.
    ///
    /// # Errors
    /// If it is not such an object, or has other tables.
    pub(crate) fn of_json(text: &str) -> Result<Self> {
        Self::of_tables(tree::of_json(text)?)
    }

    fn of_tables(tables: Vec<Entry>) -> Result<Self> {
        let mut file = RunFile {
            name: None,
            folder: PathBuf::new(),
            input: Vec::new(),
            products: Vec::new(),
        };
        let mut has_input = false;
        for Entry { key, line, value } in tables {
            let location = |own: String| line.map_or(own, |line| format!("line {line}"));
            match (key.as_str(), value) {
                ("input", Value::Table(entries)) => {
                    has_input = true;
                    file.input = entries;
                }
                ("product", Value::Table(entries)) => file.products.push(Product {
                    location: location("product".to_owned()),
                    entries,
                }),
                ("product", Value::List(products)) => {
                    for (i, (line, product)) in products.into_iter().enumerate() {
                        let number = format!("product {}", i + 1);
                        let location = line.map_or(number, |line| format!("line {line}"));
                        let Value::Table(entries) = product else {
                            return Err(Error::format("a product is a table").at(location).cure(
                                "begin each with [[product]], and name a verb: verb = \"dem\"",
                            ));
                        };
                        file.products.push(Product { location, entries });
                    }
                }
                ("input" | "product", value) => {
                    return Err(Error::format(format!(
                        "`{key}` is {}, and not a table",
                        value.kind()
                    ))
                    .at(location(key.clone()))
                    .cure("begin it with [input] or [[product]]"));
                }
                _ => {
                    let error = Error::usage(format!("`{key}` is not part of a run file"));
                    let cure = match nearest(&key, ["input", "product"].into_iter()) {
                        Some("product") => "did you mean [[product]]?".to_owned(),
                        Some(known) => format!("did you mean [{known}]?"),
                        None => "options are in [input], for the surface, or in a [[product]]"
                            .to_owned(),
                    };
                    return Err(error.at(location(key.clone())).cure(cure));
                }
            }
        }
        if !has_input {
            return Err(Error::usage("there is no [input]").cure(
                "begin with a line [input], and name the files of the surface in the next line: \
                 files = [\"tile.laz\"]",
            ));
        }
        match file.products.is_empty() {
            true => Err(Error::usage("there is no [[product]]").cure(
                "add a line [[product]], and below it lines such as verb = \"dem\" and \
                 output = \"dem.tif\"",
            )),
            false => Ok(file),
        }
    }

    /// Returns the name of the file; `None` if the tables are those of a program.
    pub(crate) fn name(&self) -> Option<&Path> {
        self.name.as_deref()
    }

    /// Returns an error of a product with the place of the key that it is about.
    pub(crate) fn of_product(&self, error: Error, product: &ProductWords) -> Error {
        let location = location_of(&error, &product.locations).unwrap_or(&product.location);
        match (error.path(), &self.name) {
            (Some(_), Some(name)) => error.within(format_args!(
                "product {} ({}, {location})",
                product.number,
                name.display()
            )),
            (Some(_), None) => error.within(format_args!("product {}", product.number)),
            _ => self.located(error, location),
        }
    }

    /// Returns an error of the surface with the place of the key that it is about.
    pub(crate) fn of_surface(&self, error: Error, locations: &[(String, String)]) -> Error {
        let location = location_of(&error, locations).unwrap_or("[input]");
        match (error.path(), &self.name) {
            (Some(_), Some(name)) => error.within(format_args!("[input] of {}", name.display())),
            _ => self.located(error, location),
        }
    }

    /// Returns an error with the place where it is, unless it has one.
    pub(crate) fn located(&self, error: Error, location: &str) -> Error {
        if error.path().is_some() {
            return error;
        }
        let error = match error.location() {
            Some(_) => error,
            None => error.at(location),
        };
        match &self.name {
            Some(name) => error.in_file(name),
            None => error,
        }
    }
}

/// Returns the place of the first option that a message names, if its key is among `locations`.
fn location_of<'a>(error: &Error, locations: &'a [(String, String)]) -> Option<&'a str> {
    let message = error.message().plain();
    let named = message
        .split(' ')
        .find_map(|word| word.strip_prefix("--"))?;
    let named = named.trim_end_matches([',', ':']);
    let found = locations
        .iter()
        .find(|(key, _)| key.replace('_', "-") == named);
    found.map(|(_, location)| location.as_str())
}
