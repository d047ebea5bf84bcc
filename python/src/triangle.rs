//! A drop-in for the package `triangle`: from arrays to the content of Triangle's files and the
//! other way round. The switches are read in `breakline/triangle.py`.

use std::mem::take;
use std::path::Path;

use breakline::io::triangle::{Edge, Hole, LineGraph, Nodes, Region, Segment, Triangulated};
use breakline::run::{Context, Silent, TriangulateOptions, TriangulateProduct, triangulate_graph};
use breakline::triangulation::refine::Shortfall;
use numpy::{Element, PyArray2, PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::arrays::{is_aligned, rows, shaped, table};
use crate::errors::{self, Result};
use crate::work::{self, Call};

/// The name of the input in errors.
const NAME: &str = "the dict";

/// Switches of Triangle.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Switches {
    /// True if segments, holes and regions are used.
    lines: bool,
    convex: bool,
    min_angle: Option<f64>,
    max_area: Option<f64>,
    region_areas: bool,
    max_added: Option<usize>,
    ignore_holes: bool,
    /// True if holes and regions are in the result as they were given.
    return_given: bool,
    /// The arrays of the result by their names in the package `triangle`, each once. Those of
    /// attributes are left out if there are none.
    names: Vec<String>,
}

/// Switches that were read: once for all calls with the same ones.
#[pyclass(frozen, module = "breakline._breakline")]
pub(crate) struct TriangleSwitches(Switches);

#[pymethods]
impl TriangleSwitches {
    #[new]
    fn new(switches: Switches) -> Self {
        TriangleSwitches(switches)
    }
}

/// Triangulates a planar straight-line graph, given by the arrays that the package `triangle` has.
/// Returns the arrays of the result by their names, and the number of triangles that are not as the
/// switches require; `None` if the graph is not one of plain arrays, or something is wrong with it,
/// which `breakline/triangle.py` finds out.
#[pyfunction]
pub(crate) fn triangulate_arrays<'py>(
    py: Python<'py>,
    tri: &Bound<'py, PyAny>,
    switches: &TriangleSwitches,
    call: Call,
) -> PyResult<Option<(Bound<'py, PyDict>, usize)>> {
    let TriangleSwitches(switches) = switches;
    let Ok(given) = tri.cast::<PyDict>().map_err(drop).and_then(|tri| {
        // A subclass may have other items than it stores.
        if !tri.is_exact_instance_of::<PyDict>() {
            return Err(());
        }
        Given::read(tri, switches).map_err(drop)
    }) else {
        return Ok(None);
    };
    let graph = &given.graph;
    let options = TriangulateOptions {
        convex: switches.convex,
        min_angle: switches.min_angle,
        max_area: switches.max_area,
        region_areas: switches.region_areas && !graph.regions.is_empty(),
        max_added: switches.max_added,
        ..Default::default()
    };
    let product = match triangulated_here(py, &call, graph, &options)? {
        Some(product) => product,
        None => work::run(py, &call, |context| -> Result<_> {
            Ok(triangulate_graph(
                graph,
                Path::new(NAME),
                &options,
                context,
            )?)
        })?,
    };
    let short = product.report.shortfall.len();
    let (has_attributes, has_regions) =
        (graph.nodes.attribute_count > 0, !graph.regions.is_empty());
    let names = switches.names.iter().map(String::as_str);
    let names = names.filter(|&name| match name {
        "vertex_attributes" => has_attributes,
        "triangle_attributes" => has_regions,
        _ => true,
    });
    let arrays = arrays(py, product.triangulated, names)?;
    if switches.return_given {
        if let Some(holes) = given.holes {
            arrays.set_item(intern!(py, "holes"), table(py, holes)?)?;
        }
        if let Some(regions) = given.regions {
            arrays.set_item(intern!(py, "regions"), table(py, regions)?)?;
        }
    }
    Ok(Some((arrays, short)))
}

/// The number of vertices that the calling thread may add. It takes some 30 ms, less than until the
/// next look for signals.
const TRIED: usize = 1 << 14;

/// Triangulates on the calling thread; `None` if that would take too long.
///
/// How many vertices an angle needs is not known before: two lines near each other need as many as
/// their distance says. So it is tried, and few points seldom need more.
fn triangulated_here(
    py: Python<'_>,
    call: &Call,
    graph: &LineGraph,
    options: &TriangulateOptions,
) -> PyResult<Option<TriangulateProduct>> {
    let most = options.max_added.unwrap_or(usize::MAX);
    let limited = TriangulateOptions {
        max_added: match options.min_angle {
            Some(_) => Some(most.min(TRIED)),
            None => options.max_added,
        },
        ..options.clone()
    };
    work::run_few(py, call, expected(graph, options), |context| {
        // An attempt that is given up must not report what the next one reports again.
        let silent = Context {
            monitor: &Silent,
            ..*context
        };
        let product = triangulate_graph(graph, Path::new(NAME), &limited, &silent)?;
        let is_cut = limited.max_added.is_some_and(|limit| limit < most)
            && product.report.shortfall.contains(&Shortfall::Limit);
        if is_cut {
            return Result::Ok(None);
        }
        product
            .notices
            .iter()
            .for_each(|notice| context.monitor.notice(notice));
        Ok(Some(product))
    })
    .map(Option::flatten)
}

