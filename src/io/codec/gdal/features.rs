//! Writes vector layers by a driver of GDAL: to files, or to a table of a database.

use std::collections::BTreeSet;
use std::ffi::CString;
use std::path::{Path, PathBuf};

use gdal::errors::GdalError;
use gdal::raster::RasterCreationOptions;
use gdal::spatial_ref::{AxisMappingStrategy, SpatialRef};
use gdal::vector::{
    Feature, Geometry, LayerAccess, LayerCaps, LayerOptions, OGRFieldType, geometry_type_set_z,
};
use gdal::{Dataset, DatasetOptions, Driver, GdalOpenFlags};
use gdal_sys::OGRwkbGeometryType as Type;

use super::{drivers, messages, names};
use crate::crs::Crs;
use crate::data::{Attributes, ContourLine, Layer, Shape, ShapeKind, Value, ValueKind, polygons};
use crate::error::{Error, Kind, Result, Setting, wording};
use crate::io::bytes::appended::appended;
use crate::io::bytes::output::{Deferred, Destination, OutputDriver};
use crate::io::codec::contour_summary::ContourSummary;

/// Writes contours by the driver of the destination, as line strings with heights and with the
/// attributes `ID` (from 1) and `ELEV`. Lines with fewer than two vertices are left out.
///
/// # Errors
/// Those of [`write_layer`].
pub(crate) fn write_contours(
    target: Destination,
    driver: &OutputDriver,
    lines: &mut dyn Iterator<Item = ContourLine>,
    crs: Option<&Crs>,
) -> Result<ContourSummary> {
    let head = Head {
        kind: Type::wkbLineString,
        has_heights: true,
        fields: vec![
            ("ID".to_owned(), OGRFieldType::OFTInteger),
            ("ELEV".to_owned(), OGRFieldType::OFTReal),
        ],
        crs,
    };
    let mut summary = ContourSummary::default();
    let mut fill = |records: &mut Records| {
        for line in &mut *lines {
            if line.points.len() > 1 {
                summary.add(&line);
                let (shape, values) = summary.last_record(&line);
                records.add(&shape, &values)?;
            }
        }
        Ok(())
    };
    let warnings = write(target, driver, &head, &mut fill)?;
    summary.warnings = warnings;
    Ok(summary)
}

/// Writes the shapes of a layer with all its attributes by the driver of the destination. The layer
/// has the name of the file. Returns warnings.
///
/// # Errors
/// If the driver has no room for such shapes, or the file cannot be written; for a database, if it
/// has no transactions, or the table exists and is not to be replaced.
pub(crate) fn write_layer(
    target: Destination,
    driver: &OutputDriver,
    layer: &Layer,
) -> Result<Vec<String>> {
    let none = Default::default();
    let attributes = layer.attributes.as_ref().unwrap_or(&none);
    let fields = match attributes.names.is_empty() {
        true => vec![("ID".to_owned(), OGRFieldType::OFTInteger)],
        false => (0..)
            .zip(&attributes.names)
            .map(|(number, name)| (name.clone(), type_of(attributes, number)))
            .collect(),
    };
    let shapes = || layer.shapes.iter();
    let is_multiple = shapes().any(|shape| shape.part_count() > 1);
    let head = Head {
        kind: kind_of(layer, is_multiple),
        has_heights: shapes().flat_map(Shape::vertices).any(|p| p[2].is_finite()),
        fields,
        crs: layer.crs.as_ref(),
    };
    write(target, driver, &head, &mut |records| {
        for (i, shape) in shapes().enumerate() {
            match attributes.rows.get(i) {
                Some(row) if !attributes.names.is_empty() => records.add(shape, row)?,
                _ => records.add(shape, &[Value::Whole(i as i64 + 1)])?,
            }
        }
        Ok(())
    })
}

/// Returns the type of an attribute. Whole numbers have 32 bits where these suffice: several
/// drivers have no others.
fn type_of(attributes: &Attributes, number: usize) -> OGRFieldType::Type {
    let is_long = |value: &Value| matches!(value, Value::Whole(n) if i32::try_from(*n).is_err());
    match attributes.kind(number) {
        ValueKind::Whole if attributes.column(number).any(is_long) => OGRFieldType::OFTInteger64,
        ValueKind::Whole | ValueKind::Truth => OGRFieldType::OFTInteger,
        ValueKind::Number => OGRFieldType::OFTReal,
        ValueKind::Text => OGRFieldType::OFTString,
    }
}

