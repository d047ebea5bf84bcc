//! Surfaces: built from arrays and files, asked for heights, products and files.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use breakline::crs::Crs;
use breakline::data::{ContourLine, EdgeKind, Frame, Grid, Surface as _};
use breakline::io::formats::{Content, Product};
use breakline::io::geotiff::CellFormat;
use breakline::io::{Destination, formats, mapped, mesh};
use breakline::run::{
    self, CellProduct, Context, ContourOptions, DemOptions, Heights, HillshadeOptions, Model,
    SampleOptions, SampledField, Source, SurfaceProduct, SurfaceRequest,
};
use breakline::terrain::{CompactTin, SimplifyLimit, SimplifyRule};
use breakline::{Error, io};
use numpy::{Element, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::errors::{self, Failure, Result};
use crate::requests::{
    self, FrameArguments, LightArguments, PointInput, ReadArguments, ReliefArguments,
    SurfaceArguments, SystemArguments,
};
use crate::work::{self, Call};
use crate::{arrays, notices, reports};

/// A raster in Python: its cells by rows, its transform in GDAL's order, and its coordinate system
/// as WKT.
pub(crate) type Raster<'py> = (Bound<'py, PyAny>, [f64; 6], Option<String>);

/// Contours in Python: all vertices, where each line begins among them (and where the last one
/// ends), and the height of each line.
type Contours<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>);

/// A surface of triangles or cells, and how it came to be.
#[pyclass(frozen, module = "breakline._breakline")]
pub(crate) struct Surface {
    product: Arc<SurfaceProduct>,
    heights: Heights,
}

impl Surface {
    fn of(product: SurfaceProduct) -> Self {
        let product = Arc::new(product);
        Surface {
            heights: Heights::new(Arc::clone(&product)),
            product,
        }
    }

    /// Returns the surface of the library.
    pub(crate) fn product(&self) -> Arc<SurfaceProduct> {
        Arc::clone(&self.product)
    }
}

