//! Drop-ins for triangulations, Voronoi diagrams and convex hulls of `scipy.spatial`, and for the
//! interpolators over them: what is computed. The signatures of scipy are in
//! `package/breakline/spatial`.

mod cubic;
mod dimensions;
mod groups;
mod guesses;
mod hull;
mod lists;
mod mesh;
mod queries;
mod voronoi;

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{PoisonError, RwLock, RwLockReadGuard};

use breakline::Error;
use breakline::triangulation::InputError;
use breakline::triangulation::geometry::{Plane, Space};
use breakline::triangulation::kernel::{Adaptive, Kernel, Range};
use breakline::triangulation::num::unsigned_zero;
use numpy::{
    IntoPyArray, IxDyn, PyArray1, PyArray3, PyArrayDyn, PyArrayMethods, PyReadonlyArray1,
    PyReadonlyArray2, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::prelude::*;

use self::cubic::{Limits, Surface};
use self::hull::Hull;
pub(crate) use self::lists::nested_lists;
use self::mesh::Mesh;
use self::queries::Field;
use self::voronoi::Diagram;
use crate::arrays::{column, is_aligned, points, table};
use crate::errors::{self, Failure, Result};
use crate::work::{self, Call};

/// A triangulation of the plane or of space.
enum Any {
    Plane(Mesh<Plane, 3, 2>),
    Space(Mesh<Space, 4, 3>),
}

/// Positions in the plane or in space.
enum Positions {
    Plane(Vec<[f64; 2]>),
    Space(Vec<[f64; 3]>),
}

/// Positions as Python passes them: rows of coordinates, or an array for each axis, all of one
/// length.
#[derive(FromPyObject)]
enum Given<'py> {
    Rows(PyReadonlyArray2<'py, f64>),
    Axes(Vec<PyReadonlyArray1<'py, f64>>),
}

impl Given<'_> {
    /// Copies them, so that other threads may change the arrays meanwhile.
    fn read(&self) -> PyResult<Positions> {
        let axes = match self {
            Given::Rows(rows) => return Ok(Positions::of(rows)),
            Given::Axes(axes) => axes.iter().map(|axis| axis.as_slice()),
        };
        let axes = axes.collect::<std::result::Result<Vec<_>, _>>()?;
        Ok(match axes[..] {
            [x, y] => Positions::Plane(x.iter().zip(y).map(|(&x, &y)| [x, y]).collect()),
            [x, y, z] => {
                let all = x.iter().zip(y).zip(z);
                Positions::Space(all.map(|((&x, &y), &z)| [x, y, z]).collect())
            }
            _ => return Err(errors::internal(&"there are two or three axes")),
        })
    }
}

/// Calls a method of the triangulation in the plane or in space.
macro_rules! of_dimension {
    ($any:expr, $mesh:ident => $call:expr) => {
        match $any {
            Any::Plane($mesh) => $call,
            Any::Space($mesh) => $call,
        }
    };
}

/// Like `of_dimension`, with positions of the same dimension; of another one there are none.
macro_rules! at_positions {
    ($any:expr, $positions:expr, ($mesh:ident, $at:ident) => $call:expr) => {
        match ($any, $positions) {
            (Any::Plane($mesh), Positions::Plane($at)) => $call,
            (Any::Space($mesh), Positions::Space($at)) => $call,
            (Any::Plane(_), Positions::Space(_)) | (Any::Space(_), Positions::Plane(_)) => {
                Default::default()
            }
        }
    };
}

impl Positions {
    /// Copies an array of shape (n, 2) or (n, 3).
    fn of(array: &PyReadonlyArray2<'_, f64>) -> Self {
        match array.shape()[1] {
            2 => Positions::Plane(points(array)),
            _ => Positions::Space(points(array)),
        }
    }

    /// Copies an array of shape (..., `width`) that needs no conversion: exactly of type `ndarray`
    /// (masked arrays are of a subclass), of float64, in C order. `None` for all else.
    fn of_plain(array: &Bound<'_, PyAny>, width: usize) -> Option<Self> {
        if !array.is_exact_instance_of::<PyUntypedArray>() {
            return None;
        }
        let array = array.cast::<PyArrayDyn<f64>>().ok()?;
        if array.shape().last() != Some(&width) || !array.is_c_contiguous() || !is_aligned(array) {
            return None;
        }
        let array = array.try_readonly().ok()?;
        let numbers = array.as_slice().ok()?;
        Some(match width {
            2 => Positions::Plane(numbers.as_chunks().0.to_vec()),
            _ => Positions::Space(numbers.as_chunks().0.to_vec()),
        })
    }

    /// Rounds coordinates below the range of exact arithmetic to the nearest that it has, which is
    /// closer than any two points are: no position is outside because it is near an axis.
    fn rounded(mut self) -> Self {
        let coordinates = match &mut self {
            Positions::Plane(positions) => positions.as_flattened_mut(),
            Positions::Space(positions) => positions.as_flattened_mut(),
        };
        let (least, step) = (Adaptive::RANGE.min, Adaptive::RANGE.min * f64::EPSILON);
        for x in coordinates.iter_mut().filter(|x| x.abs() < least) {
            *x = unsigned_zero((*x / step).round() * step);
        }
        self
    }

    fn count(&self) -> usize {
        match self {
            Positions::Plane(points) => points.len(),
            Positions::Space(points) => points.len(),
        }
    }

    /// The number of coordinates of a point.
    fn width(&self) -> usize {
        match self {
            Positions::Plane(_) => 2,
            Positions::Space(_) => 3,
        }
    }

    fn triangulated(self, cancel: &AtomicBool) -> Result<Any> {
        Ok(match self {
            Positions::Plane(mut points) => {
                Any::Plane(Mesh::new(&mut points, cancel).map_err(|e| refused(&e, &points))?)
            }
            Positions::Space(mut points) => {
                Any::Space(Mesh::new(&mut points, cancel).map_err(|e| refused(&e, &points))?)
            }
        })
    }
}

/// A Delaunay triangulation of points in the plane or in space, numbered as scipy does.
///
/// Arrays have rows of `d` coordinates, for `d` of 2 or 3; `n` is the number of points, `m` that of
/// simplices.
#[pyclass(frozen, module = "breakline._breakline")]
pub(crate) struct Tessellation {
    any: RwLock<Any>,
    /// The number of points, without a lock.
    points: AtomicUsize,
    /// The number of coordinates of a point.
    width: usize,
}

impl Tessellation {
    /// Waits for the end of an insertion, so that no thread that has the interpreter's lock may
    /// call this.
    fn read(&self) -> RwLockReadGuard<'_, Any> {
        self.any.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// Computes something from the triangulation.
    fn compute<T: Send>(
        &self,
        py: Python<'_>,
        call: &Call,
        compute: impl FnOnce(&Any, &AtomicBool) -> T + Send,
    ) -> PyResult<T> {
        let points = Some(self.points.load(Ordering::Relaxed));
        work::run_around_on(py, call, points, |pool, context| {
            let any = self.read();
            let any: &Any = &any;
            Result::Ok(pool.install(|| compute(any, context.cancel)))
        })
    }

    /// Answers queries.
    fn answer<T: Send>(
        &self,
        py: Python<'_>,
        call: &Call,
        positions: Positions,
        answer: impl FnOnce(&Any, &Positions, &AtomicBool) -> T + Send,
    ) -> PyResult<T> {
        let positions = positions.rounded();
        // `PERF:` one is found before another thread would have the interpreter's lock.
        if positions.count() == 1
            && let Ok(any) = self.any.try_read()
        {
            return work::at_once(|| answer(&any, &positions, &AtomicBool::new(false)));
        }
        work::run_around_on(py, call, Some(positions.count()), |pool, context| {
            let any = self.read();
            let any: &Any = &any;
            Result::Ok(pool.install(|| answer(any, &positions, context.cancel)))
        })
    }
}

#[pymethods]
impl Tessellation {
    /// Triangulates points of shape (n, d).
    #[new]
    fn new(py: Python<'_>, points: PyReadonlyArray2<'_, f64>, call: Call) -> PyResult<Self> {
        let points = Positions::of(&points);
        let count = points.count();
        let width = points.width();
        let any = work::run_on(py, &call, Some(count), |context| {
            points.triangulated(context.cancel)
        })?;
        Ok(Tessellation {
            any: RwLock::new(any),
            points: AtomicUsize::new(count),
            width,
        })
    }

    /// Inserts more points, of shape (n, d).
    fn add(&self, py: Python<'_>, points: PyReadonlyArray2<'_, f64>, call: Call) -> PyResult<()> {
        let mut points = Positions::of(&points);
        let count = points.count();
        work::run_around_on(py, &call, Some(count), |pool, _| {
            let mut any = self.any.write().unwrap_or_else(PoisonError::into_inner);
            let (any, points) = (&mut *any, &mut points);
            pool.install(|| {
                at_positions!(any, points, (mesh, at) => mesh.add(at).map_err(|e| refused(&e, at))?);
                self.points.fetch_add(count, Ordering::Relaxed);
                Result::Ok(())
            })
        })
    }

    /// The number of simplices; 0 if the points do not span the plane or the space.
    fn simplex_count(&self, py: Python<'_>) -> PyResult<usize> {
        work::short(py, || {
            Result::Ok(of_dimension!(&*self.read(), mesh => mesh.simplex_count()))
        })
    }

    /// True if the points do not span the plane or the space.
    fn has_no_simplices(&self, py: Python<'_>) -> PyResult<bool> {
        work::short(py, || {
            Result::Ok(of_dimension!(&*self.read(), mesh => mesh.has_no_simplices()))
        })
    }

    /// The corners of simplices and their neighbors: two arrays of shape (m, d + 1).
    fn tables<'py>(&self, py: Python<'py>, call: Call) -> PyResult<[Bound<'py, PyAny>; 2]> {
        enum Tables {
            Plane([Vec<[i32; 3]>; 2]),
            Space([Vec<[i32; 4]>; 2]),
        }
        let tables = self.compute(py, &call, |any, _| match any {
            Any::Plane(mesh) => Tables::Plane([mesh.simplices(), mesh.neighbors()]),
            Any::Space(mesh) => Tables::Space([mesh.simplices(), mesh.neighbors()]),
        })?;
        Ok(match tables {
            Tables::Plane([simplices, neighbors]) => [table(py, simplices)?, table(py, neighbors)?],
            Tables::Space([simplices, neighbors]) => [table(py, simplices)?, table(py, neighbors)?],
        })
    }

    /// The maps to barycentric coordinates: an array of shape (m, d + 1, d).
    fn transforms<'py>(&self, py: Python<'py>, call: Call) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let (maps, d) = self.compute(py, &call, |any, _| match any {
            Any::Plane(mesh) => (mesh.transforms().into_flattened().into_flattened(), 2),
            Any::Space(mesh) => (mesh.transforms().into_flattened().into_flattened(), 3),
        })?;
        let count = maps.len() / (d * (d + 1));
        maps.into_pyarray(py).reshape([count, d + 1, d])
    }

    /// The facets of the convex hull: an array of shape (k, d).
    fn hull<'py>(&self, py: Python<'py>, call: Call) -> PyResult<Bound<'py, PyAny>> {
        let (hull, d) = self.compute(py, &call, |any, _| match any {
            Any::Plane(mesh) => (mesh.hull().into_flattened(), 2),
            Any::Space(mesh) => (mesh.hull().into_flattened(), 3),
        })?;
        let count = hull.len() / d;
        Ok(hull.into_pyarray(py).reshape([count, d])?.into_any())
    }

    /// Points at the site of an earlier one: an array of shape (k, 3).
    fn coplanar<'py>(&self, py: Python<'py>, call: Call) -> PyResult<Bound<'py, PyAny>> {
        table(
            py,
            self.compute(
                py,
                &call,
                |any, _| of_dimension!(any, mesh => mesh.coplanar()),
            )?,
        )
    }

    /// A simplex at each point: an array of shape (n,).
    fn simplex_at<'py>(&self, py: Python<'py>, call: Call) -> PyResult<Bound<'py, PyArray1<i32>>> {
        Ok(column(
            py,
            self.compute(
                py,
                &call,
                |any, _| of_dimension!(any, mesh => mesh.simplex_at()),
            )?,
        ))
    }

    /// The neighbors of points: where those of each begin, and all of them.
    fn neighbor_points<'py>(
        &self,
        py: Python<'py>,
        call: Call,
    ) -> PyResult<[Bound<'py, PyArray1<i32>>; 2]> {
        let neighbors = self.compute(
            py,
            &call,
            |any, _| of_dimension!(any, mesh => mesh.neighbor_points()),
        )?;
        let starts = neighbors.starts.into_iter().map(|start| start as i32);
        Ok([column(py, starts.collect()), column(py, neighbors.items)])
    }

    /// The Voronoi diagram.
    fn voronoi<'py>(&self, py: Python<'py>, call: Call) -> PyResult<DiagramArrays<'py>> {
        enum Diagrams {
            Plane(Diagram<2>),
            Space(Diagram<3>),
        }
        let diagram = self.compute(py, &call, |any, _| match any {
            Any::Plane(mesh) => Diagrams::Plane(mesh.diagram()),
            Any::Space(mesh) => Diagrams::Space(mesh.diagram()),
        })?;
        match diagram {
            Diagrams::Plane(diagram) => arrays_of(py, diagram),
            Diagrams::Space(diagram) => arrays_of(py, diagram),
        }
    }

    /// The simplex at each position of shape (q, d): an array of shape (q,).
    fn find<'py>(
        &self,
        py: Python<'py>,
        positions: Given<'py>,
        tolerance: f64,
        call: Call,
    ) -> PyResult<Bound<'py, PyArray1<i32>>> {
        let found = self.answer(
            py,
            &call,
            positions.read()?,
            |any, positions, cancel| at_positions!(any, positions, (mesh, at) => mesh.find(at, tolerance, cancel)),
        )?;
        Ok(column(py, found))
    }

    /// Like `find`, at an array of shape (..., d) that needs no conversion: an array of shape
    /// (...); `None` if that is something else.
    fn find_plain<'py>(
        &self,
        py: Python<'py>,
        positions: &Bound<'py, PyAny>,
        tolerance: f64,
        call: Call,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(copied) = Positions::of_plain(positions, self.width) else {
            return Ok(None);
        };
        let found = self.answer(py, &call, copied, |any, positions, cancel| {
            at_positions!(any, positions, (mesh, at) => mesh.find(at, tolerance, cancel))
        })?;
        let (found, given) = (column(py, found), positions.cast::<PyUntypedArray>()?);
        Ok(Some(match given.shape() {
            [_, _] => found.into_any(),
            [shape @ .., _] => found.reshape(IxDyn(shape))?.into_any(),
            [] => return Ok(None),
        }))
    }

    /// The point nearest to each position of shape (q, d): an array of shape (q,). There must be
    /// `values` points.
    fn nearest<'py>(
        &self,
        py: Python<'py>,
        positions: Given<'py>,
        values: usize,
        call: Call,
    ) -> PyResult<Bound<'py, PyArray1<i32>>> {
        let nearest = self.answer(py, &call, positions.read()?, |any, positions, cancel| {
            one_for_each_point(any, values)?;
            Result::Ok(at_positions!(any, positions, (mesh, at) => mesh.nearest(at, cancel)))
        })?;
        Ok(column(py, nearest?))
    }
}