/// Returns the type of the geometries of a layer, in plan.
fn kind_of(layer: &Layer, is_multiple: bool) -> Type::Type {
    let kinds: BTreeSet<ShapeKind> = layer.shapes.iter().map(Shape::kind).collect();
    let mut kinds = kinds.into_iter().filter(|&kind| kind != ShapeKind::Null);
    match (kinds.next(), kinds.next(), is_multiple) {
        (Some(ShapeKind::Points), None, false) => Type::wkbPoint,
        (Some(ShapeKind::Points), None, true) => Type::wkbMultiPoint,
        (Some(ShapeKind::Lines), None, false) => Type::wkbLineString,
        (Some(ShapeKind::Lines), None, true) => Type::wkbMultiLineString,
        (Some(ShapeKind::Polygon), None, false) => Type::wkbPolygon,
        (Some(ShapeKind::Polygon), None, true) => Type::wkbMultiPolygon,
        _ => Type::wkbUnknown,
    }
}

/// What is known of a layer before its records.
struct Head<'a> {
    kind: Type::Type,
    has_heights: bool,
    /// The names and types of the attributes.
    fields: Vec<(String, OGRFieldType::Type)>,
    crs: Option<&'a Crs>,
}

impl Head<'_> {
    /// Returns the coordinate system for GDAL, easting or longitude first.
    fn reference(&self, warnings: &mut Vec<String>) -> Option<SpatialRef> {
        let mut reference = match SpatialRef::from_wkt(&self.crs?.to_wkt()) {
            Ok(reference) => reference,
            Err(error) => {
                // Not an error of the driver.
                messages::listen();
                warnings.push(format!(
                    "without its coordinate system, which GDAL does not know: {error}"
                ));
                return None;
            }
        };
        reference.set_axis_mapping_strategy(AxisMappingStrategy::TraditionalGisOrder);
        Some(reference)
    }

    /// Returns the type of the geometries.
    fn geometry_type(&self) -> Type::Type {
        match self.has_heights {
            true => geometry_type_set_z(self.kind),
            false => self.kind,
        }
    }
}

/// Adds records to a layer.
type Fill<'a> = dyn FnMut(&mut Records) -> Result<()> + 'a;

fn write(
    target: Destination,
    driver: &OutputDriver,
    head: &Head,
    fill: &mut Fill,
) -> Result<Vec<String>> {
    let written = match names::is_connection(target.path()) {
        true => write_table(target, driver, head, fill),
        false => write_file(target, driver, head, fill),
    };
    written.map_err(|error| error.in_file(target.path()))
}

fn write_file(
    target: Destination,
    driver: &OutputDriver,
    head: &Head,
    fill: &mut Fill,
) -> Result<Vec<String>> {
    let own = drivers::get(&driver.name)?;
    let folder = target.staging_folder()?;
    let path = folder
        .path()
        .join(target.path().file_name().unwrap_or_default());
    let name = target
        .path()
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy();
    let paths = Paths {
        path: &path,
        target: target.path(),
    };
    messages::listen();
    let mut dataset =
        create(&own, &path, &driver.creation).map_err(|error| paths.refused(error))?;
    let mut warnings = add_layer(&mut dataset, &name, driver, head, paths, fill)?;
    dataset.close().map_err(|error| paths.refused(error))?;
    paths.require_no_failure()?;
    warnings.extend(messages::warning_texts(&path, target.path()));
    let stale = [".aux.xml"].map(|end| appended(target.path(), end));
    target.put_staged(folder.path(), &stale)?;
    Ok(warnings)
}

