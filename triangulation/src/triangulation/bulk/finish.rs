//! From twins of edges to neighbors of faces.

use crate::parallel::*;
use crate::tds::{CellId, Links, VertexId};

use super::Grain;
use super::faces::Edge;

/// A cell of each vertex.
pub(super) struct Cells {
    pub(super) of_vertices: Vec<CellId>,
    pub(super) of_infinite: CellId,
}

/// What one thread found among the faces of a range of vertices.
struct Found {
    has_finite: bool,
    infinite: Option<CellId>,
    /// Cells of vertices that other ranges have.
    elsewhere: Vec<(VertexId, CellId)>,
}

/// Replaces twins of edges by the neighbors opposite vertices; `None` if no face is finite.
///
/// Most faces that are made with a range of points are at these points still, so that threads can fill
/// ranges of the cells of vertices. The ranges do not depend on the number of threads, and so the cells do not.
pub(super) fn finish(faces: &mut [Links<3>], count: usize, grain: Grain) -> Option<Cells> {
    let mut of_vertices: Vec<CellId> =
        (0..count).into_par_iter().with_min_len(grain.points).map(|_| CellId::NONE).collect();
    let ranges = of_vertices.par_chunks_mut(grain.points).zip(faces.par_chunks_mut(2 * grain.points)).enumerate();
    let found: Vec<Found> = ranges.map(|(i, (cells, faces))| finish_range(faces, cells, i * grain.points)).collect();
    if !found.iter().any(|found| found.has_finite) {
        return None;
    }
    for &(vertex, cell) in found.iter().flat_map(|found| &found.elsewhere) {
        let place = &mut of_vertices[vertex.index()];
        if *place == CellId::NONE {
            *place = cell;
        }
    }
    let of_infinite = found.iter().find_map(|found| found.infinite)?;
    Some(Cells { of_vertices, of_infinite })
}

/// The faces of the vertices from number `first` on.
fn finish_range(faces: &mut [Links<3>], cells: &mut [CellId], first: usize) -> Found {
    let mut found = Found { has_finite: false, infinite: None, elsewhere: Vec::new() };
    for (i, links) in faces.iter_mut().enumerate() {
        let cell = CellId::new(2 * first + i);
        let places = links.vertices.map(|vertex| vertex.index().wrapping_sub(first));
        // `PERF:` one branch for nearly all faces instead of three.
        if places[0].max(places[1]).max(places[2]) < cells.len() {
            places.into_iter().for_each(|place| cells[place] = cell);
        } else {
            for (vertex, place) in links.vertices.into_iter().zip(places) {
                match cells.get_mut(place) {
                    Some(place) => *place = cell,
                    None if vertex == VertexId::INFINITE => found.infinite = Some(cell),
                    None => found.elsewhere.push((vertex, cell)),
                }
            }
        }
        found.has_finite |= links.vertices[2] != VertexId::INFINITE;
        // The edge from vertex 0 to 1 lies opposite vertex 2, and so on.
        let [a, b, c] = links.neighbors.map(|twin| CellId::new(Edge::of(twin).face() as usize));
        links.neighbors = [b, c, a];
    }
    found
}
