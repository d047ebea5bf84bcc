//! Reading a tile.

use super::{HEADER, METADATA, NORMALS, SHORT, WATER};
use crate::data::{TerrainTile, WaterMask};
use crate::error::{Error, Result};

/// What is in a file of a tile.
#[derive(Debug, Clone, PartialEq)]
pub struct DecodedTile {
    /// The lowest height and the highest, in meters.
    pub range: [f64; 2],
    /// The vertices: steps from the west, from the south, and above the lowest height.
    pub vertices: Vec<[u16; 3]>,
    /// The corners of the triangles.
    pub triangles: Vec<[u32; 3]>,
    /// The vertices on the west, south, east and north side.
    pub borders: [Vec<u32>; 4],
    /// The normal of each vertex in two bytes, by an octahedron, if there are any.
    pub normals: Vec<[u8; 2]>,
    /// Where the tile has water, if it says so.
    pub water: Option<WaterMask>,
    /// What is known of the tile, such as which tiles exist below it, as JSON.
    pub metadata: Option<String>,
    /// The numbers of the extensions.
    pub extensions: Vec<u8>,
}

impl DecodedTile {
    /// Returns the height of a vertex in meters.
    ///
    /// # Panics
    /// If there is no vertex with this number.
    pub fn height(&self, vertex: u32) -> f64 {
        let [low, high] = self.range;
        let steps = f64::from(self.vertices[vertex as usize][2]);
        low + steps * (high - low) / f64::from(TerrainTile::STEPS)
    }
}

/// The bytes that are left, and how many there were.
struct Rest<'a> {
    bytes: &'a [u8],
    all: usize,
}

impl<'a> Rest<'a> {
    fn position(&self) -> usize {
        self.all - self.bytes.len()
    }

    fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8]> {
        let Some((taken, rest)) = self.bytes.split_at_checked(count) else {
            return Err(Error::format(format!(
                "the file ends at byte {}, within {what}, which need {count} bytes from byte {}",
                self.all,
                self.position()
            )));
        };
        self.bytes = rest;
        Ok(taken)
    }

    fn double(&mut self, what: &str) -> Result<f64> {
        let bytes = self.take(8, what)?;
        Ok(f64::from_le_bytes(bytes.try_into().unwrap_or_default()))
    }

    fn float(&mut self, what: &str) -> Result<f64> {
        let bytes = self.take(4, what)?;
        Ok(f64::from(f32::from_le_bytes(
            bytes.try_into().unwrap_or_default(),
        )))
    }

    fn count(&mut self, what: &str) -> Result<usize> {
        let bytes = self.take(4, what)?;
        Ok(u32::from_le_bytes(bytes.try_into().unwrap_or_default()) as usize)
    }

    /// Numbers of 16 or 32 bits.
    fn numbers(&mut self, count: usize, is_long: bool, what: &str) -> Result<Vec<u32>> {
        let unit = if is_long { 4 } else { 2 };
        let bytes = self.take(count.saturating_mul(unit), what)?;
        let number = |bytes: &[u8]| match *bytes {
            [a, b] => u32::from(u16::from_le_bytes([a, b])),
            [a, b, c, d] => u32::from_le_bytes([a, b, c, d]),
            _ => 0,
        };
        Ok(bytes.chunks_exact(unit).map(number).collect())
    }
}

