//! Binary STL: triangles in 32-bit floats, from a local origin.

use std::io::Write;
use std::path::PathBuf;

use super::listing::Listing;
use crate::data::Bounds;
use crate::error::{Error, Result};
use crate::io::{Destination, Output};

/// Writes the triangles, and their origin as three numbers in `TARGET.origin.txt`.
///
/// The origin is the smallest corner of the data in whole units: a float then keeps the millimetre
/// over 8 km, where map coordinates would lose the metre.
pub(super) fn write(target: Destination, mesh: &Listing) -> Result<([f64; 3], PathBuf)> {
    let count = u32::try_from(mesh.face_count)
        .map_err(|_| Error::limit(format!("{} triangles; an STL file counts to {}", mesh.face_count, u32::MAX)))?;
    let mut bounds = Bounds::default();
    mesh.vertices().for_each(|p| bounds.add(p));
    let origin = if bounds.is_empty() { [0.0; 3] } else { bounds.min.map(f64::floor) };
    let [x, y, z] = origin;

    let mut header = [b' '; 80];
    // A file that began with "solid" would be taken for text.
    let title = format!("breakline; add the origin {x} {y} {z}");
    let length = title.len().min(header.len());
    header[..length].copy_from_slice(&title.as_bytes()[..length]);
    let mut output = Output::create(target.path())?;
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

    let mut beside = target.path().as_os_str().to_owned();
    beside.push(".origin.txt");
    let beside = PathBuf::from(beside);
    let mut note = Output::create(&beside)?;
    writeln!(note, "{x} {y} {z}")?;
    target.put_all([note], output, [])?;
    Ok((origin, beside))
}

fn local(p: [f64; 3], origin: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| p[i] - origin[i])
}

/// The unit normal; up for faces counter-clockwise in plan.
fn normal([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    let (u, v) = (local(b, a), local(c, a));
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = n[0].hypot(n[1]).hypot(n[2]);
    if length > 0.0 { n.map(|part| part / length) } else { [0.0; 3] }
}
