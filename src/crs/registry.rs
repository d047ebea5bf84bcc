//! The EPSG registry: definitions from `proj-core`, further names from `names.txt` (made by `names.sql`).

use std::collections::{BTreeMap, HashMap};
use std::sync::OnceLock;

use proj_core::{AxisOrder, CrsDef, HorizontalCrsDef, VerticalCrsDef};

use super::definition::{Datum, Definition, Ellipsoid};
use super::projection::{Projection, normalized};
use super::{CrsKind, Unit};

/// The highest code that a coordinate system has in the registry, which is also the highest that GeoKeys can hold.
const LAST_CODE: u32 = 32766;

/// What the registry says of a code.
pub(super) struct System {
    pub(super) name: String,
    pub(super) kind: CrsKind,
    /// The code of the horizontal part; the code itself, for what has no parts.
    pub(super) code: u32,
    pub(super) unit: Unit,
    /// None where proj-core has no formula for the projection.
    pub(super) definition: Option<Definition>,
    pub(super) vertical: Option<Vertical>,
}

/// A vertical system.
pub(super) struct Vertical {
    pub(super) name: String,
    /// None for heights over the ellipsoid.
    pub(super) code: Option<u32>,
    pub(super) unit: Unit,
}

/// The system with this code.
pub(super) fn find(code: u32) -> Option<System> {
    let Some(found) = proj_core::lookup_epsg(code) else {
        let (factor, name) = names().formulaless.get(&code)?;
        let unit = Unit::length(*factor);
        return Some(System {
            name: (*name).to_owned(),
            kind: CrsKind::Projected,
            code,
            unit,
            definition: None,
            vertical: None,
        });
    };
    let whole = found.name().to_owned();
    let mut system = match &found {
        CrsDef::Compound(parts) => {
            let horizontal = match parts.horizontal() {
                HorizontalCrsDef::Geographic(part) => CrsDef::Geographic(part.clone()),
                HorizontalCrsDef::Projected(part) => CrsDef::Projected(part.clone()),
            };
            let mut system = plain(&horizontal);
            let vertical = vertical(parts.vertical_crs());
            if vertical.code.is_none() {
                // A three-dimensional system has no parts: the code is of the whole.
                system.code = code;
            }
            system.vertical = Some(vertical);
            system
        }
        other => plain(other),
    };
    system.name = whole;
    Some(system)
}

/// The vertical system with this code.
pub(super) fn find_vertical(code: u32) -> Option<Vertical> {
    proj_core::lookup_vertical_epsg(code).map(|found| vertical(&found))
}

fn vertical(found: &VerticalCrsDef) -> Vertical {
    Vertical {
        name: found.name().to_owned(),
        code: Some(found.epsg()).filter(|&code| code != 0),
        unit: Unit::length(found.linear_unit_to_meter()),
    }
}

fn plain(found: &CrsDef) -> System {
    let (kind, unit, geographic, projection) = match found {
        CrsDef::Projected(p) => (
            CrsKind::Projected,
            Unit::length(p.linear_unit_to_meter()),
            p.base_geographic_crs_epsg(),
            Some(Projection::from_registry(p.method())),
        ),
        CrsDef::Geocentric(g) => (CrsKind::Geocentric, Unit::metre(), g.base_geographic_crs_epsg(), None),
        other => (CrsKind::Geographic, Unit::degree(), other.epsg(), None),
    };
    let code = found.datum().epsg();
    let geographic_name = proj_core::lookup_epsg(geographic).map_or(String::new(), |g| g.name().to_owned());
    // The two systems of France in grads: their definitions are written in grads, as Esri and GDAL do.
    let angle =
        if [4807, 4902].contains(&geographic) { Unit::angle(std::f64::consts::PI / 200.0) } else { Unit::degree() };
    let unit = if kind == CrsKind::Geographic { angle.clone() } else { unit };
    System {
        name: found.name().to_owned(),
        kind,
        code: found.epsg(),
        unit: unit.clone(),
        definition: datum(code).map(|datum| Definition {
            kind,
            datum,
            geographic: (geographic_name, Some(geographic).filter(|&code| code != 0)),
            angle,
            projection,
            unit,
        }),
        vertical: None,
    }
}

