//! Normals of vertices, by which viewers shade a tile.
//!
//! Those inside of a tile are the normals of its triangles. A tile does not know the triangles
//! beyond its border, so the normals there follow from how the surface rises around the border:
//! both tiles have the same.

use super::lines::Rises;
use crate::crs::{from_local, geocentric};
use crate::data::{TerrainTile, Tiling, unit, vertex_normals};

/// Returns the normal of each vertex of a tile, from the center of the earth.
pub(super) fn normals(tile: &TerrainTile, tiling: Tiling, rises: &Rises) -> Vec<[f64; 3]> {
    let degrees = |steps: [u16; 3]| tile.position(tiling, steps);
    let on_earth: Vec<[f64; 3]> = tile.vertices.iter().map(|&v| degrees(v)).collect();
    let positions: Vec<[f64; 3]> = on_earth.iter().map(|&p| geocentric(p)).collect();
    let faces = tile.triangles.iter();
    let mut normals = vertex_normals(
        positions.len(),
        faces.map(|face| (*face, face.map(|v| positions[v as usize]))),
    );
    for ((normal, &[u, v, _]), &[longitude, latitude, _]) in
        normals.iter_mut().zip(&tile.vertices).zip(&on_earth)
    {
        let Some(rise) = rises.get(&[u, v]) else {
            continue;
        };
        let meters = Tiling::meters_per_degree(latitude);
        let slope = [0, 1].map(|k| rise[k] / meters[k]);
        // At a pole, a unit along x has no length.
        let is_known = slope.iter().all(|slope| slope.is_finite());
        let [east, north] = if is_known { slope } else { [0.0; 2] };
        let local = unit([-east, -north, 1.0]).unwrap_or([0.0, 0.0, 1.0]);
        *normal = from_local([longitude, latitude], local);
    }
    normals
}
