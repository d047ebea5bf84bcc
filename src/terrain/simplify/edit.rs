//! Inserting what is too far off, and removing what is not needed.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::error::Worst;
use super::lines::Lines;
use super::mesh::{Mesh, NONE};
use super::star::Star;

/// How many edits are made before it is asked whether the run is canceled.
const EDITS: usize = 1 << 12;

/// How many sites are dealt with one after the other, on one thread.
const CHUNK: usize = 1 << 12;

/// Returns true if a vertex may be removed, given its neighbors.
pub(super) type MayGo<'a> = dyn Fn(u32, &[u32]) -> bool + Sync + 'a;

/// The run was canceled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Canceled;

/// Returns an error every now and then, if the run was canceled.
struct Watch<'a> {
    cancel: &'a AtomicBool,
    edits: usize,
}

impl<'a> Watch<'a> {
    fn new(cancel: &'a AtomicBool) -> Self {
        Watch { cancel, edits: 0 }
    }

    fn edit(&mut self) -> Result<(), Canceled> {
        self.edits += 1;
        if self.edits.is_multiple_of(EDITS) {
            go_on(self.cancel)?;
        }
        Ok(())
    }
}

pub(super) fn go_on(cancel: &AtomicBool) -> Result<(), Canceled> {
    if cancel.load(Ordering::Relaxed) {
        Err(Canceled)
    } else {
        Ok(())
    }
}

/// A key of a queue: distances are not negative, so that their bits are in their order.
fn key(error: f64) -> u64 {
    error.to_bits()
}

/// Inserts the worst site as long as it is above the bound (Garland and Heckbert 1995). Returns the
/// sites that were inserted. The worst site of each triangle is known.
///
/// # Complexity
/// O(log n) for each insertion, and what is hidden in the triangles that it changes.
pub(super) fn refine(mesh: &mut Mesh, cancel: &AtomicBool) -> Result<Vec<u32>, Canceled> {
    let mut watch = Watch::new(cancel);
    let mut queue: BinaryHeap<(u64, Reverse<u32>, u32)> = (0..mesh.cell_slots())
        .filter(|&cell| mesh.is_used(cell) && mesh.worst[cell as usize].error > mesh.bound)
        .map(|cell| entry(mesh, cell))
        .collect();
    let mut inserted = Vec::new();
    while let Some((error, Reverse(site), cell)) = queue.pop() {
        let Worst {
            error: now,
            site: at,
        } = mesh.worst[cell as usize];
        if key(now) != error || at != site || mesh.is_vertex(site) {
            continue;
        }
        mesh.insert(cell, site);
        inserted.push(site);
        watch.edit()?;
        for k in 0..mesh.fresh.len() {
            let cell = mesh.fresh[k];
            if mesh.worst[cell as usize].error > mesh.bound {
                queue.push(entry(mesh, cell));
            }
        }
    }
    Ok(inserted)
}

fn entry(mesh: &Mesh, cell: u32) -> (u64, Reverse<u32>, u32) {
    let Worst { error, site } = mesh.worst[cell as usize];
    (key(error), Reverse(site), cell)
}