/// Lists of different lengths: where each begins, and what they contain.
type ListArrays<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<i32>>);

/// A Voronoi diagram: the positions of its vertices, of shape (v, d); the points on both sides of
/// each ridge, of shape (r, 2); the vertices around ridges, and around regions; the region of each
/// point, of shape (n,).
type DiagramArrays<'py> = (
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    ListArrays<'py>,
    ListArrays<'py>,
    Bound<'py, PyArray1<i64>>,
);

fn arrays_of<const D: usize>(py: Python<'_>, diagram: Diagram<D>) -> PyResult<DiagramArrays<'_>> {
    Ok((
        table(py, diagram.vertices)?,
        table(py, diagram.ridge_points)?,
        diagram.ridges.arrays(py),
        diagram.regions.arrays(py),
        column(py, diagram.region_of),
    ))
}

/// A convex hull: its corners, of shape (k,); the corners of facets and their neighbors, of shape
/// (f, d); their equations, of shape (f, d + 1); the volume and the area.
type HullArrays<'py> = (
    Bound<'py, PyArray1<i32>>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    f64,
    f64,
);

/// Returns the convex hull of points of shape (n, d), the first `accepted` of which were checked
/// before; `None` if they do not span the plane or the space.
#[pyfunction]
pub(crate) fn convex_hull<'py>(
    py: Python<'py>,
    points: PyReadonlyArray2<'py, f64>,
    accepted: usize,
    call: Call,
) -> PyResult<Option<HullArrays<'py>>> {
    enum Hulls {
        Plane(Hull<2>),
        Space(Hull<3>),
    }
    let points = Positions::of(&points);
    let accepted = accepted.min(points.count());
    let hull = work::run_on(py, &call, Some(points.count()), |context| {
        Result::Ok(match points {
            Positions::Plane(mut points) => hull::of_plane(&mut points, accepted, context.cancel)
                .map_err(|e| refused(&e, &points[accepted..]))?
                .map(Hulls::Plane),
            Positions::Space(mut points) => hull::of_space(&mut points, accepted, context.cancel)
                .map_err(|e| refused(&e, &points[accepted..]))?
                .map(Hulls::Space),
        })
    })?;
    match hull {
        None => Ok(None),
        Some(Hulls::Plane(hull)) => {
            let equations = hull.normals.iter().map(|&([x, y], offset)| [x, y, offset]);
            let equations = table(py, equations.collect())?;
            hull_arrays(py, hull, equations).map(Some)
        }
        Some(Hulls::Space(hull)) => {
            let equations = hull.normals.iter();
            let equations = equations.map(|&([x, y, z], offset)| [x, y, z, offset]);
            let equations = table(py, equations.collect())?;
            hull_arrays(py, hull, equations).map(Some)
        }
    }
}