/// Returns what `build` makes of the request for the TIN of points and lines.
fn built(
    py: Python<'_>,
    points: Vec<PointInput<'_>>,
    read: &ReadArguments,
    systems: &SystemArguments,
    options: SurfaceArguments<'_>,
    call: &Call,
    build: impl FnOnce(&SurfaceRequest, &Context<'_>) -> breakline::Result<SurfaceProduct> + Send,
) -> PyResult<Surface> {
    let request = SurfaceRequest {
        source: Source::Points(Box::new(options.request(&points, read)?)),
        systems: systems.options()?,
    };
    let count = requests::count(&points).filter(|_| !options.have_lines());
    // The arrays are copied, and may be changed.
    drop((points, options));
    work::run_on(py, call, count, move |context| -> Result<_> {
        Ok(build(&request, context)?)
    })
    .map(Surface::of)
}

#[pymethods]
impl Surface {
    /// Builds the TIN of points and lines.
    #[staticmethod]
    fn build(
        py: Python<'_>,
        points: Vec<PointInput<'_>>,
        read: ReadArguments,
        systems: SystemArguments,
        options: SurfaceArguments<'_>,
        method: &str,
        call: Call,
    ) -> PyResult<Self> {
        let method = requests::method(method)?;
        let build = move |request: &SurfaceRequest, context: &Context<'_>| {
            run::triangles_for(method, request, context)
        };
        built(py, points, &read, &systems, options, &call, build)
    }

    /// Builds one of `count` TINs of points and lines that are only asked: in files if it needs
    /// more than its share of the memory.
    #[staticmethod]
    #[allow(clippy::too_many_arguments)] // as Python passes them
    fn ask(
        py: Python<'_>,
        points: Vec<PointInput<'_>>,
        read: ReadArguments,
        systems: SystemArguments,
        options: SurfaceArguments<'_>,
        method: &str,
        call: Call,
        memory: Option<&str>,
        count: u64,
    ) -> PyResult<Self> {
        let method = requests::method(method)?;
        let memory = memory.map(requests::memory).transpose()?;
        let memory = memory.map(|all| all / count.max(1));
        let build = move |request: &SurfaceRequest, context: &Context<'_>| {
            run::open_surface(request, method, memory, context)
        };
        built(py, points, &read, &systems, options, &call, build)
    }

    /// Reads a mesh or a raster, or opens a TIN; `None` if the file has points.
    #[staticmethod]
    fn open(
        py: Python<'_>,
        file: PathBuf,
        systems: SystemArguments,
        call: Call,
    ) -> PyResult<Option<Self>> {
        let source = work::short(py, || -> Result<_> { Ok(Source::of_files(&[file])?) })?;
        if matches!(source, Source::Points(_)) {
            return Ok(None);
        }
        let request = SurfaceRequest {
            source,
            systems: systems.options()?,
        };
        let product = work::run(py, &call, |context| -> Result<_> {
            Ok(run::surface(&request, context)?)
        })?;
        Ok(Some(Surface::of(product)))
    }

    /// Returns the surface between the centers of the cells of a raster.
    #[staticmethod]
    fn of_cells(
        cells: PyReadonlyArray2<'_, f64>,
        transform: [f64; 6],
        crs: Option<&str>,
    ) -> PyResult<Self> {
        let grid = grid(&cells, transform, crs)?;
        grid.frame.checked().map_err(Failure)?;
        Ok(Surface::of(Model::Raster(Box::new(grid)).into()))
    }

    /// Opens a TIN in the bytes that [`to_bytes`](Self::to_bytes) returns.
    #[staticmethod]
    fn of_bytes(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        let product = work::short(py, || -> Result<_> {
            let tin = CompactTin::open(mapped::of_bytes(bytes)?, "(bytes)")?;
            Ok(Model::Compact(Box::new(tin)).into())
        })?;
        Ok(Surface::of(product))
    }

    /// Returns the TIN in the bytes of its file.
    fn to_bytes<'py>(&self, py: Python<'py>, call: Call) -> PyResult<Bound<'py, PyBytes>> {
        let product = &self.product;
        let bytes = work::run_on(py, &call, self.vertex_count(), |_| -> Result<_> {
            let mut bytes = Vec::new();
            product.triangles()?.write_tin(&mut bytes)?;
            Ok(bytes)
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// "tin", "mesh" or "raster".
    #[getter]
    fn kind(&self) -> &'static str {
        match &self.product.model {
            Model::Tin(_) | Model::Compact(_) | Model::Parts(_) => "tin",
            Model::Mesh(_) => "mesh",
            Model::Raster(_) | Model::RasterFile(_) => "raster",
        }
    }

    /// The coordinate system: WKT, name and EPSG code.
    #[getter]
    fn crs(&self) -> Option<(String, String, Option<u32>)> {
        self.product
            .crs()
            .map(|crs| (crs.to_wkt(), crs.describe(), crs.epsg))
    }

    /// The lowest and the highest coordinates.
    #[getter]
    fn extent(&self, py: Python<'_>) -> PyResult<([f64; 3], [f64; 3])> {
        let extent = work::short(py, || -> Result<_> { Ok(self.product.extent()) })?;
        Ok((extent.min, extent.max))
    }

    /// What was assumed and what looks wrong, each with the name of its severity.
    #[getter]
    fn notices(&self) -> Vec<(&'static str, String)> {
        notices::pairs(&self.product.notices)
    }

    /// Counts of the surface, and of how it was built.
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        reports::of_surface(py, &self.product)
    }

    /// The points that water and walls replaced, (n, 3).
    fn replaced_points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        arrays::table(
            py,
            self.product
                .built
                .as_ref()
                .map(|built| built.replaced.clone())
                .unwrap_or_default(),
        )
    }

    /// Returns the vertices (n, 3) and the corners of the triangles (m, 3), as a file lists them.
    fn list<'py>(
        &self,
        py: Python<'py>,
        call: Call,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let product = &self.product;
        let (vertices, faces) = work::run_on(py, &call, self.vertex_count(), |_| -> Result<_> {
            let listed = mesh::list(product.triangles()?)?;
            Ok((listed.vertices, signed(listed.faces)?))
        })?;
        let lists = (arrays::table(py, vertices)?, arrays::table(py, faces)?);
        arrays::read_only(&lists.0)?;
        arrays::read_only(&lists.1)?;
        Ok(lists)
    }

    /// Returns the ends of all edges (k, 2) and their kinds (k,).
    fn edges<'py>(
        &self,
        py: Python<'py>,
        call: Call,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let product = &self.product;
        let (ends, kinds) = work::run_on(py, &call, self.vertex_count(), |_| -> Result<_> {
            let (ends, kinds): (Vec<[u32; 2]>, Vec<u8>) = mesh::edges(product.triangles()?)?
                .into_iter()
                .map(|(ends, kind)| (ends, kind.number()))
                .unzip();
            Ok((signed(ends)?, kinds))
        })?;
        let lists = (
            arrays::table(py, ends)?,
            arrays::column(py, kinds).into_any(),
        );
        arrays::read_only(&lists.0)?;
        arrays::read_only(&lists.1)?;
        Ok(lists)
    }

    /// Returns the height at each position (n, 2).
    fn elevations<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'py, f64>,
        method: &str,
        call: Call,
    ) -> PyResult<Bound<'py, PyAny>> {
        let method = requests::method(method)?;
        let positions = arrays::points::<2>(&positions);
        let heights = &self.heights;
        let count = heights.is_prepared(method).then_some(positions.len());
        let heights = work::run_on(py, &call, count, |context| -> Result<_> {
            Ok(heights.at(&positions, method, context)?)
        })?;
        Ok(arrays::column(py, heights).into_any())
    }

    /// Returns the names of columns, and a value in each for each position (n, 2), position by
    /// position.
    fn samples<'py>(
        &self,
        py: Python<'py>,
        positions: PyReadonlyArray2<'py, f64>,
        add: Vec<String>,
        prefix: String,
        method: &str,
        call: Call,
    ) -> PyResult<(Vec<String>, Bound<'py, PyAny>)> {
        let known: Vec<(&str, SampledField)> = SampledField::ALL
            .iter()
            .map(|&(field, name)| (name, field))
            .collect();
        let options = SampleOptions {
            add: add
                .iter()
                .map(|name| requests::choose("add", name, &known))
                .collect::<PyResult<_>>()?,
            prefix,
            method: requests::method(method)?,
            ..SampleOptions::default()
        };
        let positions = arrays::points::<2>(&positions);
        let product = &self.product;
        let values = work::run_on(py, &call, Some(positions.len()), |context| -> Result<_> {
            Ok(run::sample_positions(
                product, &positions, &options, context,
            )?)
        })?;
        let names = options.column_names();
        let shape = [positions.len(), names.len()];
        Ok((names, arrays::shaped(py, values, shape)?))
    }

    /// Returns a surface of fewer vertices, within a bound or of at most so many.
    fn simplify(
        &self,
        py: Python<'_>,
        max_error: Option<f64>,
        target: Option<u64>,
        line_tolerance: Option<f64>,
        call: Call,
    ) -> PyResult<Self> {
        let limit = match (max_error, target) {
            (Some(bound), None) => SimplifyLimit::MaxError(bound),
            (None, Some(target)) => SimplifyLimit::Target(target),
            _ => {
                return Err(errors::usage(
                    "one of max_error and target is needed",
                    "",
                    "pass max_error=0.1",
                ));
            }
        };
        let rule = SimplifyRule {
            limit,
            line_tolerance,
        };
        rule.check().map_err(Failure)?;
        let product = &self.product;
        work::run(py, &call, |context| -> Result<_> {
            Ok(run::simplify(product, &rule, context)?)
        })
        .map(Surface::of)
    }

    /// Computes heights at the centers of cells.
    fn dem<'py>(
        &self,
        py: Python<'py>,
        frame: FrameArguments,
        method: &str,
        call: Call,
    ) -> PyResult<Raster<'py>> {
        let options = DemOptions {
            frame: frame.options()?,
            method: requests::method(method)?,
        };
        let product = &self.product;
        let (frame, heights) = work::run(py, &call, |context| -> Result<_> {
            Ok(run::dem(product, &options, context)?.collect_cells(context)?)
        })?;
        raster_of(py, &frame, heights, self.product.crs())
    }

    /// Computes a quantity in cells. `quantity` has the name of the verb, its formula, whether it
    /// is in percent, and the factor for heights.
    fn quantity<'py>(
        &self,
        py: Python<'py>,
        frame: FrameArguments,
        method: &str,
        quantity: (String, String, bool, Option<f64>),
        call: Call,
    ) -> PyResult<Raster<'py>> {
        let options = requests::quantity_options(frame.options()?, method, &quantity)?;
        let product = &self.product;
        let (frame, values) = work::run(py, &call, |context| -> Result<_> {
            Ok(run::quantity(product, &options, context)?.collect_cells(context)?)
        })?;
        raster_of(py, &frame, values, self.product.crs())
    }

    /// Computes shades from 1 (dark) to 255 (bright), and 0 in cells without a height.
    fn hillshade<'py>(
        &self,
        py: Python<'py>,
        frame: FrameArguments,
        method: &str,
        light: LightArguments,
        call: Call,
    ) -> PyResult<Raster<'py>> {
        let options = HillshadeOptions {
            frame: frame.options()?,
            method: requests::method(method)?,
            light: requests::light_options(light)?,
        };
        let product = &self.product;
        let (frame, shades) = work::run(py, &call, |context| -> Result<_> {
            let (frame, shades) =
                run::hillshade(product, &options, context)?.collect_cells(context)?;
            // A conversion that saturates: NaN becomes 0.
            Ok((
                frame,
                shades
                    .into_iter()
                    .map(|shade| shade as u8)
                    .collect::<Vec<u8>>(),
            ))
        })?;
        raster_of(py, &frame, shades, self.product.crs())
    }

    /// Computes the colors of heights in cells: red, green, blue and opacity.
    fn color_relief<'py>(
        &self,
        py: Python<'py>,
        asked: ReliefArguments,
        call: Call,
    ) -> PyResult<Raster<'py>> {
        let options = requests::relief_options(asked)?;
        let product = &self.product;
        let (frame, colors) = work::run(py, &call, |context| -> Result<_> {
            Ok(run::color_relief(product, &options, context)?.collect_colors(context)?)
        })?;
        let cells = arrays::column(py, colors.into_flattened());
        let cells = cells.reshape([frame.height, frame.width, 4])?;
        let crs = self.product.crs().map(Crs::to_wkt);
        Ok((cells.into_any(), frame.transform, crs))
    }

    /// Writes the colors of heights in cells.
    fn write_color_relief(
        &self,
        py: Python<'_>,
        asked: ReliefArguments,
        file: PathBuf,
        overwrite: bool,
        call: Call,
    ) -> PyResult<()> {
        let options = requests::relief_options(asked)?;
        let format = formats::for_output(&file, Product::Colors).ok_or_else(|| {
            Failure(
                Error::usage("the extension is not that of a color relief")
                    .in_file(&file)
                    .cure("write .tif or .png"),
            )
        })?;
        let product = &self.product;
        write_to(py, &file, overwrite, &call, |target, context| {
            let cells = run::color_relief(product, &options, context)?;
            match format.content {
                Content::Picture => cells.write_picture(target, context),
                _ => cells.write(target, context).map(drop),
            }
        })
    }

    /// Draws contours.
    fn contours<'py>(
        &self,
        py: Python<'py>,
        interval: Option<f64>,
        base: f64,
        levels: Vec<f64>,
        map: requests::MapArguments,
        call: Call,
    ) -> PyResult<Contours<'py>> {
        let options = ContourOptions {
            interval,
            base,
            levels,
            map: requests::map_options(map)?,
        };
        let product = &self.product;
        let (points, starts, levels) = work::run(py, &call, |context| -> Result<_> {
            let lines = if options.map.is_asked_for() {
                let map = run::contour_map(product, &options, context)?;
                map.contours.lines.into_iter().map(|of| of.line).collect()
            } else {
                run::contour(product, &options, context)?.collect(context)?
            };
            let levels: Vec<f64> = lines.iter().map(|line| line.level).collect();
            let mut starts = vec![0];
            starts.extend(lines.iter().scan(0, |end, line| {
                *end += line.points.len() as i64;
                Some(*end)
            }));
            let points: Vec<[f64; 2]> = lines.into_iter().flat_map(|line| line.points).collect();
            Ok((points, starts, levels))
        })?;
        let column = |values| arrays::column(py, values).into_any();
        Ok((
            arrays::table(py, points)?,
            arrays::column(py, starts).into_any(),
            column(levels),
        ))
    }

    /// Returns the flaws, each with the positions that it concerns.
    fn check(&self, py: Python<'_>, call: Call) -> PyResult<Vec<(String, Vec<[f64; 2]>)>> {
        let product = &self.product;
        let flaws = work::run_on(py, &call, self.vertex_count(), |context| -> Result<_> {
            Ok(run::surface_flaws(product, context)?)
        })?;
        Ok(flaws
            .into_iter()
            .map(|flaw| (flaw.flaw.to_string(), flaw.at))
            .collect())
    }

    /// Writes the surface as a mesh.
    fn write(
        &self,
        py: Python<'_>,
        file: PathBuf,
        plain: bool,
        overwrite: bool,
        call: Call,
    ) -> PyResult<()> {
        let product = &self.product;
        let edges = requests::written_edges(plain);
        write_to(py, &file, overwrite, &call, |target, context| {
            edges.write(product.triangles()?, target, context).map(drop)
        })
    }
}

