//! What PROJ is asked for: systems with heights where both systems have them, else in plan.

use crate::crs::{Crs, CrsKind, Heights};

/// A system as PROJ receives it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Side {
    /// A code or WKT.
    pub(super) definition: String,
    /// The definition is in plan, and gets heights above its ellipsoid, in meters.
    pub(super) is_raised: bool,
    /// The unit of heights in the definition, in units of heights of the system.
    scale: f64,
}

/// The systems at both ends as PROJ receives them, and what becomes of heights.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Route {
    pub(super) from: Side,
    pub(super) to: Side,
    /// What heights are multiplied by; `None` if the operation transforms them.
    pub(super) factor: Option<f64>,
}

impl Route {
    /// Returns the height that PROJ receives.
    pub(super) fn before(&self, height: f64) -> f64 {
        match self.factor {
            // PROJ gets no height, in both directions: the position in plan does not depend on it.
            Some(_) => 0.0,
            None if height.is_finite() => height / self.from.scale,
            // A line may have vertices without heights.
            None => 0.0,
        }
    }

    /// Returns the height of the result for that of the point and what PROJ returns.
    pub(super) fn after(&self, height: f64, moved: f64) -> f64 {
        match self.factor {
            Some(factor) => height * factor,
            None if height.is_finite() => moved * self.to.scale,
            None => height,
        }
    }

    /// Returns true if the operation transforms heights.
    pub(super) fn has_heights(&self) -> bool {
        self.factor.is_none()
    }
}

/// Returns the route for plan and heights; `None` if heights need no transform, or one of the
/// systems does not say what they are.
pub(super) fn with_heights(from: &Crs, to: &Crs) -> Option<Route> {
    let is_same = match (from.heights(), to.heights()) {
        (Heights::Vertical(a), Heights::Vertical(b)) => a == b || have_one_datum(a, b),
        _ => false,
    };
    if is_same && from.kind != CrsKind::Geocentric {
        return None;
    }
    Some(Route {
        from: whole(from)?,
        to: whole(to)?,
        factor: None,
    })
}

/// Returns the route without a transform of heights between datums, and a warning about heights if
/// there is one.
pub(super) fn in_plan(from: &Crs, to: &Crs) -> (Route, Option<String>) {
    if from.kind == CrsKind::Geocentric {
        return above_ellipsoid(from, to);
    }
    let (factor, warning) = kept(from, to);
    let route = Route {
        from: plan(from),
        to: plan(to),
        factor: Some(factor),
    };
    (route, warning)
}

/// Returns the route of geocentric coordinates. They have no plan of their own: heights above the
/// ellipsoid come with it.
fn above_ellipsoid(from: &Crs, to: &Crs) -> (Route, Option<String>) {
    let warning = match to.heights() {
        Heights::Vertical(code) => {
            format!("heights are kept above the ellipsoid: they are not those of EPSG:{code}")
        }
        _ => "heights are above the ellipsoid".to_owned(),
    };
    let route = Route {
        from: plan(from),
        to: raised(to),
        factor: None,
    };
    (route, Some(warning))
}

fn plan(crs: &Crs) -> Side {
    Side {
        definition: match crs.epsg {
            Some(code) => format!("EPSG:{code}"),
            None => crs.to_wkt(),
        },
        is_raised: false,
        scale: 1.0,
    }
}

fn raised(crs: &Crs) -> Side {
    // PROJ adds heights in meters.
    let scale = match (&crs.vertical_unit, crs.epsg) {
        (Some(unit), Some(_)) => 1.0 / unit.factor,
        _ => 1.0,
    };
    Side {
        is_raised: true,
        scale,
        ..plan(crs)
    }
}

/// Returns a system with its heights; `None` if it does not say what they are.
fn whole(crs: &Crs) -> Option<Side> {
    match (crs.heights(), crs.epsg) {
        (Heights::None | Heights::Unknown, _) => None,
        (Heights::Ellipsoid, _) if crs.kind == CrsKind::Geocentric => Some(plan(crs)),
        (Heights::Ellipsoid, Some(_)) => Some(raised(crs)),
        (Heights::Vertical(vertical), Some(code)) => {
            let definition = format!("EPSG:{code}+{vertical}");
            let unit = Crs::from_user(&definition).ok()?.vertical_unit;
            let scale = match (unit, &crs.vertical_unit) {
                (Some(of_code), Some(stated)) => of_code.factor / stated.factor,
                _ => 1.0,
            };
            Some(Side {
                definition,
                is_raised: false,
                scale,
            })
        }
        (Heights::Ellipsoid | Heights::Vertical(_) | Heights::Named, _) => Some(Side {
            definition: crs.to_wkt(),
            is_raised: false,
            scale: 1.0,
        }),
    }
}

