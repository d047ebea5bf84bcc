//! Coordinate systems: names, codes, units, and how formats write them.
//!
//! Nothing here reprojects; that is the task of PROJ, behind [`Transform`].
//!
//! Every form that a format uses (a code, WKT of any kind, GeoKeys) is converted to a `Definition`:
//! datum, projection with its parameters, unit. Two systems are the same if their definitions are;
//! names do not matter. Codes come from the EPSG registry in `proj-core`, names that it lacks from
//! `crs-definitions`, and names for a `.prj` follow a rule.

mod definition;
mod ellipsoid;
mod esri;
mod geokeys;
mod heights;
mod identifier;
mod names;
mod projection;
mod registry;
mod system;
mod unit;
mod wkt_read;
mod wkt_tree;
mod wkt_write;

pub(crate) use ellipsoid::{SEMI_AXES, from_local, geocentric};
pub use geokeys::{GeoKeys, RasterType};
pub use heights::Heights;
pub use system::{Crs, CrsKind};
pub use unit::Unit;

use definition::Definition;
use wkt_write::Dialect;

use crate::error::{Error, Result};

impl Crs {
    /// Returns the horizontal, compound or geocentric system with an EPSG code.
    ///
    /// A compound system is split into its parts.
    ///
    /// # Errors
    /// If the registry has no such code.
    pub fn from_epsg(code: u32) -> Result<Self> {
        let Some(found) = registry::find(code) else {
            let error = match registry::find_vertical(code) {
                Some(vertical) => Error::usage(format!(
                    "EPSG:{code} ({}) is only a vertical system",
                    vertical.name
                ))
                .cure(format!(
                    "state the horizontal system with it, as EPSG:25832+{code}"
                )),
                None => Error::usage(format!(
                    "EPSG:{code} is not the code of a coordinate system"
                ))
                .cure(
                    "write the code of a horizontal or compound system, such as EPSG:25832, or WKT",
                ),
            };
            return Err(error);
        };
        let height = found.vertical.as_ref().map(|part| part.unit.clone());
        Ok(Crs {
            name: found.name,
            epsg: Some(found.code),
            vertical_epsg: found.vertical.and_then(|part| part.code),
            vertical_unit: if found.kind == CrsKind::Geocentric {
                Some(found.unit.clone())
            } else {
                height
            },
            kind: found.kind,
            unit: found.unit,
            wkt: None,
        })
    }

    /// Parses WKT, version 1 (OGC or Esri) or 2.
    ///
    /// A definition without a code gets the code of the system in the registry with the same datum,
    /// projection, parameters and unit, if there is one.
    ///
    /// # Errors
    /// If the text is not WKT of a coordinate system.
    pub fn from_wkt(text: &str) -> Result<Self> {
        wkt_read::read(text).map(|(crs, _)| crs)
    }

    /// Parses the input of a user, or an identifier in a file: `EPSG:25832`, `EPSG:25832+7837`,
    /// `EPSG:25832+ellipsoid` (heights above the ellipsoid, in meters), `25832`, `OGC:CRS84`, a URN
    /// of OGC 07-092 or its http form, or WKT.
    ///
    /// | identifier | example |
    /// |---|---|
    /// | URN, with or without a version | `urn:ogc:def:crs:EPSG::25832` |
    /// | URN of a compound system | `urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837` |
    /// | http | `http://www.opengis.net/def/crs/EPSG/0/25832` |
    /// | http of a compound system | `http://www.opengis.net/def/crs-compound?1=http:...&2=http:...` |
    ///
    /// Systems with longitude and latitude have longitude as x, whatever the identifier says of the
    /// order of axes.
    ///
    /// # Errors
    /// If the text has none of these forms, or names no system that is known.
    pub fn from_user(text: &str) -> Result<Self> {
        let text = text.trim();
        if text.contains(['[', '(']) {
            return Self::from_wkt(text);
        }
        identifier::read(text)
    }

    /// Returns the definition for a `.prj` file: WKT 1 with Esri's names, which GDAL, QGIS and
    /// ArcGIS identify.
    ///
    /// It is horizontal only, as most readers expect.
    pub fn to_prj(&self) -> String {
        self.write(Dialect::Esri)
    }

    /// Returns the definition as WKT: as it was read, or else WKT 1 with GDAL's names and EPSG
    /// codes.
    ///
    /// The latter is compound if the vertical part is known.
    pub fn to_wkt(&self) -> String {
        if let Some(wkt) = &self.wkt {
            return wkt.clone();
        }
        let horizontal = self.write(Dialect::Gdal);
        match &self.vertical_unit {
            Some(unit) if self.vertical_epsg.is_some() => {
                wkt_write::write_compound(&self.name, &horizontal, (self.vertical_epsg, unit))
            }
            _ => horizontal,
        }
    }

    /// Like [`to_wkt`](Self::to_wkt), but always with the unit of heights: if nothing else is known
    /// of them, as a vertical system of unknown datum.
    pub(crate) fn to_wkt_with_unit_of_heights(&self) -> String {
        let wkt = self.to_wkt();
        match &self.vertical_unit {
            Some(unit) if Crs::from_wkt(&wkt).is_ok_and(|read| read.vertical_unit.is_none()) => {
                wkt_write::write_compound(&self.name, &wkt, (None, unit))
            }
            _ => wkt,
        }
    }

