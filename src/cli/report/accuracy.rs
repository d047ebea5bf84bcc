//! The accuracy of a surface as a table, as JSON and as CSV.

use serde_json::{Map, Value, json};

use super::statistics::{TITLES, shown};
use super::summary::counted;
use crate::io::csv_field;
use crate::run::units::number;
use crate::run::{
    AccuracyProduct, CheckpointRow, CheckpointSet, ClassDecision, Quantity, SetAccuracy,
};
use crate::terrain::ErrorStatistics;

/// What the RMSE with that of the checkpoints is called.
const ACCURACY: &str = "accuracy";

/// Returns the numbers of a set: its statistics, and its accuracy.
fn values(set: &SetAccuracy) -> impl Iterator<Item = f64> {
    set.statistics.values().into_iter().chain([set.rmse])
}

/// The longest bar of a histogram.
const LONGEST: usize = 40;

/// Returns rounded numbers for a terminal.
pub(crate) fn text(product: &AccuracyProduct) -> String {
    let unit = product.unit.as_ref().map_or("units", |unit| &unit.name);
    let mut text = format!(
        "differences in {unit}: surface minus checkpoint; accuracy: RMSE with that of the checkpoints, {}\n",
        number(product.checkpoint_error)
    );
    let mut cells: Vec<Vec<String>> = vec![["set", "n"].map(str::to_owned).into()];
    cells[0].extend(
        TITLES
            .iter()
            .chain([&ACCURACY])
            .map(|title| (*title).to_owned()),
    );
    cells.extend(product.sets.iter().map(|set| {
        let values = values(set).map(shown);
        let first = [name(&set.set), set.statistics.count.to_string()];
        first.into_iter().chain(values).collect()
    }));
    text += &table(&cells);
    text += &histogram(product);
    if let Some(decision) = &product.decision {
        text += &decided(decision, product);
    }
    text
}

fn name(set: &CheckpointSet) -> String {
    match set.group() {
        None => set.kind().to_owned(),
        Some("") => "(no group)".to_owned(),
        Some(name) => name.to_owned(),
    }
}

/// Returns rows of cells: the first column to the left, the others to the right.
fn table(cells: &[Vec<String>]) -> String {
    let width = |column: usize| {
        let of_column = cells.iter().filter_map(|row| row.get(column));
        of_column
            .map(|cell| cell.chars().count())
            .max()
            .unwrap_or(0)
    };
    let mut text = String::new();
    for row in cells {
        let aligned = row.iter().enumerate().map(|(column, cell)| {
            let width = width(column);
            match column {
                0 => format!("{cell:<width$}"),
                _ => format!("{cell:>width$}"),
            }
        });
        text += aligned.collect::<Vec<_>>().join("  ").trim_end();
        text.push('\n');
    }
    text
}

fn histogram(product: &AccuracyProduct) -> String {
    let Some(histogram) = &product.histogram else {
        return String::new();
    };
    let most = histogram.counts.iter().copied().max().unwrap_or(1).max(1);
    let bins = histogram.counts.iter().enumerate().map(|(bin, &count)| {
        let ends = [bin, bin + 1].map(|bin| number(histogram.edge(bin) + 0.0));
        let bar = "#".repeat((count * LONGEST).div_ceil(most.max(LONGEST)));
        let [from, to] = ends;
        vec![
            String::new(),
            from,
            "to".to_owned(),
            to,
            count.to_string(),
            bar,
        ]
    });
    let mut cells: Vec<Vec<String>> = bins.collect();
    let longest = cells.iter().map(|row| row[5].len()).max().unwrap_or(0);
    cells
        .iter_mut()
        .for_each(|row| row[5] = format!("{:<longest$}", row[5]));
    table(&cells)
}

fn decided(decision: &ClassDecision, product: &AccuracyProduct) -> String {
    let of_unit = |value: f64| Quantity {
        value,
        unit: product.unit.clone(),
    };
    let result = match decision.is_met() {
        true => "met",
        false => "not met",
    };
    let count = product.sets.iter().find(|set| set.set == decision.set);
    format!(
        "class {}: {result}, accuracy {} by {} ({})\n",
        of_unit(decision.limit),
        of_unit(decision.rmse),
        counted(
            count.map_or(0, |set| set.statistics.count as u64),
            "checkpoint"
        ),
        name(&decision.set)
    )
}

/// Returns exact numbers as JSON.
pub(crate) fn json(product: &AccuracyProduct) -> Value {
    let set = |accuracy: &SetAccuracy| {
        let mut object = named(&accuracy.set);
        object.insert("n".to_owned(), accuracy.statistics.count.into());
        let names = ErrorStatistics::NAMES.iter().chain([&ACCURACY]);
        for (name, value) in names.zip(values(accuracy)) {
            object.insert((*name).to_owned(), finite(value));
        }
        Value::Object(object)
    };
    let row = |row: &CheckpointRow| {
        let [x, y, z] = row.point;
        json!({
            product.counted_by: row.number,
            "x": x,
            "y": y,
            "z": z,
            "surface_z": finite(row.surface),
            "difference": finite(row.difference()),
            "group": row.group,
        })
    };
    let decision = product.decision.as_ref().map(|decision| {
        let mut object = named(&decision.set);
        object.insert("limit".to_owned(), decision.limit.into());
        object.insert("accuracy".to_owned(), decision.rmse.into());
        object.insert("is_met".to_owned(), decision.is_met().into());
        object
    });
    let histogram = product.histogram.as_ref().map(|histogram| {
        json!({
            "start": histogram.start,
            "width": histogram.width,
            "counts": histogram.counts,
        })
    });
    json!({
        "unit": product.unit.as_ref().map(|unit| &unit.name),
        "checkpoint_error": product.checkpoint_error,
        "sets": product.sets.iter().map(set).collect::<Vec<_>>(),
        "class": decision,
        "histogram": histogram,
        "points": product.rows.iter().map(row).collect::<Vec<_>>(),
    })
}

fn named(set: &CheckpointSet) -> Map<String, Value> {
    let mut object = Map::new();
    object.insert("set".to_owned(), set.kind().into());
    if let Some(name) = set.group() {
        object.insert("group".to_owned(), name.into());
    }
    object
}

fn finite(value: f64) -> Value {
    match value.is_finite() {
        true => (value + 0.0).into(),
        false => Value::Null,
    }
}

/// Returns a row for each checkpoint as CSV.
pub(crate) fn rows_csv(product: &AccuracyProduct) -> String {
    let mut text = format!("{},x,y,z,surface_z,difference,group\n", product.counted_by);
    for row in &product.rows {
        let numbers = row.point.into_iter().chain([row.surface, row.difference()]);
        let numbers: Vec<String> = numbers.map(field).collect();
        let group = row.group.as_deref().map(csv_field).unwrap_or_default();
        text += &format!("{},{},{group}\n", row.number, numbers.join(","));
    }
    text
}

/// Returns the bins of the histogram as CSV.
pub(crate) fn bins_csv(product: &AccuracyProduct) -> String {
    let mut text = "from,to,count\n".to_owned();
    if let Some(histogram) = &product.histogram {
        for (bin, count) in histogram.counts.iter().enumerate() {
            let [from, to] = [bin, bin + 1].map(|bin| field(histogram.edge(bin)));
            text += &format!("{from},{to},{count}\n");
        }
    }
    text
}

/// Returns a number as a field; empty if there is none.
fn field(value: f64) -> String {
    match value.is_nan() {
        true => String::new(),
        false => (value + 0.0).to_string(),
    }
}
