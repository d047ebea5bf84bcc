//! Heights smoothed inside a tube around those of the surface.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::fit::Fit;
use super::work::GoOn;
use crate::data::{Surface, corners};
use crate::error::Result;
use crate::terrain::in_order::by_coordinates;

/// How often all heights are smoothed.
pub(super) const PASSES: usize = 4;

/// The least number of vertices for a fit.
const LEAST_COUNT: usize = 8;

/// How far the weighted mean of the positions may be from a vertex, in radii. Beyond, the vertex is
/// at the border of what is known, and a fit would extrapolate.
const LARGEST_ECCENTRICITY: f64 = 0.25;

/// The vertices that a thread takes at a time.
const BATCH: usize = 1 << 8;

/// No vertex.
const NONE: u32 = u32::MAX;

/// The largest radius, in mean distances of vertices: the time grows with its square.
const LARGEST_RADIUS: f64 = 10.0;

/// How far heights are smoothed.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tube {
    /// The radius around each vertex, in plan; less where vertices are near to each other.
    pub(super) radius: f64,
    /// The area of the box around the surface.
    pub(super) area: f64,
    /// The largest change of a height.
    pub(super) largest: f64,
}

/// Returns smoothed heights for all vertices of a surface; held vertices keep theirs.
///
/// Each height becomes that of a quadric at the vertex, fitted to the vertices within the radius
/// that edges lead to, but not through held vertices; then it is cut to the tube. All are smoothed
/// at once, four times. Vertices at one position count as one: parts of a surface share them. Sums
/// are made in the order of coordinates, so that they depend on the surface alone.
///
/// # Errors
/// That of `go_on`, which counts each vertex once in each pass.
///
/// # Complexity
/// Proportional to the vertices, times those within the radius of each, on all threads. About 80
/// bytes for each vertex, of which 8 remain; and for each thread, 4 for each vertex in a strip of
/// twice the radius.
pub(super) fn smoothed(surface: &dyn Surface, tube: Tube, go_on: GoOn) -> Result<Vec<f64>> {
    let (vertices, ranks) = Vertices::of(surface);
    // If vertices fill the box.
    let spacing = (tube.area / vertices.positions.len() as f64).sqrt();
    let tube = Tube {
        radius: tube.radius.min(LARGEST_RADIUS * spacing),
        ..tube
    };
    let original: Vec<f64> = vertices.positions.iter().map(|p| p[2]).collect();
    let mut heights = original.clone();
    for _ in 0..PASSES {
        heights = vertices.smooth(&heights, &original, tube, go_on)?;
    }
    let height = |(vertex, &rank): (u32, &u32)| {
        let smoothed = heights.get(rank as usize).copied();
        smoothed.unwrap_or_else(|| surface.position(vertex)[2])
    };
    Ok((0..).zip(&ranks).map(height).collect())
}

/// The vertices that have faces, in the order of their coordinates, and the edges between them.
struct Vertices {
    positions: Vec<[f64; 3]>,
    is_held: Vec<bool>,
    /// Where the neighbors of each vertex start, and where the last ones end.
    starts: Vec<u32>,
    neighbors: Vec<u32>,
}

impl Vertices {
    /// Also returns the position in this order of each vertex of the surface.
    fn of(surface: &dyn Surface) -> (Self, Vec<u32>) {
        let mut ranks = vec![NONE; surface.vertex_count()];
        for (_, vertices) in corners(surface) {
            for v in vertices {
                ranks[v as usize] = 0;
            }
        }
        let used = (0..surface.vertex_count() as u32).filter(|&v| ranks[v as usize] == 0);
        let mut sorted: Vec<([f64; 3], u32)> = used.map(|v| (surface.position(v), v)).collect();
        sorted.par_sort_unstable_by(|(a, v), (b, w)| by_coordinates(a, b).then(v.cmp(w)));
        let mut positions: Vec<[f64; 3]> = Vec::with_capacity(sorted.len());
        for (position, vertex) in sorted {
            if positions
                .last()
                .is_none_or(|last| by_coordinates(last, &position).is_ne())
            {
                positions.push(position);
            }
            ranks[vertex as usize] = positions.len() as u32 - 1;
        }
        let mut is_held = vec![false; positions.len()];
        let mut starts = vec![0; positions.len() + 1];
        // Each edge between two faces is seen in both directions, one at the rim in one.
        let each_edge = |take: &mut dyn FnMut(u32, u32)| {
            for (face, vertices) in corners(surface) {
                for i in 0..3 {
                    let [a, b] = [1, 2].map(|k| ranks[vertices[(i + k) % 3] as usize]);
                    take(a, b);
                    if surface.neighbor(face, i).is_none() {
                        take(b, a);
                    }
                }
            }
        };
        each_edge(&mut |a, _| starts[a as usize + 1] += 1);
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        // Some vertex, where a run is canceled before all neighbors are known.
        let mut neighbors = vec![0; starts.last().copied().unwrap_or(0) as usize];
        each_edge(&mut |a, b| {
            neighbors[next[a as usize] as usize] = b;
            next[a as usize] += 1;
        });
        if surface.has_lines() {
            for (face, vertices) in corners(surface) {
                for i in (0..3).filter(|&i| surface.edge_kind(face, i).is_hard()) {
                    for k in [1, 2] {
                        is_held[ranks[vertices[(i + k) % 3] as usize] as usize] = true;
                    }
                }
            }
        }
        let vertices = Vertices {
            positions,
            is_held,
            starts,
            neighbors,
        };
        (vertices, ranks)
    }

