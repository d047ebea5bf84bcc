//! Verbs from files to files or arrays: `info`, `points`, `triangulate`.

use std::path::PathBuf;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};

use breakline::data::classes;
use breakline::io::las::Rounding;
use breakline::io::{Destination, formats};
use breakline::run::proj::TransformOptions;
use breakline::run::{
    self, Alpha, Arithmetic, Existing, PlanLength, PointTiles, PointsReport, PointsRequest,
    SpaceOptions, TriangulateOptions, Withheld,
};
use breakline::{Error, cli, io};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::errors::{self, Failure, Result};
use crate::notices;
use crate::requests::{self, NumberOrName, ReadArguments, SystemArguments, bounds, choose};
use crate::surface::write_to;
use crate::work::{self, Call, POLL};

/// The stack of the program's thread: that of a main thread.
const STACK: usize = 8 << 20;

/// Returns what is in a file as JSON, and its warnings.
#[pyfunction]
pub(crate) fn info(
    py: Python<'_>,
    file: PathBuf,
    read: ReadArguments,
    call: Call,
) -> PyResult<String> {
    let options = read.options()?;
    work::run(py, &call, |context| -> Result<_> {
        let facts = run::facts(&file, options, context).map_err(|e| e.in_file(&file))?;
        Ok(cli::facts_as_json(&file, &facts))
    })
}

/// Returns what a coordinate system is, or the operations from it to another, as JSON.
#[pyfunction]
pub(crate) fn crs(
    py: Python<'_>,
    from: String,
    to: Option<String>,
    at: Option<Vec<f64>>,
    options: (bool, Option<f64>),
    call: Call,
) -> PyResult<String> {
    let (require_grids, epoch) = options;
    let options = TransformOptions {
        require_grids,
        epoch,
    };
    work::run(py, &call, |context| -> Result<_> {
        Ok(cli::systems_as_json(
            &from,
            to.as_deref(),
            at.as_deref(),
            &options,
            context,
        )?)
    })
}

/// Returns the description of the program as JSON.
#[pyfunction]
pub(crate) fn describe() -> String {
    cli::description()
}

/// Runs the program with its arguments, the first of which is its name; returns the exit code.
///
/// After the exception of a signal handler the process should end: the program still works, but
/// none of its outputs appears.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, arguments: Vec<std::ffi::OsString>) -> PyResult<u8> {
    let (sender, receiver) = sync_channel(1);
    let program = std::thread::Builder::new().stack_size(STACK);
    program
        .spawn(move || sender.send(cli::run(arguments) as u8))
        .map_err(|e| Failure(e.into()))?;
    py.detach(move || {
        loop {
            match receiver.recv_timeout(POLL) {
                Ok(code) => return Ok(code),
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(error) = Python::attach(|py| py.check_signals()) {
                        std::mem::forget(io::abandon_outputs());
                        return Err(error);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(errors::internal(&"the program ended without a code"));
                }
            }
        }
    })
}

/// Options of selecting points, under the names that they have in Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct SelectionArguments {
    classes: Option<Vec<u8>>,
    returns: Option<Vec<String>>,
    drop_withheld: bool,
    bounds: Option<[f64; 4]>,
    boundary: Vec<PathBuf>,
    thin: Option<String>,
    thin_keep: Option<String>,
    seed: Option<u64>,
    round: bool,
}

impl SelectionArguments {
    fn request(
        self,
        files: Vec<PathBuf>,
        read: &ReadArguments,
        systems: &SystemArguments,
    ) -> PyResult<PointsRequest> {
        Ok(PointsRequest {
            files,
            read: read.options()?,
            classes: self.classes.unwrap_or_default(),
            returns: requests::returns_of(self.returns.as_deref())?,
            withheld: if self.drop_withheld {
                Withheld::Drop
            } else {
                Withheld::Keep
            },
            bounds: bounds(self.bounds),
            boundary: self.boundary,
            thinning: requests::thinning(
                self.thin.as_deref(),
                self.thin_keep.as_deref(),
                self.seed,
            )?,
            rounding: if self.round {
                Rounding::Nearest
            } else {
                Rounding::Refuse
            },
            systems: systems.options()?,
        })
    }
}

