//! Coordinate systems by their identifiers: codes, the URNs of OGC 07-092, and their http forms.
//!
//! | form | example |
//! |---|---|
//! | code | `25832`, `EPSG:25832`, `OGC:CRS84` |
//! | codes of both parts | `EPSG:25832+7837` |
//! | with heights above the ellipsoid | `EPSG:25832+ellipsoid` |
//! | URN; the version may be missing | `urn:ogc:def:crs:EPSG:9.8:25832`, `urn:ogc:def:crs:OGC:1.3:CRS84` |
//! | URN of a compound system | `urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::7837` |
//! | http | `http://www.opengis.net/def/crs/EPSG/0/25832` |
//! | http with parameters | `http://www.opengis.net/def/crs?authority=EPSG&version=0&code=25832` |
//! | http of a compound system | `http://www.opengis.net/def/crs-compound?1=http:...&2=http:...` |
//! | http of GML 2 | `http://www.opengis.net/gml/srs/epsg.xml#25832` |
//!
//! Upper and lower case are the same. A system that is put together from a datum, a coordinate
//! system or a conversion, and one with parameters, is refused by name.

use super::{Crs, registry};
use crate::error::{Error, Result};

const CURE: &str = "write EPSG:25832, EPSG:25832+7837 (with heights), or WKT";

/// What stands for a vertical code where heights are above the ellipsoid.
const ELLIPSOID: &str = "ellipsoid";

/// The codes of OGC for systems with longitude before latitude, each with the code in EPSG of the
/// system that has the same datum.
const OF_OGC: &[(&str, u32)] = &[
    ("crs84", 4326),
    ("crs84h", 4979),
    ("crs83", 4269),
    ("crs27", 4267),
];

/// A system that an identifier names: `crs`, `epsg`, `25832`.
struct Object {
    kind: String,
    authority: String,
    code: String,
}

impl Object {
    fn new(kind: &str, authority: &str, code: &str) -> Self {
        Object {
            kind: kind.to_owned(),
            authority: authority.to_owned(),
            code: code.to_owned(),
        }
    }
}

/// Returns the system that an identifier names.
///
/// # Errors
/// If the text is none of these forms, or names no system that is known.
pub(super) fn read(text: &str) -> Result<Crs> {
    let objects = objects(&text.to_ascii_lowercase()).ok_or_else(|| not_a_system(text))?;
    for Object {
        kind, authority, ..
    } in &objects
    {
        if kind != "crs" {
            return Err(Error::unsupported(format!(
                "\"{text}\" puts a system together from a {kind}"
            ))
            .cure(CURE));
        }
        if authority != "epsg" && authority != "ogc" {
            let authority = authority.to_ascii_uppercase();
            return Err(Error::unsupported(format!(
                "\"{text}\": the codes of {authority} are not known"
            ))
            .cure(CURE));
        }
    }
    match &objects[..] {
        [one] => horizontal(one, text),
        [one, other] => with_heights(horizontal(one, text)?, other, text),
        _ => Err(Error::unsupported(format!(
            "\"{text}\" has {} parts, expected one or two",
            objects.len()
        ))
        .cure(CURE)),
    }
}

fn horizontal(object: &Object, text: &str) -> Result<Crs> {
    if object.authority == "ogc" {
        let found = OF_OGC.iter().find(|(name, _)| *name == object.code);
        let (_, code) = found.ok_or_else(|| {
            let code = object.code.to_ascii_uppercase();
            Error::unsupported(format!(
                "\"{text}\": OGC's {code} is not a system in plan that is known"
            ))
            .cure(CURE)
        })?;
        return Crs::from_epsg(*code);
    }
    Crs::from_epsg(object.code.parse().map_err(|_| not_a_system(text))?)
}

/// Adds the vertical system of a compound one.
fn with_heights(mut crs: Crs, object: &Object, text: &str) -> Result<Crs> {
    if crs.vertical_unit.is_some() {
        return Err(Error::usage(format!("\"{text}\": {crs} has heights of its own")).cure(CURE));
    }
    if object.code == ELLIPSOID {
        return Ok(crs.with_ellipsoidal_heights());
    }
    let code = match (object.authority.as_str(), object.code.as_str()) {
        ("ogc", "crs88") => 5703,
        (_, code) => code.parse().map_err(|_| not_a_system(text))?,
    };
    let found = registry::find_vertical(code).ok_or_else(|| {
        Error::usage(format!(
            "EPSG:{code} is not the code of a vertical coordinate system"
        ))
        .cure(CURE)
    })?;
    crs.name = format!("{} + {}", crs.name, found.name);
    crs.vertical_epsg = found.code;
    crs.vertical_unit = Some(found.unit);
    Ok(crs)
}