/// The geodetic datum with this code.
pub(super) fn datum(code: u32) -> Option<Datum> {
    let found = proj_core::lookup_datum_epsg(code)?;
    let row = names().datums.get(&code);
    let ellipsoid_code = row.map(|row| row.ellipsoid).or_else(|| proj_core::lookup_ellipsoid_code_for_datum(code));
    let ellipsoid = found.ellipsoid();
    let rf = if ellipsoid.flattening() == 0.0 { 0.0 } else { 1.0 / ellipsoid.flattening() };
    Some(Datum {
        name: row.map_or(String::new(), |row| row.name.to_owned()),
        code: Some(code),
        ellipsoid: Ellipsoid {
            name: ellipsoid_code
                .and_then(|code| names().ellipsoids.get(&code))
                .map_or("unknown".into(), |row| row.0.to_owned()),
            code: ellipsoid_code,
            a: ellipsoid.semi_major_axis(),
            // Through the flattening and back costs digits that were never there.
            rf: (rf * 1e10).round() / 1e10,
        },
        meridian: row.map_or(0.0, |row| meridian(row.meridian)),
    })
}

/// The name of a prime meridian by its longitude.
pub(super) fn meridian_name(longitude: f64) -> (&'static str, Option<u32>) {
    MERIDIANS
        .iter()
        .find(|row| (row.2 - longitude).abs() < 1e-7)
        .map_or(("unnamed", None), |&(code, name, _)| (name, Some(code)))
}

fn meridian(code: u32) -> f64 {
    MERIDIANS.iter().find(|row| row.0 == code).map_or(0.0, |row| row.2)
}

const MERIDIANS: &[(u32, &str, f64)] = &[
    (8901, "Greenwich", 0.0),
    (8902, "Lisbon", -(9.0 + 7.0 / 60.0 + 54.862 / 3600.0)),
    (8903, "Paris", 2.596_921_3 * 0.9),
    (8904, "Bogota", -(74.0 + 4.0 / 60.0 + 51.3 / 3600.0)),
    (8905, "Madrid", -(3.0 + 41.0 / 60.0 + 14.55 / 3600.0)),
    (8906, "Rome", 12.0 + 27.0 / 60.0 + 8.4 / 3600.0),
    (8907, "Bern", 7.0 + 26.0 / 60.0 + 22.5 / 3600.0),
    (8908, "Jakarta", 106.0 + 48.0 / 60.0 + 27.79 / 3600.0),
    (8909, "Ferro", -(17.0 + 40.0 / 60.0)),
    (8910, "Brussels", 4.0 + 22.0 / 60.0 + 4.71 / 3600.0),
    (8911, "Stockholm", 18.0 + 3.0 / 60.0 + 29.8 / 3600.0),
    (8912, "Athens", 23.0 + 42.0 / 60.0 + 58.815 / 3600.0),
    (8913, "Oslo", 10.0 + 43.0 / 60.0 + 22.5 / 3600.0),
    (8914, "Paris RGS", 2.0 + 20.0 / 60.0 + 13.95 / 3600.0),
    (1026, "Copenhagen", 12.0 + 34.0 / 60.0 + 39.9 / 3600.0),
];

