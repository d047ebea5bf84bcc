//! Cut and fill between surfaces.

use std::path::PathBuf;

use breakline::run::{self, Bulking, VolumeBase, VolumeOptions, VolumeRow, VolumeUnit};
use pyo3::prelude::*;

use crate::errors::Result;
use crate::requests::{self, LayerInput};
use crate::surface::Surface;
use crate::work::{self, Call};

/// The record of the polygon, the level of the base, the volumes and areas, and what is moved, in
/// the order of the fields in Python; then the name of the polygon and its area.
type Row = (
    Option<usize>,
    Option<f64>,
    [f64; 10],
    [Option<f64>; 3],
    Option<String>,
    Option<f64>,
);

const UNITS: [(&str, VolumeUnit); 4] = [
    ("m3", VolumeUnit::CubicMeters),
    ("yd3", VolumeUnit::CubicYards),
    ("ft3", VolumeUnit::CubicFeet),
    ("acre-ft", VolumeUnit::AcreFeet),
];

/// Returns the volumes between a surface and its base, and their unit. The base is a second
/// surface, or levels, or, if there are neither, the rim of the polygons.
#[pyfunction]
pub(crate) fn volume(
    py: Python<'_>,
    surface: PyRef<'_, Surface>,
    base: Option<PyRef<'_, Surface>>,
    levels: Option<Vec<f64>>,
    within: Option<LayerInput<'_>>,
    name_by: Option<String>,
    assign: Option<&str>,
    unit: Option<&str>,
    bulking: Option<[f64; 2]>,
    names: [PathBuf; 2],
    call: Call,
) -> PyResult<(Vec<Row>, Option<&'static str>)> {
    let options = VolumeOptions {
        within: within.map(|layer| requests::layer(&layer)).transpose()?,
        name_by,
        assign: requests::crs(assign)?,
        unit: unit
            .map(|name| requests::choose("unit", name, &UNITS))
            .transpose()?,
        bulking: bulking.map(|[swell, shrink]| Bulking { swell, shrink }),
        names,
    };
    let (surface, other) = (surface.product(), base.map(|base| base.product()));
    let product = work::run(py, &call, |context| -> Result<_> {
        let base = match (&other, &levels) {
            (Some(base), _) => VolumeBase::Surface(base),
            (None, Some(levels)) => VolumeBase::Levels(levels),
            (None, None) => VolumeBase::Rim,
        };
        Ok(run::volume(&surface, base, &options, context)?)
    })?;
    let unit = product.unit.map(|unit| unit.symbols()[0]);
    Ok((product.rows.iter().map(row).collect(), unit))
}

fn row(row: &VolumeRow) -> Row {
    let of = &row.volume;
    let numbers = [
        of.cut,
        of.fill,
        of.net(),
        of.cut_area,
        of.fill_area,
        of.level_area(),
        of.common_area,
        of.surface_only_area,
        of.base_only_area,
        of.slope_area,
    ];
    let moved = row.earthwork.map(|e| [e.loose_cut, e.bank_fill, e.balance]);
    let moved = moved.map_or([None; 3], |numbers| numbers.map(Some));
    (
        row.record,
        row.level,
        numbers,
        moved,
        row.name.clone(),
        row.polygon_area,
    )
}
