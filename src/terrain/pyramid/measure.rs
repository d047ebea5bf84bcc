//! How far the heights of a surface and its lines are from the triangles of a tile.

use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::blocks::Block;
use super::tile::{Work, in_tile, inner, rounded};
use crate::error::{Error, Result};
use crate::terrain::cancel::go_on;
use crate::terrain::records::Record;
use crate::triangulation::tds::{CellId, ccw, cw};
use crate::triangulation::{Location, Passage};

/// How many blocks or edges are measured one after the other, on one thread: where a search starts
/// must not depend on threads, as it decides which of two triangles has what is between them.
const IN_ROW: [usize; 2] = [32, 256];

/// A margin for the roundings of viewers, as a share of what is allowed.
const MARGIN: f64 = 1e-9;

/// The share of what is allowed up to which a block is not looked at. The rest is for roundings.
const SURE: f64 = 0.999;

/// How often crossings of lines are inserted: twice as many each time at most. Where steps are too
/// large for what is between two lines, as at a wall, it would not end.
const ROUNDS: usize = 12;

/// Crossings that are nearer to the ends of an edge, in steps, are not inserted.
const APART: f64 = 2.0;

/// What is furthest from a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Worst {
    off: f64,
    /// In steps.
    at: [u16; 2],
    height: f64,
}

/// What was measured of a tile.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// The number of heights that are further off than the bound.
    pub(super) beyond: usize,
    /// The largest distance, or more where heights were not looked at.
    pub(super) largest: f64,
    /// What is worst of each triangle that is further off than it should be.
    pub(super) worst: FxHashMap<CellId, Worst>,
}

impl Found {
    fn nominate(&mut self, cell: CellId, candidate: Worst) {
        let worst = self.worst.entry(cell).or_insert(candidate);
        let order = candidate.off.total_cmp(&worst.off);
        let order = order.then(candidate.at.cmp(&worst.at));
        let order = order.then(candidate.height.total_cmp(&worst.height));
        if order.is_gt() {
            *worst = candidate;
        }
    }

    fn merged(mut self, other: Found) -> Found {
        self.beyond += other.beyond;
        self.largest = self.largest.max(other.largest);
        for (cell, worst) in other.worst {
            self.nominate(cell, worst);
        }
        self
    }

    /// Returns what is worst of each triangle, in any order: positions in steps, and heights.
    pub(super) fn candidates(&self) -> impl Iterator<Item = ([u16; 2], f64)> {
        self.worst.values().map(|worst| (worst.at, worst.height))
    }
}

