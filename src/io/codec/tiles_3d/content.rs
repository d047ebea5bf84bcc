//! A tile as GLB.

use rustc_hash::FxHashMap;
use serde_json::json;

use crate::crs::geocentric;
use crate::data::{Bounds, TerrainTile, Tiling};
use crate::error::Result;
use crate::io::codec::glb::{FLOAT, INT, head};

/// The vertices of a tile on the earth, and those of its skirts.
struct Shape {
    positions: Vec<[f64; 3]>,
    /// For each vertex the one whose normal it has.
    normal_of: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

/// Returns the bytes of a GLB file: the triangles of a tile, and a skirt of some depth in meters
/// along its borders.
///
/// # Errors
/// If a triangle names a vertex that does not exist, or the file would be too large.
pub fn content(tile: &TerrainTile, tiling: Tiling, depth: f64) -> Result<Vec<u8>> {
    tile.check()?;
    let shape = Shape::of(tile, tiling, depth);
    let mut bounds = Bounds::default();
    shape.positions.iter().for_each(|&p| bounds.add(p));
    let origin = [0, 1, 2].map(|k| ((bounds.min[k] + bounds.max[k]) / 2.0).round());
    let floats = |[x, y, z]: [f64; 3]| [x, z, -y].map(|c| c as f32);
    let local = |p: &[f64; 3]| floats([0, 1, 2].map(|k| p[k] - origin[k]));
    let (count, faces) = (shape.positions.len(), shape.triangles.len());
    let mut arrays = Vec::with_capacity(24 * count + 12 * faces);
    let mut extent = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    for position in shape.positions.iter().map(local) {
        for (k, value) in position.into_iter().enumerate() {
            extent[0][k] = extent[0][k].min(value);
            extent[1][k] = extent[1][k].max(value);
            arrays.extend(value.to_le_bytes());
        }
    }
    for &vertex in &shape.normal_of {
        let normal = tile.normals.get(vertex as usize);
        let normal = floats(normal.copied().unwrap_or([0.0, 0.0, 1.0]));
        normal.iter().for_each(|c| arrays.extend(c.to_le_bytes()));
    }
    let corners = shape.triangles.iter().flatten();
    corners.for_each(|v| arrays.extend(v.to_le_bytes()));
    let [min, max] = extent.map(|corner| corner.map(f64::from));
    let [x, y, z] = origin;
    let view = |start: usize, length: usize, target: u32| json!({ "buffer": 0, "byteOffset": start, "byteLength": length, "target": target });
    let text = json!({
        "asset": {
            "version": "2.0",
            "generator": format!("breakline {}", env!("CARGO_PKG_VERSION")),
        },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "translation": [x, z, -y + 0.0] }],
        "meshes": [{
            "primitives": [{
                "attributes": { "POSITION": 0, "NORMAL": 1 },
                "indices": 2,
                "material": 0,
                "mode": 4,
            }],
        }],
        "materials": [{
            "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 1 },
        }],
        "accessors": [
            {
                "bufferView": 0, "componentType": FLOAT, "type": "VEC3", "count": count,
                "min": min, "max": max,
            },
            { "bufferView": 1, "componentType": FLOAT, "type": "VEC3", "count": count },
            { "bufferView": 2, "componentType": INT, "type": "SCALAR", "count": 3 * faces },
        ],
        "bufferViews": [
            view(0, 12 * count, 34962),
            view(12 * count, 12 * count, 34962),
            view(24 * count, 12 * faces, 34963),
        ],
        "buffers": [{ "byteLength": arrays.len() }],
    });
    let mut bytes = head(text.to_string(), arrays.len() as u64)?;
    bytes.extend(arrays);
    Ok(bytes)
}

impl Shape {
    fn of(tile: &TerrainTile, tiling: Tiling, depth: f64) -> Self {
        let on_earth = |steps: [u16; 3], below: f64| {
            let [longitude, latitude, z] = tile.position(tiling, steps);
            geocentric([longitude, latitude, z - below])
        };
        let mut shape = Shape {
            positions: tile.vertices.iter().map(|&v| on_earth(v, 0.0)).collect(),
            normal_of: (0..tile.vertices.len() as u32).collect(),
            triangles: tile.triangles.clone(),
        };
        let is_on = |v: u32, axis: usize, at: u16| tile.vertices[v as usize][axis] == at;
        let mut lower: FxHashMap<u32, u32> = FxHashMap::default();
        for face in &tile.triangles {
            for i in 0..3 {
                let [a, b] = [face[i], face[(i + 1) % 3]];
                let is_border = [0, 1].into_iter().any(|axis| {
                    [0, TerrainTile::STEPS]
                        .into_iter()
                        .any(|at| is_on(a, axis, at) && is_on(b, axis, at))
                });
                if !is_border {
                    continue;
                }
                let [under_a, under_b] = [a, b].map(|v| {
                    *lower.entry(v).or_insert_with(|| {
                        shape
                            .positions
                            .push(on_earth(tile.vertices[v as usize], depth));
                        shape.normal_of.push(v);
                        shape.positions.len() as u32 - 1
                    })
                });
                // Seen from outside of the tile, whose surface is to the left of the edge.
                shape.triangles.push([b, a, under_a]);
                shape.triangles.push([b, under_a, under_b]);
            }
        }
        shape
    }
}
