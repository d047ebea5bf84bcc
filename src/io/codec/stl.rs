//! Binary STL: triangles in 32-bit floats, from a local origin.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::listing::Listing;
use crate::data::Bounds;
use crate::error::{Error, Result};
use crate::io::Destination;
use crate::io::bytes::appended::appended;

/// Writes the triangles, and their origin as three numbers in `TARGET.origin.txt`. Returns the
/// origin and the path of that file.
///
/// The origin is the minimum corner of the data, rounded to whole units. A float then has a
/// resolution of a millimeter over 8 km; with map coordinates, it would lose the meter.
pub(crate) fn write(target: Destination, mesh: &Listing) -> Result<([f64; 3], PathBuf)> {
    let count = u32::try_from(mesh.face_count).map_err(|_| {
        Error::limit(format!(
            "{} triangles; an STL file supports up to {}",
            mesh.face_count,
            u32::MAX
        ))
    })?;
    let mut bounds = Bounds::default();
    mesh.vertices().for_each(|p| bounds.add(p));
    let origin = if bounds.is_empty() {
        [0.0; 3]
    } else {
        bounds.min.map(f64::floor)
    };
    let [x, y, z] = origin;

    let mut header = [b' '; 80];
    // A file that begins with "solid" would be read as text.
    let title = format!("breakline; add the origin {x} {y} {z}");
    let length = title.len().min(header.len());
    header[..length].copy_from_slice(&title.as_bytes()[..length]);
    let mut output = target.create()?;
    output.write_all(&header)?;
    output.write_all(&count.to_le_bytes())?;
    for corners in mesh.triangles() {
        let corners = corners.map(|p| local(p, origin));
        let mut facet = [0u8; 50];
        let numbers = std::iter::once(normal(corners)).chain(corners).flatten();
        for (bytes, number) in facet.chunks_exact_mut(4).zip(numbers) {
            bytes.copy_from_slice(&(number as f32).to_le_bytes());
        }
        output.write_all(&facet)?;
    }

    let beside = origin_file(target.path());
    let mut note = target.create_beside(&beside)?;
    writeln!(note, "{x} {y} {z}")?;
    target.put_all([note], output, [])?;
    Ok((origin, beside))
}

/// The content of a binary STL file.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Number of triangles.
    pub triangles: usize,
    /// Extent in map coordinates.
    pub bounds: Bounds,
    /// The origin to be added to the coordinates of the file, as stated by the file next to it; 0
    /// if there is none.
    pub origin: [f64; 3],
}

/// Bytes before the first facet: a title and the count.
const HEADER: usize = 84;
const FACET: usize = 50;

/// Reads the number of triangles, extent and origin of a binary STL file.
pub(crate) fn describe(path: &Path) -> Result<Solid> {
    let bytes = std::fs::read(path)?;
    let count = bytes
        .get(80..HEADER)
        .and_then(|count| count.try_into().ok())
        .map(u32::from_le_bytes);
    let length = count.map(|count| HEADER as u64 + FACET as u64 * u64::from(count));
    let (Some(count), Some(length)) = (count, length) else {
        return Err(Error::format(format!(
            "{} bytes, a binary STL file has 84 and more",
            bytes.len()
        )));
    };
    if length != bytes.len() as u64 {
        let text = if bytes.starts_with(b"solid") {
            " (STL as text is not read)"
        } else {
            ""
        };
        return Err(Error::format(format!(
            "{count} triangles need {length} bytes, the file has {}{text}",
            bytes.len()
        )));
    }
    let origin = read_origin(&origin_file(path))?.unwrap_or_default();
    let mut bounds = Bounds::default();
    for facet in bytes[HEADER..].chunks_exact(FACET) {
        // A facet consists of the normal, then the corners, three numbers each.
        let number = |i: usize| {
            facet[4 * i..]
                .first_chunk()
                .map_or(f32::NAN, |bytes| f32::from_le_bytes(*bytes))
        };
        let corner = |k: usize| {
            std::array::from_fn(|axis| f64::from(number(3 + 3 * k + axis)) + origin[axis])
        };
        (0..3).for_each(|k| bounds.add(corner(k)));
    }
    Ok(Solid {
        triangles: count as usize,
        bounds,
        origin,
    })
}

/// Returns the path of the file with the origin: `ground.stl` has `ground.stl.origin.txt`.
fn origin_file(target: &Path) -> PathBuf {
    appended(target, ".origin.txt")
}

fn read_origin(path: &Path) -> Result<Option<[f64; 3]>> {
    if !path.is_file() {
        return Ok(None);
    }
    let text = std::fs::read_to_string(path).map_err(|e| Error::from(e).in_file(path))?;
    let numbers: Vec<f64> = text
        .split_ascii_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect();
    let origin = <[f64; 3]>::try_from(numbers)
        .ok()
        .filter(|origin| origin.iter().all(|c| c.is_finite()));
    origin
        .map(Some)
        .ok_or_else(|| Error::format("expected the three numbers of an origin").in_file(path))
}

fn local(p: [f64; 3], origin: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| p[i] - origin[i])
}

/// Returns the unit normal, which points up if the face is counter-clockwise in plan.
fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let (u, v) = (local(b, a), local(c, a));
    let n = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let length = n[0].hypot(n[1]).hypot(n[2]);
    if length > 0.0 {
        n.map(|part| part / length)
    } else {
        [0.0; 3]
    }
}
