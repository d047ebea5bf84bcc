//! Surfaces to files, in one piece or in tiles, and the jobs that tiles are done by.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use breakline::run::{
    self, BadFiles, ContourOptions, DemOptions, Division, Execution, Existing, FoundJob,
    HillshadeOptions, JobCommand, JobReport, Look, Origin, Source, StoredJob, Summary,
    SurfaceOptions, SurfaceRequest, Targets, TileOptions, Verb, WorkOptions, WriteReport,
    WriteRequest, Written, WrittenOf,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::errors::{self, Failure, Result};
use crate::reports;
use crate::requests::{
    self, FrameArguments, PointInput, ReadArguments, SurfaceArguments, SystemArguments,
};
use crate::work::{self, Call};

/// What is written, and of what, under the names in Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked<'py> {
    /// The kind of the input: a result of [`kind_of`].
    kind: String,
    points: Vec<PointInput<'py>>,
    read: ReadArguments,
    systems: SystemArguments,
    /// The options of building a TIN; none are given if the input is a surface already.
    surface: SurfaceArguments<'py>,
    verb: String,
    /// The options of the verb.
    product: Bound<'py, PyDict>,
    output: PathBuf,
    labels_output: Option<PathBuf>,
    overwrite: bool,
    tiles: Option<String>,
    memory: Option<String>,
    job: Option<PathBuf>,
    resume: bool,
    update: bool,
    skip_bad: bool,
    headers_only: bool,
    /// The memory of one task, for tasks that are done elsewhere.
    task_memory: Option<u64>,
}

impl Asked<'_> {
    fn request(&self) -> PyResult<WriteRequest> {
        let source = match (&self.kind[..], &self.points[..]) {
            (MESH, [PointInput::File(path)]) => Source::Mesh(path.clone()),
            (RASTER, [PointInput::File(path)]) => Source::Raster(path.clone()),
            _ => Source::Points(Box::new(self.surface.request(&self.points, &self.read)?)),
        };
        let surface = SurfaceRequest {
            source,
            systems: self.systems.options()?,
        };
        Ok(WriteRequest {
            surface,
            verb: verb(&self.verb, &self.product)?,
        })
    }

    fn targets(&self) -> Targets {
        Targets {
            existing: Existing::of(self.overwrite),
            labels: self.labels_output.clone(),
            ..Targets::of(&self.output)
        }
    }

    fn tiles(&self) -> PyResult<TileOptions> {
        let division = self.tiles.as_deref().map(|text| {
            text.parse::<Division>().map_err(|why| {
                errors::usage(
                    &format!("tiles: {why}"),
                    &format!("'{text}'"),
                    "write 'auto' or '8x8'",
                )
            })
        });
        Ok(TileOptions {
            division: division.transpose()?.unwrap_or_default(),
            memory: self.memory.as_deref().map(requests::memory).transpose()?,
            folder: self.job.clone(),
            bad: if self.skip_bad {
                BadFiles::Skip
            } else {
                BadFiles::Refuse
            },
            look: if self.headers_only {
                Look::Headers
            } else {
                Look::Points
            },
            task_memory: self.task_memory,
        })
    }

    fn execution(&self) -> PyResult<Execution> {
        let options = self.tiles()?;
        Ok(if self.resume {
            Execution::Resume(options)
        } else if self.update {
            Execution::Update(options)
        } else if self.tiles.is_some() || self.job.is_some() || self.skip_bad {
            Execution::Tiles(options)
        } else {
            Execution::Auto {
                memory: options.memory,
            }
        })
    }
}

/// Returns the time in which a worker gives a sign of life.
fn lease(seconds: f64) -> PyResult<Duration> {
    let lease = Duration::try_from_secs_f64(seconds).ok();
    lease.filter(|lease| lease.as_secs() > 0).ok_or_else(|| {
        errors::usage(
            "lease: expected a number of seconds, at least 1",
            &seconds.to_string(),
            "write 60",
        )
    })
}