impl Surface {
    /// The number of vertices; `None` if it takes long to find.
    fn vertex_count(&self) -> Option<usize> {
        match &self.product.model {
            Model::Tin(tin) => Some(tin.vertex_count()),
            Model::Compact(tin) => Some(tin.vertex_count()),
            Model::Mesh(mesh) => Some(mesh.vertex_count()),
            Model::Parts(_) | Model::Raster(_) | Model::RasterFile(_) => None,
        }
    }
}

/// Returns the cells of a raster as an array, with its transform and its coordinate system.
pub(crate) fn raster_of<'py, T: Element>(
    py: Python<'py>,
    frame: &Frame,
    cells: Vec<T>,
    crs: Option<&Crs>,
) -> PyResult<Raster<'py>> {
    let cells = arrays::column(py, cells).reshape([frame.height, frame.width])?;
    Ok((cells.into_any(), frame.transform, crs.map(Crs::to_wkt)))
}

/// Writes a file, unless there is one that must be kept.
pub(crate) fn write_to(
    py: Python<'_>,
    file: &Path,
    overwrite: bool,
    call: &Call,
    write: impl FnOnce(Destination<'_>, &Context<'_>) -> breakline::Result<()> + Send,
) -> PyResult<()> {
    work::run(py, call, |context| -> Result<()> {
        if !overwrite {
            require_free(file)?;
        }
        Ok(write(file.into(), context)?)
    })
}

