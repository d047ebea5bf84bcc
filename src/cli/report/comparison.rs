//! The difference of two surfaces as lines and as JSON.

use serde_json::{Map, Value, json};

use super::statistics::{TITLES, shown};
use crate::run::units::{Units, number};
use crate::run::{ChangedAreas, CompareProduct, VolumeUnit};
use crate::terrain::ErrorStatistics;

/// Returns rounded numbers for a terminal.
pub(crate) fn text(product: &CompareProduct, changed: Option<f64>) -> String {
    let statistics = &product.statistics;
    let symbols = Units::of(product.difference.crs.as_ref()).symbols();
    let [plan, height] = symbols;
    let square = plan.map_or_else(|| "square units".to_owned(), |plan| plan + "2");
    let height = height.unwrap_or_else(|| "units".to_owned());
    let mut text = format!("{:<12} {:>16}\n", "cells", statistics.count);
    for (k, (title, value)) in TITLES.iter().zip(statistics.values()).enumerate() {
        let of = if ErrorStatistics::NAMES[k] == "skew" {
            ""
        } else {
            &height
        };
        text += format!("{title:<12} {:>16} {of}", shown(value)).trim_end();
        text.push('\n');
    }
    if let Some(height) = changed {
        let counts = product.changed(height);
        for (name, count) in ["raised", "lowered"].iter().zip(counts) {
            let area = number(count as f64 * product.cell_area());
            text += &format!("{name:<12} {count:>16} cells, area {area} {square}\n");
        }
    }
    if let Some(areas) = &product.areas {
        text += &of_areas(areas);
    }
    if !product.worst.is_empty() {
        text += "largest at\n";
    }
    for extreme in &product.worst {
        let [x, y] = extreme.at;
        text += &format!("{:>16} {height} at {x} {y}\n", number(extreme.value));
    }
    text
}

/// Returns the sums of the areas that are raised, and of those that are lowered.
fn of_areas(changed: &ChangedAreas) -> String {
    let [of_volumes, of_areas] = VolumeUnit::symbols_of(changed.unit);
    let mut text = String::new();
    for (name, is_raised) in [("raised", true), ("lowered", false)] {
        let of = || {
            changed
                .areas
                .iter()
                .filter(|area| area.is_raised() == is_raised)
        };
        let [area, volume] = [of().map(|of| of.area).sum(), of().map(|of| of.volume).sum()]
            .map(|sum: f64| number(sum + 0.0));
        let count = of().count();
        text += &format!(
            "{name:<12} {count:>16} polygons, area {area} {of_areas}, volume {volume} {of_volumes}\n"
        );
    }
    if changed.left_out > 0 {
        text += &format!(
            "{:<12} {:>16} smaller polygons\n",
            "left out", changed.left_out
        );
    }
    text
}

/// Returns exact numbers as JSON.
pub(crate) fn json(product: &CompareProduct, changed: Option<f64>) -> Value {
    let mut object = Map::new();
    let [plan, height] = Units::of(product.difference.crs.as_ref()).symbols();
    object.insert("plan_unit".to_owned(), plan.into());
    object.insert("height_unit".to_owned(), height.into());
    object.insert("cells".to_owned(), product.statistics.count.into());
    let values = product.statistics.values();
    for (k, name) in ErrorStatistics::NAMES.iter().enumerate() {
        object.insert((*name).to_owned(), (values[k] + 0.0).into());
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
    if let Some(changed) = &product.areas {
        let rows = changed.areas.iter().map(|of| {
            let [x, y] = of.at;
            json!({
                "change": if of.is_raised() { "raised" } else { "lowered" },
                "area": of.area,
                "volume": of.volume,
                "largest": of.largest,
                "x": x,
                "y": y,
            })
        });
        let [of_volumes, of_areas] = match changed.unit {
            Some(unit) => unit.symbols().map(Value::from),
            None => [Value::Null, Value::Null],
        };
        let areas = json!({
            "unit": of_volumes,
            "area_unit": of_areas,
            "left_out": changed.left_out,
            "rows": rows.collect::<Vec<_>>(),
        });
        object.insert("areas".to_owned(), areas);
    }
    let extremes = product.worst.iter().map(|extreme| {
        let [x, y] = extreme.at;
        json!({ "x": x, "y": y, "difference": extreme.value })
    });
    object.insert("worst".to_owned(), extremes.collect());
    Value::Object(object)
}
