//! Surfaces and 3-manifolds, as consistently oriented cells.

use std::collections::BTreeMap;

use crate::judge::Cell;

/// Returns the cells with their vertices renumbered in order of appearance.
fn renumbered(cells: &[Cell]) -> (usize, Vec<Cell>) {
    let mut numbers = BTreeMap::new();
    let cells = cells.iter().map(|cell| {
        cell.iter()
            .map(|v| {
                let next = numbers.len();
                *numbers.entry(*v).or_insert(next)
            })
            .collect()
    });
    let cells = cells.collect();
    (numbers.len(), cells)
}

/// Returns the border of a simplex with this many vertices.
pub(crate) fn simplex(vertices: usize) -> (usize, Vec<Cell>) {
    let facet = |i: usize| {
        let mut cell: Cell = (0..vertices).filter(|&k| k != i).collect();
        if i % 2 == 1 {
            cell.swap(0, 1);
        }
        cell
    };
    (vertices, (0..vertices).map(facet).collect())
}

/// Joins cells to two more vertices.
pub(crate) fn suspension((vertices, cells): (usize, Vec<Cell>)) -> (usize, Vec<Cell>) {
    let above = cells.iter().map(|cell| [&cell[..], &[vertices]].concat());
    let below = cells
        .iter()
        .map(|cell| [&[cell[1], cell[0]], &cell[2..], &[vertices + 1]].concat());
    let cells = above.chain(below).collect();
    (vertices + 2, cells)
}

pub(crate) fn octahedron() -> (usize, Vec<Cell>) {
    suspension((4, (0..4).map(|k| vec![k, (k + 1) % 4]).collect()))
}

/// Returns a grid of squares with its sides glued; `glue` returns the vertex at a row's end.
fn glued(width: usize, height: usize, glue: impl Fn(usize, usize) -> usize) -> (usize, Vec<Cell>) {
    let mut cells = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let [a, b, c, d] =
                [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)].map(|(x, y)| glue(x, y));
            cells.extend([vec![a, b, c], vec![a, c, d]]);
        }
    }
    (width * height, cells)
}

pub(crate) fn torus(width: usize, height: usize) -> (usize, Vec<Cell>) {
    glued(width, height, |x, y| x % width + width * (y % height))
}

/// Glues the right side to the left one upside down.
pub(crate) fn klein_bottle(width: usize, height: usize) -> (usize, Vec<Cell>) {
    glued(width, height, |x, y| {
        let y = if x == width { 2 * height - y } else { y };
        x % width + width * (y % height)
    })
}

/// Removes the first cell of both shapes and identifies its vertices.
pub(crate) fn connected_sum(
    (m, a): (usize, Vec<Cell>),
    (_, b): (usize, Vec<Cell>),
) -> (usize, Vec<Cell>) {
    let (left, right) = (a[0].clone(), b[0].clone());
    // The second is seen from behind: its vertices 1 and 2 are exchanged in the match.
    let turned = [left[1], left[0]]
        .into_iter()
        .chain(left[2..].iter().copied());
    let matched: BTreeMap<usize, usize> = right.iter().copied().zip(turned).collect();
    let map = |v: usize| matched.get(&v).copied().unwrap_or(m + v);
    let rest = b[1..]
        .iter()
        .map(|cell| cell.iter().map(|&v| map(v)).collect());
    renumbered(&a[1..].iter().cloned().chain(rest).collect::<Vec<_>>())
}

/// Returns a grid of cubes of six tetrahedra each, opposite sides glued.
pub(crate) fn three_torus(side: usize) -> (usize, Vec<Cell>) {
    let number = |p: [usize; 3]| p.iter().fold(0, |n, x| n * side + x % side);
    let mut cells = Vec::new();
    for cube in 0..side.pow(3) {
        let corner = [cube / side / side, cube / side % side, cube % side];
        for (order, is_odd) in [([0, 1, 2], false), ([1, 2, 0], false), ([2, 0, 1], false)]
            .into_iter()
            .flat_map(|(o, _)| [(o, false), ([o[1], o[0], o[2]], true)])
        {
            let mut p = corner;
            let mut cell = vec![number(p)];
            for axis in order {
                p[axis] += 1;
                cell.push(number(p));
            }
            if is_odd {
                cell.swap(0, 1);
            }
            cells.push(cell);
        }
    }
    (side.pow(3), cells)
}

/// Returns the disjoint union of two shapes.
pub(crate) fn both((m, a): (usize, Vec<Cell>), (n, b): (usize, Vec<Cell>)) -> (usize, Vec<Cell>) {
    let moved = b
        .into_iter()
        .map(|cell| cell.into_iter().map(|v| v + m).collect());
    (m + n, a.into_iter().chain(moved).collect())
}
