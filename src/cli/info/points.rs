use std::path::Path;

use serde_json::{Map, Value, json};

use super::Sheet;
use crate::cli::progress::Size;
use crate::cli::talk::Talk;
use crate::cli::{classes, open};
use crate::data::{Bounds, Columns, Lattice, PointBatch, PointFlags, PointInfo};
use crate::error::Result;
use crate::io::points::Options;
use crate::run::units::counted;

/// The flags of a point, by name.
const FLAGS: [(&str, u8); 4] = [
    ("synthetic", PointFlags::SYNTHETIC),
    ("key_point", PointFlags::KEY_POINT),
    ("withheld", PointFlags::WITHHELD),
    ("overlap", PointFlags::OVERLAP),
];

/// Counts over all points of a file.
struct Census {
    count: u64,
    bounds: Bounds,
    not_finite: u64,
    classes: [u64; 256],
    returns: [u64; 256],
    flags: [u64; FLAGS.len()],
}

impl Census {
    fn add(&mut self, batch: &PointBatch) {
        self.count += batch.len() as u64;
        for ((&x, &y), &z) in batch.x.iter().zip(&batch.y).zip(&batch.z) {
            self.bounds.add([x, y, z]);
            self.not_finite += u64::from(!(x.is_finite() && y.is_finite() && z.is_finite()));
        }
        batch.class.iter().for_each(|&class| self.classes[usize::from(class)] += 1);
        batch.return_number.iter().for_each(|&number| self.returns[usize::from(number)] += 1);
        for flags in &batch.flags {
            for (count, (_, bit)) in self.flags.iter_mut().zip(FLAGS) {
                *count += u64::from(flags.0 & bit != 0);
            }
        }
    }
}

pub(super) fn sheet(path: &Path, options: Options, talk: &Talk) -> Result<Sheet> {
    let mut source = open::points(path, options)?;
    let info = source.info().clone();
    let mut census = Census {
        count: 0,
        bounds: Bounds::default(),
        not_finite: 0,
        classes: [0; 256],
        returns: [0; 256],
        flags: [0; FLAGS.len()],
    };
    let progress = talk.progress("reading points", info.count.map_or(Size::Unknown, Size::Items));
    let mut batch = PointBatch::default();
    loop {
        source.read(&mut batch)?;
        if batch.is_empty() {
            break;
        }
        census.add(&batch);
        progress.add(batch.len() as u64);
    }
    drop(progress);
    let mut sheet = tell(&info, &census);
    sheet.warnings.extend(source.warnings().iter().cloned());
    Ok(sheet)
}

fn tell(info: &PointInfo, census: &Census) -> Sheet {
    let mut sheet = Sheet::with_warnings(info.warnings.clone());
    sheet.silent("kind", "points");
    sheet.plain("format", info.format.as_str());
    if let Some(columns) = info.columns {
        let Columns { x, y, z, class } = columns;
        sheet.row("columns", columns.to_string(), json!({ "x": x, "y": y, "z": z, "class": class }));
    }
    sheet.row("count", counted(census.count, "point"), census.count);
    sheet.silent("stated_count", info.count);
    sheet.bounds(census.bounds);
    sheet.crs(info.crs.as_ref());
    if let Some(Lattice { scale, offset }) = info.lattice {
        let list = |values: [f64; 3]| values.map(|value| (value + 0.0).to_string()).join(" ");
        sheet.row("scale", list(scale), json!(scale));
        sheet.row("offset", list(offset), json!(offset));
    }
    if info.has_classes {
        let (text, value) = histogram(&census.classes, |class| format!("{class} ({})", classes::name(class)));
        sheet.row("classes", text, value);
    }
    if census.returns.iter().any(|&count| count > 0) {
        let (text, value) = histogram(&census.returns, |number| number.to_string());
        sheet.row("returns", text, value);
    }
    if info.has_classes {
        let named = || FLAGS.iter().zip(census.flags).map(|((name, _), count)| (*name, count));
        let set: Vec<String> =
            named().filter(|(_, count)| *count > 0).map(|(name, count)| format!("{name}: {count}")).collect();
        let text = if set.is_empty() { "none".to_owned() } else { set.join(", ").replace('_', " ") };
        sheet.row("flags", text, named().map(|(name, count)| (name.to_owned(), json!(count))).collect::<Map<_, _>>());
    }
    if census.not_finite > 0 {
        sheet.warnings.push(format!("{} points have a coordinate that is not finite", census.not_finite));
    }
    sheet
}

fn histogram(counts: &[u64; 256], name: impl Fn(usize) -> String) -> (String, Value) {
    let present = || counts.iter().enumerate().filter(|(_, count)| **count > 0);
    let words: Vec<String> = present().map(|(i, count)| format!("{}: {count}", name(i))).collect();
    let object: Map<String, Value> = present().map(|(i, &count)| (i.to_string(), json!(count))).collect();
    (words.join(", "), Value::Object(object))
}
