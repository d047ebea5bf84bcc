//! A GeoJSON document as it is, with properties appended to its features.

use std::ops::Range;

use serde_json::Value;

use crate::error::{Error, Result, Setting, wording};

/// A document of features that are points.
#[derive(Debug)]
pub struct PointFeatures {
    text: Vec<u8>,
    features: Vec<Feature>,
}

/// A feature in the text.
#[derive(Debug)]
struct Feature {
    /// x and y; NaN of a feature without a geometry.
    position: [f64; 2],
    /// Where members are added.
    slot: Slot,
}

/// Where the members of a feature's properties are added.
#[derive(Debug)]
enum Slot {
    /// Before the end of its properties, which are empty or not.
    Before { end: usize, is_empty: bool },
    /// Instead of `null`.
    Instead(Range<usize>),
    /// After the brace of the feature, which has no properties.
    After(usize),
}

impl PointFeatures {
    /// Finds the features in a text.
    ///
    /// # Errors
    /// If it is not a FeatureCollection or a Feature of GeoJSON, a feature is not a point, or has a
    /// property of one of the names already.
    pub fn read(text: Vec<u8>, names: &[String]) -> Result<Self> {
        // The scan below relies on it.
        let root: Value = serde_json::from_slice(text.strip_prefix(BOM).unwrap_or(&text))
            .map_err(|e| Error::format(format!("not JSON: {e}")))?;
        let start = blank(&text, text.strip_prefix(BOM).map_or(0, |_| BOM.len()));
        let kind = root.get("type").and_then(Value::as_str);
        let mut features = Vec::new();
        match kind {
            Some("FeatureCollection") => {
                let list = member(&text, start, "features")
                    .filter(|list| text[list.start] == b'[')
                    .ok_or_else(|| Error::format("not GeoJSON: no features"))?;
                for (i, range) in items(&text, list.start).into_iter().enumerate() {
                    let at = |e: Error| e.at(format!("feature {}", i + 1));
                    features.push(feature(&text, range, names).map_err(at)?);
                }
            }
            Some("Feature") => {
                let range = start..value_end(&text, start);
                features.push(feature(&text, range, names)?);
            }
            _ => {
                return Err(
                    Error::unsupported("neither a FeatureCollection nor a Feature")
                        .cure("properties are added to features: save it as a FeatureCollection"),
                );
            }
        }
        Ok(PointFeatures { text, features })
    }

    /// Returns the position of each feature; NaN of one without a geometry.
    pub fn positions(&self) -> Vec<[f64; 2]> {
        self.features
            .iter()
            .map(|feature| feature.position)
            .collect()
    }

    /// Returns the text with numbers added to the properties of each feature; `null` for NaN.
    /// `numbers` has those of all features, as many for each as there are names.
    pub fn with_numbers(&self, names: &[String], numbers: &[f64]) -> Vec<u8> {
        let quoted: Vec<String> = names
            .iter()
            .map(|name| Value::from(name.as_str()).to_string())
            .collect();
        let mut out = Vec::with_capacity(self.text.len() + numbers.len() * 32);
        let mut copied = 0;
        for (i, feature) in self.features.iter().enumerate() {
            let of_feature = numbers.iter().skip(i * names.len());
            let members: Vec<String> = quoted
                .iter()
                .zip(of_feature)
                .map(|(name, number)| match number.is_finite() {
                    true => format!("{name}:{number}"),
                    false => format!("{name}:null"),
                })
                .collect();
            let members = members.join(",");
            let (until, from, text) = match &feature.slot {
                Slot::Before {
                    end,
                    is_empty: true,
                } => (*end, *end, members),
                Slot::Before { end, .. } => (*end, *end, format!(",{members}")),
                Slot::Instead(null) => (null.start, null.end, format!("{{{members}}}")),
                Slot::After(brace) => (*brace, *brace, format!("\"properties\":{{{members}}},")),
            };
            out.extend_from_slice(&self.text[copied..until]);
            out.extend_from_slice(text.as_bytes());
            copied = from;
        }
        out.extend_from_slice(&self.text[copied..]);
        out
    }
}

const BOM: &[u8] = b"\xef\xbb\xbf";

