use std::ffi::c_int;
use std::path::Path;

use gdal::errors::GdalError;
use gdal::spatial_ref::{AxisMappingStrategy, SpatialRef};
use gdal::vector::{
    Feature, FieldValue, Geometry, LayerAccess, geometry_type_flatten, geometry_type_has_z,
    geometry_type_to_name,
};
use gdal::{Dataset, DatasetOptions, GdalOpenFlags};
use gdal_sys::OGRwkbGeometryType as Type;

use super::{messages, names};
use crate::crs::Crs;
use crate::data::{Layer, Shape, Value, oriented};
use crate::error::{Error, Result};
use crate::io::bytes::field::{finite_or_none, not_a_number, parse_number};
use crate::io::bytes::watch::{Watch, unwatched};
use crate::io::options::layer::Options;
use crate::io::options::layers::{Fields, check_depth, set_heights, warn_of_missing_heights};

/// Reads a layer of any vector file that GDAL supports; `layer` may be omitted if the file has only
/// one.
///
/// Heights come from the geometry, and are NaN if that is flat. Arcs become polylines (with GDAL's
/// default of a vertex every 4 degrees). The parts of a collection become separate shapes.
///
/// # Errors
/// If GDAL cannot open the file, the file has no such layer, or reading fails; if the file has
/// several layers and none is named.
pub fn read_layer(path: &Path, layer: Option<&str>) -> Result<Layer> {
    read_layer_with(
        path,
        &Options {
            layer,
            ..Options::default()
        },
        &unwatched,
    )
}

/// Like [`read_layer`], but with heights from an attribute and the numbers of others, and watched.
/// Nothing is counted.
///
/// # Errors
/// Those of [`read_layer`], and that of the watch; if an attribute does not exist, or a value of a
/// requested column is not a number.
pub fn read_layer_with(path: &Path, options: &Options, watch: Watch) -> Result<Layer> {
    let path = names::shown(path);
    options
        .read_chosen(|options| read_all(&path, options, watch))
        .map_err(|error| error.in_file(&path))
}

/// Returns true if GDAL opens a data set as vector layers.
pub fn holds_layers(path: &Path) -> bool {
    messages::listen();
    open(&names::shown(path)).is_ok_and(|dataset| dataset.layer_count() > 0)
}

fn open(path: &Path) -> gdal::errors::Result<Dataset> {
    let options = DatasetOptions {
        open_flags: GdalOpenFlags::GDAL_OF_VECTOR | GdalOpenFlags::GDAL_OF_VERBOSE_ERROR,
        ..DatasetOptions::default()
    };
    Dataset::open_ex(names::with_secrets(path), options)
}

fn read_all(path: &Path, options: &Options, watch: Watch) -> Result<Layer> {
    messages::listen();
    let dataset = open(path).map_err(|error| messages::cannot_open(path, "vector", error))?;
    let layers: Vec<String> = dataset.layers().map(|layer| layer.name()).collect();
    let is_field = |name: &str| {
        dataset.layers().any(|layer| {
            let mut fields = layer.defn().fields();
            fields.any(|field| field.name().eq_ignore_ascii_case(name))
        })
    };
    let (at, height_field) = options
        .choose(&layers, is_field)
        .map_err(|error| error.in_file(path))?;
    let layer_name = &layers[at];
    let mut source = dataset
        .layer_by_name(layer_name)
        .map_err(|error| messages::error(path, error))?;
    let names: Vec<String> = source.defn().fields().map(|field| field.name()).collect();
    let fields = Fields::of(&names, height_field.as_deref(), options.columns)
        .map_err(|error| error.in_file(path))?;
    let mut layer = Layer {
        format: format!(
            "GDAL {} {}",
            dataset.driver().short_name(),
            geometry_type_to_name(source.defn().geometry_type())
        ),
        ..options.empty_layer(names)
    };
    let reference = source.spatial_ref();
    let is_swapped = reference.as_ref().is_some_and(is_north_first);
    if let Some(reference) = reference {
        read_crs(&reference, &mut layer);
    }
    let mut without_height = 0;
    for (record, feature) in (1..).zip(source.features()) {
        watch(0)?;
        let first = layer.shapes.len();
        let lacks_height = add_shapes(path, &feature, fields.height, &mut layer.shapes)?;
        without_height += usize::from(lacks_height);
        add_values(path, &feature, record, &fields.columns, &mut layer)?;
        keep_values(path, &feature, &mut layer)?;
        if is_swapped {
            layer.shapes[first..]
                .iter_mut()
                .for_each(|shape| shape.change_vertices(|vertex| vertex.swap(0, 1)));
        }
    }
    // The iterator ends at an error as it does at the end of the file.
    if let Some(error) = messages::failure(path) {
        return Err(error.at(format!(
            "layer {layer_name}, after {} records",
            layer.shapes.len()
        )));
    }
    layer.warnings.extend(messages::warnings());
    warn_of_missing_heights(without_height, &mut layer);
    Ok(layer)
}

