//! Coordinate systems, and the operations between them.

use std::fmt::Write;
use std::path::Path;

use serde_json::{Value, json};

use super::product::in_lines;
use crate::cli::Exit;
use crate::cli::input::args::CrsArgs;
use crate::cli::report::console::Console;
use crate::cli::report::escape;
use crate::cli::report::stdout::print;
use crate::cli::report::systems::{crs_json, kind_of};
use crate::crs::{Crs, CrsKind, Heights, Unit};
use crate::error::{Error, Result};
use crate::run::proj::{
    self, GridState, OperationFacts, Operations, TransformOptions, TransformedPoint,
};
use crate::run::units::neat;
use crate::run::{Context, crs_of_file};

/// What is found about one system, or two.
enum Found {
    System(Crs),
    Operations(Box<Operations>),
}

/// Prints what a system is, or the operations from one to another.
pub(crate) fn run(args: &CrsArgs, console: &Console) -> Result<Exit> {
    let options = (&args.transform).into();
    let (to, at) = (args.to.as_deref(), args.at.as_deref());
    let found = find(&args.from, to, at, &options, &console.context())?;
    if let Found::Operations(found) = &found {
        found
            .warnings
            .iter()
            .for_each(|text| console.warning(escape::line(text)));
    }
    match args.json {
        true => print(&in_lines(&found.to_json()))?,
        false => print(&escape::lines(&found.to_text()))?,
    }
    Ok(Exit::Done)
}

/// Returns what is known of one system, or of two, as JSON.
///
/// # Errors
/// If a text is not a coordinate system, or no operation leads from one to the other.
pub(crate) fn as_json(
    from: &str,
    to: Option<&str>,
    at: Option<&[f64]>,
    options: &TransformOptions,
    context: &Context,
) -> Result<Value> {
    Ok(find(from, to, at, options, context)?.to_json())
}

fn find(
    from: &str,
    to: Option<&str>,
    at: Option<&[f64]>,
    options: &TransformOptions,
    context: &Context,
) -> Result<Found> {
    let from = system(from, context)?;
    let Some(to) = to else {
        return Ok(Found::System(from));
    };
    let to = system(to, context)?;
    let found = proj::operations(&from, &to, options, at.and_then(point))?;
    Ok(Found::Operations(Box::new(found)))
}

impl Found {
    fn to_json(&self) -> Value {
        match self {
            Found::System(crs) => system_json(crs),
            Found::Operations(found) => operations_json(found),
        }
    }

    fn to_text(&self) -> String {
        match self {
            Found::System(crs) => system_text(crs),
            Found::Operations(found) => operations_text(found),
        }
    }
}

/// Returns the system that a text or a file states.
///
/// # Errors
/// If it is neither.
fn system(typed: &str, context: &Context) -> Result<Crs> {
    let path = Path::new(typed);
    // A file whose name is that of a system is not meant.
    match Crs::from_user(typed) {
        Ok(crs) => Ok(crs),
        Err(_) if path.is_file() => crs_of_file(path, context),
        Err(error) => {
            let cure = error.cure_text().cloned();
            let named = Error::usage(format!("{error}, and no file has this name"));
            Err(match cure {
                Some(cure) => named.cure(cure),
                None => named,
            })
        }
    }
}

/// Returns the point to transform; without a height, its height is not a number.
fn point(typed: &[f64]) -> Option<[f64; 3]> {
    match *typed {
        [x, y, z] => Some([x, y, z]),
        [x, y] => Some([x, y, f64::NAN]),
        _ => None,
    }
}

/// Returns what a system is, as the object that `crs --json` prints for it.
fn system_json(crs: &Crs) -> Value {
    let mut object = crs_json(crs);
    object["axes"] = json!(axes(crs));
    object["authority_has_northing_first"] = json!(crs.is_northing_first());
    object["heights"] = json!(match crs.heights() {
        Heights::None => "none",
        Heights::Ellipsoid => "ellipsoid",
        Heights::Vertical(_) => "vertical system",
        Heights::Named => "named in the definition",
        Heights::Unknown => "unknown",
    });
    object["epoch"] = json!(crs.epoch());
    object["wkt"] = json!(crs.to_wkt());
    object
}

fn system_text(crs: &Crs) -> String {
    let mut text = format!("{crs}\n");
    let mut row = |name: &str, value: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {name:<10} {value}");
    };
    row("kind", kind_of(crs));
    row(
        "unit",
        &unit_text(&crs.unit, crs.kind == CrsKind::Geographic),
    );
    row("axes", &axes_text(crs));
    row("heights", &heights_text(crs));
    if let Some(epoch) = crs.epoch() {
        row("epoch", &neat(epoch));
    }
    row("wkt", &crs.to_wkt());
    text
}

fn unit_text(unit: &Unit, is_angle: bool) -> String {
    let (name, size) = (&unit.name, unit.factor);
    match (is_angle, size == 1.0) {
        (true, _) => format!("{name}, {} degrees", neat(size.to_degrees())),
        (false, true) => name.clone(),
        (false, false) => format!("{name}, {size} m"),
    }
}