fn hull_arrays<'py, const D: usize>(
    py: Python<'py>,
    hull: Hull<D>,
    equations: Bound<'py, PyAny>,
) -> PyResult<HullArrays<'py>> {
    Ok((
        column(py, hull.vertices),
        table(py, hull.facets)?,
        table(py, hull.neighbors)?,
        equations,
        hull.volume,
        hull.area,
    ))
}

/// Values at the points of a triangulation.
#[pyclass(frozen, module = "breakline._breakline")]
pub(crate) struct Values {
    tessellation: Py<Tessellation>,
    field: Field,
    /// The number of rows of values.
    count: usize,
    /// The values outside of the hull.
    outside: Vec<f64>,
    tolerance: f64,
}

#[pymethods]
impl Values {
    /// Takes values of shape (n, k), one row for each point, and the row that positions outside of
    /// the hull get; outside by no more than a tolerance counts as inside.
    #[new]
    fn new(
        py: Python<'_>,
        tessellation: Py<Tessellation>,
        values: PyReadonlyArray2<'_, f64>,
        outside: Vec<f64>,
        tolerance: f64,
        call: Call,
    ) -> PyResult<Self> {
        let values = values.as_array().to_owned();
        let count = values.nrows();
        let field = tessellation.get().compute(py, &call, |any, _| {
            one_for_each_point(any, count)?;
            Result::Ok(of_dimension!(any, mesh => mesh.field(values.view())))
        })?;
        Ok(Values {
            tessellation,
            field: field?,
            count,
            outside,
            tolerance,
        })
    }