/// Adds the shapes of a record, at the height in a field if one is given. Returns true if that is
/// not a number.
fn add_shapes(
    path: &Path,
    feature: &Feature,
    field: Option<usize>,
    into: &mut Vec<Shape>,
) -> Result<bool> {
    let first = into.len();
    match feature.geometry() {
        Some(geometry) if !is_absent(geometry) => {
            shapes(geometry, 0, into).map_err(|error| error.in_file(path))?
        }
        _ => into.push(Shape::Null),
    }
    let Some(field) = field else { return Ok(false) };
    let value = value_of(path, feature, field)?;
    let height = value.map_or(Ok(f64::NAN), number).unwrap_or(f64::NAN);
    Ok(set_heights(&mut into[first..], height))
}

/// Adds the numbers of a record to the columns, once for each of its shapes.
fn add_values(
    path: &Path,
    feature: &Feature,
    record: usize,
    fields: &[usize],
    layer: &mut Layer,
) -> Result<()> {
    let shapes = layer.shapes.len();
    for (column, &field) in layer.columns.iter_mut().zip(fields) {
        let value = value_of(path, feature, field)?;
        let value = value.map_or(Ok(f64::NAN), number).map_err(|text| {
            not_a_number(&column.name, &text)
                .at(format!("record {record}"))
                .in_file(path)
        })?;
        column.values.resize(shapes, value);
    }
    Ok(())
}

/// Adds all values of a record, once for each of its shapes, if they are kept.
fn keep_values(path: &Path, feature: &Feature, layer: &mut Layer) -> Result<()> {
    let Some(attributes) = &mut layer.attributes else {
        return Ok(());
    };
    let mut row = Vec::with_capacity(attributes.names.len());
    for field in 0..attributes.names.len() {
        let value = value_of(path, feature, field)?;
        row.push(value.map_or(Value::Missing, kept));
    }
    attributes.rows.resize(layer.shapes.len(), row);
    Ok(())
}

/// Returns the value of a field; `None` if the record has none. What the crate `gdal` has no type
/// for, such as times, is a text.
#[allow(unsafe_code)]
fn value_of(path: &Path, feature: &Feature, field: usize) -> Result<Option<FieldValue>> {
    let number = c_int::try_from(field).unwrap_or(c_int::MAX);
    // `Feature::field` of the crate `gdal` takes a value that was never set, as in a text format,
    // for 0 or an empty text.
    // SAFETY: the feature is live; GDAL checks the number.
    let is_there =
        unsafe { gdal_sys::OGR_F_IsFieldSetAndNotNull(feature.c_feature(), number) } != 0;
    if !is_there {
        return Ok(None);
    }
    let value = match feature.field(field) {
        Err(GdalError::UnhandledFieldType { .. }) => {
            let text = feature.field_as_string(field);
            text.map(|text| text.map(FieldValue::StringValue))
        }
        value => value,
    };
    value.map_err(|error| messages::error(path, error))
}

/// Returns a value as it is kept; what is neither a number nor a text, as a text.
fn kept(value: FieldValue) -> Value {
    match value {
        FieldValue::StringValue(text) => Value::Text(text),
        FieldValue::IntegerValue(whole) => Value::Whole(i64::from(whole)),
        FieldValue::Integer64Value(whole) => Value::Whole(whole),
        FieldValue::RealValue(number) => Value::Number(number),
        FieldValue::DateValue(date) => Value::Text(date.to_string()),
        FieldValue::DateTimeValue(time) => Value::Text(time.to_string()),
        // Lists.
        other => Value::Text(format!("{other:?}")),
    }
}

/// Sets the coordinate system of a layer.
fn read_crs(reference: &SpatialRef, layer: &mut Layer) {
    let (stated, read) = match reference.to_wkt() {
        Ok(wkt) => (
            wkt.clone(),
            Crs::from_wkt(&wkt).map_err(|error| error.to_string()),
        ),
        Err(error) => (
            "a system that GDAL cannot write as WKT".to_owned(),
            Err(error.to_string()),
        ),
    };
    match read {
        Ok(crs) => layer.crs = crs.unless_undefined(),
        Err(reason) => {
            layer
                .warnings
                .push(format!("the coordinate system is not understood: {reason}").into());
            layer.unread_crs = Some(stated);
        }
    }
}

/// Returns true if the first coordinate is a latitude or northing in the axis order of the data.
fn is_north_first(reference: &SpatialRef) -> bool {
    let target = if reference.is_geographic() {
        "GEOGCS"
    } else {
        "PROJCS"
    };
    reference.axis_mapping_strategy() == AxisMappingStrategy::AuthorityCompliant
        && reference
            .axis_orientation(target, 0)
            .is_ok_and(|axis| axis == gdal_sys::OGRAxisOrientation::OAO_North)
}

