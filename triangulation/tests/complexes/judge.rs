//! A naive judge of complexes: lists of cells, and faces counted in sets.

use std::collections::{BTreeMap, BTreeSet};

use breakline_triangulation::tds::{Tds, VertexId};

pub(crate) type Cell = Vec<usize>;

/// Returns all faces with this many vertices.
pub(crate) fn faces(cells: &[Cell], size: usize) -> BTreeSet<Cell> {
    let mut faces = BTreeSet::new();
    for cell in cells {
        for subset in 0u32..1 << cell.len() {
            if subset.count_ones() as usize == size {
                let mut face: Cell = (0..cell.len())
                    .filter(|k| subset >> k & 1 == 1)
                    .map(|k| cell[k])
                    .collect();
                face.sort_unstable();
                faces.insert(face);
            }
        }
    }
    faces
}

pub(crate) fn euler(cells: &[Cell]) -> i64 {
    let width = cells.first().map_or(0, Vec::len);
    (1..=width)
        .map(|size| if size % 2 == 1 { 1 } else { -1 } * faces(cells, size).len() as i64)
        .sum()
}

/// Returns the link of a vertex: what remains of its cells.
pub(crate) fn link(cells: &[Cell], vertex: usize) -> Vec<Cell> {
    let with = cells.iter().filter(|cell| cell.contains(&vertex));
    with.map(|cell| cell.iter().copied().filter(|&v| v != vertex).collect())
        .collect()
}

/// Returns true if cells cannot be divided into two groups without a common vertex.
fn is_connected(cells: &[Cell]) -> bool {
    let mut reached = BTreeSet::from_iter(cells.first().into_iter().flatten().copied());
    for _ in cells {
        for cell in cells {
            if cell.iter().any(|v| reached.contains(v)) {
                reached.extend(cell);
            }
        }
    }
    cells
        .iter()
        .all(|cell| cell.iter().any(|v| reached.contains(v)))
}

/// Returns true if each facet is in two cells and each link is a sphere, in dimensions up to 2.
pub(crate) fn is_manifold(cells: &[Cell]) -> bool {
    let width = cells.first().map_or(0, Vec::len);
    let distinct: BTreeSet<Cell> = cells
        .iter()
        .map(|cell| BTreeSet::from_iter(cell).into_iter().copied().collect())
        .collect();
    if distinct.len() != cells.len() || distinct.iter().any(|cell| cell.len() != width) {
        return false;
    }
    if width == 1 {
        return true;
    }
    let facets = faces(cells, width - 1);
    let on_two = |facet: &Cell| {
        distinct
            .iter()
            .filter(|cell| facet.iter().all(|v| cell.contains(v)))
            .count()
            == 2
    };
    facets.iter().all(on_two)
        && faces(cells, 1)
            .iter()
            .all(|v| is_sphere(&link(cells, v[0])))
}

/// Returns true if cells form a sphere, of dimension up to 2.
pub(crate) fn is_sphere(cells: &[Cell]) -> bool {
    match cells.first().map_or(0, Vec::len) {
        1 => cells.len() == 2 && cells[0] != cells[1],
        2 => is_manifold(cells) && is_connected(cells),
        3 => is_manifold(cells) && is_connected(cells) && euler(cells) == 2,
        _ => false,
    }
}

/// Returns true if each facet appears once in either orientation.
pub(crate) fn is_oriented(cells: &[Cell]) -> bool {
    let mut turns: BTreeMap<Cell, Vec<bool>> = BTreeMap::new();
    for cell in cells {
        for i in 0..cell.len() {
            let mut facet: Cell = (0..cell.len())
                .filter(|&k| k != i)
                .map(|k| cell[k])
                .collect();
            let mut odd = i % 2 == 1;
            for a in 0..facet.len() {
                for b in a + 1..facet.len() {
                    odd ^= facet[a] > facet[b];
                }
            }
            facet.sort_unstable();
            turns.entry(facet).or_default().push(odd);
        }
    }
    turns
        .values()
        .all(|turns| turns.len() == 2 && turns[0] != turns[1])
}

/// Returns true if the constructor has to accept the cells.
pub(crate) fn is_sound(vertices: usize, cells: &[Cell]) -> bool {
    let used: BTreeSet<usize> = cells.iter().flatten().copied().collect();
    used.len() == vertices
        && used.iter().all(|&v| v < vertices)
        && is_manifold(cells)
        && is_oriented(cells)
}

/// Returns the cells of a complex, each by the numbers of its vertices.
pub(crate) fn cells_of<const N: usize, V, C: Copy + Default>(tds: &Tds<N, V, C>) -> Vec<Cell> {
    tds.cells()
        .map(|cell| tds.cell_vertices(cell).iter().map(|v| v.index()).collect())
        .collect()
}

pub(crate) fn build<const N: usize>(
    vertices: usize,
    cells: &[Cell],
) -> Result<Tds<N, usize>, breakline_triangulation::tds::TdsError> {
    let cells: Vec<[VertexId; N]> = cells
        .iter()
        .map(|cell| std::array::from_fn(|k| VertexId::new(cell[k])))
        .collect();
    Tds::from_cells((0..vertices).collect(), &cells)
}
