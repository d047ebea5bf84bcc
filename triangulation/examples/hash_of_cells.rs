//! Prints a hash of the tetrahedra of points in space, to be compared with other programs:
//! `benches/cgal_hash.cpp` prints the same line where no five points lie on a sphere.
//!
//! ```text
//! hash_of_cells FILE.xyz ...
//! ```
//!
//! A file contains triples of coordinates, little-endian 64-bit floating point. The line consists
//! of: file, points, tetrahedra, hash. The hash is the sum over all tetrahedra of a hash of the
//! indices of their corners, in ascending order.

#![allow(clippy::print_stdout, reason = "what it is for")]

use breakline_triangulation::Delaunay3;
use breakline_triangulation::geometry::Space;

/// A step of splitmix64 (Steele, Lea and Flood 2014).
fn mixed(number: u64) -> u64 {
    let mut z = number.wrapping_add(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for path in std::env::args().skip(1) {
        let bytes = std::fs::read(&path)?;
        let numbers: Vec<f64> = bytes
            .as_chunks::<8>()
            .0
            .iter()
            .map(|number| f64::from_le_bytes(*number))
            .collect();
        let points = numbers.as_chunks::<3>().0;
        let (t, vertices) = Delaunay3::from_points(Space::new(), points)?;
        let mut point_of = vec![u64::MAX; t.tds().vertex_slots()];
        vertices
            .iter()
            .zip(0..)
            .for_each(|(v, point)| point_of[v.index()] = point.min(point_of[v.index()]));
        let (mut count, mut hash) = (0, 0u64);
        for cell in t.finite_cells() {
            let mut corners = t.tds().corners(cell).map(|vertex| point_of[vertex.index()]);
            corners.sort_unstable();
            count += 1;
            hash = hash.wrapping_add(corners.iter().fold(0, |hash, corner| mixed(hash ^ corner)));
        }
        println!("{path} {} {count} {hash:016x}", points.len());
    }
    Ok(())
}