/// Returns the counts of points, as a dictionary.
fn report<'py>(py: Python<'py>, report: &PointsReport) -> PyResult<Bound<'py, PyDict>> {
    let counts = PyDict::new(py);
    for (name, count) in [
        ("read", report.read),
        ("written", report.written.count),
        ("withheld", report.withheld),
        ("of_other_classes", report.other_class),
        ("of_other_returns", report.other_return),
        ("outside", report.outside),
        ("thinned", report.thinned),
    ] {
        counts.set_item(name, count)?;
    }
    counts.set_item("min", report.written.bounds.min)?;
    counts.set_item("max", report.written.bounds.max)?;
    counts.set_item("notices", notices::pairs(&report.notices))?;
    Ok(counts)
}

/// Reads the selected points of files: columns, coordinate system as WKT, counts.
#[pyfunction]
pub(crate) fn read_points<'py>(
    py: Python<'py>,
    files: Vec<PathBuf>,
    read: ReadArguments,
    systems: SystemArguments,
    selection: SelectionArguments,
    call: Call,
) -> PyResult<Bound<'py, PyDict>> {
    let request = selection.request(files, &read, &systems)?;
    let product = work::run(py, &call, |context| -> Result<_> {
        Ok(run::read_points(&request, context)?)
    })?;
    let (points, found) = (product.points, PyDict::new(py));
    found.set_item("x", arrays::column(py, points.x))?;
    found.set_item("y", arrays::column(py, points.y))?;
    found.set_item("z", arrays::column(py, points.z))?;
    let optional = |column: Vec<u8>| (!column.is_empty()).then(|| arrays::column(py, column));
    found.set_item("classification", optional(points.class))?;
    found.set_item(
        "flags",
        optional(points.flags.into_iter().map(|flags| flags.0).collect()),
    )?;
    found.set_item("return_number", optional(points.return_number))?;
    found.set_item("number_of_returns", optional(points.return_count))?;
    found.set_item(
        "crs",
        product.report.crs.as_ref().map(breakline::crs::Crs::to_wkt),
    )?;
    found.set_item("report", report(py, &product.report)?)?;
    Ok(found)
}

/// Writes the selected points of files to a file; returns the counts.
#[pyfunction]
#[pyo3(signature = (files, read, systems, selection, output, tiles, overwrite, call))]
pub(crate) fn write_points<'py>(
    py: Python<'py>,
    files: Vec<PathBuf>,
    read: ReadArguments,
    systems: SystemArguments,
    selection: SelectionArguments,
    output: PathBuf,
    tiles: Option<(String, Option<String>, bool)>,
    overwrite: bool,
    call: Call,
) -> PyResult<Bound<'py, PyDict>> {
    let request = selection.request(files, &read, &systems)?;
    if let Some((size, buffer, flags_buffer)) = tiles {
        let tiles = PointTiles {
            folder: output,
            size: length("tile", &size)?,
            buffer: match buffer {
                Some(buffer) => length("buffer", &buffer)?,
                None => PlanLength::Units(0.0),
            },
            flags_buffer,
            existing: Existing::of(overwrite),
        };
        let (written, _) = work::run(py, &call, |context| -> Result<_> {
            Ok(run::write_point_tiles(&request, &tiles, context)?)
        })?;
        return report(py, &written);
    }
    let mut written = PointsReport::default();
    write_to(py, &output, overwrite, &call, |target, context| {
        written = run::write_points(&request, target, context)?;
        Ok(())
    })?;
    report(py, &written)
}

/// Returns a length, or an error that names the parameter.
fn length(parameter: &str, text: &str) -> PyResult<PlanLength> {
    let wrong = |error: String| Failure(Error::usage(format!("{parameter}: {text}: {error}")));
    Ok(text.parse::<PlanLength>().map_err(wrong)?)
}

