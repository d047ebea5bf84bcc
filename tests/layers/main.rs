//! Vector layers: every real file against its facts, every damaged one against a table, and what is
//! written against what is read.

mod damaged;
mod sound;
mod written;

use std::path::Path;

use breakline::data::Layer;
use breakline::error::Result;
use breakline::io::layer;
use serde_json::Value;

fn facts() -> serde_json::Map<String, Value> {
    let text = std::fs::read_to_string(testkit::shared("FACTS.json")).unwrap();
    // Written by Python, which has numbers that JSON has not.
    let text = text
        .replace("NaN", "null")
        .replace("-Infinity", "null")
        .replace("Infinity", "null");
    let Value::Object(facts) = serde_json::from_str(&text).unwrap() else {
        panic!("FACTS.json is no object")
    };
    facts
}

fn read(path: &Path) -> Result<Layer> {
    layer::read(path.to_str().unwrap())
}
