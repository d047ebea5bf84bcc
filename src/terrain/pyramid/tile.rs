//! One tile: its vertices are chosen, rounded to steps, and measured against all heights.

use std::sync::atomic::AtomicBool;

use rustc_hash::FxHashMap;

use super::lines::{Chain, chain, height_on, in_steps, steps_between};
use super::{Level, Pyramid};
use crate::data::{TerrainTile, TilePosition};
use crate::error::{Error, Result};
use crate::terrain::admitted::searched;
use crate::terrain::sample::along_curve;
use crate::terrain::simplify::choose_around;
use crate::triangulation::geometry::Terrain;
use crate::triangulation::tds::CellId;
use crate::triangulation::{Delaunay, Location};

/// How near a tile is to the surface.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TileReport {
    /// The vertices.
    pub vertices: usize,
    /// The triangles.
    pub triangles: usize,
    /// The heights of the surface that it was measured against.
    pub heights: usize,
    /// The largest distance of a height, in meters.
    pub largest: f64,
    /// The number of heights that are further off than the bound, because steps are too large.
    pub beyond: usize,
}

impl TileReport {
    /// Adds the counts of another tile.
    pub fn merge(&mut self, other: &TileReport) {
        self.vertices += other.vertices;
        self.triangles += other.triangles;
        self.heights += other.heights;
        self.largest = self.largest.max(other.largest);
        self.beyond += other.beyond;
    }
}

const STEPS: u16 = TerrainTile::STEPS;

/// A tile while its vertices are chosen.
struct Work<'a> {
    level: &'a Level,
    /// The heights to be near to: steps along x and y, height in meters.
    heights: Vec<[f64; 3]>,
    triangulation: Delaunay<Terrain, 3>,
}

/// Makes one tile.
pub(super) fn tile(
    pyramid: &Pyramid,
    at: TilePosition,
    cancel: &AtomicBool,
) -> Result<(TerrainTile, TileReport)> {
    let level = &pyramid.levels[usize::from(at.level)];
    let [min, max] = pyramid.rule.tiling.bounds(at);
    let points = pyramid.points_of(at);
    let heights: Vec<[f64; 3]> = points
        .iter()
        .map(|&[x, y, z]| {
            let [u, v] = [(x, 0), (y, 1)].map(|(c, axis)| steps_between(c, min[axis], max[axis]));
            let [u, v] = searched([u, v]);
            [u, v, z]
        })
        .collect();
    let kept = frame(pyramid, level, at);
    let candidate = |&[u, v, z]: &[f64; 3]| {
        let [u, v] = [u, v].map(inner);
        [f64::from(u), f64::from(v), z]
    };
    let mut sites: Vec<([f64; 3], bool)> = kept
        .into_iter()
        .map(|([u, v], height)| {
            let height = f64::from(height) * level.step;
            ([f64::from(u), f64::from(v), height], true)
        })
        .chain(heights.iter().map(|p| (candidate(p), false)))
        .collect();
    sites.sort_unstable_by(|(p, p_stays), (q, q_stays)| {
        let axis = |k: usize| p[k].total_cmp(&q[k]);
        axis(0)
            .then(axis(1))
            .then(q_stays.cmp(p_stays))
            .then(axis(2))
    });
    sites.dedup_by(|(q, _), (p, _)| p[0] == q[0] && p[1] == q[1]);
    let stay: Vec<u32> = (0..sites.len() as u32)
        .filter(|&site| sites[site as usize].1)
        .collect();
    let positions: Vec<[f64; 3]> = sites.into_iter().map(|(p, _)| p).collect();
    let bound = (level.allowance - level.step / 2.0).max(level.allowance / 2.0);
    let chosen = choose_around(positions.clone(), &stay, bound, cancel)?;
    let vertices: Vec<[f64; 3]> = chosen
        .iter()
        .map(|&site| rounded(positions[site as usize], level.step))
        .collect();
    let (triangulation, _) = Delaunay::from_points(Terrain::default(), &vertices)
        .map_err(|e| Error::format(e.to_string()))?;
    let mut work = Work {
        level,
        heights,
        triangulation,
    };
    let mut report = work.repair(cancel)?;
    let tile = work.finish(at)?;
    report.vertices = tile.vertices.len();
    report.triangles = tile.triangles.len();
    Ok((tile, report))
}

/// A step inside of the tile: only vertices of borders are on them.
fn inner(steps: f64) -> u16 {
    (steps.round() as u16).clamp(1, STEPS - 1)
}

/// A position with its height in whole steps.
fn rounded([u, v, z]: [f64; 3], step: f64) -> [f64; 3] {
    [u, v, (z / step).round() * step]
}

