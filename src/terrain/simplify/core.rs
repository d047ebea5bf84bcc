//! Which sites a surface needs to stay within a bound of all of them.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use crate::triangulation::geometry::Terrain;
use crate::triangulation::{ConstrainedDelaunay, InputError, OnCrossing};

use super::edit::{Canceled, MayGo, go_on, hide_all, refine, thin};
use super::lattice::Lattice;
use super::lines::Lines;
use super::mesh::Mesh;
use super::sites::Sites;

/// The side of a block of a lattice, in cells.
const BLOCK_CELLS: u32 = 128;

/// About how many sites a block has that are on no lattice.
const BLOCK_SITES: usize = 10_000;

/// If removal leaves a share within this range of the vertices of a block, it is worth the time to
/// choose some of them again: where it takes more, there is little left to take; where it takes
/// next to nothing, nearly every site is needed.
const WORTH_MORE: Range<f64> = 0.83..0.9;

/// To choose again, vertices are removed up to these multiples of the bound.
const BEYOND: [f64; 2] = [1.5, 1.25];

/// Why sites could not be chosen.
#[derive(Debug)]
pub(super) enum Refused {
    Canceled,
    /// The triangulation refuses a site.
    Input(InputError),
}

impl From<Canceled> for Refused {
    fn from(_: Canceled) -> Self {
        Refused::Canceled
    }
}

impl From<InputError> for Refused {
    fn from(error: InputError) -> Self {
        Refused::Input(error)
    }
}

/// A division of the sites.
enum Blocks {
    /// Squares of cells; with the numbers of columns and rows of all.
    OfLattice([u32; 2]),
    OfScattered {
        /// The sites of each block, in the order of their numbers.
        sites: Vec<Vec<u32>>,
        /// The block of each site.
        block_of: Vec<u32>,
    },
}

impl Blocks {
    /// The blocks in which sites are chosen first: a function of the set of sites.
    fn of(sites: &Sites) -> Self {
        match sites {
            Sites::Scattered { positions, .. } => Blocks::of_scattered(positions),
            Sites::Lattice { lattice, .. } => Blocks::of_lattice(lattice),
        }
    }

    fn of_lattice(lattice: &Lattice) -> Self {
        let columns = lattice.heights.len() / lattice.rows.max(1) as usize;
        Blocks::OfLattice([columns as u32, lattice.rows])
    }

    /// Strips of as many sites each from west to east, and of each as many from south to north.
    fn of_scattered(sites: &[[f64; 3]]) -> Self {
        let count = sites.len().div_ceil(BLOCK_SITES).max(1);
        let strips = (count as f64).sqrt().ceil() as usize;
        let in_strip = count.div_ceil(strips);
        let share = |length: usize, parts: usize, k: usize| length * k / parts;
        let range_of = |length: usize, parts: usize, k: usize| {
            share(length, parts, k)..share(length, parts, k + 1)
        };
        let strips: Vec<Vec<Vec<u32>>> = (0..strips)
            .into_par_iter()
            .map(|k| {
                let all = range_of(sites.len(), strips, k);
                let mut strip: Vec<u32> = (all.start as u32..all.end as u32).collect();
                let by_y = |site: &u32| {
                    let [_, y, _] = sites[*site as usize];
                    y
                };
                strip.sort_unstable_by(|a, b| by_y(a).total_cmp(&by_y(b)).then(a.cmp(b)));
                let part = |k: usize| {
                    let mut part = strip[range_of(strip.len(), in_strip, k)].to_vec();
                    part.sort_unstable();
                    part
                };
                (0..in_strip).map(part).collect()
            })
            .collect();
        let blocks: Vec<Vec<u32>> = strips.into_iter().flatten().collect();
        let mut block_of = vec![0; sites.len()];
        for (block, sites) in blocks.iter().enumerate() {
            for &site in sites {
                block_of[site as usize] = block as u32;
            }
        }
        Blocks::OfScattered {
            sites: blocks,
            block_of,
        }
    }

    fn count(&self) -> usize {
        match self {
            Blocks::OfLattice([columns, rows]) => {
                (columns.div_ceil(BLOCK_CELLS) * rows.div_ceil(BLOCK_CELLS)) as usize
            }
            Blocks::OfScattered { sites, .. } => sites.len(),
        }
    }

