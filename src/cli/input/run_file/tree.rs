//! Tables with the lines that they are on, from TOML or JSON.

use serde_json::Value as Json;
use toml::de::{DeTable, DeValue};

use crate::error::{Error, Result};

/// A key with its value.
#[derive(Debug)]
pub(super) struct Entry {
    pub(super) key: String,
    /// The line that it is on, if it is in a file.
    pub(super) line: Option<usize>,
    pub(super) value: Value,
}

/// A value. Numbers are words as they are typed.
#[derive(Debug)]
pub(super) enum Value {
    Bool(bool),
    Word(String),
    /// Values, each with its line.
    List(Vec<(Option<usize>, Value)>),
    Table(Vec<Entry>),
    /// A date or a time.
    Date,
}

impl Value {
    /// Returns what it is, with an article.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Value::Bool(_) => "true or false",
            Value::Word(_) => "one value",
            Value::List(_) => "a list",
            Value::Table(_) => "a table",
            Value::Date => "a date",
        }
    }
}

/// Returns the entries of a TOML text.
///
/// # Errors
/// With the line, if it is not TOML.
pub(super) fn of_toml(text: &str) -> Result<Vec<Entry>> {
    let line_at = |start: usize| 1 + ends_of_lines(text.as_bytes(), start.min(text.len()));
    let table = DeTable::parse(text).map_err(|e| {
        let message = e.message().trim().replace('\n', ": ");
        let found = e.span().and_then(|span| text.get(span)).unwrap_or_default();
        let error = Error::format(match message.as_str() {
            // Which one, it does not say.
            "duplicate key" if !found.is_empty() => format!("`{found}` is there twice"),
            _ => message,
        });
        match e.span() {
            Some(span) => error.at(format!("line {}", line_at(span.start))),
            None => error,
        }
    })?;
    Ok(entries(table.get_ref(), &line_at))
}

fn entries(table: &DeTable, line_at: &dyn Fn(usize) -> usize) -> Vec<Entry> {
    let all = table.iter().map(|(key, value)| Entry {
        key: key.get_ref().to_string(),
        line: Some(line_at(key.span().start)),
        value: of_value(value.get_ref(), line_at),
    });
    let mut entries: Vec<Entry> = all.collect();
    // In the order of the file.
    entries.sort_by_key(|entry| entry.line);
    entries
}

fn of_value(value: &DeValue, line_at: &dyn Fn(usize) -> usize) -> Value {
    match value {
        DeValue::Boolean(value) => Value::Bool(*value),
        DeValue::String(text) => Value::Word(text.to_string()),
        DeValue::Float(number) => Value::Word(number.as_str().to_owned()),
        DeValue::Integer(number) => {
            let digits = number.as_str();
            let other =
                (number.radix() != 10).then(|| i128::from_str_radix(digits, number.radix()));
            Value::Word(match other {
                Some(Ok(value)) => value.to_string(),
                // Too large: options refuse it as it is typed.
                Some(Err(_)) => format!("{}{digits}", prefix(number.radix())),
                None => digits.to_owned(),
            })
        }
        DeValue::Datetime(_) => Value::Date,
        DeValue::Array(list) => Value::List(
            list.iter()
                .map(|item| {
                    let line = line_at(item.span().start);
                    (Some(line), of_value(item.get_ref(), line_at))
                })
                .collect(),
        ),
        DeValue::Table(table) => Value::Table(entries(table, line_at)),
    }
}

/// Returns what numbers of a base begin with.
fn prefix(radix: u32) -> &'static str {
    match radix {
        2 => "0b",
        8 => "0o",
        _ => "0x",
    }
}

/// Returns the entries of a JSON object; `null` is left out.
///
/// # Errors
/// If it is not a JSON object.
pub(super) fn of_json(text: &str) -> Result<Vec<Entry>> {
    match serde_json::from_str(text).map_err(|e| Error::format(e.to_string()))? {
        Json::Object(object) => Ok(of_object(object)),
        _ => Err(Error::format("a run consists of tables: input and product")),
    }
}

fn of_object(object: serde_json::Map<String, Json>) -> Vec<Entry> {
    let entry = |(key, value)| {
        Some(Entry {
            key,
            line: None,
            value: of_json_value(value)?,
        })
    };
    object.into_iter().filter_map(entry).collect()
}

fn of_json_value(value: Json) -> Option<Value> {
    Some(match value {
        Json::Null => return None,
        Json::Bool(value) => Value::Bool(value),
        Json::Number(number) => Value::Word(number.to_string()),
        Json::String(text) => Value::Word(text),
        Json::Array(list) => Value::List(
            list.into_iter()
                .filter_map(|item| Some((None, of_json_value(item)?)))
                .collect(),
        ),
        Json::Object(object) => Value::Table(of_object(object)),
    })
}

/// Returns the number of ends of lines in the first bytes of a text.
pub(super) fn ends_of_lines(text: &[u8], end: usize) -> usize {
    text[..end].iter().filter(|&&byte| byte == b'\n').count()
}