fn feature(text: &[u8], range: Range<usize>, names: &[String]) -> Result<Feature> {
    if text.get(range.start) != Some(&b'{') {
        return Err(Error::format("not a Feature"));
    }
    let parsed = |range: Range<usize>| serde_json::from_slice::<Value>(&text[range]).ok();
    let geometry = member(text, range.start, "geometry").and_then(parsed);
    let position = match geometry {
        None | Some(Value::Null) => [f64::NAN; 2],
        Some(geometry) => {
            let coordinates = geometry.get("coordinates");
            let axis = |i: usize| coordinates?.get(i)?.as_f64();
            let is_point = geometry.get("type").and_then(Value::as_str) == Some("Point");
            match (is_point, axis(0), axis(1)) {
                (true, Some(x), Some(y)) => [x, y],
                _ => {
                    return Err(Error::unsupported("the geometry is not a point")
                        .cure("leave out what is not a Point"));
                }
            }
        }
    };
    let properties = member(text, range.start, "properties");
    let slot = match properties {
        None => Slot::After(range.start + 1),
        Some(range) if text[range.start] == b'{' => {
            let members = parsed(range.clone()).unwrap_or_default();
            let is_there = |name: &&String| {
                let keys = members.as_object().map(|members| members.keys());
                keys.is_some_and(|mut keys| keys.any(|key| key.eq_ignore_ascii_case(name)))
            };
            if let Some(name) = names.iter().find(is_there) {
                return Err(
                    Error::usage(format!("there is a property {name} already")).cure(wording![
                        "give the new ones other names with ",
                        Setting::Prefix.text("new_")
                    ]),
                );
            }
            Slot::Before {
                end: range.end - 1,
                is_empty: members.as_object().is_none_or(|members| members.is_empty()),
            }
        }
        Some(range) if &text[range.clone()] == b"null" => Slot::Instead(range),
        Some(_) => return Err(Error::format("its properties are not an object")),
    };
    Ok(Feature { position, slot })
}

// The text is JSON, so that brackets match and strings end. Still no index is trusted.

/// Returns the position of the next byte that is not blank.
fn blank(text: &[u8], at: usize) -> usize {
    let rest = text.get(at..).unwrap_or_default();
    at + rest
        .iter()
        .position(|byte| !byte.is_ascii_whitespace())
        .unwrap_or(rest.len())
}

/// Returns the end of the string that begins at a quote.
fn string_end(text: &[u8], start: usize) -> usize {
    let mut at = start + 1;
    while let Some(byte) = text.get(at) {
        match byte {
            b'\\' => at += 2,
            b'"' => return at + 1,
            _ => at += 1,
        }
    }
    text.len()
}

/// Returns the end of the value that begins at a position.
fn value_end(text: &[u8], start: usize) -> usize {
    let mut depth = 0_usize;
    let mut at = start;
    while let Some(byte) = text.get(at) {
        match byte {
            b'"' => {
                at = string_end(text, at);
                if depth == 0 {
                    return at;
                }
                continue;
            }
            b'{' | b'[' => depth += 1,
            b'}' | b']' if depth == 0 => return at,
            b'}' | b']' => {
                depth -= 1;
                if depth == 0 {
                    return at + 1;
                }
            }
            b',' if depth == 0 => return at,
            byte if depth == 0 && byte.is_ascii_whitespace() => return at,
            _ => {}
        }
        at += 1;
    }
    text.len()
}

/// Returns the value of the last member with a name of the object that begins at a brace.
fn member(text: &[u8], brace: usize, name: &str) -> Option<Range<usize>> {
    let mut found = None;
    let mut at = blank(text, brace + 1);
    while text.get(at) == Some(&b'"') {
        let end = string_end(text, at);
        let key: Option<String> = serde_json::from_slice(text.get(at..end)?).ok();
        let value = blank(text, blank(text, end) + 1);
        let value_end = value_end(text, value);
        if key.as_deref() == Some(name) && value < value_end {
            found = Some(value..value_end);
        }
        at = blank(text, value_end);
        if text.get(at) != Some(&b',') {
            break;
        }
        at = blank(text, at + 1);
    }
    found
}

