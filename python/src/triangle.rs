//! A drop-in for the package `triangle`: from arrays to the content of Triangle's files and the
//! other way round. The switches are read in `breakline/triangle.py`.

use std::path::Path;

use breakline::io::triangle::{Edge, Hole, LineGraph, Nodes, Region, Segment, Triangulated};
use breakline::run::{TriangulateOptions, triangulate_graph};
use numpy::{PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{column, points, rows, table};
use crate::errors::Result;
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

/// Triangulates a planar straight-line graph. Returns arrays of all that Triangle can return, and
/// the number of triangles that are not as the switches require.
#[pyfunction]
pub(crate) fn triangulate_arrays<'py>(
    py: Python<'py>,
    graph: Graph<'py>,
    switches: Switches,
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
    let count = expected(&graph, &options);
    let product = work::run_on(py, &call, Some(count), |context| -> Result<_> {
        Ok(triangulate_graph(
            &graph,
            Path::new(NAME),
            &options,
            context,
        )?)
    })?;
    Ok((
        arrays(py, product.triangulated)?,
        product.report.shortfall.len(),
    ))
}

/// Returns about how many vertices a mesh may have.
fn expected(graph: &LineGraph, options: &TriangulateOptions) -> usize {
    let points = &graph.nodes.points;
    let extent = |axis: usize| {
        let along = points.iter().map(|p| p[axis]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    };
    let of_regions = graph.regions.iter().filter_map(|region| region.max_area);
    let areas = of_regions.chain(options.max_area);
    let by_area = areas.map(|area| extent(0) * extent(1) / area).sum::<f64>();
    let given = points.len() + graph.segments.len();
    // A conversion that saturates.
    let added = (by_area as usize).saturating_add(match options.min_angle {
        // Two lines near each other need as many vertices as their distance says.
        Some(_) => options.max_added.unwrap_or(usize::MAX),
        None => 0,
    });
    given.saturating_add(added)
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

/// Returns the arrays of a triangulation, by the names of the package `triangle`.
fn arrays(py: Python<'_>, triangulated: Triangulated) -> PyResult<Bound<'_, PyDict>> {
    let Triangulated {
        nodes,
        triangles,
        neighbors,
        attributes,
        edges,
        segments,
        ..
    } = triangulated;
    let number = |index: u32| index as i32;
    let beside = |neighbor: Option<u32>| neighbor.map_or(-1, number);
    let ends = |edges: &[Edge]| table(py, edges.iter().map(|edge| edge.ends.map(number)).collect());
    let markers = |edges: &[Edge]| table(py, edges.iter().map(|edge| [edge.marker]).collect());
    let single =
        |markers: Vec<i32>| table(py, markers.into_iter().map(|marker| [marker]).collect());
    let arrays = PyDict::new(py);
    let of_vertices = [nodes.points.len(), nodes.attribute_count];
    arrays.set_item("vertices", table(py, nodes.points)?)?;
    arrays.set_item(
        "vertex_attributes",
        column(py, nodes.attributes).reshape(of_vertices)?,
    )?;
    arrays.set_item("vertex_markers", single(nodes.markers)?)?;
    arrays.set_item(
        "triangles",
        table(py, triangles.into_iter().map(|t| t.map(number)).collect())?,
    )?;
    arrays.set_item(
        "neighbors",
        table(py, neighbors.into_iter().map(|t| t.map(beside)).collect())?,
    )?;
    arrays.set_item(
        "triangle_attributes",
        table(py, attributes.into_iter().map(|value| [value]).collect())?,
    )?;
    arrays.set_item("edges", ends(&edges)?)?;
    arrays.set_item("edge_markers", markers(&edges)?)?;
    arrays.set_item("segments", ends(&segments)?)?;
    arrays.set_item("segment_markers", markers(&segments)?)?;
    Ok(arrays)
}