    fn block_of(&self, site: u32) -> u32 {
        match self {
            Blocks::OfLattice([_, rows]) => {
                let [column, row] = [site / rows, site % rows];
                column / BLOCK_CELLS * rows.div_ceil(BLOCK_CELLS) + row / BLOCK_CELLS
            }
            Blocks::OfScattered { block_of, .. } => block_of[site as usize],
        }
    }

    /// The sites of a block in the order of their numbers, and how many of them are in a column, if
    /// they are on a lattice.
    fn sites(&self, block: usize) -> (Cow<'_, [u32]>, Option<u32>) {
        match self {
            &Blocks::OfLattice([columns, rows]) => {
                let tall = rows.div_ceil(BLOCK_CELLS);
                let range = |k: u32, end: u32| {
                    let first = k * BLOCK_CELLS;
                    first..end.min(first + BLOCK_CELLS)
                };
                let (x, y) = (
                    range(block as u32 / tall, columns),
                    range(block as u32 % tall, rows),
                );
                let in_column = y.len() as u32;
                let at = |column: u32| y.clone().map(move |row| column * rows + row);
                (Cow::Owned(x.flat_map(at).collect()), Some(in_column))
            }
            Blocks::OfScattered { sites, .. } => (Cow::Borrowed(&sites[block]), None),
        }
    }
}

/// Returns the sites that are needed, in the order of their numbers. All others are within the
/// bound of the Delaunay triangulation of these, constrained by what is left of the lines.
///
/// The result is a function of the set of sites and the bound.
///
/// # Complexity
/// O(n log n) in practice; the blocks on all threads, what joins them on one.
pub(super) fn choose(
    sites: &Sites,
    lines: &mut Lines,
    bound: f64,
    cancel: &AtomicBool,
) -> Result<Vec<u32>, Refused> {
    let blocks = Blocks::of(sites);
    let on_lines = lines.sites();
    let mut fixed: Vec<Vec<u32>> = vec![Vec::new(); blocks.count()];
    for &site in &on_lines {
        fixed[blocks.block_of(site) as usize].push(site);
    }
    let chosen: Vec<Vec<u32>> = (0..blocks.count())
        .into_par_iter()
        .with_max_len(1)
        .map(|block| {
            let (of_block, rows) = blocks.sites(block);
            choose_in(sites, &of_block, &fixed[block], rows, bound, cancel)
        })
        .collect::<Result<_, _>>()?;
    let mut chosen: Vec<u32> = chosen.concat();
    chosen.par_sort_unstable();
    if blocks.count() == 1 && lines.is_empty() {
        return Ok(chosen);
    }
    let edges: Vec<[u32; 2]> = lines.sorted().iter().map(|(ends, _)| *ends).collect();
    let Some(mut mesh) = triangulated(sites, bound, &chosen, &edges)? else {
        return Ok(chosen);
    };
    go_on(cancel)?;
    chosen.extend(refine(&mut mesh, cancel)?);
    chosen.sort_unstable();
    // Where the blocks did not know what is around it. What lines lose changes what is needed far
    // from them, too.
    let has_lines = lines.vertices_on_lines() > 0;
    let is_at_rim = |site: u32| on_lines.binary_search(&site).is_ok();
    let is_open = |vertex: u32, ring: &[u32]| {
        let block = blocks.block_of(vertex);
        let is_beyond = |&other: &u32| blocks.block_of(other) != block || is_at_rim(other);
        has_lines || ring.iter().any(is_beyond) || is_at_rim(vertex)
    };
    thin(&mut mesh, lines, &chosen, &is_open, cancel)?;
    chosen.retain(|&site| mesh.is_vertex(site));
    Ok(chosen)
}

/// The triangulation of chosen sites, with all others hidden and the worst of each triangle found;
/// `None` if they are on one line.
fn triangulated<'a>(
    sites: &'a Sites,
    bound: f64,
    chosen: &[u32],
    edges: &[[u32; 2]],
) -> Result<Option<Mesh<'a>>, InputError> {
    let points: Vec<[f64; 3]> = chosen.iter().map(|&site| sites.position(site)).collect();
    let position = |site: u32| chosen.partition_point(|&other| other < site) as u32;
    let lines: Vec<[u32; 2]> = edges.iter().map(|ends| ends.map(position)).collect();
    let (triangulation, vertices) =
        ConstrainedDelaunay::from_lines(Terrain::default(), &points, &lines, OnCrossing::Reject)?;
    if triangulation.dimension() < 2 {
        return Ok(None);
    }
    let mut mesh = Mesh::new(sites, bound, chosen, &triangulation, &vertices);
    if let Sites::Scattered { order, .. } = sites {
        hide_all(&mut mesh, order);
    }
    let measured: Vec<_> = (0..mesh.cell_slots())
        .into_par_iter()
        .with_min_len(1 << 10)
        .map(|cell| mesh.measured(cell))
        .collect();
    mesh.worst = measured;
    Ok(Some(mesh))
}