/// Creates a data set without cells.
#[allow(unsafe_code)]
fn create(driver: &Driver, path: &Path, options: &[String]) -> gdal::errors::Result<Dataset> {
    let options = RasterCreationOptions::from_iter(options.iter().map(String::as_str));
    let name = CString::new(path.as_os_str().as_encoded_bytes())?;
    // `Driver::create_vector_only` of the crate `gdal` takes no options, and its other functions
    // need a type of cells, which some drivers refuse.
    // SAFETY: all pointers are those of live values, which GDAL uses until it returns.
    let created = unsafe {
        let no_cells = gdal_sys::GDALDataType::GDT_Unknown;
        let driver = driver.c_driver();
        gdal_sys::GDALCreate(driver, name.as_ptr(), 0, 0, 0, no_cells, options.as_ptr())
    };
    match created.is_null() {
        true => Err(GdalError::NullPointer {
            method_name: "GDALCreate",
            msg: "the driver creates nothing".to_owned(),
        }),
        // SAFETY: the data set was just created, and is used nowhere else.
        false => Ok(unsafe { Dataset::from_c_dataset(created) }),
    }
}

/// Where a layer is written, and where it will appear.
#[derive(Clone, Copy)]
struct Paths<'a> {
    path: &'a Path,
    target: &'a Path,
}

impl Paths<'_> {
    fn require_no_failure(self) -> Result<()> {
        messages::refusal(self.path, self.target).map_or(Ok(()), Err)
    }

    /// Returns the error of a driver that could not write, preferring the captured message.
    fn refused(self, error: GdalError) -> Error {
        messages::refusal(self.path, self.target)
            .unwrap_or_else(|| Error::caused_by(Kind::Unsupported, error).in_file(self.target))
    }
}

/// Creates a layer and fills it. Returns warnings.
fn add_layer(
    dataset: &mut Dataset,
    name: &str,
    driver: &OutputDriver,
    head: &Head,
    paths: Paths,
    fill: &mut Fill,
) -> Result<Vec<String>> {
    let mut warnings = Vec::new();
    let reference = head.reference(&mut warnings);
    let options: Vec<&str> = driver.layer.iter().map(String::as_str).collect();
    let layer = dataset
        .create_layer(LayerOptions {
            name,
            srs: reference.as_ref(),
            ty: head.geometry_type(),
            options: (!options.is_empty()).then_some(&options[..]),
        })
        .map_err(|error| paths.refused(error))?;
    if layer.defn().geometry_type() == Type::wkbNone {
        let error = format!(
            "the driver {} stores no shapes, only attributes",
            driver.name
        );
        return Err(Error::usage(error).cure(wording![
            "choose another driver; CSV stores them as text with ",
            Setting::LayerOptions.text("GEOMETRY=AS_WKT")
        ]));
    }
    let mut fields = Vec::with_capacity(head.fields.len());
    let can_add = layer.has_capability(LayerCaps::OLCCreateField);
    let mut left_out = Vec::new();
    for (name, field_type) in &head.fields {
        // Of a fixed set of attributes, some may have the name.
        let fixed = layer
            .defn()
            .fields()
            .position(|own| own.name().eq_ignore_ascii_case(name));
        let at = match fixed {
            Some(at) => Some(at),
            None if can_add => {
                let before = layer.defn().fields().count();
                layer
                    .create_defn_fields(&[(name.as_str(), *field_type)])
                    .map_err(|error| paths.refused(error))?;
                // Its driver may have given it another name.
                (layer.defn().fields().count() > before).then_some(before)
            }
            None => None,
        };
        if at.is_none() {
            left_out.push(name.as_str());
        }
        fields.push(at);
    }
    if !left_out.is_empty() {
        warnings.push(format!(
            "without {}: the driver {} has a fixed set of attributes",
            left_out.join(", "),
            driver.name
        ));
    }
    let mut records = Records {
        layer: &layer,
        fields,
        has_heights: head.has_heights,
        is_multiple: matches!(
            head.kind,
            Type::wkbMultiPoint | Type::wkbMultiLineString | Type::wkbMultiPolygon
        ),
        paths,
        count: 0,
    };
    fill(&mut records)?;
    Ok(warnings)
}

/// A layer that is being filled.
struct Records<'a> {
    layer: &'a gdal::vector::Layer<'a>,
    /// The position of each attribute in the layer; `None` if it has none.
    fields: Vec<Option<usize>>,
    has_heights: bool,
    /// True if each record has a list of points, lines or polygons, as the layer states.
    is_multiple: bool,
    paths: Paths<'a>,
    count: u64,
}

