//! Triangulates many points in space at once, by insertion in an order that suits the memory.
//!
//! The algorithm is that of Bowyer and Watson (1981): the cells whose circumscribed spheres contain
//! the new point, its conflict zone, are replaced by the star of the point. All speed lies in how
//! little is done for each cell.
//!
//! 1. [`order`]: points are inserted in rounds, each along a curve, so that a walk from the last
//!    star is about three cells long.
//! 2. [`sphere`]: each cell has its sphere, rounded, with the error that it is known to have.
//!    Nearly all tests are decided by it, four at a time; the others by the geometry.
//! 3. [`mesh`]: the star is built in the memory of the zone, and linked by a small table in which
//!    each edge of the zone's boundary finds the two facets that it belongs to.
//!
//! Points may have weights: then the spheres are those that are orthogonal to the points' own
//! (Edelsbrunner and Shah 1996), and a point in conflict with nothing is hidden.
//!
//! Ties are broken as everywhere else, so that the cells are those of any other algorithm. Where
//! the predicates are seen to contradict each other (it may happen with
//! [`Fast`](crate::kernel::Fast)), the builder gives up and the caller inserts the points one by
//! one.

mod mesh;
mod order;
mod sphere;
#[cfg(test)]
mod tests;
mod weights;

use crate::geometry::{Coordinates, in_sphere, in_sphere_of_flat};
use crate::num::Sign;
use crate::tds::{CellId, Links, VertexId};

use super::Grain;
use mesh::{Cell, DUMMY, Mesh, Predicates};
use weights::Weights;

/// The largest number of points. Evenly spread ones have about 7 cells each, which are numbered in
/// 30 bits; where points have more (on the moment curve half as many as there are points), that is
/// checked.
const MAX_POINTS: usize = 1 << 27;

/// So many points are inserted before it is asked whether to stop.
const POLL: usize = 1 << 12;

/// Cells that fill their numbers, a cell of each vertex, and a cell of the infinite one.
pub(super) struct Built {
    pub(super) links: Vec<Links<4>>,
    pub(super) of_vertices: Vec<CellId>,
    pub(super) of_infinite: CellId,
}

/// Triangulates sites that are [exact](Coordinates::exact_site); vertices are numbered like the
/// points, and hidden ones have no cell. `None` if the sites are coplanar, fewer than four or too
/// many, if the predicates contradict each other, or if the work was stopped.
///
/// # Complexity
/// Linear in practice; quadratic at worst, as is the result.
pub(super) fn build<G: Coordinates<N>, const N: usize>(
    geometry: &G,
    points: &[G::Point],
    grain: Grain,
) -> Option<Built> {
    if !(4..=MAX_POINTS).contains(&points.len()) {
        return None;
    }
    let point = |rank: u32| &points[rank as usize];
    let simplex = |vertices: [u32; 4]| std::array::from_fn::<_, N, _>(|i| point(vertices[i & 3]));
    let orientation = |vertices: [u32; 4]| geometry.orientation(simplex(vertices));
    let mut order = order::rounds(points.len());
    let first = first_cell(geometry, points, orientation, &mut order)?;
    let predicates = Predicates {
        orientation: &orientation,
        in_sphere: &|vertices, q| in_sphere(geometry, simplex(vertices), point(q)),
        in_circle: &|facet, q| in_sphere_of_flat::<G, N>(geometry, &facet.map(point), point(q)),
    };
    let exact = points.iter().map(|p| geometry.exact_site(p).unwrap_or([f64::NAN; 4]));
    let weights = Weights::new(exact.clone().map(|[.., weight]| weight));
    let sites = exact.map(|[x, y, z, _]| [x, y, z]);
    insert_all(Mesh::new(sites, weights, first, predicates), &order[4..], grain)
}

/// Moves the first four points that span the space to the front of the order; returns them as a
/// positive cell.
fn first_cell<G: Coordinates<N>, const N: usize>(
    geometry: &G,
    points: &[G::Point],
    orientation: impl Fn([u32; 4]) -> Sign,
    order: &mut [u32],
) -> Option<[u32; 4]> {
    let turn = |corners: [u32; 3]| geometry.orientation_in_flat(&corners.map(|rank| &points[rank as usize]));
    let third = (2..order.len()).find(|&i| turn([order[0], order[1], order[i]]) != Sign::Zero)?;
    order.swap(2, third);
    let [a, b, c] = [order[0], order[1], order[2]];
    let fourth = (3..order.len()).find(|&i| orientation([a, b, c, order[i]]) != Sign::Zero)?;
    order.swap(3, fourth);
    let d = order[3];
    Some(if orientation([a, b, c, d]) == Sign::Positive { [a, b, c, d] } else { [b, a, c, d] })
}

fn insert_all(mut mesh: Mesh, order: &[u32], grain: Grain) -> Option<Built> {
    for chunk in order.chunks(POLL) {
        if grain.stops() {
            return None;
        }
        for &vertex in chunk {
            mesh.insert(vertex).ok()?;
        }
    }
    finished(mesh)
}

/// Closes the gaps in the numbers of cells and gives vertices and cells their ids. `None` if no
/// cell is infinite, which happens only if predicates contradict each other.
fn finished(mesh: Mesh) -> Option<Built> {
    let (mut cells, mut gaps, count) = mesh.into_parts();
    gaps.push(DUMMY);
    gaps.sort_unstable();
    // The last cells move into the gaps.
    for &gap in &gaps {
        while cells.last().is_some_and(|cell| !cell.is_used()) {
            cells.pop();
        }
        if gap as usize >= cells.len() {
            break;
        }
        if let Some(moved) = cells.pop() {
            cells[gap as usize] = moved;
            for (i, neighbor) in (0u32..).zip(moved.neighbors) {
                cells[(neighbor >> 2) as usize].neighbors[(neighbor & 3) as usize] = 4 * gap + i;
            }
        }
    }
    let mut of_vertices = vec![CellId::NONE; count];
    let mut of_infinite = CellId::NONE;
    for (i, cell) in cells.iter().enumerate() {
        for &vertex in &cell.vertices {
            *of_vertices.get_mut(vertex as usize).unwrap_or(&mut of_infinite) = CellId::new(i);
        }
    }
    if of_infinite == CellId::NONE {
        return None;
    }
    let vertex = |rank: u32| if rank as usize == count { VertexId::INFINITE } else { VertexId::new(rank as usize) };
    let links = |cell: Cell| Links {
        vertices: cell.vertices.map(vertex),
        neighbors: cell.neighbors.map(|neighbor| CellId::new((neighbor >> 2) as usize)),
    };
    // In place.
    let mut links: Vec<Links<4>> = cells.into_iter().map(links).collect();
    links.shrink_to_fit();
    Some(Built { links, of_vertices, of_infinite })
}
