//! Vector layers: read, reprojected to the coordinate system of the result, and written.

use std::borrow::Cow;
use std::path::Path;

use super::shapes::{self, Polygon, Rings};
use crate::data::Layer;
use crate::error::{Result, Setting};
use crate::io::{Destination, OnDamage, layer};
use crate::run::context::notice::Notice;
use crate::run::context::{Context, Journal};
use crate::run::request::input::Input;
use crate::run::sources::open;
use crate::run::sources::transforms::Transforms;

/// Layers, each with its path.
pub(crate) type Layers<'a> = Vec<(&'a Path, Cow<'a, Layer>)>;

/// Writes a layer in the format that the extension of `target` names. What the format cannot keep
/// is a notice.
///
/// # Errors
/// If the format cannot be written, has no room for the shapes or their attributes, or the file
/// cannot be written.
pub(crate) fn write(layer: &Layer, target: Destination, context: &Context) -> Result<()> {
    let path = target.path();
    let warnings = target.put_whole(|target| layer::write_lines(target, layer))?;
    note_warnings(path, warnings, context);
    Ok(())
}

/// Reports what the writer of a file said.
pub(crate) fn note_warnings(path: &Path, warnings: Vec<String>, context: &Context) {
    for text in warnings {
        let notice = Notice::Reader(path.to_path_buf(), text.into());
        context.monitor.notice(&notice);
    }
}

/// Reads layers with these columns, and adds a notice about each layer.
///
/// # Errors
/// If one cannot be read or lacks a column, or the run is canceled.
pub(crate) fn read<'a>(
    inputs: &'a [Input<Layer>],
    columns: &[&str],
    cut: OnDamage,
    journal: &Journal,
) -> Result<Layers<'a>> {
    let mut layers = Vec::with_capacity(inputs.len());
    for input in inputs {
        journal.context.check()?;
        let path = input.path();
        let layer =
            open::layer_of(input, columns, cut, &journal.context).map_err(|e| e.in_file(path))?;
        note(path, &layer, journal);
        layers.push((path, layer));
    }
    Ok(layers)
}

/// Reads a layer with all its attributes, and adds a notice about it.
///
/// # Errors
/// If it cannot be read, or the run is canceled.
pub(crate) fn read_whole<'a>(
    input: &'a Input<Layer>,
    journal: &Journal,
) -> Result<(&'a Path, Cow<'a, Layer>)> {
    journal.context.check()?;
    let path = input.path();
    let layer = match input {
        Input::File(path) => {
            open::whole_layer(path, OnDamage::Refuse, &journal.context).map(Cow::Owned)
        }
        Input::Memory(layer) => Ok(Cow::Borrowed(&**layer)),
    };
    let layer = layer.map_err(|e| e.in_file(path))?;
    note(path, &layer, journal);
    if layer.attributes.is_none() && !layer.fields.is_empty() {
        journal.add(Notice::AttributesLeftOut(path.to_path_buf()));
    }
    Ok((path, layer))
}

fn note(path: &Path, layer: &Layer, journal: &Journal) {
    journal.add(Notice::LayerRead {
        path: path.to_path_buf(),
        format: layer.format.clone(),
        records: layer.shapes.len(),
    });
    journal.add_warnings(path, &layer.warnings);
}

/// Returns the polygons of several layers of boundaries in the coordinate system of the result.
///
/// # Errors
/// Those of [`polygons`].
pub(crate) fn boundaries(
    boundary: &Layers,
    by_file: &[Option<usize>],
    transforms: &Transforms,
) -> Result<Vec<Rings>> {
    let mut all = Vec::new();
    for ((path, layer), transform) in boundary.iter().zip(by_file) {
        let polygons = polygons(layer, path, Setting::Boundary, *transform, transforms)?;
        all.extend(polygons.into_iter().map(|polygon| polygon.rings));
    }
    Ok(all)
}

/// Returns the polygons of a layer in the coordinate system of the result.
///
/// # Errors
/// If the layer has no polygon, or a polygon cannot be reprojected.
pub(crate) fn polygons(
    layer: &Layer,
    path: &Path,
    setting: Setting,
    transform: Option<usize>,
    transforms: &Transforms,
) -> Result<Vec<Polygon>> {
    let mut polygons = shapes::polygons(layer, path, setting)?;
    for ring in polygons.iter_mut().flat_map(|polygon| &mut polygon.rings) {
        let mut points: Vec<[f64; 3]> = ring.iter().map(|p| [p[0], p[1], 0.0]).collect();
        transforms
            .apply(transform, &mut points)
            .map_err(|e| e.in_file(path))?;
        *ring = points.into_iter().map(|p| [p[0], p[1]]).collect();
    }
    Ok(polygons)
}
