use super::named::named;

/// What a record has for an attribute.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Value {
    /// Nothing.
    #[default]
    Missing,
    /// A whole number.
    Whole(i64),
    /// A number.
    Number(f64),
    /// A text; dates are texts such as `2024-05-31`.
    Text(String),
    /// True or false.
    Truth(bool),
}

impl Value {
    /// Returns the value as text; empty if there is none.
    pub(crate) fn text(&self) -> String {
        match self {
            Value::Missing => String::new(),
            Value::Whole(whole) => whole.to_string(),
            Value::Number(number) => number.to_string(),
            Value::Text(text) => text.clone(),
            Value::Truth(truth) => truth.to_string(),
        }
    }
}

/// What all values of an attribute are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ValueKind {
    Whole,
    Number,
    Truth,
    Text,
}

impl Value {
    /// Returns what the value is; `None` if it is missing.
    fn kind(&self) -> Option<ValueKind> {
        Some(match self {
            Value::Missing => return None,
            Value::Whole(_) => ValueKind::Whole,
            Value::Number(_) => ValueKind::Number,
            Value::Text(_) => ValueKind::Text,
            Value::Truth(_) => ValueKind::Truth,
        })
    }
}

/// The attributes of all records of a vector layer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Attributes {
    /// Their names, in order.
    pub names: Vec<String>,
    /// For each shape of the layer, a value for each name.
    pub rows: Vec<Vec<Value>>,
}

impl Attributes {
    /// Returns the values of the attribute with this name, as written, else in any case, as texts:
    /// one for each shape.
    pub(crate) fn texts(&self, name: &str) -> Option<Vec<String>> {
        let number = named(self.names.iter().map(String::as_str), name)?;
        Some(self.column(number).map(Value::text).collect())
    }

    /// Returns what all values of an attribute are; texts if they differ, or if there are none.
    pub(crate) fn kind(&self, number: usize) -> ValueKind {
        let kinds = self.column(number).filter_map(Value::kind);
        let common = |a, b| match (a, b) {
            (a, b) if a == b => a,
            (ValueKind::Whole | ValueKind::Number, ValueKind::Whole | ValueKind::Number) => {
                ValueKind::Number
            }
            _ => ValueKind::Text,
        };
        kinds.reduce(common).unwrap_or(ValueKind::Text)
    }

    /// Returns the values of an attribute, one for each shape.
    pub fn column(&self, number: usize) -> impl Iterator<Item = &Value> {
        let missing = &Value::Missing;
        self.rows
            .iter()
            .map(move |row| row.get(number).unwrap_or(missing))
    }
}