/// The code of a datum by its name in any format, or by the name of the geographic system that rests on it.
pub(super) fn datum_code(datum: &str, geographic: &str) -> Option<u32> {
    const ALIASES: &[(&str, u32)] = &[
        ("wgs84", 6326),
        ("wgs1984", 6326),
        ("nad83", 6269),
        ("nad1983", 6269),
        ("nad27", 6267),
        ("etrs89", 6258),
        ("militargeographischeinstitute", 6312),
        ("nad83highaccuracyregionalnetwork", 6152),
        ("nad83highaccuracyreferencenetwork", 6152),
    ];
    let by_name = |name: &str| {
        let key = normalized(name);
        if key.is_empty() {
            return None;
        }
        let alias = ALIASES.iter().find(|alias| alias.0 == key).map(|alias| alias.1);
        alias
            .or_else(|| proj_core::lookup_datum_code_for_name(name))
            .or_else(|| proj_core::lookup_datum_code_for_name(&format!("D_{name}")))
    };
    by_name(datum).or_else(|| names().datum_of_geographic.get(&normalized(geographic)).copied())
}

/// What an Esri definition calls a datum, ellipsoid, geographic or projected system.
pub(super) mod esri {
    use super::names;

    pub(in crate::crs) fn datum(code: u32) -> Option<&'static str> {
        names().datums.get(&code).map(|row| row.esri).filter(|name| !name.is_empty())
    }

    pub(in crate::crs) fn ellipsoid(code: u32) -> Option<&'static str> {
        names().ellipsoids.get(&code).map(|row| row.1).filter(|name| !name.is_empty())
    }

    pub(in crate::crs) fn geographic(code: u32) -> Option<&'static str> {
        names().geographic.get(&code).map(|row| row.0).filter(|name| !name.is_empty())
    }

    pub(in crate::crs) fn projected(code: u32) -> Option<&'static str> {
        names().projected.get(&code).copied()
    }
}

/// Name and code of the datum of a vertical system.
pub(super) fn vertical_datum(code: u32) -> Option<(&'static str, u32)> {
    names().verticals.get(&code).map(|row| (row.datum_name, row.datum))
}

/// The vertical system of heights over the datum of this name, in this unit.
pub(super) fn identify_vertical(datum: &str, unit: &Unit) -> Option<u32> {
    let key = normalized(datum);
    let heights =
        names().verticals.iter().filter(|(_, row)| normalized(row.datum_name) == key && row.name.contains("height"));
    heights.map(|(&code, _)| code).find(|&code| find_vertical(code).is_some_and(|found| found.unit.is_same(unit)))
}

/// The vertical system of heights over the datum with this code, in this unit.
pub(super) fn vertical_of_datum(datum: u32, unit: &Unit) -> Option<u32> {
    let name = names().verticals.values().find(|row| row.datum == datum)?.datum_name;
    identify_vertical(name, unit)
}

/// The code of the system with this definition: method, parameters, datum and unit are the same. Where several are (the
/// registry has copies with northings first), the one of this name, else an ordinary one, else the lowest.
pub(super) fn identify(wanted: &Definition, name: &str) -> Option<u32> {
    let datum = wanted.datum.code?;
    let codes: Vec<u32> = match wanted.kind {
        CrsKind::Projected => projected()
            .iter()
            .filter(|(_, found)| found.datum.code == Some(datum) && found.is_same(wanted))
            .map(|(code, _)| *code)
            .collect(),
        CrsKind::Geographic => names()
            .geographic
            .iter()
            .filter(|(_, row)| row.1 == datum)
            .filter(|(code, _)| {
                find(**code).and_then(|found| found.definition).is_some_and(|found| found.is_same(wanted))
            })
            .map(|(code, _)| *code)
            .collect(),
        CrsKind::Geocentric if datum == 6326 && wanted.unit.is_same(&Unit::metre()) => vec![4978],
        _ => Vec::new(),
    };
    let key = normalized(name);
    let is_named = |code: u32| {
        let esri = esri::projected(code).or_else(|| esri::geographic(code));
        esri.is_some_and(|esri| normalized(esri) == key)
            || find(code).is_some_and(|found| normalized(&found.name) == key)
    };
    codes.into_iter().min_by_key(|&code| {
        let northing_first = proj_core::lookup_authority_axis_order(code) == Some(AxisOrder::NorthEast);
        // Geographic systems all begin with latitude.
        let odd = northing_first && wanted.kind == CrsKind::Projected;
        (!is_named(code), odd, code)
    })
}

