//! A JSON value that is read under watch.

use std::cell::Cell;
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};

use super::watch::Watch;
use crate::error::{Error, Result};

/// Values of a long list between two calls of a watch.
pub(crate) const VALUES_AT_ONCE: usize = 1 << 10;

/// Returns the value that a text contains. The watch is called between the members of the list
/// `features` of the outermost object, which is what is long in GeoJSON.
///
/// # Errors
/// That of the watch. If the text is not JSON, the inner result says so.
pub(crate) fn of(bytes: &[u8], watch: Watch) -> Result<serde_json::Result<Value>> {
    let mut parser = serde_json::Deserializer::from_slice(bytes);
    let state = State {
        watch,
        ended: Cell::new(None),
    };
    let value = Root(&state)
        .deserialize(&mut parser)
        .and_then(|root| parser.end().map(|()| root));
    if let Some(error) = state.ended.take() {
        return Err(error);
    }
    match value {
        // JSON of another shape.
        Err(error) if error.is_data() => Ok(serde_json::from_slice(bytes)),
        value => Ok(value),
    }
}

struct State<'a> {
    watch: Watch<'a>,
    /// The error of the watch; the parser only gets its text.
    ended: Cell<Option<Error>>,
}

struct Root<'a>(&'a State<'a>);

struct Features<'a>(&'a State<'a>);

impl<'de> DeserializeSeed<'de> for Root<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, parser: D) -> std::result::Result<Value, D::Error> {
        parser.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Root<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut members: M) -> std::result::Result<Value, M::Error> {
        let mut map = Map::new();
        while let Some(key) = members.next_key::<String>()? {
            let value = match key.as_str() {
                "features" => members.next_value_seed(Features(self.0))?,
                _ => members.next_value()?,
            };
            map.insert(key, value);
        }
        Ok(Value::Object(map))
    }
}

impl<'de> DeserializeSeed<'de> for Features<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, parser: D) -> std::result::Result<Value, D::Error> {
        parser.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for Features<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a list")
    }

    fn visit_seq<S: SeqAccess<'de>>(self, mut members: S) -> std::result::Result<Value, S::Error> {
        let mut list = Vec::new();
        while let Some(value) = members.next_element()? {
            list.push(value);
            if list.len() % VALUES_AT_ONCE == 0 {
                (self.0.watch)(0).map_err(|error| {
                    let text = S::Error::custom(&error);
                    self.0.ended.set(Some(error));
                    text
                })?;
            }
        }
        Ok(Value::Array(list))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Kind;
    use crate::io::bytes::watch::unwatched;

    #[test]
    fn values_are_those_of_the_parser() {
        for text in [
            r#"{"type": "FeatureCollection", "features": [{"a": 1.5e-3, "features": 7}, [], null], "crs": null}"#,
            r#"{"features": [1], "features": [2, 3]}"#,
            r#"{"features": {"a": [1]}, "b": [true]}"#,
            r#"{"features": 1}"#,
            "[1, 2]",
            "7",
            "{}",
            "{\"features\": [1, 2",
            "{\"features\": [1]} x",
            "[1,]",
            "",
            "\"a",
        ] {
            let expected = serde_json::from_str::<Value>(text);
            let found = of(text.as_bytes(), &unwatched).unwrap();
            match (&found, &expected) {
                (Ok(found), Ok(expected)) => assert_eq!(found, expected, "{text}"),
                (Err(found), Err(expected)) => {
                    assert_eq!(found.to_string(), expected.to_string(), "{text}")
                }
                _ => panic!("{text}: {found:?} {expected:?}"),
            }
        }
    }

    #[test]
    fn a_long_list_is_left_when_the_watch_says_so() {
        let text = format!("{{\"features\": [{}0]}}", "0,".repeat(10 * VALUES_AT_ONCE));
        let error = of(text.as_bytes(), &|_| Err(Error::canceled())).unwrap_err();
        assert_eq!(error.kind(), Kind::Canceled);
        assert!(of(text.as_bytes(), &unwatched).unwrap().is_ok());
    }
}
