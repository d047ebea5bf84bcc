//! Profiles as a table for a terminal, and as JSON.

use serde_json::{Value, json};

use super::escape;
use crate::data::{Profile, Profiles, Stretch};
use crate::run::units::number;
use crate::triangulation::num::unsigned_zero;

/// The profiles that a terminal shows.
const MOST_SHOWN: usize = 40;

/// Returns a line for each profile and surface: its lengths and its lowest and highest height,
/// rounded.
pub(crate) fn text(profiles: &Profiles) -> String {
    let [plan, height] = profiles
        .units
        .each_ref()
        .map(|unit| unit.as_deref().unwrap_or("units"));
    let mut text = String::new();
    for profile in profiles.list.iter().take(MOST_SHOWN) {
        let [from, to] = profile.range;
        text += &format!(
            "{}, {} {plan}\n",
            profiles.title(profile),
            number(to - from)
        );
        for (surface, stretches) in profiles.surfaces.iter().zip(&profile.stretches) {
            text += &format!("  {surface}: {}\n", line(stretches, plan, height));
        }
    }
    if profiles.list.len() > MOST_SHOWN {
        text += &format!("and {} more\n", profiles.list.len() - MOST_SHOWN);
    }
    escape::lines(&text)
}

fn line(stretches: &[Stretch], plan: &str, height: &str) -> String {
    let points = || stretches.iter().flatten();
    let heights = points().map(|p| p.at[2]);
    let low = heights.clone().fold(f64::INFINITY, f64::min);
    let high = heights.fold(f64::NEG_INFINITY, f64::max);
    let length = |stretch: &Stretch| match (stretch.first(), stretch.last()) {
        (Some(first), Some(last)) => last.along - first.along,
        _ => 0.0,
    };
    let on: f64 = stretches.iter().map(length).sum();
    if stretches.is_empty() {
        return "nothing".to_owned();
    }
    format!(
        "{} {plan} on it, heights {} .. {} {height}, {} points",
        number(on),
        number(low),
        number(high),
        points().count()
    )
}

/// Returns all points as JSON. A point is `[distance, x, y, z]`; each surface has a list of
/// stretches without a gap.
pub(crate) fn json(profiles: &Profiles) -> Value {
    let stretch = |stretch: &Stretch| -> Value {
        let point = |p: &crate::data::LinePoint| {
            let [x, y, z] = p.at;
            json!([p.along, x, y, z].map(unsigned_zero))
        };
        stretch.iter().map(point).collect()
    };
    let profile = |profile: &Profile| {
        let surfaces: Vec<Value> = profile
            .stretches
            .iter()
            .map(|stretches| stretches.iter().map(stretch).collect())
            .collect();
        let mut object = json!({
            "record": profile.record,
            "from": unsigned_zero(profile.range[0]),
            "to": unsigned_zero(profile.range[1]),
            "surfaces": surfaces,
        });
        if let Some(part) = profile.part {
            object["part"] = part.into();
        }
        if let Some(station) = &profile.station {
            object["station"] = unsigned_zero(station.at).into();
            object["name"] = station.text.clone().into();
        }
        object
    };
    let list: Vec<Value> = profiles.list.iter().map(profile).collect();
    let [unit, height_unit] = &profiles.units;
    json!({
        "unit": unit,
        "height_unit": height_unit,
        "surfaces": profiles.surfaces,
        "profiles": list,
    })
}