/// Returns the items of the list that begins at a bracket.
fn items(text: &[u8], bracket: usize) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut at = blank(text, bracket + 1);
    while at < text.len() && text[at] != b']' {
        let end = value_end(text, at);
        found.push(at..end);
        at = blank(text, end);
        if text.get(at) != Some(&b',') {
            break;
        }
        at = blank(text, at + 1);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn added(text: &str, numbers: &[f64]) -> Result<String> {
        let names = ["z\"1".to_owned(), "s".to_owned()];
        let features = PointFeatures::read(text.as_bytes().to_vec(), &names)?;
        assert_eq!(features.positions().len() * 2, numbers.len());
        let out = features.with_numbers(&names, numbers);
        let _: Value = serde_json::from_slice(&out).unwrap();
        Ok(String::from_utf8(out).unwrap())
    }

    #[test]
    fn all_else_stays_byte_by_byte() {
        let text = r#" { "a}" : [ "\"features\":[" , {"features":[1]} ], "type":"FeatureCollection",
 "features" : [ {"type":"Feature","properties":{ "name" : "a \"]}" },"geometry":{"type":"Point","coordinates":[1,2,3]}} ,
 {"properties":{ }, "type":"Feature","geometry":null},{"type":"Feature","properties":null,"geometry":{"type":"Point","coordinates":[1.50,2]}},
 {"type":"Feature","geometry":{"coordinates":[-1e1,2],"type":"Point"}} ] } "#;
        let out = added(text, &[1.5, 2.0, f64::NAN, 0.1, 3.0, 4.0, 5.0, -6.0]).unwrap();
        let expected = text
            .replace("\"a \\\"]}\" }", "\"a \\\"]}\" ,\"z\\\"1\":1.5,\"s\":2}")
            .replace("{ }", "{ \"z\\\"1\":null,\"s\":0.1}")
            .replace("\"properties\":null", "\"properties\":{\"z\\\"1\":3,\"s\":4}")
            .replace(
                "{\"type\":\"Feature\",\"geometry\":{\"coordinates\"",
                "{\"properties\":{\"z\\\"1\":5,\"s\":-6},\"type\":\"Feature\",\"geometry\":{\"coordinates\"",
            );
        assert_eq!(out, expected);
    }

    #[test]
    fn positions_are_those_of_points() {
        let text =
            r#"{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[7,8]}}"#;
        let features = PointFeatures::read(text.as_bytes().to_vec(), &[]).unwrap();
        assert_eq!(features.positions(), [[7.0, 8.0]]);
        for (wrong, said) in [
            ("[1]", "neither a FeatureCollection"),
            ("{", "not JSON"),
            (r#"{"type":"FeatureCollection"}"#, "no features"),
            (
                r#"{"type":"FeatureCollection","features":[3]}"#,
                "feature 1: not a Feature",
            ),
            (
                r#"{"type":"Feature","geometry":{"type":"LineString","coordinates":[[1,2],[3,4]]}}"#,
                "not a point",
            ),
            (
                r#"{"type":"Feature","properties":[],"geometry":null}"#,
                "its properties are not an object",
            ),
            (
                r#"{"type":"Feature","properties":{"S":1},"geometry":null}"#,
                "there is a property s already",
            ),
        ] {
            let error =
                PointFeatures::read(wrong.as_bytes().to_vec(), &["s".to_owned()]).unwrap_err();
            assert!(error.to_string().contains(said), "{error}");
        }
    }

    #[test]
    fn damaged_texts_are_errors_or_stay_json() {
        let text = r#"{"type":"FeatureCollection","features":[{"type":"Feature","properties":{"a":[1,{"b":"\"]}"}]},"geometry":{"type":"Point","coordinates":[1,2]}},{"type":"Feature","properties":null,"geometry":null}]}"#;
        let names = ["z".to_owned()];
        let mut random = testkit::random::Random(90);
        let mut read = 0;
        for _ in 0..20_000 {
            let mut bytes = text.as_bytes().to_vec();
            for _ in 0..1 + random.index(3) {
                let at = random.index(bytes.len());
                match random.index(3) {
                    0 => drop(bytes.remove(at)),
                    1 => bytes.insert(at, random.pick(b"{}[]\",:\\ 1n")),
                    _ => bytes[at] = random.pick(b"{}[]\",:\\ 1n"),
                }
            }
            let Ok(features) = PointFeatures::read(bytes, &names) else {
                continue;
            };
            read += 1;
            let numbers = vec![0.5; features.positions().len()];
            let out = features.with_numbers(&names, &numbers);
            let parsed: Value = serde_json::from_slice(&out).unwrap();
            let found = parsed.to_string().matches("\"z\":0.5").count();
            assert_eq!(found, numbers.len(), "{}", String::from_utf8_lossy(&out));
        }
        assert!(read > 100, "{read}");
    }
}
