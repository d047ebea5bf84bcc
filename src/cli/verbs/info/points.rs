use serde_json::{Map, Value, json};

use super::Sheet;
use crate::cli::report::summary::counted;
use crate::data::classes;
use crate::data::{Columns, Lattice};
use crate::run::PointFacts;
use crate::triangulation::num::unsigned_zero;

/// Names of the flags of a point, in the order in which they are counted.
const FLAGS: [&str; 4] = ["synthetic", "key_point", "withheld", "overlap"];

pub(super) fn sheet(facts: &PointFacts) -> Sheet {
    let info = &facts.info;
    let mut sheet = Sheet::with_warnings(info.warnings.clone());
    sheet.silent("kind", "points");
    sheet.plain("format", info.format.as_str());
    if let Some(columns) = info.columns {
        let Columns { x, y, z, class } = columns;
        sheet.row(
            "columns",
            columns.to_string(),
            json!({ "x": x, "y": y, "z": z, "class": class }),
        );
    }
    sheet.row("count", counted(facts.count, "point"), facts.count);
    sheet.silent("stated_count", info.count);
    sheet.bounds(facts.bounds);
    sheet.crs(info.crs.as_ref());
    if let Some(Lattice { scale, offset }) = info.lattice {
        let list = |values: [f64; 3]| {
            values
                .map(|value| unsigned_zero(value).to_string())
                .join(" ")
        };
        sheet.row("scale", list(scale), json!(scale));
        sheet.row("offset", list(offset), json!(offset));
    }
    if info.has_classes {
        let (text, value) = histogram(&facts.classes, |class| {
            format!("{class} ({})", classes::name(class))
        });
        sheet.row("classes", text, value);
    }
    if facts.returns.iter().any(|&count| count > 0) {
        let (text, value) = histogram(&facts.returns, |number| number.to_string());
        sheet.row("returns", text, value);
    }
    if info.has_classes {
        let named = || {
            FLAGS
                .iter()
                .zip(facts.flags)
                .map(|(name, count)| (*name, count))
        };
        let set: Vec<String> = named()
            .filter(|(_, count)| *count > 0)
            .map(|(name, count)| format!("{name}: {count}"))
            .collect();
        let text = if set.is_empty() {
            "none".to_owned()
        } else {
            set.join(", ").replace('_', " ")
        };
        sheet.row(
            "flags",
            text,
            named()
                .map(|(name, count)| (name.to_owned(), json!(count)))
                .collect::<Map<_, _>>(),
        );
    }
    if facts.not_finite > 0 {
        sheet.warnings.push(
            format!(
                "{} points have a coordinate that is not finite",
                facts.not_finite
            )
            .into(),
        );
    }
    sheet.warnings.extend(facts.warnings.iter().cloned());
    sheet
}

fn histogram(counts: &[u64; 256], name: impl Fn(usize) -> String) -> (String, Value) {
    let present = || counts.iter().enumerate().filter(|(_, count)| **count > 0);
    let words: Vec<String> = present()
        .map(|(i, count)| format!("{}: {count}", name(i)))
        .collect();
    let object: Map<String, Value> = present()
        .map(|(i, &count)| (i.to_string(), json!(count)))
        .collect();
    (words.join(", "), Value::Object(object))
}
