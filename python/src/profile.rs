//! Heights along lines, and lines with heights.

use std::path::{Path, PathBuf};

use breakline::data::{Profile, Shape, Stretch};
use breakline::io::OutputSet;
use breakline::io::profiles::PlotOptions;
use breakline::run::{
    self, DrapeOptions, ProfileOptions, SectionOptions, SectionStations, StationFormat,
};
use pyo3::prelude::*;

use crate::arrays;
use crate::errors::{self, Result};
use crate::requests::{self, LayerInput};
use crate::surface::{Surface, require_free};
use crate::work::{self, Call};

/// An array of numbers.
type Array<'py> = Bound<'py, PyAny>;

/// A profile in Python: its record and part, its station as a number and as text, the distances at
/// which it starts and ends, and for each surface its stretches: rows of distance, x, y and z.
type Row<'py> = (
    usize,
    Option<usize>,
    Option<f64>,
    Option<String>,
    [f64; 2],
    Vec<Vec<Array<'py>>>,
);

/// Profiles in Python: what each is, what the surfaces are called, and the units of distances and
/// heights.
type Found<'py> = (Vec<Row<'py>>, Vec<String>, [Option<String>; 2]);

/// Sections in Python: an interval, or stations; the station at the start, the lengths to the left
/// and to the right, the angle, and an example of a station.
type Sections = (Option<f64>, Vec<f64>, f64, [f64; 2], f64, String);

/// A plot in Python: its exaggeration, datum and title.
type Plot = (Option<f64>, Option<f64>, Option<String>);

/// Returns the profiles of surfaces along lines, what the surfaces are called, and the units of
/// distances and heights. Writes them to files, unless there are any that must be kept.
#[pyfunction]
pub(crate) fn profile<'py>(
    py: Python<'py>,
    surfaces: Vec<PyRef<'py, Surface>>,
    along: LayerInput<'py>,
    assign: Option<&str>,
    step: Option<f64>,
    sections: Option<Sections>,
    plot: Plot,
    names: Vec<PathBuf>,
    output: (Vec<PathBuf>, bool),
    call: Call,
) -> PyResult<Found<'py>> {
    let options = ProfileOptions {
        along: requests::layer(&along)?,
        assign: requests::crs(assign)?,
        step,
        sections: sections.map(section_options).transpose()?,
        names,
    };
    let (exaggeration, datum, title) = plot;
    let plot = PlotOptions {
        exaggeration,
        datum,
        title,
    };
    let products: Vec<_> = surfaces.iter().map(|surface| surface.product()).collect();
    let product = work::run(py, &call, |context| -> Result<_> {
        check_free(&output)?;
        let surfaces: Vec<_> = products.iter().map(|product| &**product).collect();
        let product = run::profile(&surfaces, &options, context)?;
        let set = OutputSet::default();
        for file in &output.0 {
            product.write(set.at(file), &plot)?;
        }
        set.commit()?;
        Ok(product)
    })?;
    let found = product.profiles;
    let rows = found.list.into_iter().map(|profile| row(py, profile));
    Ok((rows.collect::<PyResult<_>>()?, found.surfaces, found.units))
}

fn section_options(
    (interval, stations, start, widths, angle, format): Sections,
) -> PyResult<SectionOptions> {
    let format = format.parse::<StationFormat>().map_err(|text| {
        errors::usage(
            "station_format is not an example",
            &text,
            "use one such as 0+000",
        )
    })?;
    Ok(SectionOptions {
        at: interval.map_or(SectionStations::At(stations), SectionStations::Every),
        start,
        widths,
        angle,
        format,
    })
}

fn row(py: Python<'_>, profile: Profile) -> PyResult<Row<'_>> {
    let array = |stretch: Stretch| {
        let rows = stretch.into_iter().map(|p| {
            let [x, y, z] = p.at;
            [p.along, x, y, z]
        });
        arrays::table(py, rows.collect())
    };
    let stretches = profile.stretches.into_iter();
    let stretches = stretches.map(|of| of.into_iter().map(array).collect());
    let (at, text) = profile
        .station
        .map(|station| (station.at, station.text))
        .unzip();
    Ok((
        profile.record,
        profile.part,
        at,
        text,
        profile.range,
        stretches.collect::<PyResult<_>>()?,
    ))
}

/// Returns the parts of each record's lines on a surface, with its heights. Writes them to files,
/// unless there are any that must be kept.
#[pyfunction]
pub(crate) fn drape<'py>(
    py: Python<'py>,
    surface: PyRef<'py, Surface>,
    lines: LayerInput<'py>,
    assign: Option<&str>,
    step: Option<f64>,
    name: PathBuf,
    output: (Vec<PathBuf>, bool),
    call: Call,
) -> PyResult<Vec<Vec<Array<'py>>>> {
    let options = DrapeOptions {
        lines: requests::layer(&lines)?,
        assign: requests::crs(assign)?,
        step,
        name,
    };
    let surface = surface.product();
    let product = work::run(py, &call, |context| -> Result<_> {
        check_free(&output)?;
        let product = run::drape(&surface, &options, context)?;
        let set = OutputSet::default();
        for file in &output.0 {
            product.write(set.at(file), context)?;
        }
        set.commit()?;
        Ok(product)
    })?;
    let array = |points: Vec<[f64; 3]>| arrays::table(py, points);
    let record = |shape| match shape {
        Shape::Lines(parts) => parts.into_iter().map(array).collect(),
        _ => Ok(Vec::new()),
    };
    product.layer.shapes.into_iter().map(record).collect()
}

/// Returns an error if one of the files to write exists and must be kept.
fn check_free((files, overwrite): &(Vec<PathBuf>, bool)) -> Result<()> {
    let mut files = files.iter().map(PathBuf::as_path).filter(|_| !overwrite);
    files.try_for_each(|file: &Path| require_free(file))
}
