//! Lengths and heights with their units.

use std::fmt;

use crate::crs::{Crs, CrsKind, Unit};
use crate::error::{MANY_DIGITS, Plain};
use crate::triangulation::num::unsigned_zero;

/// Metres per degree along a meridian, approximately: good enough for defaults.
const METRES_PER_DEGREE: f64 = 111_320.0;

/// The units of a surface, in plan and of heights.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Units {
    plan: Option<Unit>,
    height: Option<Unit>,
    is_angular: bool,
}

impl Units {
    pub(crate) fn of(crs: Option<&Crs>) -> Self {
        let is_angular = crs.is_some_and(|crs| crs.kind == CrsKind::Geographic);
        let plan = crs.map(|crs| crs.unit.clone());
        // With degrees in plan, heights are in metres unless the definition says otherwise.
        let height = match crs.and_then(|crs| crs.vertical_unit.clone()) {
            Some(unit) => Some(unit),
            None if is_angular => Some(Unit {
                name: "metre".to_owned(),
                factor: 1.0,
            }),
            None => plan.clone(),
        };
        Units {
            plan,
            height,
            is_angular,
        }
    }

    /// Returns a length in plan with its unit.
    pub(crate) fn length(&self, value: f64) -> Quantity {
        Quantity {
            value,
            unit: self.plan.clone(),
        }
    }

    /// Returns a height with its unit.
    pub(crate) fn height(&self, value: f64) -> Quantity {
        Quantity {
            value,
            unit: self.height.clone(),
        }
    }

    /// Converts metres to units of the plan; returns the number itself if the unit is not known.
    pub(crate) fn of_metres(&self, metres: f64) -> f64 {
        match &self.plan {
            Some(_) if self.is_angular => metres / METRES_PER_DEGREE,
            Some(unit) if unit.factor > 0.0 => metres / unit.factor,
            _ => metres,
        }
    }

    /// Converts metres to units of the heights; returns the number itself if the unit is not known.
    pub(crate) fn height_of_metres(&self, metres: f64) -> f64 {
        match &self.height {
            Some(unit) if unit.factor > 0.0 => metres / unit.factor,
            _ => metres,
        }
    }

    /// Returns the meters in a unit of x, of y and of the heights, each 1 if it is not known.
    /// Angles have the lengths that they have at a latitude, which is not used otherwise.
    pub(crate) fn metres_at(&self, latitude: f64) -> [f64; 3] {
        /// At the poles, degrees of longitude have no length.
        const MOST: f64 = 89.0;
        let factor = |unit: &Option<Unit>| match unit {
            Some(unit) if unit.factor > 0.0 => unit.factor,
            _ => 1.0,
        };
        let (plan, height) = (factor(&self.plan), factor(&self.height));
        if !self.is_angular {
            return [plan, plan, height];
        }
        let most = MOST.to_radians();
        let north = METRES_PER_DEGREE * plan.to_degrees();
        let east = north * (latitude * plan).clamp(-most, most).cos();
        [east, north, height]
    }

    /// Returns the meters in a unit of the plan and in one of the heights; `None` if the units are
    /// not known, or angles.
    pub(crate) fn in_metres(&self) -> Option<[f64; 2]> {
        let [plan, height] = [self.plan.as_ref()?, self.height.as_ref()?];
        (!self.is_angular).then_some([plan.factor, height.factor])
    }

    /// Returns the symbols of the units in plan and of heights, such as `m`, if they are known.
    pub(crate) fn symbols(&self) -> [Option<String>; 2] {
        [&self.plan, &self.height].map(|unit| unit.as_ref().map(|unit| symbol(unit).to_owned()))
    }

    /// Returns true if coordinates in plan are angles.
    pub(crate) fn is_angular(&self) -> bool {
        self.is_angular
    }

    /// Returns the names of both units if lengths in plan and heights are in different units.
    pub(crate) fn disagreement(&self) -> Option<(&str, &str)> {
        match (&self.plan, &self.height) {
            (Some(plan), Some(height)) if self.is_angular || plan.factor != height.factor => {
                Some((&plan.name, &height.name))
            }
            _ => None,
        }
    }
}

/// A length or a height with its unit, if that is known.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// The number.
    pub value: f64,
    /// Its unit; `None` if no coordinate system is known.
    pub unit: Option<Unit>,
}