/// Returns an error if a file exists, or one that is written with it.
pub(crate) fn require_free(file: &Path) -> Result<()> {
    // A name may be that of several formats.
    let written = [Product::Heights, Product::Surface, Product::Lines];
    let mut written = written
        .iter()
        .filter_map(|&product| formats::for_output(file, product));
    let format = formats::of_name(file).or_else(|| written.next());
    let extension = format.map_or("", |format| format.extensions[0]);
    let beside = format.map_or(&[][..], |format| format.beside);
    let files = formats::with_companions(file, extension, beside);
    files
        .iter()
        .try_for_each(|(path, _)| io::require_absent(path))?;
    Ok(())
}

/// Returns numbers with a sign, as numpy's index arrays have.
fn signed<const N: usize>(rows: Vec<[u32; N]>) -> Result<Vec<[i32; N]>> {
    let largest = rows.iter().flatten().max().copied().unwrap_or(0);
    if i32::try_from(largest).is_err() {
        return Err(Error::limit(format!(
            "vertex {largest} has no number of 32 bits with a sign"
        ))
        .into());
    }
    Ok(rows
        .into_iter()
        .map(|row| row.map(u32::cast_signed))
        .collect())
}

/// Returns the cells of an array as a grid.
fn grid(
    cells: &PyReadonlyArray2<'_, f64>,
    transform: [f64; 6],
    crs: Option<&str>,
) -> PyResult<Grid> {
    let cells = cells.as_array();
    let (height, width) = cells.dim();
    let frame = Frame {
        width,
        height,
        transform,
    };
    Ok(Grid {
        frame,
        crs: requests::crs(crs)?,
        values: cells.iter().copied().collect(),
    })
}

