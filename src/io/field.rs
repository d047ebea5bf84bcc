//! Attributes of vector layers, by name.

use crate::error::Error;

/// The error for an attribute that is not there.
pub(super) fn no_such_field<'a>(name: &str, fields: impl Iterator<Item = &'a str>) -> Error {
    let fields: Vec<&str> = fields.collect();
    let error = Error::usage(format!("there is no field {name}"));
    match fields[..] {
        [] => error.cure("the file has no fields; heights can only come from its geometry"),
        _ => error.cure(format!("name one of {}", fields.join(", "))),
    }
}
