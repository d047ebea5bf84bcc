//! The difference of two surfaces.

use std::path::PathBuf;

use breakline::run::{self, AreaOptions, CompareOptions};
use breakline::terrain::ChangedArea;
use pyo3::prelude::*;

use crate::arrays::table;
use crate::errors::Result;
use crate::requests::{self, FrameArguments};
use crate::surface::{Raster, Surface, raster_of};
use crate::work::{self, Call};

/// An area that differs: true if it is raised, its rings, its area and volume, the largest
/// difference and where it is.
type Area<'py> = (bool, Vec<Bound<'py, PyAny>>, [f64; 5]);

/// The cells, how many are on both surfaces, their statistics, the worst places, how many cells are
/// higher and lower by more than a height, and the areas that are, with the unit of volumes and the
/// number of those that were left out.
type Compared<'py> = (
    Raster<'py>,
    usize,
    [f64; 9],
    Bound<'py, PyAny>,
    Option<(usize, usize)>,
    Option<(Vec<Area<'py>>, Option<&'static str>, usize)>,
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
    min_area: Option<f64>,
    names: [PathBuf; 2],
    call: Call,
) -> PyResult<Compared<'py>> {
    let changed = requests::positive("changed", changed)?;
    let options = CompareOptions {
        frame: frame.options()?,
        method: requests::method(method)?,
        worst,
        areas: changed
            .zip(min_area)
            .map(|(height, min_area)| AreaOptions { height, min_area }),
        names,
    };
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
    let numbers = product.statistics.values();
    let counts = changed.map(|height| product.changed(height).into());
    let areas = product.areas.as_ref().map(|found| -> PyResult<_> {
        let area = |of: &ChangedArea| -> PyResult<Area<'py>> {
            let rings = of.rings.iter().map(|ring| table(py, ring.clone()));
            let [x, y] = of.at;
            let numbers = [of.area, of.volume, of.largest, x, y];
            Ok((of.is_raised(), rings.collect::<PyResult<_>>()?, numbers))
        };
        let areas = found.areas.iter().map(area).collect::<PyResult<_>>()?;
        let unit = found.unit.map(|unit| unit.symbols()[0]);
        Ok((areas, unit, found.left_out))
    });
    let grid = &product.difference;
    let cells: Vec<f32> = grid.values.iter().map(|&d| d as f32).collect();
    Ok((
        raster_of(py, &grid.frame, cells, grid.crs.as_ref())?,
        product.statistics.count,
        numbers,
        table(py, extremes.collect())?,
        counts,
        areas.transpose()?,
    ))
}