    /// Values that are linear on each simplex, at positions of shape (q, d): an array of shape
    /// (q * k,).
    fn linear<'py>(
        &self,
        py: Python<'py>,
        positions: Given<'py>,
        call: Call,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let values = self.tessellation.get().answer(
            py,
            &call,
            positions.read()?,
            |any, positions, cancel| {
                one_for_each_point(any, self.count)?;
                Result::Ok(at_positions!(any, positions, (mesh, at) => {
                    mesh.linear(at, &self.field, &self.outside, self.tolerance, cancel)
                }))
            },
        )?;
        Ok(column(py, values?))
    }

    /// Values by natural neighbors, at positions of shape (q, d): an array of shape (q * k,).
    fn natural<'py>(
        &self,
        py: Python<'py>,
        positions: Given<'py>,
        call: Call,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let values = self.tessellation.get().answer(
            py,
            &call,
            positions.read()?,
            |any, positions, cancel| {
                one_for_each_point(any, self.count)?;
                Result::Ok(at_positions!(any, positions, (mesh, at) => {
                    mesh.natural(at, &self.field, &self.outside, self.tolerance, cancel)
                }))
            },
        )?;
        Ok(column(py, values?))
    }
}

/// Values at the points of a triangulation of the plane, with gradients.
#[pyclass(frozen, module = "breakline._breakline")]
pub(crate) struct CubicValues {
    values: Py<Values>,
    surface: Surface,
}