/// Returns a verb with its options.
fn verb(name: &str, options: &Bound<'_, PyDict>) -> PyResult<Arc<dyn Verb>> {
    let frame = || {
        options
            .as_any()
            .get_item("frame")?
            .extract::<FrameArguments>()?
            .options()
    };
    let method = || requests::method(&options.as_any().get_item("method")?.extract::<String>()?);
    Ok(match name {
        "dem" => Arc::new(DemOptions {
            frame: frame()?,
            method: method()?,
        }),
        "hillshade" => {
            let light = options.as_any().get_item("light")?.extract()?;
            Arc::new(HillshadeOptions {
                frame: frame()?,
                method: method()?,
                light: requests::light_options(light)?,
            })
        }
        "color_relief" => {
            let of = |name: &str| options.as_any().get_item(name);
            let asked = (
                of("frame")?.extract()?,
                of("method")?.extract()?,
                of("colors")?.extract()?,
            );
            Arc::new(requests::relief_options(asked)?)
        }
        "contour" => {
            let (interval, base, levels) = options.as_any().get_item("levels")?.extract()?;
            Arc::new(ContourOptions {
                interval,
                base,
                levels,
                map: requests::map_options(options.as_any().get_item("map")?.extract()?)?,
            })
        }
        "tin" => Arc::new(SurfaceOptions {
            edges: requests::written_edges(options.as_any().get_item("plain")?.extract()?),
            simplify: None,
        }),
        _ => {
            let Some(quantity) = options.get_item("quantity")? else {
                return Err(requests::no_verb(name));
            };
            let method: String = options.as_any().get_item("method")?.extract()?;
            let quantity = quantity.extract()?;
            Arc::new(requests::quantity_options(frame()?, &method, &quantity)?)
        }
    })
}

/// Writes what a verb makes of a surface; returns the report.
#[pyfunction]
pub(crate) fn write<'py>(
    py: Python<'py>,
    asked: Asked<'py>,
    call: Call,
) -> PyResult<Bound<'py, PyDict>> {
    let (request, targets, execution) = (asked.request()?, asked.targets(), asked.execution()?);
    // The arrays are copied, and may be changed.
    drop(asked);
    let report = work::run_alone(py, &call, |context| -> Result<_> {
        Ok(run::write(&request, &targets, &execution, context)?)
    })?;
    of_report(py, &report)
}

/// Returns what was written, as a dictionary.
fn of_report<'py>(py: Python<'py>, report: &WriteReport) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    match report {
        WriteReport::Kept { has_holes, .. } => found.set_item("has_holes", has_holes)?,
        WriteReport::Written(written) => of_written(&found, written)?,
        _ => return Err(errors::internal(&"nothing was written")),
    }
    Ok(found)
}

fn of_written(
    found: &Bound<'_, PyDict>,
    Written {
        surface,
        summary,
        files,
        ..
    }: &Written,
) -> PyResult<()> {
    found.set_item(
        "files",
        files
            .iter()
            .map(|path| path.as_os_str())
            .collect::<Vec<&OsStr>>(),
    )?;
    match surface {
        WrittenOf::Whole(report) => {
            found.set_item("in_tiles", false)?;
            found.set_item("has_holes", false)?;
            found.set_item("min", report.extent.min)?;
            found.set_item("max", report.extent.max)?;
            match &report.origin {
                Origin::Built(built) => {
                    found.set_item("vertices", built.tin.vertices)?;
                    found.set_item("triangles", built.tin.triangles)?;
                    reports::of_building(found, built)?;
                }
                Origin::Triangles(facts) => {
                    found.set_item("vertices", facts.vertices)?;
                    found.set_item("triangles", facts.triangles)?;
                }
                Origin::Cells(_) => {}
            }
        }
        WrittenOf::Tiles { report, folder } => of_tiles(found, report, folder)?,
    }
    match summary {
        Summary::Heights(cells) => {
            found.set_item("cells_with_height", cells.valid)?;
            found.set_item("lowest", (cells.valid > 0).then_some(cells.min))?;
            found.set_item("highest", (cells.valid > 0).then_some(cells.max))
        }
        Summary::Contours(drawn) => {
            found.set_item("lines", drawn.lines)?;
            found.set_item("closed_lines", drawn.closed)
        }
        Summary::Map(map) => {
            found.set_item("lines", map.drawn.lines)?;
            found.set_item("closed_lines", map.drawn.closed)?;
            found.set_item("lines_left_out", map.left_out)?;
            found.set_item("deviation", map.deviation)?;
            found.set_item("bands", map.bands)?;
            found.set_item("labels", map.labels)
        }
        Summary::Parts(parts) => found.set_item("parts", parts.index.parts.len()),
        _ => Ok(()),
    }
}

