//! The accuracy of surfaces, by checkpoints.

use std::path::PathBuf;

use breakline::run::{self, AccuracyOptions, AccuracyProduct, HeightMeasure, SetAccuracy};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::errors::{self, Result};
use crate::requests::{self, PointInput, ReadArguments};
use crate::surface::Surface;
use crate::work::{self, Call};

/// A set of checkpoints, its group, their number, and the statistics and the accuracy in the order
/// of the fields in Python.
type Set = (&'static str, Option<String>, usize, Vec<f64>);

/// A difference of heights: a number in the unit of the data, or a text with a unit.
#[derive(FromPyObject)]
pub(crate) enum Measure {
    Number(f64),
    Text(String),
}

impl Measure {
    fn read(&self, parameter: &str) -> PyResult<HeightMeasure> {
        let text = match self {
            Measure::Number(number) => number.to_string(),
            Measure::Text(text) => text.clone(),
        };
        text.parse().map_err(|why: String| {
            errors::usage(
                &format!("{parameter}: {why}"),
                &format!("'{text}'"),
                "pass a number in the unit of the heights, or a text such as '10cm'",
            )
        })
    }
}

/// Returns the accuracy of a surface: sets, decision, histogram, and columns of checkpoints.
#[pyfunction]
pub(crate) fn accuracy<'py>(
    py: Python<'py>,
    surface: PyRef<'_, Surface>,
    checkpoints: PointInput<'py>,
    read: ReadArguments,
    assign: Option<&str>,
    groups: (Option<String>, Vec<String>, Vec<String>),
    class: Option<Measure>,
    checkpoint_error: Option<Measure>,
    method: &str,
    name: PathBuf,
    call: Call,
) -> PyResult<Bound<'py, PyDict>> {
    let (group_by, labels, vegetated) = groups;
    let measure = |parameter: &str, given: Option<Measure>| {
        given.map(|measure| measure.read(parameter)).transpose()
    };
    let options = AccuracyOptions {
        read: read.options()?,
        assign: requests::crs(assign)?,
        group_by,
        groups: labels,
        vegetated,
        class: measure("accuracy_class", class)?,
        checkpoint_error: measure("checkpoint_error", checkpoint_error)?,
        method: requests::method(method)?,
        surface: name,
    };
    let mut inputs = requests::point_inputs(&[checkpoints])?;
    let Some(points) = inputs.pop() else {
        return Err(errors::usage("no checkpoints", "", "pass points"));
    };
    let surface = surface.product();
    let product = work::run(py, &call, |context| -> Result<_> {
        Ok(run::accuracy(&surface, &points, &options, context)?)
    })?;
    report(py, &product)
}

fn report<'py>(py: Python<'py>, product: &AccuracyProduct) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    let sets: Vec<Set> = product.sets.iter().map(set).collect();
    found.set_item("sets", sets)?;
    let decision = product.decision.as_ref();
    found.set_item("limit", decision.map(|decision| decision.limit))?;
    found.set_item("is_met", decision.map(|decision| decision.is_met()))?;
    found.set_item("decisive", decision.map(|decision| decision.set.kind()))?;
    found.set_item("checkpoint_error", product.checkpoint_error)?;
    found.set_item("unit", product.unit.as_ref().map(|unit| &unit.name))?;
    let histogram = product.histogram.as_ref();
    found.set_item(
        "histogram",
        histogram.map(|bins| (bins.start, bins.width, bins.counts.clone())),
    )?;
    let rows = &product.rows;
    let numbers: Vec<u64> = rows.iter().map(|row| row.number).collect();
    found.set_item("number", PyArray1::from_vec(py, numbers))?;
    let column = |of: &dyn Fn(&run::CheckpointRow) -> f64| {
        arrays::column(py, rows.iter().map(of).collect::<Vec<f64>>())
    };
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        found.set_item(name, column(&|row| row.point[axis]))?;
    }
    found.set_item("surface_z", column(&|row| row.surface))?;
    found.set_item("difference", column(&run::CheckpointRow::difference))?;
    let groups: Vec<Option<&str>> = rows.iter().map(|row| row.group.as_deref()).collect();
    found.set_item("group", groups)?;
    Ok(found)
}

fn set(accuracy: &SetAccuracy) -> Set {
    let statistics = &accuracy.statistics;
    let numbers = statistics.values().into_iter().chain([accuracy.rmse]);
    (
        accuracy.set.kind(),
        accuracy.set.group().map(str::to_owned),
        statistics.count,
        numbers.collect(),
    )
}
