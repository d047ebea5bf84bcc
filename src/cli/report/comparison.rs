//! The difference of two surfaces as lines and as JSON.

use serde_json::{Map, Value, json};

use super::escape;
use crate::run::CompareProduct;
use crate::run::units::number;
use crate::terrain::ErrorStatistics;

/// A number of the statistics: its name in text and in JSON.
type Field = (&'static str, &'static str, fn(&ErrorStatistics) -> f64);

/// The numbers, in the order of all outputs.
const FIELDS: &[Field] = &[
    ("mean", "mean", |s| s.mean),
    ("median", "median", |s| s.median),
    ("std dev", "standard_deviation", |s| s.standard_deviation),
    ("RMSE", "rmse", |s| s.rmse),
    ("NMAD", "nmad", |s| s.nmad),
    ("95 %", "percentile_95", |s| s.percentile_95),
    ("min", "min", |s| s.min),
    ("max", "max", |s| s.max),
    ("skew", "skew", |s| s.skew),
];

/// Returns rounded numbers for a terminal.
pub(crate) fn text(product: &CompareProduct, changed: Option<f64>) -> String {
    let Some(statistics) = &product.statistics else {
        return "no cell is on both surfaces\n".to_owned();
    };
    let mut text = format!("{:<12} {:>16}\n", "cells", statistics.count);
    for (name, _, of) in FIELDS {
        let value = of(statistics);
        let shown = if value.is_nan() {
            "-".to_owned()
        } else {
            number(value + 0.0)
        };
        text += &format!("{name:<12} {shown:>16}\n");
    }
    if let Some(height) = changed {
        let counts = product.changed(height);
        for (name, count) in ["raised", "lowered"].iter().zip(counts) {
            let area = number(count as f64 * product.cell_area());
            text += &format!("{name:<12} {count:>16} cells, area {area}\n");
        }
    }
    if !product.worst.is_empty() {
        text += "largest at\n";
    }
    for extreme in &product.worst {
        let [x, y] = extreme.at;
        text += &format!("{:>16} at {x} {y}\n", number(extreme.value));
    }
    text
}

/// Returns exact numbers as JSON.
pub(crate) fn json(product: &CompareProduct, changed: Option<f64>) -> String {
    let mut object = Map::new();
    let count = product.statistics.map_or(0, |statistics| statistics.count);
    object.insert("cells".to_owned(), count.into());
    for (_, key, of) in FIELDS {
        let value = product.statistics.as_ref().map(of);
        object.insert((*key).to_owned(), value.map(|v| v + 0.0).into());
    }
    if let Some(height) = changed {
        let [raised, lowered] = product.changed(height);
        let area = |count: usize| count as f64 * product.cell_area();
        object.insert(
            "changed".to_owned(),
            json!({
                "height": height,
                "raised_cells": raised,
                "lowered_cells": lowered,
                "raised_area": area(raised),
                "lowered_area": area(lowered),
            }),
        );
    }
    let extremes = product.worst.iter().map(|extreme| {
        let [x, y] = extreme.at;
        json!({ "x": x, "y": y, "difference": extreme.value })
    });
    object.insert("worst".to_owned(), extremes.collect());
    escape::json(&format!("{:#}\n", Value::Object(object)))
}
