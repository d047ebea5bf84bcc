//! Points of a file, with all that it has, to which values are added.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::options::{SampleOptions, SampleTarget};
use super::values::Values;
use crate::crs::Crs;
use crate::data::{Columns, PointBatch, PointInfo, PointSource, Shape};
use crate::error::{Error, Result};
use crate::io::geojson::PointFeatures;
use crate::io::las::{self, Detail, Rounding};
use crate::io::points::{self, Options};
use crate::io::text::Axes;
use crate::io::text::table::{self, Fields, TableBatch, TextTable};
use crate::io::{Destination, OnDamage, shapefile};
use crate::run::context::Journal;
use crate::run::request::input::is_read_once;
use crate::run::sources::open::{self, Content, content, is_lidar};
use crate::run::sources::systems::{Role, Stated};

/// Points of a format whose other contents can be kept.
pub(super) enum Source {
    Text(Box<TextTable>),
    Lidar(Box<PointInfo>, Box<dyn PointSource + Send>),
    Shapefile {
        path: PathBuf,
        system: System,
        /// x and y of each record; NaN of one without a point.
        positions: Vec<[f64; 2]>,
    },
    GeoJson {
        system: System,
        features: PointFeatures,
    },
}

/// The coordinate system of a layer, and what it states if that is not understood.
type System = (Option<Crs>, Option<String>);

impl Source {
    /// Opens a file, to which columns with these names are added.
    pub(super) fn open(
        path: &Path,
        options: &SampleOptions,
        names: &[String],
        journal: &Journal,
    ) -> Result<Self> {
        if !is_read_once(path) && is_lidar(path) {
            return Self::of_lidar(path, options, names, journal);
        }
        options
            .require_no_heights()
            .map_err(|error| error.in_file(path))?;
        if is_read_once(path) {
            return Self::of_text(path, options);
        }
        if content(path) != Content::Layer {
            return Self::of_text(path, options);
        }
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        match extension.to_str() {
            Some("shp") => Self::of_shapefile(path, options.read.cut, journal),
            Some("geojson" | "json") => Self::of_geojson(path, options.read.cut, names, journal),
            _ => Err(Error::unsupported(
                "values are added to points of text, LAS, LAZ, shapefiles and GeoJSON",
            )
            .in_file(path)
            .cure("save the points as one of these")),
        }
    }

    fn of_text(path: &Path, options: &SampleOptions) -> Result<Self> {
        let table = table::open(path, options.read, Axes::Plan)?;
        Ok(Source::Text(Box::new(table)))
    }

    fn of_lidar(
        path: &Path,
        options: &SampleOptions,
        names: &[String],
        journal: &Journal,
    ) -> Result<Self> {
        let options = Options {
            detail: Detail::Records,
            ..options.read
        };
        let source =
            open::points_of_file(path, options, &journal.context).map_err(|e| e.in_file(path))?;
        let mut info = source.info().clone();
        journal.add_warnings(path, &info.warnings);
        if let Some(head) = &mut info.head {
            las::add_numbers(head, names).map_err(|e| e.in_file(path))?;
        }
        Ok(Source::Lidar(Box::new(info), source))
    }

    fn of_shapefile(path: &Path, cut: OnDamage, journal: &Journal) -> Result<Self> {
        let layer = open::layer(path, &[], cut, &journal.context).map_err(|e| e.in_file(path))?;
        journal.add_warnings(path, &layer.warnings);
        let position = |(number, shape): (usize, &Shape)| match shape {
            Shape::Null => Ok([f64::NAN; 2]),
            Shape::Points(points) if points.len() == 1 => Ok([points[0][0], points[0][1]]),
            Shape::Points(_) | Shape::Lines(_) | Shape::Polygon(_) | Shape::Faces(_) => {
                Err(Error::unsupported("the shape is not one point")
                    .at(format!("record {number}"))
                    .in_file(path)
                    .cure("a value is added to each record: save one point in each"))
            }
        };
        Ok(Source::Shapefile {
            path: path.to_path_buf(),
            positions: (1..)
                .zip(&layer.shapes)
                .map(position)
                .collect::<Result<_>>()?,
            system: (layer.crs, layer.unread_crs),
        })
    }

    fn of_geojson(path: &Path, cut: OnDamage, names: &[String], journal: &Journal) -> Result<Self> {
        let layer = open::layer(path, &[], cut, &journal.context).map_err(|e| e.in_file(path))?;
        journal.add_warnings(path, &layer.warnings);
        let text = std::fs::read(path).map_err(|e| Error::from(e).in_file(path))?;
        let features = PointFeatures::read(text, names).map_err(|e| e.in_file(path))?;
        Ok(Source::GeoJson {
            system: (layer.crs, layer.unread_crs),
            features,
        })
    }