#[pymethods]
impl CubicValues {
    /// Estimates gradients for values: until none changes by more than a tolerance, and in at most
    /// so many rounds.
    #[new]
    fn new(
        py: Python<'_>,
        values: Py<Values>,
        tolerance: f64,
        rounds: usize,
        call: Call,
    ) -> PyResult<Self> {
        let limits = Limits { tolerance, rounds };
        let of = values.get();
        let gradients = of.tessellation.get().compute(py, &call, |any, cancel| {
            one_for_each_point(any, of.count)?;
            let gradients = plane(any)?.gradients(&of.field, limits, cancel);
            Result::Ok(gradients)
        })??;
        let surface = Surface::new(gradients);
        Ok(CubicValues { values, surface })
    }

    /// True if gradients changed by no more than the tolerance at the end.
    #[getter]
    fn has_converged(&self) -> bool {
        self.surface.gradients().have_converged
    }

    /// The gradients at the points: an array of shape (n, k, 2).
    fn gradients<'py>(&self, py: Python<'py>, call: Call) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let of = self.values.get();
        let gradients = of.tessellation.get().compute(py, &call, |any, _| {
            one_for_each_point(any, of.count)?;
            Result::Ok(plane(any)?.gradients_at_points(self.surface.gradients()))
        })??;
        Ok(gradients.into_pyarray(py))
    }

    /// Cubic values at positions of shape (q, 2): an array of shape (q * k,).
    fn at<'py>(
        &self,
        py: Python<'py>,
        positions: Given<'py>,
        call: Call,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let of = self.values.get();
        let values = of.tessellation.get().answer(
            py,
            &call,
            positions.read()?,
            |any, positions, cancel| {
                one_for_each_point(any, of.count)?;
                let (mesh, Positions::Plane(at)) = (plane(any)?, positions) else {
                    return Err(not_of_the_plane());
                };
                let data = (&of.field, &self.surface);
                Result::Ok(mesh.cubic(at, data, &of.outside, of.tolerance, cancel))
            },
        )?;
        Ok(column(py, values?))
    }
}

