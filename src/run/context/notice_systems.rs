//! The texts of notices about coordinate systems and what files state of themselves.

use std::path::Path;

use super::units::Units;
use crate::crs::{Crs, Heights};
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

pub(super) fn above_ellipsoid(heights: Heights) -> Wording {
    let what = match heights {
        Heights::Vertical(code) => {
            format!("heights are those of EPSG:{code}, which is not the ellipsoid")
        }
        Heights::None => "no system of heights is stated".to_owned(),
        Heights::Named => {
            "the system of heights is not the ellipsoid, and has no known code".to_owned()
        }
        Heights::Unknown | Heights::Ellipsoid => {
            "the unit of heights is stated, but not what they are counted from".to_owned()
        }
    };
    wording![
        what,
        ": they are used as heights above the ellipsoid, so that viewers show the surface too low or \
         too high, in most places by 10 to 60 m; state the height of the geoid there with ",
        Setting::VerticalOffset.number("METERS")
    ]
}

pub(super) fn beyond_bound(level: u8, count: usize, [within, bound]: [f64; 2]) -> Wording {
    let why = match count {
        0 => "the earth is curved within them".to_owned(),
        1 => "32767 steps along a tile are too few for 1 height".to_owned(),
        _ => format!("32767 steps along a tile are too few for {count} heights"),
    };
    wording![
        format!(
            "level {level}: the surface is within {within:.3} m of the triangles, not within \
             {bound:.3} m: {why}; for bounds that hold, pass a larger "
        ),
        Setting::MaxError
    ]
}