/// The file that cells are written to, under the names in Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct CellTarget {
    file: PathBuf,
    overwrite: bool,
    overviews: String,
}

/// Writes cells as GeoTIFF: heights, or shades, which can also be written as PNG.
#[pyfunction]
pub(crate) fn write_cells(
    py: Python<'_>,
    cells: PyReadonlyArray2<'_, f64>,
    transform: [f64; 6],
    crs: Option<&str>,
    shades: bool,
    target: CellTarget,
    call: Call,
) -> PyResult<()> {
    let grid = grid(&cells, transform, crs)?;
    let CellTarget {
        file,
        overwrite,
        overviews,
    } = target;
    let overviews = requests::overviews(&overviews)?;
    let format = if shades {
        CellFormat::Shades
    } else {
        CellFormat::Heights
    };
    let is_picture = file
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    if is_picture && !shades {
        return Err(Failure(
            Error::usage("heights are not written as a picture")
                .in_file(&file)
                .cure("write .tif, or a hillshade"),
        )
        .into());
    }
    write_to(py, &file, overwrite, &call, |target, context| {
        let cells = CellProduct::of_grid(&grid, format).with_overviews(overviews);
        if is_picture {
            cells.write_picture(target, context)
        } else {
            cells.write(target, context).map(drop)
        }
    })
}