const KERNELS: [(&str, Arithmetic); 3] = [
    ("adaptive", Arithmetic::Adaptive),
    ("exact", Arithmetic::Exact),
    ("fast", Arithmetic::Fast),
];

/// Options of triangulating in the plane, under the names that they have in Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct PlaneArguments {
    convex: bool,
    on_crossing: String,
    min_angle: Option<f64>,
    max_area: Option<f64>,
    region_areas: bool,
    max_added: Option<usize>,
    kernel: String,
}

/// Triangulates a `.node` or `.poly` file; writes files, if any, and returns arrays.
#[pyfunction]
pub(crate) fn triangulate<'py>(
    py: Python<'py>,
    file: PathBuf,
    options: PlaneArguments,
    outputs: Vec<PathBuf>,
    overwrite: bool,
    call: Call,
) -> PyResult<Bound<'py, PyDict>> {
    let options = TriangulateOptions {
        convex: options.convex,
        on_crossing: requests::on_crossing(&options.on_crossing)?,
        min_angle: options.min_angle,
        max_area: requests::positive("max_area", options.max_area)?,
        region_areas: options.region_areas,
        max_added: options.max_added,
        arithmetic: choose("kernel", &options.kernel, &KERNELS)?,
    };
    let product = work::run(py, &call, |context| -> Result<_> {
        refuse_existing(&outputs, overwrite)?;
        let product = run::triangulate(&file, &options, context)?;
        let (meshes, others) = split(&outputs);
        for mesh in meshes {
            run::write_mesh(&product.to_mesh()?, mesh, context)?;
        }
        product.write(&others, context)?;
        Ok(product)
    })?;
    let (triangulated, counts) = (product.triangulated, PyDict::new(py));
    let nodes = &triangulated.nodes;
    counts.set_item("vertices", arrays::table(py, nodes.points.clone())?)?;
    let markers: Vec<i64> = nodes
        .markers
        .iter()
        .map(|&marker| i64::from(marker))
        .collect();
    counts.set_item("vertex_markers", arrays::column(py, markers))?;
    counts.set_item(
        "triangles",
        arrays::table(py, signed(triangulated.triangles))?,
    )?;
    let segments = triangulated
        .segments
        .iter()
        .map(|segment| segment.ends)
        .collect();
    counts.set_item("segments", arrays::table(py, signed(segments))?)?;
    let report = product.report;
    for (name, count) in [
        ("vertices_given", report.vertices_given),
        ("vertices_at_crossings", report.vertices_at_crossings),
        ("vertices_for_quality", report.vertices_for_quality),
        ("duplicates", report.duplicates),
        ("segments_given", report.segments_given),
        ("triangles_built", report.triangles_built),
        ("triangles_not_as_requested", report.shortfall.len()),
    ] {
        counts.set_item(name, count)?;
    }
    Ok(counts)
}

