//! The parts of a surface above a height, as polygons.

use rayon::prelude::*;

use super::apart::Apart;
use super::area::ChangedArea;
use crate::data::{Surface, bounds_of_faces, corners};
use crate::error::Result;
use crate::terrain::contour::{Polygons, crossing};
use crate::terrain::linear::plan;
use crate::terrain::overlay::Corner;
use crate::terrain::volume::{Sum, Units, integral};

/// Parts of faces that a thread takes at a time.
const BATCH: usize = 1 << 10;

/// Returns the areas in which a difference of surfaces, times a sign of 1 or -1, is above a height.
pub(super) fn above(
    Apart { mesh, origin }: &Apart,
    height: f64,
    sign: f64,
) -> Result<Vec<ChangedArea>> {
    let mut arcs = Vec::new();
    let mut parts = Vec::new();
    for (face, vertices) in corners(mesh) {
        let triangle = vertices.map(|v| {
            let [x, y, d] = mesh.position(v);
            [x, y, sign * d]
        });
        let part = Part::above(triangle, height);
        arcs.extend(part.border(|edge| mesh.neighbor(face, edge).is_none()));
        if part.count > 0 {
            parts.push(part);
        }
    }
    if parts.is_empty() {
        return Ok(Vec::new());
    }
    let from_origin = |[x, y]: [f64; 2]| [x + origin[0], y + origin[1]];
    for at in arcs.as_flattened_mut() {
        *at = from_origin(*at);
    }
    let polygons = Polygons::new(&arcs)?;
    let mut around = bounds_of_faces(mesh);
    // Volumes reach down to 0.
    let [x, y, _] = around.min;
    around.add([x, y, 0.0]);
    let units = Units::within(&around, 1.0)?;
    let batches: Vec<Vec<Option<usize>>> = parts
        .par_chunks(BATCH)
        .map(|batch| {
            let mut near = None;
            let of = |part: &Part| polygons.at(from_origin(part.center()), &mut near);
            batch.iter().map(of).collect()
        })
        .collect();
    let mut totals = vec![Totals::default(); polygons.rings.len()];
    for (part, polygon) in parts.iter().zip(batches.into_iter().flatten()) {
        // A part thinner than rounding errors may be in none.
        if let Some(polygon) = polygon {
            totals[polygon].add(part, &units);
        }
    }
    let areas = polygons.rings.into_iter().zip(totals);
    Ok(areas
        .map(|(rings, totals)| ChangedArea {
            rings,
            area: units.area.value(totals.area),
            volume: units.volume.value(totals.volume),
            largest: sign * totals.largest,
            at: from_origin(totals.at),
        })
        .filter(|area| area.area > 0.0)
        .collect())
}

/// The part of a face that is above a height.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// The corners of a convex polygon, counter-clockwise.
    corners: [[f64; 3]; 4],
    /// The edge of the face along which the side from each corner to the next one runs; `None` for
    /// the side at the height.
    edges: [Option<usize>; 4],
    /// The number of corners.
    count: usize,
}

impl Part {
    fn above(triangle: [[f64; 3]; 3], height: f64) -> Self {
        let mut part = Part {
            corners: [triangle[0]; 4],
            edges: [None; 4],
            count: 0,
        };
        let is_above = triangle.map(|p| p[2] > height);
        for i in 0..3 {
            let (j, edge) = ((i + 1) % 3, Some((i + 2) % 3));
            let at_height = || {
                let out = triangle[if is_above[i] { j } else { i }];
                let [x, y] = if out[2] == height {
                    [out[0], out[1]]
                } else {
                    crossing(triangle[i], triangle[j], height)
                };
                [x, y, height]
            };
            if is_above[i] {
                part.push(triangle[i], edge);
            }
            match [is_above[i], is_above[j]] {
                [true, false] => part.push(at_height(), None),
                [false, true] => part.push(at_height(), edge),
                _ => {}
            }
        }
        part
    }

    fn push(&mut self, corner: [f64; 3], edge: Option<usize>) {
        self.corners[self.count] = corner;
        self.edges[self.count] = edge;
        self.count += 1;
    }

    /// Returns the sides that are at the height, and those along edges at the rim.
    fn border(&self, is_rim: impl Fn(usize) -> bool) -> impl Iterator<Item = [[f64; 2]; 2]> {
        (0..self.count)
            .filter(move |&i| self.edges[i].is_none_or(&is_rim))
            .map(|i| [i, (i + 1) % self.count].map(|i| plan(self.corners[i])))
            .filter(|[from, to]| from != to)
    }

    fn corners(&self) -> &[[f64; 3]] {
        &self.corners[..self.count]
    }

    fn center(&self) -> [f64; 2] {
        let [x, y, _] = self.corners[0];
        let sum = self
            .corners()
            .iter()
            .fold([0.0; 2], |[u, v], p| [u + (p[0] - x), v + (p[1] - y)]);
        [
            x + sum[0] / self.count as f64,
            y + sum[1] / self.count as f64,
        ]
    }
}

/// Sums over the parts of one polygon.
#[derive(Debug, Clone, Copy, Default)]
struct Totals {
    area: Sum,
    volume: Sum,
    largest: f64,
    at: [f64; 2],
}

impl Totals {
    fn add(&mut self, part: &Part, units: &Units) {
        let [x, y, _] = part.corners[0];
        let corners = part.corners.map(|p| Corner {
            at: [p[0] - x, p[1] - y],
            heights: [p[2], 0.0],
        });
        let of = integral(&corners[..part.count]);
        self.area += units.area.of(of.area);
        self.volume += units.volume.of(of.volumes[0]);
        for &corner in part.corners() {
            let is_before = corner[2] == self.largest && plan(corner) < self.at;
            if corner[2] > self.largest || is_before {
                (self.largest, self.at) = (corner[2], plan(corner));
            }
        }
    }
}