/// Returns about how many vertices a mesh may have, but for those that angles need.
fn expected(graph: &LineGraph, options: &TriangulateOptions) -> usize {
    let points = &graph.nodes.points;
    let extent = |axis: usize| {
        let along = points.iter().map(|p| p[axis]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    };
    let of_regions = graph.regions.iter().filter_map(|region| region.max_area);
    let areas = of_regions.chain(options.max_area);
    let by_area = areas.map(|area| extent(0) * extent(1) / area).sum::<f64>();
    // A conversion that saturates.
    (by_area as usize).saturating_add(points.len() + graph.segments.len())
}

/// A graph that was read, and the holes and regions as they were given.
struct Given {
    graph: LineGraph,
    holes: Option<Vec<[f64; 2]>>,
    regions: Option<Vec<[f64; 4]>>,
}

/// There is something else than a plain array of what is expected.
struct NotPlain;

type Plain<T> = std::result::Result<T, NotPlain>;

impl Given {
    /// Reads plain arrays: exactly of type `ndarray`, of the types that the package returns.
    fn read(tri: &Bound<'_, PyDict>, switches: &Switches) -> Plain<Self> {
        let py = tri.py();
        let points = finite::<2>(tri, intern!(py, "vertices"))?.ok_or(NotPlain)?;
        let count = points.len();
        if count < 3 {
            return Err(NotPlain);
        }
        let name = intern!(py, "vertex_attributes");
        if plain(tri, name)?.is_some_and(|array| array.shape().first() != Some(&count)) {
            return Err(NotPlain);
        }
        let attributes = column::<f64>(tri, name)?.unwrap_or_default();
        let mut graph = LineGraph {
            nodes: Nodes {
                first_number: 0,
                points,
                attribute_count: attributes.len() / count,
                attributes,
                markers: markers(tri, intern!(py, "vertex_markers"), count)?,
            },
            node_file: NAME.into(),
            ..LineGraph::default()
        };
        if !switches.lines {
            let (holes, regions) = (None, None);
            return Ok(Given {
                graph,
                holes,
                regions,
            });
        }
        graph.segments = segments(tri, count)?;
        let holes = finite::<2>(tri, intern!(py, "holes"))?;
        let regions = finite::<4>(tri, intern!(py, "regions"))?;
        let used = holes.iter().flatten().filter(|_| !switches.ignore_holes);
        graph.holes = (0..)
            .zip(used)
            .map(|(line, &at)| Hole { at, line })
            .collect();
        graph.regions = (0..)
            .zip(regions.iter().flatten())
            .map(|(line, &[x, y, attribute, area])| Region {
                at: [x, y],
                attribute,
                // Without the switch they are not missed.
                max_area: (switches.region_areas && area > 0.0).then_some(area),
                line,
            })
            .collect();
        Ok(Given {
            graph,
            holes,
            regions,
        })
    }
}

/// Returns the segments between so many vertices.
fn segments(tri: &Bound<'_, PyDict>, count: usize) -> Plain<Vec<Segment>> {
    let py = tri.py();
    let Some(array) = plain(tri, intern!(py, "segments"))? else {
        // Markers alone are refused.
        return match plain(tri, intern!(py, "segment_markers"))? {
            Some(_) => Err(NotPlain),
            None => Ok(Vec::new()),
        };
    };
    let ends: Vec<[i64; 2]> = match array.cast::<PyArray2<i32>>() {
        Ok(array) => {
            let ends = table_of::<i32, 2>(array)?.into_iter();
            ends.map(|ends| ends.map(i64::from)).collect()
        }
        Err(_) => table_of(array.cast::<PyArray2<i64>>().map_err(|_| NotPlain)?)?,
    };
    let markers = markers(tri, intern!(py, "segment_markers"), ends.len())?;
    let vertex = |end: i64| u32::try_from(end).ok().filter(|&v| (v as usize) < count);
    let segment = |(line, ([a, b], marker)): (usize, ([i64; 2], i32))| {
        Some(Segment {
            ends: [vertex(a)?, vertex(b)?],
            marker,
            number: line as i64,
            line,
        })
    };
    let all = ends.into_iter().zip(markers).enumerate();
    all.map(segment).collect::<Option<_>>().ok_or(NotPlain)
}

/// Returns the array with a name, if there is one.
fn plain<'py>(
    tri: &Bound<'py, PyDict>,
    name: &Bound<'py, PyString>,
) -> Plain<Option<Bound<'py, PyUntypedArray>>> {
    let Some(value) = tri.get_item(name).map_err(|_| NotPlain)? else {
        return Ok(None);
    };
    // Masked arrays are of a subclass.
    if !value.is_exact_instance_of::<PyUntypedArray>() {
        return Err(NotPlain);
    }
    value.cast_into().map(Some).map_err(|_| NotPlain)
}