impl Records<'_> {
    /// Adds a record.
    fn add(&mut self, shape: &Shape, values: &[Value]) -> Result<()> {
        self.count += 1;
        self.try_add(shape, values).map_err(|error| {
            self.paths
                .refused(error)
                .at(format!("record {}", self.count))
        })?;
        self.paths.require_no_failure()
    }

    fn try_add(&self, shape: &Shape, values: &[Value]) -> gdal::errors::Result<()> {
        let mut feature = Feature::new(self.layer.defn())?;
        if let Some(geometry) = self.geometry(shape)? {
            feature.set_geometry(geometry)?;
        }
        for (at, value) in self.fields.iter().zip(values) {
            let Some(at) = *at else { continue };
            match value {
                Value::Missing => feature.set_field_null(at)?,
                Value::Whole(whole) => feature.set_field_integer64(at, *whole)?,
                Value::Number(number) if number.is_finite() => {
                    feature.set_field_double(at, *number)?
                }
                Value::Number(_) => feature.set_field_null(at)?,
                Value::Text(text) => feature.set_field_string(at, &text.replace('\0', " "))?,
                Value::Truth(truth) => feature.set_field_integer(at, i32::from(*truth))?,
            }
        }
        feature.create(self.layer)
    }

    /// Returns the geometry of a shape; `None` for one without.
    fn geometry(&self, shape: &Shape) -> gdal::errors::Result<Option<Geometry>> {
        let point = |point: &[f64; 3]| self.simple(Type::wkbPoint, &[*point]);
        let line = |part: &Vec<[f64; 3]>| self.simple(Type::wkbLineString, part);
        Ok(Some(match shape {
            Shape::Null => return Ok(None),
            Shape::Points(points) => match &points[..] {
                [] => return Ok(None),
                [only] if !self.is_multiple => point(only)?,
                points => joined(Type::wkbMultiPoint, points.iter().map(point))?,
            },
            Shape::Lines(parts) => match &parts[..] {
                [] => return Ok(None),
                [only] if !self.is_multiple => line(only)?,
                parts => joined(Type::wkbMultiLineString, parts.iter().map(line))?,
            },
            Shape::Polygon(rings) => self.areas(polygons(rings).into_iter())?,
            Shape::Faces(faces) => self.areas(faces.iter().map(Vec::as_slice))?,
        }))
    }

    /// Returns polygons, each of which has its outer ring first.
    fn areas<'r>(
        &self,
        areas: impl ExactSizeIterator<Item = &'r [Vec<[f64; 3]>]>,
    ) -> gdal::errors::Result<Geometry> {
        let polygon = |rings: &[Vec<[f64; 3]>]| {
            let rings = rings
                .iter()
                .map(|ring| self.simple(Type::wkbLinearRing, ring));
            joined(Type::wkbPolygon, rings)
        };
        let is_single = areas.len() == 1 && !self.is_multiple;
        let mut areas = areas.map(polygon);
        match is_single {
            true => areas
                .next()
                .unwrap_or_else(|| Geometry::empty(Type::wkbPolygon)),
            false => joined(Type::wkbMultiPolygon, areas),
        }
    }

    fn simple(&self, kind: Type::Type, points: &[[f64; 3]]) -> gdal::errors::Result<Geometry> {
        let mut geometry = Geometry::empty(kind)?;
        for &[x, y, z] in points {
            match self.has_heights {
                true => geometry.add_point((x, y, z)),
                false => geometry.add_point_2d((x, y)),
            }
        }
        Ok(geometry)
    }
}

/// Returns a geometry of parts.
fn joined(
    kind: Type::Type,
    parts: impl Iterator<Item = gdal::errors::Result<Geometry>>,
) -> gdal::errors::Result<Geometry> {
    let mut geometry = Geometry::empty(kind)?;
    for part in parts {
        geometry.add_geometry(part?)?;
    }
    Ok(geometry)
}

