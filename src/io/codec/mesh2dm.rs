//! 2DM, the mesh of SMS (Aquaveo) and of models of water such as BASEMENT: text, with a card at the
//! beginning of each line.
//!
//! `MESH2D`, then `E3T number v1 v2 v3 material` for each triangle and `ND number x y z` for each
//! vertex, both counted from 1.

use std::io::Write;

use super::listing::ids::Ids;
use super::listing::{Listing, Remarks, crs_text, polygon};
use crate::crs::Crs;
use crate::data::Triangles;
use crate::error::{Error, Result};
use crate::io::bytes::decimal::Decimal;
use crate::io::bytes::lines::write_lines;
use crate::io::bytes::rows::{Row, Rows, shown};
use crate::io::options::cut::open_line;
use crate::io::{Destination, Watch};

/// Writes triangles, then vertices: a file that is cut lacks vertices that triangles before them
/// name. 2DM has no coordinate system.
pub(crate) fn write(target: Destination, mesh: &Listing, crs: Option<&Crs>) -> Result<Remarks> {
    let mut output = target.create()?;
    writeln!(output, "MESH2D")?;
    let faces = (1u64..).zip(mesh.faces());
    write_lines(&mut output, faces, |text, (number, face)| {
        let [a, b, c] = face.map(|v| u64::from(v) + 1);
        writeln!(text, "E3T {number} {a} {b} {c} 1")
    })?;
    let vertices = (1u64..).zip(mesh.vertices());
    write_lines(&mut output, vertices, |text, (number, p)| {
        let [x, y, z] = p.map(Decimal);
        writeln!(text, "ND {number} {x} {y} {z}")
    })?;
    target.put(output)?;
    Ok(Remarks {
        notes: crs_text::left_out(crs).into_iter().collect(),
        ..Remarks::default()
    })
}

/// Reads elements with three and four corners, and nodes, in any order. Node strings, parameters
/// and boundary conditions are skipped; an unknown card is an error, since it may be a damaged one.
pub(crate) fn read(bytes: &[u8], watch: Watch) -> Result<Triangles> {
    let mut rows = Rows::new(bytes, watch);
    let mut row = rows.expect(|| "the card MESH2D".to_owned(), "MESH2D")?;
    let first = row.word().unwrap_or_default();
    if first != b"MESH2D" {
        let shown = shown(first);
        return Err(row.wrong(format!("the file begins with '{shown}', not with 'MESH2D'")));
    }
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    let mut ids = Ids::default();
    let mut elements = Vec::new();
    let mut corners: Vec<u64> = Vec::new();
    let mut skipped_to: Option<&[u8]> = None;
    while let Some(mut row) = rows.next_watched("CARD NUMBER ...")? {
        let card = row.word().unwrap_or_default();
        if let Some(end) = skipped_to {
            skipped_to = (card != end).then_some(end);
            continue;
        }
        match card {
            b"ND" => {
                let id = row.within("node number")?;
                let number = u32::try_from(vertices.len())
                    .map_err(|_| Error::limit(format!("more than {} nodes", u32::MAX)))?;
                if !ids.add(id, number) {
                    return Err(row.wrong(format!("two nodes have the number {id}")));
                }
                vertices.push([
                    row.finite("x coordinate")?,
                    row.finite("y coordinate")?,
                    row.finite("z coordinate")?,
                ]);
                if row.has_more() {
                    return Err(row.wrong("a node with more than three coordinates".to_owned()));
                }
            }
            b"E3T" => elements.push(element(&mut row, 3, &mut corners)?),
            b"E4Q" => elements.push(element(&mut row, 4, &mut corners)?),
            b"E6T" | b"E8Q" | b"E9Q" => {
                let card = shown(card);
                return Err(Error::unsupported(format!(
                    "elements {card} have nodes on their edges"
                ))
                .at(format!("line {}", row.line))
                .cure("write the mesh with linear elements (E3T, E4Q)"));
            }
            b"BEGPARAMDEF" => skipped_to = Some(b"ENDPARAMDEF"),
            b"BEG2DMBC" => skipped_to = Some(b"END2DMBC"),
            _ if CARDS.contains(&card) => (),
            _ => {
                let card = shown(card);
                return Err(row.wrong(format!("'{card}' is not a card of 2DM")));
            }
        }
    }
    if let Some(end) = skipped_to {
        return Err(Error::format(format!("the card {} is missing", shown(end)))
            .at("the end")
            .cure("get the whole file"));
    }
    let mut faces = Vec::with_capacity(elements.len());
    let mut numbers = Vec::new();
    for (line, range) in elements {
        let at_line = |e: Error| e.at(format!("line {line}"));
        numbers.clear();
        for &id in &corners[range] {
            let number = ids.number(id).ok_or_else(|| {
                at_line(Error::format(format!("there is no node {id}")).cure("get the whole file"))
            })?;
            numbers.push(number);
        }
        polygon::add_polygon(&vertices, &numbers, &mut faces).map_err(at_line)?;
    }
    Ok(Triangles {
        vertices,
        faces,
        warnings: open_line(bytes).into_iter().collect(),
        ..Triangles::default()
    })
}

/// Reads the corners of an element. Returns its line, and where its corners are.
fn element(
    row: &mut Row,
    count: usize,
    corners: &mut Vec<u64>,
) -> Result<(usize, std::ops::Range<usize>)> {
    row.whole("element number")?;
    let first = corners.len();
    for _ in 0..count {
        corners.push(row.within("node number")?);
    }
    // Two lines that became one would else be one element.
    while row.has_more() {
        row.finite("material")?;
    }
    Ok((row.line, first..corners.len()))
}

/// The cards that are skipped: names, node strings, materials, elements of lines.
const CARDS: &[&[u8]] = &[
    b"MESHNAME",
    b"NUM_MATERIALS_PER_ELEM",
    b"NS",
    b"E2L",
    b"E3L",
    b"GP",
    b"MAT",
    b"BED",
    b"BCS",
    b"BCD",
];
