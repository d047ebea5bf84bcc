//! Writing a tile.

use super::header::Header;
use super::{METADATA, NORMALS, SHORT, WATER};
use crate::data::{TerrainTile, Tiling, WaterMask};
use crate::error::Result;

/// What a tile says besides its triangles and their normals.
#[derive(Debug, Clone, Copy, Default)]
pub struct Extensions<'a> {
    /// Where it has water.
    pub water: Option<&'a WaterMask>,
    /// Which tiles exist below it: see [`tiles_below`](super::tiles_below).
    pub metadata: Option<&'a str>,
}

/// Returns the bytes of a tile, which are not compressed.
///
/// The normals are left out unless there is one for each vertex. Vertices are in the order of their
/// first use by a triangle, as [`TerrainTile`]s of a pyramid have them; others are put into this
/// order.
///
/// # Errors
/// If a triangle names a vertex that does not exist.
pub fn encode(tile: &TerrainTile, tiling: Tiling, extensions: &Extensions) -> Result<Vec<u8>> {
    tile.check()?;
    let (order, triangles) = by_first_use(tile);
    let vertices: Vec<[u16; 3]> = order.iter().map(|&v| tile.vertices[v as usize]).collect();
    let mut bytes = Vec::new();
    header(&Header::of(tile, tiling), &mut bytes);
    let count = vertices.len() as u32;
    bytes.extend(count.to_le_bytes());
    for axis in 0..3 {
        let mut before = 0_i32;
        for vertex in &vertices {
            let value = i32::from(vertex[axis]);
            let difference = value - before;
            before = value;
            // Small numbers whatever the sign.
            let folded = (difference << 1) ^ (difference >> 31);
            bytes.extend((folded as u16).to_le_bytes());
        }
    }
    let is_long = vertices.len() > SHORT;
    let unit = if is_long { 4 } else { 2 };
    while !bytes.len().is_multiple_of(unit) {
        bytes.push(0);
    }
    let number = |value: u32, bytes: &mut Vec<u8>| match is_long {
        true => bytes.extend(value.to_le_bytes()),
        false => bytes.extend((value as u16).to_le_bytes()),
    };
    bytes.extend((triangles.len() as u32).to_le_bytes());
    let mut next = 0;
    for corner in triangles.iter().flatten() {
        number(next - corner, &mut bytes);
        next += u32::from(*corner == next);
    }
    for border in borders(&vertices) {
        bytes.extend((border.len() as u32).to_le_bytes());
        border.iter().for_each(|&v| number(v, &mut bytes));
    }
    if tile.normals.len() == tile.vertices.len() {
        let normals = order.iter().map(|&v| octahedral(tile.normals[v as usize]));
        let normals: Vec<u8> = normals.flatten().collect();
        extension(NORMALS, &normals, &mut bytes);
    }
    if let Some(water) = extensions.water {
        let byte = |&is_water: &bool| if is_water { u8::MAX } else { 0 };
        let mask = match water {
            WaterMask::Land => vec![byte(&false)],
            WaterMask::Water => vec![byte(&true)],
            WaterMask::Cells(cells) => cells.iter().map(byte).collect(),
        };
        extension(WATER, &mask, &mut bytes);
    }
    if let Some(text) = extensions.metadata {
        let mut content = (text.len() as u32).to_le_bytes().to_vec();
        content.extend(text.as_bytes());
        extension(METADATA, &content, &mut bytes);
    }
    Ok(bytes)
}

fn extension(number: u8, content: &[u8], bytes: &mut Vec<u8>) {
    bytes.push(number);
    bytes.extend((content.len() as u32).to_le_bytes());
    bytes.extend(content);
}

/// A direction in two bytes: projected to an octahedron, whose lower half is folded outwards
/// (Cigolle et al. 2014, "A survey of efficient representations for independent unit vectors").
fn octahedral(normal: [f64; 3]) -> [u8; 2] {
    let sum: f64 = normal.iter().map(|c| c.abs()).sum();
    let [x, y] = [normal[0] / sum, normal[1] / sum];
    let folded = match normal[2] < 0.0 {
        true => [(1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y)],
        false => [x, y],
    };
    folded.map(|c| ((c.clamp(-1.0, 1.0) * 0.5 + 0.5) * 255.0).round() as u8)
}

fn header(header: &Header, bytes: &mut Vec<u8>) {
    let doubles = |values: &[f64], bytes: &mut Vec<u8>| {
        values
            .iter()
            .for_each(|value| bytes.extend(value.to_le_bytes()));
    };
    doubles(&header.center, bytes);
    for height in header.range {
        bytes.extend((height as f32).to_le_bytes());
    }
    let (center, radius) = header.sphere;
    doubles(&center, bytes);
    doubles(&[radius], bytes);
    doubles(&header.horizon, bytes);
}

/// Returns the vertices in the order of their first use, and the triangles with their new numbers.
/// Vertices without a triangle come last.
fn by_first_use(tile: &TerrainTile) -> (Vec<u32>, Vec<[u32; 3]>) {
    let mut numbers = vec![u32::MAX; tile.vertices.len()];
    let mut order = Vec::with_capacity(tile.vertices.len());
    let mut number_of = |vertex: u32| {
        let number = &mut numbers[vertex as usize];
        if *number == u32::MAX {
            *number = order.len() as u32;
            order.push(vertex);
        }
        *number
    };
    let triangles = tile
        .triangles
        .iter()
        .map(|corners| corners.map(&mut number_of))
        .collect();
    (0..tile.vertices.len() as u32).for_each(|vertex| {
        number_of(vertex);
    });
    (order, triangles)
}

/// Returns the vertices on the west, south, east and north side, in the order of their positions
/// along it.
fn borders(vertices: &[[u16; 3]]) -> [Vec<u32>; 4] {
    let sides = [
        (0, 0),
        (1, 0),
        (0, TerrainTile::STEPS),
        (1, TerrainTile::STEPS),
    ];
    sides.map(|(axis, at)| {
        let numbers = 0..vertices.len() as u32;
        let mut border: Vec<u32> = numbers
            .filter(|&v| vertices[v as usize][axis] == at)
            .collect();
        border.sort_by_key(|&v| vertices[v as usize][1 - axis]);
        border
    })
}
