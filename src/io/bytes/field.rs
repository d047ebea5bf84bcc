//! Attributes of vector layers, looked up by name.

use crate::data::Value;
use crate::error::Error;

/// Limit for the characters of a value in a message.
const MAX_SHOWN: usize = 60;

/// Returns the error for an attribute that does not exist; it lists the ones that do.
pub(crate) fn no_such_field<'a>(name: &str, fields: impl Iterator<Item = &'a str>) -> Error {
    let fields: Vec<&str> = fields.collect();
    let error = Error::usage(format!("there is no field {name}"));
    match fields[..] {
        [] => error.cure("the file has no fields; heights can only come from its geometry"),
        _ => error.cure(format!("name one of {}", fields.join(", "))),
    }
}

/// Returns the error for a value of a requested attribute that is not a number.
pub(crate) fn not_a_number(field: &str, value: &str) -> Error {
    let start: String = value.chars().take(MAX_SHOWN).collect();
    Error::format(format!("field {field}: expected a number, found '{start}'"))
        .cure("correct the value, or leave it empty if there is none")
}

/// Parses a number as people write it into tables: with a decimal point or comma. Empty text and
/// stars give NaN.
///
/// # Errors
/// Returns the text if it does not parse as a number.
pub(crate) fn parse_number(text: &str) -> std::result::Result<f64, String> {
    if text.chars().all(|c| c == '*') {
        return Ok(f64::NAN);
    }
    match text.replacen(',', ".", 1).parse() {
        Ok(value) => Ok(finite_or_none(value)),
        Err(_) => Err(text.to_owned()),
    }
}

/// Returns the number that a value is, or that its text is; NaN if there is none or it is not
/// finite.
///
/// # Errors
/// Returns the text if it does not parse as a number.
pub(crate) fn number_of(value: &Value) -> std::result::Result<f64, String> {
    let number = match value {
        Value::Missing => f64::NAN,
        Value::Whole(whole) => *whole as f64,
        Value::Number(number) => *number,
        Value::Text(text) => parse_number(text.trim())?,
        Value::Truth(truth) => return Err(truth.to_string()),
    };
    Ok(finite_or_none(number))
}

/// Returns a number, or NaN, which stands for none, if it is infinite.
pub(crate) fn finite_or_none(number: f64) -> f64 {
    if number.is_finite() { number } else { f64::NAN }
}
