//! Lists of different lengths, one behind the other.

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyList;
use rayon::prelude::*;

use crate::arrays::column;

/// Items per parallel task: points, simplices or lists.
pub(super) const CHUNK: usize = 1 << 12;

/// List `k` has the numbers `items[starts[k]..starts[k + 1]]`.
#[derive(Default)]
pub(super) struct Lists {
    pub(super) starts: Vec<i64>,
    pub(super) items: Vec<i32>,
}

/// Some of the lists: the length of each, and their numbers.
#[derive(Default)]
pub(super) struct Part {
    lengths: Vec<i32>,
    items: Vec<i32>,
}

impl Part {
    pub(super) fn push(&mut self, list: &[i32]) {
        self.lengths.push(list.len() as i32);
        self.items.extend_from_slice(list);
    }
}

impl FromIterator<Part> for Lists {
    fn from_iter<I: IntoIterator<Item = Part>>(parts: I) -> Self {
        let mut lists = Lists {
            starts: vec![0],
            items: Vec::new(),
        };
        let mut end = 0;
        for part in parts {
            for length in part.lengths {
                end += i64::from(length);
                lists.starts.push(end);
            }
            lists.items.extend(part.items);
        }
        lists
    }
}

impl Lists {
    /// Returns the list of each item, in order. `list_of` gets an empty vector and adds the
    /// numbers.
    pub(super) fn of<T: Sync>(items: &[T], list_of: impl Fn(&T, &mut Vec<i32>) + Sync) -> Self {
        let of_chunk = |items: &[T]| {
            let (mut part, mut list) = (Part::default(), Vec::new());
            for item in items {
                list.clear();
                list_of(item, &mut list);
                part.push(&list);
            }
            part
        };
        let parts: Vec<Part> = items.par_chunks(CHUNK).map(of_chunk).collect();
        parts.into_iter().collect()
    }

    /// Returns two arrays: where each list begins, and what they contain.
    pub(super) fn arrays(
        self,
        py: Python<'_>,
    ) -> (Bound<'_, PyArray1<i64>>, Bound<'_, PyArray1<i32>>) {
        (column(py, self.starts), column(py, self.items))
    }
}

/// Returns lists of lists, from where each begins and what they contain. Equal numbers are one
/// object, which takes less memory than one for each.
#[pyfunction]
pub(crate) fn nested_lists<'py>(
    py: Python<'py>,
    starts: PyReadonlyArray1<'py, i64>,
    items: PyReadonlyArray1<'py, i32>,
) -> PyResult<Bound<'py, PyList>> {
    let (starts, items) = (starts.as_slice()?, items.as_slice()?);
    let most = items.iter().max().map_or(0, |&most| i64::from(most) + 1);
    // -1 is the first.
    let numbers: Vec<Bound<'py, PyAny>> = (-1..most)
        .map(|number| number.into_pyobject(py).map(Bound::into_any))
        .collect::<Result<_, _>>()?;
    let list = |ends: &[i64]| {
        let range = ends[0] as usize..ends[1] as usize;
        let items = items.get(range).unwrap_or_default();
        PyList::new(
            py,
            items
                .iter()
                .filter_map(|&item| numbers.get((item + 1) as usize))
                .collect::<Vec<_>>(),
        )
    };
    let rows = starts.windows(2).map(list).collect::<PyResult<Vec<_>>>()?;
    PyList::new(py, rows)
}