/// Returns the factor for heights that keep their datum, and a warning about them if there is one.
fn kept(from: &Crs, to: &Crs) -> (f64, Option<String>) {
    let (Some(source), target) = (&from.vertical_unit, &to.vertical_unit) else {
        let nothing = to.vertical_epsg.map(|code| {
            format!(
                "heights are left as they are: {from} does not state their vertical system, EPSG:{code} is assumed"
            )
        });
        return (1.0, nothing);
    };
    let factor = target
        .as_ref()
        .map_or(1.0, |target| source.factor / target.factor);
    let same = match (from.vertical_epsg, to.vertical_epsg) {
        (Some(a), Some(b)) => a == b || have_one_datum(a, b),
        (None, None) => from.heights() == to.heights() && from.heights() != Heights::Named,
        _ => false,
    };
    let warning = match target {
        None => from.vertical_epsg.map(|code| {
            format!(
                "heights are left as they are, in {} (EPSG:{code}): {to} states no vertical system",
                source.name
            )
        }),
        Some(_) if same => None,
        Some(target) => Some(format!(
            "heights keep their datum{}: they are not transformed from {} to {}",
            if (factor - 1.0).abs() > 1e-12 {
                format!(" (in {})", target.name)
            } else {
                String::new()
            },
            datum_of(from),
            datum_of(to),
        )),
    };
    (factor, warning)
}

/// Returns what heights are counted from, in words.
fn datum_of(crs: &Crs) -> String {
    match crs.heights() {
        Heights::Vertical(code) => format!("EPSG:{code}"),
        Heights::Ellipsoid => "heights above the ellipsoid".to_owned(),
        Heights::Named => format!("those of {crs}"),
        Heights::None | Heights::Unknown => "heights above an unknown datum".to_owned(),
    }
}

/// Returns true if two vertical systems are known to have the same datum.
fn have_one_datum(a: u32, b: u32) -> bool {
    let datum = |code| proj_core::lookup_vertical_epsg(code)?.vertical_datum_epsg();
    datum(a).is_some() && datum(a) == datum(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crs(text: &str) -> Crs {
        Crs::from_user(text).unwrap()
    }

    #[test]
    fn heights_are_transformed_where_both_systems_say_what_they_are() {
        let has = |from: &str, to: &str| with_heights(&crs(from), &crs(to)).is_some();
        assert!(has("EPSG:25832+7837", "EPSG:25832+ellipsoid"));
        assert!(has("EPSG:4979", "EPSG:4326+5773"));
        assert!(has("EPSG:4978", "EPSG:25832+7837"));
        assert!(has("EPSG:25832+5783", "EPSG:25832+7837"));
        assert!(!has("EPSG:25832", "EPSG:25832+7837"));
        assert!(!has("EPSG:25832+7837", "EPSG:25833"));
        assert!(
            !has("EPSG:2264+6360", "EPSG:32119+5703"),
            "only the unit differs"
        );
    }

    #[test]
    fn units_of_heights_are_those_of_the_definition() {
        // 8228 is NAVD88 in feet, 5703 in meters.
        let mut feet = crs("EPSG:2264+5703");
        feet.vertical_unit = Some(crate::crs::Unit::length(0.3048));
        let route = with_heights(&feet, &crs("EPSG:4979")).unwrap();
        assert_eq!(route.from.definition, "EPSG:2264+5703");
        assert!((route.before(1000.0) - 304.8).abs() < 1e-9);
        assert_eq!(route.after(1000.0, 7.0), 7.0);
        // A vertex without a height stays one.
        assert_eq!(route.before(f64::NAN), 0.0);
        assert!(route.after(f64::NAN, 7.0).is_nan());
    }
}