/// Formats as `100 m`, `1 ftUS`, `12.5 units`, rounded like the numbers of a summary.
impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = number(self.value);
        match &self.unit {
            None if value == "1" => f.write_str("1 unit"),
            None => write!(f, "{value} units"),
            Some(unit) => write!(f, "{value} {}", symbol(unit)),
        }
    }
}

/// Returns the symbol of a unit, or its name if it has none.
fn symbol(unit: &Unit) -> &str {
    match unit.name.as_str() {
        "metre" | "meter" => "m",
        "foot" => "ft",
        "US survey foot" => "ftUS",
        "degree" => "degrees",
        name => name,
    }
}

/// Formats a number with at most nine decimals.
pub(crate) fn neat(value: f64) -> String {
    if value.abs() >= MANY_DIGITS {
        return format!("{value:e}");
    }
    let text = format!("{:.9}", unsigned_zero(value));
    match text.trim_end_matches('0').trim_end_matches('.') {
        // Not zero, but too small for nine decimals.
        "0" | "-0" if value != 0.0 => Plain(value).to_string(),
        "-0" => "0".to_owned(),
        trimmed => trimmed.to_owned(),
    }
}

/// Formats a number with at most two decimals; below 1 with three digits, below 1e-6 with two.
pub(crate) fn number(value: f64) -> String {
    if value.abs() >= MANY_DIGITS {
        format!("{value:.2e}")
    } else if value.abs() >= 1.0 || value == 0.0 {
        let text = format!("{value:.2}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else if value.abs() < 1e-6 {
        format!("{value:.1e}")
    } else {
        let digits = 2 - value.abs().log10().floor() as i32;
        let scale = 10f64.powi(digits);
        format!("{}", (value * scale).round() / scale)
    }
}

/// Formats a number of bytes as `12 kB`, `1.5 GB`.
pub(crate) fn bytes(count: u64) -> String {
    match count {
        0..1_000_000 => format!("{} kB", count.div_ceil(1000)),
        1_000_000..1_000_000_000 => format!("{:.0} MB", count as f64 / 1e6),
        _ => format!("{:.1} GB", count as f64 / 1e9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crs(kind: CrsKind, unit: (&str, f64), vertical: Option<(&str, f64)>) -> Crs {
        let unit_of = |(name, factor): (&str, f64)| Unit {
            name: name.to_owned(),
            factor,
        };
        Crs {
            name: "test".to_owned(),
            epsg: None,
            vertical_epsg: None,
            kind,
            unit: unit_of(unit),
            vertical_unit: vertical.map(unit_of),
            wkt: None,
        }
    }

    #[test]
    fn a_hundred_metres_are_328_feet() {
        let feet = Units::of(Some(&crs(CrsKind::Projected, ("foot", 0.3048), None)));
        assert_eq!(feet.length(feet.of_metres(100.0)).to_string(), "328.08 ft");
        assert_eq!(feet.disagreement(), None);
        let unknown = Units::of(None);
        assert_eq!(
            unknown.length(unknown.of_metres(100.0)).to_string(),
            "100 units"
        );
    }

    #[test]
    fn feet_over_metres_are_told() {
        let mixed = Units::of(Some(&crs(
            CrsKind::Projected,
            ("metre", 1.0),
            Some(("US survey foot", 1200.0 / 3937.0)),
        )));
        assert_eq!(mixed.disagreement(), Some(("metre", "US survey foot")));
        assert_eq!(mixed.height(2.5).to_string(), "2.5 ftUS");
    }

    #[test]
    fn degrees_have_heights_in_metres() {
        let degrees = Units::of(Some(&crs(CrsKind::Geographic, ("degree", 0.0174), None)));
        assert_eq!(degrees.disagreement(), Some(("degree", "metre")));
        assert_eq!(
            degrees.length(degrees.of_metres(100.0)).to_string(),
            "0.000898 degrees"
        );
    }

    #[test]
    fn numbers_are_short() {
        let cases = [
            (0.0, "0"),
            (1.0, "1"),
            (-12.345, "-12.35"),
            (100.0, "100"),
            (0.25, "0.25"),
            (0.001234, "0.00123"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
        let cases = [
            (-0.0, "0"),
            (0.1 + 0.2, "0.3"),
            (-1e-12, "-0.000000000001"),
            (1e-3, "0.001"),
            (7e5, "700000"),
        ];
        for (value, text) in cases {
            assert_eq!(neat(value), text);
        }
    }
}