/// The vertices that a tile has in any case: those of its borders, and a grid that follows the
/// earth.
fn frame(pyramid: &Pyramid, level: &Level, at: TilePosition) -> Vec<([u16; 2], i32)> {
    let cells = level.grid;
    let height = |i: u32, j: u32| (pyramid.height(level, at, [i, j]) / level.step).round() as i32;
    let steps = |i: u32| (f64::from(STEPS) * f64::from(i) / f64::from(cells)).round() as u16;
    let border = |axis: usize, far: u32| -> Chain {
        let fixed: Vec<(u16, i32)> = (0..=cells)
            .map(|k| match axis {
                0 => (steps(k), height(far * cells, k)),
                _ => (steps(k), height(k, far * cells)),
            })
            .collect();
        let (heights, ends) = pyramid.along(at, axis, far);
        chain(
            &in_steps(heights, ends),
            &fixed,
            level.step,
            level.allowance,
        )
    };
    let mut frame = Vec::new();
    for (far, side) in [(0, 0), (1, STEPS)] {
        frame.extend(border(0, far).into_iter().map(|(v, z)| ([side, v], z)));
        // Corners are on both.
        let inner = border(1, far)
            .into_iter()
            .filter(|&(u, _)| u != 0 && u != STEPS);
        frame.extend(inner.map(|(u, z)| ([u, side], z)));
    }
    for i in 1..cells {
        frame.extend((1..cells).map(|j| ([steps(i), steps(j)], height(i, j))));
    }
    frame
}

impl Work<'_> {
    /// Inserts the worst height of each triangle until none is further off than the bound.
    fn repair(&mut self, cancel: &AtomicBool) -> Result<TileReport> {
        loop {
            if cancel.load(std::sync::atomic::Ordering::Relaxed) {
                return Err(Error::canceled());
            }
            let (mut beyond, mut largest) = (0, 0.0_f64);
            let mut worst: FxHashMap<CellId, (f64, [u16; 2], f64)> = FxHashMap::default();
            let mut near = None;
            for &[u, v, z] in &self.heights {
                let location = self.triangulation.locate(&[u, v, z], near);
                near = location.cell(&self.triangulation).or(near);
                let (off, cell) = match location {
                    Location::Vertex(vertex) => {
                        ((self.triangulation.point(vertex)[2] - z).abs(), None)
                    }
                    Location::Cell { cell, .. } => match self.triangulation.cell_points(cell) {
                        Some(corners) => {
                            let height = height_on(corners.map(|p| *p), [u, v]);
                            ((height - z).abs(), Some(cell))
                        }
                        None => continue,
                    },
                    _ => continue,
                };
                largest = largest.max(off);
                // A margin for the roundings of viewers.
                if off <= self.level.allowance * (1.0 - 1e-9) {
                    continue;
                }
                beyond += usize::from(off > self.level.allowance);
                let Some(cell) = cell else {
                    continue;
                };
                let entry = worst.entry(cell).or_insert((0.0, [0; 2], 0.0));
                let candidate = (off, [u, v].map(inner), z);
                let is_worse = off
                    .total_cmp(&entry.0)
                    .then(candidate.1.cmp(&entry.1))
                    .is_gt();
                if is_worse {
                    *entry = candidate;
                }
            }
            let mut candidates: Vec<([u16; 2], f64)> =
                worst.into_values().map(|(_, at, z)| (at, z)).collect();
            candidates.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
            let before = self.triangulation.tds().vertex_count();
            for ([u, v], z) in candidates {
                let p = rounded([f64::from(u), f64::from(v), z], self.level.step);
                let inserted = self.triangulation.insert(p);
                inserted.map_err(|e| Error::format(e.to_string()))?;
            }
            if self.triangulation.tds().vertex_count() == before {
                return Ok(TileReport {
                    heights: self.heights.len(),
                    largest,
                    beyond,
                    ..TileReport::default()
                });
            }
        }
    }

    /// The tile with its triangles along a curve, and its vertices in the order of their first use.
    fn finish(&self, at: TilePosition) -> Result<TerrainTile> {
        let tds = self.triangulation.tds();
        let cells: Vec<CellId> = self.triangulation.finite_cells().collect();
        let centers: Vec<[f64; 2]> = cells
            .iter()
            .map(|&cell| {
                let corners = tds
                    .corners(cell)
                    .map(|vertex| *self.triangulation.point(vertex));
                [0, 1].map(|k| corners.iter().map(|p| p[k]).sum::<f64>() / 3.0)
            })
            .collect();
        let step = self.level.step;
        let steps_of = |z: f64| (z / step).round() as i32;
        let mut number_of = vec![u32::MAX; tds.vertex_slots()];
        let mut used: Vec<[f64; 3]> = Vec::new();
        let triangles: Vec<[u32; 3]> = along_curve(&centers)
            .into_iter()
            .map(|k| {
                tds.corners(cells[k as usize]).map(|vertex| {
                    let number = &mut number_of[vertex.index()];
                    if *number == u32::MAX {
                        *number = used.len() as u32;
                        used.push(*self.triangulation.point(vertex));
                    }
                    *number
                })
            })
            .collect();
        let lowest = used.iter().map(|p| steps_of(p[2])).min().unwrap_or(0);
        let vertices = used
            .iter()
            .map(|&[u, v, z]| {
                let height = u16::try_from(steps_of(z) - lowest);
                Some([u as u16, v as u16, height.ok().filter(|&h| h <= STEPS)?])
            })
            .collect::<Option<_>>()
            .ok_or_else(|| Error::limit("the heights of a tile are too far from each other"))?;
        Ok(TerrainTile {
            at,
            step,
            lowest,
            vertices,
            triangles,
        })
    }
}
