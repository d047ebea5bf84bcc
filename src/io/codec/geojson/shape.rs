//! Geometries: from the values of JSON to shapes.

use serde_json::{Map, Value};

use crate::data::{Shape, oriented};
use crate::error::{Error, Result};

/// The members of an object of JSON.
pub(super) type Object = Map<String, Value>;

/// Returns the type that an object states.
pub(super) fn kind(object: &Object) -> Result<&str> {
    object
        .get("type")
        .and_then(Value::as_str)
        .ok_or_else(|| Error::format("not GeoJSON: an object without a type"))
}

/// Returns the array in a member of an object.
pub(super) fn array<'a>(object: &'a Object, name: &str) -> Result<&'a [Value]> {
    object
        .get(name)
        .and_then(Value::as_array)
        .map(Vec::as_slice)
        .ok_or_else(|| Error::format(format!("no array {name}")))
}

/// Returns the shape of a geometry of a type other than GeometryCollection.
pub(super) fn shape_of(geometry: &Object, kind: &str) -> Result<Shape> {
    let coordinates = || array(geometry, "coordinates");
    Ok(match kind {
        "Point" => match coordinates()? {
            [] => Shape::Null,
            position => Shape::Points(vec![vertex(position)?]),
        },
        "MultiPoint" => Shape::Points(line(coordinates()?)?),
        "LineString" => Shape::Lines(vec![line(coordinates()?)?]),
        "MultiLineString" => Shape::Lines(lines(coordinates()?)?),
        "Polygon" => Shape::Polygon(rings(coordinates()?)?),
        "MultiPolygon" => {
            let polygons = coordinates()?.iter().map(|polygon| rings(list(polygon)?));
            Shape::Polygon(polygons.collect::<Result<Vec<_>>>()?.concat())
        }
        other => return Err(Error::format(format!("type {other} is not a GeoJSON type"))),
    })
}

fn list(value: &Value) -> Result<&[Value]> {
    value
        .as_array()
        .map(Vec::as_slice)
        .ok_or_else(|| Error::format(format!("{value} instead of an array")))
}

fn vertex(position: &[Value]) -> Result<[f64; 3]> {
    let number = |value: &Value| {
        value
            .as_f64()
            .ok_or_else(|| Error::format(format!("coordinate {value}")))
    };
    match position {
        [x, y] => Ok([number(x)?, number(y)?, f64::NAN]),
        // A null height is not allowed, but occurs in files.
        [x, y, Value::Null, ..] => Ok([number(x)?, number(y)?, f64::NAN]),
        [x, y, z, ..] => Ok([number(x)?, number(y)?, number(z)?]),
        _ => Err(Error::format(format!(
            "a position of {} numbers",
            position.len()
        ))),
    }
}

fn line(positions: &[Value]) -> Result<Vec<[f64; 3]>> {
    positions
        .iter()
        .map(|position| vertex(list(position)?))
        .collect()
}

fn lines(parts: &[Value]) -> Result<Vec<Vec<[f64; 3]>>> {
    parts.iter().map(|part| line(list(part)?)).collect()
}

/// Returns the rings of one polygon, the outer one first.
fn rings(parts: &[Value]) -> Result<Vec<Vec<[f64; 3]>>> {
    let mut rings = lines(parts)?;
    for ring in &mut rings {
        if let (Some(&first), Some(&last)) = (ring.first(), ring.last())
            && first[..2] != last[..2]
        {
            ring.push(first);
        }
    }
    Ok(oriented(rings))
}