#[cold]
fn not_a_system(text: &str) -> Error {
    Error::usage(format!("\"{text}\" is not a coordinate system")).cure(CURE)
}

/// Returns the objects that a text in lower case names; `None` for a form that is not known.
fn objects(text: &str) -> Option<Vec<Object>> {
    if let Some(urn) = ["urn:ogc:def:", "urn:x-ogc:def:"]
        .iter()
        .find_map(|prefix| text.strip_prefix(prefix))
    {
        return of_urn(urn);
    }
    if let Some(url) = ["http://", "https://"]
        .iter()
        .find_map(|prefix| text.strip_prefix(prefix))
    {
        return of_url(url);
    }
    match text.split_once(':') {
        Some(("urn", _)) => None,
        Some((authority, code)) => of_code(authority.trim(), code),
        None if text == "crs84" => of_code("ogc", text),
        None => of_code("epsg", text),
    }
}

/// Splits `25832+7837` or `25832+epsg:7837`.
fn of_code(authority: &str, code: &str) -> Option<Vec<Object>> {
    let parts = code
        .split('+')
        .map(|part| match part.trim().split_once(':') {
            Some((authority, code)) => Object::new("crs", authority, code),
            None => Object::new("crs", authority, part.trim()),
        });
    Some(parts.collect())
}

/// Splits `crs:epsg::25832`, or `crs,crs:epsg::25832,crs:epsg::7837`.
fn of_urn(urn: &str) -> Option<Vec<Object>> {
    let object = |text: &str| {
        let parts: Vec<&str> = text.split(':').map(str::trim).collect();
        match parts[..] {
            [kind, authority, code] | [kind, authority, _, code] => {
                let codes = of_code(authority, code)?;
                Some(
                    codes
                        .into_iter()
                        .map(|object| Object {
                            kind: kind.to_owned(),
                            ..object
                        })
                        .collect(),
                )
            }
            _ => None,
        }
    };
    match urn.split_once(',') {
        None => object(urn),
        Some(("crs", parts)) => {
            let parts: Vec<Vec<Object>> = parts.split(',').map(object).collect::<Option<_>>()?;
            Some(parts.into_iter().flatten().collect())
        }
        Some(_) => None,
    }
}

/// Splits the part after `http://`.
fn of_url(url: &str) -> Option<Vec<Object>> {
    let path = url
        .strip_prefix("www.")
        .unwrap_or(url)
        .strip_prefix("opengis.net/")?;
    if let Some(code) = path.strip_prefix("gml/srs/epsg.xml#") {
        return of_code("epsg", code);
    }
    if let Some(parameters) = path.strip_prefix("def/crs-compound?") {
        let mut parts: Vec<(&str, String)> = parameters
            .split('&')
            .map(parameter)
            .collect::<Option<_>>()?;
        parts.sort();
        let parts: Vec<Vec<Object>> = parts
            .iter()
            .map(|(_, part)| objects(part))
            .collect::<Option<_>>()?;
        return Some(parts.into_iter().flatten().collect());
    }
    if let Some(parameters) = path.strip_prefix("def/crs?") {
        let parts: Vec<(&str, String)> = parameters
            .split('&')
            .map(parameter)
            .collect::<Option<_>>()?;
        let value = |wanted: &str| {
            parts
                .iter()
                .find(|(name, _)| *name == wanted)
                .map(|(_, value)| value.as_str())
        };
        return of_code(value("authority")?, value("code")?);
    }
    let parts: Vec<&str> = path
        .strip_prefix("def/crs/")?
        .trim_end_matches('/')
        .split('/')
        .collect();
    match parts[..] {
        [authority, code] | [authority, _, code] => of_code(authority, code),
        _ => None,
    }
}

/// Splits a parameter of a URL into its name and its value.
fn parameter(text: &str) -> Option<(&str, String)> {
    let (name, value) = text.split_once('=')?;
    Some((name, value.replace("%3a", ":").replace("%2f", "/")))
}
