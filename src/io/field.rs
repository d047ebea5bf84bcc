//! Attributes of vector layers, looked up by name.

use crate::error::Error;

/// Returns the error for an attribute that does not exist; it lists the ones that do.
pub(super) fn no_such_field<'a>(name: &str, fields: impl Iterator<Item = &'a str>) -> Error {
    let fields: Vec<&str> = fields.collect();
    let error = Error::usage(format!("there is no field {name}"));
    match fields[..] {
        [] => error.cure("the file has no fields; heights can only come from its geometry"),
        _ => error.cure(format!("name one of {}", fields.join(", "))),
    }
}
