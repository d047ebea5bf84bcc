//! Units and the coordinate system of a LandXML file.

use crate::crs::{Crs, CrsKind, Unit};
use crate::error::{Error, Result, Wording};

/// A unit of length as LandXML names it: the element of its system, and its name there.
pub(super) struct UnitNames {
    pub(super) element: &'static str,
    pub(super) linear: &'static str,
}

/// Returns how LandXML names a unit, if it does.
pub(super) fn unit_names(unit: &Unit) -> Option<UnitNames> {
    let names = |element, linear| UnitNames { element, linear };
    match unit.name.as_str() {
        "metre" => Some(names("Metric", "meter")),
        "millimetre" => Some(names("Metric", "millimeter")),
        "centimetre" => Some(names("Metric", "centimeter")),
        "kilometre" => Some(names("Metric", "kilometer")),
        "foot" => Some(names("Imperial", "foot")),
        "US survey foot" => Some(names("Imperial", "USSurveyFoot")),
        "mile" => Some(names("Imperial", "mile")),
        _ => None,
    }
}

/// Returns how LandXML names a unit of heights that is not the unit of all coordinates, if it does.
pub(super) fn elevation_name(unit: &Unit) -> Option<&'static str> {
    match unit.name.as_str() {
        "metre" => Some("meter"),
        "kilometre" => Some("kilometer"),
        "foot" => Some("feet"),
        "mile" => Some("miles"),
        _ => None,
    }
}

/// Returns the unit with a name of LandXML.
pub(super) fn unit_of(name: &str) -> Option<Unit> {
    match name {
        "inch" => Some(Unit::new("inch", 0.0254)),
        "miles" => Unit::length_from_name("mile"),
        _ => Unit::length_from_name(&name.replace("meter", "metre")),
    }
}

/// What a file states of its coordinates.
#[derive(Default)]
pub(super) struct Stated {
    pub(super) linear: Option<Unit>,
    pub(super) elevation: Option<Unit>,
    pub(super) epsg: Option<String>,
    pub(super) wkt: Option<String>,
    /// The name of the system, for a message.
    pub(super) name: Option<String>,
}

impl Stated {
    /// Returns the coordinate system, and a warning if one is stated that is not understood.
    ///
    /// A file that states feet and no system has a local one in that unit. Meters alone state none.
    ///
    /// # Errors
    /// If the system has another unit than the file.
    pub(super) fn system(self) -> Result<(Option<Crs>, Option<Wording>)> {
        let by_wkt = self.wkt.as_deref().and_then(|wkt| Crs::from_wkt(wkt).ok());
        let is_stated = |code: &&str| !matches!(*code, "" | "0");
        let code = self.epsg.as_deref().map(str::trim).filter(is_stated);
        let by_code = || code.and_then(|code| Crs::from_user(&format!("EPSG:{code}")).ok());
        if let Some(mut crs) = by_wkt.or_else(by_code) {
            self.require_unit_of(&crs)?;
            if let (None, Some(heights)) = (&crs.vertical_unit, self.elevation) {
                crs.vertical_unit = (!heights.is_same(&crs.unit)).then_some(heights);
            }
            return Ok((Some(crs), None));
        }
        let warning = code
            .map(|code| format!("EPSG:{code}"))
            .or(self.wkt.filter(|wkt| !wkt.is_empty()))
            .or(self.name)
            .map(|text| {
                let text: String = text.chars().take(60).collect();
                format!("the coordinate system '{text}' is not understood").into()
            });
        let local = |unit: Unit| {
            let (name, factor) = (&unit.name, unit.factor);
            Crs::from_wkt(&format!(
                "LOCAL_CS[\"LandXML\",UNIT[\"{name}\",{factor:?}]]"
            ))
        };
        let plan = self.linear.unwrap_or_else(Unit::metre);
        let heights = self.elevation.filter(|heights| !heights.is_same(&plan));
        if plan.is_same(&Unit::metre()) && heights.is_none() {
            return Ok((None, warning));
        }
        let mut crs = local(plan)?;
        crs.vertical_unit = heights;
        Ok((Some(crs), warning))
    }

    fn require_unit_of(&self, crs: &Crs) -> Result<()> {
        match &self.linear {
            Some(unit) if crs.kind != CrsKind::Geographic && !unit.is_same(&crs.unit) => {
                Err(Error::format(format!(
                    "the coordinates are in {} by 'Units', in {} by the coordinate system {crs}",
                    unit.name, crs.unit.name
                ))
                .cure("correct linearUnit, or remove the element CoordinateSystem"))
            }
            _ => Ok(()),
        }
    }
}
