//! Conversion of WKT, version 1 (OGC, Esri) or 2, to a [`Crs`] and its [`Definition`].

use super::definition::{Datum, Definition, Ellipsoid};
use super::projection::{Measure, Param, Projection, normalized};
use super::registry;
use super::wkt_tree::{Node, Value};
use super::{Crs, CrsKind, Unit};
use crate::error::{Error, Result};

const PROJECTED: &[&str] = &["PROJCS", "PROJCRS", "PROJECTEDCRS"];
const GEOGRAPHIC: &[&str] = &["GEOGCS", "GEOGCRS", "GEOGRAPHICCRS"];
const GEODETIC: &[&str] = &["GEODCRS", "GEODETICCRS"];
const GEOCENTRIC: &[&str] = &["GEOCCS"];
const LOCAL: &[&str] = &["LOCAL_CS", "ENGCRS", "ENGINEERINGCRS", "FITTED_CS"];
const COMPOUND: &[&str] = &["COMPD_CS", "COMPOUNDCRS"];
const BOUND: &[&str] = &["BOUNDCRS"];
pub(super) const METADATA: &str = "COORDINATEMETADATA";
pub(super) const VERTICAL: &[&str] = &["VERT_CS", "VERTCS", "VERTCRS", "VERTICALCRS"];
const BASE: &[&str] = &[
    "GEOGCS",
    "BASEGEOGCRS",
    "BASEGEODCRS",
    "GEOGCRS",
    "GEODCRS",
    "GEOGRAPHICCRS",
    "GEODETICCRS",
];

/// Reads a system and its definition, which is `None` for a local system.
pub(super) fn read(text: &str) -> Result<(Crs, Option<Definition>)> {
    let nodes = Node::parse_all(text)?;
    let (root, beside) = nodes
        .split_first()
        .ok_or_else(|| Error::format("WKT without content"))?;
    let (mut crs, definition) = system(root)?;
    if crs.vertical_epsg.is_none() && crs.vertical_unit.is_none() {
        // Esri writes the vertical system after the horizontal one, others inside of it.
        let vertical = beside
            .iter()
            .find(|node| is(node, VERTICAL))
            .or_else(|| root.find(VERTICAL));
        if let Some(vertical) = vertical {
            add_vertical(&mut crs, vertical);
        }
    }
    crs.wkt = Some(
        text.trim_matches(|c: char| c.is_whitespace() || c == '\0' || c == '\u{feff}')
            .to_owned(),
    );
    Ok((crs, definition))
}

fn is(node: &Node, keywords: &[&str]) -> bool {
    keywords.contains(&node.keyword.as_str())
}

fn system(node: &Node) -> Result<(Crs, Option<Definition>)> {
    if node.keyword == METADATA {
        let stated = node.nodes().find(|child| child.keyword != "EPOCH");
        return system(
            stated.ok_or_else(|| Error::format(format!("{METADATA} without a system")))?,
        );
    }
    if is(node, BOUND) {
        let source = node
            .find(&["SOURCECRS"])
            .and_then(|source| source.nodes().next());
        return system(source.ok_or_else(|| Error::format("BOUNDCRS without SOURCECRS"))?);
    }
    if is(node, COMPOUND) {
        return compound(node);
    }
    let kind = if is(node, PROJECTED) {
        CrsKind::Projected
    } else if is(node, GEOCENTRIC) || (is(node, GEODETIC) && is_cartesian(node)) {
        CrsKind::Geocentric
    } else if is(node, GEOGRAPHIC) || is(node, GEODETIC) {
        CrsKind::Geographic
    } else if is(node, LOCAL) {
        CrsKind::Local
    } else if is(node, VERTICAL) {
        return Err(Error::unsupported(format!(
            "\"{}\" is only a vertical coordinate system",
            node.name()
        ))
        .cure("state the horizontal system with it, as EPSG:HORIZONTAL+VERTICAL"));
    } else {
        return Err(Error::format(format!(
            "{} is not a keyword of a coordinate system, expected PROJCS, GEOGCS, PROJCRS, COMPD_CS or the like",
            node.keyword
        )));
    };
    let definition = match kind {
        CrsKind::Local => None,
        _ => Some(definition(node, kind)?),
    };
    let length = match &definition {
        Some(definition) => definition.unit.clone(),
        None => unit(node, Measure::Length).unwrap_or(Unit::new("unknown", 1.0)),
    };
    let epsg = match node.epsg().map(|code| (code, registry::find(code))) {
        // A code whose system differs in kind or unit from the definition is an error in the file.
        Some((_, Some(found))) if found.kind != kind || !found.unit.is_same(&length) => None,
        Some((code, _)) => Some(code),
        None => None,
    };
    let epsg = epsg.or_else(|| registry::identify(definition.as_ref()?, node.name()));
    let mut crs = Crs {
        name: node.name().to_owned(),
        epsg,
        vertical_epsg: None,
        kind,
        unit: length,
        vertical_unit: None,
        wkt: None,
    };
    if kind == CrsKind::Geocentric {
        crs.vertical_unit = Some(crs.unit.clone());
    } else if node.nodes().filter(|child| child.keyword == "AXIS").count() == 3 {
        let up = node.nodes().filter(|child| child.keyword == "AXIS").nth(2);
        crs.vertical_unit = up
            .and_then(|axis| unit(axis, Measure::Length))
            .or(Some(Unit::metre()));
    }
    Ok((crs, definition))
}

