//! Triangulates many points in space at once, by insertion in an order that suits the memory.
//!
//! The algorithm is that of Bowyer and Watson (1981): the cells whose circumscribed spheres contain
//! the new point, its conflict zone, are replaced by the star of the point. All speed lies in how
//! little is done for each cell.
//!
//! 1. [`order`]: points are inserted in rounds, each along a curve, so that a walk from the last
//!    star is about three cells long.
//! 2. [`sphere`]: each cell has its sphere, rounded, with the error that it is known to have.
//!    Nearly all tests are decided by it, four at a time; the others by [`predicates`].
//! 3. [`mesh`]: the star is built in the memory of the zone, and linked by a small table in which
//!    each edge of the zone's boundary finds the two facets that it belongs to.
//!
//! Where a [sample](blocks) shows that it is worth it, the points are divided into blocks of space,
//! which threads triangulate on their own; what depends on several blocks is triangulated again
//! ([`merge`]). The blocks are a function of the points, not of the number of threads.
//!
//! Points may have weights: then the spheres are those that are orthogonal to the points' own
//! (Edelsbrunner and Shah 1996), and a point in conflict with nothing is hidden.
//!
//! Ties are broken as everywhere else, so that the cells are those of any other algorithm. Where
//! the predicates are seen to contradict each other (it may happen with
//! [`Fast`](crate::kernel::Fast)), the builder gives up and the caller inserts the points one by
//! one.

mod blocks;
mod cell;
mod merge;
mod mesh;
mod order;
mod part;
mod predicates;
mod source;
mod sphere;
#[cfg(test)]
mod tests;
mod weights;

use crate::geometry::Coordinates;
use crate::num::Sign;
use crate::parallel::*;

use super::grain::Grain;
use blocks::{Block, Blocks};
use mesh::{Extent, Mesh};
use part::{Built, Part};
use source::{Source, with_source};

/// The largest number of points. Evenly spread ones have about 7 cells each, which are numbered in
/// 30 bits; where points have more (on the moment curve half as many as there are points), that is
/// checked.
const MAX_POINTS: usize = 1 << 27;

/// The number of points that are inserted between two looks at the flag that stops the work.
const POLL: u32 = 1 << 12;

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
    with_source(geometry, points, |source| triangulate(source, grain))
}

/// Triangulates all points, in blocks if that is worth it.
fn triangulate(source: Source, grain: Grain) -> Option<Built> {
    let extent = Extent::of(source);
    let divided = divided(source, extent, grain);
    divided
        .and_then(|blocks| by_blocks(source, extent, &blocks, grain))
        .or_else(|| whole(source, extent, grain))
}

/// Triangulates all points as one block.
fn whole(source: Source, extent: Extent, grain: Grain) -> Option<Built> {
    let ranks: Vec<u32> = (0..source.count as u32).collect();
    let (cells, unused) = meshed(source, extent, &ranks, grain)?.into_cells();
    merge::joined(source.count, vec![Part::of(cells, unused, &[], &ranks)])
}

/// Returns blocks whose triangulations are nearly that of the whole; `None` if there are none, by a
/// sample.
fn divided(source: Source, extent: Extent, grain: Grain) -> Option<Blocks> {
    let levels = blocks::levels(source.count);
    if levels == 0 {
        return None;
    }
    let ranks = order::sample(source.count);
    let mut sites: Vec<[f64; 3]> = ranks.iter().map(|&rank| source.position(rank)).collect();
    let blocks = Blocks::of(&mut sites, levels, extent.frame)?;
    let mesh = meshed(source, extent, &ranks, grain)?;
    blocks
        .are_worth_it(source.count, mesh.spheres())
        .then_some(blocks)
}

/// Triangulates blocks, each on its own, and merges them. `None` also if the points of a block are
/// coplanar.
fn by_blocks(source: Source, extent: Extent, blocks: &Blocks, grain: Grain) -> Option<Built> {
    let mut ranks: Vec<Vec<u32>> = blocks.each().iter().map(|_| Vec::new()).collect();
    for rank in 0..source.count as u32 {
        ranks[blocks.index_of(source.position(rank))].push(rank);
    }
    let parts: Vec<Option<Part>> = ranks
        .par_iter()
        .zip(blocks.each().par_iter())
        .map(|(ranks, block)| by_block(source, extent, ranks, block, grain))
        .collect();
    let mut parts = parts.into_iter().collect::<Option<Vec<Part>>>()?;
    let residual = merge::residual(&parts);
    let (cells, unused) = meshed(source, extent, &residual, grain)?.into_cells();
    let covered = merge::covered(&parts, &cells, &residual)?;
    parts.push(Part::of(cells, unused, &covered, &residual));
    merge::joined(source.count, parts)
}

/// Triangulates the points of a block, and leaves out the cells that other points may be in
/// conflict with.
fn by_block<'a>(
    source: Source<'a>,
    extent: Extent,
    ranks: &'a [u32],
    block: &Block,
    grain: Grain,
) -> Option<Part<'a>> {
    let mesh = meshed(source, extent, ranks, grain)?;
    let open = mesh.open_cells(block);
    let (cells, unused) = mesh.into_cells();
    Some(Part::of(cells, unused, &open, ranks))
}

/// Returns the mesh of points, given by ascending ranks. Vertex `i` is the point of rank
/// `ranks[i]`.
fn meshed<'a>(
    source: Source<'a>,
    extent: Extent,
    ranks: &'a [u32],
    grain: Grain,
) -> Option<Mesh<'a>> {
    let mut order = order::rounds(ranks);
    let first = first_cell(source, ranks, &mut order)?;
    let mut mesh = Mesh::new(source, extent, ranks, first);
    for (done, &vertex) in (4u32..).zip(&order[4..]) {
        if done % POLL == 0 && grain.stops() {
            return None;
        }
        mesh.insert(vertex).ok()?;
    }
    Some(mesh)
}

/// Moves the first four vertices that span the space to the front; returns them as a positive cell.
fn first_cell(source: Source, ranks: &[u32], order: &mut [u32]) -> Option<[u32; 4]> {
    let rank = |vertex: u32| ranks[vertex as usize];
    let turn = |order: &[u32], i: usize| (source.turn)([order[0], order[1], order[i]].map(rank));
    let third = (2..order.len()).find(|&i| turn(order, i) != Sign::Zero)?;
    order.swap(2, third);
    let side = |order: &[u32], i: usize| {
        (source.orientation)([order[0], order[1], order[2], order[i]].map(rank))
    };
    let fourth = (3..order.len()).find(|&i| side(order, i) != Sign::Zero)?;
    order.swap(3, fourth);
    let [a, b, c, d] = *order.first_chunk()?;
    Some(if side(order, 3) == Sign::Positive {
        [a, b, c, d]
    } else {
        [b, a, c, d]
    })
}