/// Removes the vertices that are not needed, the cheapest first: by the largest error in the
/// triangles that fill its star, then by the box around it, then by rank. Only those are tried for
/// which `may_go` returns true.
///
/// # Complexity
/// O(log n) for each removal, and what is hidden in the stars around it.
pub(super) fn thin(
    mesh: &mut Mesh,
    lines: &mut Lines,
    vertices: &[u32],
    may_go: &MayGo,
    cancel: &AtomicBool,
) -> Result<(), Canceled> {
    let mut watch = Watch::new(cancel);
    let mut star = Star::default();
    let mut queue = BinaryHeap::new();
    // One more than what is in the queue for a vertex, if that is still right.
    // PERF: zeros take no memory until they are written.
    let mut current: Vec<u64> = vec![0; mesh.sites.count()];
    let joint = |mesh: &Mesh, lines: &Lines, vertex: u32, ends: [u32; 2]| {
        lines.joint(vertex, ends, &|site: u32| mesh.plan(site))
    };
    let try_vertex = |mesh: &Mesh, lines: &Lines, vertex: u32, star: &mut Star| {
        mesh.find_star(vertex, star);
        let can_go = may_go(vertex, &star.ring)
            && mesh.fill_star(vertex, star)
            && star
                .new_edge()
                .is_none_or(|ends| joint(mesh, lines, vertex, ends).is_some());
        can_go.then(|| mesh.cost(vertex, star, lines)).flatten()
    };
    let first: Vec<_> = {
        let (mesh, lines) = (&*mesh, &*lines);
        let tried = vertices.par_iter().with_min_len(CHUNK);
        let tried = tried.map_init(Star::default, |star, &vertex| {
            go_on(cancel)?;
            let cost = try_vertex(mesh, lines, vertex, star);
            Ok(cost.map(|cost| (cost, extent(mesh, &star.ring), vertex)))
        });
        tried.collect::<Result<_, Canceled>>()?
    };
    for (cost, extent, vertex) in first.into_iter().flatten() {
        current[vertex as usize] = key(cost) + 1;
        queue.push(Reverse((key(cost), extent, vertex)));
    }
    let mut ring = Vec::new();
    while let Some(Reverse((cost, _, vertex))) = queue.pop() {
        if current[vertex as usize] != cost + 1 {
            continue;
        }
        mesh.find_star(vertex, &mut star);
        // As it was when the cost was found: an edit of the star would have changed that.
        if !mesh.fill_star(vertex, &mut star) {
            continue;
        }
        current[vertex as usize] = 0;
        if let Some(ends) = star.new_edge() {
            let Some(joint) = joint(mesh, lines, vertex, ends) else {
                continue;
            };
            lines.join(vertex, ends, joint);
        }
        mesh.remove(vertex, &star);
        watch.edit()?;
        ring.clear();
        ring.extend_from_slice(&star.ring);
        for &vertex in &ring {
            current[vertex as usize] = 0;
            if let Some(cost) = try_vertex(mesh, lines, vertex, &mut star) {
                current[vertex as usize] = key(cost) + 1;
                queue.push(Reverse((key(cost), extent(mesh, &star.ring), vertex)));
            }
        }
    }
    Ok(())
}

/// The area of the box around a star.
///
/// PERF: of equal costs, as on level ground and along straight rims, the smallest star comes first:
/// otherwise one grows at the expense of its neighbors, and what is hidden in it is measured again
/// for each of them.
fn extent(mesh: &Mesh, ring: &[u32]) -> u64 {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for &site in ring {
        for (axis, at) in mesh.plan(site).into_iter().enumerate() {
            low[axis] = low[axis].min(at);
            high[axis] = high[axis].max(at);
        }
    }
    key((high[0] - low[0]) * (high[1] - low[1]))
}

/// Hides all sites that are no vertices. They are looked for in the order given, each from the one
/// before it on, some thousands together.
pub(super) fn hide_all(mesh: &mut Mesh, order: &[u32]) {
    let Some(start) = order.iter().find(|&&site| mesh.is_vertex(site)) else {
        return;
    };
    let start = mesh.cell_of[*start as usize];
    let seen = &*mesh;
    let locate = |chunk: &[u32]| -> Vec<u32> {
        let mut near = start;
        let locate = |&site: &u32| {
            if seen.is_vertex(site) {
                near = seen.cell_of[site as usize];
                NONE
            } else {
                near = seen.locate(near, site);
                near
            }
        };
        chunk.iter().map(locate).collect()
    };
    let cells: Vec<Vec<u32>> = order.par_chunks(CHUNK).map(locate).collect();
    for (&site, cell) in order.iter().zip(cells.into_iter().flatten()) {
        if cell != NONE {
            mesh.hide(cell, site);
        }
    }
}
