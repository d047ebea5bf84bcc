//! The EPSG registry: definitions from `proj-core`, further names from `crs-definitions`.

use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use proj_core::{AxisOrder, CrsDef, HorizontalCrsDef, VerticalCrsDef};

use super::definition::{Datum, Definition, Ellipsoid};
use super::projection::{Projection, normalized};
use super::{CrsKind, Unit, esri, names};

/// The highest code of a coordinate system in the registry, which is also the highest in GeoKeys.
const LAST_CODE: u32 = 32766;

/// The registry's entry for a code.
pub(super) struct System {
    pub(super) name: String,
    pub(super) kind: CrsKind,
    /// The code of the horizontal part; for a system without parts, its own code.
    pub(super) code: u32,
    pub(super) unit: Unit,
    /// `None` if proj-core has no formula for the projection.
    pub(super) definition: Option<Definition>,
    pub(super) vertical: Option<Vertical>,
}

/// A vertical system.
pub(super) struct Vertical {
    pub(super) name: String,
    /// `None` for heights above the ellipsoid.
    pub(super) code: Option<u32>,
    pub(super) unit: Unit,
}

/// The system with a code.
pub(super) fn find(code: u32) -> Option<System> {
    let Some(found) = proj_core::lookup_epsg(code) else {
        let (name, unit) = names::projected(code)?;
        return Some(System {
            name,
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
                // A three-dimensional system has no parts: the code is that of the whole.
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

/// Returns true if the authority states latitude or northing first.
pub(super) fn is_northing_first(code: u32) -> Option<bool> {
    Some(proj_core::lookup_authority_axis_order(code)? == AxisOrder::NorthEast)
}

/// The vertical system with a code.
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
        CrsDef::Geocentric(g) => (
            CrsKind::Geocentric,
            Unit::metre(),
            g.base_geographic_crs_epsg(),
            None,
        ),
        other => (CrsKind::Geographic, Unit::degree(), other.epsg(), None),
    };
    let code = found.datum().epsg();
    let geographic_name =
        proj_core::lookup_epsg(geographic).map_or(String::new(), |g| g.name().to_owned());
    // Definitions of the two French systems in grads use grads, as with Esri and GDAL.
    let angle = if [4807, 4902].contains(&geographic) {
        Unit::angle(std::f64::consts::PI / 200.0)
    } else {
        Unit::degree()
    };
    let unit = if kind == CrsKind::Geographic {
        angle.clone()
    } else {
        unit
    };
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

/// The geodetic datum with a code.
pub(super) fn datum(code: u32) -> Option<Datum> {
    let found = proj_core::lookup_datum_epsg(code)?;
    let names = names::datum(code);
    // A datum that is newer than the definitions gets the name of a system that uses it.
    let named_after = || {
        geographic()
            .iter()
            .find(|system| system.datum == code)
            .map_or(String::new(), |system| system.name.clone())
    };
    let ellipsoid_code = proj_core::lookup_ellipsoid_code_for_datum(code);
    let ellipsoid = found.ellipsoid();
    let rf = if ellipsoid.flattening() == 0.0 {
        0.0
    } else {
        1.0 / ellipsoid.flattening()
    };
    Some(Datum {
        name: names.map_or_else(named_after, |names| names.name.clone()),
        code: Some(code),
        ellipsoid: Ellipsoid {
            name: ellipsoid_code
                .and_then(names::ellipsoid)
                .unwrap_or("unknown")
                .to_owned(),
            code: ellipsoid_code,
            a: ellipsoid.semi_major_axis(),
            // The inverse of the flattening has spurious digits.
            rf: (rf * 1e10).round() / 1e10,
        },
        meridian: names.and_then(|names| names.meridian).map_or(0.0, meridian),
    })
}

/// Name and code of a prime meridian by its longitude.
pub(super) fn meridian_name(longitude: f64) -> (&'static str, Option<u32>) {
    MERIDIANS
        .iter()
        .find(|row| (row.2 - longitude).abs() < 1e-7)
        .map_or(("unnamed", None), |&(code, name, _)| (name, Some(code)))
}

fn meridian(code: u32) -> f64 {
    MERIDIANS
        .iter()
        .find(|row| row.0 == code)
        .map_or(0.0, |row| row.2)
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

/// The code of a datum by its name in any format, or by that of a geographic system that uses it.
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
        let alias = ALIASES
            .iter()
            .find(|alias| alias.0 == key)
            .map(|alias| alias.1);
        alias
            .or_else(|| proj_core::lookup_datum_code_for_name(name))
            .or_else(|| proj_core::lookup_datum_code_for_name(&format!("D_{name}")))
    };
    by_name(datum).or_else(|| datum_of_geographic(geographic))
}

/// The code of the datum of the geographic system with a name, EPSG's or Esri's.
fn datum_of_geographic(name: &str) -> Option<u32> {
    static BY_NAME: OnceLock<HashMap<String, u32>> = OnceLock::new();
    let by_name = BY_NAME.get_or_init(|| {
        let mut by_name = HashMap::new();
        for system in geographic() {
            for name in [
                normalized(&system.name),
                normalized(&esri::geographic(&system.name)),
            ] {
                by_name.entry(name).or_insert(system.datum);
            }
        }
        by_name
    });
    by_name.get(&normalized(name)).copied()
}

/// Name and code of the datum of a vertical system.
pub(super) fn vertical_datum(code: u32) -> Option<(String, u32)> {
    let system = verticals().iter().find(|system| system.epsg() == code)?;
    Some((vertical_datum_name(system), system.vertical_datum_epsg()?))
}

/// The name of the datum; if it is unknown, that of the system without "height".
fn vertical_datum_name(system: &VerticalCrsDef) -> String {
    let known = system.vertical_datum_epsg().and_then(names::vertical_datum);
    known.map_or_else(
        || {
            let name = system.name();
            let end = [" height", " depth"]
                .iter()
                .filter_map(|word| name.find(word))
                .min()
                .unwrap_or(name.len());
            name[..end].to_owned()
        },
        str::to_owned,
    )
}

/// The vertical system of heights above the datum of a name, in a unit; if no datum has that name,
/// the system of this name.
pub(super) fn identify_vertical(datum: &str, name: &str, unit: &Unit) -> Option<u32> {
    let (datum, name) = (normalized(datum), normalized(name));
    let by_datum = heights(unit).find(|system| normalized(&vertical_datum_name(system)) == datum);
    let found = by_datum.or_else(|| heights(unit).find(|system| normalized(system.name()) == name));
    found.map(VerticalCrsDef::epsg)
}

/// The vertical system of heights above the datum with a code, in a unit.
pub(super) fn vertical_of_datum(datum: u32, unit: &Unit) -> Option<u32> {
    heights(unit)
        .find(|system| system.vertical_datum_epsg() == Some(datum))
        .map(VerticalCrsDef::epsg)
}

/// The vertical systems of heights in a unit, by code.
fn heights(unit: &Unit) -> impl Iterator<Item = &'static VerticalCrsDef> {
    let in_unit =
        |system: &&VerticalCrsDef| unit.is_same(&Unit::length(system.linear_unit_to_meter()));
    verticals()
        .iter()
        .filter(|system| system.name().contains("height"))
        .filter(in_unit)
}

/// The code of the system with a definition: the same method, parameters, datum and unit.
///
/// There may be several, as the registry has copies with northings first. Then the one with this
/// name precedes those that share most of its words, then those with eastings first, then the
/// lowest code.
pub(super) fn identify(wanted: &Definition, name: &str) -> Option<u32> {
    let datum = wanted.datum.code?;
    let codes: Vec<u32> = match wanted.kind {
        CrsKind::Projected => projected(datum)
            .iter()
            .filter(|(_, found)| found.is_same(wanted))
            .map(|(code, _)| *code)
            .collect(),
        CrsKind::Geographic => geographic()
            .iter()
            .filter(|system| system.datum == datum)
            .map(|system| system.code)
            .filter(|&code| {
                find(code)
                    .and_then(|found| found.definition)
                    .is_some_and(|found| found.is_same(wanted))
            })
            .collect(),
        CrsKind::Geocentric if datum == 6326 && wanted.unit.is_same(&Unit::metre()) => vec![4978],
        _ => Vec::new(),
    };
    if codes.len() < 2 {
        return codes.first().copied();
    }
    let key = normalized(name);
    let is_named = |code: u32| {
        find(code).is_some_and(|found| {
            let esri = match found.kind {
                CrsKind::Projected => esri::projected(&found.name, Some(code)),
                _ => esri::geographic(&found.name),
            };
            [esri, found.name]
                .iter()
                .any(|name| normalized(name) == key)
        })
    };
    // New Jersey's system equals that of New York East. Esri's name shares the words of the state
    // with EPSG's name, and little else.
    let stated = words(name);
    let common_words =
        |code: u32| find(code).map_or(0, |found| words(&found.name).intersection(&stated).count());
    codes.into_iter().min_by_key(|&code| {
        let northing_first =
            proj_core::lookup_authority_axis_order(code) == Some(AxisOrder::NorthEast);
        // All geographic systems have latitude first.
        let odd = northing_first && wanted.kind == CrsKind::Projected;
        (!is_named(code), Reverse(common_words(code)), odd, code)
    })
}

/// The words of a name that consist of letters alone ("New", "Jersey"): formats write the numbers
/// of zones differently.
fn words(name: &str) -> HashSet<String> {
    let words = name
        .split(|c: char| !c.is_ascii_alphabetic())
        .filter(|word| word.len() > 2);
    words.map(str::to_ascii_lowercase).collect()
}

/// Projected systems, by code.
type ProjectedSystems = Arc<[(u32, Definition)]>;

/// The projected systems with a datum.
///
/// `PERF:` the definitions of all datums would take longer than a million points take to be sorted.
fn projected(datum: u32) -> ProjectedSystems {
    static KNOWN: Mutex<BTreeMap<u32, ProjectedSystems>> = Mutex::new(BTreeMap::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let definition = |code| match proj_core::lookup_epsg(code)? {
        found @ CrsDef::Projected(_) => Some((code, plain(&found).definition?)),
        _ => None,
    };
    let find = || {
        (1024..=LAST_CODE)
            .filter(|&code| proj_core::lookup_datum_code_for_crs(code) == Some(datum))
            .filter_map(definition)
            .collect()
    };
    Arc::clone(known.entry(datum).or_insert_with(find))
}

struct Geographic {
    code: u32,
    name: String,
    datum: u32,
}

/// All two-dimensional geographic systems, by code.
fn geographic() -> &'static [Geographic] {
    static ALL: OnceLock<Vec<Geographic>> = OnceLock::new();
    ALL.get_or_init(|| {
        (1024..=LAST_CODE)
            .filter(|&code| proj_core::lookup_datum_code_for_crs(code).is_some())
            .filter_map(|code| match proj_core::lookup_epsg(code)? {
                CrsDef::Geographic(found) => Some(Geographic {
                    code,
                    name: found.name().to_owned(),
                    datum: found.datum().epsg(),
                }),
                _ => None,
            })
            .collect()
    })
}

/// All vertical systems, by code.
fn verticals() -> &'static [VerticalCrsDef] {
    static ALL: OnceLock<Vec<VerticalCrsDef>> = OnceLock::new();
    ALL.get_or_init(|| {
        (1024..=LAST_CODE)
            .filter_map(proj_core::lookup_vertical_epsg)
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prime_meridians_are_those_of_the_registry() {
        assert_eq!(meridian(8901), 0.0);
        assert!((datum(6807).unwrap().meridian - 2.33722917).abs() < 1e-9);
    }

    #[test]
    fn every_projected_system_is_identified_from_its_definition() {
        let all = (1024..=LAST_CODE)
            .filter(|&code| proj_core::lookup_datum_code_for_crs(code).is_some())
            .filter_map(|code| Some((code, find(code)?)));
        let is_projected = |system: &System| system.kind == CrsKind::Projected;
        let mut count = 0;
        for (code, system) in all.filter(|(_, system)| is_projected(system)) {
            let Some(definition) = system.definition.filter(|_| system.vertical.is_none()) else {
                continue;
            };
            let name = system.name;
            let found =
                identify(&definition, &name).unwrap_or_else(|| panic!("EPSG:{code} {name}"));
            assert!(
                find(found)
                    .unwrap()
                    .definition
                    .unwrap()
                    .is_same(&definition),
                "{code} is taken for {found}"
            );
            count += 1;
        }
        assert!(count > 4_000, "{count}");
    }

    #[test]
    fn of_systems_with_one_definition_the_name_decides() {
        for (code, name) in [
            (3424, "NAD_1983_StatePlane_New_Jersey_FIPS_2900_Feet"),
            (2260, "NAD_1983_StatePlane_New_York_East_FIPS_3101_Feet"),
            (31467, "DHDN_3_Degree_Gauss_Zone_3"),
            (5677, "DHDN / 3-degree Gauss-Kruger zone 3 (E-N)"),
            (25832, "no such name"),
        ] {
            let definition = find(code).unwrap().definition.unwrap();
            assert_eq!(identify(&definition, name), Some(code), "{name}");
        }
    }

    #[test]
    fn heights_are_identified_by_datum_else_by_name() {
        let metre = Unit::metre();
        assert_eq!(
            identify_vertical("North_American_Vertical_Datum_1988", "", &metre),
            Some(5703)
        );
        assert_eq!(
            identify_vertical("Deutsches Haupthoehennetz 2016", "", &metre),
            Some(7837)
        );
        assert_eq!(
            identify_vertical("unknown", "SVS2000 height", &metre),
            Some(5779)
        );
        assert_eq!(identify_vertical("of nobody", "of nobody", &metre), None);
        assert_eq!(
            vertical_of_datum(5103, &Unit::length(12.0 / 39.37)),
            Some(6360)
        );
        assert_eq!(
            vertical_datum(7837).unwrap(),
            ("Deutsches Haupthoehennetz 2016".to_owned(), 1170)
        );
    }
}