fn of_tiles(found: &Bound<'_, PyDict>, report: &JobReport, folder: &Path) -> PyResult<()> {
    found.set_item("in_tiles", true)?;
    found.set_item("has_holes", report.skipped > 0)?;
    found.set_item("job", (report.skipped > 0).then_some(folder.as_os_str()))?;
    found.set_item("files_skipped", report.skipped)?;
    for (name, count) in [
        ("points_read", report.read),
        ("points_used", report.used),
        ("points_withheld", report.withheld),
        ("points_of_other_classes", report.other_class),
        ("points_of_other_returns", report.other_return),
        ("duplicates", report.duplicates),
        ("points_on_breaklines", report.points_on_breaklines),
        ("points_replaced", report.points_replaced),
        ("triangles", report.triangles),
        ("triangles_beyond_max_edge", report.beyond_max_edge),
        ("triangles_clipped", report.clipped),
        ("triangles_over_skipped_files", report.over_skipped),
    ] {
        found.set_item(name, count)?;
    }
    found.set_item("min", report.extent.min)?;
    found.set_item("max", report.extent.max)
}

const POINTS: &str = "points";
const MESH: &str = "mesh";
const RASTER: &str = "raster";

/// Returns what a file is: points, or a surface already.
#[pyfunction]
pub(crate) fn kind_of(py: Python<'_>, file: PathBuf) -> PyResult<&'static str> {
    let source = work::short(py, || -> Result<_> { Ok(Source::of_files(&[file])?) })?;
    Ok(match source {
        Source::Points(_) => POINTS,
        Source::Mesh(_) => MESH,
        Source::Raster(_) => RASTER,
    })
}

/// Returns the folder that a job with this output has by default.
#[pyfunction]
pub(crate) fn job_folder(output: PathBuf) -> Option<OsString> {
    Targets::of(output)
        .job_folder()
        .map(PathBuf::into_os_string)
}

/// The job in a folder.
#[pyclass(frozen, module = "breakline._breakline")]
pub(crate) struct Job {
    /// Without its command: a job can be removed even if its command cannot be read.
    found: FoundJob,
    /// The first output, if it is known: also when the job is removed.
    output: Option<PathBuf>,
}

impl Job {
    fn of(stored: &StoredJob) -> Self {
        Job {
            found: stored.found().clone(),
            output: first_output(stored),
        }
    }
}

fn first_output(stored: &StoredJob) -> Option<PathBuf> {
    stored.command.targets.files.first().cloned()
}

#[pymethods]
impl Job {
    /// Opens the job in the folder that is asked for, or plans one.
    #[staticmethod]
    fn begin(py: Python<'_>, asked: Asked<'_>, call: Call) -> PyResult<Self> {
        let (targets, tiles) = (asked.targets(), asked.tiles()?);
        let command = JobCommand::new(&asked.request()?, &targets, &tiles).map_err(Failure)?;
        drop(asked);
        let folder = tiles
            .folder
            .or_else(|| targets.job_folder())
            .unwrap_or_default();
        work::run_alone(py, &call, |context| -> Result<_> {
            let stored = match StoredJob::find(&folder)? {
                Some(stored) => {
                    stored.require_for(&command)?;
                    stored
                }
                None => run::plan_job(&command, &folder, context)?,
            };
            Ok(Job::of(&stored))
        })
    }

    /// Opens the job in a folder.
    #[staticmethod]
    fn open(py: Python<'_>, folder: PathBuf) -> PyResult<Self> {
        work::short(py, || -> Result<_> {
            let found = FoundJob::read(&folder)?;
            // A job whose command is damaged can be removed: what else is asked for is an error.
            let output = found.stored().ok().as_ref().and_then(first_output);
            Ok(Job { found, output })
        })
    }

    /// The folder.
    #[getter]
    fn folder(&self) -> &Path {
        self.found.folder()
    }

    /// The first output.
    #[getter]
    fn output(&self, py: Python<'_>) -> PyResult<Option<PathBuf>> {
        match &self.output {
            Some(output) => Ok(Some(output.clone())),
            None => work::short(py, || -> Result<_> {
                Ok(first_output(&self.found.stored()?))
            }),
        }
    }

    /// Returns the tasks, each as a dictionary.
    fn tasks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let tasks = work::run_alone(py, &Call::BRIEF, |context| -> Result<_> {
            let stored = self.found.stored()?;
            let outputs = &stored.command.targets.files;
            Ok(stored.job()?.tasks(outputs, context)?)
        })?;
        let listed = PyList::empty(py);
        for task in tasks {
            let found = PyDict::new(py);
            found.set_item("number", task.number)?;
            found.set_item("name", task.name)?;
            found.set_item("stage", task.stage)?;
            found.set_item("needs", task.needs)?;
            found.set_item("input", task.input.map(PathBuf::into_os_string))?;
            found.set_item(
                "has_read",
                task.has_read.map(|state| (state.size, state.modified)),
            )?;
            found.set_item("done", task.is_done)?;
            let lease = task.lease.filter(|lease| !lease.has_expired);
            let worker = lease.and_then(|lease| lease.worker);
            found.set_item("worker", worker.map(|worker| worker.to_string()))?;
            listed.append(found)?;
        }
        Ok(listed)
    }

    /// Reads the files of the tasks, and removes those that are damaged.
    fn verify(&self, py: Python<'_>, call: Call) -> PyResult<()> {
        work::run_alone(py, &call, |context| -> Result<_> {
            let job = self.found.stored()?.job()?;
            Ok(job.remove_damaged(context).map(drop)?)
        })
    }

    /// Checks that the files of points which these tasks read, and all files of lines, are as they
    /// were read or planned with.
    fn check_inputs(&self, py: Python<'_>, tasks: Vec<usize>) -> PyResult<()> {
        work::run_alone(py, &Call::BRIEF, |context| -> Result<_> {
            let job = self.found.stored()?.job()?;
            Ok(job.check_inputs_of(tasks, context)?)
        })
    }

    /// Does a task; returns the report of the last one, which writes the output.
    fn run_task<'py>(
        &self,
        py: Python<'py>,
        number: usize,
        call: Call,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let report = work::run_alone(py, &call, |context| -> Result<_> {
            let stored = self.found.stored()?;
            Ok(run::run_task(
                &stored.job()?,
                number,
                &stored.command.targets,
                context,
            )?)
        })?;
        report.map(|report| of_report(py, &report)).transpose()
    }

    /// Does all tasks that are left, and writes the output; returns the report.
    fn write<'py>(
        &self,
        py: Python<'py>,
        overwrite: Option<bool>,
        call: Call,
    ) -> PyResult<Bound<'py, PyDict>> {
        let report = work::run_alone(py, &call, |context| -> Result<_> {
            let mut stored = self.found.stored()?;
            if let Some(overwrite) = overwrite {
                stored.command.targets.existing = Existing::of(overwrite);
            }
            Ok(run::run_job(&stored, context)?)
        })?;
        of_report(py, &report)
    }

    /// Does again what inputs reach that have changed; returns the report of the output, which is
    /// replaced.
    fn update<'py>(&self, py: Python<'py>, call: Call) -> PyResult<Bound<'py, PyDict>> {
        let report = work::run_alone(py, &call, |context| -> Result<_> {
            Ok(run::update_job(&self.found.stored()?, context)?)
        })?;
        of_report(py, &report)
    }

    /// Does tasks together with other processes, until all are done; returns the report of the
    /// output, which one of them writes.
    fn work<'py>(
        &self,
        py: Python<'py>,
        most: Option<String>,
        seconds: f64,
        call: Call,
    ) -> PyResult<Bound<'py, PyDict>> {
        let options = WorkOptions {
            memory: most.as_deref().map(requests::memory).transpose()?,
            lease: lease(seconds)?,
        };
        let report = work::run_alone(py, &call, |context| -> Result<_> {
            Ok(run::work_job(&self.found.stored()?, &options, context)?)
        })?;
        of_report(py, &report)
    }

    /// True if files were skipped.
    #[getter]
    fn has_holes(&self, py: Python<'_>) -> PyResult<bool> {
        work::run_alone(py, &Call::BRIEF, |context| -> Result<_> {
            Ok(self.found.stored()?.job()?.has_holes(context)?)
        })
    }

    /// Removes the files that the job has written, except the output.
    fn clean(&self, py: Python<'_>) -> PyResult<()> {
        work::run_alone(py, &Call::BRIEF, |context| -> Result<_> {
            Ok(self.found.remove(context)?)
        })
    }
}
