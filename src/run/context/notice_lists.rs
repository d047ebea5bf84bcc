//! Texts about things of a file, of which the first are listed.

use std::path::Path;

use super::notice::PartlyCounted;
use super::units::number;
use crate::error::{Plain, Setting, Wording, wording};

/// Returns a text about a file.
pub(super) fn of_file(path: &Path, text: &str) -> Wording {
    format!("{}: {text}", path.display()).into()
}

pub(super) fn polygons_outside(path: &Path, records: &[usize]) -> Wording {
    let s = if records.len() == 1 { "" } else { "s" };
    let records = named("record", records);
    of_file(
        path,
        &format!("{records}: nothing to compute a volume of is in the polygon{s}"),
    )
}

pub(super) fn rings_overlap(path: &Path, records: &[usize]) -> Wording {
    let records = named("record", records);
    let text = format!(
        "{records}: rings overlap each other: what an even number of them covers is not counted (repair the polygons)"
    );
    of_file(path, &text)
}

pub(super) fn polygons_partly_outside(
    path: &Path,
    partly: &[PartlyCounted],
    unit: &str,
) -> Wording {
    let areas = |one: &PartlyCounted| {
        let [counted, area] = [one.counted, one.area].map(number);
        format!("record {}: {counted} of {area} {unit}", one.record)
    };
    let listed: Vec<String> = partly.iter().map(areas).collect();
    let polygons = match partly.len() {
        1 => "a polygon is".to_owned(),
        count => format!("{count} polygons are"),
    };
    let listed = first_of(&listed);
    let text = format!("{polygons} counted only where the surface and its base are ({listed})");
    of_file(path, &text)
}

/// Returns a text about several things in a file, of which the first are listed.
pub(super) fn of_listed(path: &Path, things: &[String], text: &str) -> Wording {
    // "records 1, 2 and 4 more" where all are plain records.
    let numbers = things.iter().map(|thing| {
        let number = thing.strip_prefix("record ")?;
        number.bytes().all(|c| c.is_ascii_digit()).then_some(number)
    });
    let listed = match numbers.collect::<Option<Vec<&str>>>() {
        Some(numbers) => named("record", &numbers),
        None => first_of(things),
    };
    of_file(path, &format!("{listed}: {text}"))
}

pub(super) fn sections_cross(
    path: &Path,
    record: usize,
    first: &[[String; 2]],
    more: usize,
    are_all: bool,
) -> Wording {
    let pairs: Vec<String> = first.iter().map(|[a, b]| format!("{a} and {b}")).collect();
    let more = match (more, are_all) {
        (0, _) => String::new(),
        (more, true) => format!(" and {more} more"),
        (more, false) => format!(" and at least {more} more"),
    };
    let pairs = pairs.join(", ");
    of_file(
        path,
        &format!("record {record}: sections cross: {pairs}{more}"),
    )
}

/// Returns the first of several things, and how many more there are.
fn first_of(things: &[impl ToString]) -> String {
    const MOST_LISTED: usize = 5;
    let first = things.iter().take(MOST_LISTED);
    let listed: Vec<String> = first.map(ToString::to_string).collect();
    match things.len().saturating_sub(MOST_LISTED) {
        0 => listed.join(", "),
        more => format!("{} and {more} more", listed.join(", ")),
    }
}

/// Returns the first of some records or lines by their numbers: "records 1, 2 and 3 more".
pub(super) fn named(noun: &str, numbers: &[impl ToString]) -> String {
    let s = if numbers.len() == 1 { "" } else { "s" };
    format!("{noun}{s} {}", first_of(numbers))
}

/// Tiles of which the first has this middle.
pub(super) fn ground_in_doubt(tiles: usize, of: usize, [x, y]: [f64; 2]) -> Wording {
    wording![
        format!(
            "the ground in {tiles} of {of} tiles, the first around {} {}, depends on points further away than memory has room for; ",
            Plain(x),
            Plain(y)
        ),
        Setting::Memory,
        " gives it more"
    ]
}
