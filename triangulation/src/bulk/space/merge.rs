//! Joins parts of one triangulation.
//!
//! Every vertex of a cell that is in no block is a vertex of an open cell of its own block:
//! otherwise all cells around it would have stayed. So the triangulation of the vertices of open
//! cells, the *residual* one, has all missing cells. Its other cells fill the space of those that
//! stayed. The facets between the two, *seams*, are in both: a flood from each seam toward the side
//! that is filled already finds what is to be left out.

use crate::parallel::*;
use crate::tds::{CellId, Links};

use super::cell::Cell;
use super::part::{Built, Facet, Part, Seam, facet};

/// Returns the ranks of the vertices of open cells.
pub(super) fn residual(parts: &[Part]) -> Vec<u32> {
    let mut ranks: Vec<u32> = parts
        .iter()
        .flat_map(|part| part.open.iter().copied())
        .collect();
    ranks.sort_unstable();
    ranks
}

/// Returns the cells of the residual triangulation that are covered by parts. `None` if the
/// predicates contradict each other.
pub(super) fn covered(parts: &[Part], cells: &[Cell], ranks: &[u32]) -> Option<Vec<u32>> {
    let seams = Seams::of(parts);
    // The seams of each cell, one bit each.
    let mut of_cells = vec![0u8; cells.len()];
    let mut is_covered = vec![false; cells.len()];
    let mut covered = Vec::new();
    for (number, cell) in (0u32..).zip(cells).filter(|(_, cell)| cell.is_used()) {
        let vertices = cell
            .vertices
            .map(|vertex| ranks.get(vertex as usize).copied().unwrap_or(u32::MAX));
        // Each facet once.
        for (face, beyond) in (0..4)
            .zip(cell.neighbors)
            .filter(|&(_, beyond)| beyond >> 2 > number)
        {
            let (sorted, is_odd) = facet(vertices, face);
            let Some(seam) = seams.find(sorted) else {
                continue;
            };
            of_cells[number as usize] |= 1 << face;
            of_cells[(beyond >> 2) as usize] |= 1 << (beyond & 3);
            let on_the_side_of_the_part = if seam == is_odd { number } else { beyond >> 2 };
            if !std::mem::replace(&mut is_covered[on_the_side_of_the_part as usize], true) {
                covered.push(on_the_side_of_the_part);
            }
        }
    }
    let mut done = 0;
    while let Some(&number) = covered.get(done) {
        done += 1;
        let cell = &cells[number as usize];
        // Parts that stay are finite.
        if cell
            .vertices
            .iter()
            .any(|&vertex| vertex as usize >= ranks.len())
        {
            return None;
        }
        for (face, neighbor) in cell
            .neighbors
            .map(|neighbor| neighbor >> 2)
            .into_iter()
            .enumerate()
        {
            if of_cells[number as usize] >> face & 1 == 0 && !is_covered[neighbor as usize] {
                is_covered[neighbor as usize] = true;
                covered.push(neighbor);
            }
        }
    }
    Some(covered)
}

/// Numbers the cells of parts one after the other, and links them at their seams. `None` if seams
/// are not those of exactly two parts, or if no cell is infinite: then the predicates contradict
/// each other.
pub(super) fn joined(count: usize, parts: Vec<Part>) -> Option<Built> {
    let mut of_vertices = vec![CellId::NONE; count];
    let mut of_infinite = CellId::NONE;
    let mut seams: Vec<(Facet, CellId, usize)> = Vec::new();
    let mut links = Vec::new();
    for part in parts {
        let first = links.len();
        let numbered = |cell: CellId| {
            if cell == CellId::NONE {
                cell
            } else {
                CellId::new(first + cell.index())
            }
        };
        part.cells_of_vertices()
            .for_each(|(rank, cell)| of_vertices[rank] = numbered(cell));
        if part.of_infinite != CellId::NONE {
            of_infinite = numbered(part.of_infinite);
        }
        seams.extend(
            part.seams
                .iter()
                .map(|seam| (seam.facet, numbered(seam.cell), seam.face)),
        );
        if first == 0 {
            links = part.links;
        } else {
            let moved = |cell: Links<4>| Links {
                neighbors: cell.neighbors.map(numbered),
                ..cell
            };
            links.par_extend(part.links.into_par_iter().map(moved));
        }
    }
    if of_infinite == CellId::NONE {
        return None;
    }
    links.shrink_to_fit();

    seams.par_sort_unstable();
    for pair in seams.chunks(2) {
        let &[((facet, false), a, i), ((other, true), b, j)] = pair else {
            return None;
        };
        if facet != other {
            return None;
        }
        links[a.index()].neighbors[i] = b;
        links[b.index()].neighbors[j] = a;
    }
    Some(Built {
        links,
        of_vertices,
        of_infinite,
    })
}

/// The seams of parts, by their vertices: an open hash table.
struct Seams<'a> {
    seams: Vec<&'a Seam>,
    /// The lower half of a hash, and the number of a seam, from 1.
    slots: Vec<u64>,
}

impl<'a> Seams<'a> {
    fn of(parts: &'a [Part]) -> Self {
        let seams: Vec<&Seam> = parts.iter().flat_map(|part| &part.seams).collect();
        let slots = vec![0; (2 * seams.len()).next_power_of_two().max(2)];
        let mut table = Seams { seams, slots };
        for (number, seam) in (1u64..).zip(&table.seams) {
            let hash = hash(seam.facet.0);
            let mut slot = table.first_slot(hash);
            while table.slots[slot] != 0 {
                slot = table.next_slot(slot);
            }
            table.slots[slot] = hash << 32 | number;
        }
        table
    }

    fn first_slot(&self, hash: u64) -> usize {
        (hash >> 32) as usize & (self.slots.len() - 1)
    }

    fn next_slot(&self, slot: usize) -> usize {
        (slot + 1) & (self.slots.len() - 1)
    }

    /// Returns whether an odd permutation sorts a seam as its part sees it; `None` if the facet is
    /// not a seam.
    fn find(&self, facet: [u32; 3]) -> Option<bool> {
        let hash = hash(facet);
        let mut slot = self.first_slot(hash);
        while self.slots[slot] != 0 {
            let (lower, number) = (self.slots[slot] >> 32, self.slots[slot] as u32);
            // PERF: that of another facet is hardly ever read.
            if lower == hash & u64::from(u32::MAX) {
                let (sorted, is_odd) = self.seams[number as usize - 1].facet;
                if sorted == facet {
                    return Some(is_odd);
                }
            }
            slot = self.next_slot(slot);
        }
        None
    }
}

fn hash(facet: [u32; 3]) -> u64 {
    let mixed = facet.into_iter().fold(0u64, |bits, vertex| {
        (bits.rotate_left(29) ^ u64::from(vertex)).wrapping_mul(0x9E37_79B9_7F4A_7C15)
    });
    mixed ^ mixed >> 32
}
