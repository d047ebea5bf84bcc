//! The difference of two surfaces as lines and as JSON.

use serde_json::{Map, Value, json};

use super::escape;
use super::statistics::{TITLES, shown};
use crate::run::CompareProduct;
use crate::run::units::number;
use crate::terrain::ErrorStatistics;

/// Returns rounded numbers for a terminal.
pub(crate) fn text(product: &CompareProduct, changed: Option<f64>) -> String {
    let Some(statistics) = &product.statistics else {
        return "no cell is on both surfaces\n".to_owned();
    };
    let mut text = format!("{:<12} {:>16}\n", "cells", statistics.count);
    for (title, value) in TITLES.iter().zip(statistics.values()) {
        text += &format!("{title:<12} {:>16}\n", shown(value));
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
    let values = product.statistics.map(|statistics| statistics.values());
    for (k, name) in ErrorStatistics::NAMES.iter().enumerate() {
        let value = values.map(|values| values[k] + 0.0);
        object.insert((*name).to_owned(), value.into());
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