/// Returns the sites that are needed besides those that stay, in one block.
pub(super) fn choose_all(
    sites: &Sites,
    stay: &[u32],
    bound: f64,
    cancel: &AtomicBool,
) -> Result<Vec<u32>, Refused> {
    let all: Vec<u32> = (0..sites.count() as u32).collect();
    choose_in(sites, &all, stay, None, bound, cancel)
}

/// Returns the sites of a block that are needed for these.
fn choose_in(
    sites: &Sites,
    block: &[u32],
    fixed: &[u32],
    rows: Option<u32>,
    bound: f64,
    cancel: &AtomicBool,
) -> Result<Vec<u32>, Refused> {
    go_on(cancel)?;
    let local = sites.part(block, rows);
    let mut first = hull(&local, &local.may_be_at_hull());
    let position = |site: &u32| block.partition_point(|other| other < site) as u32;
    let fixed: Vec<u32> = fixed.iter().map(position).collect();
    first.extend(&fixed);
    first.sort_unstable();
    first.dedup();
    let named = |chosen: &[u32]| chosen.iter().map(|&site| block[site as usize]).collect();
    let Some(mut mesh) = triangulated(&local, bound, &first, &[])? else {
        return Ok(named(&local.with_heights().collect::<Vec<_>>()));
    };
    let may_go = |vertex: u32, _: &[u32]| fixed.binary_search(&vertex).is_err();
    first.extend(refine(&mut mesh, cancel)?);
    let inserted = first.len();
    thin(&mut mesh, &mut Lines::default(), &first, &may_go, cancel)?;
    first.retain(|&site| mesh.is_vertex(site));
    if WORTH_MORE.contains(&(first.len() as f64 / inserted as f64)) {
        for beyond in BEYOND {
            choose_again(&mut mesh, &mut first, beyond * bound, &may_go, cancel)?;
        }
    }
    first.sort_unstable();
    Ok(named(&first))
}

/// Removes too many of the vertices, up to a larger bound, then inserts what is missing: fewer, as
/// these are where most is missing.
fn choose_again(
    mesh: &mut Mesh,
    vertices: &mut Vec<u32>,
    larger: f64,
    may_go: &MayGo,
    cancel: &AtomicBool,
) -> Result<(), Canceled> {
    let mut no_lines = Lines::default();
    let bound = mesh.bound;
    mesh.bound = larger;
    thin(mesh, &mut no_lines, vertices, may_go, cancel)?;
    mesh.bound = bound;
    mesh.measure_new();
    let inserted = refine(mesh, cancel)?;
    // All others could not even be removed up to the larger bound.
    let changed = mesh.with_neighbors(&inserted);
    thin(mesh, &mut no_lines, &changed, may_go, cancel)?;
    vertices.extend(inserted);
    vertices.sort_unstable();
    vertices.dedup();
    vertices.retain(|&site| mesh.is_vertex(site));
    Ok(())
}

/// The corners of the convex hull of some sites, in the order of their numbers.
fn hull(sites: &Sites, some: &[u32]) -> Vec<u32> {
    use crate::triangulation::kernel::{Adaptive, Kernel, Orientation2};
    use crate::triangulation::num::Sign;
    let plan = |site: u32| sites.plan(site);
    let half = |order: &mut dyn Iterator<Item = u32>| {
        let mut half: Vec<u32> = Vec::new();
        for site in order {
            while let [.., a, b] = half[..]
                && Adaptive::sign(&Orientation2([plan(a), plan(b), plan(site)])) != Sign::Positive
            {
                half.pop();
            }
            half.push(site);
        }
        half
    };
    let mut hull = half(&mut some.iter().copied());
    hull.extend(half(&mut some.iter().rev().copied()));
    hull.sort_unstable();
    hull.dedup();
    hull
}
