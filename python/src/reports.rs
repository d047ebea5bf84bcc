//! Reports as dictionaries.

use breakline::data::SurfaceFacts;
use breakline::run::{BuildReport, SurfaceProduct};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::errors::Result;
use crate::{names, work};

/// Returns the counts of a surface and, if it was built here, of how.
pub(crate) fn of_surface<'py>(
    py: Python<'py>,
    product: &SurfaceProduct,
) -> PyResult<Bound<'py, PyDict>> {
    let report = PyDict::new(py);
    if product.triangles().is_err() {
        return Ok(report);
    }
    let facts = work::short(py, || -> Result<_> { Ok(product.facts()?) })?;
    let SurfaceFacts {
        vertices,
        triangles,
        edges,
        extent,
    } = facts;
    report.set_item("vertices", vertices)?;
    report.set_item("triangles", triangles)?;
    let kinds = PyDict::new(py);
    for (kind, count) in edges.kinds() {
        kinds.set_item(format!("{kind:?}").to_lowercase(), count)?;
    }
    report.set_item("edges", kinds)?;
    report.set_item("min", extent.min)?;
    report.set_item("max", extent.max)?;
    if let Some(built) = &product.built {
        of_building(&report, built)?;
    }
    Ok(report)
}

/// Adds the counts of how a TIN was built.
pub(crate) fn of_building(report: &Bound<'_, PyDict>, built: &BuildReport) -> PyResult<()> {
    let py = report.py();
    let (points, tin) = (&built.points, &built.tin);
    report.set_item("sources", built.sources)?;
    for (name, count) in [
        ("points_read", points.read),
        ("points_used", points.used),
        ("points_withheld", points.withheld),
        ("points_of_other_classes", points.other_class),
        ("points_of_other_returns", points.other_return),
        ("points_outside", points.outside),
        ("points_without_class", points.without_class),
    ] {
        report.set_item(name, count)?;
    }
    let classes = PyDict::new(py);
    for (class, count) in &points.by_class {
        classes.set_item(class, count)?;
    }
    report.set_item("points_by_class", classes)?;
    report.set_item(
        "classes_used",
        points
            .classes
            .as_ref()
            .map(|classes| PyList::new(py, classes))
            .transpose()?,
    )?;
    for (name, count) in [
        ("duplicates", tin.duplicates),
        ("points_replaced", tin.points_replaced),
        ("points_on_breaklines", tin.points_on_breaklines),
        ("breaklines", tin.breaklines),
        ("breakline_vertices", tin.breakline_vertices),
        ("crossings", tin.crossings),
        ("triangles_beyond_max_edge", tin.faces_beyond_max_edge),
        (
            "triangles_beyond_max_edge_inside",
            tin.faces_with_long_edges,
        ),
        ("triangles_clipped", tin.faces_clipped),
        ("triangles_cut", tin.faces_cut),
        ("vertices_clipped", tin.vertices_clipped),
        ("vertices_cut", tin.vertices_cut),
    ] {
        report.set_item(name, count)?;
    }
    report.set_item("lines", lines(py, built)?)?;
    report.set_item("crossing_heights", crossing_heights(py, built)?)?;
    report.set_item("water_overlaps", water_overlaps(py, built)?)
}

/// Returns the inputs of lines and areas, with their counts.
fn lines<'py>(py: Python<'py>, built: &BuildReport) -> PyResult<Bound<'py, PyList>> {
    let lines = PyList::empty(py);
    for input in &built.lines {
        let line = PyDict::new(py);
        line.set_item("parameter", names::parameter(input.role.setting()))?;
        line.set_item("file", input.path.as_os_str())?;
        line.set_item("lines", input.lines)?;
        line.set_item("edges", input.edges)?;
        lines.append(line)?;
    }
    Ok(lines)
}

/// Returns where breaklines meet with different heights.
fn crossing_heights<'py>(py: Python<'py>, built: &BuildReport) -> PyResult<Bound<'py, PyList>> {
    let differing = PyList::empty(py);
    for crossing in &built.tin.crossing_heights {
        let found = PyDict::new(py);
        found.set_item("at", crossing.site)?;
        found.set_item("height", crossing.chosen)?;
        let heights = crossing
            .heights
            .iter()
            .map(|&(line, height)| (built.line_names.name(line), height));
        found.set_item("lines", heights.collect::<Vec<_>>())?;
        differing.append(found)?;
    }
    Ok(differing)
}

/// Returns the steps between waters that overlap or touch.
fn water_overlaps<'py>(py: Python<'py>, built: &BuildReport) -> PyResult<Bound<'py, PyList>> {
    let overlaps = PyList::empty(py);
    for overlap in &built.tin.water_overlaps {
        let found = PyDict::new(py);
        found.set_item("at", overlap.at)?;
        found.set_item("step", overlap.step)?;
        found.set_item(
            "lines",
            overlap.lines.map(|line| built.line_names.name(line)),
        )?;
        overlaps.append(found)?;
    }
    Ok(overlaps)
}
