//! Turns twins of edges into neighbors of faces.

use crate::parallel::*;
use crate::tds::{CellId, Links, VertexId};

use super::chunks;
use super::faces::Edge;
use super::grain::Grain;

/// A cell of each vertex.
pub(super) struct CellsOfVertices {
    pub(super) of_vertices: Vec<CellId>,
    pub(super) of_infinite: CellId,
}

/// What one thread found among the faces of a range of vertices.
struct FoundInRange {
    has_finite: bool,
    infinite: Option<CellId>,
    /// Cells of vertices in other ranges.
    elsewhere: Vec<(VertexId, CellId)>,
}

/// Replaces twins of edges by the neighbors opposite vertices; `None` if no face is finite.
///
/// Most faces that were built with a range of points still have vertices in that range, so that
/// threads can fill ranges of the cells of vertices. The ranges do not depend on the number of
/// threads, and therefore neither do the cells.
pub(super) fn finish(
    faces: &mut [Links<3>],
    count: usize,
    grain: Grain,
) -> Option<CellsOfVertices> {
    let mut of_vertices = chunks::filled(count, grain.points, || CellId::NONE);
    let ranges = of_vertices
        .par_chunks_mut(grain.points)
        .zip(faces.par_chunks_mut(2 * grain.points))
        .enumerate();
    let found: Vec<FoundInRange> = ranges
        .map(|(i, (cells, faces))| finish_range(faces, cells, i * grain.points))
        .collect();
    if !found.iter().any(|found| found.has_finite) {
        return None;
    }
    for &(vertex, cell) in found.iter().flat_map(|found| &found.elsewhere) {
        let known = &mut of_vertices[vertex.index()];
        if *known == CellId::NONE {
            *known = cell;
        }
    }
    let of_infinite = found.iter().find_map(|found| found.infinite)?;
    Some(CellsOfVertices {
        of_vertices,
        of_infinite,
    })
}

/// Converts the faces of the vertices from number `first` on.
fn finish_range(faces: &mut [Links<3>], cells: &mut [CellId], first: usize) -> FoundInRange {
    let mut found = FoundInRange {
        has_finite: false,
        infinite: None,
        elsewhere: Vec::new(),
    };
    for (i, links) in faces.iter_mut().enumerate() {
        let cell = CellId::new(2 * first + i);
        let offsets = links
            .vertices
            .map(|vertex| vertex.index().wrapping_sub(first));
        // `PERF:` one branch for nearly all faces instead of three.
        if offsets[0].max(offsets[1]).max(offsets[2]) < cells.len() {
            offsets.into_iter().for_each(|i| cells[i] = cell);
        } else {
            for (vertex, offset) in links.vertices.into_iter().zip(offsets) {
                match cells.get_mut(offset) {
                    Some(known) => *known = cell,
                    None if vertex == VertexId::INFINITE => found.infinite = Some(cell),
                    None => found.elsewhere.push((vertex, cell)),
                }
            }
        }
        found.has_finite |= links.vertices[2] != VertexId::INFINITE;
        // The edge from vertex 0 to 1 lies opposite vertex 2, and so on.
        let [a, b, c] = links
            .neighbors
            .map(|twin| CellId::new(Edge::of(twin).face() as usize));
        links.neighbors = [b, c, a];
    }
    found
}