fn compound(node: &Node) -> Result<(Crs, Option<Definition>)> {
    let parts = || {
        node.nodes()
            .filter(|part| !matches!(part.keyword.as_str(), "AUTHORITY" | "ID"))
    };
    let is_vertical = |part: &&Node| {
        is(part, VERTICAL)
            || is(part, BOUND)
                && part
                    .find(&["SOURCECRS"])
                    .and_then(|s| s.nodes().next())
                    .is_some_and(|s| is(s, VERTICAL))
    };
    let horizontal = parts().find(|part| !is_vertical(part));
    let (mut crs, definition) = system(horizontal.ok_or_else(|| {
        Error::format(format!(
            "compound coordinate system \"{}\" without a horizontal part",
            node.name()
        ))
    })?)?;
    if let Some(vertical) = parts().find(is_vertical) {
        let vertical = vertical
            .find(&["SOURCECRS"])
            .and_then(|s| s.nodes().next())
            .unwrap_or(vertical);
        add_vertical(&mut crs, vertical);
    }
    if let Some(whole) = node.epsg().and_then(registry::find) {
        crs.epsg = crs
            .epsg
            .or(Some(whole.code).filter(|_| whole.unit.is_same(&crs.unit)));
        crs.vertical_epsg = crs
            .vertical_epsg
            .or(whole.vertical.and_then(|part| part.code));
    }
    if !node.name().is_empty() {
        crs.name = node.name().to_owned();
    }
    Ok((crs, definition))
}

fn add_vertical(crs: &mut Crs, node: &Node) {
    let stated = unit(node, Measure::Length);
    let code = node
        .epsg()
        .map(|code| (code, registry::find_vertical(code)));
    let code = match (&stated, code) {
        (Some(unit), Some((_, Some(found)))) if !found.unit.is_same(unit) => None,
        (None, Some((code, Some(found)))) => {
            crs.vertical_unit = Some(found.unit);
            Some(code)
        }
        (_, code) => code.map(|(code, _)| code),
    };
    if let Some(unit) = stated {
        let datum = node
            .find(&["VERT_DATUM", "VDATUM", "VERTICALDATUM", "VRF"])
            .map_or("", Node::name);
        crs.vertical_epsg = code.or_else(|| registry::identify_vertical(datum, node.name(), &unit));
        crs.vertical_unit = Some(unit);
    } else {
        crs.vertical_epsg = code;
    }
}

fn is_cartesian(node: &Node) -> bool {
    node.find(&["CS"])
        .is_some_and(|cs| cs.name().eq_ignore_ascii_case("Cartesian"))
}

/// The unit of a node, stated in it (WKT 1) or in its axes (WKT 2).
fn unit(node: &Node, measure: Measure) -> Option<Unit> {
    let keywords: &[&str] = if measure == Measure::Angle {
        &["UNIT", "ANGLEUNIT"]
    } else {
        &["UNIT", "LENGTHUNIT"]
    };
    let stated = node.find(keywords).or_else(|| {
        let axes = node.nodes().filter(|child| child.keyword == "AXIS");
        axes.filter_map(|axis| axis.find(keywords)).next()
    })?;
    let (named, from_factor) = match measure {
        Measure::Angle => (
            Unit::angle_from_name(stated.name()),
            Unit::angle as fn(f64) -> Unit,
        ),
        _ => (
            Unit::length_from_name(stated.name()),
            Unit::length as fn(f64) -> Unit,
        ),
    };
    match (stated.number(0).filter(|&factor| factor > 0.0), named) {
        // Some writers give every unit the factor 1; then the name is right.
        (Some(1.0), Some(named)) => Some(named),
        (Some(factor), _) => {
            let mut unit = from_factor(factor);
            if unit.code().is_none() && !stated.name().is_empty() {
                unit.name = stated.name().to_owned();
            }
            Some(unit)
        }
        (None, named) => named,
    }
}

fn definition(node: &Node, kind: CrsKind) -> Result<Definition> {
    let missing = |what: &str| {
        Error::format(format!(
            "coordinate system \"{}\" without {what}",
            node.name()
        ))
    };
    let base = match kind {
        CrsKind::Projected => node
            .find(BASE)
            .ok_or_else(|| missing("a geographic one below it (GEOGCS)"))?,
        _ => node,
    };
    // A length there ("metres", seen in lidar files) is a mistake for degrees.
    let is_length = |node: &Node| {
        node.find(&["UNIT"])
            .is_some_and(|u| Unit::length_from_name(u.name()).is_some())
    };
    let angle = unit(base, Measure::Angle)
        .filter(|_| kind != CrsKind::Geocentric && !is_length(base))
        .unwrap_or_else(Unit::degree);
    let degrees = angle.factor.to_degrees();
    let length = match kind {
        CrsKind::Geographic => angle.clone(),
        _ => unit(node, Measure::Length).unwrap_or_else(Unit::metre),
    };
    let projection = match kind {
        CrsKind::Projected => {
            let parent = node.find(&["CONVERSION"]).unwrap_or(node);
            let method = parent
                .find(&["PROJECTION", "METHOD"])
                .ok_or_else(|| missing("a projection"))?;
            Some(projection(
                node,
                method.name(),
                parent,
                degrees,
                length.factor,
            )?)
        }
        _ => None,
    };
    Ok(Definition {
        kind,
        datum: datum(base, &missing)?,
        geographic: (base.name().to_owned(), base.epsg()),
        angle,
        projection,
        unit: length,
    })
}