/// Every projected system, by code.
fn projected() -> &'static [(u32, Definition)] {
    static ALL: OnceLock<Vec<(u32, Definition)>> = OnceLock::new();
    ALL.get_or_init(|| {
        (1024..=LAST_CODE)
            .filter_map(|code| match proj_core::lookup_epsg(code)? {
                found @ CrsDef::Projected(_) => Some((code, plain(&found).definition?)),
                _ => None,
            })
            .collect()
    })
}

struct DatumRow {
    name: &'static str,
    esri: &'static str,
    ellipsoid: u32,
    meridian: u32,
}

struct VerticalRow {
    name: &'static str,
    datum: u32,
    datum_name: &'static str,
}

#[derive(Default)]
struct Names {
    datums: HashMap<u32, DatumRow>,
    /// Name and Esri's name.
    ellipsoids: HashMap<u32, (&'static str, &'static str)>,
    /// Esri's name and the datum.
    geographic: BTreeMap<u32, (&'static str, u32)>,
    /// By normalized name, EPSG's and Esri's.
    datum_of_geographic: HashMap<String, u32>,
    projected: HashMap<u32, &'static str>,
    verticals: BTreeMap<u32, VerticalRow>,
    /// Metres in a unit and name.
    formulaless: HashMap<u32, (f64, &'static str)>,
}

fn names() -> &'static Names {
    static NAMES: OnceLock<Names> = OnceLock::new();
    NAMES.get_or_init(|| {
        let mut names = Names::default();
        for line in include_str!("names.txt").lines() {
            // A line that does not parse cannot be: a test reads them all.
            let _ = names.add(line);
        }
        names
    })
}

impl Names {
    fn add(&mut self, line: &'static str) -> Option<()> {
        let mut fields = line.split('|');
        let kind = fields.next()?;
        let code = fields.next()?.parse().ok()?;
        let mut text = || fields.next();
        match kind {
            "d" => {
                let (name, esri) = (text()?, text()?);
                let (ellipsoid, meridian) = (text()?.parse().ok()?, text()?.parse().ok()?);
                self.datums.insert(code, DatumRow { name, esri, ellipsoid, meridian });
            }
            "e" => drop(self.ellipsoids.insert(code, (text()?, text()?))),
            "g" => {
                let (esri, datum) = (text()?, text()?.parse().ok()?);
                self.geographic.insert(code, (esri, datum));
                let name = proj_core::lookup_epsg(code).map_or("", |found| match found {
                    CrsDef::Geographic(found) => found.name(),
                    _ => "",
                });
                for name in [name, esri].map(normalized) {
                    if !name.is_empty() {
                        self.datum_of_geographic.entry(name).or_insert(datum);
                    }
                }
            }
            "p" => drop(self.projected.insert(code, text()?)),
            "v" => {
                let (name, datum, datum_name) = (text()?, text()?.parse().ok()?, text()?);
                self.verticals.insert(code, VerticalRow { name, datum, datum_name });
            }
            "n" => drop(self.formulaless.insert(code, (text()?.parse().ok()?, text()?))),
            _ => return None,
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_of_the_names_is_read() {
        let mut names = Names::default();
        for line in include_str!("names.txt").lines() {
            assert!(names.add(line).is_some(), "{line}");
        }
    }

    #[test]
    fn prime_meridians_are_those_of_the_registry() {
        assert_eq!(meridian(8901), 0.0);
        assert!((datum(6807).unwrap().meridian - 2.33722917).abs() < 1e-9);
    }

    #[test]
    fn every_projected_system_is_identified_from_its_definition() {
        for (code, definition) in projected() {
            let name = find(*code).unwrap().name;
            let found = identify(definition, &name).unwrap_or_else(|| panic!("EPSG:{code} {name}"));
            assert!(find(found).unwrap().definition.unwrap().is_same(definition), "{code} is taken for {found}");
        }
    }
}