fn write_table(
    target: Destination,
    driver: &OutputDriver,
    head: &Head,
    fill: &mut Fill,
) -> Result<Vec<String>> {
    let text = target.path().to_string_lossy();
    let (connection, Some(table)) = names::split(&text) else {
        return Err(
            Error::usage("the output is a database, without the name of a table")
                .cure(format!("write {text}:TABLE")),
        );
    };
    messages::listen();
    let options = DatasetOptions {
        open_flags: GdalOpenFlags::GDAL_OF_VECTOR
            | GdalOpenFlags::GDAL_OF_UPDATE
            | GdalOpenFlags::GDAL_OF_VERBOSE_ERROR,
        ..DatasetOptions::default()
    };
    let dataset = Dataset::open_ex(names::with_secrets(connection), options)
        .map_err(|error| messages::cannot_open(connection, "vector", error))?;
    let mut pending = PendingTable {
        dataset,
        target: target.path().to_path_buf(),
        is_open: false,
    };
    pending.begin()?;
    let paths = Paths {
        path: Path::new(""),
        target: target.path(),
    };
    let known: Vec<String> = pending.dataset.layers().map(|layer| layer.name()).collect();
    if let Some(at) = known
        .iter()
        .position(|name| name.eq_ignore_ascii_case(table))
    {
        if !driver.replaces {
            return Err(
                Error::usage(format!("the table {table} exists")).cure(wording![
                    "give it another name, or add ",
                    Setting::Overwrite.on()
                ]),
            );
        }
        pending
            .dataset
            .delete_layer(at)
            .map_err(|error| paths.refused(error))?;
    }
    let mut warnings = add_layer(&mut pending.dataset, table, driver, head, paths, fill)?;
    pending
        .dataset
        .flush_cache()
        .map_err(|error| paths.refused(error))?;
    paths.require_no_failure()?;
    warnings.extend(messages::warning_texts(Path::new(""), target.path()));
    target.put_deferred(Box::new(pending))?;
    Ok(warnings)
}

/// A table in a transaction that has not ended; if dropped, nothing of it is left.
struct PendingTable {
    dataset: Dataset,
    target: PathBuf,
    /// True while the transaction is open.
    is_open: bool,
}

impl std::fmt::Debug for PendingTable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PendingTable")
            .field("target", &self.target)
            .finish_non_exhaustive()
    }
}

/// The transactions of the crate `gdal` borrow their data set, and so cannot be kept together with
/// it until all outputs are complete.
#[allow(unsafe_code)]
impl PendingTable {
    /// # Errors
    /// If the database has no transactions.
    fn begin(&mut self) -> Result<()> {
        // SAFETY: the data set is open; 0 asks for a transaction of the database itself.
        let started = unsafe { gdal_sys::GDALDatasetStartTransaction(self.dataset.c_dataset(), 0) };
        self.is_open = started == gdal_sys::OGRErr::OGRERR_NONE;
        match self.is_open {
            true => Ok(()),
            false => Err(self
                .refused("no transaction can be started, without which a part of it might appear")
                .cure("write a file, and load it into the database")),
        }
    }

    fn refused(&self, what: &str) -> Error {
        messages::refusal(Path::new(""), &self.target)
            .unwrap_or_else(|| Error::unsupported(what).in_file(&self.target))
    }
}

#[allow(unsafe_code)]
impl Deferred for PendingTable {
    fn target(&self) -> &Path {
        &self.target
    }

    fn appear(mut self: Box<Self>) -> Result<()> {
        messages::listen();
        self.is_open = false;
        // SAFETY: the data set is open, and so is its transaction.
        let ended = unsafe { gdal_sys::GDALDatasetCommitTransaction(self.dataset.c_dataset()) };
        match ended == gdal_sys::OGRErr::OGRERR_NONE {
            true => Ok(()),
            false => Err(self.refused("the transaction cannot be ended")),
        }
    }
}

#[allow(unsafe_code)]
impl Drop for PendingTable {
    fn drop(&mut self) {
        if self.is_open {
            // SAFETY: the data set is open, and so is its transaction.
            unsafe { gdal_sys::GDALDatasetRollbackTransaction(self.dataset.c_dataset()) };
        }
    }
}