/// Returns the number in a field or in its text, NaN if it is empty or not finite. If the field
/// contains something else, the error is its text.
fn number(value: FieldValue) -> std::result::Result<f64, String> {
    let number = match value {
        // GDAL's own conversion turns any other text into 0.
        FieldValue::StringValue(text) => parse_number(text.trim())?,
        FieldValue::IntegerValue(value) => f64::from(value),
        FieldValue::Integer64Value(value) => value as f64,
        FieldValue::RealValue(value) => value,
        other => return Err(format!("{other:?}")),
    };
    Ok(finite_or_none(number))
}

/// Adds the shape of a geometry, or several for a collection.
fn shapes(geometry: &Geometry, depth: usize, into: &mut Vec<Shape>) -> Result<()> {
    check_depth(depth)?;
    let members = || (0..geometry.geometry_count()).map(|i| geometry.get_geometry(i));
    let kind = geometry_type_flatten(geometry.geometry_type());
    into.push(match kind {
        Type::wkbPoint => Shape::Points(vertices(geometry)),
        Type::wkbMultiPoint => Shape::Points(members().flat_map(|part| vertices(&part)).collect()),
        Type::wkbLineString | Type::wkbLinearRing => Shape::Lines(vec![vertices(geometry)]),
        Type::wkbMultiLineString => Shape::Lines(members().map(|part| vertices(&part)).collect()),
        Type::wkbPolygon | Type::wkbTriangle => Shape::Polygon(oriented(parts(geometry))),
        Type::wkbMultiPolygon => {
            Shape::Polygon(members().flat_map(|part| oriented(parts(&part))).collect())
        }
        Type::wkbTIN | Type::wkbPolyhedralSurface => {
            Shape::of_faces(members().map(|part| parts(&part)).collect())
        }
        Type::wkbGeometryCollection => {
            for part in members() {
                shapes(&part, depth + 1, into)?;
            }
            return Ok(());
        }
        Type::wkbCircularString
        | Type::wkbCompoundCurve
        | Type::wkbCurvePolygon
        | Type::wkbMultiCurve
        | Type::wkbMultiSurface => {
            return with_polylines(geometry, |straight| shapes(straight, depth + 1, into));
        }
        Type::wkbNone => Shape::Null,
        _ => {
            return Err(Error::unsupported(format!(
                "geometry of the type {}",
                geometry_type_to_name(kind)
            )));
        }
    });
    Ok(())
}

/// Returns true if a record has no geometry: the `gdal` crate then wraps a null pointer, which GDAL
/// would report as an error.
#[allow(unsafe_code)]
fn is_absent(geometry: &Geometry) -> bool {
    // SAFETY: the pointer is compared, not dereferenced.
    unsafe { geometry.c_geometry() }.is_null()
}

/// Calls `show` with the geometry, in which arcs are replaced by polylines.
#[allow(unsafe_code)]
fn with_polylines(geometry: &Geometry, show: impl FnOnce(&Geometry) -> Result<()>) -> Result<()> {
    // The `gdal` crate has no safe function for this, and GDAL's global flag for it misses arcs
    // with heights (observed in 3.6).
    // SAFETY: the pointer is that of a live geometry, which GDAL does not keep; a null pointer for
    // the options and an angle of 0 mean the defaults.
    let straight = unsafe {
        gdal_sys::OGR_G_GetLinearGeometry(geometry.c_geometry(), 0.0, std::ptr::null_mut())
    };
    if straight.is_null() {
        return Err(Error::unsupported(format!(
            "arcs of the type {}",
            geometry.geometry_name()
        )));
    }
    let result = {
        // SAFETY: the wrapper does not own its geometry, and is dropped before the geometry, below.
        let wrapper = unsafe { Geometry::lazy_feature_geometry() };
        // SAFETY: the wrapper is empty and does not own its geometry, and the pointer is a
        // geometry.
        unsafe { wrapper.set_c_geometry(straight) };
        show(&wrapper)
    };
    // SAFETY: `OGR_G_GetLinearGeometry` transferred ownership to us, and nothing refers to the
    // geometry any more.
    unsafe { gdal_sys::OGR_G_DestroyGeometry(straight) };
    result
}

fn vertices(geometry: &Geometry) -> Vec<[f64; 3]> {
    let has_z = geometry_type_has_z(geometry.geometry_type());
    let mut points = Vec::new();
    if !geometry.is_empty() {
        geometry.get_points(&mut points);
    }
    points
        .into_iter()
        .map(|(x, y, z)| [x, y, if has_z { z } else { f64::NAN }])
        .collect()
}

/// Returns the rings of one polygon as stored.
fn parts(polygon: &Geometry) -> Vec<Vec<[f64; 3]>> {
    (0..polygon.geometry_count())
        .map(|i| vertices(&polygon.get_geometry(i)))
        .filter(|ring| !ring.is_empty())
        .collect()
}
