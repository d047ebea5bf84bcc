//! Where two surfaces differ by more than a height, as polygons.

mod above;
mod apart;
mod area;

use self::above::above;
use self::apart::difference_over;
pub use self::area::ChangedArea;
use super::overlay::{Overlap, overlay};
use crate::data::{Surface, bounds_of_faces};
use crate::error::{Error, Result};

/// Differences that are this close to the height, relative to the largest height of the surfaces,
/// are equal to it: they are known up to rounding errors.
const ROUNDING: f64 = f64::EPSILON * 256.0;

/// Returns the areas in which two surfaces differ by more than a height, those with the largest
/// volumes first.
///
/// The polygons are those of the triangles: the difference is linear on what a triangle of each
/// surface has in common, and is known there up to a few rounding errors. Positions at which
/// triangles cross are rounded, relative to the least coordinates; vertices of polygons are rounded
/// to the numbers that there are. Areas that meet only in a vertex are separate; what meets along
/// an edge is one area, also if the difference is just the height there. With the surfaces
/// exchanged, areas have the other sign and are equal otherwise, bit for bit.
///
/// # Errors
/// If the height is not above zero, a coordinate is not covered by the arithmetic, the surfaces
/// extend so far that products of their sizes are no numbers, or a surface was found damaged.
///
/// # Complexity
/// That of [`volumes`](super::volumes), and expected O(k log^2 k) for the k crossings of the edges
/// of triangles that differ by more, with about 300 bytes for each: this part is on one thread.
pub fn changed_areas(surfaces: [&dyn Surface; 2], height: f64) -> Result<Vec<ChangedArea>> {
    if !(height > 0.0 && height.is_finite()) {
        return Err(Error::usage(format!(
            "surfaces that differ by more than {height}: expected a height above 0"
        )));
    }
    let mut faces: [Vec<u32>; 2] = Default::default();
    let add = |found: &mut Vec<[u32; 2]>, overlap: Overlap<'_>| {
        let mut apart = overlap.corners.iter().map(|c| c.heights[0] - c.heights[1]);
        if apart.any(|d| d.abs() > height) {
            found.push(overlap.faces);
        }
    };
    overlay(surfaces, add, |pairs| {
        for (k, faces) in faces.iter_mut().enumerate() {
            faces.extend(pairs.iter().map(|pair| pair[k]));
        }
    });
    for faces in &mut faces {
        faces.sort_unstable();
        faces.dedup();
    }
    surfaces.iter().try_for_each(|of| of.ensure_intact())?;
    if faces[0].is_empty() {
        return Ok(Vec::new());
    }
    let [one, other] = surfaces.map(|of| bounds_of_faces(of).largest(2));
    let rounding = ROUNDING * one.max(other);
    let at_height = |d: f64| match (d.abs() - height).abs() <= rounding {
        true => height.copysign(d),
        false => d,
    };
    let difference = difference_over(surfaces, &faces, at_height)?;
    surfaces.iter().try_for_each(|of| of.ensure_intact())?;
    let mut areas = above(&difference, height, 1.0)?;
    areas.extend(above(&difference, height, -1.0)?);
    areas.sort_by(|one, other| {
        let by_volume = other.volume.total_cmp(&one.volume);
        by_volume.then_with(|| one.rings.partial_cmp(&other.rings).unwrap_or(by_volume))
    });
    Ok(areas)
}
