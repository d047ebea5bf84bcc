//! Contours as drawings: polylines in the plane with an elevation, and labels as texts.

use std::collections::BTreeSet;

use super::{Align, Dxf, DxfLayer};
use crate::crs::Crs;
use crate::data::{Bounds, ContourLine, Layer, Shape, Value};
use crate::error;
use crate::io::bytes::output::Destination;
use crate::io::codec::contour_summary::ContourSummary;
use crate::io::options::map_sheet::MapSheet;

/// The positions of the layers: those of lines, of index contours and of labels.
const LINES: usize = 0;
const INDEX: usize = 1;
const LABELS: usize = 2;

/// Writes contours as polylines with an elevation on the layer `CONTOURS`, one after another. The
/// drawing does not state their extent, which is not known before.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write_contours(
    target: Destination,
    lines: &mut dyn Iterator<Item = ContourLine>,
    crs: Option<&Crs>,
) -> error::Result<ContourSummary> {
    let mut summary = target.write_with(|out| {
        let mut drawing = Dxf::begin(out, layers()[..1].to_vec(), &Bounds::default())?;
        let mut summary = ContourSummary::default();
        for line in lines.filter(|line| line.points.len() > 1) {
            summary.add(&line);
            drawing.contour(LINES, line.level, &line.points)?;
        }
        drawing.end()?;
        Ok(summary)
    })?;
    summary.warnings.extend(without_system(crs));
    Ok(summary)
}

/// Writes contours of a map: index contours on the layer `CONTOURS_INDEX`, the others on
/// `CONTOURS`, and labels as texts around their positions on `CONTOUR_LABELS`. All are at their
/// heights, also if their vertices have none. Returns warnings.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write_map(target: Destination, sheet: &MapSheet) -> error::Result<Vec<String>> {
    let (lines, labels) = (at_heights(sheet.shapes), at_heights(sheet.labels));
    let mut bounds = Bounds::default();
    let all = lines.iter().chain(&labels);
    all.flat_map(vertices).for_each(|at| bounds.add(at));
    let is_marked =
        |values: &[&Value], shape: usize| matches!(values.get(shape), Some(Value::Whole(1)));
    let index = values(sheet.shapes, "INDEX");
    let depressions = values(sheet.shapes, "DEPRESSION");
    target.write_with(|out| {
        let mut drawing = Dxf::begin(out, layers(), &bounds)?;
        for (number, (shape, height)) in lines.iter().enumerate() {
            let layer = if is_marked(&index, number) {
                INDEX
            } else {
                LINES
            };
            if let Shape::Lines(parts) = shape {
                for part in parts {
                    let points: Vec<[f64; 2]> = part.iter().map(|&[x, y, _]| [x, y]).collect();
                    drawing.contour(layer, *height, &points)?;
                }
            }
        }
        let rotations = values(sheet.labels, "ROTATION");
        for (number, label) in labels.iter().enumerate() {
            let direction = number_or_zero(&rotations, number);
            let text = Value::Number(label.1).text();
            for at in vertices(label) {
                let align = Align::Middle { direction };
                drawing.text(LABELS, at, sheet.text_height, align, &text)?;
            }
        }
        drawing.end()
    })?;
    let crs = sheet.shapes.or(sheet.labels).and_then(|of| of.crs.as_ref());
    let mut warnings: Vec<String> = without_system(crs).into_iter().collect();
    if (0..lines.len()).any(|number| is_marked(&depressions, number)) {
        let left_out = "a drawing has no attributes: DEPRESSION is left out";
        warnings.push(left_out.to_owned());
    }
    Ok(warnings)
}

/// Returns the shapes of a layer with their heights, which their vertices need not have.
fn at_heights(layer: Option<&Layer>) -> Vec<(&Shape, f64)> {
    let heights = values(layer, "ELEV");
    let shapes = layer.map_or(&[][..], |layer| &layer.shapes);
    let numbered = shapes.iter().enumerate();
    numbered
        .map(|(i, shape)| (shape, number_or_zero(&heights, i)))
        .collect()
}

/// Returns the values of an attribute of a layer, one for each shape; none if it has no such
/// attribute.
fn values<'a>(layer: Option<&'a Layer>, name: &str) -> Vec<&'a Value> {
    let attributes = layer.and_then(|layer| layer.attributes.as_ref());
    let values = attributes.and_then(|attributes| {
        let number = attributes.names.iter().position(|own| own == name)?;
        Some(attributes.column(number).collect())
    });
    values.unwrap_or_default()
}

fn number_or_zero(values: &[&Value], shape: usize) -> f64 {
    match values.get(shape) {
        Some(Value::Number(number)) => *number,
        _ => 0.0,
    }
}

fn vertices<'a>(&(shape, height): &(&'a Shape, f64)) -> impl Iterator<Item = [f64; 3]> + use<'a> {
    shape.vertices().map(move |&[x, y, _]| [x, y, height])
}

fn layers() -> Vec<DxfLayer> {
    let mut taken = BTreeSet::new();
    [
        ("CONTOURS", 8),
        ("CONTOURS_INDEX", 7),
        ("CONTOUR_LABELS", 7),
    ]
    .map(|(name, color)| DxfLayer::new(name, color, &mut taken))
    .to_vec()
}

/// Returns a warning that the coordinate system is not written.
fn without_system(crs: Option<&Crs>) -> Option<String> {
    crs.map(|crs| format!("a drawing has no coordinate system: {crs} is not written"))
}
