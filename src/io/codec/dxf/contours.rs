//! Contours as drawings: polylines in the plane with an elevation, and labels as texts.

use std::collections::BTreeSet;
use std::io::Result;

use super::{Dxf, DxfLayer};
use crate::crs::Crs;
use crate::data::{Bounds, ContourLine, Layer, Shape, Value};
use crate::error;
use crate::io::bytes::output::Destination;
use crate::io::codec::contour_summary::ContourSummary;
use crate::io::options::map_sheet::{MapSheet, values};

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
/// `CONTOURS`, and labels as texts around their positions on `CONTOUR_LABELS`. Returns warnings.
///
/// # Errors
/// If the file cannot be written.
pub(crate) fn write_map(target: Destination, sheet: &MapSheet) -> error::Result<Vec<String>> {
    let mut bounds = Bounds::default();
    let shapes = &sheet.shapes.shapes;
    let vertices = shapes.iter().flat_map(Shape::vertices);
    vertices.for_each(|p| bounds.add(*p));
    let index = values(sheet.shapes, "INDEX");
    let is_index = |shape: usize| {
        let value = index.as_ref().and_then(|values| values.get(shape));
        matches!(value, Some(Value::Whole(1)))
    };
    // Lines without heights, and areas, have theirs as an attribute.
    let heights = values(sheet.shapes, "ELEV").or_else(|| values(sheet.shapes, "ELEV_MIN"));
    let height = |shape: usize| match heights.as_ref().and_then(|values| values.get(shape)) {
        Some(Value::Number(height)) => *height,
        _ => 0.0,
    };
    target.write_with(|out| {
        let mut drawing = Dxf::begin(out, layers(), &bounds)?;
        for (number, shape) in shapes.iter().enumerate() {
            let layer = if is_index(number) { INDEX } else { LINES };
            let (Shape::Lines(parts) | Shape::Polygon(parts)) = shape else {
                continue;
            };
            for part in parts {
                let points: Vec<[f64; 2]> = part.iter().map(|&[x, y, _]| [x, y]).collect();
                drawing.contour(layer, height(number), &points)?;
            }
        }
        if let Some(labels) = sheet.labels {
            draw_labels(&mut drawing, labels, sheet.text_height)?;
        }
        drawing.end()
    })?;
    Ok(without_system(sheet.shapes.crs.as_ref())
        .into_iter()
        .collect())
}

fn draw_labels(drawing: &mut Dxf, labels: &Layer, height: f64) -> Result<()> {
    let [levels, rotations] = ["ELEV", "ROTATION"].map(|name| values(labels, name));
    let (Some(levels), Some(rotations)) = (levels, rotations) else {
        return Ok(());
    };
    for ((shape, level), rotation) in labels.shapes.iter().zip(levels).zip(rotations) {
        let rotation = match rotation {
            Value::Number(degrees) => *degrees,
            _ => 0.0,
        };
        for &at in shape.vertices() {
            drawing.centered(LABELS, at, height, rotation, &level.text())?;
        }
    }
    Ok(())
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

/// Returns a warning about a system, for which there is no place.
fn without_system(crs: Option<&Crs>) -> Option<String> {
    crs.map(|crs| format!("a drawing has no coordinate system: {crs} is not written"))
}
