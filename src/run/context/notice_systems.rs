//! The texts of notices about coordinate systems and what files state of themselves.

use std::path::Path;

use super::units::Units;
use crate::crs::Crs;
use crate::error::{Setting, Wording, wording};

pub(super) fn first_of_bands(path: &Path, bands: u16) -> String {
    format!(
        "{}: band 1 of {bands} is used (`gdal_translate -b N` takes another one out)",
        path.display()
    )
}

pub(super) fn system_of_others(path: &Path, crs: &Crs) -> Wording {
    let used = format!(
        "{} states no coordinate system; {crs} is used, as in the other files",
        path.display()
    );
    match Units::of(Some(crs)).is_angular() {
        true => wording![
            used,
            ": its coordinates are taken to be degrees (GeoJSON without a `crs` member implies them; \
             if they are not, state their system with ",
            Setting::Crs,
            ")"
        ],
        false => used.into(),
    }
}

pub(super) fn heights_of_others(path: &Path, unit: &str) -> String {
    format!(
        "{} states no unit of heights: they are taken to be in units of the {unit}, as in the other files",
        path.display()
    )
}

pub(super) fn reassigned(path: &Path, stated: &Crs, assigned: &Crs) -> Wording {
    wording![
        format!(
            "{} states {stated}; {assigned} is used, as given by ",
            path.display()
        ),
        Setting::Crs
    ]
}

pub(super) fn no_system() -> &'static str {
    "no coordinate system is stated: lengths are in the units of the data"
}

pub(super) fn different_units(plan: &str, height: &str) -> String {
    format!("x and y are in units of the {plan}, heights in units of the {height}")
}
