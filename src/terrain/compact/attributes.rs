//! What the file of a TIN says about the whole of it: coordinate system, counts, extent.

use serde_json::{Map, Value, json};

use crate::crs::{Crs, CrsKind, Unit};
use crate::data::{Bounds, EdgeKind, LineEdges, SurfaceFacts};
use crate::error::{Error, Result};

/// The names of the kinds of coordinates.
const KINDS: [(CrsKind, &str); 4] = [
    (CrsKind::Projected, "projected"),
    (CrsKind::Geographic, "geographic"),
    (CrsKind::Geocentric, "geocentric"),
    (CrsKind::Local, "local"),
];

/// What the file says about the whole TIN.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Attributes {
    pub(super) crs: Option<Crs>,
    pub(super) facts: SurfaceFacts,
}

impl Attributes {
    /// Returns the attributes as JSON, which reads back as the same values, bit for bit.
    pub(super) fn to_json(&self) -> String {
        self.to_value().to_string()
    }

    /// Returns the attributes as a value of JSON.
    pub(super) fn to_value(&self) -> Value {
        let SurfaceFacts {
            vertices,
            triangles,
            edges,
            extent,
        } = &self.facts;
        let lines: Map<String, Value> = edges
            .kinds()
            .map(|(kind, count)| (kind.noun().to_owned(), count.into()))
            .collect();
        json!({
            "vertices": vertices,
            "triangles": triangles,
            "lines": lines,
            "extent": box_to_json(extent),
            "crs": self.crs.as_ref().map(crs_to_json),
        })
    }

    /// Reads the attributes.
    ///
    /// # Errors
    /// If the text is not JSON; the error names a value that is missing or wrong.
    pub(super) fn from_json(text: &[u8]) -> Result<Self> {
        Self::from_value(&parse(text)?)
    }

    /// Reads the attributes from a value of JSON.
    ///
    /// # Errors
    /// If a value is missing or wrong, which the error names.
    pub(super) fn from_value(value: &Value) -> Result<Self> {
        let object = value.as_object().ok_or_else(|| wrong("the text"))?;
        let count = |name| {
            object
                .get(name)
                .and_then(Value::as_u64)
                .and_then(|n| usize::try_from(n).ok())
        };
        let count = |name| count(name).ok_or_else(|| wrong(name));
        let crs = match object.get("crs") {
            Some(Value::Null) => None,
            Some(Value::Object(crs)) => Some(crs_from_json(crs)?),
            _ => return Err(wrong("crs")),
        };
        let facts = SurfaceFacts {
            vertices: count("vertices")?,
            triangles: count("triangles")?,
            edges: edges(object.get("lines")).ok_or_else(|| wrong("lines"))?,
            extent: object
                .get("extent")
                .and_then(box_from_json)
                .ok_or_else(|| wrong("extent"))?,
        };
        Ok(Attributes { crs, facts })
    }
}

/// Returns a text as JSON.
///
/// # Errors
/// If it is not.
pub(super) fn parse(text: &[u8]) -> Result<Value> {
    serde_json::from_slice(text).map_err(|e| Error::format(format!("not JSON: {e}")))
}

/// Returns a box as JSON, which has no infinity: null if it is empty.
pub(super) fn box_to_json(bounds: &Bounds) -> Value {
    if bounds.is_empty() {
        Value::Null
    } else {
        json!([bounds.min, bounds.max])
    }
}

/// Reads a box; `None` if it is none.
pub(super) fn box_from_json(value: &Value) -> Option<Bounds> {
    if value.is_null() {
        return Some(Bounds::default());
    }
    let corner = |i: usize| {
        let axis = |axis: usize| value.get(i)?.get(axis)?.as_f64();
        Some([axis(0)?, axis(1)?, axis(2)?])
    };
    Some(Bounds {
        min: corner(0)?,
        max: corner(1)?,
    })
}

/// Reads the numbers of edges on lines.
fn edges(value: Option<&Value>) -> Option<LineEdges> {
    let mut edges = LineEdges::default();
    for (name, count) in value?.as_object()? {
        let kind = EdgeKind::ALL
            .into_iter()
            .find(|kind| kind.is_constrained() && kind.noun() == name)?;
        edges.add_edges(kind, usize::try_from(count.as_u64()?).ok()?);
    }
    Some(edges)
}

fn crs_to_json(crs: &Crs) -> Value {
    let Crs {
        name,
        epsg,
        vertical_epsg,
        kind,
        unit,
        vertical_unit,
        wkt,
    } = crs;
    let unit_to_json = |unit: &Unit| json!({ "name": unit.name, "factor": unit.factor });
    json!({
        "name": name,
        "epsg": epsg,
        "vertical_epsg": vertical_epsg,
        "kind": KINDS.iter().find(|(known, _)| known == kind).map(|(_, name)| name),
        "unit": unit_to_json(unit),
        "vertical_unit": vertical_unit.as_ref().map(unit_to_json),
        "wkt": wkt,
    })
}