fn projection(
    node: &Node,
    method: &str,
    parent: &Node,
    degrees: f64,
    metres: f64,
) -> Result<Projection> {
    let mut stated = Vec::new();
    for parameter in parent.nodes().filter(|child| child.keyword == "PARAMETER") {
        let value = parameter.number(0).ok_or_else(|| {
            Error::format(format!(
                "projection parameter \"{}\" without a number",
                parameter.name()
            ))
        })?;
        let param = Param::from_name(parameter.name());
        let own = |keyword: &str| {
            parameter
                .find(&[keyword, "UNIT"])
                .and_then(|unit| unit.number(0))
        };
        let value = match param.measure() {
            Measure::Angle => value * own("ANGLEUNIT").map_or(degrees, f64::to_degrees),
            Measure::Length => value * own("LENGTHUNIT").unwrap_or(metres),
            Measure::Ratio => value * own("SCALEUNIT").unwrap_or(1.0),
        };
        stated.push((param, value));
    }
    let get = |name: &str| {
        stated
            .iter()
            .find(|(param, _)| *param == Param::Other(name.into()))
            .map(|entry| entry.1)
    };
    let points = |direction: &str| {
        node.nodes().filter(|child| child.keyword == "AXIS").any(|axis| {
            axis.values.iter().any(|value| matches!(value, Value::Word(word) if word.eq_ignore_ascii_case(direction)))
        })
    };
    let is_sphere = |text: &str| text.contains("+nadgrids=@null") || text.contains("+b=6378137");
    let name = match normalized(method).as_str() {
        "mercator1sp"
            if node.find(&["EXTENSION"]).is_some_and(|e| {
                e.values
                    .iter()
                    .any(|v| matches!(v, Value::Text(t) if is_sphere(t)))
            }) =>
        {
            "Mercator_Auxiliary_Sphere"
        }
        // The same name, with axes to the south and west.
        "krovak" if points("SOUTH") || get("xscale") == Some(1.0) => "Krovak_South_West",
        _ => method,
    };
    Ok(Projection::new(name, &stated))
}

fn datum(base: &Node, missing: &dyn Fn(&str) -> Error) -> Result<Datum> {
    let node = base
        .find(&["DATUM", "ENSEMBLE", "TRF", "GEODETICDATUM"])
        .ok_or_else(|| missing("a datum"))?;
    let spheroid = node
        .find(&["SPHEROID", "ELLIPSOID"])
        .ok_or_else(|| missing("an ellipsoid"))?;
    let (a, rf) = (spheroid.number(0), spheroid.number(1));
    let (Some(a), Some(rf)) = (a.filter(|&a| a > 0.0), rf.filter(|&rf| rf >= 0.0)) else {
        return Err(missing("the axes of its ellipsoid"));
    };
    let metres = spheroid
        .find(&["LENGTHUNIT", "UNIT"])
        .and_then(|unit| unit.number(0))
        .unwrap_or(1.0);
    let ellipsoid = Ellipsoid {
        name: spheroid.name().to_owned(),
        code: spheroid.epsg(),
        a: a * metres,
        rf,
    };
    let meridian = base
        .find(&["PRIMEM", "PRIMEMERIDIAN"])
        .map_or(0.0, |meridian| {
            let degrees = meridian
                .find(&["ANGLEUNIT", "UNIT"])
                .and_then(|unit| unit.number(0))
                .map_or(1.0, f64::to_degrees);
            meridian.number(0).unwrap_or(0.0) * degrees
        });
    let by_base = || registry::find(base.epsg()?)?.definition?.datum.code;
    // A datum with a known name but a different ellipsoid or meridian is not that datum; Esri's
    // names of datums do not depend on the prime meridian.
    let fits = |known: &Datum| {
        known.ellipsoid.is_same(&ellipsoid) && (known.meridian - meridian).abs() < 1e-6
    };
    // PERF: each is looked up only if those before do not fit. The last one needs the names of all
    // systems.
    let codes: [&dyn Fn() -> Option<u32>; 4] = [
        &|| node.epsg(),
        &by_base,
        &|| registry::datum_code(node.name(), ""),
        &|| registry::datum_code("", base.name()),
    ];
    if let Some(known) = codes
        .into_iter()
        .filter_map(|code| registry::datum(code()?))
        .find(fits)
    {
        return Ok(known);
    }
    Ok(Datum {
        name: node.name().to_owned(),
        code: None,
        ellipsoid,
        meridian,
    })
}
