//! The ground among points, of arrays and of files.

use std::path::PathBuf;

use breakline::run::{self, Existing, GroundFile, GroundRequest};
use breakline::terrain::ground::{Bridges, GroundOptions};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::Result;
use crate::requests::{self, choose};
use crate::work::{self, Call};
use crate::{arrays, notices};

/// How the ground is found, under the names in Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct GroundArguments {
    bridges: String,
    noise: bool,
    crs: Option<String>,
}

impl GroundArguments {
    fn options(&self) -> PyResult<GroundOptions> {
        let known = [("off", Bridges::OffGround), ("ground", Bridges::Ground)];
        Ok(GroundOptions {
            bridges: choose("bridges", &self.bridges, &known)?,
            noise: self.noise,
            ..GroundOptions::default()
        })
    }
}

/// Returns the class of each point.
#[pyfunction]
pub(crate) fn ground_classes<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    ground: GroundArguments,
    call: Call,
) -> PyResult<Bound<'py, PyAny>> {
    let (options, crs) = (ground.options()?, requests::crs(ground.crs.as_deref())?);
    let points = arrays::points::<3>(&points);
    let classes = work::run(py, &call, |context| -> Result<_> {
        Ok(run::ground_classes(
            &points,
            crs.as_ref(),
            &options,
            context,
        )?)
    })?;
    let classes: Vec<u8> = classes.into_iter().map(run::class_number).collect();
    Ok(arrays::column(py, classes).into_any())
}

/// Writes files with the classes of the ground; returns their counts.
#[pyfunction]
pub(crate) fn write_ground<'py>(
    py: Python<'py>,
    files: Vec<PathBuf>,
    chosen: (Option<Vec<u8>>, Option<Vec<String>>),
    ground: GroundArguments,
    output: (PathBuf, bool, Option<String>),
    call: Call,
) -> PyResult<Bound<'py, PyDict>> {
    let (from_classes, returns) = chosen;
    let (output, overwrite, memory) = output;
    let request = GroundRequest {
        files,
        from_classes: from_classes.unwrap_or_default(),
        returns: requests::returns_of(returns.as_deref())?,
        options: ground.options()?,
        memory: memory.as_deref().map(requests::memory).transpose()?,
        crs: requests::crs(ground.crs.as_deref())?,
    };
    let report = work::run(py, &call, |context| -> Result<_> {
        let existing = Existing::of(overwrite);
        Ok(run::write_ground(&request, &output, existing, context)?)
    })?;
    let files: Vec<Bound<'py, PyDict>> = report
        .files
        .iter()
        .map(|file| counts(py, file))
        .collect::<PyResult<_>>()?;
    let found = PyDict::new(py);
    found.set_item("files", files)?;
    found.set_item("notices", notices::pairs(&report.notices))?;
    Ok(found)
}

/// Returns the counts of a file.
fn counts<'py>(py: Python<'py>, file: &GroundFile) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    found.set_item("path", &file.path)?;
    found.set_item("output", &file.output)?;
    found.set_item("points", file.points())?;
    found.set_item("filtered", file.filtered)?;
    found.set_item("before", &file.before)?;
    found.set_item("after", &file.after)?;
    Ok(found)
}