impl Work<'_> {
    /// Measures all heights of the tile, and its lines; crossings of these are candidates only if
    /// `at_lines`.
    pub(super) fn measure(&self, at_lines: bool, cancel: &AtomicBool) -> Result<Found> {
        let bounds = self.all.tiling.bounds(self.at);
        let blocks = self.all.blocks_of(self.at).par_chunks(IN_ROW[0]);
        let of_heights = blocks.map(|blocks| {
            go_on(cancel)?;
            self.of_blocks(blocks, bounds)
        });
        let edges = self.all.edges_of(self.at)?;
        let of_lines = edges.par_chunks(IN_ROW[1]).map(|edges| {
            go_on(cancel)?;
            Ok(self.of_edges(edges, bounds, at_lines))
        });
        of_heights
            .chain(of_lines)
            .try_reduce(Found::default, |a, b| Ok(a.merged(b)))
    }

    fn of_blocks(&self, blocks: &[Block], bounds: [[f64; 2]; 2]) -> Result<Found> {
        let mut found = Found::default();
        let mut near = None;
        let mut records = Vec::new();
        for block in blocks {
            if let Some(off) = self.sure_of(block, bounds, &mut near) {
                found.largest = found.largest.max(off);
                continue;
            }
            self.all.read(block, &mut records)?;
            for &(_, p) in &records {
                let p = in_tile(p, bounds);
                let location = self.triangulation.locate(&p, near);
                near = location.cell(&self.triangulation).or(near);
                let [u, v, z] = p;
                let Some((height, cell)) = self.height_at(location, [u, v]) else {
                    continue;
                };
                let off = (height - z).abs();
                self.add(&mut found, off);
                if off > self.level.allowance * (1.0 - MARGIN)
                    && let Some(cell) = cell
                {
                    let at = [u, v].map(inner);
                    let height = z;
                    found.nominate(cell, Worst { off, at, height });
                }
            }
        }
        Ok(found)
    }

    /// Counts a distance.
    fn add(&self, found: &mut Found, off: f64) {
        found.largest = found.largest.max(off);
        found.beyond += usize::from(off > self.level.allowance);
    }

    /// Returns how far all heights of a block are from the triangle that contains its box, at most,
    /// if there is one and they are within the bound.
    fn sure_of(
        &self,
        block: &Block,
        bounds: [[f64; 2]; 2],
        near: &mut Option<CellId>,
    ) -> Option<f64> {
        let mut cell_of_all = None;
        let mut above = [f64::INFINITY, f64::NEG_INFINITY];
        for [x, y] in block.corners() {
            let p = in_tile([x, y, block.height([x, y])], bounds);
            let location = self.triangulation.locate(&p, *near);
            let Location::Cell { cell, .. } = location else {
                return None;
            };
            *near = Some(cell);
            if *cell_of_all.get_or_insert(cell) != cell {
                return None;
            }
            let (height, _) = self.height_at(location, [p[0], p[1]])?;
            above = [above[0].min(height - p[2]), above[1].max(height - p[2])];
        }
        let [low, high] = block.residuals;
        let off = (above[1] - low).abs().max((above[0] - high).abs());
        (off <= self.level.allowance * SURE).then_some(off)
    }

    /// Measures edges of the surface: what is linear along each of two lines differs most where one
    /// of them bends.
    fn of_edges(&self, edges: &[Record<6>], bounds: [[f64; 2]; 2], at_lines: bool) -> Found {
        let mut found = Found::default();
        let mut near = None;
        let tds = self.triangulation.tds();
        for &(_, [x, y, z, to_x, to_y, to_z]) in edges {
            let ends = [[x, y, z], [to_x, to_y, to_z]].map(|p| in_tile(p, bounds));
            for passage in self.triangulation.along([&ends[0], &ends[1]], near) {
                let (cell, i) = match passage {
                    Passage::Edge(cell, i) => (cell, i),
                    Passage::Face(cell) => {
                        near = Some(cell);
                        continue;
                    }
                    // The tile bends here, and has a vertex already.
                    Passage::Vertex(vertex) => {
                        let bend = *self.triangulation.point(vertex);
                        if let Some(line) = height_on(ends, bend) {
                            self.add(&mut found, (line - bend[2]).abs());
                        }
                        continue;
                    }
                    Passage::Along(_) => continue,
                };
                let corners = tds.corners(cell);
                let across =
                    [corners[ccw(i)], corners[cw(i)]].map(|v| *self.triangulation.point(v));
                let Some([u, v, line, height]) = crossing(ends, across) else {
                    continue;
                };
                let off = (line - height).abs();
                self.add(&mut found, off);
                let is_apart = across
                    .iter()
                    .all(|p| (p[0] - u).abs().max((p[1] - v).abs()) > APART);
                if at_lines && is_apart && off > self.level.allowance * (1.0 - MARGIN) {
                    let at = [u, v].map(inner);
                    let height = line;
                    found.nominate(cell, Worst { off, at, height });
                }
            }
        }
        found
    }

    /// Inserts the worst of each triangle until none is further off than the bound. Returns what
    /// was measured last.
    pub(super) fn repair(&mut self, mut found: Found, cancel: &AtomicBool) -> Result<Found> {
        for round in 1.. {
            let mut candidates: Vec<([u16; 2], f64)> = found.candidates().collect();
            candidates.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
            let before = self.triangulation.tds().vertex_count();
            for ([u, v], z) in candidates {
                let p = rounded([f64::from(u), f64::from(v), z], self.level.step);
                let inserted = self.triangulation.insert(p);
                inserted.map_err(|e| Error::format(e.to_string()))?;
            }
            if self.triangulation.tds().vertex_count() == before {
                break;
            }
            found = self.measure(round < ROUNDS, cancel)?;
        }
        Ok(found)
    }
}

/// Returns the height of a segment where it passes through a position; `None` if its ends are at
/// one position.
fn height_on([p, q]: [[f64; 3]; 2], [u, v, _]: [f64; 3]) -> Option<f64> {
    let [x, y, z] = [0, 1, 2].map(|k| q[k] - p[k]);
    let share = ((u - p[0]) * x + (v - p[1]) * y) / (x * x + y * y);
    let height = p[2] + share.clamp(0.0, 1.0) * z;
    height.is_finite().then_some(height)
}

/// Returns where two segments cross, and the height of each there.
fn crossing([p, q]: [[f64; 3]; 2], [a, b]: [[f64; 3]; 2]) -> Option<[f64; 4]> {
    let minus = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|k| p[k] - q[k]);
    let cross = |p: [f64; 3], q: [f64; 3]| p[0] * q[1] - p[1] * q[0];
    let [along, across, from] = [minus(q, p), minus(b, a), minus(a, p)];
    let area = cross(along, across);
    let [s, t] = [cross(from, across) / area, cross(from, along) / area];
    // NaN if they are parallel, rounded.
    let [s, t] = [s.clamp(0.0, 1.0), t.clamp(0.0, 1.0)];
    let at = [0, 1, 2].map(|k| p[k] + s * along[k]);
    let height = a[2] + t * across[2];
    (at.iter().all(|c| c.is_finite()) && height.is_finite())
        .then_some([at[0], at[1], at[2], height])
}
