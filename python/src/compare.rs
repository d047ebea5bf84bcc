//! The difference of two surfaces.

use std::path::PathBuf;

use breakline::run::{self, CompareOptions};
use pyo3::prelude::*;

use crate::arrays::table;
use crate::errors::Result;
use crate::requests::{self, FrameArguments};
use crate::surface::{Raster, Surface, raster_of};
use crate::work::{self, Call};

/// The cells, how many are on both surfaces, their statistics, the worst places, and how many cells
/// are higher and lower by more than a height.
type Compared<'py> = (
    Raster<'py>,
    usize,
    [f64; 9],
    Bound<'py, PyAny>,
    Option<(usize, usize)>,
);

/// Compares two surfaces in cells.
#[pyfunction]
pub(crate) fn compare<'py>(
    py: Python<'py>,
    first: PyRef<'py, Surface>,
    second: PyRef<'py, Surface>,
    frame: FrameArguments,
    method: &str,
    worst: usize,
    changed: Option<f64>,
    names: [PathBuf; 2],
    call: Call,
) -> PyResult<Compared<'py>> {
    let options = CompareOptions {
        frame: frame.options()?,
        method: requests::method(method)?,
        worst,
        names,
    };
    let changed = requests::positive("changed", changed)?;
    let surfaces = [first.product(), second.product()];
    let product = work::run(py, &call, |context| -> Result<_> {
        Ok(run::compare(
            [&surfaces[0], &surfaces[1]],
            &options,
            context,
        )?)
    })?;
    let extremes = product.worst.iter();
    let extremes = extremes.map(|extreme| [extreme.at[0], extreme.at[1], extreme.value]);
    let numbers = product
        .statistics
        .map_or([f64::NAN; 9], |statistics| statistics.values());
    let counts = changed.map(|height| product.changed(height).into());
    let grid = &product.difference;
    let cells: Vec<f32> = grid.values.iter().map(|&d| d as f32).collect();
    let count = product.statistics.map_or(0, |statistics| statistics.count);
    Ok((
        raster_of(py, &grid.frame, cells, grid.crs.as_ref())?,
        count,
        numbers,
        table(py, extremes.collect())?,
        counts,
    ))
}
