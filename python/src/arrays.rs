//! Arrays of numpy to numbers, and numbers to arrays.

use numpy::ndarray::{Array2, ArrayView2, Dimension};
use numpy::{
    Element, IntoPyArray, PyArray, PyArray1, PyArrayMethods, PyReadonlyArray2,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Returns the rows of an array as points, in any layout of memory.
pub(crate) fn rows<T: Element + Copy + Default, const N: usize>(
    array: ArrayView2<'_, T>,
) -> Vec<[T; N]> {
    // In C order the rows are next to each other already.
    if let Some(flat) = array.as_slice().filter(|_| array.ncols() == N) {
        return flat.as_chunks().0.to_vec();
    }
    let row = |row: numpy::ndarray::ArrayView1<'_, T>| {
        let mut point = [T::default(); N];
        point.iter_mut().zip(row).for_each(|(to, from)| *to = *from);
        point
    };
    array.rows().into_iter().map(row).collect()
}

/// Returns true if all numbers of an array are where the processor expects them: arrays made by
/// numpy are, those over the bytes of others may not be.
pub(crate) fn is_aligned<T, D>(array: &Bound<'_, PyArray<T, D>>) -> bool
where
    T: Element,
    D: Dimension,
{
    let multiple = align_of::<T>() as isize;
    array.data().is_aligned() && array.strides().iter().all(|&stride| stride % multiple == 0)
}

/// Returns the rows of an array of positions, copied so that other threads may change it meanwhile.
pub(crate) fn points<const N: usize>(array: &PyReadonlyArray2<'_, f64>) -> Vec<[f64; N]> {
    rows(array.as_array())
}

/// So few numbers are copied to an array sooner than an object is made that owns their vector.
const FEW: usize = 64;

/// Returns an array of the numbers of a vector, which are not copied unless they are few.
pub(crate) fn column<T: Element>(py: Python<'_>, values: Vec<T>) -> Bound<'_, PyArray1<T>> {
    if values.len() <= FEW {
        return PyArray1::from_slice(py, &values);
    }
    values.into_pyarray(py)
}

/// Returns an array of the rows of a vector, which are not copied.
pub(crate) fn table<T: Element, const N: usize>(
    py: Python<'_>,
    rows: Vec<[T; N]>,
) -> PyResult<Bound<'_, PyAny>> {
    let count = rows.len();
    shaped(py, rows.into_flattened(), [count, N])
}

/// Returns a vector as an array of this shape, row by row, without a copy.
///
/// # Errors
/// If the shape is for another number of them.
pub(crate) fn shaped<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    shape: [usize; 2],
) -> PyResult<Bound<'_, PyAny>> {
    // In one step: an array that is reshaped is two objects.
    let array = Array2::from_shape_vec(shape, values);
    let array = array.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(array.into_pyarray(py).into_any())
}

/// Makes an array read-only, for one that is kept and given to everyone who asks.
pub(crate) fn read_only<'py>(array: &Bound<'py, PyAny>) -> PyResult<()> {
    array.call_method1("setflags", (false,)).map(drop)
}
