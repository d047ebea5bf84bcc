//! OFF, the object file format of Geomview: vertices and faces as text.
//!
//! `OFF`, then the numbers of vertices, faces and edges, then a line `x y z` for each vertex and a
//! line `count v1 v2 ...` for each face, counted from 0. Comments begin with `#`. Further values in
//! a line (colors, normals) are skipped.

use std::io::Write;

use super::listing::{Listing, crs_text, polygon};
use crate::crs::Crs;
use crate::data::Triangles;
use crate::error::{Error, Result};
use crate::io::bytes::decimal::Decimal;
use crate::io::bytes::lines::write_lines;
use crate::io::bytes::rows::{Row, Rows, shown};
use crate::io::options::cut::open_line;
use crate::io::{Destination, Watch};

/// Writes vertices, faces and the coordinate system. The number of edges, which no reader uses, is
/// written as 0.
pub(crate) fn write(target: Destination, mesh: &Listing, crs: Option<&Crs>) -> Result<()> {
    let mut output = target.create()?;
    writeln!(output, "OFF")?;
    for line in crs_text::comments(crs) {
        writeln!(output, "# {line}")?;
    }
    writeln!(output, "{} {} 0", mesh.vertex_count, mesh.face_count)?;
    write_lines(&mut output, mesh.vertices(), |text, p| {
        let [x, y, z] = p.map(Decimal);
        writeln!(text, "{x} {y} {z}")
    })?;
    write_lines(&mut output, mesh.faces(), |text, [a, b, c]| {
        writeln!(text, "3 {a} {b} {c}")
    })?;
    target.put(output)
}

/// Reads plain OFF and its variants with colors and normals.
pub(crate) fn read(bytes: &[u8], watch: Watch) -> Result<Triangles> {
    let mut rows = Rows::new(bytes, watch);
    let [vertex_count, face_count] = read_header(&mut rows)?;
    let mut vertices = Vec::with_capacity(vertex_count.min(bytes.len() / MIN_BYTES));
    for i in 0..vertex_count {
        let mut row = rows.expect(|| format!("vertex {i} of {vertex_count}"), "X Y Z")?;
        row.refuse_commas()?;
        vertices.push([
            row.finite("x coordinate")?,
            row.finite("y coordinate")?,
            row.finite("z coordinate")?,
        ]);
    }
    let mut faces = Vec::with_capacity(face_count.min(bytes.len() / MIN_BYTES));
    let mut corners = Vec::new();
    for i in 0..face_count {
        let mut row = rows.expect(|| format!("face {i} of {face_count}"), "COUNT V1 V2 V3 ...")?;
        let count: usize = row.within("number of corners")?;
        corners.clear();
        for _ in 0..count {
            corners.push(row.within("vertex number")?);
        }
        polygon::add_polygon(&vertices, &corners, &mut faces)
            .map_err(|e| e.at(format!("line {}", row.line)))?;
    }
    rows.end("the last face")?;
    let comments = bytes
        .split(|&b| b == b'\n')
        .filter_map(|line| line.strip_prefix(b"# "));
    let comments = comments.map(|text| {
        String::from_utf8_lossy(text)
            .trim_end_matches('\r')
            .to_owned()
    });
    let crs: String = comments
        .filter_map(|text| crs_text::crs_comment(&text).map(str::to_owned))
        .collect();
    let warnings = open_line(bytes).into_iter().collect();
    Ok(Triangles {
        vertices,
        faces,
        crs: crs_text::parse(&crs)?,
        warnings,
        ..Default::default()
    })
}

/// The fewest bytes of a vertex or a face, which limit the memory allocated for a stated count.
const MIN_BYTES: usize = 6;

/// Returns the numbers of vertices and faces, which follow the keyword in its line or in the next.
fn read_header(rows: &mut Rows) -> Result<[usize; 2]> {
    const COUNTS: &str = "VERTICES FACES EDGES";
    let mut row = rows.expect(|| "the keyword OFF".to_owned(), "OFF")?;
    let keyword = row.word().unwrap_or_default();
    match keyword {
        b"OFF" | b"COFF" | b"NOFF" | b"CNOFF" | b"STOFF" => {}
        _ if keyword.ends_with(b"OFF") => {
            let kind = shown(keyword);
            return Err(Error::unsupported(format!(
                "'{kind}' is a variant of OFF that is not supported"
            ))
            .at(format!("line {}", row.line))
            .cure("save it as plain OFF"));
        }
        _ => {
            return Err(row.wrong(format!(
                "the file begins with '{}', not with 'OFF'",
                shown(keyword)
            )));
        }
    }
    if row.has_more() {
        return counts(row);
    }
    counts(rows.expect(|| "the number of vertices".to_owned(), COUNTS)?)
}

fn counts(mut row: Row) -> Result<[usize; 2]> {
    Ok([
        row.within("number of vertices")?,
        row.within("number of faces")?,
    ])
}
