//! `.vtu`: VTK's unstructured grid in XML (Kitware, "VTK File Formats", version 1.0), with the
//! arrays appended as raw bytes.

use std::io::{self, Write};

use super::tetrahedralized::Tetrahedralized;

/// VTK's number for a tetrahedron.
const TETRAHEDRON: u8 = 10;

pub(super) fn write(out: &mut impl Write, triangulated: &Tetrahedralized) -> io::Result<()> {
    let (points, cells) = (&triangulated.nodes.points, &triangulated.tetrahedra);
    let sizes = [
        24 * points.len() as u64,
        32 * cells.len() as u64,
        8 * cells.len() as u64,
        cells.len() as u64,
    ];
    // Each array begins with its size.
    let starts: Vec<u64> = (0..4)
        .map(|i| sizes[..i].iter().map(|size| size + 8).sum())
        .collect();
    write!(
        out,
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         <UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n\
         <Points>\n\
         <DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" offset=\"{}\"/>\n\
         </Points>\n\
         <Cells>\n\
         <DataArray type=\"Int64\" Name=\"connectivity\" format=\"appended\" offset=\"{}\"/>\n\
         <DataArray type=\"Int64\" Name=\"offsets\" format=\"appended\" offset=\"{}\"/>\n\
         <DataArray type=\"UInt8\" Name=\"types\" format=\"appended\" offset=\"{}\"/>\n\
         </Cells>\n\
         </Piece>\n\
         </UnstructuredGrid>\n\
         <AppendedData encoding=\"raw\">\n_",
        points.len(),
        cells.len(),
        starts[0],
        starts[1],
        starts[2],
        starts[3]
    )?;
    out.write_all(&sizes[0].to_le_bytes())?;
    points
        .as_flattened()
        .iter()
        .try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
    out.write_all(&sizes[1].to_le_bytes())?;
    cells
        .as_flattened()
        .iter()
        .try_for_each(|&v| out.write_all(&u64::from(v).to_le_bytes()))?;
    out.write_all(&sizes[2].to_le_bytes())?;
    (1..=cells.len() as u64).try_for_each(|end| out.write_all(&(4 * end).to_le_bytes()))?;
    out.write_all(&sizes[3].to_le_bytes())?;
    cells
        .iter()
        .try_for_each(|_| out.write_all(&[TETRAHEDRON]))?;
    writeln!(out, "\n</AppendedData>\n</VTKFile>")
}