/// Triangulates the points of a file in space; writes files, if any, and returns arrays.
#[pyfunction]
pub(crate) fn triangulate_space<'py>(
    py: Python<'py>,
    file: PathBuf,
    weighted: bool,
    alpha: Option<NumberOrName>,
    kernel: &str,
    outputs: Vec<PathBuf>,
    overwrite: bool,
    call: Call,
) -> PyResult<Bound<'py, PyDict>> {
    let alpha = match alpha {
        None => None,
        Some(NumberOrName::Number(alpha)) => {
            requests::positive("alpha", Some(alpha))?.map(Alpha::Given)
        }
        Some(NumberOrName::Name(name)) => {
            Some(choose("alpha", &name, &[("auto", Alpha::OneSolid)])?)
        }
    };
    let options = SpaceOptions {
        weighted,
        alpha,
        arithmetic: choose("kernel", kernel, &KERNELS)?,
    };
    let product = work::run(py, &call, |context| -> Result<_> {
        refuse_existing(&outputs, overwrite)?;
        let product = run::triangulate_space(&file, &options, context)?;
        let (meshes, others) = split(&outputs);
        for mesh in meshes {
            let path = mesh.path().to_path_buf();
            let solid = product.solid.as_ref().ok_or_else(|| {
                Error::usage("there is no alpha shape to write")
                    .in_file(path)
                    .cure("use alpha=\"auto\", or write .vtu")
            })?;
            run::write_mesh(solid, mesh, context)?;
        }
        product.write(&others, context)?;
        Ok(product)
    })?;
    let (report, found) = (product.report, PyDict::new(py));
    found.set_item(
        "vertices",
        arrays::table(py, product.triangulated.nodes.points)?,
    )?;
    found.set_item(
        "tetrahedra",
        arrays::table(py, signed(product.triangulated.tetrahedra))?,
    )?;
    for (name, count) in [
        ("points", report.points),
        ("duplicates", report.duplicates),
        ("hidden", report.hidden),
    ] {
        found.set_item(name, count)?;
    }
    found.set_item("dimension", report.dimension)?;
    found.set_item("volume", report.volume)?;
    if let Some(solid) = product.solid {
        let shape = PyDict::new(py);
        shape.set_item("is_manifold", solid.is_manifold())?;
        shape.set_item("alpha", solid.alpha)?;
        shape.set_item("parts", solid.parts)?;
        shape.set_item("volume", solid.volume)?;
        shape.set_item("triangles", arrays::table(py, signed(solid.triangles))?)?;
        found.set_item("solid", shape)?;
    }
    Ok(found)
}

/// Returns numbers with a sign, as numpy's index arrays have; no triangulation has more vertices.
fn signed<const N: usize>(rows: Vec<[u32; N]>) -> Vec<[i64; N]> {
    rows.into_iter().map(|row| row.map(i64::from)).collect()
}

fn refuse_existing(outputs: &[PathBuf], overwrite: bool) -> Result<()> {
    if !overwrite {
        outputs
            .iter()
            .try_for_each(|path| io::require_absent(path))?;
    }
    Ok(())
}

/// Separates outputs that are meshes from others.
fn split(outputs: &[PathBuf]) -> (Vec<Destination<'_>>, Vec<Destination<'_>>) {
    let is_mesh = |path: &&PathBuf| formats::for_output(path, formats::Product::Surface).is_some();
    let (meshes, others): (Vec<_>, Vec<_>) = outputs.iter().partition(is_mesh);
    (destinations(meshes), destinations(others))
}

fn destinations(paths: Vec<&PathBuf>) -> Vec<Destination<'_>> {
    paths
        .into_iter()
        .map(|path| path.as_path().into())
        .collect()
}

/// Checks tetrahedra; returns the flaws.
#[pyfunction]
pub(crate) fn check_space(
    py: Python<'_>,
    file: PathBuf,
    weighted: bool,
    call: Call,
) -> PyResult<Vec<String>> {
    let law = if weighted {
        run::SpaceLaw::Regular
    } else {
        run::SpaceLaw::Delaunay
    };
    let checked = work::run(py, &call, |context| -> Result<_> {
        Ok(run::check_space(&file, law, context)?)
    })?;
    Ok(checked.flaws.iter().map(ToString::to_string).collect())
}

/// Returns true if a file has points or tetrahedra in space.
#[pyfunction]
pub(crate) fn is_of_space(py: Python<'_>, file: PathBuf) -> PyResult<bool> {
    work::short(py, || -> Result<_> { Ok(run::is_of_space(&file)) })
}

/// Returns the classes of points that a word means: a name such as "ground", a number, a range, or
/// "all".
#[pyfunction]
pub(crate) fn class_numbers(name: &str) -> PyResult<Vec<u8>> {
    let unknown = |_| {
        let error = Error::usage(format!("`{name}` is not a class of points"));
        Failure(error.cure("use a number from 0 to 255, a range such as `0-31`, `all`, or a name as in LAS 1.4, such as `ground`"))
    };
    Ok(classes::parse(name).map_err(unknown)?)
}
