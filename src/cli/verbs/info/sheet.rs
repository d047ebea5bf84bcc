use std::borrow::Cow;
use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::cli::report::systems::crs_json;
use crate::cli::report::{escape, names};
use crate::crs::Crs;
use crate::data::Bounds;
use crate::error::Wording;
use crate::run::units::neat;

/// The facts about a file, each stated once for text and for JSON.
#[derive(Debug, Default)]
pub(super) struct Sheet {
    rows: Vec<Row>,
    pub(super) warnings: Vec<Wording>,
}

#[derive(Debug)]
struct Row {
    key: Cow<'static, str>,
    /// `None` if the fact appears only in JSON.
    text: Option<String>,
    value: Value,
}

impl Sheet {
    /// A sheet with warnings and no facts yet.
    pub(super) fn with_warnings(warnings: Vec<Wording>) -> Self {
        Sheet {
            rows: Vec::new(),
            warnings,
        }
    }

    /// Adds a fact with a text and a value.
    pub(super) fn row(
        &mut self,
        key: impl Into<Cow<'static, str>>,
        text: impl Into<String>,
        value: impl Into<Value>,
    ) {
        self.rows.push(Row {
            key: key.into(),
            text: Some(text.into()),
            value: value.into(),
        });
    }

    /// Adds a fact whose text is its value.
    pub(super) fn plain(&mut self, key: &'static str, value: impl Into<Value>) {
        let value = value.into();
        let text = match &value {
            Value::String(text) => text.clone(),
            Value::Number(number) => number
                .as_f64()
                .filter(|_| number.is_f64())
                .map_or(number.to_string(), neat),
            other => other.to_string(),
        };
        self.rows.push(Row {
            key: key.into(),
            text: Some(text),
            value,
        });
    }

    /// Adds a fact that appears only in JSON.
    pub(super) fn silent(&mut self, key: &'static str, value: impl Into<Value>) {
        self.rows.push(Row {
            key: key.into(),
            text: None,
            value: value.into(),
        });
    }

    /// Adds the extent, or that there is none.
    pub(super) fn bounds(&mut self, bounds: Bounds) {
        if bounds.is_empty() {
            return self.row("bounds", "none", Value::Null);
        }
        let axis = |i: usize, name: &str| {
            format!("{name} {} .. {}", neat(bounds.min[i]), neat(bounds.max[i]))
        };
        let mut text = format!("{}, {}", axis(0, "x"), axis(1, "y"));
        // Without any height the box is empty in z.
        if bounds.min[2] <= bounds.max[2] {
            text += &format!(", {}", axis(2, "z"));
        }
        self.row(
            "bounds",
            text,
            json!({ "min": finite(bounds.min), "max": finite(bounds.max) }),
        );
    }

    /// Adds the coordinate system, or that there is none.
    pub(super) fn crs(&mut self, crs: Option<&Crs>) {
        let Some(crs) = crs else {
            return self.row("crs", "not stated", Value::Null);
        };
        self.row("crs", crs.describe(), crs_json(crs));
    }

    /// Returns the facts as text; warnings are printed elsewhere.
    pub(super) fn to_text(&self, name: &str) -> String {
        let mut text = format!("{}\n", escape::line(name));
        for row in &self.rows {
            if let Some(words) = &row.text {
                // Writing to a string cannot fail.
                let _ = writeln!(
                    text,
                    "  {:<10} {}",
                    row.key.replace('_', " "),
                    escape::line(words)
                );
            }
        }
        text
    }

    /// Returns the facts and the warnings as JSON.
    pub(super) fn to_json(&self, name: &str) -> Value {
        let mut object = Map::new();
        object.insert("file".to_owned(), json!(name));
        for row in &self.rows {
            object.insert(row.key.to_string(), row.value.clone());
        }
        let warnings: Vec<String> = self
            .warnings
            .iter()
            .map(|text| text.render(&names::name))
            .collect();
        object.insert("warnings".to_owned(), json!(warnings));
        Value::Object(object)
    }
}

/// Returns coordinates as JSON numbers; null for those that are not finite.
fn finite(values: [f64; 3]) -> [Option<f64>; 3] {
    values.map(|value| Some(value).filter(|value| value.is_finite()))
}
