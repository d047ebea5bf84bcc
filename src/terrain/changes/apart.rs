//! The difference of two surfaces as a surface.

use rayon::prelude::*;

use crate::data::{Mesh, Surface, orientation};
use crate::error::{Error, Result};
use crate::terrain::admitted::refused;
use crate::terrain::arranged::arranged;
use crate::terrain::boxes::{Boxes, Extent, LocatedFace};
use crate::terrain::in_order::in_order;
use crate::terrain::overlay::{from_least, within};
use crate::terrain::rasterize::height_at;
use crate::triangulation::kernel::RANGE;
use crate::triangulation::num::Sign;

type Triangle = [[f64; 3]; 3];

/// The difference of two surfaces as a surface.
pub(super) struct Apart {
    /// Each triangle is within one face of either surface.
    pub(super) mesh: Mesh,
    /// Where the mesh has its origin.
    pub(super) origin: [f64; 2],
}

/// Returns the difference of two surfaces, first minus second, over all that the given faces of
/// both have in common. Its heights are mapped by `map`.
///
/// # Errors
/// If a coordinate is not covered by the arithmetic.
///
/// # Complexity
/// That of a triangulation of the edges of all these faces, with their crossings.
pub(super) fn difference_over(
    surfaces: [&dyn Surface; 2],
    faces: &[Vec<u32>; 2],
    map: impl Fn(f64) -> f64,
) -> Result<Apart> {
    let mut triangles = [0, 1].map(|k| triangles_of(surfaces[k], &faces[k]));
    let corners = || triangles.iter().flatten().flatten();
    if let Some(&p) = corners().find(|p| !p.iter().all(|&c| RANGE.admits(c))) {
        return Err(refused(p));
    }
    let origin = origin_of(corners());
    for p in triangles.iter_mut().flatten().flatten() {
        (p[0], p[1]) = (p[0] - origin[0], p[1] - origin[1]);
    }
    let points: Vec<[f64; 3]> = triangles
        .iter()
        .flatten()
        .flatten()
        .map(|&[x, y, _]| [x, y, 0.0])
        .collect();
    let parts = triangles.map(Part::new);
    let sides = |first: u32| {
        [
            [first, first + 1],
            [first + 1, first + 2],
            [first + 2, first],
        ]
    };
    let count = u32::try_from(points.len())
        .map_err(|_| Error::limit("more than a billion triangles differ"))?;
    let lines: Vec<[u32; 2]> = (0..count).step_by(3).flat_map(sides).collect();
    let triangulation = arranged(&points, &lines)?;
    let plan = |v: usize| {
        let [x, y, _] = triangulation.points()[v];
        [x, y]
    };
    let cells: Vec<[usize; 3]> = triangulation
        .finite_cells()
        .map(|cell| {
            let corners = triangulation.tds().corners(cell).map(|v| v.index());
            // One order, however the surfaces are given.
            let before = |&i: &usize, &j: &usize| {
                let [p, q] = [i, j].map(|i| plan(corners[i]));
                in_order(&p, &q)
            };
            let least = (0..3).min_by(before).unwrap_or(0);
            [0, 1, 2].map(|i| corners[(least + i) % 3])
        })
        .collect();
    // A cell is in the faces around its center.
    let inside: Vec<DifferenceCell> = cells
        .into_par_iter()
        .filter_map(|corners| {
            let [a, b, c] = corners.map(plan);
            let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1]]);
            let center = [0, 1].map(|k| a[k] + (u[k] + v[k]) / 3.0);
            let [first, second] = parts.each_ref().map(|part| part.face(center));
            let (first, second) = first.zip(second)?;
            Some(DifferenceCell {
                corners,
                area: u[0] * v[1] - u[1] * v[0],
                heights: [a, b, c].map(|p| within(first, p) - within(second, p)),
            })
        })
        .collect();
    // Where a triangle is thin, a rounded crossing beside it may be on it, at any of its heights.
    // So the height of a vertex is that of the largest cell around it.
    let mut heights = vec![(0.0, f64::NAN); triangulation.points().len()];
    for cell in &inside {
        for (&v, height) in cell.corners.iter().zip(cell.heights) {
            let (area, before): (f64, f64) = heights[v];
            let is_smaller = cell.area == area && height.abs() < before.abs();
            if before.is_nan() || cell.area > area || is_smaller {
                heights[v] = (cell.area, height);
            }
        }
    }
    let vertices = heights.iter().enumerate().map(|(v, &(_, height))| {
        let [x, y] = plan(v);
        // The other vertices are in no face.
        [x, y, if height.is_nan() { 0.0 } else { map(height) }]
    });
    let faces = inside.iter().map(|cell| cell.corners.map(|v| v as u32));
    Ok(Apart {
        mesh: Mesh::new(vertices.collect(), faces.collect(), &[], None)?,
        origin,
    })
}

/// Returns the least coordinates, if all are exact numbers relative to these, else 0: crossings are
/// rounded, the less the nearer the origin is.
fn origin_of<'a>(corners: impl Iterator<Item = &'a [f64; 3]> + Clone) -> [f64; 2] {
    [0, 1].map(|k| {
        let coordinates = corners.clone().map(|p| p[k]);
        let least = coordinates.clone().fold(f64::INFINITY, f64::min);
        let is_exact = |c: f64| {
            let from_least = c - least;
            from_least + least == c && c - from_least == least
        };
        let all = coordinates.clone().all(is_exact);
        if all && least.is_finite() { least } else { 0.0 }
    })
}

/// Returns some faces of a surface, without those that have no area.
fn triangles_of(surface: &dyn Surface, faces: &[u32]) -> Vec<Triangle> {
    let triangles = faces.iter().filter_map(|&face| surface.triangle(face));
    triangles
        .filter(|&corners| orientation(corners) == Sign::Positive)
        .map(from_least)
        .collect()
}

/// A triangle of the difference.
struct DifferenceCell {
    corners: [usize; 3],
    /// Twice its area.
    area: f64,
    /// The heights at its corners, in the faces around its center.
    heights: [f64; 3],
}

/// Some faces of a surface.
struct Part {
    triangles: Vec<Triangle>,
    boxes: Boxes<LocatedFace>,
}

impl Part {
    fn new(triangles: Vec<Triangle>) -> Self {
        let located = triangles
            .iter()
            .enumerate()
            .map(|(number, corners)| LocatedFace {
                number: number as u32,
                extent: Extent::of(*corners),
            });
        Part {
            boxes: Boxes::new(located.collect()),
            triangles,
        }
    }

    /// Returns the face at a position: the last one that has it, as in a raster.
    fn face(&self, q: [f64; 2]) -> Option<Triangle> {
        let mut found: Option<u32> = None;
        self.boxes.find(q, |face| {
            let corners = self.triangles[face.number as usize];
            if found.is_none_or(|number| number < face.number) && height_at(corners, q).is_some() {
                found = Some(face.number);
            }
            None::<()>
        });
        found.map(|number| self.triangles[number as usize])
    }
}