    fn write(&self, dialect: Dialect) -> String {
        let found = self.epsg.and_then(registry::find);
        // The name of the horizontal part, if the registry has it.
        let name = found
            .as_ref()
            .map_or(self.name.clone(), |found| found.name.clone());
        let definition = found
            .and_then(|found| found.definition)
            .or_else(|| self.definition());
        definition
            .and_then(|definition| wkt_write::write(&definition, &name, self.epsg, dialect))
            .or_else(|| self.wkt.clone())
            .unwrap_or_else(|| wkt_write::write_local(&self.name, &self.unit, dialect))
    }

    fn definition(&self) -> Option<Definition> {
        match &self.wkt {
            Some(wkt) => wkt_read::read(wkt).ok()?.1,
            None => registry::find(self.epsg?)?.definition,
        }
    }

    /// Returns true if both are the same horizontal system, and the same vertical one if both state
    /// one.
    ///
    /// Systems are compared by code if both have one, otherwise by definition (datum, projection,
    /// parameters, unit), and never by name.
    pub fn is_same(&self, other: &Crs) -> bool {
        if self == other {
            return true;
        }
        let vertical = match (self.vertical_epsg, other.vertical_epsg) {
            (Some(a), Some(b)) => a == b,
            _ => match (&self.vertical_unit, &other.vertical_unit) {
                (Some(a), Some(b)) => a.is_same(b) && !self.differs_by_ellipsoid(other),
                _ => true,
            },
        };
        let by_code = self.epsg.is_some() && self.epsg == other.epsg;
        let by_definition = || match (self.definition(), other.definition()) {
            (Some(a), Some(b)) => a.is_same(&b),
            // Only the text is known.
            _ => {
                self.epsg.is_none()
                    && other.epsg.is_none()
                    && self.wkt.is_some()
                    && self.wkt == other.wkt
            }
        };
        vertical && self.kind == other.kind && (by_code || by_definition())
    }

    /// Returns true if the heights of one are above its ellipsoid, and those of the other are above
    /// a vertical datum.
    fn differs_by_ellipsoid(&self, other: &Crs) -> bool {
        let is_datum = |heights| matches!(heights, Heights::Vertical(_) | Heights::Named);
        match (self.heights(), other.heights()) {
            (Heights::Ellipsoid, heights) | (heights, Heights::Ellipsoid) => is_datum(heights),
            _ => false,
        }
    }

    /// Returns the system, or `None` for the names that GDAL writes for a missing one, such as
    /// "Undefined geographic SRS".
    ///
    /// GDAL writes these into formats that require a system.
    pub fn unless_undefined(self) -> Option<Self> {
        let name = self.name.replace('_', " ").to_ascii_lowercase();
        // In Esri's `.prj` the name begins with GCS.
        let name = name.strip_prefix("gcs ").unwrap_or(&name);
        let is_undefined =
            self.epsg.is_none() && name.starts_with("undefined ") && name.ends_with(" srs");
        (!is_undefined).then_some(self)
    }

    /// Returns the unit of lengths in plan; `None` if coordinates are angles.
    pub fn length_unit(&self) -> Option<&Unit> {
        (self.kind != CrsKind::Geographic).then_some(&self.unit)
    }

    /// Returns true if lengths in plan are in feet of any kind.
    pub fn is_foot(&self) -> bool {
        self.length_unit().is_some_and(Unit::is_foot)
    }

    /// Returns a description for users.
    ///
    /// For example `EPSG:2994 (NAD83(HARN) / Oregon GIC Lambert (ft)), foot`, followed by
    /// `, heights in US survey foot (EPSG:6360)` if the vertical part is known.
    pub fn describe(&self) -> String {
        let mut text = format!("{self}, {}", self.unit.name);
        if self.kind == CrsKind::Geocentric {
            text += ", geocentric";
        } else if let Some(unit) = &self.vertical_unit {
            text += &format!(", heights in {}", unit.name);
            if let Some(code) = self.vertical_epsg {
                text += &format!(" (EPSG:{code})");
            }
        }
        text
    }
}

impl std::fmt::Display for Crs {
    /// Formats the system as `EPSG:25832 (ETRS89 / UTM zone 32N)`, or as its name alone.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.epsg {
            Some(code) => write!(f, "EPSG:{code} ({})", self.name),
            None => f.write_str(&self.name),
        }
    }
}

/// A transformation of coordinates from one system to another.
pub trait Transform: Send + Sync {
    /// Transforms points in place.
    ///
    /// # Errors
    /// If a point lies outside of the area of the operation; the message names the point.
    fn transform(&self, points: &mut [[f64; 3]]) -> Result<()>;

    /// Warnings for the user about the operation: unknown accuracy, heights that are not
    /// transformed.
    fn warnings(&self) -> Vec<String>;
}

#[cfg(test)]
mod tests {
    use super::Crs;

    #[test]
    fn what_gdal_writes_for_no_system_is_none() {
        let geographic = |name: &str| {
            format!(
                "GEOGCS[\"{name}\",DATUM[\"D_unknown\",SPHEROID[\"unknown\",6378137.0,298.257223563]],\
                 PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]]"
            )
        };
        let local = "ENGCRS[\"Undefined Cartesian SRS\",EDATUM[\"\"],CS[Cartesian,2],AXIS[\"x\",east],AXIS[\"y\",north],\
                     LENGTHUNIT[\"metre\",1]]";
        for undefined in [
            &geographic("Undefined geographic SRS"),
            &geographic("GCS_Undefined_geographic_SRS"),
            local,
        ] {
            assert_eq!(
                Crs::from_wkt(undefined).unwrap().unless_undefined(),
                None,
                "{undefined}"
            );
        }
        let named = Crs::from_wkt(&geographic("Some SRS")).unwrap();
        assert_eq!(named.clone().unless_undefined(), Some(named));
    }
}
