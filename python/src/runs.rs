//! Several products of one surface.

use std::path::PathBuf;

use breakline::cli::{RunOptions, RunTables, run_products};
use pyo3::prelude::*;

use crate::errors::Result;
use crate::requests;
use crate::work::{self, Call};

/// Makes the products of a run file, or of its tables as JSON; returns their report as JSON.
#[pyfunction]
pub(crate) fn run(
    py: Python<'_>,
    file: Option<PathBuf>,
    tables: Option<String>,
    overwrite: bool,
    memory: Option<String>,
    dry_run: bool,
    call: Call,
) -> PyResult<String> {
    let options = RunOptions {
        overwrite,
        memory: memory.as_deref().map(requests::memory).transpose()?,
        dry_run,
    };
    work::run_alone(py, &call, |context| -> Result<_> {
        let tables = match (&file, &tables) {
            (Some(file), _) => RunTables::File(file),
            (None, tables) => RunTables::Json(tables.as_deref().unwrap_or_default()),
        };
        Ok(run_products(tables, &options, context)?)
    })
}