/// Returns what x, y and z are.
fn axes(crs: &Crs) -> Vec<&'static str> {
    let mut axes = match crs.kind {
        CrsKind::Projected => vec!["easting", "northing"],
        CrsKind::Geographic => vec!["longitude", "latitude"],
        CrsKind::Geocentric => return vec!["X", "Y", "Z"],
        CrsKind::Local => vec!["x", "y"],
    };
    if crs.vertical_unit.is_some() {
        axes.push("height");
    }
    axes
}

fn axes_text(crs: &Crs) -> String {
    let mut text = axes(crs).join(", ");
    if crs.kind != CrsKind::Geocentric && crs.is_northing_first() == Some(true) {
        text += match crs.kind {
            CrsKind::Geographic => " (the authority has latitude first)",
            _ => " (the authority has northing first)",
        };
    }
    text
}

fn heights_text(crs: &Crs) -> String {
    let from = match crs.heights() {
        Heights::None => return "none".to_owned(),
        Heights::Ellipsoid => "above the ellipsoid".to_owned(),
        Heights::Vertical(code) => format!("EPSG:{code}"),
        Heights::Named => "above a datum that is named in the definition".to_owned(),
        Heights::Unknown => "above an unknown datum".to_owned(),
    };
    match &crs.vertical_unit {
        Some(unit) => format!("{from}, {}", unit_text(unit, false)),
        None => from,
    }
}

/// Returns operations, as the object that `crs --json` prints for them.
fn operations_json(found: &Operations) -> Value {
    json!({
        "from": system_json(&found.from),
        "to": system_json(&found.to),
        "heights_are_transformed": found.heights_are_transformed,
        "operations": found.operations.iter().map(operation_json).collect::<Vec<_>>(),
        "point": found.point.as_ref().map(point_json),
        "warnings": found.warnings,
        "proj": found.version,
    })
}

fn operation_json(one: &OperationFacts) -> Value {
    let grids = one.grids.iter().map(|grid| {
        json!({
            "name": grid.name,
            "url": grid.url,
            "file": grid.file,
            "state": state_of(grid.state),
        })
    });
    let area = one.area.as_ref().map(|area| {
        json!({
            "name": area.name,
            "west": area.west,
            "south": area.south,
            "east": area.east,
            "north": area.north,
        })
    });
    json!({
        "name": one.name,
        "code": one.code,
        "accuracy": one.accuracy,
        "area": area,
        "grids": grids.collect::<Vec<_>>(),
        "ballpark": one.is_ballpark,
        "heights": one.has_heights,
        "needs_epoch": one.needs_epoch,
        "used": one.is_used,
        "steps": one.steps,
    })
}

fn point_json(point: &TransformedPoint) -> Value {
    let finite = |point: [f64; 3]| point.map(|value| Some(value).filter(|value| value.is_finite()));
    json!({
        "from": finite(point.from),
        "to": finite(point.to),
        "operation": point.operation,
        "steps": point.steps,
    })
}

fn operations_text(found: &Operations) -> String {
    let mut text = String::new();
    let heights = match (found.heights_are_transformed, &found.to.vertical_unit) {
        (true, _) => "transformed",
        (false, Some(_)) => "keep their datum",
        (false, None) => "left as they are",
    };
    // Writing to a string cannot fail.
    let _ = writeln!(text, "from        {}", found.from.describe());
    let _ = writeln!(text, "to          {}", found.to.describe());
    let _ = writeln!(text, "heights     {heights}");
    for (i, one) in found.operations.iter().enumerate() {
        write_operation(&mut text, i + 1, one);
    }
    if let Some(point) = &found.point {
        let _ = writeln!(text, "point       {}", point_text(point.from));
        let _ = writeln!(text, "becomes     {}", point_text(point.to));
        for step in &point.steps {
            let _ = writeln!(text, "            {step}");
        }
    }
    text
}

fn write_operation(text: &mut String, number: usize, one: &OperationFacts) {
    let used = if one.is_used { ", used" } else { "" };
    let _ = writeln!(text, "\n{:<11} {}", format!("{number}{used}"), one.name);
    let mut facts = vec![match one.accuracy {
        Some(accuracy) => format!("accurate to {accuracy} m"),
        None => "of unknown accuracy".to_owned(),
    }];
    facts.extend(one.code.clone());
    if one.is_ballpark {
        facts.push("ignores a difference of datums".to_owned());
    }
    if one.has_heights {
        facts.push("with heights".to_owned());
    }
    if one.needs_epoch {
        facts.push("depends on the epoch".to_owned());
    }
    let _ = writeln!(text, "            {}", facts.join(", "));
    if let Some(area) = &one.area {
        let _ = writeln!(
            text,
            "            longitude {} .. {}, latitude {} .. {}: {}",
            area.west, area.east, area.south, area.north, area.name
        );
    }
    for grid in &one.grids {
        let url = match (&grid.url, grid.state) {
            (Some(url), GridState::Missing) => format!(" ({url})"),
            _ => String::new(),
        };
        let _ = writeln!(
            text,
            "            grid {}: {}{url}",
            grid.name,
            state_of(grid.state)
        );
    }
}

fn state_of(state: GridState) -> &'static str {
    match state {
        GridState::Installed => "installed",
        GridState::Missing => "missing",
        GridState::Unreadable => "not readable by this build",
    }
}

fn point_text(point: [f64; 3]) -> String {
    let numbers: Vec<String> = point
        .iter()
        .filter(|value| !value.is_nan())
        .map(|value| neat(*value))
        .collect();
    numbers.join(" ")
}