    /// Returns the coordinate system that the file states.
    pub(super) fn stated(&self, path: &Path) -> Stated {
        let (crs, unread) = match self {
            Source::Text(_) => (None, None),
            Source::Lidar(info, _) => (info.crs.clone(), info.unread_crs.clone()),
            Source::Shapefile { system, .. } | Source::GeoJson { system, .. } => system.clone(),
        };
        Stated {
            path: path.to_path_buf(),
            crs,
            unread,
            role: Role::Ground,
        }
    }

    /// Returns the columns of x and y of text.
    pub(super) fn columns(&self) -> Option<Columns> {
        match self {
            Source::Text(table) => Some(table.columns()),
            Source::Lidar(..) | Source::Shapefile { .. } | Source::GeoJson { .. } => None,
        }
    }

    /// Writes the points with what is added to them.
    pub(super) fn write(
        self,
        names: &[String],
        values: &mut Values,
        target: SampleTarget,
    ) -> Result<()> {
        self.check(&target)?;
        let kind = self.kind();
        match (self, target) {
            (Source::Text(mut table), SampleTarget::Stream(out)) => {
                write_text(&mut table, names, values, out)
            }
            (Source::Text(mut table), SampleTarget::File(target)) => {
                let mut out = target.create()?;
                write_text(&mut table, names, values, &mut out)?;
                target.put(out)
            }
            (Source::GeoJson { features, .. }, target) => {
                let numbers = values.at(&features.positions(), &[])?;
                values.require_any()?;
                let text = features.with_numbers(names, &numbers);
                match target {
                    SampleTarget::Stream(out) => Ok(out.write_all(&text)?),
                    SampleTarget::File(target) => target.write_with(|out| out.write_all(&text)),
                }
            }
            (Source::Lidar(info, source), SampleTarget::File(target)) => {
                write_lidar(&info, source, names, values, target)
            }
            (
                Source::Shapefile {
                    path, positions, ..
                },
                SampleTarget::File(target),
            ) => {
                let numbers = values.at(&positions, &[])?;
                values.require_any()?;
                shapefile::append_fields(&path, positions.len(), names, &numbers, target)
            }
            (Source::Lidar(..) | Source::Shapefile { .. }, SampleTarget::Stream(_)) => Err(
                Error::usage(format!("{kind} cannot be written to a stream"))
                    .cure("name a file for the output"),
            ),
        }
    }

    fn kind(&self) -> &'static str {
        match self {
            Source::Text(_) => "text",
            Source::Lidar(..) => "LAS",
            Source::Shapefile { .. } => "a shapefile",
            Source::GeoJson { .. } => "GeoJSON",
        }
    }

    /// Returns the extensions of the format, without their dots.
    fn extensions(&self) -> &'static [&'static str] {
        match self {
            Source::Text(_) => &["csv", "txt", "xyz"],
            Source::Lidar(..) => &["las", "laz"],
            Source::Shapefile { .. } => &["shp"],
            Source::GeoJson { .. } => &["geojson", "json"],
        }
    }

    /// Returns an error if an output has the extension of another format.
    fn check(&self, target: &SampleTarget) -> Result<()> {
        let SampleTarget::File(target) = target else {
            return Ok(());
        };
        let path = target.format_path();
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        let known = self.extensions();
        match known.iter().any(|known| extension == **known) {
            true => Ok(()),
            false => Err(Error::usage(format!(
                "the points are {}, and are written as .{}",
                self.kind(),
                known.join(" or .")
            ))
            .in_file(target.path())),
        }
    }
}

fn write_text(
    table: &mut TextTable,
    names: &[String],
    values: &mut Values,
    out: &mut dyn Write,
) -> Result<()> {
    let writer = table.writer(names)?;
    let mut batch = TableBatch::default();
    loop {
        table.read(&mut batch)?;
        if batch.is_empty() {
            values.journal.add_warnings(values.file, table.warnings());
            return values.require_any();
        }
        let mut fields = Fields::new(table.has_decimal_commas());
        let numbers = values.at(&batch.positions, &[])?;
        numbers.into_iter().for_each(|number| fields.push(number));
        writer.write(&batch, &fields, out)?;
    }
}

fn write_lidar(
    info: &PointInfo,
    mut source: Box<dyn PointSource + Send>,
    names: &[String],
    values: &mut Values,
    target: Destination,
) -> Result<()> {
    // What is refused is in the points, unless the error names the output.
    let mut sink =
        points::create(target, &[info], Rounding::Refuse).map_err(|e| e.in_file(values.file))?;
    sink.next_source(info).map_err(|e| e.in_file(values.file))?;
    let mut batch = PointBatch::default();
    loop {
        source
            .read(&mut batch)
            .map_err(|e| e.in_file(values.file))?;
        if batch.is_empty() {
            break;
        }
        let positions = batch.x.iter().zip(&batch.y).map(|(&x, &y)| [x, y]);
        let positions: Vec<[f64; 2]> = positions.collect();
        let numbers = values.at(&positions, &batch.z)?;
        las::append_numbers(&mut batch, &numbers, names.len());
        sink.write(&batch)?;
    }
    values.journal.add_warnings(values.file, source.warnings());
    values.require_any()?;
    sink.finish().map(drop)
}
