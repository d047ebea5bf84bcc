//! A drop-in for the package `triangle`: from arrays to the content of Triangle's files and the
//! other way round. The switches are read in `breakline/triangle.py`.

use std::mem::take;
use std::path::Path;

use breakline::io::triangle::{Edge, Hole, LineGraph, Nodes, Region, Segment, Triangulated};
use breakline::run::{Context, Silent, TriangulateOptions, TriangulateProduct, triangulate_graph};
use breakline::triangulation::refine::Shortfall;
use numpy::{Element, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{points, rows, shaped, table};
use crate::errors::{self, Result};
use crate::work::{self, Call};

/// The name of the input in errors.
const NAME: &str = "the dict";

/// Arrays of a planar straight-line graph, all C-contiguous.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Graph<'py> {
    /// Of shape (n, 2).
    vertices: PyReadonlyArray2<'py, f64>,
    /// Of shape (n, k).
    vertex_attributes: PyReadonlyArray2<'py, f64>,
    /// Of shape (n,).
    vertex_markers: PyReadonlyArray1<'py, i32>,
    /// Of shape (m, 2).
    segments: PyReadonlyArray2<'py, u32>,
    /// Of shape (m,).
    segment_markers: PyReadonlyArray1<'py, i32>,
    /// Of shape (h, 2).
    holes: PyReadonlyArray2<'py, f64>,
    /// Of shape (r, 4): a site, an attribute, a largest area.
    regions: PyReadonlyArray2<'py, f64>,
}

/// Switches of Triangle.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Switches {
    convex: bool,
    min_angle: Option<f64>,
    max_area: Option<f64>,
    region_areas: bool,
    max_added: Option<usize>,
}

/// Triangulates a planar straight-line graph. Returns arrays by the names of the package
/// `triangle`, each of which is given once, and the number of triangles that are not as the
/// switches require.
#[pyfunction]
pub(crate) fn triangulate_arrays<'py>(
    py: Python<'py>,
    graph: Graph<'py>,
    switches: Switches,
    names: Vec<String>,
    call: Call,
) -> PyResult<(Bound<'py, PyDict>, usize)> {
    let Switches {
        convex,
        min_angle,
        max_area,
        region_areas,
        max_added,
    } = switches;
    let mut graph = graph.read();
    if !region_areas {
        // Without the switch they are not missed.
        graph
            .regions
            .iter_mut()
            .for_each(|region| region.max_area = None);
    }
    let options = TriangulateOptions {
        convex,
        min_angle,
        max_area,
        region_areas,
        max_added,
        ..Default::default()
    };
    let product = match triangulated_here(py, &call, &graph, &options)? {
        Some(product) => product,
        None => work::run(py, &call, |context| -> Result<_> {
            Ok(triangulate_graph(
                &graph,
                Path::new(NAME),
                &options,
                context,
            )?)
        })?,
    };
    Ok((
        arrays(py, product.triangulated, &names)?,
        product.report.shortfall.len(),
    ))
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

impl Graph<'_> {
    fn read(&self) -> LineGraph {
        let segments = rows::<u32, 2>(self.segments.as_array());
        let regions = rows::<f64, 4>(self.regions.as_array());
        let holes = points::<2>(&self.holes);
        let markers = self.segment_markers.as_array();
        LineGraph {
            nodes: Nodes {
                first_number: 0,
                points: points(&self.vertices),
                attribute_count: self.vertex_attributes.shape()[1],
                attributes: self.vertex_attributes.as_array().iter().copied().collect(),
                markers: self.vertex_markers.as_array().to_vec(),
            },
            node_file: NAME.into(),
            segments: (0..)
                .zip(segments.into_iter().zip(markers))
                .map(|(line, (ends, &marker))| Segment {
                    ends,
                    marker,
                    number: line as i64,
                    line,
                })
                .collect(),
            holes: (0..)
                .zip(holes)
                .map(|(line, at)| Hole { at, line })
                .collect(),
            regions: (0..)
                .zip(regions)
                .map(|(line, [x, y, attribute, area])| Region {
                    at: [x, y],
                    attribute,
                    max_area: (area > 0.0).then_some(area),
                    line,
                })
                .collect(),
            ..LineGraph::default()
        }
    }
}

/// Returns the arrays of a triangulation that have these names in the package `triangle`.
fn arrays<'py>(
    py: Python<'py>,
    triangulated: Triangulated,
    names: &[String],
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
        let array = match name.as_str() {
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
