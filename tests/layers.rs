//! Vector layers: every real file against its facts, every damaged one against a table, and what is
//! written against what is read.

mod common;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use breakline::data::{Bounds, ContourLine, Layer, Shape};
use breakline::error::Result;
use breakline::io::{contours, layer, shapefile};
use serde_json::Value;

fn facts() -> Option<serde_json::Map<String, Value>> {
    let text = std::fs::read_to_string(common::shared("FACTS.json")?).unwrap();
    // Written by Python, which has numbers that JSON has not.
    let text = text.replace("NaN", "null").replace("-Infinity", "null").replace("Infinity", "null");
    let Value::Object(facts) = serde_json::from_str(&text).unwrap() else { panic!("FACTS.json is no object") };
    Some(facts)
}

fn read(path: &Path) -> Result<Layer> {
    layer::read(path.to_str().unwrap())
}

fn parts(layer: &Layer) -> usize {
    let parts = layer.shapes.iter().map(|shape| match shape {
        Shape::Lines(parts) | Shape::Polygon(parts) => parts.len(),
        _ => 0,
    });
    parts.sum()
}

fn bounds(layer: &Layer) -> Bounds {
    let mut bounds = Bounds::default();
    layer.shapes.iter().flat_map(Shape::vertices).for_each(|&v| bounds.add(v));
    bounds
}

/// Names of the types of a file, as in its facts.
fn format_name(code: u64) -> &'static str {
    match code {
        1 => "Point",
        3 => "PolyLine",
        5 => "Polygon",
        8 => "MultiPoint",
        11 => "PointZ",
        13 => "PolyLineZ",
        15 => "PolygonZ",
        18 => "MultiPointZ",
        21 => "PointM",
        23 => "PolyLineM",
        25 => "PolygonM",
        31 => "MultiPatch",
        other => panic!("type {other}"),
    }
}

#[test]
fn every_sound_shapefile_has_the_facts() {
    let Some(facts) = facts() else { return };
    let mut seen = 0;
    for (name, fact) in facts.iter().filter(|(name, _)| name.ends_with(".shp") && !name.contains("/broken")) {
        let layer = read(&common::shared(name).unwrap()).unwrap_or_else(|e| panic!("{e}"));
        let number = |key: &str| fact[key].as_u64().unwrap_or_else(|| panic!("{name}: no {key}")) as usize;
        seen += 1;
        assert_eq!(layer.format, format!("shapefile {}", format_name(number("hdr_type") as u64)), "{name}");
        assert_eq!(layer.shapes.len(), number("records"), "{name}: records");
        let nulls = layer.shapes.iter().filter(|shape| matches!(shape, Shape::Null)).count();
        assert_eq!(nulls, number("nulls"), "{name}: nulls");
        // Parts and vertices of a multipatch become triangles; the test below looks at them.
        if number("hdr_type") != 31 {
            assert_eq!(parts(&layer), number("parts"), "{name}: parts");
            let vertices = layer.shapes.iter().flat_map(Shape::vertices).count();
            assert_eq!(vertices, number("points"), "{name}: points");
        }
        let found = bounds(&layer);
        let bbox: Vec<f64> = fact["hdr_bbox"].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
        assert_eq!([found.min[0], found.min[1], found.max[0], found.max[1]], bbox[..], "{name}: bbox");
        match fact["z"].as_array() {
            Some(z) => {
                assert_eq!([found.min[2], found.max[2]], [z[0].as_f64().unwrap(), z[1].as_f64().unwrap()], "{name}: z")
            }
            None => assert!(found.min[2] > found.max[2], "{name}: no heights"),
        }
    }
    assert_eq!(seen, 63);
}