/// Returns the rows of an array, copied.
fn table_of<T: Element + Copy + Default, const N: usize>(
    array: &Bound<'_, PyArray2<T>>,
) -> Plain<Vec<[T; N]>> {
    if array.shape()[1] != N || !is_aligned(array) {
        return Err(NotPlain);
    }
    let array = array.try_readonly().map_err(|_| NotPlain)?;
    Ok(rows(array.as_array()))
}

/// Returns the rows of an array of finite numbers, if there is one with this name.
fn finite<const N: usize>(
    tri: &Bound<'_, PyDict>,
    name: &Bound<'_, PyString>,
) -> Plain<Option<Vec<[f64; N]>>> {
    let Some(array) = plain(tri, name)? else {
        return Ok(None);
    };
    let rows = table_of(array.cast::<PyArray2<f64>>().map_err(|_| NotPlain)?)?;
    let are_finite = rows.as_flattened().iter().all(|x| x.is_finite());
    are_finite.then_some(Some(rows)).ok_or(NotPlain)
}

/// Returns the numbers of an array of any shape, if there is one with this name.
fn column<T: Element + Copy>(
    tri: &Bound<'_, PyDict>,
    name: &Bound<'_, PyString>,
) -> Plain<Option<Vec<T>>> {
    let Some(array) = plain(tri, name)? else {
        return Ok(None);
    };
    let array = array.cast::<PyArrayDyn<T>>().map_err(|_| NotPlain)?;
    if !is_aligned(array) {
        return Err(NotPlain);
    }
    let array = array.try_readonly().map_err(|_| NotPlain)?;
    Ok(Some(array.as_array().iter().copied().collect()))
}

/// Returns so many markers; zeros if there are none.
fn markers(tri: &Bound<'_, PyDict>, name: &Bound<'_, PyString>, count: usize) -> Plain<Vec<i32>> {
    let markers = column(tri, name)?.unwrap_or_else(|| vec![0; count]);
    if markers.len() == count {
        Ok(markers)
    } else {
        Err(NotPlain)
    }
}

/// Returns the arrays of a triangulation that have these names in the package `triangle`.
fn arrays<'py, 'a>(
    py: Python<'py>,
    triangulated: Triangulated,
    names: impl Iterator<Item = &'a str>,
) -> PyResult<Bound<'py, PyDict>> {
    let Triangulated {
        mut nodes,
        triangles,
        neighbors,
        mut attributes,
        edges,
        segments,
        ..
    } = triangulated;
    let number = |index: u32| index as i32;
    let beside = |neighbor: Option<u32>| neighbor.map_or(-1, number);
    let ends = |edges: &[Edge]| table(py, edges.iter().map(|edge| edge.ends.map(number)).collect());
    let markers = |edges: &[Edge]| single(py, edges.iter().map(|edge| edge.marker).collect());
    let count = nodes.points.len();
    let arrays = PyDict::new(py);
    for name in names {
        let array = match name {
            "vertices" => table(py, take(&mut nodes.points)),
            "vertex_attributes" => {
                let shape = [count, nodes.attribute_count];
                shaped(py, take(&mut nodes.attributes), shape)
            }
            "vertex_markers" => single(py, take(&mut nodes.markers)),
            "triangles" => table(py, triangles.iter().map(|t| t.map(number)).collect()),
            "neighbors" => table(py, neighbors.iter().map(|t| t.map(beside)).collect()),
            "triangle_attributes" => single(py, take(&mut attributes)),
            "edges" => ends(&edges),
            "edge_markers" => markers(&edges),
            "segments" => ends(&segments),
            "segment_markers" => markers(&segments),
            other => Err(errors::internal(&format!("no array is called {other}"))),
        };
        arrays.set_item(name, array?)?;
    }
    Ok(arrays)
}

/// Returns an array of one column.
fn single<T: Element>(py: Python<'_>, values: Vec<T>) -> PyResult<Bound<'_, PyAny>> {
    let count = values.len();
    shaped(py, values, [count, 1])
}