/// Reads a tile, which must not be compressed.
///
/// # Errors
/// If the file ends too early, a height is not a number, or a triangle or a border names a vertex
/// that does not exist. Nothing is allocated beyond the size of the file.
pub fn decode(bytes: &[u8]) -> Result<DecodedTile> {
    let mut rest = Rest {
        bytes,
        all: bytes.len(),
    };
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return Err(Error::format("the tile is compressed by gzip").cure("decompress it first"));
    }
    for _ in 0..3 {
        rest.double("the header")?;
    }
    let range = [rest.float("the header")?, rest.float("the header")?];
    if !(range[0] <= range[1] && range.iter().all(|height| height.is_finite())) {
        return Err(Error::format(format!(
            "the range of heights is {} to {}",
            range[0], range[1]
        )));
    }
    rest.take(HEADER - rest.position(), "the header")?;
    let count = rest.count("the number of vertices")?;
    let mut vertices = vec![[0; 3]; 0];
    for axis in 0..3 {
        let folded = rest.numbers(count, false, "the vertices")?;
        vertices.resize(count, [0; 3]);
        let mut value = 0_i32;
        for (vertex, folded) in vertices.iter_mut().zip(folded) {
            let folded = folded as i32;
            value += (folded >> 1) ^ -(folded & 1);
            vertex[axis] = u16::try_from(value)
                .ok()
                .filter(|&steps| steps <= TerrainTile::STEPS)
                .ok_or_else(|| {
                    Error::format(format!("a vertex is at {value} of 0 to 32767 steps"))
                })?;
        }
    }
    let is_long = count > SHORT;
    let unit = if is_long { 4 } else { 2 };
    rest.take(
        rest.position().next_multiple_of(unit) - rest.position(),
        "the padding",
    )?;
    let triangle_count = rest.count("the number of triangles")?;
    let codes = rest.numbers(triangle_count.saturating_mul(3), is_long, "the triangles")?;
    let mut next = 0_u32;
    let mut corners = Vec::with_capacity(codes.len());
    for code in codes {
        let corner = next.checked_sub(code).filter(|&v| (v as usize) < count);
        corners.push(corner.ok_or_else(|| no_vertex(i64::from(next) - i64::from(code), count))?);
        next += u32::from(code == 0);
    }
    let triangles = corners
        .chunks_exact(3)
        .map(|corners| [corners[0], corners[1], corners[2]])
        .collect();
    let mut borders: [Vec<u32>; 4] = Default::default();
    for border in &mut borders {
        let length = rest.count("the number of vertices on a border")?;
        *border = rest.numbers(length, is_long, "the vertices on a border")?;
        if let Some(&bad) = border.iter().find(|&&v| v as usize >= count) {
            return Err(no_vertex(i64::from(bad), count));
        }
    }
    let mut extensions = Vec::new();
    let mut normals = Vec::new();
    let mut water = None;
    let mut metadata = None;
    while !rest.bytes.is_empty() {
        let number = rest.take(1, "an extension")?;
        extensions.extend(number);
        let length = rest.count("the length of an extension")?;
        let content = rest.take(length, "an extension")?;
        if number == [NORMALS] {
            if length != 2 * count {
                return Err(Error::format(format!(
                    "{length} bytes of normals for {count} vertices, which need two each"
                )));
            }
            normals = content
                .chunks_exact(2)
                .map(|pair| [pair[0], pair[1]])
                .collect();
        } else if number == [WATER] {
            water = Some(mask(content)?);
        } else if number == [METADATA] {
            metadata = Some(text(content)?);
        }
    }
    Ok(DecodedTile {
        range,
        vertices,
        triangles,
        borders,
        normals,
        water,
        metadata,
        extensions,
    })
}

fn mask(content: &[u8]) -> Result<WaterMask> {
    const CELLS: usize = WaterMask::SIDE * WaterMask::SIDE;
    match *content {
        [0] => Ok(WaterMask::Land),
        [_] => Ok(WaterMask::Water),
        // Shades between land and water are allowed.
        ref cells if cells.len() == CELLS => Ok(WaterMask::of_cells(
            cells.iter().map(|&byte| byte > 127).collect(),
        )),
        ref cells => Err(Error::format(format!(
            "the water of a tile is 1 byte or {CELLS}, and here {}",
            cells.len()
        ))),
    }
}

fn text(content: &[u8]) -> Result<String> {
    let mut rest = Rest {
        bytes: content,
        all: content.len(),
    };
    let length = rest.count("the length of the metadata")?;
    let text = rest.take(length, "the metadata")?;
    String::from_utf8(text.to_vec()).map_err(|_| Error::format("the metadata are not UTF-8"))
}

#[cold]
fn no_vertex(number: i64, count: usize) -> Error {
    Error::format(format!(
        "vertex {number} does not exist: there are {count}, counted from 0"
    ))
}
