//! Conversion of a [`Definition`] to WKT 1, with GDAL's names or Esri's.

use super::definition::Definition;
use super::esri::{self, underscored};
use super::projection::{Measure, Method, Param, Projection};
use super::{CrsKind, Unit, registry};
use crate::triangulation::num::unsigned_zero;

/// A dialect of WKT 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dialect {
    /// OGC's names, with AUTHORITY codes.
    Gdal,
    /// Esri's names, without codes, as in a `.prj`.
    Esri,
}

/// The horizontal definition as WKT 1; `None` if the projection method has no name in it.
pub(super) fn write(
    definition: &Definition,
    name: &str,
    epsg: Option<u32>,
    dialect: Dialect,
) -> Option<String> {
    let writer = Writer { dialect };
    Some(match definition.kind {
        CrsKind::Projected => writer.projected(definition, name, epsg)?,
        CrsKind::Geographic => writer.geographic(definition, name, epsg),
        CrsKind::Geocentric => writer.geocentric(definition, name, epsg),
        CrsKind::Local => return None,
    })
}

/// The WKT of a system of which only name and unit are known.
pub(super) fn write_local(name: &str, unit: &Unit, dialect: Dialect) -> String {
    let writer = Writer { dialect };
    format!(
        "LOCAL_CS[{},{},AXIS[\"Easting\",EAST],AXIS[\"Northing\",NORTH]]",
        quoted(name),
        writer.unit(unit)
    )
}

/// Horizontal WKT combined with a vertical system, as GDAL writes it.
pub(super) fn write_compound(
    name: &str,
    horizontal: &str,
    vertical: (Option<u32>, &Unit),
) -> String {
    let (code, unit) = vertical;
    let found = code.and_then(registry::find_vertical);
    let vertical_name = found.as_ref().map_or("unknown height", |found| &found.name);
    let (datum, datum_code) = match code.and_then(registry::vertical_datum) {
        Some((datum, code)) => (datum, Some(code)),
        None => ("unknown".into(), None),
    };
    let writer = Writer {
        dialect: Dialect::Gdal,
    };
    format!(
        "COMPD_CS[{},{horizontal},VERT_CS[{},VERT_DATUM[{},2005{}],{},AXIS[\"Gravity-related height\",UP]{}]]",
        quoted(name),
        quoted(vertical_name),
        quoted(&datum),
        authority(datum_code),
        writer.unit(unit),
        authority(code.filter(|_| found.is_some())),
    )
}

/// Horizontal WKT with heights above its ellipsoid in meters, as GDAL writes it.
pub(super) fn write_above_ellipsoid(name: &str, horizontal: &str) -> String {
    format!(
        "COMPD_CS[{},{horizontal},VERT_CS[\"Ellipsoid (metre)\",VERT_DATUM[\"Ellipsoid\",2002],\
         UNIT[\"metre\",1,AUTHORITY[\"EPSG\",\"9001\"]],AXIS[\"Up\",UP]]]",
        quoted(name)
    )
}

struct Writer {
    dialect: Dialect,
}

impl Writer {
    fn is_esri(&self) -> bool {
        self.dialect == Dialect::Esri
    }

    fn projected(&self, definition: &Definition, name: &str, epsg: Option<u32>) -> Option<String> {
        let Some(Projection::Known(method, _)) = &definition.projection else {
            return None;
        };
        let (method_name, parameters) = self.projection(definition, *method)?;
        let geographic = self.geographic(
            definition,
            &definition.geographic.0,
            definition.geographic.1,
        );
        let mut text = format!(
            "PROJCS[{},{geographic},PROJECTION[{}]",
            quoted(&self.name(name, |name| esri::projected(name, epsg))),
            quoted(method_name),
        );
        for (name, value) in parameters {
            text += &format!(",PARAMETER[{},{}]", quoted(name), self.number(value));
        }
        text += &format!(",{}", self.unit(&definition.unit));
        if !self.is_esri() {
            text += ",AXIS[\"Easting\",EAST],AXIS[\"Northing\",NORTH]";
            if *method == Method::WebMercator {
                // WKT 1 has no other means to state that the ellipsoid is to be treated as a
                // sphere.
                text += ",EXTENSION[\"PROJ4\",\"+proj=merc +a=6378137 +b=6378137 +lat_ts=0 +lon_0=0 +x_0=0 +y_0=0 +k=1 \
                         +units=m +nadgrids=@null +wktext +no_defs\"]";
            }
            text += &authority(epsg);
        }
        Some(text + "]")
    }