    /// Returns the heights after one pass.
    fn smooth(
        &self,
        heights: &[f64],
        original: &[f64],
        tube: Tube,
        go_on: GoOn,
    ) -> Result<Vec<f64>> {
        let mut after = heights.to_vec();
        // One for each thread, and not for each part into which the batches are split.
        let unused: Mutex<Vec<Around>> = Mutex::default();
        let lock = || unused.lock().unwrap_or_else(PoisonError::into_inner);
        let batches = after.par_chunks_mut(BATCH).enumerate();
        let done: Result<()> = batches.try_for_each(|(batch, after)| {
            go_on(after.len() as u64)?;
            let taken = lock().pop();
            let mut around = taken.unwrap_or_default();
            for (i, height) in after.iter_mut().enumerate() {
                let center = batch * BATCH + i;
                if !self.is_held[center] {
                    around.collect(self, center as u32, tube.radius);
                    if let Some(fitted) = self.fitted(&around, center, heights, tube.radius) {
                        let z = original[center];
                        *height = fitted.max(z - tube.largest).min(z + tube.largest);
                    }
                }
            }
            lock().push(around);
            Ok(())
        });
        done.map(|()| after)
    }

    /// Returns the height at a vertex by a fit; `None` if too little is known around it.
    fn fitted(&self, around: &Around, center: usize, heights: &[f64], radius: f64) -> Option<f64> {
        let fit = self.fit(around, center, heights, radius);
        let is_one_sided = fit.eccentricity() > LARGEST_ECCENTRICITY;
        if fit.count < LEAST_COUNT || is_one_sided {
            return None;
        }
        let fitted = heights[center] + fit.at_center();
        fitted.is_finite().then_some(fitted)
    }

    fn fit(&self, around: &Around, center: usize, heights: &[f64], radius: f64) -> Fit {
        let mut fit = Fit::default();
        let [x, y, _] = self.positions[center];
        for &other in &around.found {
            let other = other as usize;
            let at = self.positions[other];
            let [dx, dy] = [(at[0] - x) / radius, (at[1] - y) / radius];
            let inner = 1.0 - (dx * dx + dy * dy);
            let weight = inner * inner * inner;
            fit.add([dx, dy], heights[other] - heights[center], weight);
        }
        fit
    }
}

/// The vertices around another one.
#[derive(Default)]
struct Around {
    /// The vertices, in the order of coordinates.
    found: Vec<u32>,
    /// The last vertex around which each one was found, of those whose x is near enough: in the
    /// order of coordinates they follow each other. So a thread needs room for a strip only.
    seen: Vec<u32>,
}

impl Around {
    /// Collects the vertices within a radius that edges lead to, but not through held ones.
    fn collect(&mut self, vertices: &Vertices, center: u32, radius: f64) {
        let [x, y, _] = vertices.positions[center as usize];
        let square = radius * radius;
        // The products that the distances below are made of: what is near enough has its x here.
        let is_far = |at: &[f64; 3]| (at[0] - x) * (at[0] - x) >= square;
        let (before, behind) = vertices.positions.split_at(center as usize);
        let first = before.partition_point(is_far);
        let end = center as usize + behind.partition_point(|at| !is_far(at)).max(1);
        if self.seen.len() < end - first {
            self.seen.resize(end - first, NONE);
        }
        self.found.clear();
        self.found.push(center);
        self.seen[center as usize - first] = center;
        let mut next = 0;
        while let Some(&vertex) = self.found.get(next) {
            next += 1;
            let vertex = vertex as usize;
            if vertices.is_held[vertex] {
                continue;
            }
            let [start, end] = [0, 1].map(|k| vertices.starts[vertex + k] as usize);
            for &other in &vertices.neighbors[start..end] {
                let at = vertices.positions[other as usize];
                let [dx, dy] = [at[0] - x, at[1] - y];
                if dx * dx + dy * dy >= square {
                    continue;
                }
                let seen = &mut self.seen[other as usize - first];
                if *seen != center {
                    *seen = center;
                    self.found.push(other);
                }
            }
        }
        self.found.sort_unstable();
    }
}

/// Raises heights that are within a distance of a level to that distance above it, so that no
/// vertex is on a level. Levels are ascending and farther apart than that.
pub(super) fn nudge(heights: &mut [f64], levels: &[f64], distance: f64) {
    heights.par_iter_mut().for_each(|height| {
        let above = levels.partition_point(|&level| level < *height);
        let near = levels[above.saturating_sub(1)..levels.len().min(above + 1)]
            .iter()
            .find(|&&level| (*height - level).abs() < distance);
        if let Some(level) = near {
            *height = level + distance;
        }
    });
}