fn crs_from_json(object: &Map<String, Value>) -> Result<Crs> {
    let text = |object: &Map<String, Value>, name| {
        object.get(name).and_then(Value::as_str).map(str::to_owned)
    };
    let code = |name| match object.get(name) {
        Some(Value::Null) => Ok(None),
        code => code
            .and_then(Value::as_u64)
            .and_then(|n| u32::try_from(n).ok())
            .map(Some)
            .ok_or_else(|| wrong(name)),
    };
    let unit = |name| {
        let unit = object.get(name)?.as_object()?;
        let factor = unit
            .get("factor")?
            .as_f64()
            .filter(|factor| factor.is_finite() && *factor > 0.0)?;
        Some(Unit {
            name: text(unit, "name")?,
            factor,
        })
    };
    let is_null = |name| object.get(name).is_some_and(Value::is_null);
    let kind = text(object, "kind").and_then(|kind| KINDS.iter().find(|(_, name)| *name == kind));
    Ok(Crs {
        name: text(object, "name").ok_or_else(|| wrong("the name of the coordinate system"))?,
        epsg: code("epsg")?,
        vertical_epsg: code("vertical_epsg")?,
        kind: kind
            .map(|(kind, _)| *kind)
            .ok_or_else(|| wrong("the kind of the coordinate system"))?,
        unit: unit("unit").ok_or_else(|| wrong("unit"))?,
        vertical_unit: match is_null("vertical_unit") {
            true => None,
            false => Some(unit("vertical_unit").ok_or_else(|| wrong("vertical_unit"))?),
        },
        wkt: match is_null("wkt") {
            true => None,
            false => Some(text(object, "wkt").ok_or_else(|| wrong("wkt"))?),
        },
    })
}

#[cold]
pub(super) fn wrong(name: &str) -> Error {
    Error::format(format!("{name} is missing or wrong"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts(extent: Bounds) -> SurfaceFacts {
        let mut edges = LineEdges::default();
        edges.add_edges(EdgeKind::Breakline, 2);
        edges.add_edges(EdgeKind::Clip, 1);
        SurfaceFacts {
            vertices: 5,
            triangles: 3,
            edges,
            extent,
        }
    }

    #[test]
    fn attributes_read_back_as_the_same_bits() {
        let mut systems = vec![None];
        for text in [
            "EPSG:25832",
            "EPSG:25832+7837",
            "EPSG:4326",
            "EPSG:2994",
            "EPSG:4978",
        ] {
            systems.push(Some(Crs::from_user(text).unwrap()));
        }
        let unit = Unit {
            name: "a \"foot\"\n".into(),
            factor: 0.1 + 0.2,
        };
        systems.push(Some(Crs {
            name: "é".into(),
            epsg: None,
            vertical_epsg: Some(5),
            kind: CrsKind::Local,
            unit: unit.clone(),
            vertical_unit: Some(unit),
            wkt: Some("LOCAL_CS[\"x\",\r\n UNIT[\"metre\",1]]".into()),
        }));
        let odd = Bounds {
            min: [0.1 + 0.2, -1e300, 5e-324],
            max: [1e9 / 3.0, -0.0, 1.0],
        };
        for crs in systems {
            for extent in [odd, Bounds::default()] {
                let attributes = Attributes {
                    crs: crs.clone(),
                    facts: facts(extent),
                };
                assert_eq!(
                    Attributes::from_json(attributes.to_json().as_bytes()).unwrap(),
                    attributes
                );
            }
        }
    }

    #[test]
    fn every_value_is_needed() {
        let crs = Crs::from_user("EPSG:25832+7837").ok();
        let whole = Attributes {
            crs,
            facts: facts(Bounds {
                min: [0.0; 3],
                max: [1.0; 3],
            }),
        }
        .to_json();
        let value: Value = serde_json::from_str(&whole).unwrap();
        for name in ["vertices", "triangles", "lines", "extent", "crs"] {
            let mut less = value.clone();
            less.as_object_mut().unwrap().remove(name);
            let error = Attributes::from_json(less.to_string().as_bytes()).unwrap_err();
            assert_eq!(error.to_string(), format!("{name} is missing or wrong"));
        }
        for name in [
            "name",
            "epsg",
            "vertical_epsg",
            "kind",
            "unit",
            "vertical_unit",
            "wkt",
        ] {
            let mut less = value.clone();
            less["crs"].as_object_mut().unwrap().remove(name);
            assert!(
                Attributes::from_json(less.to_string().as_bytes()).is_err(),
                "{name}"
            );
        }
        for cut in 0..whole.len() {
            assert!(Attributes::from_json(&whole.as_bytes()[..cut]).is_err());
        }
        assert!(
            Attributes::from_json(&[b'['; 100_000]).is_err(),
            "nested deeper than the stack"
        );
    }
}