/// Writes contours, given as [`Surface::contours`] returns them.
#[pyfunction]
pub(crate) fn write_contours(
    py: Python<'_>,
    points: PyReadonlyArray2<'_, f64>,
    starts: PyReadonlyArray1<'_, i64>,
    levels: PyReadonlyArray1<'_, f64>,
    crs: Option<&str>,
    file: PathBuf,
    overwrite: bool,
    call: Call,
) -> PyResult<()> {
    let crs = requests::crs(crs)?;
    let mut points = arrays::points::<2>(&points).into_iter();
    let (starts, levels) = (starts.to_vec()?, levels.to_vec()?);
    let lines: Vec<ContourLine> = starts
        .windows(2)
        .zip(levels)
        .map(|(ends, level)| {
            let count = usize::try_from(ends[1].saturating_sub(ends[0])).unwrap_or(0);
            ContourLine {
                level,
                points: points.by_ref().take(count).collect(),
            }
        })
        .collect();
    write_to(py, &file, overwrite, &call, |target, context| {
        run::write_contours(&lines, crs.as_ref(), target, context).map(drop)
    })
}

/// Returns the flaws of a mesh in a file that may not be a surface, or of a surface of points, each
/// with the positions that it concerns.
#[pyfunction]
pub(crate) fn check_file(
    py: Python<'_>,
    file: PathBuf,
    call: Call,
) -> PyResult<Vec<(String, Vec<[f64; 2]>)>> {
    let source = work::short(py, || -> Result<_> { Ok(Source::of_files(&[file])?) })?;
    let request = SurfaceRequest {
        source,
        ..SurfaceRequest::default()
    };
    let checked = work::run(py, &call, |context| -> Result<_> {
        Ok(run::check(&request, context)?)
    })?;
    Ok(checked
        .flaws
        .into_iter()
        .map(|flaw| (flaw.flaw.to_string(), flaw.at))
        .collect())
}

/// Returns the name of each kind of edges, by its number.
#[pyfunction]
pub(crate) fn edge_kinds() -> Vec<String> {
    EdgeKind::ALL
        .iter()
        .map(|kind| format!("{kind:?}").to_lowercase())
        .collect()
}