/// Returns a triangulation of the plane.
///
/// # Errors
/// If it is one of space.
fn plane(any: &Any) -> Result<&Mesh<Plane, 3, 2>> {
    match any {
        Any::Plane(mesh) => Ok(mesh),
        Any::Space(_) => Err(not_of_the_plane()),
    }
}

#[cold]
fn not_of_the_plane() -> Failure {
    Error::usage("this mode of interpolation is available for 2-D data only")
        .cure("use LinearNDInterpolator or NaturalNeighborInterpolator")
        .into()
}

/// Points may have been added since the values were given.
///
/// # Errors
/// If there are more or fewer values than points.
fn one_for_each_point(any: &Any, values: usize) -> Result<()> {
    let points = of_dimension!(any, mesh => mesh.point_count());
    if values == points {
        return Ok(());
    }
    let error = Error::usage(format!(
        "different number of values and points: {values} values, {points} points"
    ));
    Err(error
        .cure("give one value for each point; after `add_points`, make a new interpolator")
        .into())
}

/// Returns the error of points that were refused; it names the first of them.
#[cold]
fn refused<const D: usize>(error: &InputError, points: &[[f64; D]]) -> Failure {
    let (row, refused) = match *error {
        InputError::NotFinite(row) => {
            let point = &points[row];
            let refused = Error::usage(format!(
                "the point is at {point:?}: points cannot contain NaN or infinity"
            ));
            let cure = "leave such points out: points[numpy.isfinite(points).all(axis=1)]";
            (row, refused.cure(cure))
        }
        InputError::Coordinate(row) => {
            let (point, Range { min, max }) = (&points[row], Adaptive::RANGE);
            let expected = format!("expected coordinates of 0 or between {min:.0e} and {max:.0e}");
            let refused = Error::limit(format!("the point is at {point:?}, {expected}"));
            (row, refused.cure("scale the coordinates"))
        }
        InputError::Canceled => return Failure(Error::canceled()),
        error => return Failure(Error::limit(error.to_string())),
    };
    Failure(refused.at(format!("row {row}")))
}