    /// The name of the method and the parameters in order, in the units of the definition.
    fn projection(
        &self,
        definition: &Definition,
        method: Method,
    ) -> Option<(&'static str, Vec<(&'static str, f64)>)> {
        let projection = definition.projection.as_ref()?;
        let row = method.row();
        let get = |param: Param| projection.get(&param).unwrap_or_default();
        let is_pole = (get(Param::Lat1).abs() - 90.0).abs() < 1e-9;
        let is_scaled = (get(Param::K0) - 1.0).abs() > 1e-12;
        let is_plain = |angle: f64, other: f64| (angle - other).abs() < 1e-9;
        let method_name = match (self.dialect, method) {
            (Dialect::Gdal, Method::Mercator) if get(Param::Lat1) != 0.0 => "Mercator_2SP",
            // Esri's Mercator has no scale; all readers know the other name.
            (Dialect::Esri, Method::Mercator) if is_scaled => "Mercator_1SP",
            (Dialect::Esri, Method::PolarStereographic) if !is_pole && get(Param::Lat1) > 0.0 => {
                "Stereographic_North_Pole"
            }
            (Dialect::Esri, Method::PolarStereographic) if !is_pole => "Stereographic_South_Pole",
            (Dialect::Esri, Method::HotineNatural | Method::HotineCenter)
                if !is_plain(get(Param::Azimuth), get(Param::Angle)) =>
            {
                match method {
                    Method::HotineNatural => "Rectified_Skew_Orthomorphic_Natural_Origin",
                    _ => "Rectified_Skew_Orthomorphic_Center",
                }
            }
            (Dialect::Gdal, _) => row.ogc,
            (Dialect::Esri, _) => row.esri,
        };
        let mut parameters: Vec<(&'static str, f64)> = Vec::new();
        for (param, ogc, esri, _) in row.params {
            let name = if self.is_esri() { esri } else { ogc };
            let value = self.value(param, get(param.clone()), definition);
            let skip = match (self.dialect, method, param) {
                (_, Method::Mercator, Param::Lat1) => {
                    if self.is_esri() {
                        is_scaled
                    } else {
                        value == 0.0
                    }
                }
                (Dialect::Gdal, Method::Mercator, Param::K0) => get(Param::Lat1) != 0.0,
                (Dialect::Esri, Method::Mercator, Param::K0) => !is_scaled,
                (Dialect::Gdal, Method::WebMercator, Param::Lat1) => true,
                (Dialect::Esri, Method::PolarStereographic, Param::K0) => !is_pole,
                (Dialect::Esri, Method::HotineNatural | Method::HotineCenter, Param::Angle) => {
                    !method_name.starts_with("Rectified")
                }
                _ => false,
            };
            let name = match (self.dialect, method, param) {
                (Dialect::Esri, Method::PolarStereographic, Param::Lat1) if is_pole => {
                    "latitude_of_origin"
                }
                _ => *name,
            };
            if !skip {
                parameters.push((name, value));
            }
        }
        if self.is_esri() {
            match method {
                Method::Lambert1 => {
                    let lat0 = self.value(&Param::Lat0, get(Param::Lat0), definition);
                    parameters.insert(2, ("Standard_Parallel_1", lat0));
                }
                Method::WebMercator => parameters.push(("Auxiliary_Sphere_Type", 0.0)),
                Method::Krovak => parameters.extend([
                    ("X_Scale", -1.0),
                    ("Y_Scale", 1.0),
                    ("XY_Plane_Rotation", 90.0),
                ]),
                _ => {}
            }
            // Esri's order: false origin first.
            parameters.sort_by_key(|(name, _)| !name.starts_with("False_"));
        }
        Some((method_name, parameters))
    }

    fn value(&self, param: &Param, value: f64, definition: &Definition) -> f64 {
        match param.measure() {
            Measure::Angle => snap_angle(value) / definition.angle.factor.to_degrees(),
            Measure::Length => snap(value / definition.unit.factor, 1e-5),
            Measure::Ratio => value,
        }
    }

    fn geographic(&self, definition: &Definition, name: &str, epsg: Option<u32>) -> String {
        let name = self.name(name, esri::geographic);
        let codes = if self.is_esri() {
            String::new()
        } else {
            authority(epsg)
        };
        format!(
            "GEOGCS[{},{},{}{codes}]",
            quoted(&name),
            self.datum(definition),
            self.unit(&definition.angle)
        )
    }

    fn geocentric(&self, definition: &Definition, name: &str, epsg: Option<u32>) -> String {
        format!(
            "GEOCCS[{},{},{},AXIS[\"Geocentric X\",OTHER],AXIS[\"Geocentric Y\",OTHER],AXIS[\"Geocentric Z\",NORTH]{}]",
            quoted(name),
            Writer {
                dialect: Dialect::Gdal
            }
            .datum(definition),
            self.unit(&definition.unit),
            authority(epsg),
        )
    }

    /// DATUM and PRIMEM.
    fn datum(&self, definition: &Definition) -> String {
        let datum = &definition.datum;
        let ellipsoid = &datum.ellipsoid;
        let (name, ellipsoid_name) = match self.dialect {
            Dialect::Gdal => (gdal_datum_name(&datum.name), ellipsoid.name.clone()),
            Dialect::Esri => (esri::datum(datum), esri::ellipsoid(&ellipsoid.name)),
        };
        let (meridian, meridian_code) = registry::meridian_name(datum.meridian);
        let codes = |code: Option<u32>| {
            if self.is_esri() {
                String::new()
            } else {
                authority(code)
            }
        };
        format!(
            "DATUM[{},SPHEROID[{},{},{}{}]{}],PRIMEM[{},{}{}]",
            quoted(&name),
            quoted(&ellipsoid_name),
            self.number(ellipsoid.a),
            self.number(ellipsoid.rf),
            codes(ellipsoid.code),
            codes(datum.code),
            quoted(meridian),
            self.number(datum.meridian),
            codes(meridian_code),
        )
    }

    fn unit(&self, unit: &Unit) -> String {
        let esri = match unit.name.as_str() {
            "metre" => "Meter",
            "foot" => "Foot",
            "US survey foot" => "Foot_US",
            "kilometre" => "Kilometer",
            "degree" => "Degree",
            "grad" => "Grad",
            other => other,
        };
        let (name, code) = match self.dialect {
            Dialect::Gdal => (unit.name.as_str(), unit.code().map(u32::from)),
            Dialect::Esri => (esri, None),
        };
        format!(
            "UNIT[{},{}{}]",
            quoted(name),
            self.number(unit.factor),
            authority(code)
        )
    }

    fn name(&self, name: &str, esri: impl Fn(&str) -> String) -> String {
        match self.dialect {
            Dialect::Gdal => name.to_owned(),
            Dialect::Esri => esri(name),
        }
    }

    /// A number with fifteen significant digits, as other writers do; Esri's always have a point.
    fn number(&self, value: f64) -> String {
        let value: f64 = format!("{value:.14e}").parse().unwrap_or(value);
        let text = unsigned_zero(value).to_string();
        if self.is_esri() && !text.contains('.') {
            text + ".0"
        } else {
            text
        }
    }
}

/// Restores an angle: the registry's have 12 digits, but most were whole multiples of 1e-5 seconds.
fn snap_angle(degrees: f64) -> f64 {
    let snapped = snap(degrees * 3.6e8, 0.01) / 3.6e8;
    if (snapped - degrees).abs() < 2e-12 * degrees.abs().max(1.0) {
        snapped
    } else {
        degrees
    }
}

fn snap(value: f64, step: f64) -> f64 {
    let per_unit = (1.0 / step).round();
    let snapped = (value * per_unit).round() / per_unit;
    if (snapped - value).abs() < 1e-11 * value.abs().max(1.0) {
        snapped
    } else {
        value
    }
}

fn gdal_datum_name(name: &str) -> String {
    let name = name.strip_suffix(" ensemble").unwrap_or(name);
    match name {
        "World Geodetic System 1984" => "WGS_1984".into(),
        _ => underscored(name),
    }
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

fn authority(code: Option<u32>) -> String {
    code.map_or(String::new(), |code| {
        format!(",AUTHORITY[\"EPSG\",\"{code}\"]")
    })
}
