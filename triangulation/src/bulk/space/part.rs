//! The cells of a mesh that stay, in numbers without gaps.

use crate::tds::{CellId, Links, VertexId};

use super::cell::{Cell, DUMMY, FACETS};

/// Cells that fill their numbers, a cell of each vertex, and a cell of the infinite one.
pub(crate) struct Built {
    pub(crate) links: Vec<Links<4>>,
    pub(crate) of_vertices: Vec<CellId>,
    pub(crate) of_infinite: CellId,
}

/// The neighbor of a cell that is in another part.
const ELSEWHERE: u32 = u32::MAX;

/// A facet between parts.
#[derive(Clone, Copy)]
pub(super) struct Seam {
    /// The ranks of its vertices, sorted; and true if an odd permutation sorts them as seen from
    /// the cell.
    pub(super) facet: Facet,
    /// In the part.
    pub(super) cell: CellId,
    pub(super) face: usize,
}

/// Three ranks, sorted; and true if an odd permutation has sorted them.
pub(super) type Facet = ([u32; 3], bool);

/// Returns a facet of a cell.
pub(super) fn facet(vertices: [u32; 4], face: usize) -> Facet {
    let [a, b, c] = FACETS[face].map(|k| vertices[k]);
    // PERF: without branches.
    let (least, greatest) = (a.min(b).min(c), a.max(b).max(c));
    (
        [least, a ^ b ^ c ^ least ^ greatest, greatest],
        (a > b) ^ (b > c) ^ (a > c),
    )
}

/// The cells of a mesh that stay.
pub(super) struct Part<'a> {
    /// Seams have no neighbor.
    pub(super) links: Vec<Links<4>>,
    /// The points of the vertices, by their ranks; that of the infinite vertex is not among them.
    ranks: &'a [u32],
    /// A cell of each vertex, or none, and one of the infinite vertex.
    of_vertices: Vec<CellId>,
    pub(super) of_infinite: CellId,
    /// The facets beyond which another part begins.
    pub(super) seams: Vec<Seam>,
    /// The ranks of the vertices of cells that were left out, ascending.
    pub(super) open: Vec<u32>,
}

impl<'a> Part<'a> {
    /// Leaves cells out, and closes the gaps that they and unused ones leave in the numbers.
    pub(super) fn of(
        mut cells: Vec<Cell>,
        mut gaps: Vec<u32>,
        left_out: &[u32],
        ranks: &'a [u32],
    ) -> Self {
        let mut is_open = vec![false; if left_out.is_empty() { 0 } else { ranks.len() }];
        for &cell in left_out {
            for vertex in
                std::mem::replace(&mut cells[cell as usize].vertices, Cell::UNUSED.vertices)
            {
                if let Some(is_open) = is_open.get_mut(vertex as usize) {
                    *is_open = true;
                }
            }
        }
        for &cell in left_out {
            for face in cells[cell as usize].neighbors {
                let beyond = &mut cells[(face >> 2) as usize];
                if beyond.is_used() {
                    beyond.neighbors[(face & 3) as usize] = ELSEWHERE;
                }
            }
        }
        gaps.extend(left_out);
        close_gaps(&mut cells, gaps);

        let mut of_vertices = vec![CellId::NONE; ranks.len() + 1];
        let mut seams = Vec::new();
        let rank = |vertex: u32| ranks.get(vertex as usize).copied();
        let links = |(number, cell): (usize, Cell)| {
            for vertex in cell.vertices {
                of_vertices[vertex as usize] = CellId::new(number);
            }
            for face in (0..4).filter(|&face| cell.neighbors[face] == ELSEWHERE) {
                let vertices = cell.vertices.map(|vertex| rank(vertex).unwrap_or(u32::MAX));
                seams.push(Seam {
                    facet: facet(vertices, face),
                    cell: CellId::new(number),
                    face,
                });
            }
            Links {
                vertices: cell.vertices.map(|v| {
                    rank(v).map_or(VertexId::INFINITE, |rank| VertexId::new(rank as usize))
                }),
                neighbors: cell.neighbors.map(|face| match face {
                    ELSEWHERE => CellId::NONE,
                    face => CellId::new((face >> 2) as usize),
                }),
            }
        };
        // In place.
        let links = cells.into_iter().enumerate().map(links).collect();
        let of_infinite = of_vertices.pop().unwrap_or(CellId::NONE);
        let open = ranks
            .iter()
            .zip(is_open)
            .filter_map(|(&rank, is_open)| is_open.then_some(rank))
            .collect();
        Part {
            links,
            ranks,
            of_vertices,
            of_infinite,
            seams,
            open,
        }
    }

    /// Returns the cell of each vertex that has one: its rank, and the number of the cell.
    pub(super) fn cells_of_vertices(&self) -> impl Iterator<Item = (usize, CellId)> {
        let cells = self
            .ranks
            .iter()
            .map(|&rank| rank as usize)
            .zip(self.of_vertices.iter().copied());
        cells.filter(|&(_, cell)| cell != CellId::NONE)
    }
}

/// Moves the last cells into gaps.
fn close_gaps(cells: &mut Vec<Cell>, mut gaps: Vec<u32>) {
    gaps.push(DUMMY);
    gaps.sort_unstable();
    for gap in gaps {
        while cells.last().is_some_and(|cell| !cell.is_used()) {
            cells.pop();
        }
        if gap as usize >= cells.len() {
            break;
        }
        if let Some(moved) = cells.pop() {
            cells[gap as usize] = moved;
            for (i, face) in (0u32..).zip(moved.neighbors) {
                if face != ELSEWHERE {
                    cells[(face >> 2) as usize].neighbors[(face & 3) as usize] = 4 * gap + i;
                }
            }
        }
    }
}
