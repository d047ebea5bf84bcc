//! `.mesh` of MEDIT (Frey 2001, "MEDIT: An Interactive Mesh Visualization Software"), as text.

use std::io::{self, Write};

use super::tetrahedralized::Tetrahedralized;
use crate::io::bytes::decimal::Decimal;

pub(super) fn write(out: &mut impl Write, triangulated: &Tetrahedralized) -> io::Result<()> {
    let Tetrahedralized {
        nodes, tetrahedra, ..
    } = triangulated;
    writeln!(
        out,
        "MeshVersionFormatted 2\n\nDimension 3\n\nVertices\n{}",
        nodes.points.len()
    )?;
    for ([x, y, z], marker) in nodes.points.iter().zip(&nodes.markers) {
        writeln!(
            out,
            "{} {} {} {marker}",
            Decimal(*x),
            Decimal(*y),
            Decimal(*z)
        )?;
    }
    writeln!(out, "\nTriangles\n{}", triangulated.hull().count())?;
    for [a, b, c] in triangulated.hull().map(|corners| corners.map(|v| v + 1)) {
        writeln!(out, "{a} {b} {c} 1")?;
    }
    writeln!(out, "\nTetrahedra\n{}", tetrahedra.len())?;
    for [a, b, c, d] in tetrahedra.iter().map(|corners| corners.map(|v| v + 1)) {
        writeln!(out, "{a} {b} {c} {d} 0")?;
    }
    writeln!(out, "\nEnd")
}
